//! The radius of progressive passes: the first from a few pilot photons, the others in closed form.
//!
//! Pass n's radius is r₁ √(Γ(n + α)/(Γ(1 + α) Γ(n + 1))) (Knaus & Zwicker, Progressive Photon Mapping:
//! A Probabilistic Approach, ACM TOG 30(3), 2011): a function of the pass's number alone, so that
//! passes can be computed anywhere in any order. The first radius must not depend on the photons
//! that it is used on, or the passes' mean would keep a bias: it comes from photons of its own.

use super::map::PhotonMap;
use crate::math::Vec3;
use crate::scatter::Photons;

/// A k-th distance from fewer pilot photons than this says little of the density.
const FEWEST: f64 = 8.0;

/// The first pass's radius anywhere, from a pilot.
#[derive(Clone, Debug)]
pub struct Bandwidth {
    pilot: PhotonMap,
    /// The radius at each of the pilot's photons, in the map's order.
    radii: Vec<f32>,
    /// A pass's distances over the pilot's.
    factor: f32,
    min: f32,
    max: f32,
}

impl Bandwidth {
    /// `photons` is how many a pass is expected to store, `k` how many of them the first radius
    /// should hold; `min` and `max` bound it, metres.
    pub fn new(pilot: impl Into<Photons>, photons: f64, k: f64, min: f32, max: f32) -> Bandwidth {
        let pilot = PhotonMap::new(pilot);
        // In an even field of density λ, πr_k²λ is k on average.
        let expected = k * pilot.len() as f64 / photons.max(1.0);
        let asked = expected.max(FEWEST).ceil();
        let factor = (expected / asked).sqrt() as f32;
        let k = asked.min(f64::from(u32::MAX)) as usize;
        // Beyond this distance the answer is `max` in any case.
        let farthest = max / factor;
        let radii = pilot.at_each(|p, n| {
            let found = pilot.nearest_radius(p, n, k, farthest);
            found.map_or(max, |r| (r * factor).min(max)).max(min)
        });
        Bandwidth { pilot, radii, factor, min, max }
    }

    /// Metres: about the distance at which the k-th photon would be in a pass's map from the pilot's photon
    /// nearest to `p`, on the side of the unit geometric normal `n`; `max` where no such photon is near.
    #[inline]
    pub fn radius(&self, p: Vec3, n: Vec3) -> f32 {
        // The k-th is no nearer than the first.
        let near = |(place, distance): (usize, f32)| self.radii[place].max(distance * self.factor);
        self.pilot.nearest(p, n, self.max).map_or(self.max, near).clamp(self.min, self.max)
    }

    /// The pilot's memory.
    pub fn memory_bytes(&self) -> usize {
        self.pilot.memory_bytes() + self.radii.capacity() * size_of::<f32>()
    }
}

/// The factor on the first pass's radius for pass `pass`, which counts from 0 and has 1; `alpha`, in
/// (0, 1), is 2/3 for the fastest convergence of noise and blur together.
pub fn shrink(pass: u32, alpha: f64) -> f64 {
    // Γ(n + α)/Γ(n + 1) is a product of factors near one, which is exact where lgamma's difference
    // would cancel; far out, its asymptotic series (DLMF 5.11.13) is exact too.
    const SERIES_FROM: u32 = 4096;
    let step = |i: f64| (i + alpha) / (i + 1.0);
    let n = f64::from(pass) + 1.0;
    let product = |to: u32| (1..=to).map(|i| step(f64::from(i))).product::<f64>();
    if pass <= SERIES_FROM {
        return product(pass).sqrt();
    }
    let tail = |n: f64| {
        let correction = 1.0 + (alpha - 1.0) * alpha / (2.0 * n);
        libm::pow(n, alpha - 1.0) * correction
    };
    let start = f64::from(SERIES_FROM) + 1.0;
    (product(SERIES_FROM) * tail(n) / tail(start)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shrinking_factor_is_the_product_over_passes() {
        assert_eq!(shrink(0, 2.0 / 3.0), 1.0);
        for alpha in [0.5, 2.0 / 3.0, 0.9] {
            let mut squared = 1.0;
            for pass in 1..200_000u32 {
                squared *= (f64::from(pass) + alpha) / (f64::from(pass) + 1.0);
                if pass < 50 || pass % 997 == 0 {
                    let off = shrink(pass, alpha) / squared.sqrt() - 1.0;
                    assert!(off.abs() < 1e-8, "pass {pass}, α = {alpha}: off by {off}");
                }
            }
        }
    }

    /// Γ(1 + α)⁻¹ n^(α − 1), to which it tends.
    #[test]
    fn the_shrinking_factor_has_its_known_limit() {
        let alpha: f64 = 2.0 / 3.0;
        let n = 1e6;
        let limit = (libm::pow(n, alpha - 1.0) / libm::tgamma(1.0 + alpha)).sqrt();
        assert!((shrink(999_999, alpha) / limit - 1.0).abs() < 1e-6);
    }
}
