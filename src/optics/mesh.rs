//! A triangle mesh, and what it needs before it is drawn.

mod facet;

pub use facet::Facet;

use crate::math::{DVec3, Vec2, Vec3};

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

#[cfg(test)]
mod tests;
