//! The lie of the land as functions of the plan (x, z): a lake in the front right, its shore, a
//! meadow in the middle and on the left, ridged mountains at the back. Mesh (`ground.rs`),
//! carriers (`carriers.rs`) and textures (`textures/land.rs`) all read it here.

use super::erosion::{self, Grid};
use super::noise::{Noise, mix, smoothstep};
use super::random::Random;
use super::water::LEVEL;

/// The highest summit.
pub const SUMMIT: f64 = 0.25;

/// x, z, height and radius of each mountain.
const MOUNTAINS: [[f64; 4]; 6] = [
    [-0.08, -0.46, 0.66, 0.30],
    [0.36, -0.44, 0.50, 0.25],
    [-0.48, -0.34, 0.38, 0.22],
    [0.66, -0.30, 0.22, 0.17],
    [0.12, -0.70, 0.34, 0.22],
    [-0.74, -0.14, 0.14, 0.15],
];

/// The finished land.
pub struct Terrain {
    heights: Grid,
    brooks: Grid,
    seed: u64,
}

/// What covers a place, as weights from 0 to 1.
pub struct Cover {
    /// Bare rock, over everything but snow.
    pub rock: f64,
    pub snow: f64,
    /// Sand of shore and lake bed.
    pub sand: f64,
    /// Forest floor, over the meadow.
    pub forest: f64,
}

impl Terrain {
    /// Raises and erodes the land of a seed.
    pub fn new(seed: u64) -> Self {
        let mut heights = Grid::new(385, |x, z| raised(seed, x, z));
        let mut random = Random::new(seed);
        erosion::crumble(&mut heights, 30, 1.25);
        let passed = erosion::rain(&mut heights, 90_000, LEVEL - 0.002, &mut random);
        erosion::crumble(&mut heights, 10, 1.35);
        let top = heights.cells.iter().fold(f64::MIN, |top, &h| top.max(h));
        let foot = -0.25;
        for height in &mut heights.cells {
            if *height > foot {
                *height = foot + (*height - foot) * (SUMMIT - foot) / (top - foot);
            }
        }
        Self { heights, brooks: erosion::brooks(passed), seed }
    }

    /// Height of the ground.
    pub fn height(&self, x: f64, z: f64) -> f64 {
        let broad = self.heights.at(x, z);
        let rough = smoothstep(-0.27, -0.1, broad);
        let crags = Noise::new(self.seed + 40).ridged(x * 15.0, z * 15.0, 3) - 0.55;
        let bumps = Noise::new(self.seed + 41).fbm(x * 22.0, z * 22.0, 2);
        broad + 0.016 * rough * crags + 0.0012 * bumps * smoothstep(LEVEL, LEVEL + 0.04, broad)
    }

    /// How strongly brooks ran here, 0 to 1.
    pub fn brook(&self, x: f64, z: f64) -> f64 {
        self.brooks.at(x, z)
    }

    /// What grows or lies at a place of height `y` and upward normal component `up`.
    pub fn cover(&self, x: f64, z: f64, y: f64, up: f64) -> Cover {
        let rag = Noise::new(self.seed + 50).fbm(x * 18.0, z * 18.0, 4);
        let woods = Noise::new(self.seed + 51).fbm(x * 3.2 + 5.0, z * 3.2, 3);
        let high = smoothstep(-0.16, -0.04, y + 0.05 * rag);
        let steep = smoothstep(0.86, 0.74, up + 0.06 * rag);
        let line = -0.055 + 0.06 * rag + 0.13 * smoothstep(0.80, 0.50, up);
        Cover {
            rock: smoothstep(-0.01, 0.02, y - LEVEL)
                * steep.max(high * smoothstep(0.97, 0.88, up + 0.05 * rag)),
            snow: smoothstep(line - 0.02, line + 0.02, y) * smoothstep(0.32, 0.46, up + 0.12 * rag),
            sand: smoothstep(0.022, 0.012, y - LEVEL + 0.010 * rag),
            forest: smoothstep(-0.05, 0.12, woods + 0.9 * smoothstep(-0.31, -0.20, y) - 0.42)
                * smoothstep(0.04, 0.07, y - LEVEL),
        }
    }
}

/// The land before erosion.
fn raised(seed: u64, x: f64, z: f64) -> f64 {
    let warp = Noise::new(seed + 1);
    let wx = x + 0.07 * warp.fbm(x * 2.6, z * 2.6, 4);
    let wz = z + 0.07 * warp.fbm(x * 2.6 + 31.0, z * 2.6 + 17.0, 4);
    let hills = Noise::new(seed + 2).fbm(x * 3.5, z * 3.5, 4);
    let s = shore(wx, wz);
    let land = LEVEL + if s > 0.0 { 0.09 * s + 0.022 * smoothstep(0.0, 0.10, s) } else { bed(-s) };
    let inland = smoothstep(0.05, 0.35, s);
    let left = 0.05 * smoothstep(-0.35, -0.75, wx) * inland;
    land + 0.035 * inland * hills + left + mountains(seed, wx, wz)
}

/// About the distance to the shoreline; negative over the lake.
fn shore(x: f64, z: f64) -> f64 {
    let oval = |cx: f64, cz: f64, rx: f64, rz: f64| {
        let (px, pz) = ((x - cx) / rx, (z - cz) / rz);
        ((px * px + pz * pz).sqrt() - 1.0) * 0.5 * (rx + rz)
    };
    let lake = oval(0.30, 0.42, 0.50, 0.34);
    let bay = oval(-0.06, 0.20, 0.20, 0.12);
    let blend = smoothstep(-0.12, 0.12, lake - bay);
    let water = mix(lake, bay, blend) - 0.12 * blend * (1.0 - blend);
    water.max(-oval(0.36, 0.33, 0.10, 0.065))
}

/// Height against the water level at distance `d` into the lake.
fn bed(d: f64) -> f64 {
    -0.22 * d - 0.11 * smoothstep(0.0, 0.22, d)
}

fn mountains(seed: u64, x: f64, z: f64) -> f64 {
    let mut envelope = 0.0_f64;
    for [cx, cz, height, radius] in MOUNTAINS {
        let square = ((x - cx) * (x - cx) + (z - cz) * (z - cz)) / (radius * radius);
        let bell = height * 1.25 * libm::exp(-1.25 * square.sqrt()).min(0.8);
        // A soft maximum keeps passes between neighbours without adding their heights up.
        envelope = (envelope * envelope + bell * bell).sqrt();
    }
    let crest = Noise::new(seed + 3).ridged(x * 3.4 + 2.0, z * 3.4, 6);
    envelope * (0.42 + 0.78 * crest) - 0.02 * smoothstep(0.0, 0.1, envelope)
}
