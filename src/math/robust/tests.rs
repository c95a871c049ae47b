//! Robust arithmetic against exact integers and known cancellations.

use super::*;
use crate::math::random::{Counter, Stage};

/// Against integers, which hold these products exactly.
#[test]
fn differences_of_products_keep_what_does_not_cancel() {
    let mut counter = Counter::new(21, Stage::Test, 0);
    for _ in 0..100_000 {
        let mut int = || (counter.bits() >> 12) as i64;
        let (a, b) = (int(), int());
        let (c, d) = (a + (int() & 7) - 3, b + (int() & 7) - 3);
        let exact = i128::from(a) * i128::from(b) - i128::from(c) * i128::from(d);
        let got = difference_of_products(a as f64, b as f64, c as f64, d as f64);
        assert!((got - exact as f64).abs() <= 2.0 * f64::EPSILON * (exact as f64).abs(), "{a} {b} {c} {d}");
    }
}

#[test]
fn quadratic_roots_are_accurate_where_the_textbook_formula_is_not() {
    // (t − 1e-9)(t − 1e9): the small root vanishes in −b + √(b² − c).
    let [small, large] = quadratic_roots(1.0, -0.5 * (1e9 + 1e-9), 1.0).expect("real roots");
    assert!((small / 1e-9 - 1.0).abs() < 1e-15 && (large / 1e9 - 1.0).abs() < 1e-15);
    // Two roots 2⁻²⁵ apart: b² and a·c agree in all but the last bits.
    let e = 1.0 / f64::from(1 << 26);
    let [near, far] = quadratic_roots(1.0, -1.0, (1.0 - e) * (1.0 + e)).expect("real roots");
    assert_eq!([near, far], [1.0 - e, 1.0 + e]);
}

#[test]
fn degenerate_quadratics_have_the_roots_that_are_left() {
    assert_eq!(quadratic_roots(0.0, -1.0, 4.0), Some([2.0, f64::INFINITY]));
    assert_eq!(quadratic_roots(0.0, 1.0, 4.0), Some([f64::NEG_INFINITY, -2.0]));
    assert_eq!(quadratic_roots(1.0, 0.0, 1.0), None);
    assert_eq!(quadratic_roots(0.0, 0.0, 1.0), None);
    assert_eq!(quadratic_roots(f64::NAN, 1.0, 1.0), None);
    assert_eq!(quadratic_roots(3.0, 0.0, 0.0), Some([0.0, 0.0]));
    assert_eq!(quadratic_roots(-1.0, 0.0, 4.0), Some([-2.0, 2.0]));
}

#[test]
fn sphere_roots_are_none_for_lines_that_pass_or_are_no_lines() {
    assert_eq!(sphere_roots(DVec3::X * 2.0, DVec3::Y, 1.0), None);
    assert_eq!(sphere_roots(DVec3::X, DVec3::Y, 1.0), None, "touching");
    assert_eq!(sphere_roots(DVec3::X, DVec3::ZERO, 1.0), None);
    assert_eq!(sphere_roots(DVec3::NAN, DVec3::Y, 1.0), None);
    assert_eq!(sphere_roots(DVec3::NEG_X * 3.0, DVec3::X * 2.0, 1.0), Some([1.0, 2.0]));
}

#[test]
fn error_bounds_grow_by_one_rounding_each() {
    assert!(gamma(1) >= UNIT && gamma(1) < UNIT * (1.0 + 1e-15));
    assert!(gamma_f32(3) > 3.0 * UNIT_F32 && gamma_f32(3) < 3.000_001 * UNIT_F32);
}
