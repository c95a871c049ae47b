//! Direct light: every emitter is sampled from the shading point (next-event estimation).
//!
//! L = Σ_emitters 1/n Σ f(wo, wi)·|cosθ_i|·V·Lₑ/p(wi), with f = base/π + ks·(s+2)/2π·cosˢα: the
//! Lambert layer and the normalised Phong highlight of exponent s. Any surface in between blocks
//! light, glass as well: what glass lets through is a caustic.

use super::branch::{Branch, LIGHTS};
use super::light::{Arrival, LightSample};
use super::{Tally, Tracer};
use crate::build::{MediaSet, Shading, Start, Surface};
use crate::math::{Color, Ray};
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
        carried: Carriers,
        base: Color,
        branch: &Branch,
        surface: &Surface,
        shading: &Shading,
        tally: &mut Tally,
    ) -> Color {
        let sequence = branch.sequence;
        let if_carried = |effect, weight| if carried.any(effect) { weight } else { Color::ZERO };
        let lamps =
            Lobes::of(if_carried(Carriers::DIRECT, base), if_carried(Carriers::HIGHLIGHTS, shading.ks));
        // Light from all around has no middle that a highlight could show.
        let shine = if self.plan.soft_shadows { shading.ks } else { Color::ZERO };
        let sky =
            Lobes::of(if_carried(Carriers::ENVIRONMENT, base), if_carried(Carriers::ENVIRONMENT, shine));
        let mut sum = Color::ZERO;
        for (i, emitter) in self.world.emitters.iter().enumerate() {
            let lobes = if matches!(emitter.kind, EmitterKind::Environment) { &sky } else { &lamps };
            if lobes.black {
                continue;
            }
            let mut light = Color::ZERO;
            for k in 0..emitter.samples {
                // Only emitters with an extent draw it.
                let drawn =
                    || sequence.dimension(LIGHTS).dimension(i as u64).split(k, emitter.samples).pair();
                let u = || if self.plan.soft_shadows { drawn() } else { MIDDLE };
                light += self.once(i, lobes, surface, shading, &branch.media, u, tally);
            }
            if emitter.samples > 1 {
                light /= emitter.samples as f32;
            }
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
        lobes: &Lobes,
        surface: &Surface,
        shading: &Shading,
        media: &MediaSet,
        u: impl FnOnce() -> [f64; 2],
        tally: &mut Tally,
    ) -> Color {
        let kind = &self.world.emitters[emitter].kind;
        if kind.extended() {
            return self.once_extended(emitter, lobes, surface, shading, media, u, tally);
        }
        match &LightSample::without_extent(kind, surface.p) {
            Some(sample) => self.arriving(emitter, lobes, surface, shading, media, sample, tally),
            None => Color::ZERO,
        }
    }

    /// The same of an emitter with an extent: apart, so that points need not carry its arithmetic along.
    #[expect(clippy::too_many_arguments, reason = "as above")]
    #[inline(never)]
    fn once_extended(
        &self,
        emitter: usize,
        lobes: &Lobes,
        surface: &Surface,
        shading: &Shading,
        media: &MediaSet,
        u: impl FnOnce() -> [f64; 2],
        tally: &mut Tally,
    ) -> Color {
        match &self.extended_sample(&self.world.emitters[emitter].kind, surface, shading, u) {
            Some(sample) => self.arriving(emitter, lobes, surface, shading, media, sample, tally),
            None => Color::ZERO,
        }
    }

    /// What of a sample's light the point sends on, if nothing hides it.
    #[expect(clippy::too_many_arguments, reason = "as above")]
    #[inline(always)]
    fn arriving(
        &self,
        emitter: usize,
        lobes: &Lobes,
        surface: &Surface,
        shading: &Shading,
        media: &MediaSet,
        sample: &LightSample,
        tally: &mut Tally,
    ) -> Color {
        let value = sample.value * reflected_share(lobes, shading, sample);
        if value == Color::ZERO {
            return Color::ZERO;
        }
        tally.rays.shadow += u64::from(self.plan.shadows);
        if !self.visible(emitter, surface, shading, media, sample) {
            return Color::ZERO;
        }
        value * self.world.transmittance(media, sample.distance)
    }

    /// Whether nothing hides the light of an emitter, by its index.
    fn visible(
        &self,
        emitter: usize,
        surface: &Surface,
        shading: &Shading,
        media: &MediaSet,
        sample: &LightSample,
    ) -> bool {
        let lifted = surface.lifted.is_some();
        let above = sample.wi.dot(shading.ng) > 0.0;
        if !above && !lifted {
            // Lit through the back of the surface: only the shading normal says otherwise.
            return false;
        }
        if !self.plan.shadows {
            return true;
        }
        let origin = surface.lifted.unwrap_or(surface.p) + shading.ng * surface.p_error;
        let outside = above && shading.ng.dot(surface.ng) > 0.0;
        let start = Start { instance: surface.instance, outside };
        // What is lifted need not lie within the bounds of its surface.
        let occluded = |ray: &Ray, t_max, except| match lifted {
            false => self.world.occluded_from(start, ray, t_max, except),
            true => self.world.occluded(ray, t_max, except),
        };
        let clear = match sample.arrival {
            Arrival::Infinite => {
                let ray = Ray { origin, dir: sample.wi };
                !occluded(&ray, f64::INFINITY, None)
            }
            // The emitter is convex: what lies before its first surface is not itself.
            Arrival::Shape { p, instance } => {
                let ray = Ray { origin, dir: p - origin };
                let end = 1.0 - self.world.flush(&ray, p, instance);
                let hidden = occluded(&ray, end, Some(instance))
                    && !self.world.hidden_by_flush_only(&ray, end, None, instance);
                !hidden && !self.world.left_at(&ray, None, media, instance)
            }
            Arrival::Facet { p, p_error, instance } => {
                let ray = Ray { origin, dir: p - origin };
                // It has been moved by as much.
                let p_error = Some(2.0 * p_error);
                let hidden = occluded(&ray, 1.0, None)
                    && !self.world.hidden_by_flush_only(&ray, 1.0, p_error, instance);
                !hidden && !self.world.left_at(&ray, p_error, media, instance)
            }
            Arrival::Point { p } => {
                let ray = Ray { origin, dir: p - origin };
                !self.world.hidden_from(emitter, start, &ray).unwrap_or_else(|| occluded(&ray, 1.0, None))
            }
        };
        clear
            && !(self.world.emitters_in_glass[emitter]
                && self.world.enters(surface, sample.wi, media, sample.arrival.instance()))
    }
}

