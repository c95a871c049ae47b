//! Leaf values: vectors, colours, and weights that a texture may drive.

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{EnumAccess, Error, MapAccess, SeqAccess, VariantAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::fmt;

/// x, y, z.
pub type Vector = [f64; 3];

/// A linear Rec. 709 colour: a number is grey, three numbers are red, green and blue.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rgb(pub [f64; 3]);

impl Rgb {
    pub const fn grey(value: f64) -> Rgb {
        Rgb([value; 3])
    }

    pub fn is_zero(&self) -> bool {
        self.0 == [0.0; 3]
    }

    fn is_grey(&self) -> bool {
        self.0[0] == self.0[1] && self.0[1] == self.0[2]
    }
}

/// A colour or weight, constant or taken from a texture:
/// `0.5`, `(0.7, 0.2, 0.2)`, `texture("wood")` or `texture(name: "wood", scale: 0.8)`.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    Constant(Rgb),
    Texture(TextureRef),
}

/// A texture by name, its values multiplied by `scale`.
///
/// ```ron
/// materials: { "dark": (diffuse: texture(name: "wood", scale: 0.5)) }
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TextureRef {
    pub name: String,
    #[serde(default = "white")]
    pub scale: Rgb,
}

fn white() -> Rgb {
    Rgb::grey(1.0)
}

impl Default for Source {
    fn default() -> Self {
        Source::Constant(Rgb::default())
    }
}

impl Source {
    pub fn is_zero(&self) -> bool {
        matches!(self, Source::Constant(c) if c.is_zero())
    }

    /// Whether it is all of the light, everywhere.
    pub fn is_one(&self) -> bool {
        matches!(self, Source::Constant(c) if *c == Rgb::grey(1.0))
    }

    pub fn texture(&self) -> Option<&TextureRef> {
        match self {
            Source::Constant(_) => None,
            Source::Texture(texture) => Some(texture),
        }
    }
}

impl Serialize for Rgb {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.is_grey() { serializer.serialize_f64(self.0[0]) } else { self.0.serialize(serializer) }
    }
}

impl<'de> Deserialize<'de> for Rgb {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Colour;
        impl<'de> Visitor<'de> for Colour {
            type Value = Rgb;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number (grey) or three numbers (red, green, blue)")
            }

            fn visit_f64<E: Error>(self, v: f64) -> Result<Rgb, E> {
                Ok(Rgb::grey(v))
            }

            fn visit_i64<E: Error>(self, v: i64) -> Result<Rgb, E> {
                Ok(Rgb::grey(v as f64))
            }

            fn visit_u64<E: Error>(self, v: u64) -> Result<Rgb, E> {
                Ok(Rgb::grey(v as f64))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Rgb, A::Error> {
                <[f64; 3]>::deserialize(SeqAccessDeserializer::new(seq)).map(Rgb)
            }
        }
        deserializer.deserialize_any(Colour)
    }
}

impl Serialize for Source {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Source::Constant(rgb) => rgb.serialize(serializer),
            Source::Texture(t) if t.scale == white() => {
                serializer.serialize_newtype_variant("Source", 0, "texture", &t.name)
            }
            Source::Texture(t) => serializer.serialize_newtype_variant("Source", 0, "texture", t),
        }
    }
}

/// What stands behind the word `texture`: a name, or a name with a scale.
struct TextureValue(TextureRef);

impl<'de> Deserialize<'de> for TextureValue {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NameOrRef;
        impl<'de> Visitor<'de> for NameOrRef {
            type Value = TextureValue;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a texture's name, or (name: …, scale: …)")
            }

            fn visit_str<E: Error>(self, name: &str) -> Result<TextureValue, E> {
                Ok(TextureValue(TextureRef { name: name.to_owned(), scale: white() }))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<TextureValue, A::Error> {
                TextureRef::deserialize(MapAccessDeserializer::new(map)).map(TextureValue)
            }
        }
        deserializer.deserialize_any(NameOrRef)
    }
}

impl<'de> Deserialize<'de> for Source {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ColourOrTexture;
        impl<'de> Visitor<'de> for ColourOrTexture {
            type Value = Source;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number (grey), three numbers (red, green, blue) or texture(\"name\")")
            }

            fn visit_f64<E: Error>(self, v: f64) -> Result<Source, E> {
                Ok(Source::Constant(Rgb::grey(v)))
            }

            fn visit_i64<E: Error>(self, v: i64) -> Result<Source, E> {
                self.visit_f64(v as f64)
            }

            fn visit_u64<E: Error>(self, v: u64) -> Result<Source, E> {
                self.visit_f64(v as f64)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Source, A::Error> {
                let rgb = <[f64; 3]>::deserialize(SeqAccessDeserializer::new(seq))?;
                Ok(Source::Constant(Rgb(rgb)))
            }

            // TOML: { texture = "wood" }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Source, A::Error> {
                let value = match map.next_key::<String>()?.as_deref() {
                    Some("texture") => map.next_value::<TextureValue>()?,
                    Some(other) => return Err(A::Error::unknown_variant(other, &["texture"])),
                    None => return Err(A::Error::missing_field("texture")),
                };
                match map.next_key::<String>()? {
                    Some(extra) => {
                        Err(A::Error::custom(format!("nothing can follow `texture`, found `{extra}`")))
                    }
                    None => Ok(Source::Texture(value.0)),
                }
            }

            // RON: texture("wood")
            fn visit_enum<A: EnumAccess<'de>>(self, access: A) -> Result<Source, A::Error> {
                let (tag, variant) = access.variant::<String>()?;
                if tag != "texture" {
                    return Err(A::Error::unknown_variant(&tag, &["texture"]));
                }
                variant.newtype_variant::<TextureValue>().map(|value| Source::Texture(value.0))
            }
        }
        deserializer.deserialize_any(ColourOrTexture)
    }
}

fn rgb_schema() -> serde_json::Value {
    serde_json::json!([
        { "type": "number" },
        { "type": "array", "items": { "type": "number" }, "minItems": 3, "maxItems": 3 }
    ])
}

impl JsonSchema for Rgb {
    fn schema_name() -> Cow<'static, str> {
        "Rgb".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        schemars::json_schema!({ "anyOf": rgb_schema() })
    }
}

impl JsonSchema for Source {
    fn schema_name() -> Cow<'static, str> {
        "Source".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let reference = generator.subschema_for::<TextureRef>();
        let mut options = rgb_schema();
        if let Some(list) = options.as_array_mut() {
            list.push(serde_json::json!({
                "type": "object",
                "properties": { "texture": { "anyOf": [{ "type": "string" }, reference] } },
                "required": ["texture"],
                "additionalProperties": false
            }));
        }
        schemars::json_schema!({ "anyOf": options })
    }
}
