//! The surface of a triangle mesh: points, normals and coordinates from barycentrics, and what a mesh
//! needs before it is drawn.
//!
//! Vertices are single precision and exact; everything about a point is computed from them in double
//! precision. Shadow rays on smooth meshes: Hanika, Hacking the Shadow Terminator, Ray Tracing Gems
//! II, ch. 4, 2021.

use super::LocalSurface;
use crate::math::robust::gamma_f32;
use crate::math::{DVec2, DVec3, Vec2, Vec3};

/// Triangles that share vertices. All indices are within bounds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    pub positions: Vec<Vec3>,
    /// One a position, of any length; zero or not finite where there is none. Empty for a flat mesh.
    pub normals: Vec<Vec3>,
    /// One a position. Empty for none: the coordinates are then the second and third barycentrics.
    pub uvs: Vec<Vec2>,
    /// Counter-clockwise as seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// The part each triangle belongs to. Empty if all belong to part 0.
    pub parts: Vec<u32>,
}

impl TriangleMesh {
    pub fn memory_bytes(&self) -> usize {
        size_of_val(self.positions.as_slice())
            + size_of_val(self.normals.as_slice())
            + size_of_val(self.uvs.as_slice())
            + size_of_val(self.triangles.as_slice())
            + size_of_val(self.parts.as_slice())
    }

