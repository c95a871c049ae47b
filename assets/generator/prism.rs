//! A prism of glass: an equilateral triangle along z, with narrow bevels that catch the light.

use glam::{DVec2, DVec3};

use super::mesh::Mesh;

/// Distance of the bevels' edges from the sharp edge that they cut off.
const BEVEL: f64 = 0.012;
const HALF_LENGTH: f64 = 0.75;

/// Edges of 1 before they are bevelled, from z = −0.75 to 0.75; stands on y = 0 with the middle of its base at the origin.
pub fn equilateral() -> Mesh {
    let corners = [DVec2::new(-0.5, 0.0), DVec2::new(0.5, 0.0), DVec2::new(0.0, libm::sqrt(0.75))];
    let near = |from: DVec2, to: DVec2| from + (to - from) * BEVEL;
    // Anticlockwise, two to a corner.
    let outline: Vec<DVec2> = (0..3)
        .flat_map(|i| {
            let (before, here, after) = (corners[(i + 2) % 3], corners[i], corners[(i + 1) % 3]);
            [near(here, before), near(here, after)]
        })
        .collect();
    let mut mesh = Mesh::new("An equilateral prism with bevelled edges");
    mesh.normal_digits = 5;
    mesh.positions =
        [HALF_LENGTH, -HALF_LENGTH].iter().flat_map(|&z| outline.iter().map(move |p| p.extend(z))).collect();
    let n = outline.len();
    for i in 0..n {
        let next = (i + 1) % n;
        let side = outline[next] - outline[i];
        flat(&mut mesh, &[i, n + i, n + next, next], DVec3::new(side.y, -side.x, 0.0).normalize());
    }
    let front: Vec<usize> = (0..n).collect();
    let back: Vec<usize> = (n..2 * n).rev().collect();
    flat(&mut mesh, &front, DVec3::Z);
    flat(&mut mesh, &back, DVec3::NEG_Z);
    mesh
}

/// A convex face of vertices that are anticlockwise as seen from where its normal points.
fn flat(mesh: &mut Mesh, corners: &[usize], normal: DVec3) {
    let n = mesh.normals.len();
    mesh.normals.push(normal);
    for i in 2..corners.len() {
        mesh.corners([corners[0], corners[i - 1], corners[i]].map(|p| [p, 0, n]));
    }
}
