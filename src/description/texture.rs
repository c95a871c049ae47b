//! Textures: images and procedural patterns.
//!
//! Patterns of two colours go from `a` to `b`. Those with `squares` or `bricks` live in the surface's
//! (u, v); those with a size in metres are solid: they live in the object's own space.

use super::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Texture {
    /// A PNG, JPEG or EXR file; the path is relative to the scene file.
    ///
    /// ```ron
    /// textures: { "label": image(path: "label.png", color_space: srgb, wrap: clamp, uv: (scale: (2, 2))) }
    /// ```
    Image {
        path: String,
        #[serde(default)]
        color_space: ColorSpace,
        #[serde(default)]
        wrap: Wrap,
        #[serde(default)]
        uv: UvMapping,
    },
    /// Squares in (u, v); `squares` of them along u and along v in [0, 1].
    ///
    /// ```ron
    /// textures: { "floor": checker(a: 0.1, b: 0.8, squares: (8, 8)) }
    /// ```
    Checker { a: Rgb, b: Rgb, squares: [f64; 2] },
    /// Cubes of side `size_m` in object space.
    ///
    /// ```ron
    /// textures: { "blocks": checker3d(a: 0.1, b: 0.8, size_m: 0.25) }
    /// ```
    Checker3d { a: Rgb, b: Rgb, size_m: f64 },
    /// Fractal (fBm) gradient noise; `size_m` is the size of its largest features.
    ///
    /// ```ron
    /// textures: { "clouds": noise(a: (0.2, 0.4, 0.8), b: 1, size_m: 2, octaves: 6) }
    /// ```
    Noise {
        a: Rgb,
        b: Rgb,
        size_m: f64,
        #[serde(default = "default_octaves")]
        octaves: u32,
    },
    /// Veins: a sine along x, `size_m` apart, bent by noise.
    ///
    /// ```ron
    /// textures: { "marble": marble(a: 0.9, b: 0.3, size_m: 0.5) }
    /// ```
    Marble {
        a: Rgb,
        b: Rgb,
        size_m: f64,
        #[serde(default = "default_octaves")]
        octaves: u32,
    },
    /// Rings around the y axis, `ring_m` wide, bent by noise.
    ///
    /// ```ron
    /// textures: { "oak": wood(a: (0.5, 0.3, 0.15), b: (0.35, 0.2, 0.1), ring_m: 0.01) }
    /// ```
    Wood { a: Rgb, b: Rgb, ring_m: f64 },
    /// Running bond in (u, v): mortar `a`, bricks `b`; `bricks` of them along u and rows along v in
    /// [0, 1]; `mortar` is the joint's share of a row's height, 0 to 0.5. As a bump map its edges are bevelled.
    ///
    /// ```ron
    /// textures: { "wall": brick(a: 0.6, b: (0.5, 0.2, 0.1), bricks: (6, 12), mortar: 0.1) }
    /// ```
    Brick {
        a: Rgb,
        b: Rgb,
        bricks: [f64; 2],
        #[serde(default = "default_mortar")]
        mortar: f64,
    },
}

/// How the numbers of an image file are to be read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ColorSpace {
    /// EXR, and every image that only a normal or bump map names, is linear; PNG and JPEG are sRGB.
    #[default]
    Auto,
    Srgb,
    Linear,
}

/// What lies outside of [0, 1]².
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Wrap {
    #[default]
    Repeat,
    Clamp,
    Mirror,
}

/// Placement of an image in (u, v): first scaled, then moved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct UvMapping {
    /// Copies of the image along u and along v.
    pub scale: [f64; 2],
    pub offset: [f64; 2],
}

impl Default for UvMapping {
    fn default() -> Self {
        UvMapping { scale: [1.0, 1.0], offset: [0.0, 0.0] }
    }
}

fn default_octaves() -> u32 {
    5
}

fn default_mortar() -> f64 {
    0.1
}
