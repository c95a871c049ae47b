//! Lights emit in the directions of their own distribution (S2, H51): on a white sphere far around a
//! lamp, over 320 bins of equal solid angle that are no cells of the emission.

use super::lab::{Lab, lab};
use std::f64::consts::PI;
use terrarium::math::sampling::SphericalCell;
use terrarium::math::{DMat3, DVec3};
use terrarium::scatter::{Aim, Store};

fn bins() -> Vec<SphericalCell> {
    let mut bins = SphericalCell::icosahedron().to_vec();
    for _ in 0..4 {
        bins = bins.iter().flat_map(SphericalCell::halves).collect();
    }
    bins
}

/// A turn that puts the bins askew to the emission's cells.
fn turn() -> DMat3 {
    let z = DVec3::new(0.3, -0.5, 0.7).normalize();
    let x = z.cross(DVec3::new(0.1, 0.9, 0.2)).normalize();
    DMat3::from_cols(x, z.cross(x), z)
}

fn assert_distribution(light: &str, intensity: impl Fn(DVec3) -> f64) {
    let scene = lab("", light, r#"(shape: sphere(radius: 1000), material: "white")"#);
    assert_travels(&scene, intensity);
}

/// χ² of the power that arrives by bins of the direction in which it travels, with `intensity` in W/sr.
pub(super) fn assert_travels(scene: &Lab, intensity: impl Fn(DVec3) -> f64) {
    let (bins, turn) = (bins(), turn());
    let n = 150_000;
    let planes: Vec<[DVec3; 3]> = bins.iter().map(SphericalCell::planes).collect();
    let pass = &scene.passes(Store::Direct, Aim::Scene, 1, n)[0];
    let mut found = vec![[0.0f64; 2]; bins.len()];
    let mut moment = DVec3::ZERO;
    let mut total = 0.0;
    for photon in &pass.photons {
        let dir = -photon.wi.as_dvec3();
        let local = turn.transpose() * dir;
        let bin = planes.iter().position(|b| b.iter().all(|n| n.dot(local) >= 0.0)).unwrap_or(0);
        let power = f64::from(photon.power.x);
        found[bin][0] += power;
        found[bin][1] += power * power;
        moment += dir * power;
        total += power;
    }
    // By midpoints in the bins' own parameters.
    let m = 24;
    let middle = |i: usize| (i as f64 + 0.5) / m as f64;
    let (mut chi2, mut degrees, mut expected_total) = (0.0f64, 0.0f64, 0.0f64);
    for (bin, [sum, squares]) in bins.iter().zip(&found) {
        let mean =
            (0..m * m).map(|i| intensity(turn * bin.sample([middle(i / m), middle(i % m)]))).sum::<f64>()
                / (m * m) as f64;
        let expected = mean * bin.solid_angle();
        expected_total += expected;
        if *squares == 0.0 {
            assert!(expected < 1e-4 * total, "{expected} W are missing from a bin");
            continue;
        }
        // Where all photons weigh the same this is the plain χ².
        chi2 += (sum - expected).powi(2) / squares;
        degrees += 1.0;
        if expected > 2e-3 * total {
            assert!((sum / expected - 1.0).abs() < 0.2, "{sum} W in a bin of {expected} W");
        }
    }
    assert!((total / expected_total - 1.0).abs() < 5e-3, "{total} W of {expected_total} W");
    // p = 1e-3 by Wilson and Hilferty; stratified photons stay far below.
    let limit = degrees * f64::powi(1.0 - 2.0 / (9.0 * degrees) + 3.09 * f64::sqrt(2.0 / (9.0 * degrees)), 3);
    assert!(chi2 < limit, "χ² = {chi2}, {degrees} degrees of freedom");
    let mut first = DVec3::ZERO;
    for bin in &bins {
        for i in 0..m * m {
            let d = turn * bin.sample([middle(i / m), middle(i % m)]);
            first += d * (intensity(d) * bin.solid_angle() / (m * m) as f64);
        }
    }
    assert!((moment - first).length() < 5e-3 * total, "{moment} is not {first}");
}

#[test]
fn of_a_point_light_evenly() {
    assert_distribution(r#""a": point(position: (0, 0, 0), intensity: 3)"#, |_| 3.0);
}

#[test]
fn of_a_sphere_evenly() {
    let light = r#""a": sphere(center: (0, 0, 0), radius: 0.5, radiance: 3)"#;
    assert_distribution(light, |_| 3.0 * PI * 0.25);
}

#[test]
fn of_a_quad_with_the_cosine_on_one_side_or_both() {
    let n = DVec3::new(0.0, -1.0, 0.0);
    let quad = r#""a": quad(corner: (-0.5, 0, -0.5), edge_u: (1, 0, 0), edge_v: (0, 0, 1), radiance: 2, two_sided: false)"#;
    assert_distribution(quad, |d| 2.0 * d.dot(n).max(0.0));
    assert_distribution(&quad.replace("false", "true"), |d| 2.0 * d.dot(n).abs());
}

#[test]
fn of_a_disk_with_the_cosine() {
    let n = DVec3::new(1.0, 2.0, 2.0) / 3.0;
    let disk = r#""a": disk(center: (0, 0, 0), normal: (1, 2, 2), radius: 0.5, radiance: 2)"#;
    assert_distribution(disk, |d| 2.0 * PI * 0.25 * d.dot(n).max(0.0));
}

#[test]
fn of_a_spot_light_by_its_falloff() {
    let spot =
        r#""a": spot(position: (0, 0, 0), target: (1, 1, 0), intensity: 3, inner_deg: 30, outer_deg: 70)"#;
    let axis = DVec3::new(1.0, 1.0, 0.0).normalize();
    let (inner, outer) = (30f64.to_radians().cos(), 70f64.to_radians().cos());
    assert_distribution(spot, |d| {
        let s = ((d.dot(axis) - outer) / (inner - outer)).clamp(0.0, 1.0);
        3.0 * s * s * (3.0 - 2.0 * s)
    });
}
