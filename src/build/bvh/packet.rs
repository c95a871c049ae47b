//! Eight triangles tested against a ray at once, without cracks: Woop, Benthin & Wald 2013,
//! "Watertight Ray/Triangle Intersection" (JCGT 2(1)).
//!
//! The vertices are sheared so that the ray is the z axis; the signs of the edge functions at the
//! origin of the plane then decide. A difference of two rounded products has the sign of the exact
//! one unless it rounds to 0; such lanes, and lanes whose barycentrics do not lead back to the ray
//! (triangles seen edge-on), are tested in double precision, where the products are exact.

use super::ray::{BoxRay, PROJECTION_ERROR};
use crate::math::lanes::{Array, Lanes};
use crate::math::{Aabb, Vec3};

/// The memory of a packet: row 3·i + k is coordinate k of the triangles' vertices i, and the last
/// row is the bits of their indices. Lanes without a triangle hold NaN, which no test passes.
pub type Rows = [Array; 10];

const IDS: usize = 9;

/// Eight lanes without a triangle.
pub const EMPTY: Rows = [[f32::NAN; 8]; 10];

/// Fills a lane.
pub fn set(rows: &mut Rows, lane: usize, triangle: u32, corners: [Vec3; 3]) {
    for (i, corner) in corners.iter().enumerate() {
        for k in 0..3 {
            rows[3 * i + k][lane] = corner[k];
        }
    }
    rows[IDS][lane] = f32::from_bits(triangle);
}

/// Eight triangles.
#[derive(Clone, Copy, Debug)]
pub struct Packet<'a>(pub &'a Rows);

/// A hit on a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// Distance in units of the ray's direction.
    pub t: f32,
    /// Index in the list that the tree was built from.
    pub triangle: u32,
    /// Barycentric coordinates of vertices 0, 1, 2; none is negative and they sum to 1 (rounded).
    pub b: [f32; 3],
}

/// The triangle test's constants for one ray and one mesh.
#[derive(Clone, Copy)]
pub(super) struct Shear<L: Lanes> {
    axes: [usize; 3],
    origin: [L::F; 3],
    shear: [L::F; 2],
    scale: f32,
    slack: L::F,
    origin1: [f32; 3],
    shear1: [f32; 2],
}

impl<L: Lanes> Shear<L> {
    #[inline(always)]
    pub fn new(lanes: L, ray: &BoxRay, bounds: &Aabb) -> Self {
        let ([kx, ky, kz], [sx, sy, scale]) = ray.shear();
        assert!(kx < 3 && ky < 3 && kz < 3);
        let origin1 = [ray.origin[kx], ray.origin[ky], ray.origin[kz]];
        Shear {
            axes: [kx, ky, kz],
            origin: [lanes.splat(origin1[0]), lanes.splat(origin1[1]), lanes.splat(origin1[2])],
            shear: [lanes.splat(sx), lanes.splat(sy)],
            scale,
            slack: lanes.splat(PROJECTION_ERROR * ray.reach(bounds)),
            origin1,
            shear1: [sx, sy],
        }
    }

    /// One vertex of each triangle in the sheared space; its z is not scaled yet.
    #[inline(always)]
    fn project(&self, l: L, rows: &Rows, vertex: usize) -> [L::F; 3] {
        let [kx, ky, kz] = self.axes;
        // The masks change nothing; they show that the rows are in range.
        let row = 3 * vertex;
        let z = l.sub(l.load(&rows[row + (kz & 3)]), self.origin[2]);
        let x = l.sub(l.sub(l.load(&rows[row + (kx & 3)]), self.origin[0]), l.mul(self.shear[0], z));
        let y = l.sub(l.sub(l.load(&rows[row + (ky & 3)]), self.origin[1]), l.mul(self.shear[1], z));
        [x, y, z]
    }
}

/// The edge function of the edge from `q` to `p` at the ray.
#[inline(always)]
fn edge<L: Lanes>(l: L, p: &[L::F; 3], q: &[L::F; 3]) -> L::F {
    l.sub(l.mul(p[0], q[1]), l.mul(p[1], q[0]))
}

impl<'a> Packet<'a> {
    #[inline(always)]
    fn triangle(self, lane: usize) -> u32 {
        self.0[IDS][lane].to_bits()
    }

