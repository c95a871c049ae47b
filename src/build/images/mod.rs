//! Image files: read with limits, and made into textures and environments.
//!
//! What a file is, is decided by its content, not by its name. Sizes are taken from its header and held
//! against the limits before anything of that size is allocated; of PNG files the decoder sees the chunks
//! that make the picture and no others. Alpha is ignored: colours are taken as stored, which in PNG is
//! not multiplied by alpha and in EXR is. Embedded profiles and gamma values are ignored too.

mod error;
mod jpeg;
mod open_exr;
mod png;
mod textures;

pub use error::ImageError;
pub use textures::{Images, TextureUse};

use crate::description::Reach;
use crate::optics::texture::Texels;
use error::Reason;
use std::io::Read;
use std::path::Path;

/// What one image may cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Bytes that an image may take once it is loaded, pyramid and decoding included; also of its file.
    pub max_bytes: u64,
    /// Texels a side.
    pub max_side: u32,
}

impl Default for Limits {
    /// 1 GiB, 65536 texels a side.
    fn default() -> Limits {
        Limits { max_bytes: 1 << 30, max_side: 65536 }
    }
}

impl Limits {
    /// Refuses an image of this size; `texel_bytes` is all that each of its texels will take.
    fn check(&self, width: u64, height: u64, texel_bytes: u64) -> Result<(), Reason> {
        if width == 0 || height == 0 {
            return Err(Reason::Invalid(format!("an image of {width} × {height} texels")));
        }
        let side = u64::from(self.max_side);
        if width > side || height > side {
            return Err(Reason::TooLarge(format!("{width} × {height} texels; a side may have {side}")));
        }
        let bytes = u128::from(width) * u128::from(height) * u128::from(texel_bytes);
        if bytes > u128::from(self.max_bytes) {
            return Err(Reason::TooLarge(format!(
                "{width} × {height} texels × {texel_bytes} bytes = {bytes} bytes; the limit is {}",
                self.max_bytes
            )));
        }
        Ok(())
    }
}

/// The file formats that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Png,
    Jpeg,
    Exr,
}

impl Format {
    fn of(bytes: &[u8]) -> Result<Format, Reason> {
        if bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
            Ok(Format::Png)
        } else if bytes.starts_with(&[0xff, 0xd8, 0xff]) {
            Ok(Format::Jpeg)
        } else if bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
            Ok(Format::Exr)
        } else if bytes.is_empty() {
            Err(Reason::Invalid("the file is empty".into()))
        } else {
            Err(Reason::NotSupported("the content is not that of a PNG, JPEG or EXR file".into()))
        }
    }
}

/// An image as its file gives it.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadedImage {
    pub width: usize,
    pub height: usize,
    /// By rows from the top. Floats are finite and not negative.
    pub pixels: Texels,
    pub format: Format,
    /// What had to be mended, one sentence each, with the file's path.
    pub warnings: Vec<String>,
}

/// Reads an image file.
///
/// # Errors
/// [`ImageError`]: the file cannot be read, is malformed, is of a kind that is not supported, or is
/// larger than the limits.
pub fn load(path: &Path, limits: &Limits) -> Result<LoadedImage, ImageError> {
    load_within(&Reach::default(), path, limits)
}

/// As [`load`], of a file within reach.
fn load_within(reach: &Reach, path: &Path, limits: &Limits) -> Result<LoadedImage, ImageError> {
    let file = |e| ImageError::io(path, e);
    let mut bytes = Vec::new();
    // One byte more than allowed tells a file that is too large from one that just fits.
    let reader = reach.open(path).map_err(file)?;
    reader.take(limits.max_bytes.saturating_add(1)).read_to_end(&mut bytes).map_err(file)?;
    decode(path, &bytes, limits)
}

/// Decodes the content of an image file; `path` is for messages.
///
/// # Errors
/// As [`load`].
pub fn decode(path: &Path, bytes: &[u8], limits: &Limits) -> Result<LoadedImage, ImageError> {
    if bytes.len() as u64 > limits.max_bytes {
        let reason = format!("the file has more than {} bytes, the limit", limits.max_bytes);
        return Err(ImageError::new(path, Reason::TooLarge(reason)));
    }
    let read = || {
        let format = Format::of(bytes)?;
        let (width, height, pixels) = match format {
            Format::Png => png::decode(bytes, limits),
            Format::Jpeg => jpeg::decode(bytes, limits),
            Format::Exr => open_exr::decode(bytes, limits),
        }?;
        Ok(LoadedImage { width, height, pixels, format, warnings: Vec::new() })
    };
    // The decoders are other people's; should one panic on a malformed file, that is the file's error.
    let result = std::panic::catch_unwind(read)
        .unwrap_or_else(|_| Err(Reason::Invalid("the decoder failed on this file".into())));
    let mut image = result.map_err(|reason| ImageError::new(path, reason))?;
    if let Texels::F32(texels) = &mut image.pixels {
        image.warnings.extend(mended(texels).map(|what| format!("{}: {what}", path.display())));
    }
    Ok(image)
}

/// Replaces NaN and negative numbers by 0 and +∞ by the largest finite number of the image; says how
/// many there were.
fn mended(texels: &mut [[f32; 3]]) -> Option<String> {
    let finite = texels.iter().flatten().copied().filter(|v| v.is_finite()).fold(0.0, f32::max);
    let (mut nan, mut negative, mut infinite) = (0u64, 0u64, 0u64);
    for v in texels.iter_mut().flatten() {
        if v.is_nan() {
            nan += 1;
            *v = 0.0;
        } else if *v < 0.0 {
            negative += 1;
            *v = 0.0;
        } else if *v == f32::INFINITY {
            infinite += 1;
            *v = finite;
        }
    }
    (nan + negative + infinite > 0).then(|| {
        format!(
            "{nan} values that are not numbers and {negative} negative ones were replaced by 0, \
             {infinite} infinite ones by {finite}"
        )
    })
}

/// Bytes as triples; a tail of fewer than three is dropped.
fn triples<T: Copy>(values: &[T]) -> Vec<[T; 3]> {
    values.as_chunks::<3>().0.to_vec()
}

#[cfg(test)]
mod tests;
