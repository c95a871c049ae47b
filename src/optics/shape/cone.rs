//! The cone, truncated or not, and the cylinder: a surface of revolution around +y from `radius` at
//! y = 0 to `top_radius` at y = `height`. Faces: 0 the side, 1 the bottom cap, 2 the top cap.
//!
//! On the side u goes around from +x towards −z and v up from 0 to 1, singular at an apex; caps have
//! the coordinates of their bounding squares.
//!
//! The quadric is solved at the ray's point nearest to the shape's centre, so that a distant origin
//! costs no more than its own rounding; but at the origin if that is near, so that a ray that starts
//! close to an apex is judged by the small numbers that it has there.

use super::cuboid::Cuboid;
use super::disk::sample_ring;
use super::span::Span;
use super::sphere::longitude;
use super::{AreaSample, BareSurface, DirectionSample, ShapeHit, Surface};
use crate::math::robust::quadratic_roots;
use crate::math::{DVec2, DVec3, Ray, sampling};
use crate::optics::Coordinates;
use std::f64::consts::{PI, TAU};

const SIDE: u32 = 0;
const BOTTOM: u32 = 1;
const TOP: u32 = 2;

/// Squared distance from the centre, in squared radii of the sphere around the shape, up to which a ray starts
/// near: its whole surface, and a little more.
const NEAR: f64 = 1.25;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    radius: f64,
    top_radius: f64,
    height: f64,
    caps: bool,
    p_error: f64,
}

impl Cone {
    /// `height` > 0, the radii not both 0; equal radii make a cylinder.
    pub fn new(radius: f64, top_radius: f64, height: f64, caps: bool) -> Cone {
        let mut cone = Cone { radius, top_radius, height, caps, p_error: 0.0 };
        let (min, max) = cone.bounds();
        cone.p_error = super::p_error(min, max);
        cone
    }

    /// Whether it has its caps, so that it bounds a solid.
    pub fn capped(&self) -> bool {
        self.caps
    }

    /// The ray and its parameter shifted to the point nearest to the centre, where that is worth it.
    fn shifted(&self, ray: &Ray) -> Option<(Ray, f64)> {
        let from_center = ray.origin - DVec3::new(0.0, 0.5 * self.height, 0.0);
        let (r, h) = (self.radius.max(self.top_radius), 0.5 * self.height);
        if from_center.length_squared() <= NEAR * (r * r + h * h) {
            return Some((*ray, 0.0));
        }
        let t = -from_center.dot(ray.dir) / ray.dir.length_squared();
        t.is_finite().then(|| (Ray { origin: ray.at(t), dir: ray.dir }, t))
    }

    /// The part of the line inside the infinite cone, of the nappe to which the shape belongs.
    fn within_side(&self, ray: &Ray) -> Option<Span> {
        let (o, d) = (ray.origin, ray.dir);
        // The radius along the ray is r + k·t.
        let slope = (self.top_radius - self.radius) / self.height;
        let (r, k) = (self.radius + slope * o.y, slope * d.y);
        let a = d.x * d.x + d.z * d.z - k * k;
        let b = o.x * d.x + o.z * d.z - r * k;
        let c = o.x * o.x + o.z * o.z - r * r;
        let mut span = Span::LINE;
        match quadratic_roots(a, b, c) {
            Some([t0, t1]) if a >= 0.0 => {
                span.enter_at(t0, SIDE);
                span.leave_at(t1, SIDE);
            }
            // Steeper than the side: the line comes in and stays, or was in and goes out.
            Some([_, t1]) if k > 0.0 => span.enter_at(t1, SIDE),
            Some([t0, _]) => span.leave_at(t0, SIDE),
            None if a > 0.0 => return None,
            None if a == 0.0 => return (c <= 0.0).then_some(span),
            // Through the apex, but for rounding.
            None if k > 0.0 => span.enter_at(-b / a, SIDE),
            None => span.leave_at(-b / a, SIDE),
        }
        span.not_empty()
    }

