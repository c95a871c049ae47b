//! PNG of any depth and colour, decoded from sRGB to linear light; alpha stays as it is.

use super::layers::{Part, grouped};
use super::{FileImage, ReadError, Samples, check_size};
use crate::output::srgb;
use png::{BitDepth, ColorType, Transformations};
use std::io::Cursor;

pub fn decode(bytes: &[u8]) -> Result<FileImage, ReadError> {
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info()?;
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    check_size(width, height, 4)?;
    let size = reader.output_buffer_size().ok_or_else(|| ReadError::NotSupported("its size".to_owned()))?;
    let mut data = vec![0; size];
    let info = reader.next_frame(&mut data)?;
    let values: Vec<u16> = match info.bit_depth {
        BitDepth::Sixteen => data.chunks_exact(2).map(|b| u16::from_be_bytes([b[0], b[1]])).collect(),
        _ => data.iter().map(|b| u16::from(*b)).collect(),
    };
    let max: u16 = if info.bit_depth == BitDepth::Sixteen { u16::MAX } else { 255 };
    let linear: Vec<f32> = (0..=max).map(|v| srgb::decode(f64::from(v) / f64::from(max)) as f32).collect();
    let (colours, step) = match info.color_type {
        ColorType::Grayscale => ([0; 3], 1),
        ColorType::GrayscaleAlpha => ([0; 3], 2),
        ColorType::Rgb => ([0, 1, 2], 3),
        ColorType::Rgba => ([0, 1, 2], 4),
        ColorType::Indexed => return Err(ReadError::Invalid("a palette that is missing".to_owned())),
    };
    let channel = |at: usize, table: &dyn Fn(u16) -> f32| {
        Samples::F32(values.iter().skip(at).step_by(step).map(|v| table(*v)).collect())
    };
    let mut channels: Vec<(String, Samples)> = Vec::new();
    for (name, at) in ["R", "G", "B"].into_iter().zip(colours) {
        channels.push((name.to_owned(), channel(at, &|v| linear[usize::from(v)])));
    }
    if step % 2 == 0 {
        channels.push(("A".to_owned(), channel(step - 1, &|v| f32::from(v) / f32::from(max))));
    }
    let layers = grouped(vec![Part { name: None, channels }]);
    Ok(FileImage { width, height, layers, encoded: true, notes: Vec::new() })
}

impl From<png::DecodingError> for ReadError {
    fn from(error: png::DecodingError) -> Self {
        ReadError::Invalid(format!("malformed PNG: {error}"))
    }
}
