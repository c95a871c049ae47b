//! Scattered copies: how many, how evenly, on which ground; geometry is shared.

use super::meshes::{Obj, folder, icosphere};
use super::shot::{Shot, shot};
use std::path::Path;
use terrarium::build::{World, build};
use terrarium::math::DVec3;
use terrarium::plan::{Plan, Request};

fn world(shot: &Shot) -> World {
    let scene = shot.load().scene;
    let plan = Plan::new(&scene, &Request::default()).expect("nothing is overridden");
    build(&scene, &plan).unwrap_or_else(|e| panic!("{e}")).world
}

/// Tiny balls strewn over `carrier`; the last objects placed.
fn strewn(folder: &Path, count: u32, carrier: &str, more: &str) -> Shot {
    shot(format!(
        r#"(camera: (eye: (0, 5, 9), target: (0, 0, 0)), image: (width: 8, height: 8),
        materials: {{ "m": (diffuse: 0.5) }},
        definitions: {{ "dot": (shape: sphere(radius: 0.001), material: "m"), "ground": ({carrier}) }},
        objects: [(shape: scatter(of: ["dot"], over: "ground", count: {count} {more}), material: "m")])"#
    ))
    .folder(folder)
}

fn places(shot: &Shot) -> Vec<DVec3> {
    let world = world(shot);
    world.instances.iter().map(|i| i.placement.world_from_object.translation + world.origin).collect()
}

/// χ² of counts against equal expectations.
fn chi2(counts: &[f64]) -> f64 {
    let expected = counts.iter().sum::<f64>() / counts.len() as f64;
    assert!(expected > 20.0);
    counts.iter().map(|c| (c - expected).powi(2) / expected).sum()
}

const N: u32 = 20_000;

#[test]
fn copies_fill_a_quad_evenly() {
    let found = places(&strewn(Path::new(""), N, "shape: quad(size: (4, 2))", ""));
    assert_eq!(found.len(), N as usize);
    let mut counts = [0.0; 64];
    for p in found {
        assert!(p.x.abs() <= 2.0 && p.z.abs() <= 1.0 && p.y == 0.0);
        counts[((p.x + 2.0) * 2.0).min(7.0) as usize * 8 + ((p.z + 1.0) * 4.0).min(7.0) as usize] += 1.0;
    }
    // 63 degrees of freedom, 1 − 1e-4: 113.
    assert!(chi2(&counts) < 113.0, "{}", chi2(&counts));
}

/// The area of a band of a sphere is proportional to its height; of a stretched one it is not.
#[test]
fn copies_fill_spheres_and_ellipsoids_evenly_by_area() {
    for scale in [[1.0, 1.0, 1.0], [1.0, 3.0, 1.0], [2.0, 0.3, 2.0]] {
        let [sx, sy, sz] = scale;
        let carrier = format!("shape: sphere(), transform: [scale(({sx}, {sy}, {sz}))]");
        let found = places(&strewn(Path::new(""), N, &carrier, ""));
        // Equal areas along y, by quadrature of the area element of a spheroid.
        let bands = 40;
        let steps = 100_000;
        let mut area = vec![0.0];
        for i in 0..steps {
            let y: f64 = (f64::from(i) + 0.5) / f64::from(steps) * 2.0 - 1.0;
            area.push(area[i as usize] + (sx * sx * y * y + sy * sy * (1.0 - y * y)).sqrt());
        }
        let total = area[steps as usize];
        let mut counts = vec![0.0; bands];
        for p in found {
            assert!((p / DVec3::new(sx, sy, sz)).length() - 1.0 < 1e-9);
            let at = area[((p.y / sy + 1.0) / 2.0 * f64::from(steps)) as usize] / total;
            counts[((at * bands as f64) as usize).min(bands - 1)] += 1.0;
        }
        // 39 degrees of freedom, 1 − 1e-4: 81.
        assert!(chi2(&counts) < 81.0, "{scale:?}: {}", chi2(&counts));
    }
}

