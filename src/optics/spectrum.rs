//! One wavelength of a path, and what colour it has.
//!
//! Paths carry red, green and blue until they meet a medium whose index depends on the wavelength;
//! from there on they are of one wavelength, drawn from the three channels' own densities, and weighed
//! so that the mean over wavelengths is white: what does not disperse keeps its colour.
//!
//! The channels' densities are the CIE 1931 observer (multi-lobe fit of Wyman, Sloan & Shirley, JCGT
//! 2(2), 2013) in linear Rec. 709, cut off at 0, since no screen shows less, and scaled to integrate to 1.

use crate::math::Color;
use glam::DVec3;

/// Nanometres.
const FIRST: f64 = 380.0;
const LAST: f64 = 720.0;
const STEPS: usize = 340;

/// Wavelengths of the Fraunhofer lines F, d and C, µm.
const LINE_F: f64 = 0.486_134;
const LINE_D: f64 = 0.587_562;
const LINE_C: f64 = 0.656_281;

/// Draws wavelengths.
#[derive(Clone, Debug)]
pub struct Spectrum {
    /// Up to the end of each step, of the mean of the channels.
    cumulative: Vec<f64>,
    /// Of each step: the channels over their mean.
    weights: Vec<Color>,
}

/// A wavelength with its colour: the mean of the colours over all draws is (1, 1, 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WavelengthSample {
    pub um: f64,
    pub weight: Color,
}

impl Default for Spectrum {
    fn default() -> Self {
        Spectrum::new()
    }
}

impl Spectrum {
    pub fn new() -> Spectrum {
        let width = (LAST - FIRST) / STEPS as f64;
        let curves: Vec<DVec3> =
            (0..STEPS).map(|i| rec709(FIRST + (i as f64 + 0.5) * width).max(DVec3::ZERO)).collect();
        let total: DVec3 = curves.iter().sum();
        let mut sum = 0.0;
        let (mut cumulative, mut weights) = (Vec::new(), Vec::new());
        for curve in curves {
            let shares = curve / total;
            let mean = shares.element_sum() / 3.0;
            sum += mean;
            cumulative.push(sum);
            weights.push(if mean > 0.0 { (shares / mean).as_vec3a() } else { Color::ZERO });
        }
        Spectrum { cumulative, weights }
    }

    /// The wavelength of a uniform value in [0, 1).
    pub fn sample(&self, u: f64) -> WavelengthSample {
        let at = u * self.cumulative[STEPS - 1];
        let i = self.cumulative.partition_point(|&sum| sum <= at).min(STEPS - 1);
        let below = if i == 0 { 0.0 } else { self.cumulative[i - 1] };
        let within = ((at - below) / (self.cumulative[i] - below)).clamp(0.0, 1.0);
        let nm = FIRST + (i as f64 + within) * (LAST - FIRST) / STEPS as f64;
        WavelengthSample { um: 1e-3 * nm, weight: self.weights[i] }
    }
}

/// Cauchy's equation n(λ) = A + B/λ², through a known index at the d line (587.6 nm).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cauchy {
    a: f64,
    /// µm².
    b: f64,
}

impl Cauchy {
    pub const VACUUM: Cauchy = Cauchy { a: 1.0, b: 0.0 };

    /// `b` in µm²; 0 does not disperse.
    pub fn new(ior_d: f64, b: f64) -> Cauchy {
        Cauchy { a: ior_d - b / (LINE_D * LINE_D), b }
    }

    /// By the Abbe number V = (n_d − 1)/(n_F − n_C) > 0.
    pub fn from_abbe(ior_d: f64, abbe: f64) -> Cauchy {
        let spread = 1.0 / (LINE_F * LINE_F) - 1.0 / (LINE_C * LINE_C);
        Cauchy::new(ior_d, (ior_d - 1.0) / (abbe * spread))
    }

    pub fn disperses(&self) -> bool {
        self.b != 0.0
    }

