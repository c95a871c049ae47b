//! The sphere of directions in spherical triangles of equal solid angle.
//!
//! The 20 faces of the icosahedron, halved again and again: the great arc from one corner to the
//! point of the opposite edge that cuts off half of the area. That point, and the uniform map of a
//! square to the triangle, are Arvo's (Stratified Sampling of Spherical Triangles, SIGGRAPH 1995),
//! with the moved corner found by a reflection as Peters does (BRDF Importance Sampling for
//! Polygonal Lights, TOG 40(4), 2021). After n halvings a cell has 4π/(20·2ⁿ) sr exactly.

use super::{OF_A_CELL, sin_cos};
use crate::math::doubles::{Doubles, Wide, Wide3};
use crate::math::lanes::Portable;
use glam::DVec3;
use std::f64::consts::PI;

/// A spherical triangle. Its corners are unit vectors, counterclockwise as seen from outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphericalCell {
    corners: [DVec3; 3],
    solid_angle: f64,
    /// The corners' triple product.
    det: f64,
    /// (a + b)·c and 1 + a·b.
    around: [f64; 2],
}

impl SphericalCell {
    fn new(corners: [DVec3; 3], solid_angle: f64) -> SphericalCell {
        let [a, b, c] = corners;
        // From the edges, which keeps the digits of a small cell.
        let det = a.dot((b - a).cross(c - a));
        SphericalCell { corners, solid_angle, det, around: [(a + b).dot(c), 1.0 + a.dot(b)] }
    }

    /// The 20 faces of the icosahedron, which cover the sphere.
    pub fn icosahedron() -> [SphericalCell; 20] {
        let corners = icosahedron_corners();
        // Corners that share an edge have the dot product 1/√5, others −1/√5 or −1.
        let joined = |i: usize, j: usize| corners[i].dot(corners[j]) > 0.0;
        let mut faces = (0..12).flat_map(|i| (0..i).flat_map(move |j| (0..j).map(move |k| [i, j, k])));
        std::array::from_fn(|_| {
            let [i, j, k] = faces
                .find(|&[i, j, k]| joined(i, j) && joined(j, k) && joined(k, i))
                .expect("an icosahedron has 20 triples of joined corners");
            let [a, b, c] = [corners[i], corners[j], corners[k]];
            let turned = if a.dot(b.cross(c)) > 0.0 { [a, b, c] } else { [a, c, b] };
            SphericalCell::new(turned, 4.0 * PI / 20.0)
        })
    }

    pub fn corners(&self) -> [DVec3; 3] {
        self.corners
    }

    /// Steradians.
    pub fn solid_angle(&self) -> f64 {
        self.solid_angle
    }

    /// Two cells of half the solid angle, divided through the middle of the longest edge's area.
    pub fn halves(&self) -> [SphericalCell; 2] {
        let [a, b, c] = self.corners;
        let longest = [a.dot(b), b.dot(c), c.dot(a)];
        let shortest_cosine = longest[0].min(longest[1]).min(longest[2]);
        // Turned so that the longest edge lies between the first corner and the third.
        let turned = if longest[2] == shortest_cosine {
            *self
        } else if longest[0] == shortest_cosine {
            SphericalCell::new([b, c, a], self.solid_angle)
        } else {
            SphericalCell::new([c, a, b], self.solid_angle)
        };
        let [from, apex, to] = turned.corners;
        let middle = turned.moved_corner(Portable, Wide::splat(Portable, 0.5)).to_vectors()[0].normalize();
        let half = 0.5 * self.solid_angle;
        [SphericalCell::new([from, apex, middle], half), SphericalCell::new([middle, apex, to], half)]
    }

    /// The axis of a cone that holds the cell, and the cosine of its half-angle, below 90°.
    pub fn cone(&self) -> (DVec3, f64) {
        let [a, b, c] = self.corners;
        let axis = (a + b + c).normalize();
        // A cap of less than a half sphere is convex: with the corners it holds all between them.
        (axis, axis.dot(a).min(axis.dot(b)).min(axis.dot(c)))
    }

    /// Normals of the three planes through the centre that bound the cell, pointing inwards; unit length.
    pub fn planes(&self) -> [DVec3; 3] {
        let [a, b, c] = self.corners;
        [a.cross(b - a), b.cross(c - b), c.cross(a - c)].map(DVec3::normalize)
    }

    pub fn contains(&self, dir: DVec3) -> bool {
        self.planes().iter().all(|n| n.dot(dir) >= 0.0)
    }

    /// A direction, uniform over the cell. `u` in [0, 1)².
    pub fn sample(&self, u: [f64; 2]) -> DVec3 {
        let [u, v] = u.map(|u| Wide::splat(Portable, u));
        self.sample_four(Portable, [u, v]).to_vectors()[0]
    }

    /// Four such directions.
    #[inline(always)]
    pub fn sample_four<L: Doubles>(&self, l: L, [u, v]: [Wide<L>; 2]) -> Wide3<L> {
        let (one, two) = (Wide::splat(l, 1.0), Wide::splat(l, 2.0));
        let (half, three_halves) = (Wide::splat(l, 0.5), Wide::splat(l, 1.5));
        let b = Wide3::splat(l, self.corners[1]);
        let moved = self.moved_corner(l, u);
        // A point of the arc from b to the moved corner, uniform in 1 − cosine.
        let chord = moved - b;
        let one_minus_cos = half * chord.length_squared();
        let tangent = chord + b * one_minus_cos;
        let s = v * one_minus_cos;
        // |tangent|² = (1 − cos)(1 + cos).
        let reach = (v * (two - s) / (two - one_minus_cos)).max(Wide::splat(l, 0.0)).sqrt();
        let dir = b * (one - s) + tangent * reach;
        // Of unit length but for rounding, which one of Newton's steps takes off without a root or a division.
        dir * (three_halves - half * dir.length_squared())
    }

