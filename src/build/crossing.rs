//! What a path does at a mirror or an interface, from the eye as from a light: the medium behind it,
//! and the directions in which it may go on.

use super::contact::Beside;
use super::media::MediaSet;
use super::shading::Shading;
use super::surface::Surface;
use super::world::World;
use crate::math::{Color, DVec3, Health, Rare};
use crate::optics::{Interface, reflected, refracted};

/// The way through a transmissive surface.
#[derive(Clone, Copy, Debug)]
pub struct Crossing {
    /// The media behind it.
    pub after: MediaSet,
    /// Offset along the normal that clears all surfaces which coincide with it, metres.
    pub tolerance: f64,
}

/// A path's wavelength from an interface on.
#[derive(Clone, Copy, Debug)]
pub struct Colour {
    /// µm; none where nothing has dispersed yet.
    pub um: Option<f64>,
    /// What the path's weight is multiplied by.
    pub weight: Color,
}

impl World {
    /// The ratio far/near of the indices of two media for a path of this wavelength, which is drawn by
    /// `u` if either of them disperses and the path has none yet.
    #[inline]
    pub fn relative_ior(
        &self,
        near: &MediaSet,
        far: &MediaSet,
        um: Option<f64>,
        u: impl FnOnce() -> f64,
    ) -> (f64, Colour) {
        let (near, far) = (self.medium(near).0, self.medium(far).0);
        let colour = match &self.spectrum {
            Some(spectrum) if um.is_none() && (near.disperses() || far.disperses()) => {
                let sample = spectrum.sample(u());
                Colour { um: Some(sample.um), weight: sample.weight }
            }
            _ => Colour { um, weight: Color::ONE },
        };
        (far.ior(colour.um) / near.ior(colour.um), colour)
    }

    /// The way of the unit direction `dir` through a surface, which may have something opaque `beside` it. `None`
    /// where nothing is transmitted.
    #[inline]
    pub fn crossing(
        &self,
        media: &MediaSet,
        dir: DVec3,
        surface: &Surface,
        beside: &Beside,
        shading: &Shading,
        health: &mut Health,
    ) -> Option<Crossing> {
        let rank = self.instances[surface.instance as usize].rank;
        if rank == 0 || shading.kt == Color::ZERO {
            None
        } else {
            self.across(media, dir, surface, beside, rank, health)
        }
    }

    #[inline(never)]
    fn across(
        &self,
        media: &MediaSet,
        dir: DVec3,
        surface: &Surface,
        beside: &Beside,
        rank: u32,
        health: &mut Health,
    ) -> Option<Crossing> {
        let mut cross = |media: MediaSet, rank, inwards| {
            media.crossed(rank, inwards).unwrap_or_else(|| {
                health.count(Rare::MediaOverflow);
                media
            })
        };
        let mut after = cross(*media, rank, dir.dot(surface.ng) < 0.0);
        if let Beside::Before(all) = beside
            && all.top() == after.top()
        {
            // Into glass that is flush with what the path leaves: the media of all faces there.
            return Some(Crossing { after: *all, tolerance: surface.p_error });
        }
        if self.coincidence == 0.0 {
            return Some(Crossing { after, tolerance: surface.p_error });
        }
        let tolerance = 2.0 * self.coincidence.max(surface.p_error);
        self.coincident(surface.p, surface.ng, dir, surface.instance, tolerance, |rank, inwards| {
            // Before what is opaque lies the gap of no width: glass on its other side is not entered.
            if !(inwards && matches!(beside, Beside::Behind(_))) {
                after = cross(after, rank, inwards);
            }
        });
        Some(Crossing { after, tolerance: 2.0 * tolerance })
    }

    /// Beer–Lambert over `t` metres of the medium.
    #[inline]
    pub fn transmittance(&self, media: &MediaSet, t: f64) -> Color {
        if media.top() == 0 { Color::ONE } else { self.transmittance_within(media, t) }
    }

    #[inline(never)]
    fn transmittance_within(&self, media: &MediaSet, t: f64) -> Color {
        let (_, absorption) = self.medium(media);
        if absorption == Color::ZERO {
            return Color::ONE;
        }
        Color::from(absorption.to_array().map(|sigma| libm::exp(-f64::from(sigma) * t) as f32))
    }
}

impl Shading<'_> {
    /// The mirrored direction, on the side of wo: one that a bent shading normal has sent below the
    /// surface is mirrored back up.
    #[inline]
    pub fn mirrored(&self, health: &mut Health) -> DVec3 {
        let wi = reflected(self.wo, self.ns);
        let height = wi.dot(self.ng);
        if height > 0.0 {
            return wi;
        }
        health.count(Rare::DirectionThroughSurface);
        (wi - self.ng * (2.0 * height)).normalize()
    }

    /// Reflectance towards and refraction into a medium of `eta` times the index.
    #[inline]
    pub fn interface(&self, eta: f64) -> Interface {
        Interface::new(self.wo.dot(self.ns).max(0.0), eta)
    }

    /// The refracted direction, on the other side: one that a bent shading normal keeps on the side of wo
    /// is refracted by the geometric normal instead. `None` where that reflects totally.
    #[inline]
    pub fn refracted(&self, eta: f64, interface: &Interface, health: &mut Health) -> Option<DVec3> {
        let wi = refracted(self.wo, self.ns, eta, interface.cos_t);
        if wi.dot(self.ng) < 0.0 { Some(wi) } else { self.refracted_flat(eta, health) }
    }

    #[cold]
    fn refracted_flat(&self, eta: f64, health: &mut Health) -> Option<DVec3> {
        health.count(Rare::DirectionThroughSurface);
        let flat = Interface::new(self.wo.dot(self.ng).max(0.0), eta);
        (flat.reflectance < 1.0).then(|| refracted(self.wo, self.ng, eta, flat.cos_t))
    }
}
