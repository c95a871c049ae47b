//! PNG files of 1 to 16 bits a channel, grey, colour or palette.
//!
//! The file's chunks are walked first. Only those that make the picture (IHDR, PLTE, IDAT, IEND) go on to
//! the decoder, so that compressed text, profiles and animation frames cost nothing.

use super::error::Reason;
use super::{Limits, triples};
use crate::optics::texture::Texels;
use image::codecs::png::PngDecoder;
use image::{ColorType, ImageDecoder};
use std::io::Cursor;

/// Deflate cannot do better than this: 258 bytes from two bits.
const MAX_DEFLATE_RATIO: u64 = 1032;

/// Width, height and texels by rows from the top.
pub fn decode(bytes: &[u8], limits: &Limits) -> Result<(usize, usize, Texels), Reason> {
    let picture = Picture::new(bytes)?;
    let wide = picture.bit_depth == 16;
    // As decoded (at most four channels), as texels, and their pyramid.
    limits.check(picture.width, picture.height, if wide { 8 + 6 + 4 } else { 4 + 3 + 4 })?;
    let bits = u64::from(picture.bit_depth) * picture.width * picture.height;
    if bits / 8 > picture.data_bytes.saturating_mul(MAX_DEFLATE_RATIO) {
        return Err(Reason::Invalid(format!(
            "{} bytes of data cannot hold {} × {} texels",
            picture.data_bytes, picture.width, picture.height
        )));
    }

    let image_limits = {
        let mut l = image::Limits::default();
        l.max_alloc = Some(limits.max_bytes);
        l.max_image_width = Some(limits.max_side);
        l.max_image_height = Some(limits.max_side);
        l
    };
    let decoder = PngDecoder::with_limits(Cursor::new(picture.chunks), image_limits)?;
    let (width, height) = decoder.dimensions();
    let color = decoder.color_type();
    let total = decoder.total_bytes();
    if total > limits.max_bytes || (u64::from(width), u64::from(height)) != (picture.width, picture.height) {
        return Err(Reason::TooLarge(format!("{total} bytes decoded")));
    }
    let mut buffer = vec![0u8; total as usize];
    decoder.read_image(&mut buffer)?;
    let texels = match color {
        ColorType::L8 => Texels::U8(buffer.iter().map(|&v| [v; 3]).collect()),
        ColorType::La8 => Texels::U8(buffer.as_chunks::<2>().0.iter().map(|&[v, _]| [v; 3]).collect()),
        ColorType::Rgb8 => Texels::U8(triples(&buffer)),
        ColorType::Rgba8 => {
            Texels::U8(buffer.as_chunks::<4>().0.iter().map(|&[r, g, b, _]| [r, g, b]).collect())
        }
        ColorType::L16 | ColorType::La16 | ColorType::Rgb16 | ColorType::Rgba16 => {
            let channels = usize::from(color.channel_count());
            let value = |texel: &[u8], c: usize| u16::from_ne_bytes([texel[2 * c], texel[2 * c + 1]]);
            let colors: fn(usize) -> [usize; 3] = if channels < 3 { |_| [0; 3] } else { |_| [0, 1, 2] };
            Texels::U16(
                buffer
                    .chunks_exact(2 * channels)
                    .map(|texel| colors(channels).map(|c| value(texel, c)))
                    .collect(),
            )
        }
        other => return Err(Reason::NotSupported(format!("PNG with texels of kind {other:?}"))),
    };
    Ok((width as usize, height as usize, texels))
}

/// What of a file makes its picture.
struct Picture {
    width: u64,
    height: u64,
    bit_depth: u8,
    /// Length of the compressed picture.
    data_bytes: u64,
    /// The signature and the chunks to decode.
    chunks: Vec<u8>,
}

impl Picture {
    fn new(bytes: &[u8]) -> Result<Picture, Reason> {
        let truncated =
            |at: usize| Reason::Invalid(format!("the PNG file ends early, in its chunk at byte {at}"));
        let (signature, mut rest) = bytes.split_at_checked(8).ok_or_else(|| truncated(0))?;
        let mut picture =
            Picture { width: 0, height: 0, bit_depth: 0, data_bytes: 0, chunks: signature.to_vec() };
        loop {
            let at = bytes.len() - rest.len();
            let (length, after) = rest.split_first_chunk::<4>().ok_or_else(|| truncated(at))?;
            let length = u32::from_be_bytes(*length) as usize;
            // Name, data, checksum.
            let body = after.get(..length.saturating_add(8)).ok_or_else(|| truncated(at))?;
            let (chunk, next) = rest.split_at(4 + body.len());
            let (name, data) = (&body[..4], &body[4..4 + length]);
            match name {
                b"IHDR" if at == 8 => picture.header(data)?,
                b"IHDR" => return Err(Reason::Invalid("a PNG file with two headers".into())),
                _ if at == 8 => return Err(Reason::Invalid("a PNG file without its header".into())),
                b"IDAT" => picture.data_bytes += length as u64,
                _ => {}
            }
            if matches!(name, b"IHDR" | b"PLTE" | b"IDAT" | b"IEND") {
                picture.chunks.extend_from_slice(chunk);
            }
            if name == b"IEND" {
                return Ok(picture);
            }
            rest = next;
        }
    }

    fn header(&mut self, data: &[u8]) -> Result<(), Reason> {
        let [w0, w1, w2, w3, h0, h1, h2, h3, depth, ..] = *data else {
            return Err(Reason::Invalid("a PNG header of wrong length".into()));
        };
        self.width = u64::from(u32::from_be_bytes([w0, w1, w2, w3]));
        self.height = u64::from(u32::from_be_bytes([h0, h1, h2, h3]));
        self.bit_depth = depth;
        Ok(())
    }
}
