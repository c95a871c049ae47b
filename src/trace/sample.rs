//! What one camera sample yields.

use super::Probes;
use crate::math::{Color, Exact};

/// What is wanted of every sample beyond its radiance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wants {
    /// Albedo, normal, depth, position, object.
    pub first_hit: bool,
    /// Direct, reflected, refracted, focused and indirect light apart.
    pub split: bool,
    pub variance: bool,
    /// Photons as dots, and their density.
    pub photons: bool,
    /// What the density estimate's blur adds, at every pixel.
    pub bias: bool,
    /// Pixels that the picture's error is estimated from.
    pub probes: Option<Probes>,
    /// There will be one pass.
    pub one_pass: bool,
}

impl Wants {
    /// Whether more than the radiance is kept of samples that several pixels share. A probe's parts are, and any
    /// may be a probe's.
    pub fn whole_samples(&self) -> bool {
        !self.radiance_alone() || self.probes.is_some()
    }

    /// Whether a sample's radiance is all that a pixel keeps of it.
    pub(super) fn radiance_alone(&self) -> bool {
        !(self.first_hit || self.split || self.photons)
    }
}

/// The radiance along one camera ray, W·m⁻²·sr⁻¹, and what the ray met first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    pub radiance: Color,
    /// Light by the first specular event on its way from the eye, where it is wanted apart; their sum is then
    /// `radiance`.
    pub direct: Color,
    pub reflection: Color,
    pub refraction: Color,
    /// The part of it that photons brought to the first diffuse surface.
    pub caustic: Color,
    /// The part of it that came by two diffuse surfaces or more.
    pub indirect: Color,
    /// Photons as dots.
    pub photons: Color,
    /// Photons by area, 1/m².
    pub photon_density: f32,
    pub first: FirstHit,
}

/// The first surface that a camera ray meets; all zero where it meets none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FirstHit {
    /// Diffuse colour; white for what only reflects and transmits.
    pub albedo: Color,
    /// Shading normal, world space.
    pub normal: Color,
    /// Distance from the eye along the view direction, metres.
    pub depth: f32,
    /// Scene coordinates, metres.
    pub position: Color,
    /// Index of the object plus one.
    pub object: u32,
}

impl Sample {
    /// Back to black, field by field: a whole new one would be made elsewhere first, and copied.
    #[inline]
    pub(super) fn clear(&mut self) {
        let Sample {
            radiance,
            direct,
            reflection,
            refraction,
            caustic,
            indirect,
            photons,
            photon_density,
            first,
        } = self;
        for light in [radiance, direct, reflection, refraction, caustic, indirect, photons] {
            *light = Color::ZERO;
        }
        *photon_density = 0.0;
        *first = FirstHit::default();
    }

    /// What of it neither photons nor paths from surface to surface brought.
    pub(super) fn rest(&self) -> Color {
        self.radiance - self.caustic - self.indirect
    }

    /// Whether it can be added up: beyond [`Exact::LIMIT`] it counts as infinite.
    pub fn is_finite(&self) -> bool {
        self.radiance.abs().cmplt(Color::splat(Exact::LIMIT as f32)).all()
    }
}
