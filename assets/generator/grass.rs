//! A tuft of grass: bent blades that taper to their tips.

use glam::{DVec2, DVec3};

use super::mesh::Mesh;
use super::random::Random;
use super::solid::turn;

const BLADES: usize = 18;
const PARTS: usize = 4;

/// The tuft: height 1, foot at the origin; u across a blade, v from foot to tip.
pub fn tuft(seed: u64) -> Mesh {
    let mut random = Random::new(seed);
    let mut mesh = Mesh::new("tuft of grass, height 1, foot at the origin");
    for blade in 0..BLADES {
        let (sin, cos) = turn(360.0 * blade as f64 / BLADES as f64 + random.within(-25.0, 25.0));
        let out = DVec3::new(sin, 0.0, cos);
        let (sin, cos) = turn(random.within(0.0, 360.0));
        let foot = DVec3::new(sin, 0.0, cos) * random.within(0.0, 0.13);
        let height = if blade == 0 { 1.0 } else { random.within(0.5, 0.98) };
        let bend = random.within(0.12, 0.62) * height;
        let width = random.within(0.028, 0.045);
        let twist = random.within(-0.5, 0.5);
        one(&mut mesh, foot, out, [height, bend, width, twist]);
    }
    mesh
}

fn one(mesh: &mut Mesh, foot: DVec3, out: DVec3, [height, bend, width, twist]: [f64; 4]) {
    let side = (out.cross(DVec3::Y) + out * twist).normalize();
    let mut ring = Vec::new();
    for part in 0..PARTS {
        let s = part as f64 / PARTS as f64;
        let at = foot + DVec3::Y * (height * (1.3 * s - 0.3 * s * s)) + out * (bend * s * s);
        let slope = DVec3::Y * (height * (1.3 - 0.6 * s)) + out * (2.0 * bend * s);
        let facing = side.cross(slope).normalize();
        let facing = if facing.y < 0.0 { -facing } else { facing };
        let half = side * (width * (1.0 - 0.75 * s * s) * 0.5);
        // Normals turned a little apart round the blade's rib.
        let left = mesh.vertex(at - half, DVec2::new(0.0, s), (facing - side * 0.4).normalize());
        let right = mesh.vertex(at + half, DVec2::new(1.0, s), (facing + side * 0.4).normalize());
        ring.push((left, right));
    }
    let top = foot + DVec3::Y * height + out * bend;
    let tip = mesh.vertex(top, DVec2::new(0.5, 1.0), (out + DVec3::Y * 0.5).normalize());
    for pair in ring.windows(2) {
        mesh.face([pair[0].0, pair[0].1, pair[1].1]);
        mesh.face([pair[0].0, pair[1].1, pair[1].0]);
    }
    let (left, right) = ring[PARTS - 1];
    mesh.face([left, right, tip]);
}
