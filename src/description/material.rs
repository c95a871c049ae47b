//! Materials: layered from the outside in, so that no values can gain energy.
//!
//! L = km·L_mirror + (1−km)·[ kt·(F·L_reflected + (1−F)·L_refracted) + (1−kt)·L_diffuse ] + highlight,
//! with km `reflection` and kt `transmission`.

use super::{Dispersion, Rgb, Source};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::borrow::Cow;
use std::fmt;

/// What a surface is made of. The default is black.
///
/// ```ron
/// materials: {
///     "table": (diffuse: texture("wood"), specular: 0.1, shininess: 80),
///     "lemonade": (transmission: 1, ior: "water", absorption: (0.5, 0.7, 3), priority: -1),
///     "lamp": (emission: (10, 9, 8)),
/// }
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Material {
    /// Albedo of the Lambert layer, 0 to 1.
    #[serde(skip_serializing_if = "Source::is_zero")]
    pub diffuse: Source,
    /// Weight of the normalised Phong highlight (n+2)/2π·cosⁿα, 0 to 1.
    #[serde(skip_serializing_if = "Source::is_zero")]
    pub specular: Source,
    /// Phong exponent n, 1 to 1e6. Without it: 50.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shininess: Option<f64>,
    /// Mirror weight km, 0 to 1.
    #[serde(skip_serializing_if = "Source::is_zero")]
    pub reflection: Source,
    /// Weight kt of the dielectric layer, 0 to 1.
    #[serde(skip_serializing_if = "Source::is_zero")]
    pub transmission: Source,
    /// Index of refraction, 0.05 to 10, or a name. Without it: 1.5.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ior: Option<Ior>,
    /// How `ior` depends on the wavelength; it does nothing without `transmission`. Without it: not at all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dispersion: Option<Dispersion>,
    /// Beer–Lambert absorption inside, per metre; it does nothing without `transmission`.
    #[serde(skip_serializing_if = "Rgb::is_zero")]
    pub absorption: Rgb,
    /// Of overlapping transmissive objects the one of higher priority counts (Schmidt & Budge 2002).
    #[serde(skip_serializing_if = "is_zero_priority")]
    pub priority: i32,
    /// Emitted radiance, W·m⁻²·sr⁻¹.
    #[serde(skip_serializing_if = "Source::is_zero")]
    pub emission: Source,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub normal_map: Option<NormalMap>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bump_map: Option<BumpMap>,
}

impl Material {
    /// The names of all textures that it uses.
    pub fn textures(&self) -> impl Iterator<Item = &str> {
        let maps = [
            self.normal_map.as_ref().map(|map| &map.texture),
            self.bump_map.as_ref().map(|map| &map.texture),
        ];
        self.colours().chain(maps.into_iter().flatten().map(String::as_str))
    }

    /// The names of those of its colours and weights.
    pub fn colours(&self) -> impl Iterator<Item = &str> {
        let weights = [&self.diffuse, &self.specular, &self.reflection, &self.transmission, &self.emission];
        weights.into_iter().filter_map(Source::texture).map(|t| t.name.as_str())
    }
}

fn is_zero_priority(p: &i32) -> bool {
    *p == 0
}

/// A tangent-space normal map: the texture's (r, g, b) in [0, 1] is the normal 2·(r, g, b) − 1, with r
/// along ∂p/∂u, g along ∂p/∂v and b along the surface normal. Its image is read as linear.
///
/// ```ron
/// materials: { "wall": (diffuse: 0.7, normal_map: (texture: "bricks", strength: 0.5)) }
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NormalMap {
    pub texture: String,
    /// Scales the tilt: 0 flat, 1 as drawn; 0 to 10.
    #[serde(default = "one")]
    pub strength: f64,
}

/// Blinn's bump map: the texture's luminance times `height_m` displaces the surface in thought.
///
/// ```ron
/// materials: { "wall": (diffuse: 0.7, bump_map: (texture: "bricks", height_m: 0.01)) }
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BumpMap {
    pub texture: String,
    /// Height of white above black, metres.
    pub height_m: f64,
}

fn one() -> f64 {
    1.0
}

/// An index of refraction, as a number or by name.
///
/// ```ron
/// materials: { "a": (transmission: 1, ior: 1.52), "b": (transmission: 1, ior: "diamond") }
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Ior {
    Number(f64),
    Name(String),
}

/// Indices of refraction by name, at the sodium D line (589 nm) near 20 °C.
pub const NAMED_IOR: &[(&str, f64)] = &[
    ("vacuum", 1.0),
    ("air", 1.000_277),
    ("ice", 1.31),
    ("water", 1.333),
    ("ethanol", 1.361),
    ("fused_quartz", 1.458),
    ("acrylic", 1.491),
    ("glass", 1.5),
    ("crown_glass", 1.517),
    ("amber", 1.546),
    ("flint_glass", 1.62),
    ("sapphire", 1.77),
    ("zircon", 1.923),
    ("diamond", 2.417),
];

impl<'de> Deserialize<'de> for Ior {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NumberOrName;
        impl Visitor<'_> for NumberOrName {
            type Value = Ior;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number or a name such as \"glass\"")
            }

            fn visit_f64<E: Error>(self, v: f64) -> Result<Ior, E> {
                Ok(Ior::Number(v))
            }

            fn visit_i64<E: Error>(self, v: i64) -> Result<Ior, E> {
                Ok(Ior::Number(v as f64))
            }

            fn visit_u64<E: Error>(self, v: u64) -> Result<Ior, E> {
                Ok(Ior::Number(v as f64))
            }

            fn visit_str<E: Error>(self, name: &str) -> Result<Ior, E> {
                Ok(Ior::Name(name.to_owned()))
            }
        }
        deserializer.deserialize_any(NumberOrName)
    }
}

impl JsonSchema for Ior {
    fn schema_name() -> Cow<'static, str> {
        "Ior".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let names: Vec<&str> = NAMED_IOR.iter().map(|(name, _)| *name).collect();
        schemars::json_schema!({ "anyOf": [
            { "type": "number", "exclusiveMinimum": 0.05, "exclusiveMaximum": 10 },
            { "type": "string", "enum": names }
        ] })
    }
}
