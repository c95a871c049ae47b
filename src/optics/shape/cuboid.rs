//! The box. Its faces are numbered −x, +x, −y, +y, −z, +z; each has the coordinates [0, 1]², upright.

use super::solid_angle::Rectangle;
use super::span::Span;
use super::{AreaSample, BareSurface, DirectionSample, ShapeHit, Surface};
use crate::math::{DVec2, DVec3, Ray, sampling};
use crate::optics::Coordinates;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    min: DVec3,
    max: DVec3,
    p_error: f64,
}

/// Right and up of each face, as it is seen from outside.
const RIGHT: [DVec3; 6] = [DVec3::Z, DVec3::NEG_Z, DVec3::X, DVec3::X, DVec3::NEG_X, DVec3::X];
const UP: [DVec3; 6] = [DVec3::Y, DVec3::Y, DVec3::Z, DVec3::NEG_Z, DVec3::Y, DVec3::Y];

impl Cuboid {
    pub fn new(size: DVec3, center: DVec3) -> Cuboid {
        Cuboid::between(center - 0.5 * size, center + 0.5 * size)
    }

    pub fn between(min: DVec3, max: DVec3) -> Cuboid {
        Cuboid { min, max, p_error: super::p_error(min, max) }
    }

    fn span(&self, ray: &Ray) -> Option<Span> {
        let mut span = Span::LINE;
        for axis in 0..3 {
            let (o, d) = (ray.origin[axis], ray.dir[axis]);
            span = span.clip(self.min[axis] - o, -d, 2 * axis as u32)?;
            span = span.clip(o - self.max[axis], d, 2 * axis as u32 + 1)?;
        }
        Some(span)
    }

    fn normal(face: usize) -> DVec3 {
        DVec3::AXES[face / 2] * if face.is_multiple_of(2) { -1.0 } else { 1.0 }
    }

    /// The face's corner of uv = (0, 0) and its two edges from there.
    fn face(&self, face: usize) -> (DVec3, DVec3, DVec3) {
        let size = self.max - self.min;
        let (right, up) = (RIGHT[face] * size, UP[face] * size);
        let middle = 0.5 * self.min + 0.5 * self.max + 0.5 * size * Cuboid::normal(face);
        (middle - 0.5 * right - 0.5 * up, right, up)
    }

    fn face_areas(&self) -> [f64; 6] {
        let s = self.max - self.min;
        let [x, y, z] = [s.y * s.z, s.z * s.x, s.x * s.y];
        [x, x, y, y, z, z]
    }

    fn inside(&self, p: DVec3) -> bool {
        self.min.cmple(p).all() && p.cmple(self.max).all()
    }

    /// The faces that `from` is in front of, at most three, with their solid angles (0 for the rest).
    fn visible(&self, from: DVec3) -> ([Option<Rectangle>; 3], [f64; 3]) {
        let mut faces = [None, None, None];
        let mut weights = [0.0; 3];
        for axis in 0..3 {
            let face = match (from[axis] < self.min[axis], from[axis] > self.max[axis]) {
                (true, _) => 2 * axis,
                (_, true) => 2 * axis + 1,
                _ => continue,
            };
            let (corner, right, up) = self.face(face);
            let rectangle = Rectangle::new(from, corner, right, up);
            weights[axis] = rectangle.as_ref().map_or(0.0, Rectangle::solid_angle);
            faces[axis] = rectangle;
        }
        (faces, weights)
    }
}

impl Surface for Cuboid {
    fn bounds(&self) -> (DVec3, DVec3) {
        (self.min, self.max)
    }

    fn nearest(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<ShapeHit> {
        self.span(ray)?.nearest(t_min, t_max)
    }

    fn bare_surface(&self, ray: &Ray, hit: ShapeHit) -> BareSurface {
        let face = hit.face as usize;
        let axis = face / 2;
        let mut p = ray.at(hit.t).clamp(self.min, self.max);
        p[axis] = if face.is_multiple_of(2) { self.min[axis] } else { self.max[axis] };
        BareSurface { p, p_error: self.p_error, ng: Cuboid::normal(face) }
    }

    fn coordinates(&self, p: DVec3, face: u32) -> Coordinates {
        let (corner, right, up) = self.face(face as usize);
        let from_corner = p - corner;
        let share = |edge: DVec3| (from_corner.dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
        Coordinates { uv: DVec2::new(share(right), share(up)), dpdu: right, dpdv: up }
    }

    fn closed(&self) -> bool {
        true
    }

    fn clearance(&self, p: DVec3) -> f64 {
        // The smallest distance is that to the face itself.
        let mut d = (p - self.min).min(self.max - p).to_array();
        d.sort_by(f64::total_cmp);
        d[1]
    }

    fn depth(&self, p: DVec3) -> f64 {
        (p - self.min).min(self.max - p).min_element()
    }

    fn area(&self) -> f64 {
        self.face_areas().iter().sum()
    }

    fn sample_area(&self, u: [f64; 2]) -> AreaSample {
        let (face, u0) = sampling::pick(&self.face_areas(), u[0]).map_or((0, u[0]), |c| (c.index, c.u));
        let (corner, right, up) = self.face(face);
        AreaSample {
            p: corner + right * u0 + up * u[1],
            ng: Cuboid::normal(face),
            uv: DVec2::new(u0, u[1]),
            pdf: 1.0 / self.area(),
        }
    }

    fn sample_direction(&self, from: DVec3, u: [f64; 2]) -> Option<DirectionSample> {
        if self.inside(from) {
            return Some(DirectionSample { dir: sampling::sphere(u), pdf: sampling::SPHERE_PDF });
        }
        let (faces, weights) = self.visible(from);
        let choice = sampling::pick(&weights, u[0])?;
        let sample = faces[choice.index].as_ref()?.sample([choice.u, u[1]])?;
        Some(DirectionSample { pdf: sample.pdf * choice.pmf, ..sample })
    }

    fn direction_pdf(&self, from: DVec3, dir: DVec3) -> f64 {
        if self.inside(from) {
            return sampling::SPHERE_PDF;
        }
        let (faces, weights) = self.visible(from);
        let total: f64 = weights.iter().sum();
        let pdf =
            |(face, w): (&Option<Rectangle>, f64)| face.as_ref().map_or(0.0, |f| f.pdf(dir) * w / total);
        faces.iter().zip(weights).map(pdf).sum()
    }
}
