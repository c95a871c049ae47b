//! Four double-precision lanes with operators, on the same machines as [`super::lanes`] and with the same bits.

use super::DVec3;
use super::lanes::Portable;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Four values.
pub type Four = [f64; 4];

/// Arithmetic on four lanes, rounded as IEEE 754 says, never fused. Masks are lanes of all ones or all zeros.
pub trait Doubles: Copy {
    type D: Copy;

    fn load(self, a: &Four) -> Self::D;
    fn store(self, a: Self::D) -> Four;
    fn add(self, a: Self::D, b: Self::D) -> Self::D;
    fn sub(self, a: Self::D, b: Self::D) -> Self::D;
    fn mul(self, a: Self::D, b: Self::D) -> Self::D;
    fn div(self, a: Self::D, b: Self::D) -> Self::D;
    fn neg(self, a: Self::D) -> Self::D;
    fn sqrt(self, a: Self::D) -> Self::D;
    /// `a < b ? a : b`, so `b` if either is NaN.
    fn min(self, a: Self::D, b: Self::D) -> Self::D;
    /// `a > b ? a : b`, so `b` if either is NaN.
    fn max(self, a: Self::D, b: Self::D) -> Self::D;
    /// A mask.
    fn lt(self, a: Self::D, b: Self::D) -> Self::D;
    /// A mask.
    fn le(self, a: Self::D, b: Self::D) -> Self::D;
    /// `a` where the mask is set, and `b` elsewhere.
    fn select(self, mask: Self::D, a: Self::D, b: Self::D) -> Self::D;
    /// One bit per lane of a mask, lane 0 lowest.
    fn bits(self, mask: Self::D) -> u32;
}

/// Four lanes that know how to reckon.
#[derive(Clone, Copy)]
pub struct Wide<L: Doubles> {
    l: L,
    v: L::D,
}

impl<L: Doubles> Wide<L> {
    #[inline(always)]
    pub fn of(l: L, a: &Four) -> Wide<L> {
        Wide { l, v: l.load(a) }
    }

    #[inline(always)]
    pub fn splat(l: L, a: f64) -> Wide<L> {
        Wide::of(l, &[a; 4])
    }

    #[inline(always)]
    pub fn to_array(self) -> Four {
        self.l.store(self.v)
    }

    #[inline(always)]
    pub fn min(self, b: Wide<L>) -> Wide<L> {
        Wide { v: self.l.min(self.v, b.v), ..self }
    }

    #[inline(always)]
    pub fn max(self, b: Wide<L>) -> Wide<L> {
        Wide { v: self.l.max(self.v, b.v), ..self }
    }

    #[inline(always)]
    pub fn sqrt(self) -> Wide<L> {
        Wide { v: self.l.sqrt(self.v), ..self }
    }

    #[inline(always)]
    pub fn lt(self, b: Wide<L>) -> Mask<L> {
        Mask(Wide { v: self.l.lt(self.v, b.v), ..self })
    }

    #[inline(always)]
    pub fn le(self, b: Wide<L>) -> Mask<L> {
        Mask(Wide { v: self.l.le(self.v, b.v), ..self })
    }
}

/// Which of four lanes something is true of.
#[derive(Clone, Copy)]
pub struct Mask<L: Doubles>(Wide<L>);

impl<L: Doubles> Mask<L> {
    #[inline(always)]
    pub fn select(self, a: Wide<L>, b: Wide<L>) -> Wide<L> {
        Wide { v: self.0.l.select(self.0.v, a.v, b.v), ..a }
    }

    /// One bit per lane, lane 0 lowest.
    #[inline(always)]
    pub fn bits(self) -> u32 {
        self.0.l.bits(self.0.v)
    }
}