    /// The crossings of the side alone, for a surface without caps.
    fn nearest_on_side(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<ShapeHit> {
        let (near, shift) = self.shifted(ray)?;
        let span = self.within_side(&near)?;
        [span.enter, span.exit]
            .into_iter()
            .filter(|hit| hit.t.is_finite() && (0.0..=self.height).contains(&near.at(hit.t).y))
            .map(|hit| ShapeHit { t: hit.t + shift, face: SIDE })
            .find(|hit| t_min < hit.t && hit.t < t_max)
    }

    fn slant(&self) -> f64 {
        libm::hypot(self.height, self.top_radius - self.radius)
    }

    /// Areas by face.
    fn areas(&self) -> [f64; 3] {
        let cap = |r: f64| if self.caps { PI * r * r } else { 0.0 };
        [PI * (self.radius + self.top_radius) * self.slant(), cap(self.radius), cap(self.top_radius)]
    }

    fn side_normal(&self, around: DVec2) -> DVec3 {
        let n = DVec3::new(self.height * around.x, self.radius - self.top_radius, self.height * around.y);
        n.try_normalize().unwrap_or(DVec3::Y)
    }

    /// A point of the side: the direction around the axis, the share of the height, the radius there.
    fn on_side(&self, p: DVec3) -> (DVec2, f64, f64) {
        let widening = self.top_radius - self.radius;
        let rim = libm::hypot(p.x, p.z);
        let around = if rim > 0.0 { DVec2::new(p.x, p.z) / rim } else { DVec2::ZERO };
        // The nearest point of the generating line.
        let along = (rim - self.radius) * widening + p.y * self.height;
        let v = (along / (self.height * self.height + widening * widening)).clamp(0.0, 1.0);
        (around, v, self.radius + v * widening)
    }

    fn bare_at(&self, p: DVec3, face: u32) -> BareSurface {
        let p_error = self.p_error;
        match face {
            SIDE => {
                let (around, v, r) = self.on_side(p);
                let p = DVec3::new(around.x * r, v * self.height, around.y * r);
                BareSurface { p, p_error, ng: self.side_normal(around) }
            }
            TOP => BareSurface { p: DVec3::new(p.x, self.height, p.z), p_error, ng: DVec3::Y },
            _ => BareSurface { p: DVec3::new(p.x, 0.0, p.z), p_error, ng: DVec3::NEG_Y },
        }
    }

    fn side_coordinates(&self, p: DVec3) -> Coordinates {
        let (around, v, r) = self.on_side(p);
        let widening = self.top_radius - self.radius;
        let uv = DVec2::new(longitude(DVec3::new(around.x, 0.0, around.y)), v);
        // So close to the axis the derivative along u is too short to be given a direction.
        if around == DVec2::ZERO || r <= 1e-30 * self.radius.max(self.top_radius) {
            return Coordinates { uv, dpdu: DVec3::ZERO, dpdv: DVec3::ZERO };
        }
        let dpdu = DVec3::new(around.y, 0.0, -around.x) * (TAU * r);
        let dpdv = DVec3::new(around.x * widening, self.height, around.y * widening);
        Coordinates { uv, dpdu, dpdv }
    }

    fn cap_coordinates(&self, p: DVec3, top: bool) -> Coordinates {
        let r = if top { self.top_radius } else { self.radius };
        let up = if top { DVec3::NEG_Z } else { DVec3::Z };
        let uv = DVec2::new(0.5 + 0.5 * (p.x / r), 0.5 + 0.5 * (p.dot(up) / r));
        let uv = uv.clamp(DVec2::ZERO, DVec2::ONE);
        Coordinates { uv, dpdu: DVec3::X * (2.0 * r), dpdv: up * (2.0 * r) }
    }

    fn bounding_box(&self) -> Cuboid {
        let (min, max) = self.bounds();
        Cuboid::between(min, max)
    }
}

impl Surface for Cone {
    fn bounds(&self) -> (DVec3, DVec3) {
        let r = self.radius.max(self.top_radius);
        (DVec3::new(-r, 0.0, -r), DVec3::new(r, self.height, r))
    }

    fn ball(&self) -> (DVec3, f64) {
        let half = 0.5 * self.height;
        (DVec3::Y * half, libm::hypot(half, self.radius.max(self.top_radius)))
    }

    fn nearest(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<ShapeHit> {
        if !self.caps {
            return self.nearest_on_side(ray, t_min, t_max);
        }
        let (near, shift) = self.shifted(ray)?;
        let mut span = self.within_side(&near)?.clip(-near.origin.y, -near.dir.y, BOTTOM)?.clip(
            near.origin.y - self.height,
            near.dir.y,
            TOP,
        )?;
        span.enter.t += shift;
        span.exit.t += shift;
        span.not_empty()?.nearest(t_min, t_max)
    }

    fn coordinates(&self, p: DVec3, face: u32) -> Coordinates {
        if face == SIDE { self.side_coordinates(p) } else { self.cap_coordinates(p, face == TOP) }
    }

    fn bare_surface(&self, ray: &Ray, hit: ShapeHit) -> BareSurface {
        self.bare_at(ray.at(hit.t), hit.face)
    }

    fn closed(&self) -> bool {
        self.caps
    }

    fn clearance(&self, p: DVec3) -> f64 {
        let r = libm::hypot(p.x, p.z);
        // Nothing is nearer to both than to one of them.
        let to_caps = p.y.min(self.height - p.y);
        if to_caps > 1e-9 * self.height {
            return to_caps;
        }
        let rim = if p.y < 0.5 * self.height { self.radius } else { self.top_radius };
        rim - r
    }

    fn depth(&self, p: DVec3) -> f64 {
        let slope = (self.top_radius - self.radius) / self.height;
        let to_side = (self.radius + slope * p.y - libm::hypot(p.x, p.z)) * (self.height / self.slant());
        if self.caps { to_side.min(p.y).min(self.height - p.y) } else { 0.0 }
    }

    fn area(&self) -> f64 {
        self.areas().iter().sum()
    }

    fn sample_area(&self, u: [f64; 2]) -> AreaSample {
        let (face, u0) = sampling::pick(&self.areas(), u[0]).map_or((0, u[0]), |c| (c.index as u32, c.u));
        let p = if face == SIDE {
            // The share of the area up to v is quadratic in v; solved without cancellation.
            let (r, widening) = (self.radius, self.top_radius - self.radius);
            let mean = r + self.top_radius;
            let v = u0 * mean / (r + (r * r + u0 * widening * mean).max(0.0).sqrt());
            let (sin, cos) = libm::sincos(TAU * u[1]);
            DVec3::new(cos * (r + v * widening), v * self.height, -sin * (r + v * widening))
        } else {
            let (r, y) = if face == TOP { (self.top_radius, self.height) } else { (self.radius, 0.0) };
            let d = sample_ring(0.0, r, [u0, u[1]]);
            DVec3::new(d.x, y, d.y)
        };
        let at = self.bare_at(p, face);
        let uv = self.coordinates(at.p, face).uv;
        AreaSample { p: at.p, ng: at.ng, uv, pdf: 1.0 / self.area() }
    }

    /// Uniform over the directions to the bounding box, those that miss the cone included.
    fn sample_direction(&self, from: DVec3, u: [f64; 2]) -> Option<DirectionSample> {
        self.bounding_box().sample_direction(from, u)
    }

    fn direction_pdf(&self, from: DVec3, dir: DVec3) -> f64 {
        self.bounding_box().direction_pdf(from, dir)
    }
}
