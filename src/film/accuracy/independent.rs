//! The noise of all pixels, as if their passes were independent.

use super::weight;
use crate::film::brightness::Brightness;
use crate::trace::Measured;

/// The squared error of all pixels, were their passes independent.
pub(super) struct Independent {
    pub mean: f64,
    /// √Σt²/Σt of the pixels' parts t: how much it hangs on few of them.
    pub scatter: f64,
}

impl Independent {
    pub fn of(pixels: impl Iterator<Item = Measured>, picture: &Brightness, floor: f64) -> Independent {
        // Whole numbers: their sum is the same in any order.
        let (mut count, mut sum, mut squares) = (0u64, 0u128, 0u128);
        for pixel in pixels {
            let weight = weight(pixel.mean * picture.trusted(pixel.x, pixel.y, pixel.halves), floor);
            let t = (pixel.variance * weight).element_sum() / (3.0 * f64::from(pixel.passes));
            count += 1;
            sum += (t.min(MOST) * UNIT) as u128;
            squares += (t.min(MOST) * t.min(MOST) * UNIT) as u128;
        }
        let [sum, squares] = [sum, squares].map(|whole| whole as f64 / UNIT);
        let scatter = if sum > 0.0 { squares.sqrt() / sum } else { 0.0 };
        Independent { mean: sum / (count as f64).max(1.0), scatter }
    }
}

/// Steps of the sums in a squared error of 1, and the most that one pixel can have.
const UNIT: f64 = (1u64 << 62) as f64;
const MOST: f64 = 1e6;
