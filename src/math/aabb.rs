//! Axis-aligned bounding boxes in single precision, the currency of the BVH.

use glam::{DVec3, Vec3};

/// An axis-aligned box. The empty box has `min = +∞`, `max = −∞`, so that growing it by
/// anything gives that thing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    pub min: Vec3,
    pub max: Vec3,
}

impl Aabb {
    pub const EMPTY: Aabb = Aabb { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    pub fn from_points(points: impl IntoIterator<Item = Vec3>) -> Aabb {
        points.into_iter().fold(Aabb::EMPTY, Aabb::grown)
    }

    /// The smallest single-precision box that holds the double-precision one: rounded outwards.
    pub fn from_f64(min: DVec3, max: DVec3) -> Aabb {
        Aabb { min: min.to_array().map(round_down).into(), max: max.to_array().map(round_up).into() }
    }

    pub fn grown(self, p: Vec3) -> Aabb {
        Aabb { min: self.min.min(p), max: self.max.max(p) }
    }

    pub fn union(self, other: Aabb) -> Aabb {
        Aabb { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    pub fn is_empty(&self) -> bool {
        self.min.cmpgt(self.max).any()
    }

    pub fn centroid(&self) -> Vec3 {
        0.5 * self.min + 0.5 * self.max
    }

    pub fn extent(&self) -> Vec3 {
        self.max - self.min
    }

    /// Half of the surface area, which is all that the surface area heuristic compares.
    pub fn half_area(&self) -> f32 {
        let e = self.extent();
        e.x * (e.y + e.z) + e.y * e.z
    }

    pub fn overlaps(&self, other: &Aabb) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// Whether a point is within the box, or no farther from it than `distance` along any axis.
    #[inline]
    pub fn near(&self, p: DVec3, distance: f64) -> bool {
        let (min, max) = (self.min.as_dvec3() - distance, self.max.as_dvec3() + distance);
        (min.cmple(p) & p.cmple(max)).all()
    }

    pub fn contains(&self, p: Vec3) -> bool {
        self.min.cmple(p).all() && p.cmple(self.max).all()
    }
}

/// The largest `f32` that is not above `x`.
#[inline]
pub fn round_down(x: f64) -> f32 {
    let r = x as f32;
    if f64::from(r) > x { r.next_down() } else { r }
}

/// The smallest `f32` that is not below `x`.
#[inline]
pub fn round_up(x: f64) -> f32 {
    let r = x as f32;
    if f64::from(r) < x { r.next_up() } else { r }
}
