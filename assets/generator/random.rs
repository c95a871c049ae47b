//! Integer hashes and a small sequence of random values made from them: the same on every machine.
//! The mixing function is the 64-bit finaliser of Steele, Lea & Flood 2014 (SplitMix).

use glam::DVec3;

/// A well-mixed 64-bit value of `x`.
pub fn mix(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// A hash of a lattice point under a seed.
pub fn lattice(seed: u64, x: i64, y: i64) -> u64 {
    let place = (x as u64)
        .wrapping_mul(0xd6e8_feb8_6659_fd93)
        .wrapping_add((y as u64).wrapping_mul(0xa076_1d64_78bd_642f));
    mix(place ^ seed.wrapping_mul(0x8bb8_4b93_962e_acc9))
}

/// The top 53 bits of a hash as a value in [0, 1).
pub fn unit(hash: u64) -> f64 {
    (hash >> 11) as f64 / (1u64 << 53) as f64
}

/// A sequence of random values: the hashes of seed, 1, 2, 3, …
pub struct Random {
    seed: u64,
    count: u64,
}

impl Random {
    pub fn new(seed: u64) -> Self {
        Self { seed: mix(seed), count: 0 }
    }

    pub fn bits(&mut self) -> u64 {
        self.count += 1;
        mix(self.seed ^ mix(self.count))
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        unit(self.bits())
    }

    /// Uniform in [low, high).
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform inside the unit ball, by rejection.
    pub fn in_ball(&mut self) -> DVec3 {
        loop {
            let p = DVec3::new(self.within(-1.0, 1.0), self.within(-1.0, 1.0), self.within(-1.0, 1.0));
            let square = p.length_squared();
            if square <= 1.0 && square > 1e-6 {
                return p;
            }
        }
    }

    /// A uniform direction.
    pub fn direction(&mut self) -> DVec3 {
        self.in_ball().normalize()
    }
}
