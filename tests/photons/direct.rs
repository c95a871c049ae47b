//! Photons agree with direct light: stored where they arrive first, their density on a floor is
//! the irradiance, in closed form or as midpoint sums over the lamp give it.

use super::lab::{Lab, lab, on_patch, power};
use std::f64::consts::PI;
use terrarium::scatter::{Aim, Store};

pub(super) const FLOOR: &str = r#"(shape: quad(size: (4, 4)), material: "white")"#;
const SMALL_FLOOR: &str = r#"(shape: quad(size: (1.2, 1.2)), material: "white")"#;

/// The floor's irradiance over a square of a metre at (x, z), from photons: within 3σ, and 1 %.
pub(super) fn assert_irradiance(lab: &Lab, at: [f64; 2], expected: impl Fn(f64, f64) -> f64) {
    let half = 0.5;
    let n = 16;
    let middle = |i: usize| half * ((2 * i + 1) as f64 / n as f64 - 1.0);
    let mean = (0..n * n).map(|i| expected(at[0] + middle(i / n), at[1] + middle(i % n))).sum::<f64>()
        / (n * n) as f64;
    let passes = lab.passes(Store::Direct, Aim::Scene, 24, 80_000);
    let found = power(&passes, |p| on_patch(lab, p, at, half));
    let area = 4.0 * half * half;
    let (found, error) = (found.mean / area, found.error / area);
    assert!(
        (found - mean).abs() < 3.0 * error + 1e-9 * mean && (found / mean - 1.0).abs() < 0.01,
        "{found} ± {error} is not {mean}"
    );
}

/// Irradiance from a small piece of a lamp of the given radiance at `q` with normal `n`, on the floor.
pub(super) fn piece(q: [f64; 3], n: [f64; 3], area: f64, x: f64, z: f64) -> f64 {
    let d = [q[0] - x, q[1], q[2] - z];
    let d2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    let there = -(d[0] * n[0] + d[1] * n[1] + d[2] * n[2]);
    there.max(0.0) * d[1].max(0.0) / (d2 * d2) * area
}

