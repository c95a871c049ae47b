//! The radiance of a tile's pixels: exact sums over passes.

use crate::math::{DVec3, Exact};

#[derive(Clone, Debug)]
pub(super) enum Radiance {
    /// As long as no pixel has a second term: half the memory of sums, whose first touch is a good part of a short
    /// render's time. They are what sums of one term are, to the bit.
    Single(Vec<DVec3>),
    Sums(Vec<Exact>),
}

fn sum_of(term: DVec3) -> Exact {
    let mut sum = Exact::default();
    sum.add(term);
    sum
}

impl Radiance {
    /// `one_pass` says that second terms are not to be expected.
    pub fn new(pixels: usize, one_pass: bool) -> Radiance {
        if one_pass {
            Radiance::Single(vec![DVec3::ZERO; pixels])
        } else {
            Radiance::Sums(vec![Exact::default(); pixels])
        }
    }

    pub fn len(&self) -> usize {
        match self {
            Radiance::Single(values) => values.len(),
            Radiance::Sums(sums) => sums.len(),
        }
    }

    /// Adds a term to a pixel that has had none if it is its `first`.
    #[inline]
    pub fn add(&mut self, i: usize, term: DVec3, first: bool) {
        match self {
            Radiance::Single(values) if first => values[i] = sum_of(term).value(),
            _ => self.sums()[i].add(term),
        }
    }

    #[inline]
    pub fn sum(&self, i: usize) -> DVec3 {
        match self {
            Radiance::Single(values) => values[i],
            Radiance::Sums(sums) => sums[i].value(),
        }
    }

    /// The sum, up to a unit and rounding.
    #[inline]
    pub fn about(&self, i: usize) -> DVec3 {
        match self {
            Radiance::Single(values) => values[i],
            Radiance::Sums(sums) => sums[i].about(),
        }
    }

    pub fn exact(&self, i: usize) -> Exact {
        match self {
            Radiance::Single(values) => sum_of(values[i]),
            Radiance::Sums(sums) => sums[i],
        }
    }

    /// All sums, made if they are not there.
    #[inline(never)]
    pub fn sums(&mut self) -> &mut [Exact] {
        if let Radiance::Single(values) = self {
            *self = Radiance::Sums(values.iter().map(|&value| sum_of(value)).collect());
        }
        match self {
            Radiance::Sums(sums) => sums,
            Radiance::Single(_) => &mut [],
        }
    }

    pub fn memory_bytes(&self) -> usize {
        match self {
            Radiance::Single(values) => size_of_val(values.as_slice()),
            Radiance::Sums(sums) => size_of_val(sums.as_slice()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn single_terms_are_sums_of_one_to_the_bit() {
        for exponent in -90..60 {
            let term = DVec3::new(1.1, -1.7, 1.0 / 3.0) * f64::from(exponent).exp2();
            let [mut single, mut sums] = [true, false].map(|one_pass| Radiance::new(2, one_pass));
            for radiance in [&mut single, &mut sums] {
                radiance.add(1, term, true);
            }
            assert_eq!(single.memory_bytes() * 2, sums.memory_bytes());
            assert_eq!((single.sum(1), single.exact(1)), (sums.sum(1), sums.exact(1)), "2^{exponent}");
            // A second term makes sums of all.
            for radiance in [&mut single, &mut sums] {
                radiance.add(1, term * 0.7, false);
                radiance.add(0, term, true);
            }
            assert_eq!([0, 1].map(|i| single.exact(i)), [0, 1].map(|i| sums.exact(i)), "2^{exponent}");
        }
    }
}
