//! Photons through glass: closed forms of flux.

use super::lab::{lab, on_patch, power};
use terrarium::scatter::{Aim, Store};

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
    // Of the index of its surroundings
    let air = format!(r#"{floor}, (shape: sphere(center: (0, 1, 0), radius: 0.5), material: "air")"#);
    let scene = lab(r#""air": (transmission: 1, ior: 1)"#, lights, &air);
    assert!(scene.emission(Store::Caustics, Aim::Casters).is_none());
    // Aimed at all the scene, photons find nothing specular either.
    let unaimed = scene.passes(Store::Caustics, Aim::Scene, 1, 10_000);
    assert_eq!(unaimed[0].photons.len(), 0);
    assert!(unaimed[0].emitted > 9_000);
}
