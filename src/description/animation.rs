//! What changes from frame to frame: values that go through keys, and a camera that goes around.
//!
//! Nothing else of a scene depends on the frame, least of all its random values: what stands still has
//! the same noise in every frame and does not flicker.

use super::{NameMap, Vector};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::borrow::Cow;
use std::fmt;

/// Frames, numbered from 1, and what differs between them.
///
/// ```ron
/// animation: (
///     frames: 48,
///     fps: 24,
///     orbit: (deg: 360),
///     keys: {
///         "lights.lamp.radius": linear([(frame: 1, value: 0.1), (frame: 48, value: 0.3)]),
///         "objects.ball.transform.0.translate":
///             smooth([(frame: 1, value: (0, 0, 0)), (frame: 24, value: (0, 1, 0)), (frame: 48, value: (0, 0, 0))]),
///         "objects.ball.material": step([(frame: 1, value: "brass"), (frame: 25, value: "glass")]),
///     },
/// )
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Animation {
    /// How many there are, from 1 to a million.
    pub frames: u32,
    /// Frames a second, for whoever makes a film of them.
    #[serde(default = "default_fps")]
    pub fps: f64,
    /// The camera goes around.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orbit: Option<Orbit>,
    /// Values of the scene, by their paths as `--set` has them.
    #[serde(default, skip_serializing_if = "NameMap::is_empty")]
    pub keys: NameMap<Track>,
}

/// The camera as it is described, turned about an axis: not at all in frame 1, and in each frame by an
/// equal part of the angle further, so that the frame after the last would have all of it.
///
/// ```ron
/// animation: (frames: 90, orbit: (center: (0, 1, 0), axis: (0, 1, 0), deg: -360))
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Orbit {
    /// A point of the axis; without it, the camera's target.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub center: Option<Vector>,
    #[serde(default = "default_axis")]
    pub axis: Vector,
    /// Degrees over all frames, right-handed about the axis; above 360 for several turns.
    #[serde(default = "default_deg")]
    pub deg: f64,
}

/// How a value goes from key to key. Before the first key and after the last it rests.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Track {
    /// At constant speed between two keys.
    ///
    /// ```ron
    /// animation: (frames: 9, keys: { "camera.fov_deg": linear([(frame: 1, value: 40), (frame: 9, value: 20)]) })
    /// ```
    Linear(Vec<Key>),
    /// Gently: from rest to rest, through the keys between without a kink, and never beyond two
    /// neighbouring keys' values.
    ///
    /// ```ron
    /// animation: (frames: 9, keys: { "camera.fov_deg": smooth([(frame: 1, value: 40), (frame: 9, value: 20)]) })
    /// ```
    Smooth(Vec<Key>),
    /// Each key's value until the next; not only numbers.
    ///
    /// ```ron
    /// animation: (frames: 9, keys: { "lights.lamp.visible": step([(frame: 1, value: true), (frame: 5, value: false)]) })
    /// ```
    Step(Vec<Key>),
}

/// A value at a frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Key {
    pub frame: u32,
    pub value: KeyValue,
}

/// Numbers and lists of them, which lie between each other, or texts and truths, which do not.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum KeyValue {
    Number(f64),
    List(Vec<KeyValue>),
    Flag(bool),
    Text(String),
}

fn default_fps() -> f64 {
    24.0
}

fn default_axis() -> Vector {
    [0.0, 1.0, 0.0]
}

fn default_deg() -> f64 {
    360.0
}

impl Animation {
    pub const MOST_FRAMES: u32 = 1_000_000;
    /// So many values may have keys.
    pub const MOST_TRACKS: usize = 10_000;

    /// The frames at which a track has a key, in order, each once, and the first: what lies between two of
    /// them is between their values.
    pub fn key_frames(&self) -> Vec<u32> {
        let keys = self.keys.iter().flat_map(|(_, track)| track.keys()).map(|key| key.frame);
        let mut frames: Vec<u32> = keys.filter(|frame| (1..=self.frames).contains(frame)).collect();
        frames.push(1);
        frames.sort_unstable();
        frames.dedup();
        frames
    }
}

impl Track {
    pub fn keys(&self) -> &[Key] {
        match self {
            Track::Linear(keys) | Track::Smooth(keys) | Track::Step(keys) => keys,
        }
    }

    /// The word for it in a scene.
    pub fn kind(&self) -> &'static str {
        match self {
            Track::Linear(_) => "linear",
            Track::Smooth(_) => "smooth",
            Track::Step(_) => "step",
        }
    }
}

impl<'de> Deserialize<'de> for KeyValue {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Any;
        impl<'de> Visitor<'de> for Any {
            type Value = KeyValue;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number, numbers in ( ), a text in quotes, true or false")
            }

            fn visit_f64<E: Error>(self, v: f64) -> Result<KeyValue, E> {
                Ok(KeyValue::Number(v))
            }

            fn visit_i64<E: Error>(self, v: i64) -> Result<KeyValue, E> {
                Ok(KeyValue::Number(v as f64))
            }

            fn visit_u64<E: Error>(self, v: u64) -> Result<KeyValue, E> {
                Ok(KeyValue::Number(v as f64))
            }

            fn visit_bool<E: Error>(self, v: bool) -> Result<KeyValue, E> {
                Ok(KeyValue::Flag(v))
            }

            fn visit_str<E: Error>(self, v: &str) -> Result<KeyValue, E> {
                Ok(KeyValue::Text(v.to_owned()))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<KeyValue, A::Error> {
                let mut items = Vec::new();
                while let Some(item) = seq.next_element()? {
                    items.push(item);
                }
                Ok(KeyValue::List(items))
            }
        }
        deserializer.deserialize_any(Any)
    }
}

impl JsonSchema for KeyValue {
    fn schema_name() -> Cow<'static, str> {
        "KeyValue".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let inner = generator.subschema_for::<KeyValue>();
        schemars::json_schema!({ "anyOf": [
            { "type": "number" },
            { "type": "array", "items": inner },
            { "type": "boolean" },
            { "type": "string" }
        ] })
    }
}
