//! Beneath a flat pane every kind of light gives the irradiance that it gives without the pane, times
//! what the pane transmits, direction by direction. The pane is so thin that it shifts no ray.

use super::lab::{Beneath, pane};
use crate::render::meshes::{cube, folder};
use crate::render::shot::focused;
use std::f64::consts::PI;
use std::path::Path;

/// What is left out: a pane of 1 mm brings lights two metres away nearer by a third of that.
const MODEL: f64 = 2e-3;

/// Irradiance at (x, 0, z) from a small piece of a lamp of radiance 1 at `q` with normal `n`, through the pane.
fn piece(q: [f64; 3], n: [f64; 3], area: f64, x: f64, z: f64) -> f64 {
    let d = [q[0] - x, q[1], q[2] - z];
    let d2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    let there = -(d[0] * n[0] + d[1] * n[1] + d[2] * n[2]);
    there.max(0.0) * d[1].max(0.0) / (d2 * d2) * area * pane(d[1] / d2.sqrt())
}

#[track_caller]
fn assert_beneath(light: &str, expected: impl Fn(f64, f64) -> f64) {
    let beneath = Beneath::default();
    let found = beneath.irradiance(&beneath.shot(light, "", ""), Path::new(""));
    found.assert_is(beneath.mean(expected), MODEL, light);
}

/// From a point at (0.5, 2, 0.3) of an intensity that depends on the direction's cosine with −y.
fn from_point(x: f64, z: f64, intensity: impl Fn(f64) -> f64) -> f64 {
    let d2 = (x - 0.5).powi(2) + 4.0 + (z - 0.3).powi(2);
    let cos = 2.0 / d2.sqrt();
    intensity(cos) * cos / d2 * pane(cos)
}

#[test]
fn of_a_point_light() {
    assert_beneath(r#""a": point(position: (0.5, 2, 0.3), intensity: 7)"#, |x, z| from_point(x, z, |_| 7.0));
}

#[test]
fn of_a_spot_light() {
    let light = r#""a": spot(position: (0.5, 2, 0.3), target: (0.5, 0, 0.3), intensity: 7, inner_deg: 10, outer_deg: 30)"#;
    assert_beneath(light, |x, z| {
        from_point(x, z, |cos| {
            let (inner, outer) = (10f64.to_radians().cos(), 30f64.to_radians().cos());
            let s = ((cos - outer) / (inner - outer)).clamp(0.0, 1.0);
            7.0 * s * s * (3.0 - 2.0 * s)
        })
    });
}

#[test]
fn of_a_slanting_directional_light() {
    let cos = 2.0 / 5.25f64.sqrt();
    assert_beneath(r#""a": directional(direction: (1, -2, 0.5), irradiance: 3)"#, |_, _| {
        3.0 * cos * pane(cos)
    });
}

#[test]
fn of_a_sphere() {
    // By midpoints of the sphere's surface that faces down or sideways.
    let light = r#""a": sphere(center: (0.5, 2, 0.3), radius: 0.4, radiance: 5)"#;
    assert_beneath(light, |x, z| {
        let n = 40;
        let mut sum = 0.0;
        for i in 0..n * 2 * n {
            let (cos, phi) = ((i / (2 * n)) as f64 + 0.5, (i % (2 * n)) as f64 + 0.5);
            let (y, phi) = (1.0 - 2.0 * cos / n as f64, phi * PI / n as f64);
            let r = (1.0 - y * y).sqrt();
            let normal = [r * phi.cos(), y, r * phi.sin()];
            let q = [0.5 + 0.4 * normal[0], 2.0 + 0.4 * y, 0.3 + 0.4 * normal[2]];
            sum += piece(q, normal, 4.0 * PI * 0.16 / (2 * n * n) as f64, x, z);
        }
        5.0 * sum
    });
}

#[test]
fn of_a_quad() {
    let light = r#""a": quad(corner: (-0.5, 2, -0.4), edge_u: (1, 0, 0), edge_v: (0, 0, 0.8), radiance: 5)"#;
    assert_beneath(light, |x, z| {
        let n = 20usize;
        let at = |i: usize| (i as f64 + 0.5) / n as f64 - 0.5;
        let of =
            |i: usize| piece([at(i / n), 2.0, 0.8 * at(i % n)], [0.0, -1.0, 0.0], 0.8 / (n * n) as f64, x, z);
        5.0 * (0..n * n).map(of).sum::<f64>()
    });
}

