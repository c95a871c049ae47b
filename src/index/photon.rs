//! A photon without its position, in sixteen bytes.
//!
//! Directions are points of the octahedron folded onto a square (Cigolle et al., A Survey of
//! Efficient Representations for Independent Unit Vectors, JCGT 3(2), 2014), sixteen bits a
//! coordinate: off by 7e-5 rad at most, and exact along the axes. Power is three mantissas of
//! sixteen bits under one exponent (Ward, Real Pixels, Graphics Gems II, 1991, with longer
//! mantissas): a step is 2⁻¹⁵ to 2⁻¹⁶ of the largest channel. Photons often carry equal power, so
//! rounding to nearest would bend all of them the same way; each is rounded up with the probability
//! of its fraction instead, by a value that is a hash of its index, and the mean is kept.

use crate::math::{Color, Vec3, random};
use crate::optics::Face;
use crate::scatter::Photon;

const LARGEST: f32 = 32767.0;

/// A code that no direction has.
pub const NO_DIRECTION: u32 = 0x8000_8000;

/// A photon's directions and power.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Packed {
    pub normal: u32,
    wi: u32,
    power: [u16; 3],
    /// Biased by 127, as in a float.
    exponent: u8,
    pub face: Face,
}

impl Packed {
    /// `index` is the photon's place among its fellows; it decides how its power is rounded.
    pub fn new(photon: &Photon, index: usize) -> Packed {
        let (power, exponent) = pack_power(photon.power, index as u64);
        let (normal, wi) = (pack_direction(photon.normal), pack_direction(photon.wi));
        Packed { normal, wi, power, exponent, face: photon.face }
    }

    #[inline(always)]
    pub fn wi(&self) -> Vec3 {
        unpack_direction(self.wi)
    }

    /// Watts a channel.
    #[inline(always)]
    pub fn power(&self) -> Color {
        let step = f32::from_bits(u32::from(self.exponent) << 23);
        let [r, g, b] = self.power.map(f32::from);
        Color::new(r, g, b) * step
    }
}

/// Sixteen bits each of the two coordinates of a unit vector on the folded octahedron.
pub fn pack_direction(d: Vec3) -> u32 {
    let [x, y, z] = (d / (d.x.abs() + d.y.abs() + d.z.abs())).to_array();
    let sign = |v: f32| if v < 0.0 { -1.0 } else { 1.0 };
    let (u, v) = if z < 0.0 { ((1.0 - y.abs()) * sign(x), (1.0 - x.abs()) * sign(y)) } else { (x, y) };
    // To the nearest, halves away from 0: exact in double precision.
    let bits = |v: f32| {
        let v = f64::from(v * LARGEST);
        u32::from((v + 0.5f64.copysign(v)) as i16 as u16)
    };
    bits(u) | bits(v) << 16
}

/// The unit vector of a code.
#[inline(always)]
pub fn unpack_direction(code: u32) -> Vec3 {
    let (u, v) = (f32::from(code as i16) / LARGEST, f32::from((code >> 16) as i16) / LARGEST);
    let z = 1.0 - u.abs() - v.abs();
    // below the equator the square's corners fold under
    let fold = if z < 0.0 { -z } else { 0.0 };
    let x = if u < 0.0 { u + fold } else { u - fold };
    let y = if v < 0.0 { v + fold } else { v - fold };
    Vec3::new(x, y, z) * (1.0 / (x * x + y * y + z * z).sqrt())
}

/// 2 to the power of `exponent`, which is one of a normal number.
fn power_of_two(exponent: i32) -> f32 {
    f32::from_bits(((exponent + 127) as u32) << 23)
}

/// Mantissas and biased exponent of watts, which are between 0 and 1e38.
fn pack_power(power: Vec3, index: u64) -> ([u16; 3], u8) {
    let largest = power.max_element();
    // the largest channel's mantissa has sixteen bits, unless the exponent ends there
    let mut exponent = ((largest.to_bits() >> 23) as i32 - 127 - 15).max(-126);
    if largest / power_of_two(exponent) > 65535.0 {
        exponent += 1; // rounding up must find room
    }
    let step = f64::from(power_of_two(exponent));
    let mantissa = |channel: usize| {
        let exact = f64::from(power[channel]) / step;
        let whole = exact as u32;
        let up = random::unit(random::combine(index, channel as u64)) < exact - f64::from(whole);
        (whole + u32::from(up)) as u16
    };
    ([mantissa(0), mantissa(1), mantissa(2)], (exponent + 127) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::{Counter, Stage};

    #[test]
    fn a_direction_comes_back_within_7e_5_rad_and_axes_exactly() {
        let mut random = Counter::new(1, Stage::Test, 0);
        for _ in 0..100_000 {
            let v = Vec3::from_array([(); 3].map(|()| random.value() as f32 * 2.0 - 1.0));
            if v.length() < 0.01 {
                continue;
            }
            let d = v.normalize();
            let back = unpack_direction(pack_direction(d));
            assert!((back - d).length() < 7e-5, "{d} came back as {back}");
            assert!((back.length() - 1.0).abs() < 2e-7);
        }
        for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
            for d in [axis, -axis] {
                assert_eq!(unpack_direction(pack_direction(d)), d);
            }
        }
    }

    fn photon(power: Vec3) -> Photon {
        Photon { position: Vec3::ZERO, wi: Vec3::Y, normal: Vec3::Y, power, face: Face::Opaque }
    }

    /// A channel's rounding error is uniform over a step of at most 2⁻¹⁵ of the largest channel, so
    /// the mean of n has a standard error under 0.5 · 2⁻¹⁵ / √n; five of them are allowed. Rounding
    /// to nearest would be off by up to 2⁻¹⁷ always.
    #[test]
    fn equal_powers_keep_their_mean_to_the_last_bits() {
        let n = 1 << 18;
        for power in [Vec3::new(1.0, 0.123_456, 3.3e-6), Vec3::new(65535.3, 65535.9, 1.0), Vec3::splat(1e-30)]
        {
            let sum = (0..n).fold([0.0f64; 3], |sum, i| {
                let p = Packed::new(&photon(power), i).power();
                std::array::from_fn(|c| sum[c] + f64::from(p[c]))
            });
            let bound = 5.0 * 0.5 / 32768.0 / f64::from(n as u32).sqrt() * f64::from(power.max_element());
            for c in 0..3 {
                let off = sum[c] / f64::from(n as u32) - f64::from(power[c]);
                assert!(off.abs() < bound, "{power}, channel {c}: off by {off}, allowed {bound}");
            }
        }
    }

    #[test]
    fn powers_from_nothing_to_1e38_come_back() {
        for v in [0.0, f32::MIN_POSITIVE, 1e-20, 1.0, 1.999_999_9, 65535.5, 1e20, 1e38] {
            let p = Packed::new(&photon(Vec3::new(v, 0.0, v / 2.0)), 7).power();
            assert!(p.is_finite() && p.y == 0.0);
            assert!((p.x - v).abs() <= v * 3.1e-5, "{v} came back as {}", p.x);
        }
        let smallest = f32::from_bits(1);
        assert!(Packed::new(&photon(Vec3::splat(smallest)), 7).power().is_finite());
    }
}
