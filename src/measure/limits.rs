//! Limits on how far images may differ: of metrics, and of single pixels as OpenImageIO's `idiff` has them.

use super::comparison::{CompareError, Comparison, LayerDifference, pairs};
use super::read::FileImage;
use super::values::pixels_over;
use serde::Serialize;

/// The largest values that are allowed; each holds for every compared layer that has it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    pub max_rel_mse: Option<f64>,
    pub max_rel_mse_trimmed: Option<f64>,
    /// Of E, as a fraction.
    pub max_relative_rms: Option<f64>,
    /// Of FLIP's mean, as shown.
    pub max_flip: Option<f64>,
    pub max_flip_hdr: Option<f64>,
    pub fail: Pixels,
    pub warn: Pixels,
}

/// Limits of single pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pixels {
    /// A pixel is over if any of its channels differs by more than this.
    pub threshold: Option<f64>,
    /// Percent of pixels that may be over, 0 to 100.
    pub percent: f64,
    /// No channel of any pixel may differ by more than this.
    pub hard: Option<f64>,
}

/// A limit and what was found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// As on the command line: `max-relmse`, `fail`, `hardfail`, `warn` …
    pub limit: &'static str,
    /// Empty for the picture itself.
    pub layer: String,
    pub value: f64,
    pub allowed: f64,
    pub exceeded: bool,
    /// Whether it makes the images different, or is only said.
    pub fatal: bool,
}

impl Pixels {
    pub fn is_set(&self) -> bool {
        self.threshold.is_some() || self.hard.is_some()
    }
}

impl Limits {
    /// Whether any limit can make images different: otherwise they may not differ at all.
    pub fn can_fail(&self) -> bool {
        self.metrics().iter().any(|(_, allowed, _)| allowed.is_some()) || self.fail.is_set()
    }

    /// Every limit that is set, against every layer that it applies to.
    ///
    /// # Errors
    /// As [`pairs`].
    pub fn verdicts(
        &self,
        image: &FileImage,
        reference: &FileImage,
        chosen: &[String],
        found: &Comparison,
    ) -> Result<Vec<Verdict>, CompareError> {
        let mut verdicts = Vec::new();
        for (limit, allowed, of) in self.metrics() {
            let Some(allowed) = allowed else { continue };
            let values = found.layers.iter().filter_map(|layer| Some((layer.name.as_str(), of(layer)?)));
            let before = verdicts.len();
            verdicts.extend(values.map(|(layer, value)| verdict(limit, layer, value, allowed, true)));
            if verdicts.len() == before {
                // a limit that nothing is held to has not been kept
                verdicts.push(verdict(limit, "", f64::NAN, allowed, true));
            }
        }
        for (a, r) in pairs(image, reference, chosen)? {
            let layer = r.name.as_str();
            let largest = found.layers.iter().find(|l| l.name == r.name).map_or(0.0, |l| l.values.max_error);
            for (pixels, names, fatal) in
                [(&self.fail, ["fail", "hardfail"], true), (&self.warn, ["warn", "hardwarn"], false)]
            {
                if let Some(threshold) = pixels.threshold {
                    let over = pixels_over(a, r, threshold) as f64;
                    let percent = 100.0 * over / (image.width * image.height) as f64;
                    verdicts.push(verdict(names[0], layer, percent, pixels.percent, fatal));
                }
                if let Some(hard) = pixels.hard {
                    verdicts.push(verdict(names[1], layer, largest, hard, fatal));
                }
            }
        }
        Ok(verdicts)
    }

    #[allow(clippy::type_complexity)]
    fn metrics(&self) -> [(&'static str, Option<f64>, fn(&LayerDifference) -> Option<f64>); 5] {
        [
            ("max-relmse", self.max_rel_mse, |l| Some(l.colour.as_ref()?.relative.rel_mse)),
            ("max-relmse-trimmed", self.max_rel_mse_trimmed, |l| {
                Some(l.colour.as_ref()?.relative.rel_mse_trimmed)
            }),
            ("max-e", self.max_relative_rms, |l| Some(l.colour.as_ref()?.relative.relative_rms)),
            ("max-flip", self.max_flip, |l| Some(l.colour.as_ref()?.flip?.mean)),
            ("max-flip-hdr", self.max_flip_hdr, |l| Some(l.colour.as_ref()?.flip_hdr.as_ref()?.pooled.mean)),
        ]
    }
}

/// What is not a number has not been shown to keep a limit.
fn verdict(limit: &'static str, layer: &str, value: f64, allowed: f64, fatal: bool) -> Verdict {
    let exceeded = value.is_nan() || value > allowed;
    Verdict { limit, layer: layer.to_owned(), value, allowed, exceeded, fatal }
}
