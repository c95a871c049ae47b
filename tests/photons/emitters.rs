//! Objects that shine: meshes, textured ones, and lamps in glass and water.

use super::direct::{FLOOR, assert_irradiance, piece};
use super::lab::{Lab, lab, lab_in, power};
use crate::render::meshes::{cube, folder, icosphere};
use std::f64::consts::PI;
use terrarium::math::DVec3;
use terrarium::scatter::{Aim, Store};

/// By midpoints of the triangles, each in 16; convex and closed, so that what faces away is hidden.
#[test]
fn a_mesh_that_shines_lights_a_floor_as_its_triangles_do() {
    let dir = folder();
    let at = DVec3::new(0.3, 2.0, 0.2);
    for (mesh, scale, smooth) in [(icosphere(1), 0.6, true), (cube(), 0.4, false)] {
        mesh.write(&dir.path().join("lamp.obj"));
        let lamp = format!(
            r#"{FLOOR}, (shape: mesh(path: "lamp.obj", smooth: {smooth}), material: "lamp",
            transform: [scale({scale}), translate(({}, {}, {}))])"#,
            at.x, at.y, at.z
        );
        let scene = lab_in(dir.path(), "", r#""lamp": (diffuse: 0, emission: 5)"#, "", &lamp);
        let triangles: Vec<[DVec3; 3]> = mesh
            .faces
            .iter()
            .flat_map(|f| (2..f.len()).map(|i| [f[0], f[i - 1], f[i]]))
            .map(|t| t.map(|i| at + mesh.vertices[i] * scale))
            .collect();
        let pieces: Vec<([f64; 3], [f64; 3], f64)> = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let across = (b - a).cross(c - a);
                let n = 4;
                let mut parts = Vec::new();
                for i in 0..n {
                    for j in 0..n - i {
                        let third = 1.0 / (3 * n) as f64;
                        let (u, v) = (i as f64 / n as f64, j as f64 / n as f64);
                        parts.push((u + third, v + third));
                        if i + j < n - 1 {
                            parts.push((u + 2.0 * third, v + 2.0 * third));
                        }
                    }
                }
                let area = across.length() / 2.0 / parts.len() as f64;
                parts.into_iter().map(move |(u, v)| {
                    ((a + (b - a) * u + (c - a) * v).to_array(), across.normalize().to_array(), area)
                })
            })
            .collect();
        assert_irradiance(&scene, [1.0, 0.5], |x, z| {
            5.0 * pieces.iter().map(|&(q, n, area)| piece(q, n, area, x, z)).sum::<f64>()
        });
    }
}

/// All that arrives in a white room around it.
fn assert_power(scene: &Lab, store: Store, expected: f64) {
    let aim = if store == Store::Caustics { Aim::Casters } else { Aim::Scene };
    let found = power(&scene.passes(store, aim, 24, 40_000), |_| true);
    println!("{found:?}, expected {expected}");
    assert!((found.mean - expected).abs() < 3.0 * found.error + 1e-6 * expected, "{found:?}, {expected}");
    assert!(found.error < 4e-3 * expected, "{found:?}");
}

const ROOM: &str = r#"(shape: sphere(radius: 8), material: "white")"#;
const CHECKS: &str = r#"textures: { "checks": checker(a: 0, b: 4, squares: (2, 2)) },"#;

/// A lamp whose squares are dark and bright in turn sends half of what a bright one would.
#[test]
fn a_textured_lamp_emits_its_mean() {
    let lamp = r#""lamp": (emission: texture(name: "checks", scale: 0.5))"#;
    let none = std::path::Path::new("");
    let quad = format!(r#"{ROOM}, (shape: quad(size: (2, 1)), material: "lamp")"#);
    assert_power(&lab_in(none, CHECKS, lamp, "", &quad), Store::Direct, PI * 2.0 * 2.0 * 1.0);
    let ball = format!(r#"{ROOM}, (shape: sphere(radius: 0.5), material: "lamp")"#);
    assert_power(&lab_in(none, CHECKS, lamp, "", &ball), Store::Direct, PI * PI);
}

#[test]
fn a_textured_lamp_shines_where_its_texture_does() {
    let lamp = format!(
        r#"{FLOOR}, (shape: quad(size: (2, 1.6)), material: "lamp", transform: [translate((0.4, 1.2, 0))])"#
    );
    let scene = lab_in(
        std::path::Path::new(""),
        CHECKS,
        r#""lamp": (diffuse: 0, emission: texture("checks"))"#,
        "",
        &lamp,
    );
    assert_irradiance(&scene, [0.9, 0.6], |x, z| {
        let n = 40;
        let middle = |i: usize| (i as f64 + 0.5) / n as f64 - 0.5;
        let mut sum = 0.0;
        for i in 0..n * n {
            let (u, w) = (middle(i / n), middle(i % n));
            // The square at (u, v) = (0, 0) is dark; v grows along −z.
            let bright = (u > 0.0) != (w < 0.0);
            if bright {
                sum +=
                    4.0 * piece([0.4 + 2.0 * u, 1.2, 1.6 * w], [0.0, -1.0, 0.0], 3.2 / (n * n) as f64, x, z);
            }
        }
        sum
    });
}

/// None of it is caught: within 1/n of the radius no direction is reflected totally.
#[test]
fn what_a_lamp_in_glass_emits_leaves_the_glass() {
    let ball = format!(r#"{ROOM}, (shape: sphere(), material: "glass")"#);
    let point = r#""a": point(position: (0.3, 0.2, 0), intensity: 2)"#;
    assert_power(&lab("", point, &ball), Store::Caustics, 8.0 * PI);
    let hidden = r#""a": sphere(center: (0.1, 0, 0.2), radius: 0.3, radiance: 5, visible: false)"#;
    assert_power(&lab("", hidden, &ball), Store::Caustics, 5.0 * PI * 4.0 * PI * 0.09);
}

/// Beer and Lambert over the radius, and again on each way to and fro after a reflection.
#[test]
fn what_a_lamp_in_murky_water_emits_is_dimmed_on_its_way_out() {
    let ball = format!(r#"{ROOM}, (shape: sphere(), material: "murk")"#);
    let scene = lab(
        r#""murk": (transmission: 1, ior: 1.33, absorption: 0.7)"#,
        r#""a": point(position: (0, 0, 0), intensity: 2)"#,
        &ball,
    );
    let (r, t) = ((0.33f64 / 2.33).powi(2), (-0.7f64).exp());
    assert_power(&scene, Store::Caustics, 8.0 * PI * (1.0 - r) * t / (1.0 - r * t * t));
}

/// A lamp half in ink: what starts in the ink ends there; three quarters of the other half go up.
#[test]
fn a_lamp_that_cuts_a_surface_emits_in_both_media() {
    let objects = format!(r#"{ROOM}, (shape: box(size: (2, 1, 2), center: (0, -0.5, 0)), material: "ink")"#);
    let ink = r#""ink": (transmission: 1, ior: 1, absorption: 1000)"#;
    let scene = lab(ink, r#""a": sphere(center: (0, 0, 0), radius: 0.05, radiance: 5)"#, &objects);
    let passes = scene.passes(Store::Direct, Aim::Scene, 24, 10_000);
    let all = 5.0 * PI * 4.0 * PI * 0.0025;
    // Just below the horizontal, some get past the edge of the ink.
    let up = power(&passes, |p| p.wi.y < 0.0);
    assert!((up.mean / all - 0.375).abs() < 3.0 * up.error / all && up.error < 4e-3 * all, "{up:?} of {all}");
    assert_eq!(power(&passes, |p| p.wi.y > 0.1).mean, 0.0);
}
