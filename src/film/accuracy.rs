//! How far the picture still is from the truth, from how its passes differ.
//!
//! The error is E = √ mean((I−R)² / (R² + 0.31·m²)) over pixels and channels, m the mean luminance: relative,
//! and the same for any exposure. It has two parts.
//!
//! *Noise.* The squared error of the mean over n passes, V(n), would be s²/n of independent ones, s² the variance
//! from pass to pass. Samples in a pixel are well distributed over the passes and better than that, by rates ([`law`])
//! that are told from how much the mean changed when passes were doubled: the mean of the first half of them and the
//! mean of all differ by D with E[D²] = V(n/2) − V(n), whatever the passes have in common, so long as each part of
//! them is as good as any other of its size.
//!
//! *Bias.* The blur of the density estimate goes as the square of its radius where light is smooth (Silverman
//! 1986, 4.3), so the estimates at √2·r and r differ by as much, those at r and r/√2 by half of it. Products of two
//! halves of the passes, whose noise is independent, estimate its square without the noise; the first has an
//! eighth of the second's chance, the second counts where it tells more than chance may.
//!
//! What no pass can tell is not in it: the depth limit, three colours, facets of meshes, and paths so rare
//! that none was found.

mod class;
mod done;
mod independent;
mod jackknife;
mod law;
mod rates;
mod sums;

use super::brightness::Brightness;
use crate::math::DVec3;
use crate::trace::{Measured, Probe};
use class::Classes;
pub(super) use done::done;
use jackknife::jackknife;
pub use rates::Rates;
use serde::Serialize;

/// The relative RMS error of a picture, 1 for 100 %.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Accuracy {
    /// Of the pixels that have the most.
    pub passes: u32,
    /// On average over the pixels: some may have come to rest earlier.
    pub mean_passes: f64,
    /// Noise and bias together: their squares add up to its square.
    pub error: f64,
    /// Within this with 95 % confidence.
    pub interval: [f64; 2],
    pub noise: f64,
    pub bias: f64,
    pub by_effect: Vec<Part>,
    /// The squared noise of the pixels with the most passes, over what it would be if these were independent.
    #[serde(skip)]
    pub gain: f64,
    /// p: the squared bias falls as passes^−p.
    #[serde(skip)]
    pub bias_rate: f64,
}

/// What one effect adds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Part {
    /// `edges`: what differs across a pixel; `direct`: lamps with an extent, the lens, and whatever else
    /// chance decides at one place of it; `caustics`; `indirect`.
    pub effect: &'static str,
    /// Of the squared error.
    pub share: f64,
    /// p: the squared noise falls as passes^−p.
    pub rate: f64,
    pub noise: f64,
    pub bias: f64,
}

/// 0.01/0.18²: see the module's text.
const FLOOR: f64 = 0.31;

/// The truth may lie as far from the middle of the rates as this times half of what they differ.
const BESIDE: f64 = 1.2;

/// What is added for light that chance finds, photons' and that of many bounces, by its share of the error: without it
/// the intervals of a caustic after 64 passes held the truth in 8 of 12 renders, with it in 11.
const RARE: f64 = 0.2;

/// What is added for pixels that a single pass has made more than half of, glints of the sun in glass for instance, by
/// their share of the error: without it the intervals of such a scene held 32 of 40 renders.
const SINGLE: f64 = 0.8;

/// What of the way from the stated error to the upper end of its interval an error that is to be reached lies below the
/// target: a half of a standard deviation, so that the true error is below it in two of three renders.
const SURE: f64 = 0.25;

/// Student's t for 95 % and one less than the groups that probes are divided into.
const STUDENT: f64 = 2.131;

