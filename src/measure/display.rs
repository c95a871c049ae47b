//! Images as a screen shows them, and the metrics of those: PSNR and SSIM.
//!
//! Light is multiplied by 2^exposure, clamped to [0, 1] and encoded by the sRGB curve; it is not rounded to
//! integers. Values that are not finite are black. SSIM: Wang, Bovik, Sheikh & Simoncelli 2004, on the encoded
//! luminance, with their Gaussian of 11 × 11 and σ = 1.5, K₁ = 0.01, K₂ = 0.03, over the pixels whose window
//! lies within the image.

use super::relative::LUMINANCE;
use super::separable::convolve;
use crate::output::srgb;
use rayon::prelude::*;

/// Linear light in [0, 1] after exposure.
#[derive(Clone, Debug)]
pub struct Shown {
    pub width: usize,
    pub linear: [Vec<f32>; 3],
}

/// Cells of the sRGB curve between which PSNR goes straight: it departs by less than 5e-9 then.
const TABLE: usize = 1 << 18;

/// Edge of SSIM's window in pixels.
const WINDOW: usize = 11;

impl Shown {
    pub fn new(planes: [&[f32]; 3], width: usize, exposure_ev: f64) -> Self {
        let gain = libm::exp2(exposure_ev) as f32;
        let show = |value: &f32| if value.is_finite() { (value * gain).clamp(0.0, 1.0) } else { 0.0 };
        Shown { width, linear: planes.map(|plane| plane.par_iter().map(show).collect()) }
    }

    fn luma(&self) -> Vec<f64> {
        let [r, g, b] = &self.linear;
        let encoded = |i: usize| {
            let parts = [r[i], g[i], b[i]].into_iter().zip(LUMINANCE);
            let luminance = parts.map(|(c, weight)| f64::from(c) * weight).sum::<f64>();
            srgb::encode(luminance.min(1.0))
        };
        (0..r.len()).into_par_iter().map(encoded).collect()
    }
}

/// Peak signal-to-noise ratio of the encoded colours in decibels; infinite where they are the same.
pub fn psnr_db(image: &Shown, reference: &Shown) -> f64 {
    let count = 3 * image.linear[0].len();
    let table: Vec<f64> =
        (0..=TABLE + 1).into_par_iter().map(|i| srgb::encode(i as f64 / TABLE as f64)).collect();
    let encode = |linear: f32| {
        let at = f64::from(linear) * TABLE as f64;
        let (cell, part) = (at as usize, at - at.floor());
        table[cell] + part * (table[cell + 1] - table[cell])
    };
    let square = |(i, r): (&f32, &f32)| {
        let error = encode(*i) - encode(*r);
        error * error
    };
    let plane = |(a, r): (&Vec<f32>, &Vec<f32>)| -> f64 {
        let sums: Vec<f64> = a
            .par_chunks(image.width)
            .zip(r.par_chunks(image.width))
            .map(|(a, r)| a.iter().zip(r).map(square).sum())
            .collect();
        sums.iter().sum()
    };
    let mse = image.linear.iter().zip(&reference.linear).map(plane).sum::<f64>() / count as f64;
    -10.0 * libm::log10(mse)
}

/// Structural similarity, 1 where the images are the same; none of images smaller than 11 × 11.
pub fn ssim(image: &Shown, reference: &Shown) -> Option<f64> {
    let (width, height) = (image.width, image.linear[0].len() / image.width);
    if width < WINDOW || height < WINDOW {
        return None;
    }
    let kernel = gaussian();
    let blur = |values: &[f64]| convolve(values, width, &kernel, &kernel);
    let product = |a: &[f64], b: &[f64]| -> Vec<f64> { a.par_iter().zip(b).map(|(a, b)| a * b).collect() };
    let (x, y) = (image.luma(), reference.luma());
    let (mx, my) = (blur(&x), blur(&y));
    let (xx, yy, xy) = (blur(&product(&x, &x)), blur(&product(&y, &y)), blur(&product(&x, &y)));
    let (c1, c2) = (0.01 * 0.01, 0.03 * 0.03);
    let border = WINDOW / 2;
    let rows: Vec<f64> = (border..height - border)
        .into_par_iter()
        .map(|row| {
            (border..width - border)
                .map(|column| {
                    let i = row * width + column;
                    let (vx, vy) = (xx[i] - mx[i] * mx[i], yy[i] - my[i] * my[i]);
                    let covariance = xy[i] - mx[i] * my[i];
                    (2.0 * mx[i] * my[i] + c1) * (2.0 * covariance + c2)
                        / ((mx[i] * mx[i] + my[i] * my[i] + c1) * (vx + vy + c2))
                })
                .sum::<f64>()
        })
        .collect();
    Some(rows.iter().sum::<f64>() / ((width - 2 * border) * (height - 2 * border)) as f64)
}

fn gaussian() -> Vec<f64> {
    let radius = (WINDOW / 2) as f64;
    let weights: Vec<f64> = (0..WINDOW)
        .map(|tap| libm::exp(-(tap as f64 - radius) * (tap as f64 - radius) / (2.0 * 1.5 * 1.5)))
        .collect();
    let sum: f64 = weights.iter().sum();
    weights.iter().map(|weight| weight / sum).collect()
}
