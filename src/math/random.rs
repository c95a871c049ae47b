//! Random values as a pure function of (seed, stage, item, dimension).
//!
//! Well-distributed sequences are Owen-scrambled Sobol' points, two dimensions at a time, each pair
//! with its own scramble and its own shuffle of the order (Burley, Practical Hash-based Owen
//! Scrambling, JCGT 9(4), 2020). Any pass can be asked for its value alone, so that passes can be
//! computed anywhere and in any order.

/// Stages of the pipeline that draw random values. Values of one stage are independent of another's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    Film = 1,
    Photons = 2,
    Placement = 3,
    Test = 4,
}

/// A 64-bit mix with full avalanche (the finaliser of SplitMix64; Steele, Lea, Flood 2014).
#[inline]
pub fn mix(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// Folds one more word into a key.
#[inline]
pub fn combine(key: u64, word: u64) -> u64 {
    mix(key.wrapping_add(0x9e37_79b9_7f4a_7c15) ^ word.wrapping_mul(0xd6e8_feb8_6659_fd93))
}

/// [0, 1) from the upper 53 bits.
#[inline]
pub fn unit(x: u64) -> f64 {
    (x >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
}

/// [0, 1) from 32 bits.
#[inline(always)]
fn unit32(x: u32) -> f64 {
    f64::from(x) * (1.0 / (1u64 << 32) as f64)
}

/// A source of independent values: counter-based, so that value n needs no values before it.
#[derive(Clone, Copy, Debug)]
pub struct Counter {
    key: u64,
    next: u64,
}

impl Counter {
    pub fn new(seed: u64, stage: Stage, item: u64) -> Counter {
        Counter { key: combine(combine(mix(seed), stage as u64), item), next: 0 }
    }

    pub fn bits(&mut self) -> u64 {
        self.next += 1;
        combine(self.key, self.next)
    }

    /// Uniform in [0, 1).
    pub fn value(&mut self) -> f64 {
        unit(self.bits())
    }

    pub fn pair(&mut self) -> [f64; 2] {
        [self.value(), self.value()]
    }
}

/// One well-distributed sequence: `index` counts its samples, `key` says whose it is (pixel, path
/// vertex, use). Sequences of different keys are independent.
#[derive(Clone, Copy, Debug)]
pub struct Sequence {
    key: u64,
    index: u32,
}

/// The sequences of a stage's items.
#[derive(Clone, Copy, Debug)]
pub struct Items(u64);

impl Items {
    #[inline]
    pub fn of(seed: u64, stage: Stage) -> Items {
        Items(combine(mix(seed), stage as u64))
    }

    #[inline]
    pub fn sequence(&self, item: u64, index: u32) -> Sequence {
        Sequence { key: combine(self.0, item), index }
    }
}

impl Sequence {
    #[inline]
    pub fn new(seed: u64, stage: Stage, item: u64, index: u32) -> Sequence {
        Items::of(seed, stage).sequence(item, index)
    }

    /// Another sample of the same sequence.
    #[inline]
    pub fn at(&self, index: u32) -> Sequence {
        Sequence { key: self.key, index }
    }

    /// The same samples' values for another use: another dimension, path vertex or branch.
    #[inline]
    pub fn dimension(&self, dimension: u64) -> Sequence {
        Sequence { key: combine(self.key, dimension), index: self.index }
    }

    /// Sample `part` of `parts` where one sample of this sequence is divided into several.
    #[inline]
    pub fn split(&self, part: u32, parts: u32) -> Sequence {
        Sequence { key: self.key, index: self.index.wrapping_mul(parts).wrapping_add(part) }
    }

    /// A point of [0, 1)²: any 2^k consecutive samples are a (0, k, 2)-net.
    #[inline]
    pub fn pair(&self) -> [f64; 2] {
        self.scramble().pair(self.index)
    }

    /// All of it but the index.
    #[inline]
    pub fn scramble(&self) -> Scramble {
        let (a, b) = (mix(self.key), mix(self.key ^ 0x5851_f42d_4c95_7f2d));
        Scramble { order: (a >> 32) as u32, x: a as u32, y: (b >> 32) as u32 }
    }

    /// A value of [0, 1), well distributed over the samples: the first of the pair.
    #[inline]
    pub fn value(&self) -> f64 {
        let a = mix(self.key);
        let x = owen(self.index, (a >> 32) as u32).reverse_bits();
        unit32(owen(x, a as u32))
    }
}

/// How a sequence is shuffled and scrambled, for those who want many of its samples.
#[derive(Clone, Copy, Debug)]
pub struct Scramble {
    order: u32,
    x: u32,
    y: u32,
}

impl Scramble {
    /// What [`Sequence::pair`] is for this index.
    #[inline]
    pub fn pair(&self, index: u32) -> [f64; 2] {
        let (x, y) = sobol(owen(index, self.order));
        [unit32(owen(x, self.x)), unit32(owen(y, self.y))]
    }

    /// The pairs of this index and the next ones, as the first values and the second ones.
    #[inline(always)]
    #[expect(clippy::needless_range_loop, reason = "iterators of two arrays do not become lanes")]
    pub fn pairs<const N: usize>(&self, index: u32) -> [[f64; N]; 2] {
        // A loop, which becomes the lanes of whoever asks; a closure would be compiled for any machine.
        let mut pairs = [[0.0; N]; 2];
        for i in 0..N {
            let (x, y) = sobol(owen(index.wrapping_add(i as u32), self.order));
            (pairs[0][i], pairs[1][i]) = (unit32(owen(x, self.x)), unit32(owen(y, self.y)));
        }
        pairs
    }
}

/// The first two Sobol' dimensions. The second's matrix is Pascal's triangle modulo 2, which is a
/// tensor power, so that five exclusive-or steps multiply by it.
#[inline(always)]
fn sobol(index: u32) -> (u32, u32) {
    let mut x = index;
    x ^= (x >> 1) & 0x5555_5555;
    x ^= (x >> 2) & 0x3333_3333;
    x ^= (x >> 4) & 0x0f0f_0f0f;
    x ^= (x >> 8) & 0x00ff_00ff;
    x ^= (x >> 16) & 0x0000_ffff;
    (index.reverse_bits(), x.reverse_bits())
}

/// Nested uniform scrambling in base 2: each bit is flipped by a hash of the bits above it.
/// The permutation of the reversed word is Laine & Karras 2011 with Burley's 2020 constants.
#[inline(always)]
fn owen(x: u32, seed: u32) -> u32 {
    let mut v = x.reverse_bits();
    v ^= v.wrapping_mul(0x3d20_adea);
    v = v.wrapping_add(seed);
    v = v.wrapping_mul((seed >> 16) | 1);
    v ^= v.wrapping_mul(0x0552_6c56);
    v ^= v.wrapping_mul(0x53a2_2864);
    v.reverse_bits()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every 2^k consecutive samples put exactly one point in each elementary interval.
    #[test]
    fn consecutive_samples_are_a_net_in_every_elementary_interval() {
        for key in 0..8 {
            for k in [4u32, 6, 8] {
                let n = 1u32 << k;
                for start in [0, n, 5 * n] {
                    let points: Vec<_> =
                        (start..start + n).map(|i| Sequence::new(7, Stage::Test, key, i).pair()).collect();
                    for kx in 0..=k {
                        let (nx, ny) = (1u32 << kx, n >> kx);
                        let mut seen = vec![false; n as usize];
                        for [x, y] in &points {
                            let cell = (x * f64::from(nx)) as u32 * ny + (y * f64::from(ny)) as u32;
                            assert!(!seen[cell as usize], "two points in one cell, key {key}, k {k}");
                            seen[cell as usize] = true;
                        }
                    }
                }
            }
        }
    }

    /// Different keys are uncorrelated: over 4096 keys the first points fill 16 × 16 cells evenly
    /// (χ² with 255 degrees of freedom stays below its 1 − 1e-4 quantile, 347).
    #[test]
    fn first_points_of_different_keys_are_uniform() {
        let mut counts = [0f64; 256];
        let n = 4096;
        for key in 0..n {
            let [x, y] = Sequence::new(0, Stage::Test, key, 0).pair();
            counts[(x * 16.0) as usize * 16 + (y * 16.0) as usize] += 1.0;
        }
        let expected = n as f64 / 256.0;
        let chi2: f64 = counts.iter().map(|c| (c - expected).powi(2) / expected).sum();
        assert!(chi2 < 347.0, "χ² = {chi2}");
    }

    #[test]
    fn counter_values_have_the_moments_of_the_uniform_distribution() {
        let mut counter = Counter::new(1, Stage::Test, 9);
        let n = 100_000;
        let (mut sum, mut square) = (0.0, 0.0);
        for _ in 0..n {
            let v = counter.value();
            sum += v;
            square += v * v;
        }
        // Standard errors: 0.29/√n and 0.30/√n; five of them.
        assert!((sum / n as f64 - 0.5).abs() < 5.0 * 9.2e-4);
        assert!((square / n as f64 - 1.0 / 3.0).abs() < 5.0 * 9.5e-4);
    }
}