    /// At a wavelength in µm; at the d line where there is none.
    #[inline]
    pub fn ior(&self, um: Option<f64>) -> f64 {
        if self.b == 0.0 {
            return self.a;
        }
        let um = um.unwrap_or(LINE_D);
        self.a + self.b / (um * um)
    }

    /// The least and the greatest index over all wavelengths that are drawn.
    pub fn range(&self) -> [f64; 2] {
        let (red, violet) = (self.ior(Some(1e-3 * LAST)), self.ior(Some(1e-3 * FIRST)));
        [red.min(violet), red.max(violet)]
    }
}

/// Linear Rec. 709 of light of one wavelength, in nanometres.
fn rec709(nm: f64) -> DVec3 {
    let lobe = |peak: f64, below: f64, above: f64| {
        let t = (nm - peak) / if nm < peak { below } else { above };
        libm::exp(-0.5 * t * t)
    };
    let x =
        1.056 * lobe(599.8, 37.9, 31.0) + 0.362 * lobe(442.0, 16.0, 26.7) - 0.065 * lobe(501.1, 20.4, 26.2);
    let y = 0.821 * lobe(568.8, 46.9, 40.5) + 0.286 * lobe(530.9, 16.3, 31.1);
    let z = 1.217 * lobe(437.0, 11.8, 36.0) + 0.681 * lobe(459.0, 26.0, 13.8);
    DVec3::new(
        3.240_454 * x - 1.537_139 * y - 0.498_531 * z,
        -0.969_266 * x + 1.876_011 * y + 0.041_556 * z,
        0.055_643 * x - 0.204_026 * y + 1.057_225 * z,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_of_all_wavelengths_is_white_and_none_is_darker_than_black() {
        let spectrum = Spectrum::new();
        let n = 100_000;
        let mut sum = DVec3::ZERO;
        for i in 0..n {
            let sample = spectrum.sample((f64::from(i) + 0.5) / f64::from(n));
            assert!(sample.weight.min_element() >= 0.0 && sample.weight.max_element() <= 3.001);
            assert!((0.38..=0.72).contains(&sample.um));
            sum += sample.weight.as_dvec3();
        }
        let mean = sum / f64::from(n);
        assert!((mean - DVec3::ONE).abs().max_element() < 1e-4, "{mean}");
    }

    #[test]
    fn red_green_and_blue_lie_where_they_are_seen() {
        let spectrum = Spectrum::new();
        for i in 0..1000 {
            let WavelengthSample { um, weight } = spectrum.sample((f64::from(i) + 0.5) / 1000.0);
            let [r, g, b] = weight.to_array();
            if um > 0.60 {
                assert!(r > g && g >= b, "{um} µm: {weight}");
            } else if (0.515..0.54).contains(&um) {
                assert!(g > r && g > b, "{um} µm: {weight}");
            } else if (0.43..0.47).contains(&um) {
                assert!(b > r && b > g, "{um} µm: {weight}");
            }
        }
    }

    /// BK7: n_d = 1.5168, V = 64.17; Cauchy's form is within 2e-4 of the catalogue at F and C.
    #[test]
    fn abbe_number_gives_the_indices_of_a_known_glass() {
        let bk7 = Cauchy::from_abbe(1.5168, 64.17);
        assert!((bk7.ior(Some(LINE_D)) - 1.5168).abs() < 1e-12);
        assert!((bk7.ior(Some(LINE_F)) - 1.52238).abs() < 3e-4, "{}", bk7.ior(Some(LINE_F)));
        assert!((bk7.ior(Some(LINE_C)) - 1.51432).abs() < 3e-4, "{}", bk7.ior(Some(LINE_C)));
        let v = (1.5168 - 1.0) / (bk7.ior(Some(LINE_F)) - bk7.ior(Some(LINE_C)));
        assert!((v - 64.17).abs() < 1e-9);
        assert!(!Cauchy::new(1.5, 0.0).disperses());
    }
}
