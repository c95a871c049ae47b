//! Shading normals and the axes of maps.

use super::record::{Record, row, sized};
use super::solids::{solids, unit};
use crate::photons::bent;
use crate::render::meshes::{Obj, folder, icosphere, write_exr};
use crate::render::shot::shot;
use crate::render::textures::{shelf, shelf_folder};
use std::path::Path;
use terrarium::math::random::{Counter, Stage};
use terrarium::math::{Color, DVec3, Frame, Ray};
use terrarium::optics::texture::perturbed_normal_from_map;
use terrarium::optics::{LocalSurface, Shape, Sphere};
use terrarium::render::Aov;

fn is_usable(at: &LocalSurface) -> bool {
    let frame = Frame::with_tangent(at.ns, at.dpdu);
    let orthonormal = frame.s.dot(frame.n).abs() < 1e-12
        && (frame.s.length() - 1.0).abs() < 1e-12
        && frame.s.cross(frame.t).distance(frame.n) < 1e-12;
    let within = (0.0..=1.0).contains(&at.uv.x) && (0.0..=1.0).contains(&at.uv.y);
    at.p.is_finite() && at.dpdu.is_finite() && at.dpdv.is_finite() && orthonormal && within
}

/// The normal under the map (0.5, 0.5, 1).
fn flat(at: &LocalSurface) -> DVec3 {
    perturbed_normal_from_map(Color::new(0.5, 0.5, 1.0), 1.0, at.ns, at.dpdu, at.dpdv)
}

/// Calls `each` with the surface that a line through the middle of a shape meets.
fn look_at(shape: &Shape, dir: DVec3, each: &mut impl FnMut(&LocalSurface)) {
    let (min, max) = shape.bounds();
    let ray = Ray { origin: DVec3::new(0.0, 0.5 * (min + max).y, 0.0) - dir * 4.0, dir };
    if let Some(hit) = shape.nearest(&ray, 0.0, f64::INFINITY) {
        each(&shape.surface(&ray, hit));
    }
}

#[test]
fn s07_normal_map_axes() {
    row("S7", |row| {
        let (mut broken, mut moved, mut points) = (0, 0, 0);
        let mut look = |at: &LocalSurface| {
            broken += u64::from(!is_usable(at));
            moved += u64::from(flat(at) != at.ns);
            points += 1;
        };
        // On poles, seams and the three coordinate circles, and as near to them as numbers get.
        let steps = [0.0, -0.0, 5e-324, 1e-300, 1e-160, 1e-17, 1e-9, 1.0];
        let signed: Vec<f64> = steps.iter().flat_map(|&s| [s, -s]).collect();
        let sphere = Shape::Sphere(Sphere::new(1.0, DVec3::ZERO));
        for shape in solids(1.0).iter().chain([&sphere]) {
            for (&x, &y) in signed.iter().flat_map(|x| signed.iter().map(move |y| (x, y))) {
                for &z in &signed {
                    if let Some(dir) = DVec3::new(x, y, z).try_normalize() {
                        look_at(shape, dir, &mut look);
                    }
                }
            }
        }
        let mut random = Counter::new(7, Stage::Test, 0);
        for _ in 0..sized(100_000, 1_000_000) {
            look_at(&sphere, unit(&mut random), &mut look);
        }
        row.none(
            "points, on the circles x = 0, y = 0, z = 0 and all over, without an orthonormal frame",
            broken,
            points,
        );
        row.none("points at which the map (0.5, 0.5, 1) changes a bit of the normal", moved, points);
    });
}

