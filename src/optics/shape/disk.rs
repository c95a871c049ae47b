//! The disk or ring in the plane y = 0, normal +y. Its coordinates are those of its bounding square:
//! u grows along +x, v along −z.

use super::quad::{Quad, plane_coordinates, plane_crossing, plane_error, plane_surface, plane_uv};
use super::{AreaSample, BareSurface, DirectionSample, ShapeHit, Surface};
use crate::math::{DVec2, DVec3, Ray, sampling};
use crate::optics::Coordinates;
use std::f64::consts::{PI, TAU};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disk {
    radius: f64,
    inner_radius: f64,
    p_error: f64,
}

impl Disk {
    /// A ring if `inner_radius` > 0.
    pub fn new(radius: f64, inner_radius: f64) -> Disk {
        Disk { radius, inner_radius, p_error: plane_error(DVec2::splat(radius)) }
    }

    fn square(&self) -> Quad {
        Quad::new([2.0 * self.radius; 2])
    }
}

/// Uniform by area between two radii, in the plane; keeps squares in shape where there is no hole.
pub(super) fn sample_ring(inner: f64, outer: f64, u: [f64; 2]) -> DVec2 {
    if inner == 0.0 {
        return sampling::disk(u) * outer;
    }
    let r = (inner * inner + u[0] * (outer - inner) * (outer + inner)).sqrt();
    let (sin, cos) = libm::sincos(TAU * u[1]);
    DVec2::new(cos, sin) * r
}

impl Surface for Disk {
    fn bounds(&self) -> (DVec3, DVec3) {
        self.square().bounds()
    }

    fn ball(&self) -> (DVec3, f64) {
        (DVec3::ZERO, self.radius)
    }

    fn nearest(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<ShapeHit> {
        let (t, p) = plane_crossing(ray, t_min, t_max)?;
        let r2 = p.x * p.x + p.z * p.z;
        let within = self.inner_radius * self.inner_radius <= r2 && r2 <= self.radius * self.radius;
        within.then_some(ShapeHit { t, face: 0 })
    }

    fn bare_surface(&self, ray: &Ray, hit: ShapeHit) -> BareSurface {
        plane_surface(ray.at(hit.t), DVec2::splat(self.radius), self.p_error)
    }

    fn coordinates(&self, p: DVec3, _: u32) -> Coordinates {
        plane_coordinates(p, DVec2::splat(self.radius))
    }

    fn closed(&self) -> bool {
        false
    }

    fn clearance(&self, p: DVec3) -> f64 {
        let r = libm::hypot(p.x, p.z);
        (self.radius - r).min(if self.inner_radius > 0.0 { r - self.inner_radius } else { f64::INFINITY })
    }

    fn depth(&self, _: DVec3) -> f64 {
        0.0
    }

    fn area(&self) -> f64 {
        PI * (self.radius - self.inner_radius) * (self.radius + self.inner_radius)
    }

    fn sample_area(&self, u: [f64; 2]) -> AreaSample {
        let d = sample_ring(self.inner_radius, self.radius, u);
        let p = DVec3::new(d.x, 0.0, d.y);
        AreaSample { p, ng: DVec3::Y, uv: plane_uv(p, DVec2::splat(self.radius)), pdf: 1.0 / self.area() }
    }

    /// Uniform over the directions to the bounding square, those that miss the disk included: from
    /// afar, 1 − π/4 of them for a full disk.
    fn sample_direction(&self, from: DVec3, u: [f64; 2]) -> Option<DirectionSample> {
        self.square().sample_direction(from, u)
    }

    fn direction_pdf(&self, from: DVec3, dir: DVec3) -> f64 {
        self.square().direction_pdf(from, dir)
    }
}
