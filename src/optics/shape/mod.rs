//! The analytic shapes: intersection, surface coordinates, sampling by area and by direction.
//!
//! All in the shape's own space and in double precision; rays have a direction of any length. A shape
//! that bounds a solid is met as an interval of the ray, so that a line crosses its surface twice or
//! never, at edges and rims too; a line that only touches it misses.
//!
//! Surface coordinates: looked at from the side of `ng`, u grows to the right and v upwards (+y; on
//! horizontal faces v grows towards −z on top and towards +z below), so that ∂p/∂u × ∂p/∂v points
//! along `ng` and pictures are never mirrored.

mod cone;
mod cuboid;
mod disk;
mod planes;
mod polyhedron;
mod quad;
mod solid_angle;
mod span;
mod sphere;

pub use cone::Cone;
pub use cuboid::Cuboid;
pub use disk::Disk;
pub use polyhedron::{Polyhedron, Solid};
pub use quad::Quad;
pub use solid_angle::{DirectionSample, sample_triangle_direction, triangle_direction_pdf};
pub use sphere::Sphere;

use super::{Coordinates, LocalSurface};
use crate::math::{DVec2, DVec3, Ray, robust::gamma};

#[derive(Clone, Debug)]
pub enum Shape {
    Sphere(Sphere),
    Cuboid(Cuboid),
    /// Truncated cones and cylinders.
    Cone(Cone),
    Disk(Disk),
    Quad(Quad),
    Polyhedron(Polyhedron),
}

/// Where a ray meets a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeHit {
    /// In units of the ray's direction.
    pub t: f64,
    /// Which of the shape's faces, numbered as the shape documents.
    pub face: u32,
}

/// A surface point without coordinates; a shape's shading normal is its geometric one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BareSurface {
    pub p: DVec3,
    /// As `LocalSurface::p_error`.
    pub p_error: f64,
    /// As `LocalSurface::ng`.
    pub ng: DVec3,
}

/// A point drawn from a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaSample {
    pub p: DVec3,
    /// As `LocalSurface::ng`.
    pub ng: DVec3,
    pub uv: DVec2,
    /// Per unit area.
    pub pdf: f64,
}

/// What every shape can do; `Shape` documents it.
trait Surface {
    fn bounds(&self) -> (DVec3, DVec3);
    fn ball(&self) -> (DVec3, f64) {
        let (min, max) = self.bounds();
        (0.5 * (min + max), 0.5 * (max - min).length())
    }
    fn nearest(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<ShapeHit>;
    fn bare_surface(&self, ray: &Ray, hit: ShapeHit) -> BareSurface;
    fn coordinates(&self, p: DVec3, face: u32) -> Coordinates;
    fn clearance(&self, p: DVec3) -> f64;
    fn depth(&self, p: DVec3) -> f64;
    fn closed(&self) -> bool;
    fn area(&self) -> f64;
    fn sample_area(&self, u: [f64; 2]) -> AreaSample;
    fn sample_direction(&self, from: DVec3, u: [f64; 2]) -> Option<DirectionSample>;
    fn direction_pdf(&self, from: DVec3, dir: DVec3) -> f64;
}

/// Evaluates an expression for whichever shape it is.
macro_rules! each {
    ($shape:expr, $s:ident => $call:expr) => {
        match $shape {
            Shape::Sphere($s) => $call,
            Shape::Cuboid($s) => $call,
            Shape::Cone($s) => $call,
            Shape::Disk($s) => $call,
            Shape::Quad($s) => $call,
            Shape::Polyhedron($s) => $call,
        }
    };
}

impl Shape {
    /// The least and the greatest corner of a box around the shape.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        each!(self, s => s.bounds())
    }

    /// The centre and radius of a ball around the shape, but for rounding.
    pub fn ball(&self) -> (DVec3, f64) {
        each!(self, s => s.ball())
    }

