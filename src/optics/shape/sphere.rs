//! The sphere. One face. Its coordinates are longitude and latitude: u from +x towards −z, v from the
//! bottom pole to the top; both poles are singular.

use super::{AreaSample, BareSurface, DirectionSample, ShapeHit, Surface};
use crate::math::{DVec2, DVec3, Frame, Ray, robust, sampling};
use crate::optics::Coordinates;
use std::f64::consts::{FRAC_1_PI, PI, TAU};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    radius: f64,
    center: DVec3,
    inverse_radius: f64,
    p_error: f64,
}

impl Sphere {
    pub fn new(radius: f64, center: DVec3) -> Sphere {
        let p_error = super::p_error(center - radius, center + radius);
        Sphere { radius, center, inverse_radius: 1.0 / radius, p_error }
    }

    pub fn radius(&self) -> f64 {
        self.radius
    }

    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// Where on its way a ray from outside is nearest to the centre; `None` if that is behind it.
    pub fn nearest_to_center(&self, ray: &Ray) -> Option<f64> {
        let to_center = self.center - ray.origin;
        let t = to_center.dot(ray.dir) / ray.dir.length_squared();
        (t > 0.0 && to_center.length() > self.radius).then_some(t)
    }

    /// The normal at a point of the surface.
    #[inline]
    fn outwards(&self, p: DVec3) -> DVec3 {
        let outwards = (p - self.center) * self.inverse_radius;
        if outwards == DVec3::ZERO { DVec3::Y } else { robust::renormalized(outwards) }
    }

    /// sin² of the half-angle under which the sphere is seen; `None` from inside.
    fn sin2_theta_max(&self, from: DVec3) -> Option<f64> {
        let sin = self.radius / self.center.distance(from);
        (sin < 1.0).then_some(sin * sin)
    }
}

/// From the bottom pole (0) to the top (1), and around +y from +x towards −z, for any point but 0.
pub fn longitude_latitude(p: DVec3) -> DVec2 {
    DVec2::new(longitude(p), libm::atan2(libm::hypot(p.x, p.z), -p.y) * FRAC_1_PI)
}

/// The angle around +y from +x towards −z, as a share of the full turn in [0, 1].
pub fn longitude(p: DVec3) -> f64 {
    let turn = libm::atan2(-p.z, p.x) / TAU;
    if turn < 0.0 { turn + 1.0 } else { turn }
}

impl Surface for Sphere {
    fn bounds(&self) -> (DVec3, DVec3) {
        (self.center - self.radius, self.center + self.radius)
    }

    fn ball(&self) -> (DVec3, f64) {
        (self.center, self.radius)
    }

    #[inline(always)]
    fn nearest(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<ShapeHit> {
        let [enter, exit] = robust::sphere_roots(ray.origin - self.center, ray.dir, self.radius)?;
        let t = if t_min < enter { enter } else { exit };
        (t_min < t && t < t_max).then_some(ShapeHit { t, face: 0 })
    }

    #[inline]
    fn bare_surface(&self, ray: &Ray, hit: ShapeHit) -> BareSurface {
        let n = self.outwards(ray.at(hit.t));
        BareSurface { p: self.center + n * self.radius, p_error: self.p_error, ng: n }
    }

    fn coordinates(&self, p: DVec3, _: u32) -> Coordinates {
        let n = self.outwards(p);
        let rim = libm::hypot(n.x, n.z);
        // Any closer to a pole, the derivative along u is too short to be given a direction.
        let (dpdu, dpdv) = if rim > 1e-30 {
            let dpdv = DVec3::new(-n.y * (n.x / rim), rim, -n.y * (n.z / rim)) * (PI * self.radius);
            (DVec3::new(n.z, 0.0, -n.x) * (TAU * self.radius), dpdv)
        } else {
            (DVec3::ZERO, DVec3::ZERO)
        };
        Coordinates { uv: longitude_latitude(n), dpdu, dpdv }
    }

    fn closed(&self) -> bool {
        true
    }

    fn clearance(&self, _: DVec3) -> f64 {
        f64::INFINITY
    }

    fn depth(&self, p: DVec3) -> f64 {
        self.radius - p.distance(self.center)
    }

    fn area(&self) -> f64 {
        4.0 * PI * self.radius * self.radius
    }

    fn sample_area(&self, u: [f64; 2]) -> AreaSample {
        let n = sampling::sphere(u);
        AreaSample {
            p: self.center + n * self.radius,
            ng: n,
            uv: longitude_latitude(n),
            pdf: 1.0 / self.area(),
        }
    }

    fn sample_direction(&self, from: DVec3, u: [f64; 2]) -> Option<DirectionSample> {
        let Some(sin2) = self.sin2_theta_max(from) else {
            return Some(DirectionSample { dir: sampling::sphere(u), pdf: sampling::SPHERE_PDF });
        };
        let pdf = sampling::cone_pdf(sin2);
        let axis = (self.center - from).try_normalize()?;
        pdf.is_finite().then(|| {
            let dir = Frame::around(axis).to_world(sampling::cone(sin2, u)).normalize();
            DirectionSample { dir, pdf }
        })
    }

    fn direction_pdf(&self, from: DVec3, dir: DVec3) -> f64 {
        let Some(sin2) = self.sin2_theta_max(from) else {
            return sampling::SPHERE_PDF;
        };
        let pdf = sampling::cone_pdf(sin2);
        let to_center = self.center - from;
        let sees = dir.dot(to_center) > 0.0
            && dir.cross(to_center).length_squared() <= sin2 * to_center.length_squared();
        if sees && pdf.is_finite() { pdf } else { 0.0 }
    }
}
