//! Eight single-precision lanes, in two implementations with the same bits: AVX2 through `pulp`'s
//! safe run-time dispatch, and plain arrays for every other machine.
//!
//! The operations are the ones that IEEE 754 rounds exactly, never a fused multiply-add, so that
//! both implementations agree. `min` and `max` return the *second* operand when either is NaN;
//! the slab test relies on that.

use super::doubles::Doubles;

/// Eight values.
pub type Array = [f32; 8];

/// Arithmetic on eight lanes. Comparisons return one bit per lane, lane 0 lowest.
pub trait Lanes: Copy {
    type F: Copy;
    /// Four double-precision lanes on the same machine.
    type Doubles: Doubles;

    fn doubles(self) -> Self::Doubles;

    fn load(self, a: &Array) -> Self::F;
    fn store(self, a: Self::F) -> Array;
    fn splat(self, a: f32) -> Self::F;
    fn add(self, a: Self::F, b: Self::F) -> Self::F;
    fn sub(self, a: Self::F, b: Self::F) -> Self::F;
    fn mul(self, a: Self::F, b: Self::F) -> Self::F;
    fn div(self, a: Self::F, b: Self::F) -> Self::F;
    fn abs(self, a: Self::F) -> Self::F;
    /// `a < b ? a : b`, so `b` if either is NaN.
    fn min(self, a: Self::F, b: Self::F) -> Self::F;
    /// `a > b ? a : b`, so `b` if either is NaN.
    fn max(self, a: Self::F, b: Self::F) -> Self::F;
    fn le(self, a: Self::F, b: Self::F) -> u32;
    fn lt(self, a: Self::F, b: Self::F) -> u32;
    fn eq(self, a: Self::F, b: Self::F) -> u32;
}

/// Work that is generic over the lanes; its `run` must be `#[inline(always)]` all the way down, so
/// that it is compiled for the instructions of the lanes it gets.
pub trait Work {
    type Output;
    fn run<L: Lanes>(self, lanes: L) -> Self::Output;
}

/// Arrays, which compilers turn into whatever vectors the target is known to have.
#[derive(Clone, Copy, Debug)]
pub struct Portable;

#[inline(always)]
fn map2(a: Array, b: Array, f: impl Fn(f32, f32) -> f32) -> Array {
    std::array::from_fn(|i| f(a[i], b[i]))
}

#[inline(always)]
fn bits(a: Array, b: Array, f: impl Fn(f32, f32) -> bool) -> u32 {
    (0..8).fold(0, |mask, i| mask | u32::from(f(a[i], b[i])) << i)
}

impl Lanes for Portable {
    type F = Array;
    type Doubles = Portable;

    #[inline(always)]
    fn doubles(self) -> Portable {
        self
    }

