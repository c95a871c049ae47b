//! The lake's water: a closed solid over the whole plan of the glass (the terrain hides what is
//! under land), with a gently waved top.

use glam::{DVec2, DVec3};

use super::disc::{self, Disc};
use super::mesh::Mesh;
use super::solid::{Solid, normals};

/// The mean height of the surface.
pub const LEVEL: f64 = -0.36;
/// Inside the wall, and inside the terrain's side, so that no two surfaces coincide.
const SCALE: f64 = 0.968;

/// Direction in degrees, wavelength, amplitude and phase of each wave.
const WAVES: [[f64; 4]; 5] = [
    [20.0, 0.31, 0.0034, 0.4],
    [71.0, 0.23, 0.0029, 2.1],
    [-34.0, 0.17, 0.0027, 4.4],
    [118.0, 0.112, 0.0019, 1.3],
    [5.0, 0.083, 0.0013, 3.0],
];

/// Height of the surface and its slopes along x and z.
pub fn surface(x: f64, z: f64) -> [f64; 3] {
    waves(LEVEL, &WAVES, x, z)
}

/// The same of any waves, each by its direction in degrees, length, amplitude and phase.
pub fn waves(level: f64, waves: &[[f64; 4]], x: f64, z: f64) -> [f64; 3] {
    let mut result = [level, 0.0, 0.0];
    for &[degrees, wavelength, amplitude, phase] in waves {
        let (sin, cos) = super::solid::turn(degrees);
        let k = std::f64::consts::TAU / wavelength;
        let (wave, slope) = libm::sincos(k * (x * sin + z * cos) + phase);
        result[0] += amplitude * wave;
        result[1] += amplitude * k * sin * slope;
        result[2] += amplitude * k * cos * slope;
    }
    result
}

/// The water as a closed mesh, outward.
pub fn solid() -> Mesh {
    let (disc, hull) = (Disc { rings: 54 }, Solid::new(SCALE));
    let mut mesh = Mesh::new("water of the terrarium: closed, top waved about y = -0.36");
    mesh.normal_digits = 5;
    mesh.group("");
    for [x, z] in disc.plan(|d| disc::rim(&hull, d, |x, z| surface(x, z)[0])) {
        let [y, along_x, along_z] = surface(x, z);
        let normal = DVec3::new(-along_x, 1.0, -along_z).normalize();
        mesh.vertex(DVec3::new(x, y, z), DVec2::new(0.5 + 0.5 * x, 0.5 - 0.5 * z), normal);
    }
    for face in disc.faces() {
        mesh.face(face);
    }
    let flat = mesh.normals.len();
    mesh.normals.extend(normals());
    let (columns, foot) = (disc.columns(), mesh.positions.len());
    for j in 0..columns {
        let direction = disc.direction(j);
        let r = hull.radius(direction, hull.floor());
        mesh.positions.push(DVec3::new(r * direction.0, hull.floor(), r * direction.1));
        mesh.coordinates.push(DVec2::new(0.5 + 0.5 * r * direction.0, 0.5 - 0.5 * r * direction.1));
    }
    let centre = mesh.positions.len();
    mesh.positions.push(DVec3::new(0.0, hull.floor(), 0.0));
    mesh.coordinates.push(DVec2::new(0.5, 0.5));
    for j in 0..columns {
        let (a, b) = (disc.index(disc.rings, j), disc.index(disc.rings, j + 1));
        let (c, d) = (foot + j, foot + (j + 1) % columns);
        let side = flat
            + hull.side_normal(
                0.25 * (mesh.positions[a] + mesh.positions[b] + mesh.positions[c] + mesh.positions[d]),
            );
        mesh.corners([[a, a, side], [c, c, side], [d, d, side]]);
        mesh.corners([[a, a, side], [d, d, side], [b, b, side]]);
        mesh.corners([[centre, centre, flat], [d, d, flat], [c, c, flat]]);
    }
    mesh
}
