//! Light that glass, water and mirrors have focused (L S⁺ D): the photons near a surface point.
//!
//! Photons count the power that arrives by area of the geometric surface; shading counts it by the
//! shading normal. Each is weighed by cosθ_shading/cosθ_geometric (Veach 1997, 5.3), so that photons
//! and shadow rays agree on smooth meshes and under normal maps.

mod ground;

use super::branch::{Branch, COVERAGE, INNER, OUTER};
use super::{Tally, Tracer};
use crate::build::{Shading, Surface};
use crate::index::{Caustics, Gathered, Hit, Radius, Reach};
use crate::math::{Color, Vec3};
use ground::Ground;
use std::cell::Cell;
use std::f32::consts::{FRAC_1_SQRT_2, SQRT_2};
use std::f64::consts::TAU;

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

/// What was gathered, and what makes up for the places of its disc where no photon could be.
struct Estimate {
    gathered: Gathered,
    correction: f32,
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
        let mirror = (shading.ns * (2.0 * shading.wo.dot(shading.ns)) - shading.wo).as_vec3();
        let exponent = shading.material.shininess;
        let peak = shading.ks * ((exponent + 2.0) / TAU) as f32;
        let brdf = |wi: Vec3| {
            if shading.ks == Color::ZERO {
                return lambert * by_normals(wi);
            }
            let cos = f64::from(mirror.dot(wi).clamp(0.0, 1.0));
            let lobe = if cos > 0.0 { libm::pow(cos, exponent) as f32 } else { 0.0 };
            (lambert + peak * lobe) * by_normals(wi)
        };
        let face = self.world.face(surface, shading.ng);
        let probing = tally.probing;
        let mut estimate = |radius: Radius, dimension: u64| {
            let around = |radius| Ground::around(self.world, surface, shading, radius);
            let all = || caustics.gather(p, ng, radius, |hit| hit.face == face, brdf);
            let crowded = |ground: &Option<Ground>| ground.as_ref().is_some_and(Ground::is_crowded);
            let (mut gathered, mut ground) = match radius {
                Radius::Fixed(radius) => match around(radius) {
                    ground if crowded(&ground) => (Gathered { radius, ..Gathered::default() }, ground),
                    ground => (all(), ground),
                },
                // The ground is looked at when the photons have chosen the radius.
                Radius::Nearest { .. } => {
                    let all = all();
                    (all, around(all.radius))
                }
            };
            let sequence = branch.sequence.dimension(dimension);
            let mut correct = |ground: &Ground| {
                let (correction, places) = ground.correction(caustics.kernel, sequence);
                tally.rays.probe += u64::from(places);
                correction
            };
            if let Some(among) = ground.take_if(|ground| ground.is_crowded()) {
                let hidden = Cell::new(false);
                let holds = |hit: &Hit| {
                    if hit.face != face {
                        return false;
                    }
                    let holds = among.holds(hit.offset);
                    hidden.set(hidden.get() || !holds);
                    holds
                };
                gathered = caustics.gather(p, ng, radius, holds, brdf);
                if gathered.photons == 0 && !hidden.get() && !probing {
                    return Estimate { gathered, correction: 1.0 };
                }
                if let Some(correction) = correct(&among) {
                    return Estimate { gathered, correction };
                }
                // Hardly any ground: what is in the way is roughness of it.
                (gathered, ground) = (all(), Some(among.cleared()));
            }
            // A probe looks at what is just beyond the radius in any case, or its mean would be off.
            let correction = match ground {
                Some(ground) if gathered.photons > 0 || probing => correct(&ground).unwrap_or(1.0),
                _ => 1.0,
            };
            Estimate { gathered, correction }
        };
        let Estimate { gathered, correction } = estimate(caustics.radius(p, ng, least), COVERAGE);
        if gathered.photons == 0 && !probing {
            return Caustic { radius: gathered.radius, ..Caustic::default() };
        }
        let radiance = gathered.radiance * correction;
        let mut look = |within: f32, dimension: u64| {
            let Estimate { gathered, correction } = estimate(Radius::Fixed(within), dimension);
            gathered.radiance * correction
        };
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
}
