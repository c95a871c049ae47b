//! Bent normals: neutral maps, and slopes against derivatives.

use super::*;

/// Frames as surfaces give them, singular ones included.
fn frames(n: u64) -> Vec<(DVec3, DVec3, DVec3)> {
    let mut values = values(4);
    let mut frames = Vec::new();
    for _ in 0..n {
        let ns = vector(&mut values).normalize();
        let (a, b) = (vector(&mut values), vector(&mut values));
        for scale in [1e-4, 1.0, 1e4] {
            frames.push((ns, a * scale, b * scale));
        }
        frames.extend([(ns, DVec3::ZERO, b), (ns, a, DVec3::ZERO), (ns, DVec3::ZERO, DVec3::ZERO)]);
        frames.extend([(ns, ns, b), (ns, a, -ns * 3.0), (ns, a, a * 2.0), (ns, DVec3::NAN, b)]);
    }
    for ns in [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z] {
        frames.extend([(ns, DVec3::ZERO, DVec3::ZERO), (ns, DVec3::X, DVec3::Y), (ns, DVec3::Z, DVec3::X)]);
    }
    frames
}

#[test]
fn flat_normal_map_changes_no_bit() {
    let byte = Pyramid::new(1, 1, Texels::U8(vec![[128, 128, 255]]), Encoding::Linear).texel(0, 0, 0);
    for flat in [Color::new(0.5, 0.5, 1.0), byte, Color::new(0.5, 0.5, 0.0), Color::new(0.5, 0.5, f32::NAN)] {
        for (ns, dpdu, dpdv) in frames(200) {
            for strength in [0.0, 1.0, 10.0] {
                assert_eq!(perturbed_normal_from_map(flat, strength, ns, dpdu, dpdv), ns);
            }
        }
    }
    for (ns, dpdu, dpdv) in frames(50) {
        let tilted = Color::new(0.9, 0.2, 0.8);
        assert_eq!(perturbed_normal_from_map(tilted, 0.0, ns, dpdu, dpdv), ns);
        assert_eq!(bumped_normal(DVec2::ZERO, ns, ns, dpdu, dpdv), ns);
    }
}

#[test]
fn mapped_normals_are_unit_and_above_the_surface() {
    let mut values = values(5);
    for (ns, dpdu, dpdv) in frames(100) {
        let rgb = Color::from(std::array::from_fn(|_| values.value() as f32));
        let n = perturbed_normal_from_map(rgb, 1.0, ns, dpdu, dpdv);
        assert!((n.length() - 1.0).abs() < 1e-12 && n.dot(ns) > 0.0, "{rgb} {ns} {dpdu} {dpdv}: {n}");
        let slope = vector(&mut values).truncate() * 10.0;
        let n = bumped_normal(slope, ns, ns, dpdu, dpdv);
        assert!((n.length() - 1.0).abs() < 1e-12 && n.dot(ns) > 0.0, "{slope} {ns} {dpdu} {dpdv}: {n}");
    }
}

/// Red leans toward ∂p/∂u and green toward ∂p/∂v, also where the coordinates are mirrored, and where
/// only one of the two is known.
#[test]
fn red_leans_along_u_and_green_along_v() {
    let (red, green) = (Color::new(0.9, 0.5, 0.9), Color::new(0.5, 0.9, 0.9));
    let n = DVec3::Z;
    for (dpdu, dpdv) in [
        (DVec3::X * 3.0, DVec3::Y),
        (DVec3::X, DVec3::NEG_Y),
        (DVec3::Y, DVec3::X),
        (DVec3::new(1.0, 0.2, 5.0), DVec3::new(0.1, 1.0, -2.0)),
        (DVec3::X, DVec3::ZERO),
        (DVec3::ZERO, DVec3::Y),
    ] {
        if dpdu != DVec3::ZERO {
            assert!(perturbed_normal_from_map(red, 1.0, n, dpdu, dpdv).dot(dpdu.reject_from(n)) > 0.1);
        }
        if dpdv != DVec3::ZERO {
            assert!(perturbed_normal_from_map(green, 1.0, n, dpdu, dpdv).dot(dpdv.reject_from(n)) > 0.1);
        }
    }
    // (255, 128, 128): 45° would need equal shares; z = 0 is below the least, so it lies almost flat.
    let tilt = perturbed_normal_from_map(Color::new(1.0, 0.5, 1.0), 1.0, n, DVec3::X, DVec3::Y);
    assert!((tilt - DVec3::new(1.0, 0.0, 1.0).normalize()).length() < 1e-12);
    let half = perturbed_normal_from_map(Color::new(1.0, 0.5, 1.0), 0.5, n, DVec3::X, DVec3::Y);
    assert!((half - DVec3::new(0.5, 0.0, 1.0).normalize()).length() < 1e-12);
}

/// The cross product of the raised surface's own derivatives, for any parametrisation of a plane.
#[test]
fn bumped_normal_is_that_of_the_raised_surface() {
    let mut values = values(6);
    for _ in 0..1000 {
        let (dpdu, dpdv) = (vector(&mut values), vector(&mut values));
        let ng = dpdu.cross(dpdv).normalize() * if values.value() < 0.5 { 1.0 } else { -1.0 };
        let slope = vector(&mut values).truncate();
        let raised = (dpdu + ng * slope.x).cross(dpdv + ng * slope.y).normalize();
        let expected = if raised.dot(ng) < 0.0 { -raised } else { raised };
        let n = bumped_normal(slope, ng, ng, dpdu, dpdv);
        assert!((n - expected).length() < 1e-9, "{dpdu} {dpdv} {slope}: {n}, not {expected}");
    }
}
