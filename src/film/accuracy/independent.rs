//! The noise of all pixels, as if their passes were independent.

use super::weight;
use crate::film::brightness::Brightness;
use crate::trace::Measured;

/// A pixel's squared error, relative and averaged over channels, were its passes independent.
pub(super) fn relative(pixel: &Measured, picture: &Brightness, floor: f64) -> f64 {
    let trusted = picture.trusted(pixel.x, pixel.y, pixel.others, pixel.passes);
    (pixel.variance * weight(pixel.mean * trusted, floor)).element_sum() / (3.0 * f64::from(pixel.passes))
}

/// Sums of those, in whole numbers: they are the same in any order.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Independent {
    pub count: u64,
    sum: u128,
    squares: u128,
    /// Of pixels that a single pass has made more than half of.
    single: u128,
}

/// Steps of the sums in a squared error of 1, and the most that one pixel can have.
const UNIT: f64 = (1u64 << 62) as f64;
const MOST: f64 = 1e6;

impl Independent {
    pub fn add(&mut self, t: f64, single: bool) {
        self.count += 1;
        self.sum += (t.min(MOST) * UNIT) as u128;
        self.single += if single { (t.min(MOST) * UNIT) as u128 } else { 0 };
        self.squares += (t.min(MOST) * t.min(MOST) * UNIT) as u128;
    }

    pub fn sum(&self) -> f64 {
        self.sum as f64 / UNIT
    }

    pub fn single(&self) -> f64 {
        self.single as f64 / UNIT
    }

    pub fn squares(&self) -> f64 {
        self.squares as f64 / UNIT
    }
}
