//! PNG: the picture for the screen, 8 or 16 bits a channel, sRGB, without alpha.
//!
//! Radiance is multiplied by 2^exposure, clamped to [0, 1], encoded (see `srgb`) and rounded to
//! the nearest integer, halves to even. Every pixel that the clamp changed is counted. The file
//! says that it is sRGB (chunks `sRGB` and, for older readers, `gAMA`) and carries the provenance as text.

use super::{Image, Layer, OutputError, Provenance, Written, srgb};
use rayon::prelude::*;
use std::io::{BufWriter, Write};

/// How radiance becomes a PNG.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PngSettings {
    /// Stops: radiance is multiplied by 2^exposure_ev. Finite.
    pub exposure_ev: f64,
    pub bits: Bits,
}

/// Bits a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bits {
    Eight,
    Sixteen,
}

impl Default for PngSettings {
    fn default() -> Self {
        PngSettings { exposure_ev: 0.0, bits: Bits::Eight }
    }
}

/// Writes the picture (the layer without a name). The same image gives the same bytes.
pub fn write(
    sink: impl Write,
    image: &Image,
    provenance: &Provenance,
    settings: PngSettings,
) -> Result<Written, OutputError> {
    if let Some(defect) = image.defect() {
        return Err(OutputError::Invalid(defect));
    }
    let (Ok(width), Ok(height)) = (u32::try_from(image.width), u32::try_from(image.height)) else {
        return Err(OutputError::NotSupported("a PNG wider or higher than 4294967295".to_string()));
    };
    let beauty =
        image.beauty().ok_or_else(|| OutputError::Invalid("an image without a picture".to_string()))?;
    let (pixels, written) = pixels(beauty, image.width, settings)?;

    let mut sink = BufWriter::new(sink);
    let mut encoder = png::Encoder::new(&mut sink, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(match settings.bits {
        Bits::Eight => png::BitDepth::Eight,
        Bits::Sixteen => png::BitDepth::Sixteen,
    });
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.add_text_chunk("Software".to_string(), provenance.software.clone())?;
    if let Some(stamp) = &provenance.stamp {
        encoder.add_text_chunk("Creation Time".to_string(), stamp.date())?;
    }
    encoder.add_text_chunk(super::exr::ATTRIBUTE.to_string(), provenance.about(image).to_json())?;
    let mut writer = encoder.write_header()?;
    // for readers that don't know the sRGB chunk: the nearest power law, 1/2.2, in 1/100000
    writer.write_chunk(png::chunk::gAMA, &45_455u32.to_be_bytes())?;
    writer.write_image_data(&pixels)?;
    writer.finish()?;
    sink.flush()?;
    Ok(written)
}

/// The file's bytes before compression, big-endian, and what was changed to get them.
fn pixels(beauty: &Layer, width: usize, settings: PngSettings) -> Result<(Vec<u8>, Written), OutputError> {
    let channel = |name: &str| {
        beauty.channel(name).ok_or_else(|| OutputError::Invalid(format!("a picture without channel {name}")))
    };
    let [red, green, blue] = [channel("R")?, channel("G")?, channel("B")?];
    let gain = libm::exp2(settings.exposure_ev);
    let bytes = match settings.bits {
        Bits::Eight => 1,
        Bits::Sixteen => 2,
    };
    let mut data = vec![0u8; red.len() * 3 * bytes];
    let written = data
        .par_chunks_mut(width * 3 * bytes)
        .enumerate()
        .map(|(y, row)| {
            let mut written = Written::default();
            for (x, pixel) in row.chunks_exact_mut(3 * bytes).enumerate() {
                let i = y * width + x;
                encode_pixel([red[i], green[i], blue[i]], gain, pixel, &mut written);
            }
            written
        })
        .reduce(Written::default, Written::plus);
    Ok((data, written))
}

/// Encodes one pixel into its 3 or 6 bytes.
fn encode_pixel(radiance: [f32; 3], gain: f64, out: &mut [u8], written: &mut Written) {
    let mut clamped = false;
    let size = out.len() / 3;
    for (value, bytes) in radiance.into_iter().zip(out.chunks_exact_mut(size)) {
        let linear = if value.is_finite() {
            f64::from(value) * gain
        } else {
            written.non_finite += 1;
            0.0
        };
        clamped |= !(0.0..=1.0).contains(&linear);
        let signal = srgb::encode(linear.clamp(0.0, 1.0));
        if size == 1 {
            bytes[0] = srgb::quantise(signal, 255) as u8;
        } else {
            bytes.copy_from_slice(&srgb::quantise(signal, u16::MAX).to_be_bytes());
        }
    }
    written.clamped_pixels += u64::from(clamped);
}

impl From<png::EncodingError> for OutputError {
    fn from(error: png::EncodingError) -> Self {
        match error {
            png::EncodingError::IoError(error) => OutputError::Io(error),
            other => OutputError::Invalid(other.to_string()),
        }
    }
}
