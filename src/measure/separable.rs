//! Convolution with a product of two one-dimensional kernels; beyond its edges an image goes on as at them.

use rayon::prelude::*;
use std::ops::{Add, Mul};

/// A number that images are filtered in.
pub trait Real: Copy + Default + Send + Sync + Add<Output = Self> + Mul<Output = Self> {}

impl Real for f32 {}
impl Real for f64 {}

/// Each value becomes the sum of `along_x`, then `along_y`, over its surroundings. Kernels have odd lengths.
pub fn convolve<T: Real>(image: &[T], width: usize, along_x: &[T], along_y: &[T]) -> Vec<T> {
    let rows = horizontal(image, width, along_x);
    vertical(&rows, width, along_y)
}

fn horizontal<T: Real>(image: &[T], width: usize, kernel: &[T]) -> Vec<T> {
    let radius = kernel.len() / 2;
    let mut out = vec![T::default(); image.len()];
    out.par_chunks_mut(width).zip(image.par_chunks(width)).for_each_init(Vec::new, |padded, (out, row)| {
        padded.clear();
        padded.resize(radius, row[0]);
        padded.extend_from_slice(row);
        padded.resize(width + 2 * radius, row[width - 1]);
        for (tap, weight) in kernel.iter().enumerate() {
            add(out, &padded[tap..tap + width], *weight);
        }
    });
    out
}

fn vertical<T: Real>(image: &[T], width: usize, kernel: &[T]) -> Vec<T> {
    let (radius, height) = (kernel.len() / 2, image.len() / width);
    let mut out = vec![T::default(); image.len()];
    out.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
        for (tap, weight) in kernel.iter().enumerate() {
            let from = (y + tap).saturating_sub(radius).min(height - 1) * width;
            add(out, &image[from..from + width], *weight);
        }
    });
    out
}

fn add<T: Real>(out: &mut [T], row: &[T], weight: T) {
    for (out, value) in out.iter_mut().zip(row) {
        *out = *out + *value * weight;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the sum over the whole square, at the edges too.
    #[test]
    fn two_passes_are_the_square_of_weights() {
        let (width, height) = (5, 4);
        let image: Vec<f64> = (0..20).map(|i| f64::from(i * 7 % 11)).collect();
        let (kx, ky) = ([0.5, -1.0, 2.0], [1.0, 3.0, 0.25, -2.0, 1.5]);
        let found = convolve(&image, width, &kx, &ky);
        for (i, found) in found.iter().enumerate() {
            let (x, y) = (i % width, i / width);
            let mut sum = 0.0;
            for (dy, wy) in ky.iter().enumerate() {
                for (dx, wx) in kx.iter().enumerate() {
                    let from = |at: usize, tap: usize, radius: usize, end: usize| {
                        (at + tap).saturating_sub(radius).min(end - 1)
                    };
                    sum += wx * wy * image[from(y, dy, 2, height) * width + from(x, dx, 1, width)];
                }
            }
            assert!((found - sum).abs() < 1e-12, "{i}: {found}, {sum}");
        }
    }
}
