//! The trees against brute force, closed surfaces and degenerate input.

mod boxes;
mod triangles;
mod watertight;

use super::packet::{self, Packet, Shear, TriangleHit};
use super::ray::BoxRay;
use crate::math::lanes::Portable;
use crate::math::{Aabb, Vec3};

/// A plain generator for test values (splitmix64), with a fixed seed per test.
pub struct Rng(pub u64);

impl Rng {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f32 {
        (self.next() >> 40) as f32 / (1u64 << 24) as f32
    }

    /// In [-1, 1)³.
    pub fn cube(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - 1.0
    }
}

/// A ray whose origin is exact.
pub fn ray(origin: Vec3, dir: Vec3) -> BoxRay {
    BoxRay::new(origin, Vec3::ZERO, dir)
}

/// The nearest hit by asking every triangle in turn.
pub fn brute_force(
    vertices: &[Vec3],
    triangles: &[[u32; 3]],
    bounds: &Aabb,
    ray: &BoxRay,
    t_max: f32,
) -> Option<TriangleHit> {
    let shear = Shear::new(Portable, ray, bounds);
    let mut best = TriangleHit { t: t_max, triangle: 0, b: [0.0; 3] };
    let mut found = false;
    for (i, t) in triangles.iter().enumerate() {
        let mut rows = packet::EMPTY;
        packet::set(&mut rows, 0, i as u32, t.map(|v| vertices[v as usize]));
        found |= Packet(&rows).nearest(Portable, &shear, &mut best);
    }
    found.then_some(best)
}

/// A closed sphere of triangles about the origin: rings of vertices and two poles.
pub fn sphere(radius: f64, rings: u32, sectors: u32) -> (Vec<glam::DVec3>, Vec<[u32; 3]>) {
    let mut vertices = vec![glam::DVec3::Y * radius];
    for ring in 1..rings {
        let (sin, cos) = (std::f64::consts::PI * f64::from(ring) / f64::from(rings)).sin_cos();
        for sector in 0..sectors {
            let phi = std::f64::consts::TAU * f64::from(sector) / f64::from(sectors);
            vertices.push(glam::DVec3::new(sin * phi.cos(), cos, sin * phi.sin()) * radius);
        }
    }
    let south = vertices.len() as u32;
    vertices.push(-glam::DVec3::Y * radius);
    let at = |ring: u32, sector: u32| 1 + (ring - 1) * sectors + sector % sectors;
    let mut triangles = Vec::new();
    for s in 0..sectors {
        triangles.push([0, at(1, s), at(1, s + 1)]);
        triangles.push([south, at(rings - 1, s + 1), at(rings - 1, s)]);
        for ring in 1..rings - 1 {
            triangles.push([at(ring, s), at(ring + 1, s), at(ring + 1, s + 1)]);
            triangles.push([at(ring, s), at(ring + 1, s + 1), at(ring, s + 1)]);
        }
    }
    (vertices, triangles)
}
