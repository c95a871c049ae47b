//! Plots: a drawing is a list of lines, dots and texts; it becomes SVG, or pixels for PNG.

mod chart;
mod font;
mod marks;
mod raster;
mod scale;
mod svg;

pub use chart::chart;
pub use marks::{Anchor, Colour, Drawing, Mark};
pub use raster::raster;
pub use scale::Scale;
pub use svg::{escaped, svg};