impl Accuracy {
    /// Of all pixels and the probes of a picture, in any order. `None` where
    /// fewer than two passes are there, or everything is black.
    pub(super) fn of<'a>(
        pixels: impl Iterator<Item = Measured>,
        probes: impl Iterator<Item = &'a Probe>,
        picture: &Brightness,
        rates: Rates,
    ) -> Option<Accuracy> {
        Accuracy::by(pixels, probes, picture, rates, false)
    }

    /// The same of passes that are as good as independent.
    pub(super) fn of_independent<'a>(
        pixels: impl Iterator<Item = Measured>,
        probes: impl Iterator<Item = &'a Probe>,
        picture: &Brightness,
        rates: Rates,
    ) -> Option<Accuracy> {
        Accuracy::by(pixels, probes, picture, rates, true)
    }

    fn by<'a>(
        pixels: impl Iterator<Item = Measured>,
        probes: impl Iterator<Item = &'a Probe>,
        picture: &Brightness,
        rates: Rates,
        independent: bool,
    ) -> Option<Accuracy> {
        let floor = FLOOR * picture.mean() * picture.mean();
        if !(floor > 0.0 && floor.is_finite()) {
            return None;
        }
        let mut classes = Classes::of(pixels, probes, picture, floor)?;
        (classes.rates, classes.independent) = (rates, independent);
        let squared = classes.squared(None);
        let e = squared.sqrt();
        let mut accuracy = classes.accuracy();
        let passes = accuracy.passes;
        // Chance in the pixels' errors and in what is known of them; the jackknife over groups of probes, of ln E;
        // and how far the model may be off.
        let chance =
            0.5 * TWO_SIGMA * (2.0 * f64::from(passes) / f64::from(passes - 1)).sqrt() * classes.scatter();
        let logs: Vec<f64> = classes
            .groups()
            .map(|group| 0.5 * libm::log(classes.squared(Some(group)).max(1e-6 * squared) / squared))
            .filter(|log| log.is_finite())
            .collect();
        let groups = STUDENT * jackknife(&logs);
        let model = law::beyond(passes);
        // Bright light that is found seldom is in the truth before it is in what was seen.
        let found = |part: &&Part| matches!(part.effect, "caustics" | "indirect");
        let rare = RARE * accuracy.by_effect.iter().filter(found).map(|part| part.share).sum::<f64>();
        // What lies beside all rates that noise may fall at.
        let doubt = BESIDE * classes.doubt();
        // What one pass has found is worth nothing, or several times as much.
        let single = SINGLE * classes.single();
        let parts = [chance, groups, model, rare, doubt, single];
        let half = parts.iter().map(|part| part * part).sum::<f64>().sqrt();
        accuracy.interval = [e * libm::exp(-half), e * libm::exp(half)];
        Some(accuracy)
    }
}

/// 1/(R² + floor) by channel.
fn weight(r: DVec3, floor: f64) -> DVec3 {
    1.0 / (r * r + floor)
}

/// Of a normal distribution, for 95 %.
const TWO_SIGMA: f64 = 1.96;

impl Accuracy {
    /// What is to be stated where the true error is to be `target`: less where it is known badly.
    pub fn aim(&self, target: f64) -> f64 {
        let known = self.error / self.interval[1];
        if known > 0.0 { target * libm::pow(known, SURE) } else { target }
    }

    /// The passes in all after which the error will be `target`, at the rates found so far.
    pub fn passes_for(&self, target: f64) -> f64 {
        let (mut low, mut high) = (-20.0, 40.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.squared(libm::exp2(middle)) > target * target { low = middle } else { high = middle }
        }
        f64::from(self.passes) * libm::exp2(high)
    }

    /// The error after so many passes in all, at the rates found so far.
    pub fn error_after(&self, passes: f64) -> f64 {
        self.squared(passes / f64::from(self.passes)).sqrt()
    }

    /// The squared error after so many times the passes.
    fn squared(&self, times: f64) -> f64 {
        let sum: f64 = self.by_effect.iter().map(|part| part.noise * part.noise).sum();
        let scale = if sum > 0.0 { self.noise * self.noise / sum } else { 0.0 };
        let noise = |part: &Part| scale * part.noise * part.noise * libm::pow(times, -part.rate);
        self.by_effect.iter().map(noise).sum::<f64>()
            + self.bias * self.bias * libm::pow(times, -self.bias_rate)
    }
}
