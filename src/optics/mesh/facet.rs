//! A point of a triangle: its surface, and where its shadow rays start.
//!
//! Vertices are single precision and exact; everything about a point is computed from them in double
//! precision. Shadow rays on smooth meshes: Hanika, Hacking the Shadow Terminator, Ray Tracing Gems
//! II, ch. 4, 2021.

use super::TriangleMesh;
use crate::math::robust::gamma_f32;
use crate::math::{DVec2, DVec3};
use crate::optics::{Coordinates, LocalSurface};
use rayon::prelude::*;

/// A point of a triangle, and what both its surface and its shadow rays are computed from.
pub struct Facet<'a> {
    mesh: &'a TriangleMesh,
    triangle: u32,
    corners: [DVec3; 3],
    /// The edges from the first corner.
    edges: [DVec3; 2],
    /// The second and third barycentric.
    b: [f64; 2],
    p: DVec3,
    p_error: f64,
    /// Unit normal; +y for a triangle without an area.
    ng: DVec3,
    /// The unit normals of the vertices; `ng` for those without.
    normals: [DVec3; 3],
}

impl TriangleMesh {
    /// Where a ray has met `triangle`, from its barycentric coordinates `b` there, of which the second and third
    /// are used, so that the point is in the triangle's plane.
    #[inline]
    pub fn facet(&self, triangle: u32, b: [f32; 3]) -> Facet<'_> {
        let mut facet = self.flat_facet(triangle, b);
        if !self.normals.is_empty() {
            facet.normals = self.corner_normals(triangle, facet.ng);
        }
        facet
    }

    /// The same as if the vertices had no normals.
    #[inline]
    pub fn flat_facet(&self, triangle: u32, b: [f32; 3]) -> Facet<'_> {
        let corners = self.corners(triangle);
        let b = [f64::from(b[1]), f64::from(b[2])];
        let edges = [corners[1] - corners[0], corners[2] - corners[0]];
        let p = corners[0] + edges[0] * b[0] + edges[1] * b[1];
        let normal = edges[0].cross(edges[1]);
        let area = normal.length();
        let reciprocal = 1.0 / area;
        let sound = reciprocal.is_finite() && reciprocal > 0.0;
        let ng = if sound { normal * reciprocal } else { DVec3::Y };
        let p_error = traversal_error(&corners, area, p);
        Facet { mesh: self, triangle, corners, edges, b, p, p_error, ng, normals: [ng; 3] }
    }

    /// An upper bound of the `LocalSurface::p_error` of all its points.
    pub fn most_error(&self) -> f64 {
        let of = |triangle: u32| {
            let corners = self.corners(triangle);
            let area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).length();
            // Both of its terms are largest at a corner.
            corners.iter().map(|&p| traversal_error(&corners, area, p)).fold(0.0, f64::max)
        };
        (0..self.triangles.len() as u32)
            .into_par_iter()
            .with_min_len(1024)
            .map(of)
            .filter(|error| error.is_finite())
            .reduce(|| 0.0, f64::max)
    }

    /// The unit normals of the three vertices, as exact as single precision has them; `ng` for those without.
    #[inline]
    fn corner_normals(&self, triangle: u32, ng: DVec3) -> [DVec3; 3] {
        let [a, b, c] = self.triangles[triangle as usize];
        let normal = |v: u32| {
            let n = self.normals[v as usize].as_dvec3();
            // Nearly all are unit vectors as they are.
            if (n.length_squared() - 1.0).abs() < 1e-6 { n } else { unit_or(n, ng) }
        };
        [normal(a), normal(b), normal(c)]
    }
}

#[cold]
fn unit_or(n: DVec3, other: DVec3) -> DVec3 {
    n.try_normalize().filter(|n| n.is_finite()).unwrap_or(other)
}

