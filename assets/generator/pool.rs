//! The water of a swimming pool: a closed block with waves on top that focus the sun at its depth.

use glam::DVec3;

use super::mesh::Mesh;

/// Half of the width, m: a little more than that of the pool, whose walls hide its sides.
const HALF: f64 = 1.62;
/// How deep the block goes, m: below the floor of the pool.
const DEPTH: f64 = 1.25;
const CELLS: usize = 88;

/// Direction in degrees, wavelength, amplitude and phase of each wave. Curvatures add up to focal lengths
/// 4/(a·k²) of about the pool's depth.
const WAVES: [[f64; 4]; 6] = [
    [12.0, 0.97, 0.0100, 0.3],
    [-48.0, 0.71, 0.0075, 1.9],
    [77.0, 0.55, 0.0052, 4.0],
    [147.0, 0.43, 0.0034, 2.6],
    [-15.0, 0.36, 0.0022, 5.5],
    [104.0, 0.29, 0.0013, 0.9],
];

/// The water as a closed mesh, outward; its surface is about y = 0.
pub fn water() -> Mesh {
    let mut mesh = Mesh::new("water of a pool: closed, 3.24 m wide, waved about y = 0");
    mesh.normal_digits = 4;
    let side = CELLS + 1;
    for i in 0..side * side {
        let place = |step: usize| HALF * (2.0 * step as f64 / CELLS as f64 - 1.0);
        let (x, z) = (place(i % side), place(i / side));
        let [y, along_x, along_z] = surface(x, z);
        mesh.positions.push(DVec3::new(x, y, z));
        mesh.normals.push(DVec3::new(-along_x, 1.0, -along_z).normalize());
    }
    let at = |column: usize, row: usize| row * side + column;
    for row in 0..CELLS {
        for column in 0..CELLS {
            let [a, b] = [at(column, row), at(column + 1, row)];
            let [c, d] = [at(column, row + 1), at(column + 1, row + 1)];
            mesh.face([a, c, d]);
            mesh.face([a, d, b]);
        }
    }
    let rims: [(DVec3, Vec<usize>); 4] = [
        (DVec3::Z, (0..side).map(|i| at(i, CELLS)).collect()),
        (DVec3::X, (0..side).map(|i| at(CELLS, CELLS - i)).collect()),
        (DVec3::NEG_Z, (0..side).map(|i| at(CELLS - i, 0)).collect()),
        (DVec3::NEG_X, (0..side).map(|i| at(0, i)).collect()),
    ];
    let foot = mesh.positions.len();
    for (x, z) in [(-HALF, HALF), (HALF, HALF), (HALF, -HALF), (-HALF, -HALF)] {
        mesh.positions.push(DVec3::new(x, -DEPTH, z));
    }
    for (k, (normal, rim)) in rims.iter().enumerate() {
        let (from, to) = (foot + k, foot + (k + 1) % 4);
        let n = push_normal(&mut mesh, *normal);
        for pair in rim.windows(2) {
            mesh.corners([from, pair[1], pair[0]].map(|v| [v, 0, n]));
        }
        mesh.corners([from, to, rim[CELLS]].map(|v| [v, 0, n]));
    }
    let n = push_normal(&mut mesh, DVec3::NEG_Y);
    mesh.corners([foot, foot + 3, foot + 2].map(|v| [v, 0, n]));
    mesh.corners([foot, foot + 2, foot + 1].map(|v| [v, 0, n]));
    mesh
}

/// Height of the surface and its slopes along x and z.
fn surface(x: f64, z: f64) -> [f64; 3] {
    super::water::waves(0.0, &WAVES, x, z)
}

fn push_normal(mesh: &mut Mesh, normal: DVec3) -> usize {
    mesh.normals.push(normal);
    mesh.normals.len() - 1
}
