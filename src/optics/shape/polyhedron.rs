//! The five regular solids around the origin, standing on a face: face 0 has the normal −y and an edge
//! parallel to x towards +z.
//!
//! Each solid's face normals are the corners of its dual. Coordinates are those of the square around
//! each face, upright: v grows along the part of +y in the face (on horizontal faces as for the box).

use super::planes::Planes;
use super::solid_angle::Triangle;
use super::{AreaSample, BareSurface, DirectionSample, ShapeHit, Surface};
use crate::math::{DMat3, DVec2, DVec3, Frame, Ray, sampling};
use crate::optics::Coordinates;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solid {
    Tetrahedron,
    Cube,
    Octahedron,
    Dodecahedron,
    Icosahedron,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Polyhedron {
    circumradius: f64,
    /// The distance of every face from the origin.
    inradius: f64,
    faces: Vec<Face>,
    planes: Planes,
    /// The faces as fans of triangles, with their faces' numbers and areas.
    triangles: Vec<([DVec3; 3], u32)>,
    areas: Vec<f64>,
}

#[derive(Clone, Debug, PartialEq)]
struct Face {
    normal: DVec3,
    /// Right and up, as long as the side of the square.
    right: DVec3,
    up: DVec3,
    /// The square's corner of uv = (0, 0).
    corner: DVec3,
}

impl Polyhedron {
    pub fn new(kind: Solid, circumradius: f64) -> Polyhedron {
        let (corners, normals) = standing(kind);
        let corners: Vec<DVec3> = corners.iter().map(|&c| c * circumradius).collect();
        let inradius = circumradius * inradius_of_unit(&corners, &normals, circumradius);
        let planes = Planes::new(&normals, inradius);
        let (faces, triangles, areas) = Default::default();
        let mut solid = Polyhedron { circumradius, inradius, faces, planes, triangles, areas };
        for (number, &normal) in normals.iter().enumerate() {
            let outline = outline(&corners, normal);
            solid.faces.push(Face::new(normal, &outline));
            for i in 1..outline.len() - 1 {
                let triangle = [outline[0], outline[i], outline[i + 1]];
                solid.areas.push(0.5 * (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).length());
                solid.triangles.push((triangle, number as u32));
            }
        }
        solid
    }

    fn in_front(&self, face: u32, from: DVec3) -> bool {
        from.dot(self.faces[face as usize].normal) > self.inradius
    }

    fn inside(&self, p: DVec3) -> bool {
        (0..self.faces.len() as u32).all(|face| !self.in_front(face, p))
    }

    /// The triangles that `from` is in front of, with their solid angles (0 for the rest).
    fn visible(&self, from: DVec3) -> ([Option<Triangle>; MOST_TRIANGLES], [f64; MOST_TRIANGLES]) {
        let mut seen = [None; MOST_TRIANGLES];
        for (slot, (corners, face)) in seen.iter_mut().zip(&self.triangles) {
            if self.in_front(*face, from) {
                *slot = Triangle::new(from, *corners);
            }
        }
        let weights = seen.map(|triangle| triangle.map_or(0.0, |t| t.solid_angle()));
        (seen, weights)
    }
}

/// Of the dodecahedron: twelve pentagons of three triangles.
const MOST_TRIANGLES: usize = 36;

impl Face {
    fn new(normal: DVec3, outline: &[DVec3]) -> Face {
        // Upright, unless the face is horizontal but for rounding.
        let rise = DVec3::Y - normal * normal.y;
        let up = if rise.length_squared() > 1e-12 {
            rise.normalize()
        } else {
            DVec3::new(0.0, 0.0, -normal.y).normalize()
        };
        let right = up.cross(normal);
        let mut min = DVec2::INFINITY;
        let mut max = DVec2::NEG_INFINITY;
        for corner in outline {
            let c = DVec2::new(corner.dot(right), corner.dot(up));
            (min, max) = (min.min(c), max.max(c));
        }
        let side = (max - min).max_element();
        let low = 0.5 * (min + max) - 0.5 * side;
        let height = outline[0].dot(normal);
        Face {
            normal,
            right: right * side,
            up: up * side,
            corner: right * low.x + up * low.y + normal * height,
        }
    }

    fn uv(&self, p: DVec3) -> DVec2 {
        let from_corner = p - self.corner;
        let side2 = self.right.length_squared();
        DVec2::new(from_corner.dot(self.right), from_corner.dot(self.up)) / side2
    }
}

/// Unit corners and unit face normals, turned so that the first normal is −y.
fn standing(kind: Solid) -> (Vec<DVec3>, Vec<DVec3>) {
    let (corners, normals) = match kind {
        Solid::Tetrahedron => (half_cube(1.0), half_cube(-1.0)),
        Solid::Cube => (cube(), axes()),
        Solid::Octahedron => (axes(), cube()),
        Solid::Dodecahedron => (dodecahedron(), icosahedron()),
        Solid::Icosahedron => (icosahedron(), dodecahedron()),
    };
    let unit = |list: Vec<DVec3>| list.into_iter().map(DVec3::normalize).collect::<Vec<_>>();
    let (corners, normals) = (unit(corners), unit(normals));
    let base = outline(&corners, normals[0]);
    let to_edge = 0.5 * (base[0] + base[1]);
    let z = (to_edge - normals[0] * to_edge.dot(normals[0])).normalize();
    let y = -normals[0];
    let turned = DMat3::from_cols(y.cross(z), y, z).transpose();
    let turn = |list: Vec<DVec3>| list.into_iter().map(|v| turned * v).collect();
    (turn(corners), turn(normals))
}

/// The corners that are farthest along the normal, anticlockwise as seen from outside.
fn outline(corners: &[DVec3], normal: DVec3) -> Vec<DVec3> {
    let farthest = corners.iter().map(|c| c.dot(normal)).fold(f64::NEG_INFINITY, f64::max);
    // Corners of other faces are lower by a third of the circumradius and more.
    let mut face: Vec<DVec3> =
        corners.iter().copied().filter(|c| farthest - c.dot(normal) < 0.01 * c.length()).collect();
    let frame = Frame::around(normal);
    let angle = |c: &DVec3| libm::atan2(c.dot(frame.t), c.dot(frame.s));
    face.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    face
}

fn inradius_of_unit(corners: &[DVec3], normals: &[DVec3], circumradius: f64) -> f64 {
    corners.iter().map(|c| c.dot(normals[0])).fold(0.0, f64::max) / circumradius
}

const GOLDEN: f64 = 1.618_033_988_749_895;

fn axes() -> Vec<DVec3> {
    vec![DVec3::NEG_Y, DVec3::Y, DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::NEG_Z]
}

fn cube() -> Vec<DVec3> {
    let sign = |bit: u32| if bit == 0 { 1.0 } else { -1.0 };
    (0..8).map(|i| DVec3::new(sign(i & 1), sign(i & 2), sign(i & 4))).collect()
}

/// Every other corner of the cube; the opposite ones for −1.
fn half_cube(sign: f64) -> Vec<DVec3> {
    cube().into_iter().filter(|c| c.x * c.y * c.z * sign > 0.0).collect()
}

/// The three rectangles of edges 2·`a` and 2·`b` in the coordinate planes.
fn rectangles(a: f64, b: f64) -> Vec<DVec3> {
    let signs = [(a, b), (a, -b), (-a, b), (-a, -b)];
    let turned = |(p, q): (f64, f64)| [DVec3::new(p, 0.0, q), DVec3::new(q, p, 0.0), DVec3::new(0.0, q, p)];
    signs.into_iter().flat_map(turned).collect()
}

fn icosahedron() -> Vec<DVec3> {
    rectangles(1.0, GOLDEN)
}

fn dodecahedron() -> Vec<DVec3> {
    [cube(), rectangles(GOLDEN, 1.0 / GOLDEN)].concat()
}

impl Surface for Polyhedron {
    fn bounds(&self) -> (DVec3, DVec3) {
        let corners = || self.triangles.iter().flat_map(|(triangle, _)| triangle).copied();
        // The planes that are met may be a rounding farther out than the corners.
        let slack = 8.0 * f64::EPSILON * self.circumradius;
        let min = corners().fold(DVec3::INFINITY, DVec3::min);
        let max = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
        (min - slack, max + slack)
    }

    fn ball(&self) -> (DVec3, f64) {
        (DVec3::ZERO, self.circumradius)
    }

    fn nearest(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<ShapeHit> {
        self.planes.span(ray)?.nearest(t_min, t_max)
    }

    fn bare_surface(&self, ray: &Ray, hit: ShapeHit) -> BareSurface {
        let face = &self.faces[hit.face as usize];
        let p = ray.at(hit.t);
        let p = p - face.normal * (face.normal.dot(p) - self.inradius);
        let reach = DVec3::splat(self.circumradius);
        BareSurface { p, p_error: super::p_error(-reach, reach), ng: face.normal }
    }

    fn coordinates(&self, p: DVec3, face: u32) -> Coordinates {
        let face = &self.faces[face as usize];
        Coordinates { uv: face.uv(p).clamp(DVec2::ZERO, DVec2::ONE), dpdu: face.right, dpdv: face.up }
    }

    fn closed(&self) -> bool {
        true
    }

    fn clearance(&self, p: DVec3) -> f64 {
        self.planes.clearance(p)
    }

    fn depth(&self, p: DVec3) -> f64 {
        let heights = self.faces.iter().map(|face| p.dot(face.normal));
        self.inradius - heights.fold(f64::NEG_INFINITY, f64::max)
    }

    fn area(&self) -> f64 {
        self.areas.iter().sum()
    }

    fn sample_area(&self, u: [f64; 2]) -> AreaSample {
        let (chosen, u0) = sampling::pick(&self.areas, u[0]).map_or((0, u[0]), |c| (c.index, c.u));
        let ([a, b, c], number) = self.triangles[chosen];
        let [b0, b1, b2] = sampling::triangle([u0, u[1]]);
        let p = a * b0 + b * b1 + c * b2;
        let face = &self.faces[number as usize];
        let uv = face.uv(p).clamp(DVec2::ZERO, DVec2::ONE);
        AreaSample { p, ng: face.normal, uv, pdf: 1.0 / self.area() }
    }

    fn sample_direction(&self, from: DVec3, u: [f64; 2]) -> Option<DirectionSample> {
        if self.inside(from) {
            return Some(DirectionSample { dir: sampling::sphere(u), pdf: sampling::SPHERE_PDF });
        }
        let (seen, weights) = self.visible(from);
        let choice = sampling::pick(&weights, u[0])?;
        let sample = seen[choice.index]?.sample([choice.u, u[1]])?;
        Some(DirectionSample { pdf: sample.pdf * choice.pmf, ..sample })
    }

    fn direction_pdf(&self, from: DVec3, dir: DVec3) -> f64 {
        if self.inside(from) {
            return sampling::SPHERE_PDF;
        }
        let (seen, weights) = self.visible(from);
        let sum: f64 = seen.iter().zip(weights).map(|(t, w)| t.map_or(0.0, |t| t.pdf(dir) * w)).sum();
        if sum > 0.0 { sum / weights.iter().sum::<f64>() } else { 0.0 }
    }
}

#[cfg(test)]
mod tests;
