//! Rays and the offsets that keep them from meeting the surface they leave.

use glam::DVec3;

/// A half-line. The direction is of unit length in the world, of any length in object space.
/// Coordinates are double precision; trees are traversed in single precision with the rounding of
/// the origin bounded (`build::bvh::BoxRay`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    pub origin: DVec3,
    pub dir: DVec3,
}

impl Ray {
    #[inline]
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.dir * t
    }

    /// The ray that leaves the surface point `p`, known to within `p_error` metres, in direction
    /// `dir`: its origin is moved off the surface along the geometric normal, to the side on which
    /// it goes on (after Wächter & Binder, Ray Tracing Gems, ch. 6, with the error known instead of guessed).
    #[inline]
    pub fn leaving(p: DVec3, p_error: f64, ng: DVec3, dir: DVec3) -> Ray {
        let side = if dir.dot(ng) >= 0.0 { p_error } else { -p_error };
        Ray { origin: p + ng * side, dir }
    }

    /// The ray that goes through the surface point `p` in direction `dir` and starts just before it:
    /// as [`Ray::leaving`], on the other side.
    #[inline]
    pub fn reaching(p: DVec3, p_error: f64, ng: DVec3, dir: DVec3) -> Ray {
        Ray { dir, ..Ray::leaving(p, p_error, ng, -dir) }
    }
}