#[test]
fn h20_shadow_terminator() {
    row("H20", |row| {
        let dir = folder();
        let side = sized(64, 256);
        let view = |shape: &str| {
            shot(format!(
                r#"(camera: (eye: (0, 0, 9), target: (0, 0, 0), fov_deg: 13), image: (width: {side}, height: {side}), antialiasing: none,
                materials: {{ "white": (diffuse: 1) }}, lights: {{ "sun": directional(direction: (-1, 0, 0), irradiance: 3.1415926535) }},
                objects: [(shape: {shape}, material: "white", transform: [rotate(axis: (1, 2, 3), deg: 10)])])"#
            ))
            .folder(dir.path())
            .aovs(&[Aov::Albedo])
            .render()
        };
        let sphere = view("sphere()").grey();
        let (mut black, mut lit) = (0, 0);
        let errors: Vec<f64> = (1..4)
            .map(|n| {
                let name = format!("ball{n}.obj");
                icosphere(n).write(&dir.path().join(&name));
                let mesh = view(&format!(r#"mesh(path: "{name}")"#));
                let is_mesh: Vec<bool> = mesh.channel("albedo", "R").iter().map(|a| *a > 0.0).collect();
                let mesh = mesh.grey();
                let (mut sum, mut count) = (0.0, 0);
                for (i, (a, b)) in sphere.iter().zip(mesh).enumerate() {
                    // Its outline is not the sphere's.
                    if !is_mesh[i] {
                        continue;
                    }
                    lit += u64::from(*a > 0.05);
                    black += u64::from(*a > 0.05 && b == 0.0);
                    sum += (a - b).abs();
                    count += 1;
                }
                sum / f64::from(count)
            })
            .collect();
        row.none(
            "black pixels of smooth meshes of 80 to 1280 triangles where the sphere has n·l > 0.05",
            black,
            lit,
        );
        row.at_least("by what the mean error falls from 80 to 320 triangles", errors[0] / errors[1], 3.0);
        row.at_least("and from 320 to 1280", errors[1] / errors[2], 3.0);
    });
}

/// A plane of two triangles, normals tilted by 45° towards +x.
fn tilted_plane() -> Obj {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    Obj {
        vertices: corners.map(|(x, z)| DVec3::new(x, 0.0, z)).to_vec(),
        normals: vec![DVec3::new(1.0, 1.0, 0.0).normalize(); 4],
        faces: vec![vec![0, 3, 2, 1]],
    }
}

#[test]
fn h21_tilted_normals() {
    row("H21", |row| {
        let dir = folder();
        tilted_plane().write(&dir.path().join("plane.obj"));
        let (mut lit, mut pixels) = (0, 0);
        for light in [
            "directional(direction: (-1, 0.5, 0), irradiance: 1)",
            "directional(direction: (-1, 0.01, 0.3), irradiance: 1)",
            "point(position: (3, -0.5, 0), intensity: 9)",
            "point(position: (1.5, -0.001, 0), intensity: 9)",
            "sphere(center: (2, -0.6, 0), radius: 0.5, radiance: 9, visible: false)",
        ] {
            let picture = shot(format!(
                r#"(camera: (eye: (0, 3, 0), target: (0, 0, 0), up: (0, 0, 1), fov_deg: 40), image: (width: 65, height: 65), antialiasing: none,
                materials: {{ "white": (diffuse: 1) }}, lights: {{ "lamp": {light} }},
                objects: [(shape: mesh(path: "plane.obj"), material: "white")])"#
            ))
            .folder(dir.path())
            .passes(4)
            .render();
            lit += picture.grey().iter().filter(|x| **x != 0.0).count() as u64;
            pixels += picture.grey().len() as u64;
        }
        row.none("lit pixels of a plane with normals tilted by 45°, five lights behind it", lit, pixels);
        both_ways(row, dir.path());
    });
}