macro_rules! operator {
    ($operator:ident, $method:ident) => {
        impl<L: Doubles> $operator for Wide<L> {
            type Output = Wide<L>;

            #[inline(always)]
            fn $method(self, b: Wide<L>) -> Wide<L> {
                Wide { v: self.l.$method(self.v, b.v), ..self }
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl<L: Doubles> Neg for Wide<L> {
    type Output = Wide<L>;

    #[inline(always)]
    fn neg(self) -> Wide<L> {
        Wide { v: self.l.neg(self.v), ..self }
    }
}

/// Four vectors.
#[derive(Clone, Copy)]
pub struct Wide3<L: Doubles> {
    pub x: Wide<L>,
    pub y: Wide<L>,
    pub z: Wide<L>,
}

impl<L: Doubles> Wide3<L> {
    /// The same vector in all lanes.
    #[inline(always)]
    pub fn splat(l: L, v: DVec3) -> Wide3<L> {
        Wide3 { x: Wide::splat(l, v.x), y: Wide::splat(l, v.y), z: Wide::splat(l, v.z) }
    }

    #[inline(always)]
    pub fn dot(self, b: Wide3<L>) -> Wide<L> {
        self.x * b.x + self.y * b.y + self.z * b.z
    }

    #[inline(always)]
    pub fn length_squared(self) -> Wide<L> {
        self.dot(self)
    }

    #[inline(always)]
    pub fn to_vectors(self) -> [DVec3; 4] {
        let (x, y, z) = (self.x.to_array(), self.y.to_array(), self.z.to_array());
        std::array::from_fn(|i| DVec3::new(x[i], y[i], z[i]))
    }
}

impl<L: Doubles> Add for Wide3<L> {
    type Output = Wide3<L>;

    #[inline(always)]
    fn add(self, b: Wide3<L>) -> Wide3<L> {
        Wide3 { x: self.x + b.x, y: self.y + b.y, z: self.z + b.z }
    }
}

impl<L: Doubles> Sub for Wide3<L> {
    type Output = Wide3<L>;

    #[inline(always)]
    fn sub(self, b: Wide3<L>) -> Wide3<L> {
        Wide3 { x: self.x - b.x, y: self.y - b.y, z: self.z - b.z }
    }
}

impl<L: Doubles> Mul<Wide<L>> for Wide3<L> {
    type Output = Wide3<L>;

    #[inline(always)]
    fn mul(self, b: Wide<L>) -> Wide3<L> {
        Wide3 { x: self.x * b, y: self.y * b, z: self.z * b }
    }
}

#[inline(always)]
fn map2(a: Four, b: Four, f: impl Fn(f64, f64) -> f64) -> Four {
    std::array::from_fn(|i| f(a[i], b[i]))
}

impl Doubles for Portable {
    type D = Four;

    #[inline(always)]
    fn load(self, a: &Four) -> Four {
        *a
    }
    #[inline(always)]
    fn store(self, a: Four) -> Four {
        a
    }
    #[inline(always)]
    fn add(self, a: Four, b: Four) -> Four {
        map2(a, b, |a, b| a + b)
    }
    #[inline(always)]
    fn sub(self, a: Four, b: Four) -> Four {
        map2(a, b, |a, b| a - b)
    }
    #[inline(always)]
    fn mul(self, a: Four, b: Four) -> Four {
        map2(a, b, |a, b| a * b)
    }
    #[inline(always)]
    fn div(self, a: Four, b: Four) -> Four {
        map2(a, b, |a, b| a / b)
    }
    #[inline(always)]
    fn neg(self, a: Four) -> Four {
        a.map(|a| -a)
    }
    #[inline(always)]
    fn sqrt(self, a: Four) -> Four {
        a.map(f64::sqrt)
    }
    #[inline(always)]
    fn min(self, a: Four, b: Four) -> Four {
        map2(a, b, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, a: Four, b: Four) -> Four {
        map2(a, b, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn lt(self, a: Four, b: Four) -> Four {
        map2(a, b, |a, b| f64::from_bits(if a < b { u64::MAX } else { 0 }))
    }
    #[inline(always)]
    fn le(self, a: Four, b: Four) -> Four {
        map2(a, b, |a, b| f64::from_bits(if a <= b { u64::MAX } else { 0 }))
    }
    #[inline(always)]
    fn select(self, mask: Four, a: Four, b: Four) -> Four {
        std::array::from_fn(|i| if mask[i].to_bits() != 0 { a[i] } else { b[i] })
    }
    #[inline(always)]
    fn bits(self, mask: Four) -> u32 {
        (0..4).fold(0, |bits, i| bits | u32::from(mask[i].to_bits() != 0) << i)
    }
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use super::{Doubles, Four};
    use crate::math::lanes::Avx2;
    use pulp::cast;
    use std::arch::x86_64::{__m256d, _CMP_LE_OQ, _CMP_LT_OQ};

    impl Doubles for Avx2 {
        type D = __m256d;

        #[inline(always)]
        fn load(self, a: &Four) -> __m256d {
            cast(*a)
        }
        #[inline(always)]
        fn store(self, a: __m256d) -> Four {
            cast(a)
        }
        #[inline(always)]
        fn add(self, a: __m256d, b: __m256d) -> __m256d {
            self.0.avx._mm256_add_pd(a, b)
        }
        #[inline(always)]
        fn sub(self, a: __m256d, b: __m256d) -> __m256d {
            self.0.avx._mm256_sub_pd(a, b)
        }
        #[inline(always)]
        fn mul(self, a: __m256d, b: __m256d) -> __m256d {
            self.0.avx._mm256_mul_pd(a, b)
        }
        #[inline(always)]
        fn div(self, a: __m256d, b: __m256d) -> __m256d {
            self.0.avx._mm256_div_pd(a, b)
        }
        #[inline(always)]
        fn neg(self, a: __m256d) -> __m256d {
            self.0.avx._mm256_xor_pd(cast([-0.0; 4]), a)
        }
        #[inline(always)]
        fn sqrt(self, a: __m256d) -> __m256d {
            self.0.avx._mm256_sqrt_pd(a)
        }
        #[inline(always)]
        fn min(self, a: __m256d, b: __m256d) -> __m256d {
            self.0.avx._mm256_min_pd(a, b)
        }
        #[inline(always)]
        fn max(self, a: __m256d, b: __m256d) -> __m256d {
            self.0.avx._mm256_max_pd(a, b)
        }
        #[inline(always)]
        fn lt(self, a: __m256d, b: __m256d) -> __m256d {
            self.0.avx._mm256_cmp_pd::<_CMP_LT_OQ>(a, b)
        }
        #[inline(always)]
        fn le(self, a: __m256d, b: __m256d) -> __m256d {
            self.0.avx._mm256_cmp_pd::<_CMP_LE_OQ>(a, b)
        }
        #[inline(always)]
        fn select(self, mask: __m256d, a: __m256d, b: __m256d) -> __m256d {
            self.0.avx._mm256_blendv_pd(b, a, mask)
        }
        #[inline(always)]
        fn bits(self, mask: __m256d) -> u32 {
            self.0.avx._mm256_movemask_pd(mask) as u32
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::lanes::{Lanes, Machine, Work};

    /// All operations on awkward values, as bits.
    struct Sample<'a>(&'a mut Vec<u64>);

    impl Work for Sample<'_> {
        type Output = ();

        fn run<L: Lanes>(self, l: L) {
            let l = l.doubles();
            let rows = [[0.1, -0.0, f64::NAN, f64::INFINITY], [1e-310, 1.7e308, -7.7, 1.0 + f64::EPSILON]];
            for a in rows {
                for b in [a.map(|v| v * 0.7), [0.0; 4], [f64::NAN; 4], a, rows[0], rows[1]] {
                    let (x, y) = (Wide::of(l, &a), Wide::of(l, &b) + Wide::splat(l, 0.3));
                    let less = x.lt(y);
                    self.0.extend([less.bits(), x.le(y).bits()].map(u64::from));
                    for z in [x + y, x - y, x * y, x / y, -x, x.sqrt(), x.min(y), x.max(y), less.select(x, y)]
                    {
                        // which NaN it is does not matter
                        self.0.extend(z.to_array().map(|v| if v.is_nan() { u64::MAX } else { v.to_bits() }));
                    }
                }
            }
        }
    }

    #[test]
    fn this_machines_lanes_have_the_bits_of_plain_arrays() {
        let (mut best, mut plain) = (Vec::new(), Vec::new());
        Machine::detect().run(Sample(&mut best));
        Machine::portable().run(Sample(&mut plain));
        assert_eq!(best, plain);
    }
}