/// Triangles of very different sizes: each gets its share.
#[test]
fn copies_fill_a_mesh_evenly_by_area() {
    let dir = folder();
    let vertices = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0), (4.1, 0.0), (4.1, 4.0)];
    Obj {
        vertices: vertices.map(|(x, z)| DVec3::new(x, 0.0, z)).to_vec(),
        normals: Vec::new(),
        faces: vec![vec![0, 2, 1], vec![0, 3, 2], vec![1, 2, 4], vec![4, 2, 5]],
    }
    .write(&dir.path().join("ground.obj"));
    let found = places(&strewn(dir.path(), N, r#"shape: mesh(path: "ground.obj")"#, ""));
    let (mut counts, mut strip) = ([0.0; 64], 0.0);
    for p in found {
        if p.x > 4.0 {
            strip += 1.0;
        } else {
            counts[(p.x * 2.0).clamp(0.0, 7.0) as usize * 8 + (p.z * 2.0).clamp(0.0, 7.0) as usize] += 1.0;
        }
    }
    assert!(chi2(&counts) < 113.0, "{}", chi2(&counts));
    let expected = f64::from(N) * 0.1 / 4.1;
    assert!((strip - expected).abs() < 4.0 * expected.sqrt(), "{strip} for {expected}");
}

/// Several pieces in a group share the copies by their areas.
#[test]
fn the_pieces_of_a_group_share_by_area() {
    let carrier = "shape: group(objects: [(shape: quad(size: (1, 1)), transform: [translate((-5, 0, 0))]), (shape: quad(size: (3, 1)), transform: [translate((5, 0, 0))])])";
    let found = places(&strewn(Path::new(""), N, carrier, ""));
    let left = found.iter().filter(|p| p.x < 0.0).count() as f64;
    let expected = f64::from(N) / 4.0;
    assert!((left - expected).abs() < 4.0 * (expected * 0.75).sqrt(), "{left} for {expected}");
}

#[test]
fn ground_too_steep_carries_nothing() {
    let found = places(&strewn(Path::new(""), 3000, "shape: sphere()", ", max_slope_deg: 30"));
    assert_eq!(found.len(), 3000);
    let cos = f64::to_radians(30.0).cos();
    assert!(found.iter().all(|p| p.y.abs() >= cos - 1e-9));
    // A wall carries nothing at all, and says so.
    let wall = strewn(
        Path::new(""),
        5,
        "shape: quad(), transform: [rotate(axis: (1, 0, 0), deg: 90)]",
        ", max_slope_deg: 30",
    );
    let error = wall.try_render().err().expect("no place on a wall").to_string();
    assert!(error.contains("30"), "{error}");
}

#[test]
fn the_seed_decides_the_places() {
    let with = |seed: u32| places(&strewn(Path::new(""), 100, "shape: quad()", &format!(", seed: {seed}")));
    assert!(with(1) == with(1));
    assert!(with(1) != with(2));
    // More copies leave the first ones where they are.
    let more = places(&strewn(Path::new(""), 200, "shape: quad()", ", seed: 1"));
    assert!(more[..100] == with(1)[..]);
}

/// Scales and turns keep to their ranges, and `align` stands copies on the normal.
#[test]
fn scales_and_alignment_are_as_asked() {
    let shot = strewn(Path::new(""), 500, "shape: sphere()", ", scale: (0.5, 2), align: 1");
    let world = world(&shot);
    let mut seen = [f64::INFINITY, 0.0];
    for instance in &world.instances {
        let m = instance.placement.world_from_object;
        let scale = m.matrix3.determinant().cbrt();
        seen = [seen[0].min(scale), seen[1].max(scale)];
        assert!((0.5 - 1e-12..=2.0 + 1e-12).contains(&scale));
        // The sphere's normal is its point, turned upwards.
        let p = m.translation + world.origin;
        let up = (m.matrix3 * DVec3::Y).normalize();
        assert!((up - p * p.y.signum()).length() < 1e-6, "{up} at {p}");
    }
    assert!(seen[0] < 0.55 && seen[1] > 1.9);
}

/// `over` an object that stands in the scene, through moved groups.
#[test]
fn copies_stand_where_the_carrying_object_stands() {
    let shot = shot(
        r#"(camera: (eye: (0, 5, 9), target: (1, 0, 0)), image: (width: 8, height: 8),
        materials: { "m": (diffuse: 0.5) }, definitions: { "dot": (shape: sphere(radius: 0.001), material: "m") },
        objects: [
            (name: "table", shape: group(objects: [(shape: quad(size: (2, 2)), material: "m", transform: [translate((0, 1, 0))])]), transform: [scale((1, 3, 2)), translate((10, 0, 0))]),
            (shape: scatter(of: ["dot"], over: "table", count: 500), transform: [rotate(axis: (0, 1, 0), deg: 30), translate((5, 6, 7))]),
        ])"#,
    );
    let all = places(&shot);
    assert_eq!(all.len(), 501);
    for p in &all[1..] {
        assert!(
            (p.x - 10.0).abs() <= 1.0 + 1e-9 && (p.y - 3.0).abs() < 1e-9 && p.z.abs() <= 2.0 + 1e-9,
            "{p}"
        );
    }
}

/// A thousand copies of a mesh are stored once, and each is seen.
#[test]
fn a_thousand_copies_share_their_triangles() {
    let dir = folder();
    icosphere(2).write(&dir.path().join("ball.obj"));
    let scene = |count: u32| {
        shot(format!(
            r#"(camera: (eye: (0, 30, 0.01), target: (0, 0, 0), fov_deg: 40), image: (width: 64, height: 64),
            materials: {{ "m": (emission: 1) }}, definitions: {{ "ball": (shape: mesh(path: "ball.obj"), material: "m", transform: [scale(0.05)]) , "ground": (shape: quad(size: (18, 18))) }},
            objects: [(shape: scatter(of: ["ball"], over: "ground", count: {count}))])"#
        ))
        .folder(dir.path())
        .passes(16)
        .render()
    };
    let (one, many) = (scene(1), scene(1000));
    let (a, b) = (&one.rendered.stats, &many.rendered.stats);
    assert_eq!(a.scene.triangles, 320);
    assert_eq!(b.scene.triangles, 320);
    assert_eq!(b.scene.instances, 1000);
    assert!(
        b.memory.geometry_bytes < a.memory.geometry_bytes + 1000 * 1000,
        "{} and {}",
        a.memory.geometry_bytes,
        b.memory.geometry_bytes
    );
    // Almost none hides another: a thousand times the light, less overlap.
    let ratio = many.mean() / one.mean();
    assert!((800.0..1200.0).contains(&ratio), "{ratio}");
}
