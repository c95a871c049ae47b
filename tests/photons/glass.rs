//! Photons through glass: closed forms of flux.

use super::lab::{estimate, lab, on_patch, power};
use terrarium::scatter::{Aim, Scattered, Store};

#[test]
fn a_flat_pane_lets_0_923077_through_at_normal_incidence() {
    let lab = lab(
        "",
        r#""sun": directional(direction: (0, -1, 0), irradiance: 1)"#,
        r#"(shape: quad(size: (8, 8)), material: "white"), (shape: box(size: (4, 0.1, 4), center: (0, 1, 0)), material: "glass")"#,
    );
    let found = power(&lab.caustics(64, 4000), |p| on_patch(&lab, p, [0.0, 0.0], 1.0));
    // (1 − R)/(1 + R), R = 0.04
    assert!((found.mean / 4.0 - 0.923_077).abs() < 3.0 * found.error / 4.0 + 1e-5, "{found:?}");
    assert!(found.error / 4.0 < 2e-3);
}

#[test]
fn power_that_enters_closed_glass_leaves_it() {
    // All around the ball is white: what the lamp sends to the ball arrives on the walls, whole.
    let lab = lab(
        "",
        r#""lamp": point(position: (0, 2.5, 0), intensity: 1)"#,
        r#"(shape: sphere(radius: 8), material: "white"), (shape: sphere(radius: 1), material: "glass")"#,
    );
    let passes = lab.caustics(32, 4000);
    let found = power(&passes, |_| true);
    let cone = 2.0 * std::f64::consts::PI * (1.0 - (1.0f64 - 0.16).sqrt());
    assert!((found.mean / cone - 1.0).abs() < 3.0 * found.error / cone + 1e-6, "{found:?} {cone}");
    assert!(found.error / cone < 3e-3, "{found:?}");
}

#[test]
fn absorbing_glass_takes_what_beer_and_lambert_say() {
    let lab = lab(
        r#""ink": (transmission: 1, ior: 1.5, absorption: 4)"#,
        r#""sun": directional(direction: (0, -1, 0), irradiance: 1)"#,
        r#"(shape: quad(size: (8, 8)), material: "white"), (shape: box(size: (4, 0.1, 4), center: (0, 1, 0)), material: "ink")"#,
    );
    let found = power(&lab.caustics(64, 4000), |p| on_patch(&lab, p, [0.0, 0.0], 1.0));
    let (r, t) = (0.04f64, (-0.4f64).exp());
    let expected = 4.0 * (1.0 - r).powi(2) * t / (1.0 - (r * t).powi(2));
    assert!((found.mean - expected).abs() < 3.0 * found.error + 1e-5, "{found:?} {expected}");
}

#[test]
fn a_scene_without_mirrors_or_interfaces_has_no_emission() {
    let floor = r#"(shape: quad(size: (8, 8)), material: "white")"#;
    let lights = r#""a": point(position: (0, 2, 0), intensity: 1), "sky": environment(map: constant(1)),
        "b": sphere(center: (0, 3, 0), radius: 0.2, radiance: 5)"#;
    assert!(lab("", lights, floor).emission(Store::Caustics, Aim::Casters).is_none());
    // H14: of the index of its surroundings
    let air = format!(r#"{floor}, (shape: sphere(center: (0, 1, 0), radius: 0.5), material: "air")"#);
    let scene = lab(r#""air": (transmission: 1, ior: 1)"#, lights, &air);
    assert!(scene.emission(Store::Caustics, Aim::Casters).is_none());
    // Aimed at all the scene, photons find nothing specular either.
    let unaimed = scene.passes(Store::Caustics, Aim::Scene, 1, 10_000);
    assert_eq!(unaimed[0].photons.len(), 0);
    assert!(unaimed[0].emitted > 9_000);
}

#[test]
fn a_mirror_sends_on_its_share_of_each_colour() {
    let lab = lab(
        r#""tinted": (reflection: (0.5, 0.25, 1), diffuse: 0)"#,
        r#""sun": directional(direction: (0, -1, 0), irradiance: 2)"#,
        r#"(shape: quad(size: (1, 1)), material: "tinted", transform: [rotate(axis: (0, 0, 1), deg: 45)]),
           (shape: quad(size: (4, 4)), material: "white", transform: [rotate(axis: (0, 0, 1), deg: 90), translate((3, 0, 0))]),
           (shape: quad(size: (4, 4)), material: "white", transform: [rotate(axis: (0, 0, 1), deg: 90), translate((-3, 0, 0))])"#,
    );
    let passes = lab.caustics(32, 2000);
    for (channel, share) in [0.5, 0.25, 1.0].into_iter().enumerate() {
        let sum = |pass: &Scattered| pass.photons.iter().map(|p| f64::from(p.power[channel])).sum::<f64>();
        let found = estimate(passes.iter().map(sum));
        let expected = 2.0 * 0.5f64.sqrt() * share;
        assert!((found.mean - expected).abs() < 3.0 * found.error + 1e-5, "{found:?} {expected}");
        assert!(found.error < 0.01 * expected);
    }
}
