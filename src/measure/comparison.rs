//! Two image files compared, layer by layer.

use super::display::{Shown, psnr_db, ssim};
use super::flip::{self, Exposures, Pooled};
use super::read::{FileImage, FileLayer, Kind};
use super::relative::{LUMINANCE, Relative, relative};
use super::values::{Values, values};
use serde::Serialize;

/// The mean luminance that the reference is exposed to by default: a photographer's grey.
const EXPOSED_TO: f64 = 0.18;

/// What is compared, and how.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    /// Names of layers; the picture's is empty. All that both images have if there are none.
    pub layers: Vec<String>,
    /// Stops by which images are exposed for PSNR, SSIM and FLIP. If none: 0 where either image was stored
    /// for the screen, else what brings the mean luminance of the reference's layer to 0.18.
    pub exposure_ev: Option<f64>,
    /// Leaves out SSIM and FLIP, which take most of the time.
    pub fast: bool,
}

/// How one image differs from another.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    pub width: usize,
    pub height: usize,
    /// Whether every compared layer is the same and no other layer is in one image only.
    pub same: bool,
    pub layers: Vec<LayerDifference>,
    /// Layers that were not compared, none where layers were chosen.
    pub only_in_image: Vec<String>,
    pub only_in_reference: Vec<String>,
    /// What should be known of the comparison, one sentence each.
    pub notes: Vec<String>,
}

/// How a layer differs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LayerDifference {
    /// Empty for the picture itself.
    pub name: String,
    pub kind: Kind,
    pub channels: Vec<String>,
    #[serde(flatten)]
    pub values: Values,
    /// Of colours only.
    pub colour: Option<Colour>,
}

/// How colours differ.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Colour {
    #[serde(flatten)]
    pub relative: Relative,
    /// Stops, for PSNR, SSIM and FLIP.
    pub exposure_ev: f64,
    /// Infinite where the shown images are the same.
    pub psnr_db: f64,
    /// None where left out or smaller than 11 × 11.
    pub ssim: Option<f64>,
    pub flip: Option<Pooled>,
    /// None where left out, where the images were stored for the screen, or the reference is black.
    pub flip_hdr: Option<HdrFlip>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HdrFlip {
    #[serde(flatten)]
    pub pooled: Pooled,
    #[serde(flatten)]
    pub exposures: Exposures,
}

/// Why two images could not be compared.
#[derive(Debug, PartialEq, thiserror::Error)]
pub enum CompareError {
    #[error("the sizes differ: {0} × {1} pixels, and {2} × {3}")]
    Sizes(usize, usize, usize, usize),
    #[error("no layer `{name}` in the {side}, which has {has}")]
    NoLayer { name: String, side: &'static str, has: String },
    #[error("no layer in common: {0}, and {1}")]
    NothingCommon(String, String),
    #[error("layer `{name}` has other channels: {image}, and {reference}")]
    Channels { name: String, image: String, reference: String },
}

/// Layers that are compared, the image's and the reference's.
///
/// # Errors
/// The images' sizes differ, a layer that was chosen is missing, or they have none in common.
pub fn pairs<'a>(
    image: &'a FileImage,
    reference: &'a FileImage,
    chosen: &[String],
) -> Result<Vec<(&'a FileLayer, &'a FileLayer)>, CompareError> {
    if (image.width, image.height) != (reference.width, reference.height) {
        return Err(CompareError::Sizes(image.width, image.height, reference.width, reference.height));
    }
    if !chosen.is_empty() {
        let find = |side, file: &'a FileImage, name: &str| {
            let found = file.layers.iter().find(|layer| layer.name == name || layer.title() == name);
            found.ok_or_else(|| CompareError::NoLayer { name: name.to_owned(), side, has: titles(file) })
        };
        let pair = |name: &String| Ok((find("image", image, name)?, find("reference", reference, name)?));
        return chosen.iter().map(pair).collect();
    }
    let common: Vec<_> =
        image.layers.iter().filter_map(|layer| Some((layer, reference.layer(&layer.name)?))).collect();
    match (common.is_empty(), image.layers.as_slice(), reference.layers.as_slice()) {
        (false, ..) => Ok(common),
        (true, [a], [r]) => Ok(vec![(a, r)]),
        _ => Err(CompareError::NothingCommon(titles(image), titles(reference))),
    }
}

