//! A ray as the tree sees it: the slab test's constants, padded so that no box is missed that the
//! exact ray, or the rounded triangle test, may reach.
//!
//! Sources: Ize 2013, "Robust BVH Ray Traversal" (JCGT 2(2)): exits are pushed outwards by the
//! rounding of the slab arithmetic. Woop, Benthin & Wald 2013, "Watertight Ray/Triangle
//! Intersection" (JCGT 2(1)), section 3.3: boxes must also cover the rounding of the projected
//! vertices, so near and far planes see different origins.

use super::node::Node;
use crate::math::lanes::Lanes;
use crate::math::{Aabb, Ray, Vec3};
use glam::Vec3A;

/// Exits and limits are scaled by 1 + 16u (u = 2⁻²⁴), above Ize's 1 + 2γ₃ ≈ 1 + 6u; the rest
/// covers a direction that was itself rounded, and the rounding of a hit's distance.
const OUTWARDS: f32 = 1.0 + 8.0 * f32::EPSILON;

/// Bound on the error of a projected vertex over the largest distance along an axis from the
/// origin: the x (or y) of a vertex takes two roundings, its sheared z four, of values that are
/// both at most that distance.
pub(super) const PROJECTION_ERROR: f32 = 6.0 * f32::EPSILON;

/// A ray for traversal, in single precision.
///
/// `t` is in units of `dir`, which need not be of unit length, so that a ray keeps its `t` in the
/// object space of an instance.
#[derive(Clone, Copy, Debug)]
pub struct BoxRay {
    pub(super) origin: Vec3A,
    origin_error: Vec3A,
    pub(super) dir: Vec3A,
    /// Reciprocal of `dir`, infinite where `dir` is ±0.
    inv: Vec3A,
}

impl BoxRay {
    /// `origin_error` bounds, for each axis, how far the exact origin lies from `origin` (0 where
    /// `origin` is exact). A ray with a non-finite or zero direction meets nothing.
    #[inline]
    pub fn new(origin: Vec3, origin_error: Vec3, dir: Vec3) -> BoxRay {
        BoxRay::padded(origin.into(), origin_error.into(), dir.into())
    }

    /// A double-precision ray rounded to single precision, the origin's rounding bounded: half a unit in
    /// the last place, which below the normal numbers is less than the smallest of them.
    #[inline]
    pub fn rounded(ray: &Ray) -> BoxRay {
        let origin = ray.origin.as_vec3a();
        let error = origin.abs() * (0.5 * f32::EPSILON) + Vec3A::splat(f32::MIN_POSITIVE);
        BoxRay::padded(origin, error, ray.dir.as_vec3a())
    }

    #[inline]
    fn padded(origin: Vec3A, origin_error: Vec3A, dir: Vec3A) -> BoxRay {
        BoxRay { origin, origin_error, dir, inv: dir.recip() }
    }

    /// The axes in the order x, y, z of the triangle test's sheared space, and its shear of x and y
    /// and scale of z.
    #[inline(always)]
    pub(super) fn shear(&self) -> ([usize; 3], [f32; 3]) {
        let (dir, d) = (self.dir, self.dir.abs());
        let largest = if d.x > d.y && d.x > d.z { 0 } else { 1 + usize::from(d.y <= d.z) };
        let [x, y, z] = [[1, 2, 0], [2, 0, 1], [0, 1, 2]][largest];
        ([x, y, z], [dir[x] / dir[z], dir[y] / dir[z], 1.0 / dir[z]])
    }

    /// Whether the ray can hit anything at all.
    #[inline]
    pub(super) fn is_valid(&self) -> bool {
        // 0 times what is not finite is NaN. The smallest reciprocal is that of the largest component.
        let zero = self.origin * 0.0 + self.dir * 0.0;
        zero.cmpeq(Vec3A::ZERO).all() && self.inv.abs().min_element() < f32::INFINITY
    }

