//! Smooth interfaces: mirror direction, Snell's law, Fresnel's equations for unpolarised light.
//!
//! Walter, Marschner, Li, Torrance 2007, section 5, for the vector forms; Born & Wolf, Principles of
//! Optics, section 1.5, for the amplitudes.

use crate::math::robust::renormalized;
use glam::DVec3;

/// What an interface does with light that comes along −wo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interface {
    /// Share of the power that is reflected, [0, 1]; the rest is refracted.
    pub reflectance: f64,
    /// Cosine on the far side; 0 under total internal reflection.
    pub cos_t: f64,
}

impl Interface {
    /// `cos_i` ≥ 0 on the near side; `eta` = n_far / n_near > 0. Defined for every such argument:
    /// equal media reflect nothing, grazing light is reflected wholly otherwise.
    #[inline]
    pub fn new(cos_i: f64, eta: f64) -> Interface {
        let cos_i = cos_i.clamp(0.0, 1.0);
        if eta == 1.0 {
            return Interface { reflectance: 0.0, cos_t: cos_i };
        }
        // (1 − c)(1 + c) keeps the digits of a small sine.
        let sin2_t = (1.0 - cos_i) * (1.0 + cos_i) / (eta * eta);
        if sin2_t >= 1.0 {
            return Interface { reflectance: 1.0, cos_t: 0.0 };
        }
        let cos_t = (1.0 - sin2_t).sqrt();
        let rs = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
        let rp = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
        Interface { reflectance: 0.5 * (rs * rs + rp * rp), cos_t }
    }
}

/// The mirror image of `wo` about the unit normal `n`; both point away from the surface.
#[inline]
pub fn reflected(wo: DVec3, n: DVec3) -> DVec3 {
    renormalized(n * (2.0 * wo.dot(n)) - wo)
}

/// The direction in which light that comes along −wo goes on behind the interface. `n` is the unit
/// normal on wo's side, `cos_t` from [`Interface::new`] with the same `eta`.
#[inline]
pub fn refracted(wo: DVec3, n: DVec3, eta: f64, cos_t: f64) -> DVec3 {
    let cos_i = wo.dot(n);
    renormalized((n * (cos_i - eta * cos_t) - wo) * (1.0 / eta))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::{Counter, Stage};

    #[test]
    fn refraction_obeys_snell_in_the_plane_of_incidence() {
        let mut random = Counter::new(2, Stage::Test, 0);
        for _ in 0..100_000 {
            let mut unit =
                || DVec3::new(random.value() - 0.5, random.value() - 0.5, random.value() - 0.5).normalize();
            let n = unit();
            let mut wo = unit();
            if wo.dot(n) < 0.0 {
                wo = -wo;
            }
            for eta in [1.5, 1.0 / 1.5, 1.333, 0.7] {
                let f = Interface::new(wo.dot(n), eta);
                if f.reflectance == 1.0 {
                    continue;
                }
                let wt = refracted(wo, n, eta, f.cos_t);
                assert!(wt.dot(n) <= 0.0);
                let (sin_i, sin_t) = (wo.cross(n).length(), wt.cross(n).length());
                assert!((sin_i - eta * sin_t).abs() < 1e-9);
                assert!(wt.dot(n.cross(wo)).abs() < 1e-9);
            }
        }
    }
}
