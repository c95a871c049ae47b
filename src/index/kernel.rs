//! How the photons within the radius weigh in the density estimate: functions of the distance that
//! integrate to one over the disc. A narrower hill blurs less and is noisier.

use std::f32::consts::PI;

/// A weight by distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kernel {
    /// The same everywhere: the least noise for a radius. Second moment ½ r².
    Disc,
    /// Falls as 1 − d/(κr), κ ≥ 1 (1.1 is usual; Jensen 2001, 7.2.3). A κ below 1 counts as 1.
    Cone { kappa: f32 },
    /// Falls as 1 − d²/r², which has the least error for its radius where density is smooth
    /// (Epanechnikov 1969). Second moment ⅓ r².
    Epanechnikov,
}

impl Kernel {
    /// m⁻², of a photon at a distance whose square is `t_squared` times the radius squared, 0 to 1.
    #[inline(always)]
    pub fn weight(self, t_squared: f32, radius: f32) -> f32 {
        self.shape(t_squared) * self.scale(radius)
    }

    /// The weight but for [`Kernel::scale`].
    #[inline(always)]
    pub(super) fn shape(self, t_squared: f32) -> f32 {
        match self {
            Kernel::Disc => 1.0,
            Kernel::Cone { kappa } => 1.0 - t_squared.sqrt() / kappa.max(1.0),
            Kernel::Epanechnikov => 1.0 - t_squared,
        }
    }

    /// m⁻²: what makes the integral over the disc one.
    #[inline(always)]
    pub(super) fn scale(self, radius: f32) -> f32 {
        let shape = match self {
            Kernel::Disc => 1.0,
            Kernel::Cone { kappa } => 1.0 - 2.0 / (3.0 * kappa.max(1.0)),
            Kernel::Epanechnikov => 0.5,
        };
        1.0 / (shape * PI * radius * radius)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ w 2πd dd by the midpoint rule, whose error is of order 1/n².
    #[test]
    fn every_kernel_integrates_to_one_over_the_disc() {
        let kernels = [1.0, 1.1, 3.0].map(|kappa| Kernel::Cone { kappa });
        for kernel in [Kernel::Disc, Kernel::Epanechnikov].into_iter().chain(kernels) {
            for radius in [1e-3f32, 0.7, 250.0] {
                let n = 20_000;
                let ring = |i: i32| {
                    let t = (f64::from(i) + 0.5) / f64::from(n);
                    let weight = f64::from(kernel.weight((t * t) as f32, radius));
                    weight * std::f64::consts::TAU * t * f64::from(radius).powi(2) / f64::from(n)
                };
                let sum: f64 = (0..n).map(ring).sum();
                assert!((sum - 1.0).abs() < 1e-6, "{kernel:?} at {radius}: {sum}");
            }
        }
    }
}
