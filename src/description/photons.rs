//! How light that glass, water and mirrors focus is found, and whether light bounces between diffuse
//! surfaces.

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::fmt;

/// The photon map of caustics. Nothing needs to be set: what is left out is chosen by the scene.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Photons {
    /// Each pass has a map of its own and a smaller radius, so that the mean converges to the truth
    /// (Knaus & Zwicker 2011).
    ///
    /// ```ron
    /// photons: progressive(count: 200000, k: 30)
    /// ```
    Progressive {
        /// Photons sent out a pass, 1 to 1e8. Without it: as many as the image has pixels, from 50 000 to 400 000.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        count: Option<u32>,
        /// Photons that the first pass's radius holds on average, 2 to 10000.
        #[serde(default = "first_k")]
        k: u32,
        /// How slowly the radius shrinks: 0 to 1, both excluded. 2/3 is best in the long run.
        #[serde(default = "alpha")]
        alpha: f64,
        #[serde(default)]
        kernel: Kernel,
        /// The largest radius, metres. Without it: by the size of what focuses light.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        max_radius_m: Option<f64>,
    },
    /// One map for all passes, and the k photons nearest to each point: blurred at any count.
    ///
    /// ```ron
    /// photons: classic(count: 1000000, k: 100)
    /// ```
    Classic {
        /// Photons sent out, 1 to 1e8.
        count: u32,
        /// Photons of each estimate, 2 to 10000.
        k: u32,
        #[serde(default)]
        kernel: Kernel,
        /// The largest radius, metres. Without it: by the size of what focuses light.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        max_radius_m: Option<f64>,
    },
    /// No photons: glass and mirrors cast plain shadows.
    ///
    /// ```ron
    /// photons: off
    /// ```
    Off,
}

impl Photons {
    /// Of [`Photons::Progressive`].
    pub const FIRST_K: u32 = 30;
    pub const ALPHA: f64 = 2.0 / 3.0;

    pub fn is_default(&self) -> bool {
        *self == Photons::default()
    }
}

impl Default for Photons {
    fn default() -> Self {
        Photons::Progressive {
            count: None,
            k: Photons::FIRST_K,
            alpha: Photons::ALPHA,
            kernel: Kernel::default(),
            max_radius_m: None,
        }
    }
}

fn first_k() -> u32 {
    Photons::FIRST_K
}

fn alpha() -> f64 {
    Photons::ALPHA
}

/// How photons weigh by their distance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Kernel {
    /// All alike.
    ///
    /// ```ron
    /// photons: progressive(kernel: disc)
    /// ```
    Disc,
    /// 1 − d/(1.1·r) (Jensen 2001).
    ///
    /// ```ron
    /// photons: classic(count: 200000, k: 60, kernel: cone)
    /// ```
    Cone,
    /// 1 − (d/r)².
    ///
    /// ```ron
    /// photons: progressive(kernel: epanechnikov)
    /// ```
    #[default]
    Epanechnikov,
}

/// Light between diffuse surfaces: `true`, `false`, or the most bounces.
///
/// ```ron
/// indirect: true
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Indirect {
    #[default]
    Off,
    /// As many bounces as matter.
    On,
    /// At most so many, 1 to 10000.
    Bounces(u32),
}

/// How indirect light is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum IndirectBy {
    /// By photons where most of the light stays in the scene, as in rooms; by paths in the open.
    #[default]
    Auto,
    /// A photon map of what diffuse surfaces send on, gathered where the camera looks.
    ///
    /// ```ron
    /// indirect: true, indirect_by: photons
    /// ```
    Photons,
    /// Camera paths go on from diffuse surfaces.
    ///
    /// ```ron
    /// indirect: true, indirect_by: paths
    /// ```
    Paths,
}

impl IndirectBy {
    pub fn is_default(&self) -> bool {
        *self == IndirectBy::Auto
    }
}

impl Indirect {
    pub fn is_off(&self) -> bool {
        *self == Indirect::Off
    }
}

impl Serialize for Indirect {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Indirect::Off => serializer.serialize_bool(false),
            Indirect::On => serializer.serialize_bool(true),
            Indirect::Bounces(n) => serializer.serialize_u32(*n),
        }
    }
}

impl<'de> Deserialize<'de> for Indirect {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct BoolOrNumber;
        impl Visitor<'_> for BoolOrNumber {
            type Value = Indirect;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("true, false or a number of bounces")
            }

            fn visit_bool<E: Error>(self, on: bool) -> Result<Indirect, E> {
                Ok(if on { Indirect::On } else { Indirect::Off })
            }

            fn visit_f64<E: Error>(self, n: f64) -> Result<Indirect, E> {
                let whole = n.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&n);
                if whole {
                    self.visit_u64(n as u64)
                } else {
                    Err(E::custom(format!("{n} is no number of bounces")))
                }
            }

            fn visit_u64<E: Error>(self, n: u64) -> Result<Indirect, E> {
                Ok(Indirect::Bounces(u32::try_from(n).unwrap_or(u32::MAX)))
            }

            fn visit_i64<E: Error>(self, n: i64) -> Result<Indirect, E> {
                u64::try_from(n)
                    .map_err(|_| E::custom(format!("{n} bounces: a number of bounces is 1 or more")))
                    .and_then(|n| self.visit_u64(n))
            }
        }
        deserializer.deserialize_any(BoolOrNumber)
    }
}

impl JsonSchema for Indirect {
    fn schema_name() -> Cow<'static, str> {
        "Indirect".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        schemars::json_schema!({ "anyOf": [
            { "type": "boolean" },
            { "type": "integer", "minimum": 1, "maximum": 10000 }
        ] })
    }
}
