//! Decisions, each with its reason in the scene's own names.

use super::Effect;
use serde::Serialize;
use std::fmt;

/// Whether an effect runs, and why.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Decision {
    pub effect: Effect,
    pub on: bool,
    pub reason: String,
    pub cause: Cause,
}

/// What has decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Cause {
    /// The content calls for it or does not.
    Scene,
    /// A setting of the scene, such as `photons: off`.
    Asked,
    /// The command line.
    Overridden,
}

impl Decision {
    pub(super) fn on(effect: Effect, reason: impl Into<String>) -> Decision {
        Decision { effect, on: true, reason: reason.into(), cause: Cause::Scene }
    }

    pub(super) fn off(effect: Effect, reason: impl Into<String>) -> Decision {
        Decision { effect, on: false, reason: reason.into(), cause: Cause::Scene }
    }

    /// On for what was found, or off because nothing was.
    pub(super) fn of(effect: Effect, found: Option<String>, otherwise: &str) -> Decision {
        found.map_or_else(|| Decision::off(effect, otherwise), |reason| Decision::on(effect, reason))
    }

    pub(super) fn because(self, cause: Cause) -> Decision {
        Decision { cause, ..self }
    }
}

impl fmt::Display for Decision {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}: {}: {}", self.effect, if self.on { "on" } else { "off" }, self.reason)
    }
}

/// `` `a` ``; `` `a` and `b` ``; `` `a`, `b` and 12 more ``.
pub fn few<S: AsRef<str>>(names: &[S]) -> String {
    match names {
        [] => String::new(),
        [one] => format!("`{}`", one.as_ref()),
        [one, two] => format!("`{}` and `{}`", one.as_ref(), two.as_ref()),
        [one, two, rest @ ..] => format!("`{}`, `{}` and {} more", one.as_ref(), two.as_ref(), rest.len()),
    }
}

#[cfg(test)]
mod tests {
    use super::few;

    #[test]
    fn of_many_names_two_are_told() {
        assert_eq!(few::<&str>(&[]), "");
        assert_eq!(few(&["a"]), "`a`");
        assert_eq!(few(&["a", "b"]), "`a` and `b`");
        assert_eq!(few(&["a", "b", "c", "d"]), "`a`, `b` and 2 more");
    }
}