    #[inline(always)]
    fn load(self, a: &Array) -> Array {
        *a
    }
    #[inline(always)]
    fn store(self, a: Array) -> Array {
        a
    }
    #[inline(always)]
    fn splat(self, a: f32) -> Array {
        [a; 8]
    }
    #[inline(always)]
    fn add(self, a: Array, b: Array) -> Array {
        map2(a, b, |a, b| a + b)
    }
    #[inline(always)]
    fn sub(self, a: Array, b: Array) -> Array {
        map2(a, b, |a, b| a - b)
    }
    #[inline(always)]
    fn mul(self, a: Array, b: Array) -> Array {
        map2(a, b, |a, b| a * b)
    }
    #[inline(always)]
    fn div(self, a: Array, b: Array) -> Array {
        map2(a, b, |a, b| a / b)
    }
    #[inline(always)]
    fn abs(self, a: Array) -> Array {
        a.map(f32::abs)
    }
    #[inline(always)]
    fn min(self, a: Array, b: Array) -> Array {
        map2(a, b, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, a: Array, b: Array) -> Array {
        map2(a, b, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn le(self, a: Array, b: Array) -> u32 {
        bits(a, b, |a, b| a <= b)
    }
    #[inline(always)]
    fn lt(self, a: Array, b: Array) -> u32 {
        bits(a, b, |a, b| a < b)
    }
    #[inline(always)]
    fn eq(self, a: Array, b: Array) -> u32 {
        bits(a, b, |a, b| a == b)
    }
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use super::{Array, Lanes};
    use pulp::{cast, x86::V3};
    use std::arch::x86_64::{__m256, _CMP_EQ_OQ, _CMP_LE_OQ, _CMP_LT_OQ};

    /// AVX2 registers, on a machine that was seen to have them.
    #[derive(Clone, Copy, Debug)]
    pub struct Avx2(pub V3);

    impl Lanes for Avx2 {
        type F = __m256;
        type Doubles = Avx2;

        #[inline(always)]
        fn doubles(self) -> Avx2 {
            self
        }

        #[inline(always)]
        fn load(self, a: &Array) -> __m256 {
            cast(*a)
        }
        #[inline(always)]
        fn store(self, a: __m256) -> Array {
            cast(a)
        }
        #[inline(always)]
        fn splat(self, a: f32) -> __m256 {
            self.0.avx._mm256_set1_ps(a)
        }
        #[inline(always)]
        fn add(self, a: __m256, b: __m256) -> __m256 {
            self.0.avx._mm256_add_ps(a, b)
        }
        #[inline(always)]
        fn sub(self, a: __m256, b: __m256) -> __m256 {
            self.0.avx._mm256_sub_ps(a, b)
        }
        #[inline(always)]
        fn mul(self, a: __m256, b: __m256) -> __m256 {
            self.0.avx._mm256_mul_ps(a, b)
        }
        #[inline(always)]
        fn div(self, a: __m256, b: __m256) -> __m256 {
            self.0.avx._mm256_div_ps(a, b)
        }
        #[inline(always)]
        fn abs(self, a: __m256) -> __m256 {
            self.0.avx._mm256_andnot_ps(self.splat(-0.0), a)
        }
        #[inline(always)]
        fn min(self, a: __m256, b: __m256) -> __m256 {
            self.0.avx._mm256_min_ps(a, b)
        }
        #[inline(always)]
        fn max(self, a: __m256, b: __m256) -> __m256 {
            self.0.avx._mm256_max_ps(a, b)
        }
        #[inline(always)]
        fn le(self, a: __m256, b: __m256) -> u32 {
            self.0.avx._mm256_movemask_ps(self.0.avx._mm256_cmp_ps::<_CMP_LE_OQ>(a, b)) as u32
        }
        #[inline(always)]
        fn lt(self, a: __m256, b: __m256) -> u32 {
            self.0.avx._mm256_movemask_ps(self.0.avx._mm256_cmp_ps::<_CMP_LT_OQ>(a, b)) as u32
        }
        #[inline(always)]
        fn eq(self, a: __m256, b: __m256) -> u32 {
            self.0.avx._mm256_movemask_ps(self.0.avx._mm256_cmp_ps::<_CMP_EQ_OQ>(a, b)) as u32
        }
    }
}

#[cfg(target_arch = "x86_64")]
pub(super) use avx2::Avx2;

/// Which lanes this machine runs.
#[derive(Clone, Copy, Debug)]
pub struct Machine {
    #[cfg(target_arch = "x86_64")]
    avx2: Option<pulp::x86::V3>,
}

impl Machine {
    /// The fastest that this machine has.
    pub fn detect() -> Machine {
        Machine {
            #[cfg(target_arch = "x86_64")]
            avx2: pulp::x86::V3::try_new(),
        }
    }

    /// The arrays, whatever the machine has.
    #[cfg(test)]
    pub fn portable() -> Machine {
        Machine {
            #[cfg(target_arch = "x86_64")]
            avx2: None,
        }
    }

    #[inline(always)]
    pub fn run<W: Work>(self, work: W) -> W::Output {
        #[cfg(target_arch = "x86_64")]
        if let Some(v3) = self.avx2 {
            return v3.vectorize(
                #[inline(always)]
                || work.run(avx2::Avx2(v3)),
            );
        }
        work.run(Portable)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums, products and comparisons of awkward values, as bits.
    struct Sample<'a>(&'a mut Vec<u32>);

    impl Work for Sample<'_> {
        type Output = ();

        fn run<L: Lanes>(self, l: L) {
            let a = [0.1, -0.0, f32::NAN, f32::INFINITY, 1e-40, 3e38, -7.7, 1.000_000_1];
            for b in [a.map(|v| v * 0.7), [0.0; 8], [f32::NAN; 8], a] {
                let (x, y) = (l.load(&a), l.add(l.load(&b), l.splat(0.3)));
                self.0.extend([l.le(x, y), l.lt(x, y), l.eq(x, y)]);
                for z in
                    [l.add(x, y), l.sub(x, y), l.mul(x, y), l.div(x, y), l.min(x, y), l.max(x, y), l.abs(x)]
                {
                    // which NaN it is does not matter
                    self.0.extend(l.store(z).map(|v| if v.is_nan() { u32::MAX } else { v.to_bits() }));
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
