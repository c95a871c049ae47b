//! Solids of revolution: a wine glass, the wine in it, and a lens. Profiles are radius and height,
//! from the axis below around the outside to the axis above (or, for the glass, inside the bowl).

use glam::{DVec2, DVec3};

use super::mesh::Mesh;

const SEGMENTS: usize = 60;

/// Height of the wine's surface in the wine glass, in its own unit.
const LEVEL: f64 = 1.36;

/// A tulip glass with a wall of 0.014; the unit is 0.1 m. Stands on y = 0, 2.06 high.
pub fn wine_glass() -> Mesh {
    let mut profile = vec![DVec2::new(0.0, 0.0), DVec2::new(0.325, 0.0)];
    profile.extend(curve(
        &[
            [0.345, 0.005],
            [0.356, 0.018],
            [0.340, 0.032],
            [0.220, 0.052],
            [0.100, 0.090],
            [0.055, 0.160],
            [0.042, 0.300],
            [0.040, 0.550],
            [0.048, 0.740],
            [0.090, 0.850],
            [0.200, 0.940],
            [0.320, 1.060],
            [0.395, 1.250],
            [0.410, 1.420],
            [0.390, 1.650],
            [0.355, 1.880],
            [0.330, 2.050],
            [0.323, 2.060],
            [0.316, 2.050],
            [0.341, 1.880],
            [0.376, 1.650],
            [0.396, 1.420],
            [0.381, 1.250],
            [0.306, 1.075],
            [0.190, 0.962],
            [0.085, 0.905],
            [0.000, 0.890],
        ],
        5,
    ));
    turned("wine glass, closed, wall 0.014, 2.06 high: unit 0.1 m", &profile)
}

/// Wine up to `LEVEL`: its side runs within the glass's wall, so that no gap is left.
pub fn wine() -> Mesh {
    let mut profile = curve(
        &[
            [0.000, 0.883],
            [0.088, 0.898],
            [0.194, 0.956],
            [0.311, 1.070],
            [0.3875, 1.250],
            [0.401, 1.335],
            [0.4025, LEVEL - 0.001],
        ],
        5,
    );
    profile.extend([0.402, 0.2, 0.0].map(|r| DVec2::new(r, LEVEL)));
    turned("wine for the wine glass, closed: unit 0.1 m", &profile)
}

/// A lens of radius 1 with two equal spherical faces and an edge 0.06 thick; the axis is y.
pub fn lens() -> Mesh {
    const BEND: f64 = 2.6;
    const EDGE: f64 = 0.03;
    const RINGS: usize = 14;
    let sag = |r: f64| libm::sqrt(BEND * BEND - r * r) - libm::sqrt(BEND * BEND - 1.0);
    let below = (0..=RINGS).map(|i| i as f64 / RINGS as f64).map(|r| DVec2::new(r, -EDGE - sag(r)));
    let above = (0..=RINGS).rev().map(|i| i as f64 / RINGS as f64).map(|r| DVec2::new(r, EDGE + sag(r)));
    let profile: Vec<DVec2> = below.chain(above).collect();
    let mut mesh = turned("lens, closed, radius 1, axis y", &profile);
    // The faces' own normals: the edge between them is sharp, and hidden by a frame.
    let drop = libm::sqrt(BEND * BEND - 1.0) - EDGE;
    mesh.normals = mesh.positions.iter().map(|p| (*p + DVec3::Y * drop.copysign(p.y)).normalize()).collect();
    mesh.normal_digits = 5;
    mesh
}

/// A smooth curve through points (Catmull and Rom), each span cut in `pieces`.
fn curve(points: &[[f64; 2]], pieces: usize) -> Vec<DVec2> {
    let at = |i: usize| DVec2::from_array(points[i.min(points.len() - 1)]);
    let mut result = Vec::new();
    for i in 0..points.len() - 1 {
        let (before, from, to, after) = (at(i.saturating_sub(1)), at(i), at(i + 1), at(i + 2));
        for piece in 0..pieces {
            let t = piece as f64 / pieces as f64;
            let (along_from, along_to) = (0.5 * (to - before), 0.5 * (after - from));
            let (t2, t3) = (t * t, t * t * t);
            result.push(
                from * (2.0 * t3 - 3.0 * t2 + 1.0)
                    + along_from * (t3 - 2.0 * t2 + t)
                    + to * (3.0 * t2 - 2.0 * t3)
                    + along_to * (t3 - t2),
            );
        }
    }
    result.push(at(points.len() - 1));
    result
}

/// Turns a profile about y; its first and last points are on the axis. Without normals: readers average them.
fn turned(title: &'static str, profile: &[DVec2]) -> Mesh {
    let mut mesh = Mesh::new(title);
    let inner = &profile[1..profile.len() - 1];
    let foot = push(&mut mesh, DVec3::Y * profile[0].y);
    for p in inner {
        for j in 0..SEGMENTS {
            let (sin, cos) = super::solid::turn(360.0 * j as f64 / SEGMENTS as f64);
            push(&mut mesh, DVec3::new(p.x * sin, p.y, p.x * cos));
        }
    }
    let head = push(&mut mesh, DVec3::Y * profile[profile.len() - 1].y);
    let at = |i: usize, j: usize| 1 + i * SEGMENTS + j % SEGMENTS;
    for j in 0..SEGMENTS {
        mesh.face([foot, at(0, j + 1), at(0, j)]);
        for i in 0..inner.len() - 1 {
            mesh.face([at(i, j), at(i, j + 1), at(i + 1, j + 1)]);
            mesh.face([at(i, j), at(i + 1, j + 1), at(i + 1, j)]);
        }
        mesh.face([at(inner.len() - 1, j), at(inner.len() - 1, j + 1), head]);
    }
    mesh
}

fn push(mesh: &mut Mesh, p: DVec3) -> usize {
    mesh.positions.push(p);
    mesh.positions.len() - 1
}
