//! Triangles that rays slip between, meet edge-on, or that are no triangles.

use super::record::{Record, row, sized};
use crate::render::glass::{GLASS, unevenness};
use crate::render::meshes::{Obj, cube, folder, icosphere};
use crate::render::shot::{agreement, shot};
use terrarium::build::bvh::{BoxRay, TriangleBvh};
use terrarium::math::random::{Counter, Stage};
use terrarium::math::{DVec3, Vec3};

/// In [-1, 1)³.
fn anywhere(counter: &mut Counter) -> Vec3 {
    Vec3::from_array([0; 3].map(|_| (2.0 * counter.value() - 1.0) as f32))
}

/// Where single precision resolves a sixty-fourth of a metre only.
const PLACE: DVec3 = DVec3::new(148_376.0, 1234.0, -223_423.0);

#[test]
fn h05_mesh_cracks() {
    row("H5", |row| {
        let sphere = icosphere(4).scaled(2.0);
        let vertices: Vec<Vec3> = sphere.vertices.iter().map(|v| (*v + PLACE).as_vec3()).collect();
        let triangles: Vec<[u32; 3]> =
            sphere.faces.iter().map(|f| [f[0], f[1], f[2]].map(|v| v as u32)).collect();
        let tree = TriangleBvh::build(&vertices, &triangles);
        let edges = triangles.iter().flat_map(|t| (0..3).map(|k| (t[k], t[(k + 1) % 3])));
        let middles = edges.map(|(a, b)| 0.5 * vertices[a as usize] + 0.5 * vertices[b as usize]);
        let aims: Vec<Vec3> = vertices.iter().copied().chain(middles).collect();
        let mut random = Counter::new(5, Stage::Test, 0);
        let (mut missed, rays) = (0, aims.len() + sized(100_000, 1_000_000));
        for i in 0..rays {
            // From the middle at first, then from anywhere near it; every third ray goes anywhere.
            let from = if i < aims.len() { DVec3::ZERO } else { anywhere(&mut random).as_dvec3() * 0.7 };
            let origin = (PLACE + from).as_vec3();
            let free = i >= aims.len() && i % 3 == 0;
            let dir = if free { anywhere(&mut random) } else { aims[i % aims.len()] - origin };
            let ray = BoxRay::new(origin, Vec3::ZERO, dir);
            let met = tree.nearest(&ray, f32::INFINITY).is_some() && tree.any(&ray, f32::INFINITY);
            missed += u64::from(!met);
        }
        row.none(
            "rays that leave a closed mesh of radius 2 m at (148376, 1234, −223423)",
            missed,
            rays as u64,
        );
        seen_from_within(row);
    });
}

/// An even sky around a closed black mesh, seen from within.
fn seen_from_within(row: &mut Record) {
    let dir = folder();
    icosphere(4).write(&dir.path().join("ball.obj"));
    let side = sized(200, 1000);
    let (mut bright, mut pixels) = (0, 0);
    for place in ["scale(1)", "scale((1e-3, 1e3, 1))", "scale(2), translate((148376, 1234, -223423))"] {
        let far = place.contains("148376");
        let eye = if far { "(148376, 1234, -223423)" } else { "(0, 0, 0)" };
        let target = if far { "(148376.3, 1234.1, -223422)" } else { "(0.3, 0.1, 1)" };
        let picture = shot(format!(
            r#"(camera: (eye: {eye}, target: {target}, fov_deg: 150), image: (width: {side}, height: {side}), antialiasing: none,
            background: 1, materials: {{ "black": () }},
            objects: [(shape: mesh(path: "ball.obj"), material: "black", transform: [{place}])])"#
        ))
        .folder(dir.path())
        .render();
        bright += picture.grey().iter().filter(|x| **x != 0.0).count() as u64;
        pixels += picture.grey().len() as u64;
    }
    row.none("pixels that see a bright sky from within closed black meshes", bright, pixels);
}

