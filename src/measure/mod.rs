//! Images and times compared: what accuracy costs, and what each effect does.

mod difference;
mod leave_out;

pub use difference::{Difference, compare};
pub use leave_out::{LeftOut, Prices, prices};
