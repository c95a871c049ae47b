//! The sRGB transfer function of IEC 61966-2-1, exact, and its quantisation to integers.
//!
//! The power comes from `libm`, so that a pixel is the same integer on every machine.

/// Linear light in [0, 1] to the sRGB signal in [0, 1]. Monotonic; 0 and 1 stay where they are.
pub fn encode(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055 }
}

/// The sRGB signal in [0, 1] to linear light in [0, 1].
pub fn decode(signal: f64) -> f64 {
    if signal <= 0.040_45 { signal / 12.92 } else { libm::pow((signal + 0.055) / 1.055, 2.4) }
}

/// A signal in [0, 1] as an integer from 0 to `max`: the nearest one, the even one of two that
/// are equally near.
pub fn quantise(signal: f64, max: u16) -> u16 {
    (signal * f64::from(max)).round_ties_even() as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_8_bit_and_every_16_bit_value_survives_the_round_trip() {
        for value in 0..=255u16 {
            assert_eq!(quantise(encode(decode(f64::from(value) / 255.0)), 255), value);
        }
        for value in 0..=u16::MAX {
            assert_eq!(quantise(encode(decode(f64::from(value) / 65535.0)), u16::MAX), value);
        }
    }
}
