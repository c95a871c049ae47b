//! A normal map of raised domes in cells that sunken grooves part: bumps whose shading shows from
//! which side the light comes. Tiles.

use super::super::image::{Image, Relief};
use super::super::noise::smoothstep;

const CELLS: f64 = 6.0;

/// The normals.
pub fn normals() -> Image {
    Relief::new(512, |x, y| {
        let (dx, dy) = ((x * CELLS).rem_euclid(1.0) - 0.5, (y * CELLS).rem_euclid(1.0) - 0.5);
        let square = (dx * dx + dy * dy) / (0.33 * 0.33);
        // A spherical cap of half-angle 60° at its foot, without the kink there.
        let dome =
            if square < 1.0 { (1.0 / 0.75 - square).sqrt() - (1.0_f64 / 0.75 - 1.0).sqrt() } else { 0.0 };
        let groove = smoothstep(0.0, 0.07, 0.5 - dx.abs().max(dy.abs()));
        (0.24 * dome + 0.05 * groove) / CELLS
    })
    .normals()
}