impl Facet<'_> {
    /// Of the triangle.
    pub fn ng(&self) -> DVec3 {
        self.ng
    }

    /// Where it is, and how far off that it may be met.
    pub fn place(&self) -> (DVec3, f64) {
        (self.p, self.p_error)
    }

    #[inline]
    pub fn surface(&self) -> LocalSurface {
        let Coordinates { uv, dpdu, dpdv } = self.coordinates();
        let Facet { p, p_error, ng, .. } = *self;
        LocalSurface { p, p_error, ng, ns: self.shading_normal(), uv, dpdu, dpdv }
    }

    /// The interpolated normal, in the hemisphere of `ng`; `ng` where the mesh has none to interpolate.
    #[inline]
    pub fn shading_normal(&self) -> DVec3 {
        if self.mesh.normals.is_empty() {
            return self.ng;
        }
        let ([n0, n1, n2], [b1, b2]) = (self.normals, self.b);
        let n = n0 * (1.0 - b1 - b2) + n1 * b1 + n2 * b2;
        match n.try_normalize() {
            Some(ns) if ns.dot(self.ng) > 0.0 => ns,
            Some(ns) if ns.dot(self.ng) < 0.0 => -ns,
            _ => self.ng,
        }
    }

    /// Triangles that the map squeezes to a line or a point have no derivatives.
    pub fn coordinates(&self) -> Coordinates {
        let ([e1, e2], [b1, b2]) = (self.edges, self.b);
        if self.mesh.uvs.is_empty() {
            return Coordinates { uv: DVec2::new(b1, b2), dpdu: e1, dpdv: e2 };
        }
        let [a, b, c] =
            self.mesh.triangles[self.triangle as usize].map(|v| self.mesh.uvs[v as usize].as_dvec2());
        let (f1, f2) = (b - a, c - a);
        let uv = a + f1 * b1 + f2 * b2;
        // Exact: differences and products of single-precision values of like size.
        let det = f1.perp_dot(f2);
        let dpdu = (e1 * f2.y - e2 * f1.y) / det;
        let dpdv = (e2 * f1.x - e1 * f2.x) / det;
        let sound = dpdu.is_finite() && dpdv.is_finite();
        let (dpdu, dpdv) = if sound { (dpdu, dpdv) } else { (DVec3::ZERO, DVec3::ZERO) };
        Coordinates { uv, dpdu, dpdv }
    }

    /// Where shadow rays from the point start: lifted, where the vertex normals spread, to the curved
    /// surface that they describe, so that the flat triangles don't shadow themselves. `front` tells on
    /// which side of `ng` the rays go. Where the surface curves the other way, where all vertex normals
    /// are tilted alike, and on flat meshes, this is the point itself.
    #[inline]
    pub fn shadow_terminator_point(&self, front: bool) -> DVec3 {
        let p = self.p;
        if self.mesh.normals.is_empty() {
            return p;
        }
        let side = if front { self.ng } else { -self.ng };
        let normals = self.normals.map(|n| if n.dot(side) < 0.0 { -n } else { n });
        // What all three are tilted by is no curvature.
        let tilt = (normals[0] + normals[1] + normals[2]) * (1.0 / 3.0) - side;
        let weights = [1.0 - self.b[0] - self.b[1], self.b[0], self.b[1]];
        let mut lift = DVec3::ZERO;
        for i in 0..3 {
            let n = normals[i] - tilt;
            // Up to the plane tangent at the vertex, if the point is below it.
            lift += n * (ONTO_SURFACE * weights[i] * (self.corners[i] - p).dot(n).max(0.0));
        }
        if lift.length_squared() > self.p_error * self.p_error { p + lift } else { p }
    }
}

/// Of the way to the tangent planes: a surface of even curvature lies half as high above its chords as their mean.
const ONTO_SURFACE: f64 = 0.5;

/// Aspect up to which the bound below grows. Longer triangles would be left by offsets as large as they
/// are high; what is met again beyond is rarer than one grazing ray in 1e5.
const LONGEST: f64 = 64.0;

/// How far off its plane a triangle may be met by a single-precision test that moves the vertices to
/// the ray's origin, itself rounded to single precision, and shears them along the ray (Woop, Benthin,
/// Wald, JCGT 2(1), 2013): the origin's rounding, and those of the moved vertices, the edge functions
/// and their sum, all relative to the vertices' distance from the point, and the more so the longer the
/// triangle is for its height. `area` is that of the parallelogram.
#[inline]
fn traversal_error(corners: &[DVec3; 3], area: f64, p: DVec3) -> f64 {
    let extent2 = corners.iter().map(|v| v.distance_squared(p)).fold(0.0, f64::max);
    let aspect = (extent2 / area).clamp(1.0, LONGEST);
    gamma_f32(2) * p.length() + gamma_f32(8) * extent2.sqrt() * aspect
}
