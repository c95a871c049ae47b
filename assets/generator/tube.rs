//! Tapered tubes along a bent line: trunks and branches.

use glam::{DVec2, DVec3};

use super::mesh::Mesh;
use super::solid::turn;

/// A point of a tube's axis.
#[derive(Clone, Copy)]
pub struct Joint {
    pub at: DVec3,
    pub radius: f64,
}

/// Adds a tube with `sides` sides through `joints`, open at the foot, drawn to its last radius.
/// u goes once round, v is the length along the axis times `stretch`.
pub fn add(mesh: &mut Mesh, joints: &[Joint], sides: usize, stretch: f64) {
    let mut across = DVec3::ZERO;
    let mut rings = Vec::with_capacity(joints.len());
    let mut length = 0.0;
    for (i, joint) in joints.iter().enumerate() {
        let (before, after) = (joints[i.saturating_sub(1)].at, joints[(i + 1).min(joints.len() - 1)].at);
        let axis = (after - before).normalize();
        // The last ring's direction carried along, so that the tube does not twist.
        let carried = across - axis * across.dot(axis);
        across = if carried.length() > 1e-3 { carried.normalize() } else { axis.any_orthonormal_vector() };
        let other = axis.cross(across);
        if i > 0 {
            length += (joint.at - joints[i - 1].at).length();
        }
        let ring: Vec<usize> = (0..=sides)
            .map(|k| {
                let (sin, cos) = turn(360.0 * k as f64 / sides as f64);
                let out = across * cos + other * sin;
                let uv = DVec2::new(k as f64 / sides as f64, length * stretch);
                mesh.vertex(joint.at + out * joint.radius, uv, out)
            })
            .collect();
        rings.push(ring);
    }
    for pair in rings.windows(2) {
        for k in 0..sides {
            let (a, b, c, d) = (pair[0][k], pair[0][k + 1], pair[1][k], pair[1][k + 1]);
            mesh.face([a, b, d]);
            mesh.face([a, d, c]);
        }
    }
}