    /// The largest distance along an axis from the origin to a point of `bounds`.
    #[inline]
    pub(super) fn reach(&self, bounds: &Aabb) -> f32 {
        let (min, max) = (Vec3A::from(bounds.min), Vec3A::from(bounds.max));
        (max - self.origin).abs().max((min - self.origin).abs()).max_element()
    }
}

/// The slab test's constants for one ray and one tree, one copy per lane.
#[derive(Clone, Copy)]
pub(super) struct Slabs<L: Lanes> {
    near_row: [usize; 3],
    far_row: [usize; 3],
    near_origin: [L::F; 3],
    far_origin: [L::F; 3],
    near_inv: [L::F; 3],
    far_inv: [L::F; 3],
    zero: L::F,
}

impl<L: Lanes> Slabs<L> {
    #[inline(always)]
    pub fn new(lanes: L, ray: &BoxRay, bounds: &Aabb) -> Self {
        let pad = ray.origin_error + Vec3A::splat(PROJECTION_ERROR * ray.reach(bounds));
        // A near plane's origin is moved along the ray, a far plane's against it.
        let pad = pad.copysign(ray.dir);
        let (near_origin, far_origin) = (ray.origin + pad, ray.origin - pad);
        // Kept finite for near planes: that can only bring an entry nearer.
        let near_inv = ray.inv.clamp(Vec3A::splat(-f32::MAX), Vec3A::splat(f32::MAX));
        let far_inv = ray.inv * OUTWARDS;
        let backwards = ray.dir.is_negative_bitmask() as usize;
        let near_row = |k: usize| k + 3 * (backwards >> k & 1);
        let splat = |v: Vec3A| [lanes.splat(v.x), lanes.splat(v.y), lanes.splat(v.z)];
        Slabs {
            near_row: [near_row(0), near_row(1), near_row(2)],
            far_row: [3 - near_row(0), 5 - near_row(1), 7 - near_row(2)],
            near_origin: splat(near_origin),
            far_origin: splat(far_origin),
            near_inv: splat(near_inv),
            far_inv: splat(far_inv),
            zero: lanes.splat(0.0),
        }
    }

    /// The largest entry that a box may have to hold a hit at up to `t_max`.
    #[inline(always)]
    pub fn limit(t_max: f32) -> f32 {
        t_max * OUTWARDS
    }

    /// Entries into the node's eight boxes (not below 0), and which are entered by `limit`.
    ///
    /// 0·∞ = NaN arises for a ray in the plane of a far face; `min` then ignores that slab, and for y also that
    /// of x: the box may be entered in vain, but is not missed.
    #[inline(always)]
    pub fn enter(&self, lanes: L, node: Node, limit: L::F) -> (L::F, u32) {
        let (near, far) = (self.near(lanes, node), self.far(lanes, node));
        let entry = lanes.max(lanes.max(near[0], near[1]), lanes.max(near[2], self.zero));
        let exit = lanes.min(lanes.min(far[0], far[1]), lanes.min(far[2], limit));
        (entry, lanes.le(entry, exit))
    }

    #[inline(always)]
    fn near(&self, l: L, node: Node) -> [L::F; 3] {
        let ([x, y, z], o, inv) = (self.near_row, &self.near_origin, &self.near_inv);
        [
            l.mul(l.sub(l.load(node.row(x)), o[0]), inv[0]),
            l.mul(l.sub(l.load(node.row(y)), o[1]), inv[1]),
            l.mul(l.sub(l.load(node.row(z)), o[2]), inv[2]),
        ]
    }

    #[inline(always)]
    fn far(&self, l: L, node: Node) -> [L::F; 3] {
        let ([x, y, z], o, inv) = (self.far_row, &self.far_origin, &self.far_inv);
        [
            l.mul(l.sub(l.load(node.row(x)), o[0]), inv[0]),
            l.mul(l.sub(l.load(node.row(y)), o[1]), inv[1]),
            l.mul(l.sub(l.load(node.row(z)), o[2]), inv[2]),
        ]
    }
}
