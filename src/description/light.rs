//! Lights by kind, each in its own unit.

use super::{ColorSpace, Rgb, Vector};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A light. Objects whose material has `emission` are lights too.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Light {
    /// Shines equally in all directions. `intensity` in W/sr.
    Point {
        position: Vector,
        intensity: Rgb,
        /// Classic attenuation 1/(c0 + c1·d + c2·d²) instead of 1/d², d in metres.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        falloff: Option<[f64; 3]>,
    },
    /// A point light within a cone around the direction to `target`. Full intensity within
    /// `inner_deg`, none outside `outer_deg` (angles from the axis), smooth between.
    Spot {
        position: Vector,
        target: Vector,
        intensity: Rgb,
        #[serde(default = "default_inner")]
        inner_deg: f64,
        #[serde(default = "default_outer")]
        outer_deg: f64,
    },
    /// Parallel light that travels along `direction`. `irradiance` in W·m⁻² on a surface that faces it.
    Directional { direction: Vector, irradiance: Rgb },
    /// A luminous sphere. `radiance` in W·m⁻²·sr⁻¹.
    Sphere {
        center: Vector,
        radius: f64,
        radiance: Rgb,
        /// Shadow rays a shading point; without it 1 for progressive antialiasing, else 16.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        samples: Option<u32>,
        /// Whether rays that start at the eye and have met nothing diffuse see it.
        #[serde(default = "yes")]
        visible: bool,
    },
    /// A luminous parallelogram corner + s·edge_u + t·edge_v, s, t in [0, 1]. Shines to the side of
    /// edge_u × edge_v; its back is black.
    Quad {
        corner: Vector,
        edge_u: Vector,
        edge_v: Vector,
        radiance: Rgb,
        #[serde(default)]
        two_sided: bool,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        samples: Option<u32>,
        #[serde(default = "yes")]
        visible: bool,
    },
    /// A luminous disk. Shines to the side of `normal`; its back is black.
    Disk {
        center: Vector,
        normal: Vector,
        radius: f64,
        radiance: Rgb,
        #[serde(default)]
        two_sided: bool,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        samples: Option<u32>,
        #[serde(default = "yes")]
        visible: bool,
    },
    /// Light from infinitely far all around. At most one a scene.
    Environment {
        map: EnvironmentMap,
        /// Factor on the map's radiance.
        #[serde(default = "one")]
        scale: f64,
        /// Turn about +y, degrees.
        #[serde(default)]
        turn_deg: f64,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        samples: Option<u32>,
        #[serde(default = "yes")]
        visible: bool,
    },
}

/// Radiance by direction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum EnvironmentMap {
    Constant(Rgb),
    /// Blends by the sine of the elevation: nadir (−1), horizon (0), zenith (1).
    Gradient {
        zenith: Rgb,
        horizon: Rgb,
        nadir: Rgb,
    },
    /// Equirectangular image (EXR or PNG or JPEG): the centre column looks along −z, up is +y.
    Image {
        path: String,
        #[serde(default)]
        color_space: ColorSpace,
    },
}

fn default_inner() -> f64 {
    25.0
}

fn default_outer() -> f64 {
    30.0
}

fn one() -> f64 {
    1.0
}

fn yes() -> bool {
    true
}