#[test]
fn of_a_disk() {
    let light = r#""a": disk(center: (0, 2, 0), normal: (0, -1, 0), radius: 0.6, radiance: 5)"#;
    assert_beneath(light, |x, z| {
        let n = 30;
        let of = |i: usize| {
            let (r, phi) = ((i / n) as f64 + 0.5, 2.0 * PI * ((i % n) as f64 + 0.5) / n as f64);
            let r = 0.6 * r / n as f64;
            let area = r * (0.6 / n as f64) * (2.0 * PI / n as f64);
            piece([r * phi.cos(), 2.0, r * phi.sin()], [0.0, -1.0, 0.0], area, x, z)
        };
        5.0 * (0..n * n).map(of).sum::<f64>()
    });
}

#[test]
fn of_an_emitting_mesh() {
    let dir = folder();
    cube().scaled(0.25).write(&dir.path().join("cube.obj"));
    let beneath = Beneath::default();
    let object =
        r#", (shape: mesh(path: "cube.obj"), material: "lamp", transform: [translate((0.3, 2, 0.2))])"#;
    let shot = beneath.shot("", r#""lamp": (emission: 5)"#, object);
    // Six faces by midpoints; the cube reaches a quarter of a metre from its centre.
    let expected = |x: f64, z: f64| {
        let n = 12usize;
        let mut sum = 0.0;
        for face in 0..6usize {
            let (axis, sign) = (face / 2, if face % 2 == 0 { 1.0 } else { -1.0 });
            for i in 0..n * n {
                let at = |i: usize| 0.25 * ((2 * i + 1) as f64 / n as f64 - 1.0);
                let (mut q, mut normal) = ([0.0; 3], [0.0; 3]);
                (q[axis], normal[axis]) = (0.25 * sign, sign);
                (q[(axis + 1) % 3], q[(axis + 2) % 3]) = (at(i / n), at(i % n));
                let q = [q[0] + 0.3, q[1] + 2.0, q[2] + 0.2];
                sum += piece(q, normal, 0.25 / (n * n) as f64, x, z);
            }
        }
        5.0 * sum
    };
    beneath.irradiance(&shot, dir.path()).assert_is(beneath.mean(expected), MODEL, "a cube");
}

/// The pane covers all of the sky but a strip above the horizon, which the integral leaves out too.
#[test]
fn of_the_sky() {
    let beneath =
        Beneath { height: 0.2, side: 6.0, photons: "progressive(count: 150000)", ..Beneath::default() };
    let shot = beneath.shot(r#""a": environment(map: gradient(zenith: 3, horizon: 1, nadir: 0))"#, "", "");
    let expected = |x: f64, z: f64| {
        let n = 100;
        let mut sum = 0.0;
        for i in 0..n * 2 * n {
            // By cos²θ, in which cosθ dω is even.
            let cos = (((i / (2 * n)) as f64 + 0.5) / n as f64).sqrt();
            let phi = PI * ((i % (2 * n)) as f64 + 0.5) / n as f64;
            let reach = beneath.height * (1.0 - cos * cos).sqrt() / cos;
            let p = [x + reach * phi.cos(), z + reach * phi.sin()];
            if p.iter().all(|p| p.abs() < beneath.side / 2.0) {
                sum += (1.0 + 2.0 * cos) * pane(cos);
            }
        }
        PI * sum / (2 * n * n) as f64
    };
    beneath.irradiance(&shot, Path::new("")).assert_is(beneath.mean(expected), MODEL, "sky");
}

/// Glass that bends nothing changes nothing, within a lamp that rays do not meet or cut by it: what it sends into
/// itself ends at its own wall, through glass as well.
#[test]
fn of_an_unseen_sphere_with_glass_in_it() {
    for (lamp, glass) in [
        ("center: (0.1, 1.2, 0), radius: 0.4", "sphere(radius: 0.2, center: (0.1, 1.2, 0))"),
        ("center: (0.1, 0.8, 0), radius: 0.2", "box(size: (1.2, 0.3, 1.2), center: (0.1, 0.6, 0))"),
    ] {
        let mean = |objects: &str| {
            focused(format!(
                "(camera: (eye: (0, 3, 4), target: (0, 0, 0), fov_deg: 35), image: (width: 40, height: 40),
                materials: {{ \"white\": (diffuse: 0.8), \"glass\": (transmission: 1, ior: 1.0000001) }},
                lights: {{ \"l\": sphere({lamp}, radiance: 10, visible: false) }},
                objects: [(shape: quad(size: (30, 30)), material: \"white\"), {objects}])"
            ))
            .passes(16)
            .render()
            .mean()
        };
        let (with, without) = (mean(&format!("(shape: {glass}, material: \"glass\")")), mean(""));
        assert!((with / without - 1.0).abs() < 0.02, "{glass}: {with} and {without}");
    }
}
