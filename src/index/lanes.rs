//! Eight single-precision lanes, in two implementations with the same bits: AVX2 through `pulp`'s
//! safe run-time dispatch, and plain arrays for every other machine. Never a fused multiply-add.

/// Eight values.
pub type Array = [f32; 8];

/// Arithmetic on eight lanes.
pub trait Lanes: Copy {
    type F: Copy;

    fn load(self, a: &Array) -> Self::F;
    fn store(self, a: Self::F) -> Array;
    fn splat(self, a: f32) -> Self::F;
    fn add(self, a: Self::F, b: Self::F) -> Self::F;
    fn sub(self, a: Self::F, b: Self::F) -> Self::F;
    fn mul(self, a: Self::F, b: Self::F) -> Self::F;
    /// `a > b ? a : b`, so `b` if either is NaN.
    fn max(self, a: Self::F, b: Self::F) -> Self::F;
    /// One bit a lane, lane 0 lowest; none where either is NaN.
    fn le(self, a: Self::F, b: Self::F) -> u32;
}

/// Work that is generic over the lanes. What it runs must be inlined all the way down to be compiled
/// for the instructions of the lanes it gets.
pub trait Work {
    fn run<L: Lanes>(self, lanes: L);
}

/// Runs `work` on the best lanes of this machine.
#[inline(always)]
pub fn run(work: impl Work) {
    #[cfg(target_arch = "x86_64")]
    if let Some(v3) = pulp::x86::V3::try_new() {
        return v3.vectorize(
            #[inline(always)]
            || work.run(avx2::Avx2(v3)),
        );
    }
    work.run(Portable);
}

/// Arrays, which compilers turn into whatever vectors the target is known to have.
#[derive(Clone, Copy, Debug)]
pub struct Portable;

#[inline(always)]
fn map2(a: Array, b: Array, f: impl Fn(f32, f32) -> f32) -> Array {
    std::array::from_fn(|i| f(a[i], b[i]))
}

impl Lanes for Portable {
    type F = Array;

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
    fn max(self, a: Array, b: Array) -> Array {
        map2(a, b, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn le(self, a: Array, b: Array) -> u32 {
        (0..8).fold(0, |mask, i| mask | u32::from(a[i] <= b[i]) << i)
    }
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use super::{Array, Lanes};
    use pulp::{cast, x86::V3};
    use std::arch::x86_64::{__m256, _CMP_LE_OQ};

    /// AVX2 registers, on a machine that was seen to have them.
    #[derive(Clone, Copy, Debug)]
    pub struct Avx2(pub V3);

    impl Lanes for Avx2 {
        type F = __m256;

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
        fn max(self, a: __m256, b: __m256) -> __m256 {
            self.0.avx._mm256_max_ps(a, b)
        }
        #[inline(always)]
        fn le(self, a: __m256, b: __m256) -> u32 {
            self.0.avx._mm256_movemask_ps(self.0.avx._mm256_cmp_ps::<_CMP_LE_OQ>(a, b)) as u32
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums, products and comparisons of awkward values, as bits.
    struct Sample<'a>(&'a mut Vec<u32>);

    impl Work for Sample<'_> {
        fn run<L: Lanes>(self, l: L) {
            let a = [0.1, -0.0, f32::NAN, f32::INFINITY, 1e-40, 3e38, -7.7, 1.000_000_1];
            for b in [a.map(|v| v * 0.7), [0.0; 8], [f32::NAN; 8], a] {
                let (x, y) = (l.load(&a), l.add(l.load(&b), l.splat(0.3)));
                self.0.push(l.le(x, y));
                for z in [l.add(x, y), l.sub(x, y), l.mul(x, y), l.max(x, y)] {
                    // which NaN it is does not matter
                    self.0.extend(l.store(z).map(|v| if v.is_nan() { u32::MAX } else { v.to_bits() }));
                }
            }
        }
    }

    #[test]
    fn this_machines_lanes_have_the_bits_of_plain_arrays() {
        let (mut best, mut plain) = (Vec::new(), Vec::new());
        run(Sample(&mut best));
        Sample(&mut plain).run(Portable);
        assert_eq!(best, plain);
    }
}
