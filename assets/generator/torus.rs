//! A coarse torus, which shows what smooth shading does.

use glam::DVec3;

use super::mesh::Mesh;
use super::solid::turn;

/// Around the axis, and around the tube.
const SIDES: [usize; 2] = [14, 8];
/// Of the circle in the middle of the tube, and of the tube.
const RADII: [f64; 2] = [0.5, 0.22];

/// About +y, closed, without normals: they are the mesh's own, flat or smooth as a scene asks.
pub fn coarse() -> Mesh {
    let mut mesh = Mesh::new("A coarse torus: 14 by 8 quads of two triangles, radii 0.5 and 0.22 about +y");
    let [around, across] = SIDES;
    for i in 0..around {
        let (sin, cos) = turn(360.0 * i as f64 / around as f64);
        for k in 0..across {
            let (up, out) = turn(360.0 * k as f64 / across as f64);
            let r = RADII[0] + RADII[1] * out;
            mesh.positions.push(DVec3::new(r * cos, RADII[1] * up, -r * sin));
        }
    }
    let at = |i: usize, k: usize| i % around * across + k % across;
    for i in 0..around {
        for k in 0..across {
            let corners = [at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)].map(|p| [p, 0, 0]);
            mesh.corners([corners[0], corners[1], corners[2]]);
            mesh.corners([corners[0], corners[2], corners[3]]);
        }
    }
    mesh
}