    /// The nearest hit with `t_min` < t < `t_max`, from either side.
    ///
    /// The two most common shapes are met where this is called, without a call.
    #[inline(always)]
    pub fn nearest(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<ShapeHit> {
        match self {
            Shape::Sphere(sphere) => sphere.nearest(ray, t_min, t_max),
            Shape::Quad(quad) => quad.nearest(ray, t_min, t_max),
            _ => self.nearest_of_others(ray, t_min, t_max),
        }
    }

    #[inline(never)]
    fn nearest_of_others(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<ShapeHit> {
        each!(self, s => s.nearest(ray, t_min, t_max))
    }

    /// The surface at a hit of this ray on this shape.
    pub fn surface(&self, ray: &Ray, hit: ShapeHit) -> LocalSurface {
        let BareSurface { p, p_error, ng } = self.bare_surface(ray, hit);
        let Coordinates { uv, dpdu, dpdv } = self.coordinates(p, hit.face);
        LocalSurface { p, p_error, ng, ns: ng, uv, dpdu, dpdv }
    }

    /// The same without coordinates, which are dear to compute.
    #[inline(always)]
    pub fn bare_surface(&self, ray: &Ray, hit: ShapeHit) -> BareSurface {
        match self {
            Shape::Sphere(sphere) => sphere.bare_surface(ray, hit),
            Shape::Quad(quad) => quad.bare_surface(ray, hit),
            _ => self.bare_surface_of_others(ray, hit),
        }
    }

    #[inline(never)]
    fn bare_surface_of_others(&self, ray: &Ray, hit: ShapeHit) -> BareSurface {
        each!(self, s => s.bare_surface(ray, hit))
    }

    /// The coordinates of a point of one of its faces.
    #[inline]
    pub fn coordinates(&self, p: DVec3, face: u32) -> Coordinates {
        each!(self, s => s.coordinates(p, face))
    }

    /// A lower bound on the distance from a surface point to the end of its face; 0 where nothing is known.
    pub fn clearance(&self, p: DVec3) -> f64 {
        each!(self, s => s.clearance(p))
    }

    /// The distance from a point of a solid to the nearest of the surfaces that bound it; negative outside. Of a
    /// shape that bounds none, 0.
    pub fn depth(&self, p: DVec3) -> f64 {
        each!(self, s => s.depth(p))
    }

    /// Whether the surface bounds a solid.
    pub fn closed(&self) -> bool {
        each!(self, s => s.closed())
    }

    /// In object space.
    pub fn area(&self) -> f64 {
        each!(self, s => s.area())
    }

    /// A point uniform by area. The density is infinite for a shape without area.
    pub fn sample_area(&self, u: [f64; 2]) -> AreaSample {
        each!(self, s => s.sample_area(u))
    }

    /// A direction from `from` towards the shape, with its density in 1/sr (of object space).
    ///
    /// Uniform over the solid angle of sphere, cuboid, quad and polyhedron; of the bounding square of a
    /// disk and the bounding box of a cone, so that some directions miss these two. From inside a closed
    /// shape (or the box of a cone): uniform over all directions. `None` where nothing can be seen.
    pub fn sample_direction(&self, from: DVec3, u: [f64; 2]) -> Option<DirectionSample> {
        each!(self, s => s.sample_direction(from, u))
    }

    /// The density with which [`Shape::sample_direction`] gives the unit vector `dir`.
    pub fn direction_pdf(&self, from: DVec3, dir: DVec3) -> f64 {
        each!(self, s => s.direction_pdf(from, dir))
    }

    /// The `LocalSurface::p_error` of all points of the shape.
    pub fn p_error(&self) -> f64 {
        let (min, max) = self.bounds();
        p_error(min, max)
    }
}

/// The error bound of a point that has been put onto a shape that fills these bounds. A direction that
/// leaves along the surface may be tilted into it by rounding, by angles of a few ε; starting this far
/// above it does not come down within the shape's extent.
#[inline]
fn p_error(min: DVec3, max: DVec3) -> f64 {
    // Sums of the coordinates' sizes bound the lengths, without square roots.
    gamma(16) * (min.abs().max(max.abs()).element_sum() + (max - min).element_sum())
}

#[cfg(test)]
mod tests;
