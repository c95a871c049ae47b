//! Marble and wood: stripes and rings in object space, bent by noise.
//!
//! After Perlin, An Image Synthesizer, SIGGRAPH 1985: a periodic profile of a coordinate to which
//! noise is added.

use super::filter::{fraction, smoothstep, survives};
use super::noise::{fbm, finest, gradient_noise};
use super::{Colors, TexturePoint};
use glam::DVec3;
use std::f64::consts::PI;

/// Thin veins of `b` in `a`, `size_m` apart along x.
#[derive(Clone, Debug)]
pub struct Marble {
    pub(super) colors: Colors,
    size_m: f64,
    octaves: u32,
}

impl Marble {
    /// `size_m` above 0; `octaves` of the bending noise.
    pub fn new(colors: Colors, size_m: f64, octaves: u32) -> Marble {
        Marble { colors, size_m, octaves }
    }

    pub(super) fn weight(&self, at: &TexturePoint) -> f64 {
        let (p, radius) = (at.p / self.size_m, at.radius() / self.size_m);
        if !p.is_finite() {
            return 0.0;
        }
        // The bend is up to about a vein's distance, in folds as large as two.
        let bend = 1.6 * fbm(p * 0.5, radius * 0.5, self.octaves, 0x3a);
        let strength = 0.75 + 0.5 * fbm(p * 0.7, radius * 0.7, 2, 0x51);
        let sine = libm::sin(2.0 * PI * fraction(p.x + bend));
        // ((1 + s)/2)⁴ is narrow around the crest; its mean over a period is 35/128.
        let crest = 0.5 + 0.5 * sine;
        let vein = (crest * crest) * (crest * crest);
        let mean = 35.0 / 128.0;
        (strength * (mean + (vein - mean) * survives(radius, 0.5))).clamp(0.0, 1.0)
    }

    pub(super) fn step(&self) -> f64 {
        self.size_m * finest(self.octaves)
    }
}

/// Rings around the y axis, from `a` (early wood) to `b` (late wood), `ring_m` wide.
#[derive(Clone, Debug)]
pub struct Wood {
    pub(super) colors: Colors,
    ring_m: f64,
}

impl Wood {
    /// `ring_m` above 0.
    pub fn new(colors: Colors, ring_m: f64) -> Wood {
        Wood { colors, ring_m }
    }

    pub(super) fn weight(&self, at: &TexturePoint) -> f64 {
        let (p, radius) = (at.p / self.ring_m, at.radius() / self.ring_m);
        if !p.is_finite() {
            return 0.0;
        }
        // Trunks grow unevenly but slowly along their axis.
        let slow = DVec3::new(0.12, 0.03, 0.12);
        let bend = 2.5 * fbm(p * slow, radius * 0.12, 3, 0x77);
        let turns = (p.x * p.x + p.z * p.z).sqrt() + bend;
        // Early wood darkens slowly over the year and ends abruptly; both ends meet with slope 0.
        let f = fraction(turns);
        let late = smoothstep(0.15, 0.85, f) * (1.0 - smoothstep(0.88, 1.0, f));
        // ∫ of the product: 0.35 to the ramp's end, 0.03 at the top, 0.06 for the fall.
        let mean = 0.35 + 0.03 + 0.06;
        let ring = mean + (late - mean) * survives(radius, 0.5);
        // Fibres: fine across, long along the axis.
        let fibre = DVec3::new(9.0, 0.35, 9.0);
        let grain = survives(radius * 9.0, 1.0) * gradient_noise(p * fibre, 0x1f);
        let year =
            0.12 * gradient_noise(DVec3::new(turns.floor() + 0.5, 0.37, 0.71), 0x99) * f * (1.0 - f) * 4.0;
        (0.12 + 0.72 * ring + 0.1 * grain + year * survives(radius, 0.5)).clamp(0.0, 1.0)
    }

    pub(super) fn step(&self) -> f64 {
        self.ring_m / 2048.0
    }
}
