//! Where rays start that go on inside of a transmissive solid.
//!
//! A ray that leaves a surface starts a little off it, along the normal of the face that was met. At an edge,
//! a rim or a corner that is not enough: the other face there may lie behind such a start, by its rounding, and
//! a ray inside of glass that looks out through it would leave the glass without meeting its surface. Near
//! edges the start is therefore moved away from all faces, into the solid.

use super::surface::Surface;
use super::world::{Geometry, World};
use crate::math::{DVec3, Ray};
use crate::optics::{Shape, TriangleMesh};

/// Starts lie so many times the error of a point from the faces that meet in an edge.
const AWAY: f64 = 4.0;

impl World {
    /// As [`Ray::leaving`] from a surface point known to within `tolerance` metres; where the ray goes on inside
    /// of a transmissive solid, from a point that is inside of all of its faces.
    #[inline]
    pub fn leaving(&self, surface: &Surface, tolerance: f64, dir: DVec3) -> Ray {
        let ray = Ray::leaving(surface.p, tolerance, surface.ng, dir);
        let inwards = dir.dot(surface.ng) < 0.0 && self.instances[surface.instance as usize].rank != 0;
        if inwards { Ray { origin: self.start_within(surface, tolerance, ray.origin), dir } } else { ray }
    }

    #[inline(never)]
    fn start_within(&self, surface: &Surface, tolerance: f64, start: DVec3) -> DVec3 {
        let placement = &self.instances[surface.instance as usize].placement;
        let by = AWAY * tolerance / placement.least_stretch();
        match self.geometry(surface.instance) {
            Geometry::Shape(shape) => match within(shape, surface.local, by) {
                Some(local) => placement.point(local),
                None => start,
            },
            Geometry::Mesh(mesh) => match off_edges(&mesh.surface, surface.primitive, surface.local, by) {
                Some(shift) => start + placement.vector(shift),
                None => start,
            },
        }
    }
}

/// A point of a solid at least `by` from all its faces, near the surface point `p`. `None` where no edge is that
/// near. Depth below the surface of a convex solid is concave: on the way to its middle it grows as on a
/// straight line at least.
fn within(shape: &Shape, p: DVec3, by: f64) -> Option<DVec3> {
    if !shape.closed() || shape.clearance(p) > by {
        return None;
    }
    let (middle, _) = shape.ball();
    let (here, deepest) = (shape.depth(p), shape.depth(middle));
    let share = if deepest > by { (by - here) / (deepest - here) } else { 1.0 };
    Some(p + (middle - p) * share.clamp(0.0, 1.0))
}

/// The way to a point of the triangle at least `by` from its edges. `None` where `p` is that far from them.
fn off_edges(mesh: &TriangleMesh, triangle: u32, p: DVec3, by: f64) -> Option<DVec3> {
    let corners = mesh.corners(triangle);
    let n = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    let mut share = 0.0f64;
    for i in 0..3 {
        let (a, edge) = (corners[i], corners[(i + 1) % 3] - corners[i]);
        let across = n.cross(edge).normalize_or_zero();
        let (here, deepest) = (across.dot(p - a), across.dot(middle - a));
        if here < by {
            share = share.max(if deepest > by { (by - here) / (deepest - here) } else { 1.0 });
        }
    }
    (share > 0.0).then(|| (middle - p) * share.min(1.0))
}
