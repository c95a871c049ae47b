//! Direct light: every emitter is sampled from the shading point (next-event estimation).
//!
//! L = Σ_emitters 1/n Σ f(wo, wi)·|cosθ_i|·V·Lₑ/p(wi), with f = base/π + ks·(s+2)/2π·cosˢα: the
//! Lambert layer and the normalised Phong highlight of exponent s. Any surface in between blocks
//! light, glass as well: what glass lets through is a caustic.

use super::light::{Arrival, LightSample};
use super::path::{Branch, LIGHTS};
use super::{Tally, Tracer};
use crate::build::{MediaSet, Shading, Surface};
use crate::math::{Ray, Vec3};
use crate::optics::EmitterKind;
use crate::plan::Carriers;
use std::f64::consts::{FRAC_1_PI, TAU};

/// Of a light's sampling domain: where it is sampled without soft shadows.
const MIDDLE: [f64; 2] = [0.5; 2];

impl Tracer<'_> {
    /// Light that the point reflects towards wo from all emitters; `base` is the weight of its
    /// Lambert layer.
    pub(super) fn direct(
        &self,
        base: Vec3,
        branch: &Branch,
        surface: &Surface,
        shading: &Shading,
        tally: &mut Tally,
    ) -> Vec3 {
        let (carried, sequence) = (self.carried(branch), branch.sequence);
        let if_carried = |effect, weight| if carried.any(effect) { weight } else { Vec3::ZERO };
        let lamps = [if_carried(Carriers::DIRECT, base), if_carried(Carriers::HIGHLIGHTS, shading.ks)];
        // Light from all around has no middle that a highlight could show.
        let shine = if self.plan.soft_shadows { shading.ks } else { Vec3::ZERO };
        let sky = [base, shine].map(|weight| if_carried(Carriers::ENVIRONMENT, weight));
        let mut sum = Vec3::ZERO;
        for (i, emitter) in self.world.emitters.iter().enumerate() {
            let lobes = if matches!(emitter.kind, EmitterKind::Environment) { sky } else { lamps };
            if lobes == [Vec3::ZERO; 2] {
                continue;
            }
            let part = |k, tally: &mut Tally| {
                // Only emitters with an extent draw it.
                let drawn =
                    || sequence.dimension(LIGHTS).dimension(i as u64).split(k, emitter.samples).pair();
                let u = || if self.plan.soft_shadows { drawn() } else { MIDDLE };
                self.once(i, lobes, surface, shading, &branch.media, u, tally)
            };
            let light = if emitter.samples == 1 {
                part(0, tally)
            } else {
                let mut light = Vec3::ZERO;
                (0..emitter.samples).for_each(|k| light += part(k, tally));
                light / emitter.samples as f32
            };
            tally.note(|recorder| recorder.light(&emitter.name, light));
            sum += light;
        }
        sum
    }

    /// The light of one sample of an emitter, by its index.
    #[expect(clippy::too_many_arguments, reason = "the body of a loop")]
    #[inline]
    fn once(
        &self,
        emitter: usize,
        lobes: [Vec3; 2],
        surface: &Surface,
        shading: &Shading,
        media: &MediaSet,
        u: impl FnOnce() -> [f64; 2],
        tally: &mut Tally,
    ) -> Vec3 {
        let Some(sample) = self.light_sample(&self.world.emitters[emitter], surface, shading, u) else {
            return Vec3::ZERO;
        };
        let value = sample.value * reflected_share(lobes, shading, &sample);
        if value == Vec3::ZERO {
            return Vec3::ZERO;
        }
        tally.rays.shadow += u64::from(self.plan.shadows);
        if !self.visible(emitter, surface, shading, &sample) {
            return Vec3::ZERO;
        }
        value * self.world.transmittance(media, sample.distance)
    }

    /// Whether nothing hides the light of an emitter, by its index.
    fn visible(&self, emitter: usize, surface: &Surface, shading: &Shading, sample: &LightSample) -> bool {
        let lifted = surface.shadow_p != surface.p;
        let above = sample.wi.dot(shading.ng) > 0.0;
        if !above && !lifted {
            // Lit through the back of the surface: only the shading normal says otherwise.
            return false;
        }
        if !self.plan.shadows {
            return true;
        }
        let start = if lifted { surface.shadow_p } else { surface.p };
        let origin = start + shading.ng * surface.p_error;
        match sample.arrival {
            Arrival::Infinite => {
                let ray = Ray { origin, dir: sample.wi };
                !self.world.occluded(&ray, f64::INFINITY, None)
            }
            // The emitter is convex: what lies before its first surface is not itself.
            Arrival::Shape { p, instance } => {
                let ray = Ray { origin, dir: p - origin };
                let flush = self.world.flush(&ray, p, instance);
                !self.world.occluded(&ray, 1.0 - flush, Some(instance))
            }
            Arrival::Point { p } => {
                let ray = Ray { origin, dir: p - origin };
                let outside = above && shading.ng.dot(surface.ng) > 0.0;
                !self.world.hidden_from(emitter, &ray, outside.then_some(surface.instance))
            }
        }
    }
}

/// f(wo, wi)·cosθ_i of the Lambert layer and of the highlight, each of its weight.
#[inline]
fn reflected_share([base, ks]: [Vec3; 2], shading: &Shading, sample: &LightSample) -> Vec3 {
    let cos = sample.wi.dot(shading.ns);
    if cos <= 0.0 {
        return Vec3::ZERO;
    }
    let lambert = base * (cos * FRAC_1_PI) as f32;
    if ks == Vec3::ZERO {
        return lambert;
    }
    lambert + highlight(ks, shading, sample, cos)
}

/// The Phong highlight's part of it.
#[inline(never)]
fn highlight(ks: Vec3, shading: &Shading, sample: &LightSample, cos: f64) -> Vec3 {
    let mirror = shading.ns * (2.0 * shading.wo.dot(shading.ns)) - shading.wo;
    let cos_alpha = mirror.dot(sample.wi);
    if cos_alpha <= 0.0 {
        return Vec3::ZERO;
    }
    let s = shading.material.shininess;
    ks * ((s + 2.0) / TAU * libm::pow(cos_alpha.min(1.0), s) * cos) as f32
}
