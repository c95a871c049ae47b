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

    fn deg(cos: f64) -> f64 {
        libm::acos(cos).to_degrees()
    }

    /// S1: angle in = angle out.
    #[test]
    fn mirror_reflects_at_the_angle_of_incidence_within_1e_minus_6() {
        let mut random = Counter::new(1, Stage::Test, 0);
        for _ in 0..1_000_000 {
            let mut unit =
                || DVec3::new(random.value() - 0.5, random.value() - 0.5, random.value() - 0.5).normalize();
            let (n, wo) = (unit(), unit());
            let wi = reflected(wo, n);
            assert!((wi.dot(n) - wo.dot(n)).abs() < 1e-6);
            assert!(wi.dot(n.cross(wo)).abs() < 1e-6, "not in the plane of incidence");
        }
    }

    /// H12.
    #[test]
    fn grazing_light_is_reflected_wholly_and_monotonically() {
        for eta in [1.5, 1.0 / 1.5, 1.333, 2.417, 0.05, 10.0] {
            assert_eq!(Interface::new(0.0, eta).reflectance, 1.0);
            let mut last = 1.0;
            for cos in [f64::MIN_POSITIVE / 4.0, 1e-300, 1e-20, 1e-8, 1e-3] {
                let f = Interface::new(cos, eta);
                assert!(f.reflectance.is_finite() && f.reflectance <= last && f.reflectance >= 0.0);
                assert!(f.cos_t.is_finite());
                last = f.reflectance;
            }
        }
        assert_eq!(Interface::new(0.0, 1.0).reflectance, 0.0);
    }

    /// H13, with the values computed independently in the catalogue of hard cases.
    #[test]
    fn fresnel_has_its_known_values_and_its_critical_angle() {
        let at = |degrees: f64, eta: f64| Interface::new(libm::cos(degrees.to_radians()), eta).reflectance;
        assert!((at(0.0, 1.5) - 0.04).abs() < 1e-15);
        assert!((at(60.0, 1.5) - 0.089_186_7).abs() < 1e-7);
        assert!((at(56.309_932_474, 1.5) - 0.073_964_5).abs() < 1e-7);
        assert!((Interface::new(1.0, 1.33 / 1.5).reflectance - 0.003_608_5).abs() < 1e-7);

        let critical = libm::asin(1.0 / 1.5);
        assert!((critical.to_degrees() - 41.810_314_9).abs() < 1e-7);
        let below = Interface::new(libm::cos(critical - 1e-9), 1.0 / 1.5).reflectance;
        assert!((below - 0.999_725).abs() < 1e-6, "{below}");
        assert_eq!(Interface::new(libm::cos(critical + 1e-9), 1.0 / 1.5).reflectance, 1.0);
        let mut cos = libm::cos(critical);
        for _ in 0..64 {
            cos = cos.next_down();
        }
        for _ in 0..128 {
            let f = Interface::new(cos, 1.0 / 1.5);
            assert!(f.reflectance > 0.999 && f.reflectance <= 1.0 && f.cos_t >= 0.0);
            cos = cos.next_up();
        }
    }

    /// H15: looking from the other side at the refracted angle gives the same reflectance.
    #[test]
    fn reflectance_is_the_same_from_both_sides() {
        for eta in [1.5, 1.333, 2.4] {
            for i in 1..90 {
                let cos_i = libm::cos(f64::from(i).to_radians());
                let outside = Interface::new(cos_i, eta);
                let inside = Interface::new(outside.cos_t, 1.0 / eta);
                assert!((outside.reflectance - inside.reflectance).abs() < 1e-12);
            }
        }
    }

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

    /// H49: the least deviation of a 60° prism of n = 1.5 is 37.1808°.
    #[test]
    fn prism_deviates_least_by_its_known_angle() {
        let apex = 60f64.to_radians();
        let left = DVec3::new(-libm::cos(apex / 2.0), libm::sin(apex / 2.0), 0.0);
        let right = DVec3::new(libm::cos(apex / 2.0), libm::sin(apex / 2.0), 0.0);
        let mut least = f64::INFINITY;
        for i in 0..200_000 {
            let incidence = (30.0 + 50.0 * f64::from(i) / 200_000.0).to_radians();
            // The incoming ray lies below the left face's normal.
            let along = DVec3::new(left.y, -left.x, 0.0);
            let d = (-left * libm::cos(incidence) + along * libm::sin(incidence)).normalize();
            let first = Interface::new(-d.dot(left), 1.5);
            let inside = refracted(-d, left, 1.5, first.cos_t);
            let second = Interface::new(inside.dot(right), 1.0 / 1.5);
            if second.reflectance == 1.0 {
                continue;
            }
            let out = refracted(-inside, -right, 1.0 / 1.5, second.cos_t);
            least = least.min(deg(out.dot(d).clamp(-1.0, 1.0)));
        }
        assert!((least - 37.1808).abs() < 1e-4, "{least}");
    }

    /// H49: a plane slab of thickness 1 and n = 1.5 shifts a 45° ray by 0.329142.
    #[test]
    fn slab_shifts_a_ray_by_its_known_distance() {
        let n = DVec3::Y;
        let d = DVec3::new(1.0, -1.0, 0.0).normalize();
        let enter = Interface::new(-d.dot(n), 1.5);
        let inside = refracted(-d, n, 1.5, enter.cos_t);
        let exit_point = inside / -inside.y;
        let leave = Interface::new(-inside.dot(n), 1.0 / 1.5);
        let out = refracted(-inside, n, 1.0 / 1.5, leave.cos_t);
        assert!((out - d).length() < 1e-12);
        let shift = (exit_point - d * exit_point.dot(d)).length();
        assert!((shift - 0.329_142).abs() < 1e-6, "{shift}");
    }
}