/// What a mirror of tilted normals, and a coarse smooth ball of glass, throw onto a floor, by photons and by
/// eye paths that look for the sky in them.
fn both_ways(row: &mut Record, folder: &Path) {
    icosphere(2).write(&folder.join("ball.obj"));
    let ball = r#"(shape: mesh(path: "ball.obj"), material: "glass", transform: [scale(0.6), translate((0, 1.1, 0))])"#;
    let mapped = r#""mapped": (reflection: 1, normal_map: (texture: "tilts"))"#;
    let cases = [
        ("a mirror with a normal map", bent::TILTS, mapped, bent::mirror("mapped")),
        ("a smooth ball of 320 triangles", "", "", ball.to_owned()),
    ];
    for (name, more, materials, caster) in cases {
        let (photons, error) = bent::by_photons(folder, more, materials, &caster, sized(24, 150));
        let paths = bent::by_paths(folder, more, materials, &caster);
        // Paths are added up from nine points and 96 × 96 directions: half a per cent, by which the ball was off when
        // photons' σ was a thirtieth of that.
        let what = format!("irradiance by photons under {name}: that by paths (3σ and 0.5 %)");
        row.is(&what, photons, paths, 3.0 * error + 5e-3 * paths);
        row.at_most("σ of that as a share", error / paths, sized(0.03, 0.015));
    }
}

#[test]
fn h22_flat_normal_maps() {
    row("H22", |row| {
        let dir = shelf_folder();
        write_exr(&dir.path().join("flat.exr"), 4, 4, |_, _| [0.5, 0.5, 1.0]);
        let image = r#""flat": image(path: "flat.exr"), "tiles": checker(a: 0.5, b: 0.5, squares: (4, 4))"#;
        let (mut differ, mut values) = (0, 0);
        for layers in ["diffuse: 0.7, specular: 0.2", "reflection: 1"] {
            let plain = shelf(layers, "", dir.path()).render();
            assert!(plain.mean() > 0.05, "there is something to see");
            for relief in [
                r#"normal_map: (texture: "flat")"#,
                r#"normal_map: (texture: "flat", strength: 7)"#,
                r#"bump_map: (texture: "flat", height_m: 3)"#,
                r#"bump_map: (texture: "tiles", height_m: 3)"#,
            ] {
                let mapped = shelf(&format!("{layers}, {relief}"), image, dir.path()).render();
                differ += plain.bits().iter().zip(mapped.bits()).filter(|(a, b)| **a != *b).count() as u64;
                values += plain.bits().len() as u64;
            }
        }
        row.none(
            "values that flat maps change in pictures of 16 shapes, a third of them mirrored",
            differ,
            values,
        );
        strong_maps(row, dir.path());
    });
}

/// Poles and seams included: finite, and not black where lit.
fn strong_maps(row: &mut Record, folder: &Path) {
    write_exr(&folder.join("wild.exr"), 16, 16, |x, y| {
        [(x * 5 % 16) as f32 / 15.0, (y * 7 % 16) as f32 / 15.0, ((x + y) % 3) as f32 / 4.0]
    });
    let image = r#""wild": image(path: "wild.exr"), "noise": noise(a: 0, b: 1, size_m: 0.1)"#;
    let (mut unsound, mut dropped, mut black, mut pixels) = (0, 0, 0, 0);
    for relief in
        [r#"normal_map: (texture: "wild", strength: 10)"#, r#"bump_map: (texture: "noise", height_m: 5)"#]
    {
        for layers in ["diffuse: 0.7", "reflection: 0.9", "transmission: 1", "specular: 0.9, shininess: 1000"]
        {
            let shot = shelf(&format!("{layers}, {relief}"), image, folder);
            let picture = shot.passes(16).aovs(&[Aov::ObjectId]).render();
            unsound += u64::from(!picture.is_sound());
            dropped += picture.rendered.stats.rare_events[0].count;
            if layers == "diffuse: 0.7" {
                // The ambient term alone gives 0.007.
                let ids = picture.channel("object_id", "Y");
                let seen = || picture.grey().into_iter().zip(ids).filter(|(_, id)| **id != 0.0);
                black += seen().filter(|(x, _)| *x < 0.008).count() as u64;
                pixels += seen().count() as u64;
            }
        }
    }
    row.none("pictures with maps of ten times the strength that are not finite", unsound, 8);
    row.is("samples dropped in them", dropped as f64, 0.0, 0.0);
    row.none("pixels of seen and lit surfaces that are black", black, pixels);
}
