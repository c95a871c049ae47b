//! The density estimate: the radiance that the photons near a point send on.
//!
//! L ≈ Σ f(wi) Φ w(e, r), with w a kernel that integrates to one (Jensen 2001, 7.2). With the radius
//! given, that is the density blurred by the kernel. With k nearest, r is the distance to the k-th,
//! and the k-th is left out of the sum: the k − 1 others are then spread over the disc as though the
//! radius had been given, so the estimate has no bias where the density is even, for any kernel,
//! whatever other photons had a part in the choice of r. (With the k-th, a disc is high by
//! k/(k − 1).) Its relative standard deviation there is 1/√(k − 2) for a disc.
//!
//! The radius has a floor and a ceiling. Where the k-th is beyond the ceiling, or there is none, r is
//! the ceiling; where it is within the floor, r is the floor. Either way the radius is then given,
//! every photon within it counts, and nothing is left out; that too is free of bias.

use super::kernel::Kernel;
use super::map::PhotonMap;
use super::search::Hit;
use crate::math::{Color, Vec3};

/// Where photons are gathered, and how far around.
#[derive(Clone, Copy, Debug)]
pub struct Query {
    /// Metres.
    pub p: Vec3,
    /// Unit geometric normal on the side that is seen.
    pub n: Vec3,
    pub radius: Radius,
}

/// The radius of the estimate, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Radius {
    Fixed(f32),
    /// To the `k`-th nearest photon (at least 2, since one is left out), but no less than `min` and
    /// no more than `max`.
    Nearest {
        k: usize,
        min: f32,
        max: f32,
    },
}

/// The estimate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gathered {
    /// W·m⁻²·sr⁻¹ if the closure gives a BRDF in sr⁻¹; W·m⁻², the irradiance, if it gives ones.
    pub radiance: Color,
    /// Photons in the sum.
    pub photons: u32,
    /// Metres.
    pub radius: f32,
    /// Mean of (x − p)/r over the photons in the sum, along the tangent plane. Near zero in the midst
    /// of light, 0.42 towards the lit side at an edge of it or of the surface.
    pub offset: Vec3,
}

impl PhotonMap {
    /// The radiance that the photons near `query.p` send on, `brdf` giving the part of what comes
    /// from `wi` that is seen. Nothing where the radius is zero or not a number: a floor under it is
    /// the caller's.
    #[inline]
    pub fn gather(&self, query: &Query, kernel: Kernel, brdf: impl Fn(Vec3) -> Color) -> Gathered {
        self.gather_seen(query, kernel, |_| true, brdf)
    }

    /// The same, of the photons of which `seen` says so. The others have a part only in the choice of the radius.
    #[inline]
    pub fn gather_seen(
        &self,
        query: &Query,
        kernel: Kernel,
        seen: impl Fn(&Hit) -> bool,
        brdf: impl Fn(Vec3) -> Color,
    ) -> Gathered {
        let weigh = |hit: &Hit| seen(hit).then(|| brdf(hit.wi));
        match query.radius {
            Radius::Fixed(radius) => self.gather_within(query, radius, kernel, &weigh),
            Radius::Nearest { k, min, max } => self.gather_nearest(query, [min, max], k, kernel, &weigh),
        }
    }

    #[inline(always)]
    fn gather_within(
        &self,
        query: &Query,
        radius: f32,
        kernel: Kernel,
        weigh: &impl Fn(&Hit) -> Option<Color>,
    ) -> Gathered {
        let mut sum = Sum::new(kernel, radius);
        self.each(
            query.p,
            query.n,
            radius,
            #[inline(always)]
            |place, distance_squared| {
                sum.add(&self.hit(query.p, place, distance_squared), weigh);
            },
        );
        sum.gathered(query.n)
    }

    #[inline(always)]
    fn gather_nearest(
        &self,
        query: &Query,
        [min, max]: [f32; 2],
        k: usize,
        kernel: Kernel,
        weigh: &impl Fn(&Hit) -> Option<Color>,
    ) -> Gathered {
        let k = k.max(2);
        let gathered = self.with_nearest(query.p, query.n, k, max, |nearest| {
            let (radius, counted) = match nearest.split_last() {
                Some((kth, others)) if nearest.len() >= k => (kth.distance_squared().sqrt(), others),
                _ => (max, nearest),
            };
            if radius < min {
                return None;
            }
            let mut sum = Sum::new(kernel, radius);
            for candidate in counted {
                sum.add(&self.hit(query.p, candidate.place(), candidate.distance_squared()), weigh);
            }
            Some(sum.gathered(query.n))
        });
        gathered.unwrap_or_else(|| self.gather_within(query, min, kernel, weigh))
    }
}

/// An estimate in the making.
struct Sum {
    kernel: Kernel,
    radius: f32,
    inverse_square: f32,
    radiance: Color,
    offset: Vec3,
    photons: u32,
}

impl Sum {
    #[inline(always)]
    fn new(kernel: Kernel, radius: f32) -> Sum {
        let inverse_square = 1.0 / (radius * radius);
        Sum { kernel, radius, inverse_square, radiance: Color::ZERO, offset: Vec3::ZERO, photons: 0 }
    }

    #[inline(always)]
    fn add(&mut self, hit: &Hit, weigh: &impl Fn(&Hit) -> Option<Color>) {
        let Some(part) = weigh(hit) else { return };
        let weight = self.kernel.shape(hit.distance_squared * self.inverse_square);
        self.radiance += part * hit.power * weight;
        self.offset += hit.offset;
        self.photons += 1;
    }

    #[inline(always)]
    fn gathered(self, n: Vec3) -> Gathered {
        let Sum { kernel, radius, photons, .. } = self;
        if photons == 0 || radius.is_nan() || radius * radius <= 0.0 {
            return Gathered { radius, ..Gathered::default() };
        }
        let offset = self.offset / (radius * photons as f32);
        let offset = offset - n * offset.dot(n);
        Gathered { radiance: self.radiance * kernel.scale(radius), photons, radius, offset }
    }
}
