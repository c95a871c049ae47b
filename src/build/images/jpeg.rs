//! JPEG files, baseline and progressive, grey and colour.
//!
//! The decoder fills up what a truncated file lacks, so the file's markers are walked first, to its end.

use super::error::Reason;
use super::{Limits, triples};
use crate::optics::texture::Texels;
use image::codecs::jpeg::JpegDecoder;
use image::{ColorType, ImageDecoder};
use std::io::Cursor;

/// Scans of a progressive file; more than a dozen is unusual, thousands are an attack.
const MAX_SCANS: u32 = 128;

/// Width, height and texels by rows from the top.
pub fn decode(bytes: &[u8], limits: &Limits) -> Result<(usize, usize, Texels), Reason> {
    let frame = Frame::new(bytes)?;
    // Coefficients and samples while decoding (three of each), as decoded, as texels, their pyramid.
    limits.check(frame.width, frame.height, 6 + 3 + 3 + 3 + 4)?;
    // At least one bit a block of 8 × 8, for its mean.
    let blocks = frame.width.div_ceil(8) * frame.height.div_ceil(8);
    if blocks > 8 * bytes.len() as u64 {
        return Err(Reason::Invalid(format!(
            "{} bytes cannot hold {} × {} texels",
            bytes.len(),
            frame.width,
            frame.height
        )));
    }
    let mut decoder = JpegDecoder::new(Cursor::new(bytes))?;
    let (width, height) = decoder.dimensions();
    if (u64::from(width), u64::from(height)) != (frame.width, frame.height) {
        return Err(Reason::Invalid("a JPEG file with two sizes".into()));
    }
    let mut image_limits = image::Limits::default();
    image_limits.max_alloc = Some(limits.max_bytes);
    image_limits.max_image_width = Some(limits.max_side);
    image_limits.max_image_height = Some(limits.max_side);
    decoder.set_limits(image_limits)?;
    let color = decoder.color_type();
    let mut buffer = vec![0u8; decoder.total_bytes() as usize];
    decoder.read_image(&mut buffer)?;
    let texels = match color {
        ColorType::L8 => buffer.iter().map(|&v| [v; 3]).collect(),
        ColorType::Rgb8 => triples(&buffer),
        other => return Err(Reason::NotSupported(format!("JPEG with texels of kind {other:?}"))),
    };
    Ok((width as usize, height as usize, Texels::U8(texels)))
}

/// The picture's size, from a file whose markers are complete.
struct Frame {
    width: u64,
    height: u64,
}

impl Frame {
    fn new(bytes: &[u8]) -> Result<Frame, Reason> {
        let truncated = || Reason::Invalid("the JPEG file ends early".into());
        let mut frame = None;
        let mut scans = 0;
        // Behind the start-of-image marker.
        let mut at = 2;
        loop {
            let marker = next_marker(bytes, &mut at).ok_or_else(truncated)?;
            match marker {
                // Restart markers, and one without meaning, stand alone.
                0xd0..=0xd7 | 0x01 => continue,
                0xd9 => break,
                0xd8 => return Err(Reason::Invalid("a JPEG file that starts twice".into())),
                _ => {}
            }
            let length = bytes.get(at..at + 2).ok_or_else(truncated)?;
            let length = usize::from(u16::from_be_bytes([length[0], length[1]]));
            let segment = bytes.get(at + 2..at + length.max(2)).ok_or_else(truncated)?;
            at += length.max(2);
            match marker {
                // Frames of any kind; c4, c8 and cc are tables.
                0xc0..=0xcf if !matches!(marker, 0xc4 | 0xc8 | 0xcc) => {
                    let [_, h0, h1, w0, w1, ..] = *segment else { return Err(truncated()) };
                    let [width, height] = [[w0, w1], [h0, h1]].map(|b| u64::from(u16::from_be_bytes(b)));
                    if frame.replace(Frame { width, height }).is_some() {
                        return Err(Reason::NotSupported("a JPEG file with several frames".into()));
                    }
                }
                0xda => scans += 1,
                _ => {}
            }
            if scans > MAX_SCANS {
                return Err(Reason::TooLarge(format!("a JPEG file with more than {MAX_SCANS} scans")));
            }
        }
        if scans == 0 {
            return Err(Reason::Invalid("a JPEG file without a picture".into()));
        }
        frame.ok_or_else(|| Reason::Invalid("a JPEG file without its size".into()))
    }
}

/// The next marker's second byte; `at` moves behind it. Compressed data up to it is skipped.
fn next_marker(bytes: &[u8], at: &mut usize) -> Option<u8> {
    loop {
        let &[a, b] = bytes.get(*at..*at + 2)? else { return None };
        match (a, b) {
            (0xff, 0xff) => *at += 1,
            (0xff, 0) => *at += 2,
            (0xff, marker) => {
                *at += 2;
                return Some(marker);
            }
            _ => *at += 1,
        }
    }
}