#[test]
fn h06_false_hits() {
    row("H6", |row| {
        let mut random = Counter::new(6, Stage::Test, 0);
        let (mut hits, mut worst, mut outside) = (0, 0.0f64, 0.0f64);
        for case in 0..sized(400, 8_000) {
            let place = if case % 2 == 0 { Vec3::ZERO } else { anywhere(&mut random) * 1e5 };
            let size = [1e-3, 1.0, 100.0][case % 3];
            let mut vertices = Vec::new();
            for _ in 0..64 {
                let (a, along) = (anywhere(&mut random) * size, anywhere(&mut random) * size);
                let thin = anywhere(&mut random) * size * [1.0, 1e-3, 1e-6][random.bits() as usize % 3];
                let end = a + along * random.value() as f32 + thin;
                vertices.extend([a, a + along, end].map(|v| v + place));
            }
            let triangles: Vec<[u32; 3]> = (0..64).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
            let tree = TriangleBvh::build(&vertices, &triangles);
            for i in 0..300 {
                let t = (i % 64) * 3;
                let origin =
                    if i % 3 == 0 { vertices[t] } else { place + anywhere(&mut random) * size * 2.0 };
                let [u, v] = random.pair().map(|u| u as f32);
                let aim = vertices[t] * (1.0 - u) + (vertices[t + 1] * (1.0 - v) + vertices[t + 2] * v) * u;
                let dir = if aim == origin { anywhere(&mut random) } else { aim - origin };
                let Some(hit) = tree.nearest(&BoxRay::new(origin, Vec3::ZERO, dir), f32::INFINITY) else {
                    continue;
                };
                hits += 1;
                let corners = triangles[hit.triangle as usize].map(|v| vertices[v as usize].as_dvec3());
                let on_ray = origin.as_dvec3() + dir.as_dvec3() * f64::from(hit.t);
                let on_triangle: DVec3 = corners.iter().zip(hit.b).map(|(v, b)| *v * f64::from(b)).sum();
                let largest = corners.iter().fold(0.0f64, |m, v| m.max(v.length()));
                let bound = 32.0 * f64::from(f32::EPSILON) * (origin.as_dvec3().length() + largest);
                worst = worst.max(on_ray.distance(on_triangle) / bound);
                let sum = hit.b.iter().map(|b| f64::from(*b)).sum::<f64>();
                outside = outside.max((sum - 1.0).abs());
                outside = hit.b.iter().fold(outside, |most, b| most.max(f64::from(-b)));
            }
        }
        row.at_least("hits on needles, along and across, near and far", f64::from(hits), sized(5e4, 1e6));
        row.at_most("‖(o + t·d) − Σ bᵢvᵢ‖ over 32 ε (‖o‖ + ‖v‖max), ε that of single precision", worst, 1.0);
        row.at_most("barycentrics: how far below 0, or their sum from 1", outside, 1e-6);
    });
}

#[test]
fn h07_rays_through_edges() {
    row("H7", |row| {
        let (mut mean, mut pixel) = (0.0f64, 0.0f64);
        let dir = folder();
        cube().scaled(0.5).write(&dir.path().join("cube.obj"));
        // With `up` along y whole rows, columns and diagonals of pixels see edges, rims and the planes between
        // them exactly, and rays inside run along those planes from one to the other.
        let eyes = ["(3, 3, 3)", "(3, 3, 0)", "(4, 0, 0)", "(3, 0, 3)"];
        let views = eyes.into_iter().flat_map(|eye| ["(0.1, 1, 0.2)", "(0, 1, 0)"].map(|up| (eye, up)));
        let shapes = [
            "box()",
            r#"mesh(path: "cube.obj", smooth: false)"#,
            "polyhedron(kind: tetrahedron)",
            "cone(radius: 0.5, height: 1)",
        ];
        for ((eye, up), shape) in views.flat_map(|view| shapes.map(|shape| (view, shape))) {
            let camera = format!("(eye: {eye}, target: (0, 0, 0), up: {up}, fov_deg: 30)");
            let scene = format!(
                r#"(camera: {camera}, image: (width: 25, height: 25), antialiasing: none, render: (max_depth: 1000),
                materials: {{ {GLASS} }}, lights: {{ "sky": environment(map: constant(1)) }},
                objects: [(shape: {shape}, material: "glass")])"#
            );
            let shot = shot(scene).folder(dir.path());
            let (of_mean, of_each) = unevenness(&shot.passes(sized(8, 128)).render(), 1.0);
            (mean, pixel) = (mean.max(of_mean), pixel.max(of_each));
        }
        row.at_most("a glass cube, as a box and as a mesh, a tetrahedron and a cone, seen through edges, rims and corners in an even sky: mean off 1", mean, 2e-4);
        row.at_most("the worst pixel off 1", pixel, sized(0.01, 0.005));
    });
}

