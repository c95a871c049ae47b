//! Spherical triangles: directions uniform over the solid angle of a triangle.
//!
//! Solid angle: Van Oosterom & Strackee, The Solid Angle of a Plane Triangle, 1983. Sampling: Arvo,
//! Stratified Sampling of Spherical Triangles, SIGGRAPH 1995, with the moved corner found by a
//! reflection as Peters does (BRDF Importance Sampling for Polygonal Lights, TOG 40(4), 2021), so that
//! no difference of angles is taken and triangles may be as small as 1e-8 rad.

use super::DirectionSample;
use crate::math::{DVec3, sampling};

/// Below this the directions of the corners no longer tell them apart well: 1e-8 rad across.
const TINY: f64 = 1e-16;

/// A triangle as it is seen from a point.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    /// Corners, from the point, ordered so that `det` > 0.
    corners: [DVec3; 3],
    /// Unit directions of the corners.
    dirs: [DVec3; 3],
    /// The triple product of the directions.
    det: f64,
    solid_angle: f64,
}

impl Triangle {
    /// `None` if nothing of it is seen: edge-on, degenerate, not finite, or a corner at the point.
    pub fn new(from: DVec3, corners: [DVec3; 3]) -> Option<Triangle> {
        let [a, b, c] = corners;
        // From the edges, which are exact where corners are close together and far away.
        let normal = (b - a).cross(c - a);
        let volume = (a - from).dot(normal);
        let corners =
            if volume > 0.0 { [a - from, b - from, c - from] } else { [a - from, c - from, b - from] };
        let lengths = corners.map(DVec3::length);
        let dirs = [corners[0] / lengths[0], corners[1] / lengths[1], corners[2] / lengths[2]];
        let det = volume.abs() / lengths[0] / lengths[1] / lengths[2];
        let sum = 1.0 + dirs[0].dot(dirs[1]) + dirs[1].dot(dirs[2]) + dirs[2].dot(dirs[0]);
        let solid_angle = 2.0 * libm::atan2(det, sum);
        (solid_angle > 0.0 && solid_angle.is_finite()).then_some(Triangle { corners, dirs, det, solid_angle })
    }

    /// In steradians, in (0, 2π].
    pub fn solid_angle(&self) -> f64 {
        self.solid_angle
    }

    /// A direction, uniform over the triangle; below 1e-16 sr uniform by area instead.
    pub fn sample(&self, u: [f64; 2]) -> Option<DirectionSample> {
        if self.solid_angle < TINY {
            return self.sample_by_area(u);
        }
        let [v0, v1, v2] = self.dirs;
        let (sin, cos) = libm::sincos(0.5 * u[0] * self.solid_angle);
        // The corner moved along the arc from v0 to v2 that cuts off the share u₀: v0 mirrored in h.
        let h = v0 * (self.det * cos - (v0 + v1).dot(v2) * sin) + v2 * (sin * (1.0 + v0.dot(v1)));
        let moved = h * (2.0 * v0.dot(h) / h.length_squared()) - v0;
        // A point of the arc from v1 to the moved corner, uniform in 1 − cosine.
        let chord = moved - v1;
        let one_minus_cos = 0.5 * chord.length_squared();
        let tangent = (chord + v1 * one_minus_cos).try_normalize()?;
        let s = u[1] * one_minus_cos;
        let dir = (v1 * (1.0 - s) + tangent * (s * (2.0 - s)).max(0.0).sqrt()).try_normalize()?;
        Some(DirectionSample { dir, pdf: 1.0 / self.solid_angle })
    }

    /// The density of [`Triangle::sample`]: 0 outside the triangle.
    pub fn pdf(&self, dir: DVec3) -> f64 {
        let [a, b, c] = self.dirs;
        let side = |p: DVec3, q: DVec3| p.cross(q - p).dot(dir) >= 0.0;
        if !(side(a, b) && side(b, c) && side(c, a)) {
            return 0.0;
        }
        if self.solid_angle < TINY { self.area_pdf(dir) } else { 1.0 / self.solid_angle }
    }

    fn sample_by_area(&self, u: [f64; 2]) -> Option<DirectionSample> {
        let [b0, b1, b2] = sampling::triangle(u);
        let dir = (self.corners[0] * b0 + self.corners[1] * b1 + self.corners[2] * b2).try_normalize()?;
        let pdf = self.area_pdf(dir);
        (pdf > 0.0 && pdf.is_finite()).then_some(DirectionSample { dir, pdf })
    }

    /// Distance² / (area·cosine), with the distance along `dir` to the plane.
    fn area_pdf(&self, dir: DVec3) -> f64 {
        let [a, b, c] = self.corners;
        let normal = (b - a).cross(c - a);
        let slope = dir.dot(normal);
        let distance = a.dot(normal) / slope;
        2.0 * distance * distance / slope.abs()
    }
}

/// A direction from `from` to the triangle, seen from either side, uniform over its solid angle (by
/// area for less than 1e-16 sr). `None` if nothing of it is seen.
pub fn sample_triangle_direction(from: DVec3, corners: [DVec3; 3], u: [f64; 2]) -> Option<DirectionSample> {
    Triangle::new(from, corners)?.sample(u)
}

/// The density of [`sample_triangle_direction`] for the unit vector `dir`, in 1/sr.
pub fn triangle_direction_pdf(from: DVec3, corners: [DVec3; 3], dir: DVec3) -> f64 {
    Triangle::new(from, corners).map_or(0.0, |triangle| triangle.pdf(dir))
}
