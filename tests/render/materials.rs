//! Layers of a material: they gain nothing, and each does what it says.

use super::shot::{Picture, assert_close, shot};
use std::f64::consts::PI;

pub(crate) fn plane(material: &str, lights: &str, more: &str, eye: &str) -> f64 {
    shot(format!(
        r#"(camera: (eye: {eye}, target: (0, 0, 0), up: (0.1, 0.3, 0.5), fov_deg: 0.01), image: (width: 1, height: 1), antialiasing: none,
        materials: {{ "m": ({material}) }}, lights: {{ {lights} }}, {more} objects: [(shape: box(size: (2, 0.2, 2), center: (0, -0.1, 0)), material: "m")])"#
    ))
    .passes(256)
    .render()
    .mean()
}

/// The normalised highlight: (n+2)/2π·cosⁿα·cosθ under a directional light.
#[test]
fn the_highlight_is_normalised_phong() {
    for (n, off) in [(50.0, 0.0), (50.0, 8.0), (10.0, 30.0), (1.0, 60.0), (1e5, 0.1)] {
        let (incoming, outgoing) = (f64::to_radians(20.0), f64::to_radians(20.0 - off));
        let light = format!(
            r#""sun": directional(direction: ({}, {}, 0), irradiance: 2)"#,
            -incoming.sin(),
            -incoming.cos()
        );
        let eye = format!("({}, {}, 0)", -3.0 * outgoing.sin(), 3.0 * outgoing.cos());
        let found = plane(&format!("specular: 0.5, shininess: {n}"), &light, "", &eye);
        let expected =
            0.5 * (n + 2.0) / (2.0 * PI) * f64::to_radians(off).cos().powf(n) * incoming.cos() * 2.0;
        assert_close(found, expected, 1e-4);
    }
}

/// Colours go through every layer channel by channel.
#[test]
fn colours_stay_in_their_channels() {
    let picture = shot(
        r#"(camera: (eye: (1, 2, 1), target: (0, 0, 0), fov_deg: 0.01), image: (width: 1, height: 1), antialiasing: none, background: (1, 2, 4),
        ambient: (1, 1, 2), materials: { "m": (reflection: (0.5, 0, 0.25), diffuse: (0, 0.5, 0.5), emission: (0, 0, 3)) },
        objects: [(shape: quad(), material: "m")])"#,
    )
    .render();
    let expected = [0.5, 0.5, 0.25 * 4.0 + 0.75 * 0.5 * 2.0 + 3.0];
    for (found, expected) in picture.rgb()[0].into_iter().zip(expected) {
        assert_close(found.into(), expected, 1e-6);
    }
}

/// Surfaces are seen and lit from both sides.
#[test]
fn both_sides_of_an_open_surface_are_lit() {
    for (eye, light) in [("(1, 2, 0)", "(0, -1, 0)"), ("(1, -2, 0)", "(0, 1, 0)")] {
        let found = shot(format!(
            r#"(camera: (eye: {eye}, target: (0, 0, 0), fov_deg: 0.01), image: (width: 1, height: 1), antialiasing: none,
            materials: {{ "m": (diffuse: 0.5) }}, lights: {{ "sun": directional(direction: {light}, irradiance: 2) }}, objects: [(shape: quad(), material: "m")])"#
        ))
        .render()
        .mean();
        assert_close(found, 0.5 * 2.0 / PI, 1e-6);
    }
}

/// A highlight narrower than the lamp that it mirrors has no more noise than two choices leave, and its
/// mean is that of one that is drawn from the lamp only (a lamp of many parts, each too small to be wide).
#[test]
fn narrow_highlights_of_wide_lamps_are_smooth_and_keep_their_mean() {
    let scene = |lights: &str, passes: &str| {
        format!(
            r#"(camera: (eye: (0, 1, 2), target: (0, 0, 0), fov_deg: 10), image: (width: 24, height: 24), {passes}
            materials: {{ "polish": (specular: 0.5, shininess: 4000) }}, lights: {{ {lights} }},
            objects: [(shape: quad(size: (4, 4)), material: "polish")])"#
        )
    };
    let lamp = |x: f64, z: f64, w: f64| {
        format!(
            "corner: ({:?}, 2, {:?}), edge_u: (0, 0, {w:?}), edge_v: ({w:?}, 0, 0), two_sided: true, radiance: 5",
            x - w / 2.0,
            z - w / 2.0
        )
    };
    let wide = format!(r#""lamp": quad({})"#, lamp(0.0, -4.0, 2.0));
    let parts: Vec<String> = (0..64)
        .flat_map(|i| (0..64).map(move |j| (i, j)))
        .filter(|(i, j)| i % 8 == 0 && j % 8 == 0)
        .map(|(i, j)| {
            let w = 0.25;
            let at = |k: i32| -1.0 + w * (f64::from(k / 8) + 0.5);
            format!(r#""part {i} {j}": quad({})"#, lamp(at(i), -4.0 + at(j), w))
        })
        .collect();
    let one = shot(scene(&wide, "render: (seed: 1),")).passes(8).render();
    let other = shot(scene(&wide, "render: (seed: 2),")).passes(8).render();
    let parts = shot(scene(&parts.join(", "), "")).passes(8).render();
    let mean = |p: &Picture| p.grey().iter().sum::<f64>() / p.grey().len() as f64;
    let noise = {
        let square: f64 = one.grey().iter().zip(other.grey()).map(|(a, b)| (a - b).powi(2) / 2.0).sum();
        (square / one.grey().len() as f64).sqrt() / mean(&one)
    };
    assert!(mean(&one) > 0.1, "the lamp is not seen in the polish: {}", mean(&one));
    // Half of the draws are the lobe's and bring twice the mean, the others nothing: 1/√8 if they were
    // independent. The lamp alone would bring something once in fifty draws: 2.5.
    assert!(noise < 0.36, "noise {noise} after 8 passes");
    assert_close(mean(&one), mean(&parts), 0.02);
}
