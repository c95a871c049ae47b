//! A brick wall in running bond, 4 bricks by 12 courses: worn edges, chips, sandy mortar. Colours
//! and normals come from one relief. Tiles.

use glam::DVec3;

use super::super::image::{Image, Relief, hex, ramp};
use super::super::noise::{Noise, mix, smoothstep};
use super::super::random::{lattice, unit};

const SIZE: usize = 1024;
const ACROSS: i64 = 4;
const COURSES: i64 = 12;
/// Half the joint's width, in courses; a brick is 3 courses long.
const JOINT: f64 = 0.075;

/// The wall of a seed.
pub struct Wall {
    seed: u64,
}

/// What is at a place of the wall.
struct Spot {
    /// 0 in the mortar, 1 on the brick.
    brick: f64,
    /// Height over the mortar's ground, in courses.
    height: f64,
    id: u64,
    chip: f64,
    grain: f64,
}

/// A wall.
pub fn wall(seed: u64) -> Wall {
    Wall { seed }
}

impl Wall {
    fn spot(&self, x: f64, y: f64) -> Spot {
        let seed = self.seed;
        let courses = COURSES as f64;
        let fine = Noise::tiling(seed + 1, 96, 96).fbm(x * 96.0, y * 96.0, 3);
        let wave = Noise::tiling(seed + 2, 16, 16);
        let (wx, wy) = (wave.fbm(x * 16.0, y * 16.0, 2), wave.fbm(x * 16.0 + 7.5, y * 16.0 + 3.5, 2));
        // In courses: u along the wall, v across the courses.
        let v = y * courses + 0.025 * wy;
        let row = v.floor();
        let shift = if row as i64 % 2 == 0 { 0.0 } else { 1.5 };
        let u = x * courses + shift + 0.03 * wx;
        let column = (u / 3.0).floor();
        let id = lattice(seed, (column as i64).rem_euclid(ACROSS), (row as i64).rem_euclid(COURSES));
        let (along, up) = (u - 3.0 * column - 1.5, v - row - 0.5);
        let inside = |size: f64, at: f64| size - JOINT - at.abs();
        let slack = 0.03 * (unit(id) - 0.5);
        let (a, b) = (inside(1.5, along) + slack, inside(0.5, up + slack * 0.5));
        // Rounded corner: distance to the brick's edge.
        let r = 0.10;
        let (ca, cb) = ((r - a).max(0.0), (r - b).max(0.0));
        let edge =
            (if ca > 0.0 && cb > 0.0 { r - (ca * ca + cb * cb).sqrt() } else { a.min(b) }) + 0.018 * fine;
        let chip_noise = Noise::tiling(seed + 3, 40, 40).fbm(x * 40.0, y * 40.0, 3);
        let chip = smoothstep(0.16, 0.46, chip_noise - 1.3 * edge.max(0.0) + 0.05);
        let edge = edge - 0.06 * chip;
        let brick = smoothstep(-0.012, 0.012, edge);
        let face = 0.11 * smoothstep(-0.02, 0.07, edge) + 0.015 * fine + 0.02 * wx - 0.045 * chip;
        let pit = smoothstep(0.20, 0.08, Noise::tiling(seed + 4, 70, 70).cell(x * 70.0, y * 70.0).first);
        let tilt = 0.03 * (unit(id ^ 77) - 0.5) * along;
        let sand = |n: Noise| 0.022 * n.fbm(x * 96.0, y * 96.0, 2);
        let mortar = if brick < 1.0 { sand(Noise::tiling(seed + 5, 96, 96)) } else { 0.0 };
        let height = mix(mortar, face + tilt - 0.015 * pit * unit(id ^ 5), brick);
        Spot { brick, height, id, chip, grain: fine - 0.5 * pit }
    }

    /// The albedo in sRGB.
    pub fn albedo(&self) -> Image {
        let stain = Noise::tiling(self.seed + 6, 3, 3);
        let burnt = Noise::tiling(self.seed + 7, 9, 24);
        Image::paint(SIZE, |x, y| {
            let spot = self.spot(x, y);
            let own = unit(spot.id ^ 1);
            let base = ramp(&[0x64372b, 0x7f4634, 0x8d503c, 0x9a6049, 0x7d5548], unit(spot.id ^ 2));
            let dark = if own > 0.86 { 0.68 } else { 0.9 + 0.2 * own };
            let cloud = 1.0 + 0.16 * burnt.fbm(x * 9.0, y * 24.0, 3) + 0.13 * spot.grain;
            let brick = (base * dark * cloud).lerp(hex(0xb08a72) * cloud, 0.35 * spot.chip);
            let mortar = hex(0xa39a8c) * (0.88 + 0.35 * spot.height / 0.05 * 0.3 + 0.10 * spot.grain);
            let lime = smoothstep(0.25, 0.7, stain.fbm(x * 3.0, y * 3.0, 5));
            let colour = mortar.lerp(brick, spot.brick).lerp(DVec3::splat(0.72), 0.16 * lime);
            colour * (1.0 - 0.12 * smoothstep(0.1, 0.7, stain.fbm(x * 3.0 + 1.5, y * 3.0 + 0.5, 4)))
        })
    }

    /// The normals; the relief is about 0.11 of a course deep.
    pub fn normals(&self) -> Image {
        Relief::new(SIZE, |x, y| self.spot(x, y).height / COURSES as f64).normals()
    }
}
