//! Directions towards plane figures, uniform over the solid angle under which they are seen.

mod rectangle;
mod triangle;

pub use rectangle::Rectangle;
pub use triangle::{Triangle, sample_triangle_direction, triangle_direction_pdf};

use crate::math::DVec3;

/// A direction drawn towards something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionSample {
    /// Of unit length.
    pub dir: DVec3,
    /// In 1/sr.
    pub pdf: f64,
}
