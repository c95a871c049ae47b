//! What is wrong with a node, said by serde's `Deserialize` implementations or by our deserializer.

use serde::de::{Error, Expected, Unexpected};
use std::fmt::{self, Display};

/// Why a node cannot be read.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Fault {
    /// The value is of another type or has another length: what was expected.
    Type(String),
    UnknownField {
        name: String,
        known: &'static [&'static str],
    },
    UnknownVariant {
        name: String,
        known: &'static [&'static str],
    },
    Missing(&'static str),
    /// A variant with fields stands there as a bare word.
    FieldsMissing(String),
    /// A map in the wrong kind of brackets: what was expected.
    Brackets(&'static str),
    Message(String),
}

/// A fault and where it is: child indices from the inside out (see `Node::child_mut`).
#[derive(Clone, Debug)]
pub(super) struct Located {
    pub fault: Fault,
    pub at: Vec<usize>,
}

impl Located {
    pub fn under(mut self, child: usize) -> Located {
        self.at.push(child);
        self
    }
}

impl From<Fault> for Located {
    fn from(fault: Fault) -> Located {
        Located { fault, at: Vec::new() }
    }
}

impl Display for Located {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{:?}", self.fault)
    }
}

impl std::error::Error for Located {}

impl Error for Located {
    fn custom<T: Display>(message: T) -> Located {
        Fault::Message(message.to_string()).into()
    }

    fn invalid_type(_: Unexpected, expected: &dyn Expected) -> Located {
        Fault::Type(expected.to_string()).into()
    }

    fn invalid_value(_: Unexpected, expected: &dyn Expected) -> Located {
        Fault::Type(expected.to_string()).into()
    }

    fn invalid_length(_: usize, expected: &dyn Expected) -> Located {
        let words = expected.to_string();
        let numbers = words.strip_prefix("an array of length ");
        Fault::Type(numbers.map_or(words.clone(), |n| format!("{n} values"))).into()
    }

    fn unknown_variant(name: &str, known: &'static [&'static str]) -> Located {
        Fault::UnknownVariant { name: name.into(), known }.into()
    }

    fn unknown_field(name: &str, known: &'static [&'static str]) -> Located {
        Fault::UnknownField { name: name.into(), known }.into()
    }

    fn missing_field(field: &'static str) -> Located {
        Fault::Missing(field).into()
    }
}
