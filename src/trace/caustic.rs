//! Light that glass, water and mirrors have focused (L S⁺ D): the photons near a surface point.
//!
//! Photons count the power that arrives by area of the geometric surface; shading counts it by the
//! shading normal. Each is weighed by cosθ_shading/cosθ_geometric (Veach 1997, 5.3), so that photons
//! and shadow rays agree on smooth meshes and under normal maps.

use super::path::{Branch, COVERAGE};
use super::{Tally, Tracer};
use crate::build::{Shading, Surface};
use crate::index::{Caustics, Gathered};
use crate::math::random::Sequence;
use crate::math::{DVec2, DVec3, Frame, Ray, Vec3, sampling};
use std::f64::consts::TAU;

/// Where the photons in the sum lie no further to one side than this, no edge of the surface is near.
const EVEN: f32 = 0.2;

/// So few photons may lie to one side by chance.
const FEW: u32 = 12;

/// Places of the disc that are looked at for the surface.
const PROBES: u32 = 24;

/// A caustic at a surface point.
#[derive(Clone, Copy, Debug, Default)]
pub struct Caustic {
    pub radiance: Vec3,
    /// Photons by area, 1/m².
    pub density: f32,
}

impl Tracer<'_> {
    /// The caustic that the point reflects towards wo; `base` is the weight of its Lambert layer.
    pub(super) fn caustic(
        &self,
        caustics: &Caustics,
        branch: &Branch,
        base: Vec3,
        surface: &Surface,
        shading: &Shading,
        tally: &mut Tally,
    ) -> Caustic {
        // What the camera cannot resolve need not be resolved; after a bounce it sees everything.
        let footprint = if branch.bounces == 0 { branch.cone.after(surface.t).width } else { 0.0 };
        let (ng, ns) = (shading.ng.as_vec3(), shading.ns.as_vec3());
        let p = surface.p.as_vec3();
        // Below it the distances between single-precision photons are rounding.
        let least = (footprint as f32).max(p.abs().max_element() * 4.0 * f32::EPSILON).max(f32::MIN_POSITIVE);
        let bent = shading.ns != shading.ng;
        let by_normals = |wi: Vec3| if bent { (wi.dot(ns).max(0.0) / wi.dot(ng).max(1e-3)).min(10.0) } else { 1.0 };
        let lambert = base * std::f32::consts::FRAC_1_PI;
        let gathered = if shading.ks == Vec3::ZERO {
            caustics.gather(p, ng, least, |wi| lambert * by_normals(wi))
        } else {
            let mirror = (shading.ns * (2.0 * shading.wo.dot(shading.ns)) - shading.wo).as_vec3();
            let exponent = shading.material.shininess;
            let peak = shading.ks * ((exponent + 2.0) / TAU) as f32;
            caustics.gather(p, ng, least, |wi| {
                let cos = f64::from(mirror.dot(wi).clamp(0.0, 1.0));
                let lobe = if cos > 0.0 { libm::pow(cos, exponent) as f32 } else { 0.0 };
                (lambert + peak * lobe) * by_normals(wi)
            })
        };
        if gathered.photons == 0 {
            return Caustic::default();
        }
        let covered = self.covered(surface, shading, &gathered, branch.sequence, tally);
        let area = std::f32::consts::PI * gathered.radius * gathered.radius;
        Caustic { radiance: gathered.radiance / covered, density: gathered.photons as f32 / (area * covered) }
    }

    /// White where a photon lies within what a pixel covers, in the photon's colour.
    pub(super) fn photon_dots(
        &self,
        caustics: &Caustics,
        branch: &Branch,
        surface: &Surface,
        shading: &Shading,
    ) -> Vec3 {
        let radius = branch.cone.after(surface.t).width as f32;
        let mut dot = Vec3::ZERO;
        caustics.map.within(surface.p.as_vec3(), shading.ng.as_vec3(), radius, |hit| {
            let most = hit.power.max_element();
            if most > 0.0 {
                dot = dot.max(hit.power / most);
            }
        });
        dot
    }

    /// The part of the gathered disc that the surface fills, which photons can lie on: less than 1 at its
    /// edges and corners (H32). Looked for only where the photons lie to one side.
    fn covered(
        &self,
        surface: &Surface,
        shading: &Shading,
        gathered: &Gathered,
        sequence: Sequence,
        tally: &mut Tally,
    ) -> f32 {
        if gathered.photons >= FEW && gathered.offset.length() < EVEN {
            return 1.0;
        }
        let radius = f64::from(gathered.radius);
        if self.world.clearance(surface) >= radius {
            return 1.0;
        }
        let frame = Frame::around(shading.ng);
        let lift = shading.ng * (0.25 * radius + surface.p_error);
        let on_surface = |at: DVec3| {
            let ray = Ray { origin: at + lift, dir: -shading.ng };
            let hit = self.world.nearest(&ray, 2.0 * lift.length());
            hit.is_some_and(|hit| {
                let ng = self.world.surface(&ray, &hit).ng;
                ng.dot(shading.ng).abs() > 0.5
            })
        };
        let sequence = sequence.dimension(COVERAGE);
        let at = |d: DVec2| surface.p + frame.s * d.x + frame.t * d.y;
        // Four places at the rim tell most surfaces that go on from those that end.
        let (sin, cos) = libm::sincos(TAU * sequence.value());
        let rim = DVec2::new(cos, sin) * radius;
        tally.rays.probe += 4;
        if [rim, rim.perp(), -rim, -rim.perp()].into_iter().all(|d| on_surface(at(d))) {
            return 1.0;
        }
        let found = (0..PROBES)
            .filter(|&i| {
                let d = sampling::disk(sequence.split(i, PROBES).pair()) * radius;
                on_surface(at(d))
            })
            .count();
        tally.rays.probe += u64::from(PROBES);
        // The point itself is on the surface.
        (found as f32 / PROBES as f32).max(1.0 / PROBES as f32)
    }
}
