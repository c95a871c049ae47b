//! Warps from the unit square [0, 1)² to the domains that light transport samples, each beside its
//! density. Directions are in a local frame whose third axis is the normal or the cone's axis.
//!
//! Concentric disk: Shirley & Chiu, A Low Distortion Map Between Disk and Square, JGT 2(3), 1997.
//! Triangle: Heitz, A Low-Distortion Map Between Triangle and Square, 2019.

mod cells;
mod discrete;

pub use cells::SphericalCell;
pub use discrete::{AliasTable, Cdf, Choice, pick};

use super::doubles::{Doubles, Wide};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_1_PI, FRAC_PI_2, FRAC_PI_4, TAU};

/// Density of [`disk`], per unit area.
pub const DISK_PDF: f64 = FRAC_1_PI;

/// Density of [`sphere`], in 1/sr.
pub const SPHERE_PDF: f64 = 0.25 * FRAC_1_PI;

/// Uniform on the unit disk; squares around (½, ½) become circles around the centre.
pub fn disk(u: [f64; 2]) -> DVec2 {
    let (x, y) = (2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0);
    if x == 0.0 && y == 0.0 {
        return DVec2::ZERO;
    }
    let (r, angle) =
        if x.abs() > y.abs() { (x, FRAC_PI_4 * (y / x)) } else { (y, FRAC_PI_2 - FRAC_PI_4 * (x / y)) };
    let (sin, cos) = libm::sincos(angle);
    DVec2::new(r * cos, r * sin)
}

/// Four such points.
#[inline(always)]
pub fn disk_four<L: Doubles>(l: L, [u, v]: [Wide<L>; 2]) -> [Wide<L>; 2] {
    let (one, two) = (Wide::splat(l, 1.0), Wide::splat(l, 2.0));
    let (x, y) = (two * u - one, two * v - one);
    let aslant = y.max(-y).lt(x.max(-x));
    let (r, short) = (aslant.select(x, y), aslant.select(y, x));
    let ratio = (short / r).min(one);
    let (sin, cos) = sin_cos(l, Wide::splat(l, FRAC_PI_4) * ratio, OF_AN_EIGHTH);
    // In the middle the ratio is not a number, and was taken as 1.
    [r * aslant.select(cos, sin), r * aslant.select(sin, cos)]
}

/// How many terms of the series give sine and cosine to full precision up to π/4, and up to π/10.
const OF_AN_EIGHTH: usize = 8;
const OF_A_CELL: usize = 5;

/// Sine and cosine of small angles by so many terms of their series.
#[inline(always)]
fn sin_cos<L: Doubles>(l: L, x: Wide<L>, terms: usize) -> (Wide<L>, Wide<L>) {
    // −1/(k·(k+1)) by multiplication: a chain of divisions would take longer than all else of a sample.
    const fn parts(first: u32) -> [f64; OF_AN_EIGHTH] {
        let (mut parts, mut i) = ([0.0; OF_AN_EIGHTH], 0);
        while i < OF_AN_EIGHTH {
            let k = first + 2 * i as u32;
            parts[i] = -1.0 / (k * (k + 1)) as f64;
            i += 1;
        }
        parts
    }
    let (of_sin, of_cos) = const { (parts(2), parts(3)) };
    let (one, y) = (Wide::splat(l, 1.0), x * x);
    let (mut sin, mut cos) = (one, one);
    for i in (0..terms).rev() {
        sin = one + Wide::splat(l, of_sin[i]) * y * sin;
        cos = one + Wide::splat(l, of_cos[i]) * y * cos;
    }
    (x * sin, one - Wide::splat(l, 0.5) * y * cos)
}

/// Density cosθ/π around +z.
pub fn cosine_hemisphere(u: [f64; 2]) -> DVec3 {
    let d = disk(u);
    d.extend((1.0 - d.length_squared()).max(0.0).sqrt())
}

/// Density of [`cosine_hemisphere`] in 1/sr; 0 below the horizon.
pub fn cosine_hemisphere_pdf(cos_theta: f64) -> f64 {
    cos_theta.max(0.0) * FRAC_1_PI
}

/// Uniform on the unit sphere.
pub fn sphere(u: [f64; 2]) -> DVec3 {
    let z = 1.0 - 2.0 * u[0];
    // 1 − z² without its cancellation at the poles.
    let r = 2.0 * (u[0] * (1.0 - u[0])).sqrt();
    around_z(r, z, u[1])
}

/// Uniform over the directions within θmax ≤ 90° of +z, given sin²θmax. Accurate at any angle.
pub fn cone(sin2_theta_max: f64, u: [f64; 2]) -> DVec3 {
    let s = u[0] * one_minus_cos(sin2_theta_max);
    around_z((s * (2.0 - s)).sqrt(), 1.0 - s, u[1])
}

/// Density of [`cone`] in 1/sr, within the cone; infinite for a cone of no width.
pub fn cone_pdf(sin2_theta_max: f64) -> f64 {
    1.0 / (TAU * one_minus_cos(sin2_theta_max))
}

/// 1 − cosθ for θ ≤ 90°, from sin²θ: to full relative accuracy where θ is small.
pub fn one_minus_cos(sin2_theta: f64) -> f64 {
    sin2_theta / (1.0 + (1.0 - sin2_theta).max(0.0).sqrt())
}

/// Barycentric coordinates, uniform over a triangle: the density is 1 / its area.
pub fn triangle(u: [f64; 2]) -> [f64; 3] {
    let [b0, b1] = if u[0] < u[1] {
        let half = 0.5 * u[0];
        [half, u[1] - half]
    } else {
        let half = 0.5 * u[1];
        [u[0] - half, half]
    };
    [b0, b1, (1.0 - b0 - b1).max(0.0)]
}

/// Density (n+1)/2π·cosⁿθ around +z, `exponent` n ≥ 0 of any size.
pub fn phong_lobe(exponent: f64, u: [f64; 2]) -> DVec3 {
    // cosθ = (1−u)^(1/(n+1)), by way of its logarithm, which keeps sinθ accurate in narrow lobes.
    let ln_cos = libm::log1p(-u[0]) / (exponent + 1.0);
    let sin = (-libm::expm1(2.0 * ln_cos)).max(0.0).sqrt();
    around_z(sin, libm::exp(ln_cos), u[1])
}

/// Density of [`phong_lobe`] in 1/sr; 0 below the horizon.
pub fn phong_lobe_pdf(exponent: f64, cos_theta: f64) -> f64 {
    if cos_theta <= 0.0 {
        return 0.0;
    }
    (exponent + 1.0) / TAU * libm::pow(cos_theta, exponent)
}

fn around_z(r: f64, z: f64, turn: f64) -> DVec3 {
    let (sin, cos) = libm::sincos(TAU * turn);
    DVec3::new(r * cos, r * sin, z)
}

#[cfg(test)]
mod tests;
