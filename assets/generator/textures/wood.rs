//! Table planks: growth rings of five boards cut lengthwise, pores, and dark joints. Tiles.

use super::super::image::{Image, ramp};
use super::super::noise::{Noise, mix, smoothstep};
use super::super::random::{lattice, unit};

const PLANKS: i64 = 5;

/// Planks along x; the image is one length of five boards.
pub fn planks(seed: u64) -> Image {
    Image::paint(1024, |x, y| {
        let row = (y * PLANKS as f64).floor();
        let across = y * PLANKS as f64 - row;
        let board = seed + 100 * row as u64;
        let own = |i: i64| unit(lattice(board, i, 0));
        // The trunk's axis against the board: it wanders along the length, and that draws arches.
        let bend = Noise::tiling(board + 1, 2, 8).fbm(x * 2.0 + own(1), across * 0.4 + 3.0, 2);
        let wobble = Noise::tiling(board + 2, 5, 64).fbm(x * 5.0, across * 2.2, 3);
        let cloud = Noise::tiling(board + 5, 3, 64).fbm(x * 3.0, across * 1.3, 3);
        let side = across - 0.2 - 0.6 * own(2) + 0.10 * bend + 0.035 * wobble;
        let depth = 0.10 + 0.35 * own(3) + 0.34 * bend;
        let ring =
            (side * side + depth * depth * 0.5).sqrt() * (17.0 + 9.0 * own(4)) + 0.45 * wobble + 0.35 * cloud;
        let phase = ring - ring.floor();
        // Early wood pale and wide, late wood dark and sharp on its outer side.
        let late = smoothstep(0.15, 0.86, phase) * smoothstep(1.0, 0.93, phase);
        let fibre = Noise::tiling(board + 3, 12, 4096).fbm(x * 12.0, across * 60.0, 3);
        let streak = Noise::tiling(board + 6, 3, 4096).fbm(x * 3.0, across * 38.0, 3);
        let pores = smoothstep(0.42, 0.75, Noise::tiling(board + 4, 26, 4096).at(x * 26.0, across * 75.0));
        let tone = 0.62 + 0.22 * (own(5) - 0.5) - 0.20 * late * (0.75 + 0.5 * cloud)
            + 0.11 * fibre
            + 0.10 * streak
            + 0.10 * cloud
            - 0.17 * pores;
        let colour = ramp(&[0x3a2112, 0x61391d, 0x8a572e, 0xad7844, 0xc4945c], tone);
        let warm = glam::DVec3::new(1.0, 0.97 + 0.06 * own(6), 0.93 + 0.12 * own(7));
        let gap = across.min(1.0 - across) + 0.002 * wobble;
        let joint = smoothstep(0.004, 0.016, gap) * mix(0.82, 1.0, smoothstep(0.01, 0.05, gap));
        colour * warm * mix(0.13, 1.0, joint)
    })
}