    /// The corners of a triangle.
    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.triangles[triangle as usize].map(|v| self.positions[v as usize].as_dvec3())
    }

    pub fn part(&self, triangle: u32) -> u32 {
        self.parts.get(triangle as usize).copied().unwrap_or(0)
    }

    /// The surface where a ray has met `triangle`, from its barycentric coordinates `b` there, of which
    /// the second and third are used, so that the point is in the triangle's plane.
    pub fn surface(&self, triangle: u32, b: [f32; 3]) -> LocalSurface {
        let corners = self.corners(triangle);
        let [b1, b2] = [f64::from(b[1]), f64::from(b[2])];
        let (e1, e2) = (corners[1] - corners[0], corners[2] - corners[0]);
        let p = corners[0] + e1 * b1 + e2 * b2;
        let ng = e1.cross(e2).try_normalize().unwrap_or(DVec3::Y);
        let (uv, dpdu, dpdv) = self.coordinates(triangle, [e1, e2], [b1, b2]);
        let p_error = traversal_error(&corners, p);
        LocalSurface { p, p_error, ng, ns: self.shading_normal(triangle, [b1, b2], ng), uv, dpdu, dpdv }
    }

    /// The interpolated normal, in the hemisphere of `ng`; `ng` where the mesh has none to interpolate.
    fn shading_normal(&self, triangle: u32, [b1, b2]: [f64; 2], ng: DVec3) -> DVec3 {
        let [n0, n1, n2] = self.corner_normals(triangle, ng);
        let n = n0 * (1.0 - b1 - b2) + n1 * b1 + n2 * b2;
        match n.try_normalize() {
            Some(ns) if ns.dot(ng) > 0.0 => ns,
            Some(ns) if ns.dot(ng) < 0.0 => -ns,
            _ => ng,
        }
    }

    /// The unit normals of the three vertices; `ng` for those without.
    fn corner_normals(&self, triangle: u32, ng: DVec3) -> [DVec3; 3] {
        self.triangles[triangle as usize].map(|v| {
            let normal = self.normals.get(v as usize).and_then(|n| n.as_dvec3().try_normalize());
            normal.filter(|n| n.is_finite()).unwrap_or(ng)
        })
    }

    /// uv, ∂p/∂u and ∂p/∂v. Triangles that the map squeezes to a line or a point have no derivatives.
    fn coordinates(&self, triangle: u32, [e1, e2]: [DVec3; 2], [b1, b2]: [f64; 2]) -> (DVec2, DVec3, DVec3) {
        if self.uvs.is_empty() {
            return (DVec2::new(b1, b2), e1, e2);
        }
        let [a, b, c] = self.triangles[triangle as usize].map(|v| self.uvs[v as usize].as_dvec2());
        let (f1, f2) = (b - a, c - a);
        let uv = a + f1 * b1 + f2 * b2;
        // Exact: differences and products of single-precision values of like size.
        let det = f1.perp_dot(f2);
        let dpdu = (e1 * f2.y - e2 * f1.y) / det;
        let dpdv = (e2 * f1.x - e1 * f2.x) / det;
        if dpdu.is_finite() && dpdv.is_finite() { (uv, dpdu, dpdv) } else { (uv, DVec3::ZERO, DVec3::ZERO) }
    }

    /// Where shadow rays from a point of `triangle` start: lifted, where the vertex normals spread,
    /// to the curved surface that they describe, so that the flat triangles don't shadow themselves.
    /// `front` tells on which side of `ng` the rays go. Where the surface curves the other way, where
    /// all vertex normals are tilted alike, and on flat meshes, this is the point itself.
    pub fn shadow_terminator_point(&self, triangle: u32, b: [f32; 3], front: bool) -> DVec3 {
        let corners = self.corners(triangle);
        let [b1, b2] = [f64::from(b[1]), f64::from(b[2])];
        let (e1, e2) = (corners[1] - corners[0], corners[2] - corners[0]);
        let p = corners[0] + e1 * b1 + e2 * b2;
        let Some(ng) = e1.cross(e2).try_normalize() else { return p };
        if self.normals.is_empty() {
            return p;
        }
        let side = if front { ng } else { -ng };
        let normals = self.corner_normals(triangle, ng).map(|n| if n.dot(side) < 0.0 { -n } else { n });
        // What all three are tilted by is no curvature.
        let tilt = (normals[0] + normals[1] + normals[2]) / 3.0 - side;
        let weights = [1.0 - b1 - b2, b1, b2];
        let lift: DVec3 = (0..3)
            .map(|i| {
                let n = normals[i] - tilt;
                // Up to the plane tangent at the vertex, if the point is below it.
                n * (weights[i] * (corners[i] - p).dot(n).max(0.0))
            })
            .sum();
        if lift.length() > traversal_error(&corners, p) { p + lift } else { p }
    }

    /// Normals of the vertices: those of their triangles, weighted by the triangles' angles there
    /// (Thürmer & Wüthrich 1998). Zero for vertices of degenerate triangles only.
    pub fn angle_weighted_normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
        let mut sums = vec![DVec3::ZERO; positions.len()];
        for triangle in triangles {
            let corners = triangle.map(|v| positions[v as usize].as_dvec3());
            let Some(n) = (corners[1] - corners[0]).cross(corners[2] - corners[0]).try_normalize() else {
                continue;
            };
            for i in 0..3 {
                let (e, f) = (corners[(i + 1) % 3] - corners[i], corners[(i + 2) % 3] - corners[i]);
                sums[triangle[i] as usize] += n * libm::atan2(e.cross(f).length(), e.dot(f));
            }
        }
        sums.into_iter().map(|n| n.try_normalize().unwrap_or(DVec3::ZERO).as_vec3()).collect()
    }

    /// Edges that are used by other than two triangles, vertices at one place counting as one: 0 for
    /// a closed mesh. Degenerate triangles are left out.
    pub fn boundary_edges(&self) -> usize {
        let welded = self.welded();
        let mut edges: Vec<[u32; 2]> = Vec::with_capacity(3 * self.triangles.len());
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|v| welded[v as usize]);
            if a != b && b != c && c != a {
                edges.extend([[a.min(b), a.max(b)], [b.min(c), b.max(c)], [c.min(a), c.max(a)]]);
            }
        }
        edges.sort_unstable();
        edges.chunk_by(|a, b| a == b).filter(|same| same.len() != 2).count()
    }

    /// For each vertex the first one that is at the same place.
    fn welded(&self) -> Vec<u32> {
        // Adding 0 makes −0 the same place as +0.
        let key = |v: u32| (self.positions[v as usize] + Vec3::ZERO).to_array().map(f32::to_bits);
        let mut order: Vec<u32> = (0..self.positions.len() as u32).collect();
        order.sort_unstable_by_key(|&v| (key(v), v));
        let mut welded = vec![0; order.len()];
        for same in order.chunk_by(|&a, &b| key(a) == key(b)) {
            same.iter().for_each(|&v| welded[v as usize] = same[0]);
        }
        welded
    }
}

/// Aspect up to which the bound below grows. Longer triangles would be left by offsets as large as they
/// are high; what is met again beyond is rarer than one grazing ray in 1e5.
const LONGEST: f64 = 64.0;

/// How far off its plane a triangle may be met by a single-precision test that moves the vertices to
/// the ray's origin, itself rounded to single precision, and shears them along the ray (Woop, Benthin,
/// Wald, JCGT 2(1), 2013): the origin's rounding, and those of the moved vertices, the edge functions
/// and their sum, all relative to the vertices' distance from the point, and the more so the longer the
/// triangle is for its height.
fn traversal_error(corners: &[DVec3; 3], p: DVec3) -> f64 {
    let extent = corners.iter().map(|v| v.distance(p)).fold(0.0, f64::max);
    let area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).length();
    let aspect = (extent * extent / area).clamp(1.0, LONGEST);
    gamma_f32(2) * p.length() + gamma_f32(8) * extent * aspect
}

#[cfg(test)]
mod tests;
