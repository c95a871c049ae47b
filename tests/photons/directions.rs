//! Lights emit in the directions of their own distribution: on a white sphere far around a
//! lamp, over 320 bins of equal solid angle that are no cells of the emission.

use super::lab::{Lab, lab};
use std::f64::consts::TAU;
use terrarium::math::sampling::SphericalCell;
use terrarium::math::{DMat3, DVec2, DVec3};
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

/// A lamp in the middle of a wide white sphere.
pub(crate) fn lamp_in_a_sphere(light: &str) -> Lab {
    lab("", light, r#"(shape: sphere(radius: 1000), material: "white")"#)
}

fn assert_distribution(light: &str, intensity: impl Fn(DVec3) -> f64) {
    assert_travels(&lamp_in_a_sphere(light), intensity);
}

/// How the power that arrives is spread over the directions in which it travels.
pub(crate) struct Judged {
    pub chi2: f64,
    /// Of χ², at p = 1e-3.
    pub limit: f64,
    /// Of the fullest bin over the emptiest.
    pub ratio: f64,
    /// The first moment less the exact one, as a share of the power.
    pub moment: f64,
    /// The power less the exact one, as a share.
    pub power: f64,
    /// The worst of the bins that hold a part worth speaking of, as a share.
    pub worst: f64,
}

/// χ² by bins of the direction, with `intensity` in W/sr.
pub(super) fn assert_travels(scene: &Lab, intensity: impl Fn(DVec3) -> f64) {
    let Judged { chi2, limit, moment, power, worst, .. } = judge(scene, 150_000, intensity);
    assert!(worst < 0.2, "a bin is off by {worst}");
    assert!(power < 5e-3, "the power is off by {power}");
    assert!(chi2 < limit, "χ² = {chi2}, limit {limit}");
    assert!(moment < 5e-3, "the first moment is off by {moment}");
}

/// Of χ² at p = 1e-3, by Wilson and Hilferty; stratified photons stay far below.
fn chi2_limit(degrees: f64) -> f64 {
    degrees * f64::powi(1.0 - 2.0 / (9.0 * degrees) + 3.09 * f64::sqrt(2.0 / (9.0 * degrees)), 3)
}

/// χ² over 64 equal parts of the unit disk, eight rings of eight sectors, of where photons' lines cross it, and its
/// limit at p = 1e-3. `crossing`: from a photon's place and its direction.
pub(crate) fn judge_places(scene: &Lab, n: u64, crossing: impl Fn(DVec3, DVec3) -> DVec2) -> (f64, f64) {
    let mut found = [[0.0f64; 2]; 64];
    for photon in scene.passes(Store::Direct, Aim::Scene, 1, n)[0].photons.iter() {
        let d = crossing(scene.place(photon), -photon.wi.as_dvec3().normalize());
        let ring = ((8.0 * d.length_squared()) as usize).min(7);
        let sector = ((8.0 * (d.y.atan2(d.x) / TAU + 0.5)) as usize).min(7);
        let power = f64::from(photon.power.x);
        found[8 * ring + sector][0] += power;
        found[8 * ring + sector][1] += power * power;
    }
    let expected = found.iter().map(|part| part[0]).sum::<f64>() / 64.0;
    let part = |[sum, squares]: [f64; 2]| (sum - expected).powi(2) / squares.max(f64::MIN_POSITIVE);
    (found.into_iter().map(part).sum(), chi2_limit(63.0))
}

pub(crate) fn judge(scene: &Lab, n: u64, intensity: impl Fn(DVec3) -> f64) -> Judged {
    let (bins, turn) = (bins(), turn());
    let planes: Vec<[DVec3; 3]> = bins.iter().map(SphericalCell::planes).collect();
    let pass = &scene.passes(Store::Direct, Aim::Scene, 1, n)[0];
    let mut found = vec![[0.0f64; 2]; bins.len()];
    let mut moment = DVec3::ZERO;
    let mut total = 0.0;
    for photon in pass.photons.iter() {
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
    let (mut worst, mut fullest, mut emptiest) = (0.0f64, 0.0f64, f64::INFINITY);
    for (bin, [sum, squares]) in bins.iter().zip(&found) {
        let mean =
            (0..m * m).map(|i| intensity(turn * bin.sample([middle(i / m), middle(i % m)]))).sum::<f64>()
                / (m * m) as f64;
        let expected = mean * bin.solid_angle();
        expected_total += expected;
        (fullest, emptiest) = (fullest.max(*sum), emptiest.min(*sum));
        if *squares == 0.0 {
            assert!(expected < 1e-4 * total, "{expected} W are missing from a bin");
            continue;
        }
        // Where all photons weigh the same this is the plain χ².
        chi2 += (sum - expected).powi(2) / squares;
        degrees += 1.0;
        if expected > 2e-3 * total {
            worst = worst.max((sum / expected - 1.0).abs());
        }
    }
    let limit = chi2_limit(degrees);
    let mut first = DVec3::ZERO;
    for bin in &bins {
        for i in 0..m * m {
            let d = turn * bin.sample([middle(i / m), middle(i % m)]);
            first += d * (intensity(d) * bin.solid_angle() / (m * m) as f64);
        }
    }
    Judged {
        chi2,
        limit,
        ratio: fullest / emptiest,
        moment: (moment - first).length() / total,
        power: (total / expected_total - 1.0).abs(),
        worst,
    }
}

#[test]
fn of_a_quad_with_the_cosine_on_one_side_or_both() {
    let n = DVec3::new(0.0, -1.0, 0.0);
    let quad = r#""a": quad(corner: (-0.5, 0, -0.5), edge_u: (1, 0, 0), edge_v: (0, 0, 1), radiance: 2, two_sided: false)"#;
    assert_distribution(quad, |d| 2.0 * d.dot(n).max(0.0));
    assert_distribution(&quad.replace("false", "true"), |d| 2.0 * d.dot(n).abs());
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