/// The weights of a point's two layers for light of one kind.
struct Lobes {
    base: Color,
    ks: Color,
    black: bool,
}

impl Lobes {
    #[inline]
    fn of(base: Color, ks: Color) -> Lobes {
        Lobes { base, ks, black: base == Color::ZERO && ks == Color::ZERO }
    }
}

/// f(wo, wi)·cosθ_i of the Lambert layer and of the highlight, each of its weight.
#[inline]
fn reflected_share(&Lobes { base, ks, .. }: &Lobes, shading: &Shading, sample: &LightSample) -> Color {
    let cos = sample.wi.dot(shading.ns);
    if cos <= 0.0 {
        return Color::ZERO;
    }
    let lambert = base * (cos * FRAC_1_PI) as f32;
    if ks == Color::ZERO {
        return lambert;
    }
    lambert + highlight(ks, shading, sample, cos)
}

/// The Phong highlight's part of it.
#[inline(never)]
fn highlight(ks: Color, shading: &Shading, sample: &LightSample, cos: f64) -> Color {
    let mirror = shading.ns * (2.0 * shading.wo.dot(shading.ns)) - shading.wo;
    let cos_alpha = mirror.dot(sample.wi);
    if cos_alpha <= 0.0 {
        return Color::ZERO;
    }
    let s = shading.material.shininess;
    ks * ((s + 2.0) / TAU * libm::pow(cos_alpha.min(1.0), s) * cos) as f32
}
