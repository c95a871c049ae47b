//! Placement of objects: a list of steps, applied first to last.

use super::Vector;
use crate::math::{DAffine3, DVec3, rotation};
use schemars::JsonSchema;
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::fmt;

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Transform {
    /// Moves by (x, y, z), metres.
    ///
    /// ```ron
    /// objects: [(shape: sphere(), transform: [translate((0, 1, 0))])]
    /// ```
    Translate(Vector),
    /// One factor, or one an axis. Negative factors mirror; zero is refused.
    ///
    /// ```ron
    /// objects: [(shape: sphere(), transform: [scale(2), scale((1, 2, -1))])]
    /// ```
    Scale(Scale),
    /// Right-handed turn by `deg` degrees about `axis` through the origin.
    ///
    /// ```ron
    /// objects: [(shape: box(), transform: [rotate(axis: (0, 1, 0), deg: 45)])]
    /// ```
    Rotate { axis: Vector, deg: f64 },
    /// An affine matrix, three rows of four numbers.
    ///
    /// ```ron
    /// objects: [(shape: box(), transform: [matrix(((1, 0, 0, 2), (0, 1, 0, 0), (0, 0.5, 1, 0)))])]
    /// ```
    Matrix([[f64; 4]; 3]),
}

impl Transform {
    /// What it does to points. The axis of a turn must not be (0, 0, 0).
    pub fn map(&self) -> DAffine3 {
        match self {
            Transform::Translate(v) => DAffine3::from_translation((*v).into()),
            Transform::Scale(Scale::Uniform(s)) => DAffine3::from_scale(DVec3::splat(*s)),
            Transform::Scale(Scale::PerAxis(s)) => DAffine3::from_scale((*s).into()),
            Transform::Rotate { axis, deg } => rotation((*axis).into(), *deg),
            Transform::Matrix(rows) => {
                let column = |c: usize| DVec3::from_array(rows.map(|row| row[c]));
                DAffine3::from_cols(column(0), column(1), column(2), column(3))
            }
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Scale {
    Uniform(f64),
    PerAxis(Vector),
}

impl<'de> Deserialize<'de> for Scale {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OneOrThree;
        impl<'de> Visitor<'de> for OneOrThree {
            type Value = Scale;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a factor or three factors (x, y, z)")
            }

            fn visit_f64<E: Error>(self, v: f64) -> Result<Scale, E> {
                Ok(Scale::Uniform(v))
            }

            fn visit_i64<E: Error>(self, v: i64) -> Result<Scale, E> {
                Ok(Scale::Uniform(v as f64))
            }

            fn visit_u64<E: Error>(self, v: u64) -> Result<Scale, E> {
                Ok(Scale::Uniform(v as f64))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Scale, A::Error> {
                Vector::deserialize(SeqAccessDeserializer::new(seq)).map(Scale::PerAxis)
            }
        }
        deserializer.deserialize_any(OneOrThree)
    }
}
