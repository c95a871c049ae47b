//! Bark: fissured plates for oak and pine, and the white bark of birches. Both tile.

use super::super::image::{Image, hex, ramp};
use super::super::noise::{Noise, smoothstep};

/// Upright plates between dark fissures, in sRGB.
pub fn albedo(seed: u64) -> Image {
    Image::paint(512, |x, y| {
        let bend = Noise::tiling(seed + 1, 4, 4).fbm(x * 4.0, y * 4.0, 3);
        let plates = Noise::tiling(seed + 2, 11, 4).cell(x * 11.0 + 0.8 * bend, y * 4.0 + 0.3 * bend);
        let fissure = smoothstep(0.0, 0.22, plates.second - plates.first);
        let fibre = Noise::tiling(seed + 3, 40, 6).fbm(x * 40.0 + 2.0 * bend, y * 6.0, 3);
        let own = super::super::random::unit(plates.id);
        let tone = 0.12 + 0.55 * fissure + 0.22 * fibre + 0.16 * (own - 0.5);
        ramp(&[0x1f160f, 0x3d2d20, 0x5f4936, 0x7d6550, 0x95806a], tone)
    })
}

/// White bark with dark, lying marks, in sRGB.
pub fn birch(seed: u64) -> Image {
    Image::paint(512, |x, y| {
        let paper = Noise::tiling(seed + 1, 4, 10).fbm(x * 4.0, y * 10.0, 4);
        let marks = Noise::tiling(seed + 2, 5, 30).cell(x * 5.0, y * 30.0 + 0.3 * paper);
        let own = super::super::random::unit(marks.id ^ 3);
        let mark = smoothstep(0.34, 0.16, marks.first) * smoothstep(0.35, 0.5, own);
        let line = smoothstep(0.35, 0.8, Noise::tiling(seed + 3, 6, 64).fbm(x * 6.0, y * 64.0, 2));
        let scar = smoothstep(0.42, 0.66, Noise::tiling(seed + 4, 3, 3).fbm(x * 3.0, y * 3.0, 4));
        let white = ramp(&[0xb3aca0, 0xd3cdc2, 0xe9e5dc], 0.55 + 0.45 * paper);
        white.lerp(hex(0x2b2622), (0.9 * mark).max(0.35 * line).max(0.85 * scar))
    })
}
