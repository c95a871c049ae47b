//! A photographer's sweep: a floor that bends up into a wall, so that no horizon shows.

use glam::{DVec2, DVec3};

use super::mesh::Mesh;

const HALF_WIDTH: f64 = 10.0;
const FRONT: f64 = 9.0;
/// Where the floor begins to bend, and the radius of the bend.
const BACK: f64 = -2.5;
const BEND: f64 = 2.0;
const TOP: f64 = 7.0;
const STEPS: usize = 24;

/// In metres, open, seen from the front; texture coordinates are metres along x and along the profile.
pub fn sweep() -> Mesh {
    let mut mesh = Mesh::new("sweep: a floor from z = 9 that bends up at z = -2.5, in metres");
    mesh.normal_digits = 5;
    let arc = BEND * std::f64::consts::FRAC_PI_2;
    let mut profile = vec![(DVec2::new(FRONT, 0.0), DVec2::Y, 0.0)];
    for step in 0..=STEPS {
        let (sin, cos) = super::solid::turn(90.0 * step as f64 / STEPS as f64);
        let along = FRONT - BACK + arc * step as f64 / STEPS as f64;
        profile.push((DVec2::new(BACK - BEND * sin, BEND - BEND * cos), DVec2::new(sin, cos), along));
    }
    profile.push((DVec2::new(BACK - BEND, TOP), DVec2::X, FRONT - BACK + arc + TOP - BEND));
    for (p, normal, along) in &profile {
        for x in [-HALF_WIDTH, HALF_WIDTH] {
            mesh.vertex(DVec3::new(x, p.y, p.x), DVec2::new(x, *along), DVec3::new(0.0, normal.y, normal.x));
        }
    }
    for i in (0..profile.len() - 1).map(|i| 2 * i) {
        mesh.face([i, i + 1, i + 3]);
        mesh.face([i, i + 3, i + 2]);
    }
    mesh
}
