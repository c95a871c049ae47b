//! What the terrain looks like from above: sand, grass, forest floor, layered rock and snow, in
//! the planar mapping of the terrain's top, with layers of soil in the upper right corner for the
//! terrain's sides. And the normals of what is too fine for the mesh.

use glam::DVec3;

use super::super::ground::{SOIL, SOIL_FROM, SOIL_TO};
use super::super::image::{Image, Relief, hex, ramp};
use super::super::noise::{Noise, mix, smoothstep};
use super::super::terrain::{Cover, Terrain};
use super::super::water::LEVEL;

const SIZE: usize = 1024;

/// The land's heights on the pixels.
pub struct Lie(Relief);

impl Lie {
    /// Samples the land.
    pub fn of(terrain: &Terrain) -> Self {
        Self(Relief::new(SIZE, |u, down| terrain.height(2.0 * u - 1.0, 2.0 * down - 1.0)))
    }

    /// Height, and upward component of the normal over four pixels, at a pixel.
    fn at(&self, u: f64, down: f64) -> [f64; 2] {
        let (x, y) = ((u * SIZE as f64) as usize + SIZE, (down * SIZE as f64) as usize + SIZE);
        // Four pixels are 8/SIZE of the plan, which is 2 wide.
        let slope = |a: f64, b: f64| (b - a) * SIZE as f64 / 8.0;
        let along_x = slope(self.0.at(x - 2, y), self.0.at(x + 2, y));
        let along_z = slope(self.0.at(x, y - 2), self.0.at(x, y + 2));
        [self.0.at(x, y), 1.0 / (1.0 + along_x * along_x + along_z * along_z).sqrt()]
    }
}

/// The albedo in sRGB.
pub fn albedo(terrain: &Terrain, lie: &Lie) -> Image {
    Image::paint(SIZE, |u, down| {
        if u > SOIL - 0.004 && down < 1.0 - SOIL + 0.004 {
            return soil((u - SOIL) / (1.0 - SOIL), 1.0 - down / (1.0 - SOIL));
        }
        let (x, z) = (2.0 * u - 1.0, 2.0 * down - 1.0);
        // Off the plan nothing is seen, and one colour packs well.
        if x * x + z * z > 1.02 { hex(0x5a5a3c) } else { ground(terrain, x, z, lie.at(u, down)) }
    })
}

fn ground(terrain: &Terrain, x: f64, z: f64, [y, up]: [f64; 2]) -> DVec3 {
    let Cover { rock, snow, sand, forest } = terrain.cover(x, z, y, up);
    let broad = Noise::new(801).fbm(x * 6.0, z * 6.0, 3);
    let fine = Noise::new(802).fbm(x * 45.0, z * 45.0, 3);
    let brook = terrain.brook(x, z);

    let grass = ramp(&[0x3d5a1e, 0x55752a, 0x74883a, 0x93974e], 0.42 + 0.45 * broad + 0.25 * fine);
    let floor = ramp(&[0x2c2a16, 0x3f3a20, 0x4c4a26], 0.5 + 0.5 * fine + 0.2 * broad);
    let wet = smoothstep(0.012, -0.006, y - LEVEL);
    let deep = smoothstep(0.0, 0.14, LEVEL - y);
    let dry_sand = ramp(&[0xa88f63, 0xc4ab7c, 0xd6c194], 0.5 + 0.35 * fine + 0.3 * broad);
    let wet_sand = dry_sand * mix(0.72, 0.45, deep) + hex(0x0c1a14) * deep;
    let layers = Noise::new(803).fbm(x * 4.0, z * 4.0, 3);
    let tilt = y + 0.12 * x + 0.05 * layers;
    let stratum = Noise::new(804).fbm(tilt * 34.0, 3.0 + 0.5 * layers, 3) * smoothstep(-0.7, 0.5, broad);
    let grit = Noise::new(805).ridged(x * 30.0, z * 30.0, 4) - 0.5;
    let stone = ramp(
        &[0x4b4640, 0x6a635a, 0x857b6e, 0x9c9181],
        0.5 + 0.42 * stratum + 0.20 * fine + 0.35 * grit - 0.30 * brook,
    );
    let white = ramp(&[0xd5dfea, 0xeef3f8, 0xfbfcfd], 0.6 + 0.3 * fine - 0.3 * brook);

    let mut colour = grass.lerp(floor, forest);
    colour = colour.lerp(hex(0x6b6140), 0.5 * brook * smoothstep(0.3, 0.0, forest));
    colour = colour.lerp(dry_sand.lerp(wet_sand, wet), sand);
    colour = colour.lerp(stone, rock);
    colour.lerp(white, snow)
}

/// Layers in the ground: `across` and `up` in 0 … 1 of the square.
fn soil(across: f64, up: f64) -> DVec3 {
    let y = mix(SOIL_FROM, SOIL_TO, (up - 0.06) / 0.88);
    let wave = 0.02 * Noise::new(811).fbm(across * 3.0, up * 1.5, 3);
    let fine = Noise::new(812).fbm(across * 26.0, up * 60.0, 3);
    let depth = y + wave;
    let layers = ramp(
        &[
            0x67615a, 0x8a8070, 0x6b5f50, 0xa08a66, 0xb39a6c, 0x7d6344, 0x93734e, 0x6a4f36, 0x56412c,
            0x6b6154, 0x6f675b, 0x5f574d, 0x7a7062, 0x696054,
        ],
        ((depth - SOIL_FROM) / (SOIL_TO - SOIL_FROM)).clamp(0.0, 1.0),
    );
    let pebbles = Noise::new(813).cell(across * 9.0, up * 22.0);
    let stone = smoothstep(0.30, 0.20, pebbles.first) * if pebbles.id.is_multiple_of(3) { 1.0 } else { 0.0 };
    layers * (1.0 + 0.22 * fine) * mix(1.0, 1.35, stone)
}

/// Normals of grain, tufts, cracks and ripples.
pub fn normals(terrain: &Terrain, lie: &Lie) -> Image {
    let relief = Relief::new(SIZE, |u, down| {
        let (x, z) = (2.0 * u - 1.0, 2.0 * down - 1.0);
        let soil = u > SOIL - 0.01 && down < 1.0 - SOIL + 0.01;
        if soil || x * x + z * z > 1.02 {
            return 0.0;
        }
        let [y, up] = lie.at(u, down);
        let Cover { rock, snow, sand, forest } = terrain.cover(x, z, y, up);
        let tufts = 0.0011 * Noise::new(821).fbm(x * 60.0, z * 60.0, 2);
        let ripple =
            0.0004 * libm::sin(90.0 * (x + 0.6 * z) + 5.0 * Noise::new(822).fbm(x * 5.0, z * 5.0, 2));
        let cracks = 0.0035 * Noise::new(823).ridged(x * 28.0, z * 28.0, 3);
        let drift = 0.0007 * Noise::new(824).fbm(x * 16.0, z * 16.0, 2);
        let meadow = tufts * (1.0 + 0.5 * forest);
        mix(mix(mix(meadow, ripple, sand), cracks, rock), drift, snow)
    });
    relief.normals()
}
