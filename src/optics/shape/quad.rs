//! The rectangle in the plane y = 0, normal +y. u grows along +x, v along −z, both over [0, 1].

use super::solid_angle::Rectangle;
use super::{AreaSample, BareSurface, DirectionSample, ShapeHit, Surface};
use crate::math::{DVec2, DVec3, Ray};
use crate::optics::Coordinates;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quad {
    /// Half of the extents along x and z.
    half: DVec2,
    p_error: f64,
}

impl Quad {
    /// Extents along x and z.
    pub fn new(size: [f64; 2]) -> Quad {
        let half = 0.5 * DVec2::from(size);
        Quad { half, p_error: plane_error(half) }
    }

    fn seen_from(&self, from: DVec3) -> Option<Rectangle> {
        let corner = DVec3::new(-self.half.x, 0.0, self.half.y);
        Rectangle::new(from, corner, DVec3::X * (2.0 * self.half.x), DVec3::Z * (-2.0 * self.half.y))
    }
}

/// Where the ray crosses the plane y = 0; `None` if it is parallel to it or does not within the bounds.
#[inline]
pub(super) fn plane_crossing(ray: &Ray, t_min: f64, t_max: f64) -> Option<(f64, DVec3)> {
    let t = -ray.origin.y / ray.dir.y;
    (ray.dir.y != 0.0 && t_min < t && t < t_max).then(|| (t, ray.at(t)))
}

/// The `p_error` of a plane figure of this half-extent.
pub(super) fn plane_error(half: DVec2) -> f64 {
    let corner = DVec3::new(half.x, 0.0, half.y);
    super::p_error(-corner, corner)
}

/// The surface point of a plane figure that fills the square or rectangle of this half-extent.
#[inline]
pub(super) fn plane_surface(p: DVec3, half: DVec2, p_error: f64) -> BareSurface {
    let corner = DVec3::new(half.x, 0.0, half.y);
    let p = DVec3::new(p.x, 0.0, p.z).clamp(-corner, corner);
    BareSurface { p, p_error, ng: DVec3::Y }
}

#[inline]
pub(super) fn plane_coordinates(p: DVec3, half: DVec2) -> Coordinates {
    let (dpdu, dpdv) = (DVec3::X * (2.0 * half.x), DVec3::Z * (-2.0 * half.y));
    Coordinates { uv: plane_uv(p, half), dpdu, dpdv }
}

#[inline]
pub(super) fn plane_uv(p: DVec3, half: DVec2) -> DVec2 {
    DVec2::new(0.5 + 0.5 * (p.x / half.x), 0.5 - 0.5 * (p.z / half.y))
}

impl Surface for Quad {
    fn bounds(&self) -> (DVec3, DVec3) {
        let corner = DVec3::new(self.half.x, 0.0, self.half.y);
        (-corner, corner)
    }

    #[inline(always)]
    fn nearest(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<ShapeHit> {
        let (t, p) = plane_crossing(ray, t_min, t_max)?;
        (p.x.abs() <= self.half.x && p.z.abs() <= self.half.y).then_some(ShapeHit { t, face: 0 })
    }

    #[inline]
    fn bare_surface(&self, ray: &Ray, hit: ShapeHit) -> BareSurface {
        plane_surface(ray.at(hit.t), self.half, self.p_error)
    }

    #[inline]
    fn coordinates(&self, p: DVec3, _: u32) -> Coordinates {
        plane_coordinates(p, self.half)
    }

    fn closed(&self) -> bool {
        false
    }

    fn clearance(&self, p: DVec3) -> f64 {
        (self.half.x - p.x.abs()).min(self.half.y - p.z.abs())
    }

    fn depth(&self, _: DVec3) -> f64 {
        0.0
    }

    fn area(&self) -> f64 {
        4.0 * self.half.x * self.half.y
    }

    fn sample_area(&self, u: [f64; 2]) -> AreaSample {
        let p = DVec3::new((2.0 * u[0] - 1.0) * self.half.x, 0.0, (1.0 - 2.0 * u[1]) * self.half.y);
        AreaSample { p, ng: DVec3::Y, uv: DVec2::from(u), pdf: 1.0 / self.area() }
    }

    fn sample_direction(&self, from: DVec3, u: [f64; 2]) -> Option<DirectionSample> {
        self.seen_from(from)?.sample(u)
    }

    fn direction_pdf(&self, from: DVec3, dir: DVec3) -> f64 {
        self.seen_from(from).map_or(0.0, |rectangle| rectangle.pdf(dir))
    }
}
