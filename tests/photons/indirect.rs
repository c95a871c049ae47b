//! Photons that diffuse surfaces send on: in a closed room of one albedo ρ what arrives is a geometric
//! series, and in a sphere it is the same everywhere.

use super::lab::{Lab, estimate, lab};
use std::f64::consts::PI;
use terrarium::math::DVec3;
use terrarium::scatter::{Aim, Photon, Scattered, Store};

const ALBEDO: [f64; 3] = [0.8, 0.5, 0.2];

/// A room of `shape` with `more` in it, and light of 4π W in it.
fn room(shape: &str, more: &str, bounces: u32) -> Lab {
    let mut room = lab(
        r#""wall": (diffuse: (0.8, 0.5, 0.2))"#,
        r#""lamp": point(position: (0.3, 0.5, -0.2), intensity: 1)"#,
        &format!(r#"(shape: {shape}, material: "wall") {more}"#),
    );
    room.plan.bounces = bounces;
    room
}

fn series(rho: f64, bounces: u32) -> f64 {
    (1..=bounces.min(1000)).map(|n| rho.powi(n as i32)).sum()
}

fn passes(room: &Lab) -> Vec<Scattered> {
    room.passes(Store::Indirect, Aim::Scene, 24, 20_000)
}

/// The power of the photons that `keep` keeps, in W, within 3σ and 2 %.
#[track_caller]
fn assert_power(passes: &[Scattered], keep: impl Fn(&Photon) -> bool, expected: [f64; 3]) {
    for (channel, expected) in expected.into_iter().enumerate() {
        let sum = |pass: &Scattered| {
            pass.photons.iter().filter(|p| keep(p)).map(|p| f64::from(p.power[channel])).sum::<f64>()
        };
        let found = estimate(passes.iter().map(sum));
        let off = (found.mean - expected).abs();
        println!("{found:?}, expected {expected}");
        assert!(off < 3.0 * found.error + 1e-6 * expected && off < 0.02 * expected, "{found:?} {expected}");
    }
}

fn assert_balanced(passes: &[Scattered]) {
    for pass in passes {
        let l = &pass.ledger;
        assert!(l.imbalance() < 1e-12, "{:e}", l.imbalance());
        assert_eq!(l.bent, DVec3::ZERO);
        assert_eq!(l.photons, pass.photons.len() as u64);
        assert!(l.escaped.max_element() < 1e-9, "{}", l.escaped);
        let arrived: DVec3 = pass.photons.iter().map(|p| p.power.as_dvec3()).sum();
        assert!((arrived / l.arrived - 1.0).abs().max_element() < 1e-5);
    }
    let share = estimate(passes.iter().map(|p| p.ledger.roulette.x / p.ledger.emitted.x));
    assert!(share.mean.abs() < 3.0 * share.error + 1e-9, "{share:?}");
}

#[test]
fn an_integrating_sphere_is_lit_evenly_by_rho_over_one_minus_rho() {
    let room = room("sphere(radius: 2)", "", u32::MAX);
    let passes = passes(&room);
    assert_balanced(&passes);
    let all = ALBEDO.map(|rho| 4.0 * PI * rho / (1.0 - rho));
    assert_power(&passes, |_| true, all);
    // Wherever the lamp stands: each half gets half, whichever way it is cut; a cap by its height.
    for axis in [DVec3::X, DVec3::Y, DVec3::new(1.0, -2.0, 2.0) / 3.0] {
        let above = |height: f64| move |p: &Photon| -p.normal.as_dvec3().dot(axis) > height;
        assert_power(&passes, above(0.0), all.map(|w| w / 2.0));
        assert_power(&passes, above(0.6), all.map(|w| w / 5.0));
    }
}

#[test]
fn so_many_bounces_are_so_many_terms_of_the_series() {
    for bounces in [1, 2, 5] {
        let room = room("sphere(radius: 2)", "", bounces);
        let passes = passes(&room);
        assert_balanced(&passes);
        assert_power(&passes, |_| true, ALBEDO.map(|rho| 4.0 * PI * series(rho, bounces)));
    }
}

/// Nothing is left to chance where nothing is absorbed.
#[test]
fn white_walls_get_everything_once_a_bounce() {
    for bounces in [1, 3, 9] {
        let mut room = lab(
            "",
            r#""lamp": point(position: (0.3, 0.5, -0.2), intensity: 1)"#,
            r#"(shape: box(size: (4, 3, 2)), material: "white")"#,
        );
        room.plan.bounces = bounces;
        let pass = &room.passes(Store::Indirect, Aim::Scene, 1, 20_000)[0];
        let power: f64 = pass.photons.iter().map(|p| f64::from(p.power.x)).sum();
        let expected = f64::from(bounces) * pass.ledger.emitted.x;
        assert!((power / expected - 1.0).abs() < 1e-5, "{power} instead of {expected}");
        assert!(pass.ledger.imbalance() < 1e-12 && pass.ledger.cut == DVec3::ZERO);
        assert!(pass.ledger.roulette.abs().max_element() < 1e-9 * expected);
    }
}

/// In any closed room of one albedo, whatever mirrors and glass stand in it.
#[test]
fn mirrors_and_glass_in_a_room_leave_the_series_alone() {
    let still_life = r#", (shape: sphere(center: (0.5, -0.5, 0), radius: 0.4), material: "glass"),
        (shape: box(size: (0.5, 0.4, 0.5), center: (-0.7, -1, 0.3)), material: "mirror")"#;
    for (shape, more) in [("box(size: (4, 3, 2))", ""), ("box(size: (4, 3, 2))", still_life)] {
        let room = room(shape, more, u32::MAX);
        let passes = passes(&room);
        assert_balanced(&passes);
        assert_power(&passes, |_| true, ALBEDO.map(|rho| 4.0 * PI * rho / (1.0 - rho)));
    }
}
