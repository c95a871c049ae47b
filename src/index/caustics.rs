//! What tracing asks of a pass's photons: the map, and how far around a point it is asked.

use super::{Bandwidth, Gathered, Hit, Kernel, PhotonMap, Query, Radius};
use crate::math::{Color, Vec3};

/// The photons of one pass with the rule of their radius.
#[derive(Clone, Copy, Debug)]
pub struct Caustics<'a> {
    pub map: &'a PhotonMap,
    pub kernel: Kernel,
    pub reach: Reach<'a>,
}

/// The radius at a point.
#[derive(Clone, Copy, Debug)]
pub enum Reach<'a> {
    /// The first pass's, times a factor.
    Shrinking { first: &'a Bandwidth, factor: f32 },
    /// To the k-th nearest photon, at most this many metres.
    Nearest { k: usize, max: f32 },
}

impl Caustics<'_> {
    /// The radius at `p` on the side of the unit geometric normal `n`, metres, or how photons choose it. `least` is the smallest first radius that makes sense there, metres and above 0: that of what the
    /// camera cannot resolve.
    #[inline]
    pub fn radius(&self, p: Vec3, n: Vec3, least: f32) -> Radius {
        match self.reach {
            Reach::Shrinking { first, factor } => Radius::Fixed(first.radius(p, n).max(least) * factor),
            Reach::Nearest { k, max } => Radius::Nearest { k, min: least.min(max), max },
        }
    }

    /// The density estimate at `p` on that side; `seen` and `brdf` are those of [`PhotonMap::gather_seen`].
    #[inline]
    pub fn gather(
        &self,
        p: Vec3,
        n: Vec3,
        radius: Radius,
        seen: impl Fn(&Hit) -> bool,
        brdf: impl Fn(Vec3) -> Color,
    ) -> Gathered {
        self.map.gather_seen(&Query { p, n, radius }, self.kernel, seen, brdf)
    }
}