    /// The triangles that are there: index and corners.
    pub fn filled(self) -> impl Iterator<Item = (u32, [Vec3; 3])> + 'a {
        let corner =
            move |lane: usize, i: usize| Vec3::from_array([0, 1, 2].map(|k| self.0[3 * i + k][lane]));
        (0..8)
            .map(move |lane| (self.triangle(lane), [0, 1, 2].map(|i| corner(lane, i))))
            .filter(|(_, v)| !v[0].x.is_nan())
    }

    /// Replaces `best` by the nearest hit with 0 < t < `best.t`, or t = `best.t` on a smaller
    /// triangle index. Returns whether there was one.
    #[inline(always)]
    pub(super) fn nearest<L: Lanes>(self, lanes: L, ray: &Shear<L>, best: &mut TriangleHit) -> bool {
        let Some(c) = self.candidates(lanes, ray) else { return false };
        let inverse = lanes.div(lanes.splat(1.0), c.det);
        let t = lanes.mul(lanes.mul(c.t_det, inverse), lanes.splat(ray.scale));
        let mut mask = c.sure & lanes.lt(lanes.splat(0.0), t) & lanes.le(t, lanes.splat(best.t));
        let mut found = false;
        if mask != 0 {
            let t = lanes.store(t);
            let [u, v, w] = c.edges;
            let b = [
                lanes.store(lanes.mul(u, inverse)),
                lanes.store(lanes.mul(v, inverse)),
                lanes.store(lanes.mul(w, inverse)),
            ];
            while mask != 0 {
                let lane = mask.trailing_zeros() as usize & 7;
                mask &= mask - 1;
                let b = [b[0][lane], b[1][lane], b[2][lane]];
                found |= closer(best, TriangleHit { t: t[lane], triangle: self.triangle(lane), b });
            }
        }
        if c.unsure != 0 {
            found |= self.nearest_exact(c.unsure, ray, best);
        }
        found
    }

    /// Whether any triangle is hit with 0 < t < `t_max`.
    #[inline(always)]
    pub(super) fn any<L: Lanes>(self, lanes: L, ray: &Shear<L>, t_max: f32) -> bool {
        let Some(c) = self.candidates(lanes, ray) else { return false };
        let inverse = lanes.div(lanes.splat(1.0), c.det);
        let t = lanes.mul(lanes.mul(c.t_det, inverse), lanes.splat(ray.scale));
        let mask = c.sure & lanes.lt(lanes.splat(0.0), t) & lanes.lt(t, lanes.splat(t_max));
        let none = TriangleHit { t: t_max, triangle: 0, b: [0.0; 3] };
        mask != 0 || (c.unsure != 0 && self.nearest_exact(c.unsure, ray, &mut { none }))
    }

    /// The triangles around the ray, `None` if there are none.
    #[inline(always)]
    fn candidates<L: Lanes>(self, l: L, ray: &Shear<L>) -> Option<Candidates<L>> {
        let (a, b, c) = (ray.project(l, self.0, 0), ray.project(l, self.0, 1), ray.project(l, self.0, 2));
        let (u, v, w) = (edge(l, &c, &b), edge(l, &a, &c), edge(l, &b, &a));
        let zero = l.splat(0.0);
        let (least, most) = (l.min(l.min(u, v), w), l.max(l.max(u, v), w));
        let around = l.le(zero, least) | l.le(most, zero);
        if around == 0 {
            return None;
        }
        let det = l.add(l.add(u, v), w);
        let [x, y, t_det] = [
            l.add(l.add(l.mul(u, a[0]), l.mul(v, b[0])), l.mul(w, c[0])),
            l.add(l.add(l.mul(u, a[1]), l.mul(v, b[1])), l.mul(w, c[1])),
            l.add(l.add(l.mul(u, a[2]), l.mul(v, b[2])), l.mul(w, c[2])),
        ];
        let tolerance = l.mul(ray.slack, l.abs(det));
        let back = l.le(l.abs(x), tolerance) & l.le(l.abs(y), tolerance);
        let on_edge = l.eq(u, zero) | l.eq(v, zero) | l.eq(w, zero);
        let sure = around & back & !on_edge;
        Some(Candidates { edges: [u, v, w], det, t_det, sure, unsure: around & !sure })
    }

    #[cold]
    #[inline(never)]
    fn nearest_exact<L: Lanes>(self, mask: u32, ray: &Shear<L>, best: &mut TriangleHit) -> bool {
        let mut found = false;
        for lane in (0..8).filter(|lane| mask >> lane & 1 == 1) {
            if let Some(hit) = self.exact(lane, ray) {
                found |= closer(best, hit);
            }
        }
        found
    }

    /// The test of one triangle, from the same projected vertices, in double precision: products
    /// of two singles are exact, so signs are, and each edge function has one rounding.
    fn exact<L: Lanes>(self, lane: usize, ray: &Shear<L>) -> Option<TriangleHit> {
        let [kx, ky, kz] = ray.axes;
        let [a, b, c] = [0, 1, 2].map(|i| {
            let v = [kx, ky, kz].map(|k| self.0[3 * i + k][lane]);
            let z = v[2] - ray.origin1[2];
            let x = (v[0] - ray.origin1[0]) - ray.shear1[0] * z;
            let y = (v[1] - ray.origin1[1]) - ray.shear1[1] * z;
            [x, y, z].map(f64::from)
        });
        let edge = |p: &[f64; 3], q: &[f64; 3]| p[0] * q[1] - p[1] * q[0];
        let (u, v, w) = (edge(&c, &b), edge(&a, &c), edge(&b, &a));
        let mixed = (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0);
        let det = u + v + w;
        if mixed || det == 0.0 {
            return None;
        }
        let t = (u * a[2] + v * b[2] + w * c[2]) / det * f64::from(ray.scale);
        let hit = TriangleHit {
            t: t as f32,
            triangle: self.triangle(lane),
            b: [u / det, v / det, w / det].map(|b| b as f32),
        };
        (hit.t > 0.0).then_some(hit)
    }
}

struct Candidates<L: Lanes> {
    edges: [L::F; 3],
    det: L::F,
    /// Distance times determinant over the shear's scale.
    t_det: L::F,
    sure: u32,
    unsure: u32,
}

/// Takes over `hit` if it is nearer, or as near with a smaller index.
#[inline(always)]
fn closer(best: &mut TriangleHit, hit: TriangleHit) -> bool {
    let is = hit.t < best.t || (hit.t == best.t && hit.triangle < best.triangle);
    if is {
        *best = hit;
    }
    is
}
