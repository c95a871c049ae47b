//! Weathered stone for pebbles and cliffs: mottled, speckled, with thin cracks. Tiles.

use super::super::image::{Image, ramp};
use super::super::noise::{Noise, smoothstep};

/// The albedo in sRGB.
pub fn albedo(seed: u64) -> Image {
    Image::paint(512, |x, y| {
        let tiles = |offset: u64, n: i64| Noise::tiling(seed + offset, n, n);
        let warp = 0.12 * tiles(1, 4).fbm(x * 4.0, y * 4.0, 3);
        let mottle = tiles(2, 5).fbm(x * 5.0 + warp * 5.0, y * 5.0 + warp * 5.0, 5);
        let speck = tiles(3, 90).at(x * 90.0, y * 90.0);
        let cell = tiles(4, 6).cell(x * 6.0 + 0.5 * mottle, y * 6.0 + 0.5 * mottle);
        let crack = smoothstep(0.06, 0.0, cell.second - cell.first) * smoothstep(-0.2, 0.3, mottle);
        let vein = smoothstep(0.93, 0.99, 1.0 - tiles(5, 3).fbm(x * 3.0, y * 3.0 + warp, 4).abs());
        let tone = 0.5 + 0.34 * mottle + 0.13 * speck + 0.12 * vein;
        ramp(&[0x4a4744, 0x6b6762, 0x87827a, 0xa29b8f, 0xbdb6a8], tone) * (1.0 - 0.5 * crack)
    })
}
