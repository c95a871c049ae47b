//! Absorbing media: Beer–Lambert along eye rays and shadow rays.

use super::shot::{assert_close, shot};
use std::f64::consts::PI;

pub(crate) fn view(eye_x: f64, max_depth: u32, glass: &str, objects: &str) -> f64 {
    shot(format!(
        r#"(camera: (eye: ({eye_x}, 0, 0), target: (5, 0, 0), fov_deg: 0.001), image: (width: 1, height: 1), antialiasing: none,
        render: (max_depth: {max_depth}), materials: {{ "glass": ({glass}), "glow": (emission: 1) }},
        objects: [(shape: box(size: (0.1, 9, 9), center: (5, 0, 0)), material: "glow"), {objects}])"#
    ))
    .render()
    .mean()
}

#[test]
fn an_absorbing_slab_dims_by_beer_and_lambert() {
    for (sigma, thickness) in [(0.5, 1.0), (2.0, 0.3), (100.0, 0.01)] {
        let found = view(
            -3.0,
            2,
            &format!("transmission: 1, ior: 1.5, absorption: {sigma}"),
            &format!(r#"(shape: box(size: ({thickness}, 9, 9)), material: "glass")"#),
        );
        assert_close(found, 0.96f64.powi(2) * f64::exp(-sigma * thickness), 1e-5);
    }
}

/// Of overlapping media the one of higher priority absorbs, and only it.
#[test]
fn only_the_medium_that_counts_absorbs() {
    let found = shot(
        r#"(camera: (eye: (-3, 0, 0), target: (5, 0, 0), fov_deg: 0.001), image: (width: 1, height: 1), antialiasing: none,
        render: (max_depth: 6), background: 1,
        materials: { "a": (transmission: 1, ior: 1, absorption: 0.5, priority: 1), "b": (transmission: 1, ior: 1, absorption: 0.25) },
        objects: [(shape: box(size: (2, 9, 9)), material: "a"), (shape: box(size: (2, 9, 9), center: (1, 0, 0)), material: "b")])"#,
    )
    .render()
    .mean();
    assert_close(found, f64::exp(-0.5 * 2.0 - 0.25), 1e-5);
}

/// Light that reaches a surface under water has come through the water.
#[test]
fn shadow_rays_lose_light_in_the_medium() {
    let e = |sigma: f64| {
        shot(format!(
            r#"(camera: (eye: (0.0002, 0.05, 0), target: (0, 0, 0), fov_deg: 0.01), image: (width: 1, height: 1), antialiasing: none,
            render: (max_depth: 1), materials: {{ "white": (diffuse: 1), "water": (transmission: 1, ior: 1.33, absorption: {sigma}) }},
            lights: {{ "lamp": point(position: (0, 2, 0), intensity: 1) }},
            objects: [(shape: quad(), material: "white"), (shape: box(size: (9, 9, 9)), material: "water")])"#
        ))
        .render()
        .mean()
            * PI
    };
    assert_close(e(0.0), 0.25, 1e-4);
    assert_close(e(0.4), 0.25 * f64::exp(-0.4 * 2.05), 1e-4);
}
