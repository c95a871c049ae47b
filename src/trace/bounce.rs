//! Light between diffuse surfaces: the path goes on from where it has been shaded.
//!
//! What such a path meets shines for it by reflected light alone: lights, seen through glass or not,
//! have been counted where the path left (direct light and caustics).

use super::branch::{BOUNCE, Branch};
use super::{Tally, Tracer};
use crate::build::{Cone, Shading, Surface};
use crate::math::{Color, Ray};

/// Growth of the cone of a path that has been scattered, metres a metre: texture details smaller than
/// that are not worth their noise.
const SPREAD: f64 = 0.05;

/// A branch from a diffuse surface of at least this weight is always followed.
pub(super) const WEIGHT: f64 = 0.25;

/// From this bounce on every path may end, however white the scene.
const LONG: u32 = 8;
const LONG_SURVIVAL: f64 = 0.95;

impl Tracer<'_> {
    /// The branch that goes on from a shaded point, with its weight; `base` is that of its Lambert layer.
    pub(super) fn bounced(
        &self,
        branch: &Branch,
        base: Color,
        surface: &Surface,
        shading: &Shading,
        tally: &mut Tally,
    ) -> Option<(Branch, Color)> {
        let sequence = branch.sequence.dimension(BOUNCE);
        let (wi, weight) = shading.scattered(base, sequence.pair(), || sequence.dimension(BOUNCE).value())?;
        tally.rays.diffuse += 1;
        let ray = Ray::leaving(surface.p, surface.p_error, surface.ng, wi);
        let width = branch.cone.after(surface.t).width;
        let next = Branch {
            ray,
            start: surface.start(wi),
            cone: Cone { width, spread: SPREAD },
            bounces: branch.bounces + 1,
            depth: 0,
            ..*branch
        };
        Some((next, weight))
    }
}

/// The chance with which a path of this weight is followed after so many bounces.
pub(super) fn survival(weight: f64, bounces: u32) -> f64 {
    let survival = (weight / WEIGHT).min(1.0);
    if bounces > LONG { survival.min(LONG_SURVIVAL) } else { survival }
}
