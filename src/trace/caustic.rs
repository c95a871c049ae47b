//! Light that glass, water and mirrors have focused (L S⁺ D): the photons near a surface point.
//!
//! Photons count the power that arrives by area of the geometric surface; shading counts it by the
//! shading normal. Each is weighed by cosθ_shading/cosθ_geometric (Veach 1997, 5.3), so that photons
//! and shadow rays agree on smooth meshes and under normal maps.

use super::branch::{Branch, COVERAGE, INNER, OUTER};
use super::{Tally, Tracer};
use crate::build::{Shading, Surface};
use crate::index::{Caustics, Gathered, Reach};
use crate::math::random::Sequence;
use crate::math::{Color, Frame, Ray, Vec3};
use std::f32::consts::{FRAC_1_SQRT_2, SQRT_2};
use std::f64::consts::TAU;

/// Counts of trials whose mean is taken, and the most trials of each: a surface that fills less of the disc
/// than that is taken for noise.
const COUNTS: u32 = 2;
const MOST_TRIALS: u32 = 32;

/// A caustic at a surface point.
#[derive(Clone, Copy, Debug, Default)]
pub struct Caustic {
    pub radiance: Color,
    /// Photons by area, 1/m².
    pub density: f32,
    /// Photons in the estimate, and the radius that they were gathered within, metres.
    pub photons: u32,
    pub radius: f32,
    /// What the estimate's blur adds, by [`super::Look`]; known only where it is looked at.
    pub bias: [Color; 2],
}

impl Tracer<'_> {
    /// The caustic that the point reflects towards wo; `base` is the weight of its Lambert layer.
    pub(super) fn caustic(
        &self,
        caustics: &Caustics,
        branch: &Branch,
        base: Color,
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
        let by_normals =
            |wi: Vec3| if bent { (wi.dot(ns).max(0.0) / wi.dot(ng).max(1e-3)).min(10.0) } else { 1.0 };
        let lambert = base * std::f32::consts::FRAC_1_PI;
        let gather = |within: Option<f32>| {
            if shading.ks == Color::ZERO {
                return caustics.gather(p, ng, least, within, |wi| lambert * by_normals(wi));
            }
            let mirror = (shading.ns * (2.0 * shading.wo.dot(shading.ns)) - shading.wo).as_vec3();
            let exponent = shading.material.shininess;
            let peak = shading.ks * ((exponent + 2.0) / TAU) as f32;
            caustics.gather(p, ng, least, within, |wi| {
                let cos = f64::from(mirror.dot(wi).clamp(0.0, 1.0));
                let lobe = if cos > 0.0 { libm::pow(cos, exponent) as f32 } else { 0.0 };
                (lambert + peak * lobe) * by_normals(wi)
            })
        };
        let gathered = gather(None);
        let probing = tally.probing;
        // A probe looks at what is just beyond the radius in any case, or its mean would be off.
        if gathered.photons == 0 && !probing {
            return Caustic { radius: gathered.radius, ..Caustic::default() };
        }
        let sequence = branch.sequence.dimension(COVERAGE);
        let correction = self.edge_correction(caustics, surface, shading, &gathered, sequence, tally);
        let mut look = |within: f32, dimension: u64| {
            let other = gather(Some(within));
            let sequence = branch.sequence.dimension(dimension);
            let correction = self.edge_correction(caustics, surface, shading, &other, sequence, tally);
            other.radiance * correction
        };
        let radiance = gathered.radiance * correction;
        // The blur's bias goes as r² (Silverman 1986, 4.3): there is twice of it at √2·r, half of it at r/√2.
        let bias = if probing {
            let narrow = 2.0 * (radiance - look(gathered.radius * FRAC_1_SQRT_2, INNER));
            // A radius that photons have chosen leaves them no even chance just beyond it.
            let chosen = matches!(caustics.reach, Reach::Nearest { .. });
            let wide = if chosen { narrow } else { look(gathered.radius * SQRT_2, OUTER) - radiance };
            [wide, narrow]
        } else {
            [Color::ZERO; 2]
        };
        let area = std::f32::consts::PI * gathered.radius * gathered.radius;
        let density = gathered.photons as f32 / area;
        Caustic {
            radiance,
            density: density * correction,
            photons: gathered.photons,
            radius: gathered.radius,
            bias,
        }
    }

    /// White where a photon lies within what a pixel covers, in the photon's colour.
    pub(super) fn photon_dots(
        &self,
        caustics: &Caustics,
        branch: &Branch,
        surface: &Surface,
        shading: &Shading,
    ) -> Color {
        let radius = branch.cone.after(surface.t).width as f32;
        let mut dot = Color::ZERO;
        caustics.map.within(surface.p.as_vec3(), shading.ng.as_vec3(), radius, |hit| {
            let most = hit.power.max_element();
            if most > 0.0 {
                dot = dot.max(hit.power / most);
            }
        });
        dot
    }

    /// What the estimate is multiplied by where the surface ends within the disc, so that photons cannot
    /// lie on all of it: the inverse of the kernel's integral over the surface. As many places as are
    /// drawn from the kernel until one lies on the surface are that inverse in the mean, which leaves no bias.
    /// Looked for where the shape does not say that its face goes on for the radius.
    fn edge_correction(
        &self,
        caustics: &Caustics,
        surface: &Surface,
        shading: &Shading,
        gathered: &Gathered,
        sequence: Sequence,
        tally: &mut Tally,
    ) -> f32 {
        let radius = f64::from(gathered.radius);
        if self.world.clearance(surface) >= radius {
            return 1.0;
        }
        let frame = Frame::around(shading.ng);
        let lift = shading.ng * (0.25 * radius + surface.p_error);
        let lies_on_surface = |count: u32, trial: u32| {
            let [u, v] = sequence.dimension(u64::from(trial)).split(count, COUNTS).pair();
            let (sin, cos) = libm::sincos(TAU * v);
            let away = (frame.s * cos + frame.t * sin) * (caustics.kernel.distance(u) * radius);
            let ray = Ray { origin: surface.p + away + lift, dir: -shading.ng };
            let hit = self.world.nearest(&ray, 2.0 * lift.length());
            hit.is_some_and(|hit| self.world.surface(&ray, &hit).ng.dot(shading.ng).abs() > 0.5)
        };
        let mut trials = 0;
        for count in 0..COUNTS {
            trials += (1..=MOST_TRIALS).find(|&trial| lies_on_surface(count, trial)).unwrap_or(MOST_TRIALS);
        }
        tally.rays.probe += u64::from(trials);
        trials as f32 / COUNTS as f32
    }
}
