//! The parts of the terrain's top that plants and stones are scattered over: the terrain's own
//! triangles, so that what is scattered stands on the ground, chosen by height, slope and cover,
//! and far enough from the glass for what shall grow there.

use glam::{DVec2, DVec3};

use super::ground::{self, Top};
use super::mesh::Mesh;
use super::terrain::{Cover, Terrain};
use super::water::LEVEL;

/// Where grass grows: land of little slope above the beach, not under dense forest. A tuft of
/// height 0.04 stays inside the glass.
pub fn meadow(terrain: &Terrain, top: &Top) -> Mesh {
    part(terrain, top, "meadow: carrier for grass", 0.05, 0.012, |cover, above, up| {
        above > 0.018
            && above < 0.22
            && up > 0.86
            && cover.forest < 0.75
            && cover.rock < 0.4
            && cover.sand < 0.3
    })
}

/// Where trees grow: the foot of the mountains and the woods of the meadow. A tree of height 0.17
/// and crown radius 0.05 stays inside the glass.
pub fn forest(terrain: &Terrain, top: &Top) -> Mesh {
    part(terrain, top, "forest: carrier for trees", 0.17, 0.05, |cover, above, up| {
        above > 0.045
            && above < 0.33
            && up > 0.72
            && cover.forest > 0.5
            && cover.snow < 0.1
            && cover.rock < 0.7
    })
}

/// Where pebbles lie: the strip of sand at the shore, a little into the water.
pub fn beach(terrain: &Terrain, top: &Top) -> Mesh {
    part(terrain, top, "beach: carrier for pebbles", 0.01, 0.01, |cover, above, up| {
        above > -0.02 && above < 0.03 && up > 0.85 && cover.sand > 0.4
    })
}

/// The triangles whose middle satisfies `keep(cover, height above the water, upward normal)` and
/// stands `margin` inside the cavity, as does the point `tall` above it.
fn part(
    terrain: &Terrain,
    Top { disc, positions }: &Top,
    title: &'static str,
    tall: f64,
    margin: f64,
    keep: impl Fn(&Cover, f64, f64) -> bool,
) -> Mesh {
    let mut mesh = Mesh::new(title);
    let mut renamed = vec![usize::MAX; positions.len()];
    for face in disc.faces() {
        let corners = face.map(|i| positions[i]);
        let middle = corners.iter().sum::<DVec3>() / 3.0;
        let up = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize().y;
        let cover = terrain.cover(middle.x, middle.z, middle.y, up);
        let room = ground::inside(middle, margin) && ground::inside(middle + tall * DVec3::Y, margin);
        if !room || !keep(&cover, middle.y - LEVEL, up) {
            continue;
        }
        let face = face.map(|i| {
            if renamed[i] == usize::MAX {
                let p = positions[i];
                let plan = DVec2::new(0.5 + 0.5 * p.x, 0.5 - 0.5 * p.z);
                renamed[i] = mesh.vertex(p, plan, DVec3::Y);
            }
            renamed[i]
        });
        mesh.face(face);
    }
    mesh.smooth();
    mesh.coordinates.clear();
    mesh
}
