//! The camera: a pinhole or a thin lens.

use super::Vector;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A perspective camera at `eye` that looks at `target`.
///
/// ```ron
/// camera: (eye: (0, 3, 6.5), target: (0, 0.8, 0), fov_deg: 40, aperture_m: 0.02, focus_m: 6)
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Camera {
    pub eye: Vector,
    pub target: Vector,
    #[serde(default = "default_up")]
    pub up: Vector,
    /// Vertical field of view in degrees, above 0 and below 180.
    #[serde(default = "default_fov")]
    pub fov_deg: f64,
    /// Diameter of the lens in metres; 0 is a pinhole.
    #[serde(default)]
    pub aperture_m: f64,
    /// Distance of the sharp plane from the eye, along the view direction, in metres.
    /// Without it: the distance of `target`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub focus_m: Option<f64>,
}

fn default_up() -> Vector {
    [0.0, 1.0, 0.0]
}

fn default_fov() -> f64 {
    45.0
}
