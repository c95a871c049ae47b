//! A leaf that fills the image: midrib along v, side veins that sweep up, mottled green.

use super::super::image::{Image, hex, ramp};
use super::super::noise::{Noise, smoothstep};

/// The albedo in sRGB; v runs from stalk (bottom) to tip.
pub fn albedo(seed: u64) -> Image {
    Image::paint(256, |x, down| {
        let (v, away) = (1.0 - down, (x - 0.5).abs());
        let mottle = Noise::tiling(seed, 6, 6).fbm(x * 6.0, v * 6.0, 4);
        let bend = v - 0.75 * away + 0.35 * away * away;
        let side = (bend * 9.0 + 0.06 * mottle).rem_euclid(1.0);
        let vein = smoothstep(0.09, 0.02, (side - 0.5).abs()) * smoothstep(0.5, 0.1, away);
        let rib = smoothstep(0.022, 0.008, away);
        let tone = 0.45 + 0.35 * mottle + 0.25 * (v - 0.5);
        let green = ramp(&[0x2b4a14, 0x406a1d, 0x5a8428, 0x7a9a3a], tone);
        green.lerp(hex(0x9db45c), (0.55 * vein).max(0.85 * rib))
    })
}
