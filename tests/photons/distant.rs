//! Distant lights: what falls on a scene from a direction, and from every direction of a sky.

use super::directions::assert_travels;
use super::lab::{lab, lab_in};
use crate::render::meshes::{folder, write_exr};
use std::f64::consts::PI;
use std::path::Path;
use terrarium::math::DVec3;
use terrarium::scatter::{Aim, Store};

/// A ball of radius 1 shows the same disc to every direction: its share of a direction is π·L.
const BALL: &str = r#"(shape: sphere(), material: "white")"#;

fn assert_sky(folder: &Path, map: &str) {
    let scene = lab_in(folder, "", "", &format!(r#""sky": environment({map})"#), BALL);
    let sky = scene.world.environment.as_ref().expect("the scene has one");
    assert_travels(&scene, |dir| PI * f64::from(sky.radiance(-dir).x));
}

#[test]
fn a_sky_of_one_bright_block_sends_its_light_from_there() {
    let dir = folder();
    let bright = |x: usize, y: usize| (9..11).contains(&x) && (2..4).contains(&y);
    write_exr(&dir.path().join("sky.exr"), 16, 8, |x, y| [if bright(x, y) { 50.0 } else { 1.0 }; 3]);
    assert_sky(dir.path(), r#"map: image(path: "sky.exr")"#);
    assert_sky(dir.path(), r#"map: image(path: "sky.exr"), scale: 0.5, turn_deg: 77"#);
}

#[test]
fn a_gradient_sends_its_light_by_height() {
    assert_sky(Path::new(""), "map: gradient(zenith: 5, horizon: 1, nadir: 0.2)");
}

#[test]
fn a_directional_light_is_even_and_of_one_direction() {
    let floor = r#"(shape: quad(size: (4, 4)), material: "white")"#;
    let sun = DVec3::new(1.0, -2.0, 0.5);
    let scene = lab("", r#""sun": directional(direction: (1, -2, 0.5), irradiance: 3)"#, floor);
    let pass = &scene.passes(Store::Direct, Aim::Scene, 1, 150_000)[0];
    let n = 12;
    let mut sums = vec![[0.0; 2]; n * n];
    for photon in pass.photons.iter() {
        assert!((photon.wi.as_dvec3() + sun.normalize()).length() < 1e-6);
        let p = scene.place(photon);
        let bin = |x: f64| (((x + 2.0) / 4.0 * n as f64) as usize).min(n - 1);
        let power = f64::from(photon.power.x);
        let sum = &mut sums[bin(p.x) * n + bin(p.z)];
        *sum = [sum[0] + power, sum[1] + power * power];
    }
    let power: f64 = sums.iter().map(|s| s[0]).sum();
    let expected = power / (n * n) as f64;
    let chi2: f64 = sums.iter().map(|[sum, squares]| (sum - expected).powi(2) / squares).sum();
    assert!(pass.photons.len() > 20_000);
    // 143 degrees of freedom, 1 − 1e-3: 199.
    assert!(chi2 < 199.0, "χ² = {chi2}");
    let found = power / (16.0 * 3.0 * 2.0 / 5.25f64.sqrt());
    assert!((found - 1.0).abs() < 5e-3, "{found}");
}
