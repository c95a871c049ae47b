//! The terrain as a closed mesh: waved land on top, the dodecahedron's own faces at the sides and
//! below. Top coordinates are the plan, u = (x+1)/2 and v = (1−z)/2; the sides take theirs from a
//! corner of the same square that lies outside the plan, where the texture shows layers of soil.

use glam::{DVec2, DVec3};

use super::disc::{self, Disc};
use super::mesh::Mesh;
use super::solid::{Solid, normals};
use super::terrain::Terrain;

/// Inside the wall of glass (0.96 to 1), so that light meets the terrain from within glass.
pub const SCALE: f64 = 0.972;
/// Rows of the side; the widest place is one of the lines between them.
const ROWS: usize = 6;
const PIVOT: usize = 3;

/// The square of soil in the texture: u and v from here to 1.
pub const SOIL: f64 = 0.86;
/// What the soil square covers in height.
pub const SOIL_FROM: f64 = -0.80;
pub const SOIL_TO: f64 = 0.32;

/// The top of the terrain: its plan, heights and triangles.
pub struct Top {
    pub disc: Disc,
    pub positions: Vec<DVec3>,
}

/// The top as it is meshed; the carriers take their triangles from the same one.
pub fn top(terrain: &Terrain) -> Top {
    let (disc, hull) = (Disc { rings: 92 }, Solid::new(SCALE));
    let plan = disc.plan(|d| disc::rim(&hull, d, |x, z| terrain.height(x, z)));
    let positions = plan.iter().map(|&[x, z]| DVec3::new(x, terrain.height(x, z), z)).collect();
    Top { disc, positions }
}

/// The closed terrain.
pub fn solid(Top { disc, positions }: &Top) -> Mesh {
    let mut mesh = Mesh::new("terrain of the terrarium: closed, fills the bottom of the glass");
    mesh.coordinates = positions.iter().map(|p| DVec2::new(0.5 + 0.5 * p.x, 0.5 - 0.5 * p.z)).collect();
    mesh.positions.clone_from(positions);
    mesh.group("");
    for face in disc.faces() {
        mesh.face(face);
    }
    mesh.smooth();
    sides(&mut mesh, disc, &Solid::new(SCALE));
    mesh
}

/// Adds the sides below the rim and the floor.
fn sides(mesh: &mut Mesh, disc: &Disc, hull: &Solid) {
    let flat = mesh.normals.len();
    mesh.normals.extend(normals());
    let columns = disc.columns();
    // lines[k][j]: position and coordinate of line k (0 is the rim) in column j.
    let mut lines = vec![Vec::new(); ROWS + 1];
    for j in 0..columns {
        let direction = disc.direction(j);
        let rim = disc.index(disc.rings, j);
        let top = mesh.positions[rim].y;
        for (k, line) in lines.iter_mut().enumerate() {
            let y = side_height(k, top, hull.floor(), hull.widest(direction));
            let r = hull.radius(direction, y);
            let p = DVec3::new(r * direction.0, y, r * direction.1);
            let position = if k == 0 { rim } else { push(&mut mesh.positions, p) };
            line.push((position, push(&mut mesh.coordinates, soil(j, columns, y))));
        }
    }
    let centre = (push(&mut mesh.positions, DVec3::new(0.0, hull.floor(), 0.0)), mesh.coordinates.len());
    mesh.coordinates.push(DVec2::splat(0.5 + 0.5 * SOIL));
    for j in 0..columns {
        let next = (j + 1) % columns;
        let corner = |(v, t): (usize, usize), n: usize| [v, t, n];
        for rows in lines.windows(2) {
            let (a, b, c, d) = (rows[0][j], rows[0][next], rows[1][j], rows[1][next]);
            for face in [[a, c, d], [a, d, b]] {
                let middle = face.iter().map(|v| mesh.positions[v.0]).sum::<DVec3>() / 3.0;
                let n = flat + hull.side_normal(middle);
                mesh.corners(face.map(|v| corner(v, n)));
            }
        }
        mesh.corners([centre, lines[ROWS][next], lines[ROWS][j]].map(|v| corner(v, flat)));
    }
}

fn push<T>(list: &mut Vec<T>, value: T) -> usize {
    list.push(value);
    list.len() - 1
}

/// Height of side line `k`, of which line `PIVOT` follows the widest place where it can.
fn side_height(k: usize, top: f64, floor: f64, widest: f64) -> f64 {
    let height = top - floor;
    let pivot = widest.clamp(floor + 0.3 * height, top - 0.12 * height);
    match k {
        0..=PIVOT => top + (pivot - top) * k as f64 / PIVOT as f64,
        _ => pivot + (floor - pivot) * (k - PIVOT) as f64 / (ROWS - PIVOT) as f64,
    }
}

/// The side's coordinate: to and fro across the soil square with the direction, up with height.
fn soil(j: usize, columns: usize, y: f64) -> DVec2 {
    let sweep = 10.0 * j as f64 / columns as f64;
    let whole = sweep.floor();
    let to_and_fro = if whole as i64 % 2 == 0 { sweep - whole } else { 1.0 - (sweep - whole) };
    let up = ((y - SOIL_FROM) / (SOIL_TO - SOIL_FROM)).clamp(0.0, 1.0);
    let inset = |t: f64| SOIL + (1.0 - SOIL) * (0.06 + 0.88 * t);
    DVec2::new(inset(to_and_fro), inset(up))
}

/// Whether a point stands at least `margin` inside the cavity.
pub fn inside(p: DVec3, margin: f64) -> bool {
    Solid::new(super::solid::CAVITY).depth(p) >= margin
}
