//! Sums that do not depend on the order of their terms.
//!
//! Floating-point addition is not associative: passes added in another grouping give other bits. Whole numbers
//! of a fixed unit are, so that parts of a render that were made apart, in any order, sum to the same bits.

use super::DVec3;

/// Units in 1, as a power of two.
const UNITS: i32 = 60;

/// A sum of three channels in units of 2⁻⁶⁰ ≈ 8.7e-19, each term within ±[`Exact::LIMIT`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exact([i128; 3]);

impl Exact {
    /// The largest term, 2⁴⁵ ≈ 3.5e13: 2²¹ of them fit.
    pub const LIMIT: f64 = (1u64 << 45) as f64;

    /// What terms are truncated to a multiple of.
    pub const UNIT: f64 = 1.0 / ONE;

    /// 32-bit words of one sum.
    pub const WORDS: usize = 12;

    /// Adds a term; what is beyond the limit counts as the limit, NaN as 0.
    #[inline]
    pub fn add(&mut self, term: DVec3) {
        if !term.abs().cmplt(DVec3::splat(NEAR)).all() {
            return self.add_far(term);
        }
        // No number of such terms takes a sum from [`FULL`] over the edge.
        for (sum, t) in self.0.iter_mut().zip(term.to_array()) {
            *sum = sum.wrapping_add(near_units(t));
        }
    }

    /// The same of any term; of one that is near, with the same result.
    #[cold]
    #[inline(never)]
    fn add_far(&mut self, term: DVec3) {
        self.join(&Exact(term.to_array().map(units)));
    }

    /// The sum, rounded at most twice.
    #[inline]
    pub fn value(&self) -> DVec3 {
        // In two 64-bit parts: faster than the conversion from 128 bits.
        const HIGH: f64 = (1u64 << (64 - UNITS)) as f64;
        const LOW: f64 = 1.0 / (1u64 << UNITS) as f64;
        let one = |sum: i128| {
            let size = sum.unsigned_abs();
            let value = (size >> 64) as u64 as f64 * HIGH + size as u64 as f64 * LOW;
            if sum < 0 { -value } else { value }
        };
        DVec3::from_array(self.0.map(one))
    }

    /// The sum, up to a unit and rounding: faster for those between 0 and 16.
    #[inline]
    pub fn about(&self) -> DVec3 {
        const HALF: f64 = 2.0 / ONE;
        if self.0.iter().all(|sum| sum >> 64 == 0) {
            return DVec3::from_array(self.0.map(|sum| (sum as u64 >> 1) as i64 as f64 * HALF));
        }
        self.value()
    }

    /// The sum of both sums' terms.
    pub fn join(&mut self, other: &Exact) {
        let one = |sum: i128, more: i128| sum.saturating_add(more).clamp(-FULL, FULL);
        self.0.iter_mut().zip(other.0).for_each(|(sum, more)| *sum = one(*sum, more));
    }

    pub fn to_words(self) -> [u32; Self::WORDS] {
        std::array::from_fn(|i| (self.0[i / 4] >> (32 * (i % 4))) as u32)
    }

    pub fn from_words(words: [u32; Self::WORDS]) -> Exact {
        let one =
            |c: usize| (0..4).fold(0u128, |sum, i| sum | u128::from(words[4 * c + i]) << (32 * i)) as i128;
        Exact([one(0), one(1), one(2)])
    }
}

const ONE: f64 = (1u64 << UNITS) as f64;

/// Terms below it have units of 64 bits.
const NEAR: f64 = (1u64 << (63 - UNITS)) as f64;

/// Sums stop there.
const FULL: i128 = 1 << 126;

/// Of a term within ±[`NEAR`].
#[inline]
fn near_units(term: f64) -> i128 {
    i128::from((term * ONE) as i64)
}

/// In two 64-bit parts: twice as fast as the conversion to 128 bits.
fn units(term: f64) -> i128 {
    // NaN becomes 0 in the conversions, which truncate.
    let term = term.clamp(-Exact::LIMIT, Exact::LIMIT);
    let whole = term as i64;
    (i128::from(whole) << UNITS) + i128::from(((term - whole as f64) * ONE) as i64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::{mix, unit};

    fn terms() -> Vec<DVec3> {
        let of = |i: u64| (unit(mix(i)) - 0.5) * libm::exp2((mix(i + 7777) % 60) as f64 - 30.0);
        (0..999).map(|i| DVec3::new(of(i), of(i + 5000), -of(i + 9000).abs())).collect()
    }

    fn sum<'a>(terms: impl Iterator<Item = &'a DVec3>) -> Exact {
        let mut sum = Exact::default();
        terms.for_each(|term| sum.add(*term));
        sum
    }

    #[test]
    fn any_order_and_any_parts_give_the_same_bits() {
        let terms = terms();
        let whole = sum(terms.iter());
        assert_eq!(sum(terms.iter().rev()), whole);
        let mut parts = sum(terms.iter().skip(1).step_by(2));
        parts.join(&sum(terms.iter().step_by(2)));
        assert_eq!(parts, whole);
        assert_eq!(Exact::from_words(whole.to_words()), whole);
        for term in &terms {
            let one = sum(std::iter::once(term));
            assert!((one.about() - one.value()).abs().max_element() < 1.8e-18, "{term}");
        }
        let plain: DVec3 = terms.iter().sum();
        // What 999 additions in double precision may round off (Higham 2002, 4.2), and the units.
        let size: DVec3 = terms.iter().map(|term| term.abs()).sum();
        let off = (whole.value() - plain).abs();
        assert!(off.cmple(size * (999.0 * f64::EPSILON)).all(), "{} {plain}", whole.value());
    }

    #[test]
    fn both_ways_to_units_agree() {
        for i in 0..99_999u64 {
            let t = (unit(mix(i)) - 0.5) * 2.0 * NEAR * libm::exp2(-((mix(i + 7777) % 60) as f64));
            assert_eq!(near_units(t), units(t), "{t:e}");
            let (mut near, mut far) = (Exact::default(), Exact::default());
            near.add(DVec3::splat(t));
            far.add_far(DVec3::splat(t));
            assert_eq!(near, far);
        }
    }

    #[test]
    fn a_term_is_off_by_less_than_its_unit_and_single_precision_values_above_it_by_nothing() {
        for v in [1.0, -0.1, 1e-18, 3.5e13, 12345.678, f64::from(0.3f32), f64::from(7e-9f32)] {
            let mut one = Exact::default();
            one.add(DVec3::splat(v));
            assert!((one.value().x - v).abs() <= v.abs() * f64::EPSILON + 8.7e-19, "{v}");
        }
        let mut odd = Exact::default();
        odd.add(DVec3::new(f64::NAN, 1e300, f64::NEG_INFINITY));
        assert_eq!(odd.value(), DVec3::new(0.0, Exact::LIMIT, -Exact::LIMIT));
    }
}
