//! Spherical rectangles: directions uniform over the solid angle of a rectangle.
//!
//! Ureña, Fajardo, King: An Area-Preserving Parametrization for Spherical Rectangles, EGSR 2013. Its
//! differences of angles lose small solid angles to rounding; below 1e-4 sr the rectangle is taken as
//! two spherical triangles, which don't.

use super::{DirectionSample, Triangle};
use crate::math::{DVec3, sampling};
use std::f64::consts::TAU;

const SMALL: f64 = 1e-4;

/// A rectangle as it is seen from a point.
#[derive(Clone, Copy, Debug)]
pub struct Rectangle {
    from: DVec3,
    corner: DVec3,
    right: DVec3,
    up: DVec3,
    solid_angle: f64,
    /// Unit vectors along the edges and away from the rectangle.
    x: DVec3,
    y: DVec3,
    z: DVec3,
    /// The rectangle in that frame, from the point: z0 < 0.
    x0: f64,
    x1: f64,
    y0: f64,
    y1: f64,
    z0: f64,
}

impl Rectangle {
    /// From a corner and the two edges that leave it at right angles. `None` if nothing of it is seen.
    #[inline]
    pub fn new(from: DVec3, corner: DVec3, right: DVec3, up: DVec3) -> Option<Rectangle> {
        let [width, height] = [right.length(), up.length()];
        let (x, y) = (right / width, up / height);
        let d = corner - from;
        let normal = x.cross(y);
        let distance = d.dot(normal);
        let (x0, y0) = (d.dot(x), d.dot(y));
        let (x1, y1, z0) = (x0 + width, y0 + height, -distance.abs());
        let solid_angle = solid_angle([x0, x1], [y0, y1], z0, width * height);
        (solid_angle > 0.0 && distance != 0.0).then(|| Rectangle {
            from,
            corner,
            right,
            up,
            solid_angle,
            x,
            y,
            z: if distance > 0.0 { -normal } else { normal },
            x0,
            x1,
            y0,
            y1,
            z0,
        })
    }

    /// Its halves on either side of a diagonal.
    #[cold]
    fn halves(&self) -> [Option<Triangle>; 2] {
        let Rectangle { from, corner, right, up, .. } = *self;
        let opposite = corner + right + up;
        [
            Triangle::new(from, [corner, corner + right, opposite]),
            Triangle::new(from, [corner, opposite, corner + up]),
        ]
    }

    /// In steradians, in (0, 2π].
    pub fn solid_angle(&self) -> f64 {
        self.solid_angle
    }

    /// A direction, uniform over the rectangle.
    pub fn sample(&self, u: [f64; 2]) -> Option<DirectionSample> {
        if self.solid_angle < SMALL {
            let halves = self.halves();
            let choice = sampling::pick(&solid_angles(&halves), u[0])?;
            let sample = halves[choice.index].as_ref()?.sample([choice.u, u[1]])?;
            return Some(DirectionSample { pdf: sample.pdf * choice.pmf, ..sample });
        }
        let xu = self.column(u[0]);
        let d2 = xu * xu + self.z0 * self.z0;
        // Within the column the solid angle is uniform in the sine of the elevation.
        let sine = |y: f64| y / (d2 + y * y).sqrt();
        let (h0, h1) = (sine(self.y0), sine(self.y1));
        let h = h0 + u[1] * (h1 - h0);
        let yv = (h * (d2 / ((1.0 - h) * (1.0 + h))).sqrt()).clamp(self.y0, self.y1);
        let dir = (self.x * xu + self.y * yv + self.z * self.z0).try_normalize()?;
        Some(DirectionSample { dir, pdf: 1.0 / self.solid_angle })
    }

    /// The density of [`Rectangle::sample`]: 0 outside the rectangle.
    pub fn pdf(&self, dir: DVec3) -> f64 {
        if self.solid_angle < SMALL {
            let halves = self.halves();
            let weights = solid_angles(&halves);
            let pdf = |(half, w): (&Option<Triangle>, f64)| half.as_ref().map_or(0.0, |h| h.pdf(dir) * w);
            let sum: f64 = halves.iter().zip(weights).map(pdf).sum();
            return sum / weights.iter().sum::<f64>();
        }
        let t = self.z0 / dir.dot(self.z);
        let (x, y) = (dir.dot(self.x) * t, dir.dot(self.y) * t);
        let within = t > 0.0 && self.x0 <= x && x <= self.x1 && self.y0 <= y && y <= self.y1;
        if within { 1.0 / self.solid_angle } else { 0.0 }
    }

    /// The x up to which the share `u` of the solid angle lies.
    fn column(&self, u: f64) -> f64 {
        let z2 = self.z0 * self.z0;
        // The z components of the inward normals of the planes through the eye and the four edges.
        let nz = |c: f64| c / (z2 + c * c).sqrt();
        let (b0, b1) = (-nz(self.y0), nz(self.y1));
        // Inner angle between the planes of two neighbouring edges, from both its sine and its cosine.
        let angle = |ny_z: f64, ny_2: f64, nx_z: f64, nx_2: f64| {
            libm::atan2((ny_2 + ny_z * ny_z * nx_2).sqrt(), -ny_z * nx_z)
        };
        let rest = |c: f64| z2 / (z2 + c * c);
        let (n3, n3_rest) = (-nz(self.x0), rest(self.x0));
        let g2 = angle(b1, rest(self.y1), n3, n3_rest);
        let g3 = angle(b0, rest(self.y0), n3, n3_rest);
        let (sin, cos) = libm::sincos(u * self.solid_angle + (TAU - g2 - g3));
        let f = (cos * b0 - b1) / sin;
        let c = (1.0f64.copysign(f) / (f * f + b0 * b0).sqrt()).clamp(-1.0, 1.0);
        let x = -c * self.z0 / ((1.0 - c) * (1.0 + c)).sqrt();
        // NaN where 0/0 above: no width to choose from.
        if x.is_nan() { self.x0 } else { x.clamp(self.x0, self.x1) }
    }
}

fn solid_angles(halves: &[Option<Triangle>; 2]) -> [f64; 2] {
    halves.map(|half| half.map_or(0.0, |h| h.solid_angle()))
}

/// Of the rectangle of this area between two x and two y, in the plane z from the eye: that of its halves (Van
/// Oosterom & Strackee 1983, eq. 8), whose angles are added as arguments of complex numbers. NaN where a corner
/// is at the eye.
#[inline]
fn solid_angle(x: [f64; 2], y: [f64; 2], z: f64, area: f64) -> f64 {
    let length = |i: usize, j: usize| (x[i] * x[i] + y[j] * y[j] + z * z).sqrt();
    let dot = |[i, j]: [usize; 2], [k, l]: [usize; 2]| x[i] * x[k] + y[j] * y[l] + z * z;
    let (l00, l10, l11, l01) = (length(0, 0), length(1, 0), length(1, 1), length(0, 1));
    // Of the diagonal, which both halves have.
    let across = dot([0, 0], [1, 1]);
    let half = |corner: [usize; 2], far: f64| {
        let cube = l00 * l11 * far;
        let real = cube + across * far + dot([0, 0], corner) * l11 + dot([1, 1], corner) * l00;
        [real / cube, -z * area / cube]
    };
    let ([r0, i0], [r1, i1]) = (half([1, 0], l10), half([0, 1], l01));
    // A plane figure is seen under 2π at most.
    2.0 * libm::atan2((i0 * r1 + i1 * r0).max(0.0), r0 * r1 - i0 * i1)
}
