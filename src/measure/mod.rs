//! Images and times compared: what accuracy costs, and what each effect does.

mod comparison;
mod difference;
mod display;
mod expected;
pub mod flip;
pub mod heat;
mod leave_out;
mod limits;
pub mod read;
mod relative;
mod separable;
pub mod study;
mod values;

pub use comparison::{
    Colour, CompareError, Comparison, HdrFlip, LayerDifference, Settings, compare_files, pairs,
};
pub use difference::{Difference, compare};
pub use expected::{Expected, expected};
pub use leave_out::{LeftOut, Prices, prices};
pub use limits::{Limits, Pixels, Verdict};
pub use relative::{EPSILON, FLOOR, Relative, TRIMMED, relative};
pub use values::{NonFinite, Place, Values};
