//! FLIP: how much a viewer who flips between two images sees of their difference, 0 to 1 a pixel.
//!
//! Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström & Fairchild, "FLIP: A Difference Evaluator for
//! Alternating Images", HPG 2020, for images as shown on a screen; Andersson, Nilsson, Shirley &
//! Akenine-Möller, "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics short papers 2021,
//! for light. Symbols and constants are the papers'. The viewer sits where a degree has 67 pixels: 0.7 m before
//! a screen of 3840 pixels on 0.7 m.

mod colour;
mod features;
mod hdr;

pub use hdr::{Exposures, exposures, hdr};

use rayon::prelude::*;
use serde::Serialize;

/// Linear light in [0, 1], Rec. 709.
pub type Planes = [Vec<f32>; 3];

/// Pixels a degree: 0.7 m · 3840/0.7 m · π/180.
pub const PIXELS_PER_DEGREE: f64 = 3840.0 * std::f64::consts::PI / 180.0;

/// A map in figures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Pooled {
    pub mean: f64,
    /// Quartiles of the map, each value weighted by itself.
    pub weighted_quartiles: [f64; 3],
    pub max: f64,
}

/// The map of the difference; values outside [0, 1] have no meaning to it. Rows have `width` values.
pub fn ldr(image: &Planes, reference: &Planes, width: usize) -> Vec<f32> {
    let (image, reference) = (colour::opponent(image), colour::opponent(reference));
    let features = features::differences(&image[0], &reference[0], width);
    let mut map = colour::differences(image, reference, width);
    map.par_iter_mut().zip(&features).for_each(|(colour, feature)| {
        *colour = libm::powf(*colour, 1.0 - feature);
    });
    map
}

/// Mean, quartiles and maximum of a map.
pub fn pool(map: &[f32]) -> Pooled {
    let mut sorted = map.to_vec();
    sorted.par_sort_unstable_by(f32::total_cmp);
    let total: f64 = sorted.iter().map(|value| f64::from(*value)).sum();
    let mut weighted_quartiles = [0.0; 3];
    let (mut sum, mut next) = (0.0, 0);
    for value in &sorted {
        sum += f64::from(*value);
        while next < 3 && total > 0.0 && sum >= total * (next + 1) as f64 / 4.0 {
            weighted_quartiles[next] = f64::from(*value);
            next += 1;
        }
    }
    let max = sorted.last().map_or(0.0, |value| f64::from(*value));
    Pooled { mean: total / sorted.len().max(1) as f64, weighted_quartiles, max }
}

/// Half-width of a Gaussian's kernel in pixels: three standard deviations.
fn radius(sigma: f64) -> i32 {
    (3.0 * sigma).ceil() as i32
}
