//! Placement of objects: a list of steps, applied first to last.

use super::Vector;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Transform {
    Translate(Vector),
    /// One factor, or one an axis. Negative factors mirror; zero is refused.
    Scale(Scale),
    /// Right-handed turn by `deg` degrees about `axis` through the origin.
    Rotate {
        axis: Vector,
        deg: f64,
    },
    /// An affine matrix, three rows of four numbers.
    Matrix([[f64; 4]; 3]),
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Scale {
    Uniform(f64),
    PerAxis(Vector),
}
