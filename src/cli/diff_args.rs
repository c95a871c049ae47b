//! The arguments of `diff`, as typed.

use clap::Args as ClapArgs;
use std::path::PathBuf;
use terrarium::measure::{Limits, Pixels};

pub const DIFF_EXAMPLES: &str = "\
Examples:
  terrarium diff image.exr reference.exr
  terrarium diff image.exr reference.exr --max-e 1% --heat error.png
  terrarium diff image.exr reference.exr --layer caustic --json
  terrarium diff image.png golden.png --fail 0.01 --failpercent 0.1 --hardfail 0.2

Without limits any differing bit is a difference; with limits only what is over them.
A value that is NaN or infinite in one image only is a difference always.

Exit codes: 0 no difference; 1 the images differ, or can't be compared; 2 the call is
wrong; 3 an image can't be read; 4 a map can't be written.";

#[derive(Debug, ClapArgs)]
pub struct DiffArgs {
    /// The image, EXR or PNG; `-` reads it from standard input
    pub image: PathBuf,
    /// What it is measured against, EXR or PNG; `-` reads it from standard input
    pub reference: PathBuf,
    /// Compare these layers only; `picture` is that without a name. All that both have if not given
    #[arg(long, value_name = "LAYER,…", value_delimiter = ',')]
    pub layer: Vec<String>,
    /// Stops by which images are exposed for PSNR, SSIM, FLIP and pictures; if not given, 0 of PNG, and
    /// else what brings the reference to a mean of 0.18
    #[arg(long, value_name = "EV", allow_negative_numbers = true, value_parser = finite)]
    pub exposure: Option<f64>,
    /// Leave out SSIM and FLIP, which take most of the time
    #[arg(long)]
    pub fast: bool,
    #[command(flatten)]
    pub metrics: MetricLimits,
    #[command(flatten)]
    pub pixels: PixelLimits,
    /// Write a map of the relative error, from 0.1 % (black) to 100 % (white), logarithmic
    #[arg(long, value_name = "FILE")]
    pub heat: Option<PathBuf>,
    /// Write the image, the reference and the heat map beside each other
    #[arg(long, value_name = "FILE")]
    pub side_by_side: Option<PathBuf>,
    /// Print one JSON object instead of text
    #[arg(long)]
    pub json: bool,
    /// Print no text but warnings and what is over limits; the exit code tells whether the images differ
    #[arg(short, long)]
    pub quiet: bool,
}

/// Limits of metrics; each holds for all colour layers that are compared.
#[derive(Debug, ClapArgs)]
pub struct MetricLimits {
    /// Largest relMSE that is no difference
    #[arg(long, value_name = "X", value_parser = limit)]
    pub max_relmse: Option<f64>,
    /// Largest relMSE without the worst 0.1 % of the pixels
    #[arg(long, value_name = "X", value_parser = limit)]
    pub max_relmse_trimmed: Option<f64>,
    /// Largest relative RMS error E, as `0.01` or `1%`
    #[arg(long, value_name = "X", value_parser = limit)]
    pub max_e: Option<f64>,
    /// Largest mean of FLIP, 0 to 1
    #[arg(long, value_name = "X", value_parser = limit, conflicts_with = "fast")]
    pub max_flip: Option<f64>,
    /// Largest mean of HDR-FLIP, 0 to 1
    #[arg(long, value_name = "X", value_parser = limit, conflicts_with = "fast")]
    pub max_flip_hdr: Option<f64>,
}

/// Limits of single pixels, as OpenImageIO's idiff has them; each holds for all layers that are compared.
#[derive(Debug, ClapArgs)]
pub struct PixelLimits {
    /// A pixel fails if a channel differs by more than this
    #[arg(long, value_name = "X", value_parser = limit)]
    pub fail: Option<f64>,
    /// Percent of pixels that may fail
    #[arg(long, value_name = "P", value_parser = share, requires = "fail", default_value_t = 0.0)]
    pub failpercent: f64,
    /// No pixel may differ by more than this
    #[arg(long, value_name = "X", value_parser = limit)]
    pub hardfail: Option<f64>,
    /// As --fail, but only warns
    #[arg(long, value_name = "X", value_parser = limit)]
    pub warn: Option<f64>,
    /// Percent of pixels that may be over --warn
    #[arg(long, value_name = "P", value_parser = share, requires = "warn", default_value_t = 0.0)]
    pub warnpercent: f64,
    /// As --hardfail, but only warns
    #[arg(long, value_name = "X", value_parser = limit)]
    pub hardwarn: Option<f64>,
}

impl DiffArgs {
    pub fn limits(&self) -> Limits {
        let (metrics, pixels) = (&self.metrics, &self.pixels);
        Limits {
            max_rel_mse: metrics.max_relmse,
            max_rel_mse_trimmed: metrics.max_relmse_trimmed,
            max_relative_rms: metrics.max_e,
            max_flip: metrics.max_flip,
            max_flip_hdr: metrics.max_flip_hdr,
            fail: Pixels { threshold: pixels.fail, percent: pixels.failpercent, hard: pixels.hardfail },
            warn: Pixels { threshold: pixels.warn, percent: pixels.warnpercent, hard: pixels.hardwarn },
        }
    }
}

fn finite(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err("not a finite number".to_owned()),
        Err(error) => Err(error.to_string()),
    }
}

/// A number from 0, of which `%` is the hundredth.
fn limit(text: &str) -> Result<f64, String> {
    let value = match text.trim().strip_suffix('%') {
        Some(percent) => finite(percent)? / 100.0,
        None => finite(text)?,
    };
    if value < 0.0 { Err("below 0".to_owned()) } else { Ok(value) }
}

/// Percent, 0 to 100; the sign may be typed.
fn share(text: &str) -> Result<f64, String> {
    let percent = finite(text.trim().trim_end_matches('%'))?;
    if (0.0..=100.0).contains(&percent) { Ok(percent) } else { Err("not from 0 to 100".to_owned()) }
}
