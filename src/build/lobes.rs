//! Directions in which a surface that is not specular sends light on.

use super::shading::Shading;
use crate::math::{Color, DVec3, Frame, sampling};
use std::f64::consts::{FRAC_1_PI, TAU};

impl Shading<'_> {
    /// A direction and f·cosθ over its density; `None` below the surface. `base` is the weight of the Lambert
    /// layer. The direction is drawn from the layers' own lobes, the cosine and the Phong lobe around the
    /// mirror direction, chosen by their weights with `choose`; the density is that of both together.
    pub fn scattered(
        &self,
        base: Color,
        u: [f64; 2],
        choose: impl FnOnce() -> f64,
    ) -> Option<(DVec3, Color)> {
        let (ng, ns) = (self.ng, self.ns);
        if self.ks == Color::ZERO {
            let wi = Frame::around(ns).to_world(sampling::cosine_hemisphere(u));
            return (wi.dot(ng) > 0.0).then_some((wi, base));
        }
        let mirror = ns * (2.0 * self.wo.dot(ns)) - self.wo;
        let s = self.material.shininess;
        let (lambert, lobe) = (f64::from(base.max_element()), f64::from(self.ks.max_element()));
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
        let f = base * FRAC_1_PI as f32 + self.ks * highlight as f32;
        Some((wi, f * (cos / pdf) as f32))
    }
}
