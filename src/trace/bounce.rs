//! Light between diffuse surfaces: the path goes on from where it has been shaded.
//!
//! The direction is drawn from the layers' own lobes, the Lambert layer's cosine and the Phong lobe
//! around the mirror direction, chosen by their weights; f·cosθ over the density of both together is the
//! weight of what arrives. What such a path meets shines for it by reflected light alone: lights, seen
//! through glass or not, have been counted where the path left (direct light and caustics).

use super::path::{BOUNCE, Branch};
use super::{Tally, Tracer};
use crate::build::{Cone, Shading, Surface};
use crate::math::{DVec3, Frame, Ray, Vec3, sampling};
use std::f64::consts::{FRAC_1_PI, TAU};

/// Growth of the cone of a path that has been scattered, metres a metre: texture details smaller than
/// that are not worth their noise.
const SPREAD: f64 = 0.05;

/// A branch from a diffuse surface of at least this weight is always followed.
pub(super) const WEIGHT: f64 = 0.5;

/// From this bounce on every path may end, however white the scene.
const LONG: u32 = 8;
const LONG_SURVIVAL: f64 = 0.95;

impl Tracer<'_> {
    /// The branch that goes on from a shaded point, with its weight; `base` is that of its Lambert layer.
    pub(super) fn bounced(
        &self,
        branch: &Branch,
        base: Vec3,
        surface: &Surface,
        shading: &Shading,
        tally: &mut Tally,
    ) -> Option<(Branch, Vec3)> {
        let sequence = branch.sequence.dimension(BOUNCE);
        let (wi, weight) = scattered(base, shading, sequence.pair(), || sequence.dimension(BOUNCE).value())?;
        tally.rays.diffuse += 1;
        let ray = Ray::leaving(surface.p, surface.p_error, surface.ng, wi);
        let width = branch.cone.after(surface.t).width;
        let next = Branch { ray, cone: Cone { width, spread: SPREAD }, bounces: branch.bounces + 1, depth: 0, ..*branch };
        Some((next, weight))
    }
}

/// The chance with which a path of this weight is followed after so many bounces.
pub(super) fn survival(weight: f64, bounces: u32) -> f64 {
    let survival = (weight / WEIGHT).min(1.0);
    if bounces > LONG { survival.min(LONG_SURVIVAL) } else { survival }
}

/// A direction and f·cosθ over its density; `None` below the surface.
fn scattered(base: Vec3, shading: &Shading, u: [f64; 2], choose: impl FnOnce() -> f64) -> Option<(DVec3, Vec3)> {
    let (ng, ns) = (shading.ng, shading.ns);
    if shading.ks == Vec3::ZERO {
        let wi = Frame::around(ns).to_world(sampling::cosine_hemisphere(u));
        return (wi.dot(ng) > 0.0).then_some((wi, base));
    }
    let mirror = ns * (2.0 * shading.wo.dot(ns)) - shading.wo;
    let s = shading.material.shininess;
    let (lambert, lobe) = (f64::from(base.max_element()), f64::from(shading.ks.max_element()));
    let chance = lobe / (lambert + lobe);
    let wi = if choose() < chance {
        Frame::around(mirror).to_world(sampling::phong_lobe(s, u))
    } else {
        Frame::around(ns).to_world(sampling::cosine_hemisphere(u))
    };
    let cos = wi.dot(ns);
    if cos <= 0.0 || wi.dot(ng) <= 0.0 {
        return None;
    }
    let cos_alpha = mirror.dot(wi).clamp(0.0, 1.0);
    let pdf = chance * sampling::phong_lobe_pdf(s, cos_alpha) + (1.0 - chance) * cos * FRAC_1_PI;
    let highlight = (s + 2.0) / TAU * libm::pow(cos_alpha, s);
    let f = base * FRAC_1_PI as f32 + shading.ks * highlight as f32;
    Some((wi, f * (cos / pdf) as f32))
}
