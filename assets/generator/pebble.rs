//! Pebbles: a subdivided icosahedron, flattened, dented by smooth noise.

use std::collections::HashMap;

use glam::{DVec2, DVec3};

use super::mesh::Mesh;
use super::random::Random;

/// Subdivisions: 20·4³ triangles.
const LEVELS: usize = 3;

/// A closed stone with the given half axes, centre at the origin.
pub fn stone(seed: u64, half: [f64; 3]) -> Mesh {
    let (points, faces) = sphere();
    let mut random = Random::new(seed);
    // A few broad planes cut and a few broad swells raise the ball.
    let dents: Vec<(DVec3, f64, f64)> =
        (0..14).map(|_| (random.direction(), random.within(1.5, 6.0), random.within(-0.16, 0.10))).collect();
    let mut mesh = Mesh::new("pebble, closed, about 2 wide, centre at the origin");
    for &p in &points {
        let swell: f64 = dents
            .iter()
            .map(|(axis, narrow, height)| height * libm::exp(narrow * (p.dot(*axis) - 1.0)))
            .sum();
        mesh.positions.push(p * (1.0 + swell) * DVec3::from_array(half));
    }
    for face in faces {
        let uvs = coordinates(face.map(|i| points[i]));
        let mut corners = [[0; 3]; 3];
        for i in 0..3 {
            mesh.coordinates.push(uvs[i]);
            corners[i] = [face[i], mesh.coordinates.len() - 1, face[i]];
        }
        mesh.corners(corners);
    }
    mesh.smooth();
    share(&mut mesh);
    mesh
}

/// Longitude and latitude, made whole across the seam and at the poles.
fn coordinates(p: [DVec3; 3]) -> [DVec2; 3] {
    let turn = |p: DVec3| libm::atan2(p.x, p.z) / std::f64::consts::TAU + 0.5;
    let mut u = p.map(turn);
    if u.iter().any(|&a| a > 0.75) && u.iter().any(|&a| a < 0.25) {
        u = u.map(|a| if a < 0.5 { a + 1.0 } else { a });
    }
    for i in 0..3 {
        if p[i].y.abs() > 0.9999 {
            u[i] = 0.5 * (u[(i + 1) % 3] + u[(i + 2) % 3]);
        }
    }
    [0, 1, 2].map(|i| DVec2::new(u[i], libm::asin(p[i].y.clamp(-1.0, 1.0)) / std::f64::consts::PI + 0.5))
}

/// Writes equal texture coordinates once.
fn share(mesh: &mut Mesh) {
    let mut known: HashMap<[i64; 2], usize> = HashMap::new();
    let old = std::mem::take(&mut mesh.coordinates);
    for corner in mesh.groups.iter_mut().flat_map(|g| &mut g.faces).flatten() {
        let uv = old[corner[1]];
        let key = [(uv.x * 1e4).round() as i64, (uv.y * 1e4).round() as i64];
        let next = known.len();
        corner[1] = *known.entry(key).or_insert_with(|| {
            mesh.coordinates.push(uv);
            next
        });
    }
}

/// The icosahedron's corners at height ±1/√5 and the poles, each face cut in four `LEVELS` times.
fn sphere() -> (Vec<DVec3>, Vec<[usize; 3]>) {
    let (up, out) = (0.447_213_595_499_957_9, 0.894_427_190_999_915_9);
    let mut points = vec![DVec3::Y];
    for k in 0..10 {
        let (sin, cos) = super::solid::turn(36.0 * k as f64);
        points.push(DVec3::new(out * sin, if k % 2 == 0 { up } else { -up }, out * cos));
    }
    points.push(DVec3::NEG_Y);
    let mut faces = Vec::new();
    for k in 0..5 {
        let at = |i: usize| 1 + (2 * k + i) % 10;
        faces.push([0, at(0), at(2)]);
        faces.push([at(0), at(1), at(2)]);
        faces.push([at(1), at(3), at(2)]);
        faces.push([at(1), 11, at(3)]);
    }
    for _ in 0..LEVELS {
        let mut middles: HashMap<(usize, usize), usize> = HashMap::new();
        let mut middle = |a: usize, b: usize| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                points.push((points[a] + points[b]).normalize());
                points.len() - 1
            })
        };
        let mut finer = Vec::with_capacity(4 * faces.len());
        for [a, b, c] in faces {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        faces = finer;
    }
    (points, faces)
}
