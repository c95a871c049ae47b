//! What one camera sample yields.

use super::Probes;
use crate::math::{Exact, Vec3};

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
}

/// The radiance along one camera ray, W·m⁻²·sr⁻¹, and what the ray met first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    pub radiance: Vec3,
    /// Light by the first specular event on its way from the eye, where it is wanted apart; their sum is then
    /// `radiance`.
    pub direct: Vec3,
    pub reflection: Vec3,
    pub refraction: Vec3,
    /// The part of it that photons brought to the first diffuse surface.
    pub caustic: Vec3,
    /// The part of it that came by two diffuse surfaces or more.
    pub indirect: Vec3,
    /// Photons as dots.
    pub photons: Vec3,
    /// Photons by area, 1/m².
    pub photon_density: f32,
    pub first: FirstHit,
}

/// The first surface that a camera ray meets; all zero where it meets none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FirstHit {
    /// Diffuse colour; white for what only reflects and transmits.
    pub albedo: Vec3,
    /// Shading normal, world space.
    pub normal: Vec3,
    /// Distance from the eye along the view direction, metres.
    pub depth: f32,
    /// Scene coordinates, metres.
    pub position: Vec3,
    /// Index of the object plus one.
    pub object: u32,
}

impl Sample {
    /// What of it neither photons nor paths from surface to surface brought.
    pub(super) fn rest(&self) -> Vec3 {
        self.radiance - self.caustic - self.indirect
    }

    /// Whether it can be added up: beyond [`Exact::LIMIT`] it counts as infinite.
    pub fn is_finite(&self) -> bool {
        self.radiance.abs().cmplt(Vec3::splat(Exact::LIMIT as f32)).all()
    }
}
