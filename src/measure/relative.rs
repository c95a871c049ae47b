//! Errors of light relative to the light that is there.
//!
//! relMSE = mean((I−R)²/(R²+ε)), ε = 0.01: Rousselle, Knaus & Zwicker 2011. E = √ mean((I−R)²/(R²+0.31·m²)),
//! m the reference's mean luminance, is √relMSE of the images exposed to a mean of 0.18: it does not depend on
//! a scene's brightness. Both run over pixels and channels. MAPE = mean(|I−R|/(|R|+ε)).

use super::values::CHUNK;
use rayon::prelude::*;
use serde::Serialize;

/// Rec. 709.
pub const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// ε of relMSE and MAPE.
pub const EPSILON: f64 = 0.01;

/// ε of E, in squares of the reference's mean luminance: 0.01/0.18².
pub const FLOOR: f64 = 0.31;

/// Share of pixels, the worst, that the trimmed figures leave out.
pub const TRIMMED: f64 = 0.001;

/// Errors of a colour layer; NaN where no pixel is finite.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Relative {
    /// relMSE, nothing left out.
    pub rel_mse: f64,
    /// relMSE without the worst 0.1 % of pixels, by their own mean over channels.
    pub rel_mse_trimmed: f64,
    /// E, as a fraction: 0.01 is 1 %.
    pub relative_rms: f64,
    /// MAPE, as a fraction.
    pub mape: f64,
    /// Mean luminance of the image over that of the reference; NaN where the reference is black and the
    /// image is not.
    pub mean_ratio: f64,
}

/// Planes of one length; pixels that are not finite in both are left out.
///
/// # Panics
/// If the lengths differ.
pub fn relative(image: [&[f32]; 3], reference: [&[f32]; 3]) -> Relative {
    let pixels = reference[0].len();
    let planes = image.iter().chain(&reference);
    assert!(planes.clone().all(|plane| plane.len() == pixels), "planes of one image have one length");
    let chunks = || {
        (0..pixels.div_ceil(CHUNK))
            .into_par_iter()
            .map(move |chunk| chunk * CHUNK..((chunk + 1) * CHUNK).min(pixels))
    };
    let at = |planes: &[&[f32]; 3], i: usize| planes.map(|plane| f64::from(plane[i]));
    let finite = |i: &[f64; 3], r: &[f64; 3]| i.iter().chain(r).all(|value| value.is_finite());
    let luminance = |c: [f64; 3]| c.iter().zip(LUMINANCE).map(|(c, weight)| c * weight).sum::<f64>();

    let sums: Vec<[f64; 3]> = chunks()
        .map(|range| {
            let mut sums = [0.0; 3];
            for p in range {
                let (i, r) = (at(&image, p), at(&reference, p));
                if finite(&i, &r) {
                    sums = [sums[0] + luminance(i), sums[1] + luminance(r), sums[2] + 1.0];
                }
            }
            sums
        })
        .collect();
    let [of_image, of_reference, count] = total(&sums);
    let mean = of_reference / count;
    let floor = FLOOR * mean * mean;

    let parts: Vec<([f64; 3], Vec<f64>)> = chunks()
        .map(|range| {
            let (mut sums, mut errors) = ([0.0; 3], Vec::with_capacity(range.len()));
            for p in range {
                let (i, r) = (at(&image, p), at(&reference, p));
                if finite(&i, &r) {
                    let [squares, exposed, absolute] = pixel(i, r, floor);
                    sums = [sums[0] + squares, sums[1] + exposed, sums[2] + absolute];
                    errors.push(squares);
                }
            }
            (sums, errors)
        })
        .collect();
    let sums: Vec<[f64; 3]> = parts.iter().map(|(sums, _)| *sums).collect();
    let [squares, exposed, absolute] = total(&sums).map(|sum| sum / count);
    let mut errors: Vec<f64> = parts.into_iter().flat_map(|(_, errors)| errors).collect();
    Relative {
        rel_mse: squares,
        rel_mse_trimmed: trimmed(&mut errors),
        relative_rms: exposed.sqrt(),
        mape: absolute,
        mean_ratio: if of_image == of_reference { 1.0 } else { ratio(of_image, of_reference) },
    }
}

/// A pixel's means over channels: of (I−R)²/(R²+ε), of (I−R)²/(R²+floor), of |I−R|/(|R|+ε).
fn pixel(image: [f64; 3], reference: [f64; 3], floor: f64) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for (i, r) in image.into_iter().zip(reference) {
        let error = (i - r).abs();
        let square = error * error;
        sums[0] += square / (r * r + EPSILON) / 3.0;
        // 0 beside 0 is no error, though the reference is black and there is no floor
        sums[1] += if square == 0.0 { 0.0 } else { square / (r * r + floor) / 3.0 };
        sums[2] += error / (r.abs() + EPSILON) / 3.0;
    }
    sums
}

fn ratio(a: f64, b: f64) -> f64 {
    if b == 0.0 { f64::NAN } else { a / b }
}

fn total(parts: &[[f64; 3]]) -> [f64; 3] {
    parts.iter().fold([0.0; 3], |sum, part| [0, 1, 2].map(|k| sum[k] + part[k]))
}

/// The mean without the largest 0.1 %; at least one is kept. Which of equal ones go does not matter.
fn trimmed(errors: &mut [f64]) -> f64 {
    let kept = ((errors.len() as f64 * (1.0 - TRIMMED)).round_ties_even() as usize).max(1);
    if errors.is_empty() {
        return f64::NAN;
    }
    let (below, last, _) = errors.select_nth_unstable_by(kept - 1, f64::total_cmp);
    let last = *last;
    // summed by size, so that the sum does not depend on the order that the selection leaves
    below.par_sort_unstable_by(f64::total_cmp);
    (below.iter().sum::<f64>() + last) / kept as f64
}
