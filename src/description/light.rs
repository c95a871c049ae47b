//! Lights by kind, each in its own unit.

use super::{ColorSpace, Rgb, Vector};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A light. Objects whose material has `emission` are lights too.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Light {
    /// Shines equally in all directions. `intensity` in W/sr.
    ///
    /// ```ron
    /// lights: { "bulb": point(position: (0, 3, 0), intensity: 10, falloff: (1, 0, 0.1)) }
    /// ```
    Point {
        position: Vector,
        intensity: Rgb,
        /// Classic attenuation 1/(c0 + c1·d + c2·d²) instead of 1/d², d in metres.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        falloff: Option<[f64; 3]>,
    },
    /// A point light within a cone around the direction to `target`. Full intensity within
    /// `inner_deg`, none outside `outer_deg` (angles from the axis), smooth between.
    ///
    /// ```ron
    /// lights: { "stage": spot(position: (0, 3, 0), target: (0, 0, 0), intensity: 30, inner_deg: 10, outer_deg: 15) }
    /// ```
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
    ///
    /// ```ron
    /// lights: { "sun": directional(direction: (0.3, -1, 0), irradiance: (3, 2.9, 2.7)) }
    /// ```
    Directional { direction: Vector, irradiance: Rgb },
    /// A luminous sphere. `radiance` in W·m⁻²·sr⁻¹.
    ///
    /// ```ron
    /// lights: { "globe": sphere(center: (-3, 5, -2), radius: 0.4, radiance: 60) }
    /// ```
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
    ///
    /// ```ron
    /// lights: { "panel": quad(corner: (-1, 3, -1), edge_u: (2, 0, 0), edge_v: (0, 0, 2), radiance: 5) }
    /// ```
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
    ///
    /// ```ron
    /// lights: { "spotlight": disk(center: (0, 3, 0), normal: (0, -1, 0), radius: 0.5, radiance: 5, two_sided: true) }
    /// ```
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
    ///
    /// ```ron
    /// lights: { "sky": environment(map: constant((0.5, 0.7, 1)), scale: 2, turn_deg: 90) }
    /// ```
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

impl Light {
    /// Whether it sends nothing, as far as the scene says: an image may be black as well.
    pub fn is_black(&self) -> bool {
        match self {
            Light::Point { intensity, .. } | Light::Spot { intensity, .. } => intensity.is_zero(),
            Light::Directional { irradiance, .. } => irradiance.is_zero(),
            Light::Sphere { radiance, .. } | Light::Quad { radiance, .. } | Light::Disk { radiance, .. } => {
                radiance.is_zero()
            }
            Light::Environment { scale, map, .. } => *scale == 0.0 || map.is_black(),
        }
    }
}

impl EnvironmentMap {
    fn is_black(&self) -> bool {
        match self {
            EnvironmentMap::Constant(colour) => colour.is_zero(),
            EnvironmentMap::Gradient { zenith, horizon, nadir } => {
                zenith.is_zero() && horizon.is_zero() && nadir.is_zero()
            }
            EnvironmentMap::Image { .. } => false,
        }
    }
}

/// Radiance by direction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum EnvironmentMap {
    /// The same from everywhere.
    ///
    /// ```ron
    /// lights: { "sky": environment(map: constant(1)) }
    /// ```
    Constant(Rgb),
    /// Blends by the sine of the elevation: nadir (−1), horizon (0), zenith (1).
    ///
    /// ```ron
    /// lights: { "sky": environment(map: gradient(zenith: (0.2, 0.4, 1), horizon: 1, nadir: 0.1)) }
    /// ```
    Gradient { zenith: Rgb, horizon: Rgb, nadir: Rgb },
    /// Equirectangular image (EXR or PNG or JPEG): the centre column looks along −z, up is +y.
    ///
    /// ```ron
    /// lights: { "sky": environment(map: image(path: "sky.exr")) }
    /// ```
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
