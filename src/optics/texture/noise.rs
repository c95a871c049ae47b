//! Gradient noise and its fractal sum.
//!
//! Perlin, Improving Noise, SIGGRAPH 2002: a gradient at each integer point, blended by a quintic, so
//! that the noise is C2. Here the gradients, the twelve edge directions of a cube, come from a hash of
//! the integer coordinates instead of a permutation table, so that the noise never repeats.

use super::filter::survives;
use super::{Colors, TexturePoint};
use crate::math::random::mix;
use glam::DVec3;

/// Gradient noise in [−1, 1]: 0 at integer points, mean 0, features of size 1. C2. 0 where the
/// coordinates are not finite.
pub fn gradient_noise(p: DVec3, seed: u64) -> f64 {
    if !p.is_finite() {
        return 0.0;
    }
    let cell = p.floor();
    let f = p - cell;
    // Beyond 2⁶³ the cast saturates and f is 0.
    let [x, y, z] = cell.to_array().map(|c| c as i64 as u64);
    let corner = |i: u64, j: u64, k: u64| {
        let key = seed
            .wrapping_add(x.wrapping_add(i).wrapping_mul(0x8cb9_2ba7_2f3d_8dd7))
            .wrapping_add(y.wrapping_add(j).wrapping_mul(0xd1b5_4a32_d192_ed03))
            .wrapping_add(z.wrapping_add(k).wrapping_mul(0x9e6c_63d0_876a_68e5));
        edge_gradient(mix(key), f - DVec3::new(i as f64, j as f64, k as f64))
    };
    let [u, v, w] = f.to_array().map(|t| t * t * t * (t * (6.0 * t - 15.0) + 10.0));
    let lerp = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let plane = |k: u64| {
        lerp(lerp(corner(0, 0, k), corner(1, 0, k), u), lerp(corner(0, 1, k), corner(1, 1, k), u), v)
    };
    lerp(plane(0), plane(1), w)
}

/// The product of `d` with one of the twelve directions (±1, ±1, 0), (±1, 0, ±1), (0, ±1, ±1).
fn edge_gradient(hash: u64, d: DVec3) -> f64 {
    // The upper 32 bits choose one of three planes evenly, two lower bits the signs.
    let (a, b) = match ((hash >> 32) * 3) >> 32 {
        0 => (d.x, d.y),
        1 => (d.x, d.z),
        _ => (d.y, d.z),
    };
    (if hash & 1 == 0 { a } else { -a }) + (if hash & 2 == 0 { b } else { -b })
}

/// Fractal sum in [−1, 1]: octave i has features of size 2⁻ⁱ and weight 2⁻ⁱ; octaves that a footprint
/// of this radius cannot resolve fade to their mean, 0. At most 32 octaves count.
pub fn fbm(p: DVec3, radius: f64, octaves: u32, seed: u64) -> f64 {
    let (mut sum, mut total) = (0.0, 0.0);
    let (mut weight, mut frequency) = (1.0, 1.0);
    for octave in 0..octaves.clamp(1, 32) {
        let kept = survives(radius * frequency, 1.0);
        if kept > 0.0 {
            // The lattices of the octaves are shifted, so that their zeros don't coincide.
            let shift = DVec3::new(0.137, 0.531, 0.719) * f64::from(octave);
            sum += weight * kept * gradient_noise(p * frequency + shift, mix(seed + u64::from(octave)));
        }
        total += weight;
        weight *= 0.5;
        frequency *= 2.0;
    }
    sum / total
}

/// Fractal noise between two colours. The sum x in [−1, 1] becomes the weight
/// ½ + ½·4x/√(1 + (4x)²): smooth, within (0, 1), of mean ½, and using most of the range, since x is
/// rarely beyond ±½.
#[derive(Clone, Debug)]
pub struct Noise {
    pub(super) colors: Colors,
    size_m: f64,
    octaves: u32,
}

impl Noise {
    /// `size_m`: the largest features, above 0.
    pub fn new(colors: Colors, size_m: f64, octaves: u32) -> Noise {
        Noise { colors, size_m, octaves }
    }

    pub(super) fn weight(&self, at: &TexturePoint) -> f64 {
        let x = 4.0 * fbm(at.p / self.size_m, at.radius() / self.size_m, self.octaves, 0x6e);
        0.5 + 0.5 * x / (1.0 + x * x).sqrt()
    }

    pub(super) fn step(&self) -> f64 {
        self.size_m * finest(self.octaves)
    }
}

/// A small part of the smallest feature of so many octaves, in units of the largest.
pub fn finest(octaves: u32) -> f64 {
    libm::ldexp(1.0 / 256.0, 1 - octaves.clamp(1, 32) as i32)
}
