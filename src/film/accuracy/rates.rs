//! How photons' noise and bias fall with passes, which no few passes tell by themselves.

use serde::{Deserialize, Serialize};

/// Exponents p: what falls as passes^−p. Of progressive passes with the parameter α the noise of the mean falls as
/// n^−α and the squared bias as n^−2(1−α) (Knaus & Zwicker 2011).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rates {
    /// Of the squared noise.
    pub caustics: f64,
    pub indirect: f64,
    /// Of the squared bias.
    pub bias: f64,
}

impl Rates {
    /// Of passes whose radius shrinks by α.
    pub fn progressive(alpha: f64) -> Rates {
        Rates { caustics: alpha, indirect: alpha, bias: 2.0 * (1.0 - alpha) }
    }

    /// Of passes that share their photons: what differs between them is not the photons' noise, and the bias stays.
    pub fn one_map() -> Rates {
        Rates { caustics: 1.0, indirect: 1.0, bias: 0.0 }
    }
}

impl Default for Rates {
    fn default() -> Rates {
        Rates::progressive(2.0 / 3.0)
    }
}