    /// The points of the arc from the first corner to the third up to which the triangle with the
    /// second has the share `u` of the solid angle.
    #[inline(always)]
    fn moved_corner<L: Doubles>(&self, l: L, u: Wide<L>) -> Wide3<L> {
        let (a, c) = (Wide3::splat(l, self.corners[0]), Wide3::splat(l, self.corners[2]));
        let (det, along, around) =
            (Wide::splat(l, self.det), Wide::splat(l, self.around[0]), Wide::splat(l, self.around[1]));
        let (sin, cos) = sin_cos(l, Wide::splat(l, 0.5 * self.solid_angle) * u, OF_A_CELL);
        let h = a * (det * cos - along * sin) + c * (around * sin);
        h * (Wide::splat(l, 2.0) * a.dot(h) / h.length_squared()) - a
    }
}

/// (0, ±1, ±φ) and its cyclic permutations, of unit length, φ the golden ratio.
fn icosahedron_corners() -> [DVec3; 12] {
    let phi = 0.5 + 1.25f64.sqrt();
    std::array::from_fn(|i| {
        let one = if i & 1 == 0 { 1.0 } else { -1.0 };
        let golden = if i & 2 == 0 { phi } else { -phi };
        let corner = match i / 4 {
            0 => DVec3::new(0.0, one, golden),
            1 => DVec3::new(one, golden, 0.0),
            _ => DVec3::new(golden, 0.0, one),
        };
        corner.normalize()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::{Counter, Stage};

    fn after(halvings: u32) -> Vec<SphericalCell> {
        let mut cells = SphericalCell::icosahedron().to_vec();
        for _ in 0..halvings {
            cells = cells.iter().flat_map(SphericalCell::halves).collect();
        }
        cells
    }

    /// Van Oosterom & Strackee 1983.
    fn measured(cell: &SphericalCell) -> f64 {
        let [a, b, c] = cell.corners();
        2.0 * libm::atan2(a.dot((b - a).cross(c - a)), 1.0 + a.dot(b) + b.dot(c) + c.dot(a))
    }

    #[test]
    fn cells_have_equal_solid_angles_to_the_last_digits() {
        for halvings in [0, 1, 4, 9] {
            let cells = after(halvings);
            let expected = 4.0 * PI / cells.len() as f64;
            for cell in &cells {
                assert!((measured(cell) / expected - 1.0).abs() < 1e-11, "{halvings}: {}", measured(cell));
                assert!((cell.solid_angle() / expected - 1.0).abs() < 1e-14);
            }
        }
        let mut small = SphericalCell::icosahedron()[7];
        for _ in 0..24 {
            small = small.halves()[1];
        }
        assert!((measured(&small) / small.solid_angle() - 1.0).abs() < 1e-6);
    }

    #[test]
    fn cells_cover_the_sphere_once_and_their_cones_hold_them() {
        let cells = after(4);
        let mut random = Counter::new(3, Stage::Test, 0);
        for _ in 0..20_000 {
            let dir = crate::math::sampling::sphere(random.pair());
            let holding: Vec<&SphericalCell> = cells.iter().filter(|c| c.contains(dir)).collect();
            assert_eq!(holding.len(), 1, "{dir}");
            let (axis, cos) = holding[0].cone();
            assert!(axis.dot(dir) >= cos - 1e-15);
        }
    }

    /// Halving the longest edge keeps every angle above half of the smallest that there was (Rosenberg &
    /// Stenger, SIAM J. Numer. Anal. 12, 1975), here 30° and more: a triangle of 30°, 30° and 120°, the worst
    /// of all such, fills 1/7.26 of the disk through its corners.
    #[test]
    fn cells_stay_compact_when_they_are_halved() {
        for cell in after(12) {
            let (_, cos) = cell.cone();
            let cap = 2.0 * PI * (1.0 - cos);
            assert!(cap < 7.26 * cell.solid_angle(), "{}", cap / cell.solid_angle());
        }
    }

    #[test]
    fn samples_of_a_cell_are_uniform_and_within_it() {
        for halvings in [0, 3, 20] {
            let mut cell = SphericalCell::icosahedron()[3];
            for i in 0..halvings {
                cell = cell.halves()[i % 2];
            }
            // 64 bins of equal solid angle.
            let mut bins = vec![cell];
            for _ in 0..6 {
                bins = bins.iter().flat_map(SphericalCell::halves).collect();
            }
            let mut random = Counter::new(4, Stage::Test, halvings as u64);
            let mut counts = vec![0f64; bins.len()];
            let n = 64_000;
            for _ in 0..n {
                let dir = cell.sample(random.pair());
                assert!((dir.length() - 1.0).abs() < 1e-14);
                assert!(cell.planes().iter().all(|p| p.dot(dir) > -1e-14));
                let bin = bins.iter().position(|b| b.contains(dir)).unwrap_or(0);
                counts[bin] += 1.0;
            }
            let expected = f64::from(n) / bins.len() as f64;
            let chi2: f64 = counts.iter().map(|c| (c - expected).powi(2) / expected).sum();
            // 63 degrees of freedom, p = 1e-3.
            assert!(chi2 < 103.4, "{halvings} halvings: χ² = {chi2}");
        }
    }
}