#[test]
fn of_a_point_light() {
    let lab = lab("", r#""a": point(position: (0.5, 2, 0.3), intensity: 7)"#, FLOOR);
    assert_irradiance(&lab, [1.0, 0.5], |x, z| {
        let d2 = (x - 0.5).powi(2) + 4.0 + (z - 0.3).powi(2);
        7.0 * 2.0 / (d2 * d2.sqrt())
    });
}

#[test]
fn of_a_point_light_with_the_classic_falloff() {
    let lab = lab("", r#""a": point(position: (0, 2, 0), intensity: 7, falloff: (0.5, 0.25, 0.125))"#, FLOOR);
    assert_irradiance(&lab, [1.0, 0.5], |x, z| {
        let d = (x * x + 4.0 + z * z).sqrt();
        7.0 * 2.0 / d / (0.5 + 0.25 * d + 0.125 * d * d)
    });
}

#[test]
fn of_a_spot_light_in_its_smooth_edge() {
    let lab = lab(
        "",
        r#""a": spot(position: (0, 2, 0), target: (0, 0, 0), intensity: 8, inner_deg: 20, outer_deg: 40)"#,
        FLOOR,
    );
    assert_irradiance(&lab, [1.0, 0.0], |x, z| {
        let d = (x * x + 4.0 + z * z).sqrt();
        let (inner, outer) = (20f64.to_radians().cos(), 40f64.to_radians().cos());
        let s = ((2.0 / d - outer) / (inner - outer)).clamp(0.0, 1.0);
        8.0 * s * s * (3.0 - 2.0 * s) * 2.0 / d.powi(3)
    });
}

#[test]
fn of_a_directional_light() {
    let lab = lab("", r#""a": directional(direction: (1, -2, 0.5), irradiance: 3)"#, FLOOR);
    assert_irradiance(&lab, [1.0, 0.5], |_, _| 3.0 * 2.0 / 5.25f64.sqrt());
}

#[test]
fn of_an_even_sky() {
    let lab = lab("", r#""a": environment(map: constant(2))"#, SMALL_FLOOR);
    assert_irradiance(&lab, [0.0, 0.0], |_, _| 2.0 * PI);
}

#[test]
fn of_a_sphere() {
    for visible in [true, false] {
        let lab = lab(
            "",
            &format!(r#""a": sphere(center: (0.5, 2, 0.3), radius: 0.6, radiance: 5, visible: {visible})"#),
            FLOOR,
        );
        // E = π·L·(R/d)²·cosθ where the whole sphere is above the horizon.
        assert_irradiance(&lab, [1.0, 0.5], |x, z| {
            let d2 = (x - 0.5).powi(2) + 4.0 + (z - 0.3).powi(2);
            PI * 5.0 * 0.36 / d2 * 2.0 / d2.sqrt()
        });
    }
}

#[test]
fn of_a_sphere_around_everything_whether_rays_meet_it_or_not() {
    for visible in [true, false] {
        let lab = lab(
            "",
            &format!(r#""a": sphere(center: (0, 0, 0), radius: 1, radiance: 2, visible: {visible})"#),
            SMALL_FLOOR,
        );
        assert_irradiance(&lab, [0.0, 0.0], |_, _| 2.0 * PI);
    }
}

#[test]
fn of_an_ellipsoid() {
    let lab = lab(
        r#""lamp": (diffuse: 0, emission: 5)"#,
        "",
        &format!(
            r#"{FLOOR}, (shape: sphere(radius: 1), material: "lamp", transform: [scale((0.3, 0.9, 0.5)), translate((0, 2, 0))])"#
        ),
    );
    // By midpoints of the sphere that is stretched; area and normal go with the cofactors.
    assert_irradiance(&lab, [1.0, 0.5], |x, z| {
        let s = [0.3, 0.9, 0.5];
        let n = 60;
        let mut sum = 0.0;
        for i in 0..n {
            for j in 0..2 * n {
                let (theta, phi) = (PI * (i as f64 + 0.5) / n as f64, PI * (j as f64 + 0.5) / n as f64);
                let u = [theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin()];
                let q = [s[0] * u[0], 2.0 + s[1] * u[1], s[2] * u[2]];
                let normal = [s[1] * s[2] * u[0], s[0] * s[2] * u[1], s[0] * s[1] * u[2]];
                let area = theta.sin() * (PI / n as f64).powi(2);
                sum += 5.0 * piece(q, normal, area, x, z);
            }
        }
        sum
    });
}

#[test]
fn of_a_quad_as_a_light_and_as_objects() {
    let quad = |x: f64, z: f64| {
        let n = 40;
        let middle = |i: usize| (i as f64 + 0.5) / n as f64 - 0.5;
        (0..n * n)
            .map(|i| {
                piece([middle(i / n), 2.0, 0.8 * middle(i % n)], [0.0, -1.0, 0.0], 0.8 / (n * n) as f64, x, z)
            })
            .sum::<f64>()
            * 5.0
    };
    let light = r#""a": quad(corner: (-0.5, 2, -0.4), edge_u: (1, 0, 0), edge_v: (0, 0, 0.8), radiance: 5)"#;
    assert_irradiance(&lab("", light, FLOOR), [1.0, 0.5], quad);
    let two_sided = light.replace("radiance: 5", "radiance: 5, two_sided: true, visible: false");
    assert_irradiance(&lab("", &two_sided, FLOOR), [1.0, 0.5], quad);
    let object = format!(
        r#"{FLOOR}, (shape: quad(size: (1, 0.8)), material: "lamp", transform: [translate((0, 2, 0))])"#
    );
    assert_irradiance(&lab(r#""lamp": (diffuse: 0, emission: 5)"#, "", &object), [1.0, 0.5], quad);
    // The box's sides are too low to count: the part of the area that is not its underside is 1e-6.
    let flat = object.replace("quad(size: (1, 0.8))", "box(size: (1, 1e-6, 0.8))");
    assert_irradiance(&lab(r#""lamp": (diffuse: 0, emission: 5)"#, "", &flat), [1.0, 0.5], quad);
}

#[test]
fn of_a_disk() {
    let lab = lab("", r#""a": disk(center: (0, 2, 0), normal: (0, -1, 0), radius: 0.7, radiance: 5)"#, FLOOR);
    assert_irradiance(&lab, [0.6, 0.5], |x, z| {
        let n = 60;
        let mut sum = 0.0;
        for i in 0..n {
            for j in 0..n {
                let r = 0.7 * (i as f64 + 0.5) / n as f64;
                let phi = 2.0 * PI * (j as f64 + 0.5) / n as f64;
                let area = r * (0.7 / n as f64) * (2.0 * PI / n as f64);
                sum += 5.0 * piece([r * phi.cos(), 2.0, r * phi.sin()], [0.0, -1.0, 0.0], area, x, z);
            }
        }
        sum
    });
}

/// All of a rectangle's light, π·L·A a side, however thin it is and however far from the origin.
#[test]
fn of_thin_rectangles_far_away() {
    let within = r#"(shape: sphere(radius: 2e5), material: "white")"#;
    let quad = |corner: &str, u: f64, v: [f64; 2], radiance: f64| {
        format!(
            r#""a": quad(corner: {corner}, edge_u: (0, 0, {u:e}), edge_v: ({:e}, {:e}, 0), radiance: {radiance:e}, two_sided: true)"#,
            v[0], v[1]
        )
    };
    let thin: [(&str, f64, [f64; 2]); 4] = [
        ("(3, 4, 0)", 0.5, [0.3, 0.4]),
        ("(30, 40, 0)", 0.05, [8e-15, -6e-15]),
        ("(1e5, 1e4, 7)", 0.5, [0.0, 1e-10]),
        ("(1e5, 1e4, 7)", 0.5, [6e-14, 8e-14]),
    ];
    for (corner, u, v) in thin {
        let area = u * v[0].hypot(v[1]);
        let lab = lab("", &quad(corner, u, v, 1.0 / area), within);
        let pass = &lab.passes(Store::Direct, Aim::Scene, 1, 100_000)[0];
        let off = pass.ledger.emitted.x / (2.0 * PI) - 1.0;
        assert!(off.abs() < 2e-3, "{corner} {v:?}: off by {off}");
        assert!(pass.ledger.stored.x / pass.ledger.emitted.x > 0.999, "{corner} {v:?}");
    }
}
