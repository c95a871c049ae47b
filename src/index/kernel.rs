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

    /// A distance drawn from the kernel as a density over the disc, as a share of the radius, from a uniform
    /// value in [0, 1).
    pub fn distance(self, u: f64) -> f64 {
        match self {
            Kernel::Disc => u.sqrt(),
            Kernel::Epanechnikov => (1.0 - (1.0 - u).sqrt()).sqrt(),
            Kernel::Cone { kappa } => {
                // d² − 2d³/(3κ) = u·(1 − 2/(3κ)), which rises and bends up less and less: Newton from above.
                let a = 2.0 / (3.0 * f64::from(kappa.max(1.0)));
                let mut d = 1.0;
                for _ in 0..8 {
                    let slope = 2.0 * d - 3.0 * a * d * d;
                    let step = (d * d * (1.0 - a * d) - u * (1.0 - a)) / slope.max(1e-6);
                    d = (d - step).clamp(0.0, 1.0);
                }
                d
            }
        }
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
