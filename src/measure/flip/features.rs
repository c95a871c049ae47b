//! FLIP's feature difference: edges and points of the achromatic channel, found by first and second
//! derivatives of a Gaussian. Section 4.2 of the paper.

use super::super::separable::convolve;
use super::{PIXELS_PER_DEGREE, radius};
use rayon::prelude::*;

/// Width of the features that the eye finds, in degrees.
const WIDTH: f64 = 0.082;

/// ΔE_f of two images' achromatic channels Yy, in [0, 1].
pub fn differences(image: &[f32], reference: &[f32], width: usize) -> Vec<f32> {
    let (image, reference) = (Features::of(image, width), Features::of(reference, width));
    (0..image.edges.len())
        .into_par_iter()
        .map(|i| {
            let edges = (image.edges[i] - reference.edges[i]).abs();
            let points = (image.points[i] - reference.points[i]).abs();
            // the exponent q_f is 1/2
            (edges.max(points) / std::f32::consts::SQRT_2).sqrt()
        })
        .collect()
}

/// How strong edges and points are at each pixel.
struct Features {
    edges: Vec<f32>,
    points: Vec<f32>,
}

impl Features {
    fn of(achromatic: &[f32], width: usize) -> Self {
        let grey: Vec<f32> = achromatic.par_iter().map(|y| (y + 16.0) / 116.0).collect();
        let sigma = 0.5 * WIDTH * PIXELS_PER_DEGREE;
        let gaussian = kernel(sigma, |_| 1.0);
        let strength = |derivative: &[f32]| -> Vec<f32> {
            let x = convolve(&grey, width, derivative, &gaussian);
            let y = convolve(&grey, width, &gaussian, derivative);
            x.par_iter().zip(&y).map(|(x, y)| (x * x + y * y).sqrt()).collect()
        };
        Features {
            edges: strength(&kernel(sigma, |x| -x)),
            points: strength(&kernel(sigma, |x| x * x / (sigma * sigma) - 1.0)),
        }
    }
}

/// `factor` times the Gaussian, positive weights scaled to a sum of 1 and negative ones to −1.
fn kernel(sigma: f64, factor: impl Fn(f64) -> f64) -> Vec<f32> {
    let radius = radius(sigma);
    let weight = |tap: i32| {
        let x = f64::from(tap);
        factor(x) * libm::exp(-x * x / (2.0 * sigma * sigma))
    };
    let weights: Vec<f64> = (-radius..=radius).map(weight).collect();
    let sum = |sign: f64| weights.iter().map(|w| (w * sign).max(0.0)).sum::<f64>();
    let (positive, negative) = (sum(1.0), sum(-1.0));
    weights.iter().map(|w| (w / if *w < 0.0 { negative } else { positive }) as f32).collect()
}