#[test]
fn h10_degenerate_triangles() {
    row("H10", |row| {
        let dir = folder();
        let ball = icosphere(2);
        ball.write(&dir.path().join("sound.obj"));
        let mut broken = ball;
        let n = broken.vertices.len();
        for i in 0..1000 {
            let (a, b) = (i % n, (i * 7 + 1) % n);
            // The same corner twice; two corners in one place; three in a row.
            let at = broken.vertices[a];
            let next = broken.vertices.len();
            match i % 4 {
                0 => broken.faces.push(vec![a, a, b]),
                1 => broken.faces.push(vec![a, b, b]),
                2 => {
                    broken.vertices.push(at);
                    broken.faces.push(vec![a, next, b]);
                }
                _ => {
                    broken.vertices.extend([0.25, 0.5].map(|step| at - DVec3::X * (at.x * step)));
                    broken.faces.push(vec![a, next, next + 1]);
                }
            }
        }
        broken.normals.resize(broken.vertices.len(), DVec3::Y);
        broken.write(&dir.path().join("broken.obj"));
        let view = |name: &str| {
            shot(format!(
                r#"(camera: (eye: (0, 2, 4), target: (0, 0, 0)), image: (width: 32, height: 32), antialiasing: none,
                materials: {{ "white": (diffuse: 1), "glass": (transmission: 1) }}, lights: {{ "sun": directional(direction: (-1, -1, -1), irradiance: 1) }},
                objects: [(shape: mesh(path: "{name}"), material: "white"), (shape: mesh(path: "{name}"), material: "glass", transform: [translate((1.5, 0, 0))])])"#
            ))
            .folder(dir.path())
            .render()
        };
        let (sound, broken) = (view("sound.obj"), view("broken.obj"));
        let differ = sound.bits().iter().zip(broken.bits()).filter(|(a, b)| **a != *b).count() as u64;
        row.none(
            "values that 1,000 degenerate triangles change in a picture",
            differ,
            sound.bits().len() as u64,
        );
        let warning =
            broken.rendered.warnings.iter().find(|w| w.contains("degenerate")).cloned().unwrap_or_default();
        row.says("what is said of them", &in_folder(&warning, dir.path()), "1000 degenerate triangles");
        for vertex in ["nan 0 0", "0 inf 0", "1e999 0 0"] {
            let path = dir.path().join("none.obj");
            std::fs::write(&path, format!("v 0 0 0\nv {vertex}\nv 0 1 0\nf 1 2 3\n")).expect("written");
            let error = terrarium::build::obj::load(&path).err().map(|e| e.to_string()).unwrap_or_default();
            row.says(
                &format!("what is said of a vertex at {vertex}"),
                &in_folder(&error, dir.path()),
                "none.obj:2: ",
            );
        }
    });
}

/// The message without the temporary folder's name.
fn in_folder(message: &str, folder: &std::path::Path) -> String {
    message.replace(&format!("{}/", folder.display()), "")
}

#[test]
fn h11_missing_normals() {
    row("H11", |row| {
        let dir = folder();
        let mut ball = icosphere(1);
        ball.normals.iter_mut().for_each(|n| *n = DVec3::ZERO);
        ball.write(&dir.path().join("ball.obj"));
        let view = |smooth: bool| {
            shot(format!(
                r#"(camera: (eye: (0, 2, 4), target: (0, 0, 0)), image: (width: 32, height: 32), antialiasing: none,
                materials: {{ "white": (diffuse: 1) }}, lights: {{ "sun": directional(direction: (-1, -1, -1), irradiance: 1) }},
                objects: [(shape: mesh(path: "ball.obj", smooth: {smooth}), material: "white")])"#
            ))
            .folder(dir.path())
            .render()
        };
        let (zero, flat) = (view(true), view(false));
        row.holds(
            "a mesh of zero normals is finite and not negative, and is lit",
            zero.is_sound() && flat.mean() > 0.02,
        );
        let pixels = flat.grey().len() as u64;
        let same = (agreement(&zero, &flat, 1e-5) * pixels as f64).round() as u64;
        row.all("pixels that are those of flat triangles, to 1e-5", same, pixels);
        some_missing(row);
    });
}

/// A smooth ball of which one corner of every second triangle has no usable normal, against the same ball with the
/// triangle's own normals there.
fn some_missing(row: &mut Record) {
    let dir = folder();
    let ball = icosphere(1);
    let with = |own: Option<DVec3>| {
        let mut apart = Obj { vertices: Vec::new(), normals: Vec::new(), faces: Vec::new() };
        for (i, face) in ball.faces.iter().enumerate() {
            let corners: Vec<DVec3> = face.iter().map(|&v| ball.vertices[v]).collect();
            let flat = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
            let first = apart.vertices.len();
            apart.faces.push((first..first + 3).collect());
            apart.vertices.extend(&corners);
            apart.normals.extend(corners.iter().map(|p| p.normalize()));
            if i % 2 == 0 {
                apart.normals[first + i % 3] = own.unwrap_or(flat);
            }
        }
        apart.write(&dir.path().join("ball.obj"));
        shot(
            r#"(camera: (eye: (0, 2, 4), target: (0, 0, 0)), image: (width: 64, height: 64), antialiasing: none,
            materials: { "white": (diffuse: 1), "glass": (transmission: 1) }, lights: { "sun": directional(direction: (-1, -1, -1), irradiance: 1), "sky": environment(map: gradient(zenith: 1, horizon: 0.5, nadir: 0)) },
            objects: [(shape: mesh(path: "ball.obj"), material: "white"), (shape: mesh(path: "ball.obj"), material: "glass", transform: [translate((1.5, 0, 0))])])"#,
        )
        .folder(dir.path())
        .render()
    };
    let flat = with(None);
    let pixels = flat.grey().len() as u64;
    for (what, none) in [
        ("zero", DVec3::ZERO),
        ("NaN", DVec3::NAN),
        ("infinite", DVec3::new(f64::INFINITY, 0.0, 1.0)),
        ("minus zero", -DVec3::ZERO),
    ] {
        let picture = with(Some(none));
        let same = (agreement(&picture, &flat, 1e-4) * pixels as f64).round() as u64;
        let what = format!("some normals of a smooth ball are {what}: pixels as with their triangles' own");
        row.all(&what, if picture.is_sound() { same } else { 0 }, pixels);
    }
}
