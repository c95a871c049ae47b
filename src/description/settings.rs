//! Image size and exposure, antialiasing, and how much is rendered.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The image. Width and height in pixels, 1 to [`Image::MAX_SIDE`].
///
/// ```ron
/// image: (width: 1920, height: 1080, exposure_ev: 0.5, png_bits: 16)
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Image {
    pub width: u32,
    pub height: u32,
    /// Exposure of PNG output in stops: radiance is multiplied by 2^exposure_ev before the sRGB curve.
    /// EXR output is never scaled.
    pub exposure_ev: f64,
    /// Bits a PNG channel: 8 or 16.
    pub png_bits: u8,
}

impl Image {
    /// The largest width and height, 2²⁰.
    pub const MAX_SIDE: u32 = 1 << 20;
}

impl Default for Image {
    fn default() -> Self {
        Image { width: 800, height: 600, exposure_ev: 0.0, png_bits: 8 }
    }
}

/// Where in a pixel its samples lie.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Antialiasing {
    /// One sample at the pixel's centre.
    ///
    /// ```ron
    /// antialiasing: none
    /// ```
    None,
    /// n × n samples on a regular grid; n from 1 to 64.
    ///
    /// ```ron
    /// antialiasing: grid(3)
    /// ```
    Grid(u32),
    /// Corner subdivision where neighbouring corners differ.
    ///
    /// ```ron
    /// antialiasing: adaptive(threshold: 0.05, depth: 3)
    /// ```
    Adaptive {
        /// A cell is divided where its relative contrast, (max − min) / (max + min + 2·floor) in any channel, times
        /// its share of the pixel is above this; 0 to 1.
        #[serde(default = "default_threshold")]
        threshold: f64,
        /// Subdivisions at most: a pixel is never divided finer than 2^depth × 2^depth; 1 to 8.
        #[serde(default = "default_depth")]
        depth: u32,
    },
    /// One well-distributed sample a pixel and pass.
    ///
    /// ```ron
    /// antialiasing: progressive
    /// ```
    #[default]
    Progressive,
}

fn default_threshold() -> f64 {
    0.1
}

fn default_depth() -> u32 {
    2
}

/// How much is rendered.
///
/// ```ron
/// render: (passes: 256, seed: 1, max_depth: 64)
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Render {
    /// Independent passes whose mean is the image. Without it: 64 for progressive antialiasing, else 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub passes: Option<u32>,
    /// Wall seconds of the whole process after which the render ends, above 0. Without it: no limit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_s: Option<f64>,
    /// Relative RMS error of the picture at which the render ends, such as 0.02 for 2 %; above 0. Needs
    /// progressive antialiasing. Without it: no limit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<f64>,
    /// Seed of every random value.
    pub seed: u64,
    /// Specular events in a row after which a path is cut (and counted as cut); 1 to 10000.
    pub max_depth: u32,
}

impl Default for Render {
    fn default() -> Self {
        Render { passes: None, time_s: None, error: None, seed: 0, max_depth: 32 }
    }
}
