//! Arithmetic that bounds or avoids rounding errors.
//!
//! Bounds: Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., SIAM 2002, §3.1.
//! Exact products: Dekker 1971 (no fused multiply-add, which is slow where the machine has none).
//! Spheres: Haines, Günther, Akenine-Möller, Precision Improvements for Ray/Sphere Intersection,
//! Ray Tracing Gems, ch. 7, 2019.

use super::Placement;
use glam::DVec3;

/// Half the distance from 1 to the next double: the relative error of one rounding.
pub const UNIT: f64 = f64::EPSILON * 0.5;

/// The same for single precision.
pub const UNIT_F32: f64 = 0.5 / (1u32 << 23) as f64;

/// γₙ: bound on the relative error of `n` roundings in double precision, `n` < 2⁵².
#[inline]
pub fn gamma(n: u32) -> f64 {
    let e = f64::from(n) * UNIT;
    e / (1.0 - e)
}

/// γₙ for single precision, `n` < 2²³.
pub fn gamma_f32(n: u32) -> f64 {
    let e = f64::from(n) * UNIT_F32;
    e / (1.0 - e)
}

/// The bound, in the world, for the surface point `p` of a placed object, itself known to within
/// `p_error` in object space: the roundings of the map to the world and of the way back to object
/// space, where a further ray is tested, are included.
pub fn placed_error(placement: &Placement, p: DVec3, p_error: f64) -> f64 {
    error_between(placement, p.abs(), placement.world_from_object.transform_point3(p).abs(), p_error)
}

/// The largest of the same over all points whose coordinates are no larger than those of `reach`, or more.
pub fn placed_error_within(placement: &Placement, reach: DVec3, p_error: f64) -> f64 {
    let there = &placement.world_from_object;
    error_between(placement, reach, there.matrix3.abs() * reach + there.translation.abs(), p_error)
}

/// The same for coordinates of these sizes in object space and in the world.
fn error_between(placement: &Placement, local: DVec3, world: DVec3, p_error: f64) -> f64 {
    let there = &placement.world_from_object;
    let back = &placement.object_from_world;
    let on_the_way = there.matrix3.abs() * local + there.translation.abs();
    let back_again = back.matrix3.abs() * world + back.translation.abs();
    let error = p_error + gamma(8) * back_again.length();
    placement.stretch() * error + gamma(8) * on_the_way.length()
}

/// a·b as an unevaluated sum of two doubles, exact for |a|, |b| < 2⁴⁹⁰ and no underflow.
fn exact_product(a: f64, b: f64) -> (f64, f64) {
    // Veltkamp's split into 26 bits each.
    const SPLIT: f64 = (1u64 << 27) as f64 + 1.0;
    let halves = |x: f64| {
        let c = SPLIT * x;
        let high = c - (c - x);
        (high, x - high)
    };
    let product = a * b;
    let ((ah, al), (bh, bl)) = (halves(a), halves(b));
    (product, ((ah * bh - product) + ah * bl + al * bh) + al * bl)
}

/// a·b − c·d to within two roundings of the result, however much of it cancels.
pub fn difference_of_products(a: f64, b: f64, c: f64, d: f64) -> f64 {
    let (p, p_rest) = exact_product(a, b);
    let (q, q_rest) = exact_product(c, d);
    // Knuth's sum: difference + rest = p − q exactly.
    let difference = p - q;
    let z = difference - p;
    let rest = (p - (difference - z)) + (-q - z);
    difference + (rest + (p_rest - q_rest))
}

/// The real roots, in ascending order, of a·t² + 2·b·t + c. With a = 0 the missing root is the
/// infinity towards which it has gone. `None` without real roots, for a = b = 0 and for NaN.
pub fn quadratic_roots(a: f64, b: f64, c: f64) -> Option<[f64; 2]> {
    let discriminant = difference_of_products(b, b, a, c);
    if discriminant < 0.0 || discriminant.is_nan() {
        return None;
    }
    // Both terms of q have the same sign, so that nothing cancels.
    let q = -(b + discriminant.sqrt().copysign(b));
    if q == 0.0 {
        return (a != 0.0).then_some([0.0, 0.0]);
    }
    if a == 0.0 {
        // The curve falls towards the side where the other root is: +∞ for b < 0.
        let root = c / q;
        return Some(if b < 0.0 { [root, f64::INFINITY] } else { [f64::NEG_INFINITY, root] });
    }
    let (t, s) = (q / a, c / q);
    Some(if t <= s { [t, s] } else { [s, t] })
}

/// A vector whose length is 1 but for rounding, of length 1 again; any other is normalised as well.
/// Newton's step for the inverse square root, whose error of 3/8·(‖v‖² − 1)² is far below one rounding.
#[inline]
pub fn renormalized(v: DVec3) -> DVec3 {
    let length2 = v.length_squared();
    let excess = length2 - 1.0;
    if excess.abs() < 1e-8 { v * (1.0 - 0.5 * excess) } else { v * (1.0 / length2.sqrt()) }
}

/// 1/x, for x close to 1 without a division: 2 − x is off by (x − 1)².
#[inline]
fn reciprocal_near_one(x: f64) -> f64 {
    if (x - 1.0).abs() < 1e-8 { 2.0 - x } else { 1.0 / x }
}

/// The two distances, ascending and different, at which the line `from_center` + t·`dir` crosses a
/// sphere of `radius` around 0. `dir` need not be of unit length; a line that only touches misses.
#[inline]
pub fn sphere_roots(from_center: DVec3, dir: DVec3, radius: f64) -> Option<[f64; 2]> {
    let a = dir.length_squared();
    if a <= 0.0 || a.is_nan() {
        return None;
    }
    let b = -from_center.dot(dir);
    let inverse = reciprocal_near_one(a);
    // How far the line passes from the centre: small numbers only, however far the origin.
    let nearest2 = (from_center + dir * (b * inverse)).length_squared();
    let radius2 = radius * radius;
    let quarter_chord2 = radius2 - nearest2;
    if quarter_chord2 <= 0.0 || quarter_chord2.is_nan() {
        return None;
    }
    let c = from_center.length_squared() - radius2;
    let q = b + (a * quarter_chord2).sqrt().copysign(b);
    let (t, s) = (q * inverse, c / q);
    let roots = if t <= s { [t, s] } else { [s, t] };
    (roots[0] < roots[1]).then_some(roots)
}

#[cfg(test)]
mod tests;
