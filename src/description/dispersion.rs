//! How the index of refraction depends on the wavelength.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Dispersion of a medium; its `ior` is that of the d line, 587.6 nm. A prism throws a rainbow.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Dispersion {
    /// Abbe number (n_d − 1)/(n_F − n_C), 5 to 200: crown glass 59, flint glass 36, water 56, diamond 55.
    ///
    /// ```ron
    /// materials: { "flint": (transmission: 1, ior: 1.62, dispersion: abbe(36)) }
    /// ```
    Abbe(f64),
    /// B of Cauchy's n(λ) = A + B/λ², in µm², 0 to 0.1.
    ///
    /// ```ron
    /// materials: { "crown": (transmission: 1, ior: 1.52, dispersion: cauchy(0.0042)) }
    /// ```
    Cauchy(f64),
}