/// Compares two images.
///
/// # Errors
/// As [`pairs`]; or a layer has other channels in one than in the other.
pub fn compare_files(
    image: &FileImage,
    reference: &FileImage,
    settings: &Settings,
) -> Result<Comparison, CompareError> {
    let pairs = pairs(image, reference, &settings.layers)?;
    let encoded = image.encoded || reference.encoded;
    let mut layers = Vec::new();
    let mut notes = Vec::new();
    for (side, file) in [("image", image), ("reference", reference)] {
        notes.extend(file.notes.iter().map(|note| format!("the {side} {note}")));
    }
    for (a, r) in &pairs {
        if a.name != r.name {
            notes.push(format!("compared as the only layers: {} and {}", a.title(), r.title()));
        }
        layers.push(layer(a, r, image.width, encoded, settings)?);
    }
    let mut only = [(image, true), (reference, false)].map(|(file, first)| -> Vec<String> {
        let compared =
            |layer: &FileLayer| pairs.iter().any(|(a, r)| std::ptr::eq(if first { *a } else { *r }, layer));
        let others = file.layers.iter().filter(|layer| settings.layers.is_empty() && !compared(layer));
        others.map(|layer| layer.title().to_owned()).collect()
    });
    let [only_in_image, only_in_reference] = only.each_mut().map(std::mem::take);
    let same =
        layers.iter().all(|l| l.values.same) && only_in_image.is_empty() && only_in_reference.is_empty();
    let (width, height) = (image.width, image.height);
    Ok(Comparison { width, height, same, layers, only_in_image, only_in_reference, notes })
}

fn layer(
    image: &FileLayer,
    reference: &FileLayer,
    width: usize,
    encoded: bool,
    settings: &Settings,
) -> Result<LayerDifference, CompareError> {
    let values = values(image, reference, width).ok_or_else(|| CompareError::Channels {
        name: reference.title().to_owned(),
        image: channels(image).join(", "),
        reference: channels(reference).join(", "),
    })?;
    let colour = image.colour().zip(reference.colour());
    let colour = colour.map(|(i, r)| self::colour(i, r, width, encoded, &values, settings));
    let kind = if colour.is_some() { Kind::Colour } else { Kind::Data };
    let wider = if image.channels.len() > reference.channels.len() { image } else { reference };
    Ok(LayerDifference { name: reference.name.clone(), kind, channels: channels(wider), values, colour })
}

fn colour(
    image: [&[f32]; 3],
    reference: [&[f32]; 3],
    width: usize,
    encoded: bool,
    values: &Values,
    settings: &Settings,
) -> Colour {
    let relative = relative(image, reference);
    let weights: &[f64] = if values.mean_reference.len() == 3 { &LUMINANCE } else { &[1.0] };
    let mean = values.mean_reference.iter().zip(weights).map(|(c, weight)| c * weight).sum::<f64>();
    let auto = if encoded || mean.is_nan() || mean <= 0.0 { 0.0 } else { libm::log2(EXPOSED_TO / mean) };
    let exposure_ev = settings.exposure_ev.unwrap_or(auto);
    let (a, r) = (Shown::new(image, width, exposure_ev), Shown::new(reference, width, exposure_ev));
    let psnr_db = psnr_db(&a, &r);
    let mut colour = Colour { relative, exposure_ev, psnr_db, ssim: None, flip: None, flip_hdr: None };
    if settings.fast {
        return colour;
    }
    colour.ssim = ssim(&a, &r);
    colour.flip = Some(match psnr_db {
        f64::INFINITY => Pooled::default(),
        _ => flip::pool(&flip::ldr(&a.linear, &r.linear, width)),
    });
    if !encoded {
        let planes = |planes: [&[f32]; 3]| planes.map(<[f32]>::to_vec);
        let reference = planes(reference);
        colour.flip_hdr = flip::exposures(&reference).map(|exposures| {
            let same = values.max_error == 0.0 && values.non_finite.unmatched == 0;
            let pooled = match same {
                true => Pooled::default(),
                false => flip::pool(&flip::hdr(&planes(image), &reference, width, exposures)),
            };
            HdrFlip { pooled, exposures }
        });
    }
    colour
}

fn channels(layer: &FileLayer) -> Vec<String> {
    layer.channels.iter().map(|channel| channel.name.clone()).collect()
}

fn titles(file: &FileImage) -> String {
    file.layers.iter().map(FileLayer::title).collect::<Vec<_>>().join(", ")
}
