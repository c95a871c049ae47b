//! The sRGB transfer curve, from encoded to linear (IEC 61966-2-1).

use std::sync::LazyLock;

/// Linear value of an encoded one; continued beyond 1 by the same power.
pub fn srgb_to_linear(v: f64) -> f64 {
    if v <= 0.04045 { v / 12.92 } else { libm::pow((v + 0.055) / 1.055, 2.4) }
}

/// Linear value of each 8-bit code.
pub fn srgb8_to_linear() -> &'static [f32; 256] {
    static TABLE: LazyLock<[f32; 256]> =
        LazyLock::new(|| std::array::from_fn(|v| srgb_to_linear(v as f64 / 255.0) as f32));
    &TABLE
}

/// v/255 of each 8-bit code.
pub(super) fn linear8() -> &'static [f32; 256] {
    static TABLE: LazyLock<[f32; 256]> = LazyLock::new(|| std::array::from_fn(|v| (v as f64 / 255.0) as f32));
    &TABLE
}

/// Linear value of each 16-bit code.
pub(super) fn srgb16_to_linear() -> &'static [f32] {
    static TABLE: LazyLock<Vec<f32>> =
        LazyLock::new(|| (0..=u16::MAX).map(|v| srgb_to_linear(f64::from(v) / 65535.0) as f32).collect());
    &TABLE
}

/// v/65535 of each 16-bit code.
pub(super) fn linear16() -> &'static [f32] {
    static TABLE: LazyLock<Vec<f32>> =
        LazyLock::new(|| (0..=u16::MAX).map(|v| (f64::from(v) / 65535.0) as f32).collect());
    &TABLE
}
