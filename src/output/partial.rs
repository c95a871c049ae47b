//! Partial images: OpenEXR files that show a picture and hold the sums that it was made of.
//!
//! Two parts. The first is the picture, as any viewer shows it; its provenance says under `partial` what of the
//! image is there. The second, `sums`, has one channel of unsigned 32-bit integers, `word`: the sums, row after
//! row, the last row filled up with zeros. They are not compressed: most of their bits are chance. The picture's
//! attribute `terrariumChecksum` is that of the provenance, as [`checksum`] makes it of the text's bytes.

use super::exr::{ATTRIBUTE, picture_with, save, text};
use super::parts::{Part, Values};
use super::{Image, OutputError, Provenance};
use crate::math::random::combine;
use exr::block::chunk::CompressedBlock;
use exr::meta::BlockDescription;
use exr::meta::attribute::SampleType;
use exr::meta::header::Header;
use exr::prelude::{AttributeValue, Compression, LayerAttributes, Vec2};
use rayon::prelude::*;
use std::io::{BufReader, ErrorKind, Read, Seek, SeekFrom, Write};

/// Words in a row of the file.
const ROW: usize = 8192;
const ROW_BYTES: usize = ROW * size_of::<u32>();

/// Bytes that are read at one go.
const BUFFER: usize = 1 << 20;

/// Names of the parts.
const PICTURE: &str = "picture";
const SUMS: &str = "sums";

/// The attribute with the checksum of the provenance.
const SEAL: &str = "terrariumChecksum";

/// Why a file is no partial image.
#[derive(Debug, thiserror::Error)]
pub enum PartialError {
    #[error("{0}")]
    Io(#[from] std::io::Error),
    /// A file of another kind.
    #[error("{0}")]
    Other(String),
    #[error("damaged: {0}")]
    Damaged(String),
}

/// Writes a picture with its sums.
pub fn write(
    sink: impl Write + Seek,
    image: &Image,
    provenance: &Provenance,
    mut words: Vec<u32>,
) -> Result<(), OutputError> {
    let (first, _) = picture_with(image, provenance, |attributes| {
        attributes.layer_name = Some(text(PICTURE));
        let own = &mut attributes.other;
        if let Some(AttributeValue::Text(said)) = own.get(&text(ATTRIBUTE)) {
            let seal = AttributeValue::Text(text(&seal(&said.to_string())));
            own.insert(text(SEAL), seal);
        }
    })?;
    let rows = words.len().div_ceil(ROW).max(1);
    words.resize(rows * ROW, 0);
    let sums = Part::new(
        Vec2(ROW, rows),
        Compression::Uncompressed,
        LayerAttributes::named(SUMS),
        vec![(text("word"), Values::U32(&words))],
    );
    save(sink, image, &[first, sums])
}

/// The provenance of a partial image, and its sums with the zeros at their end. Its picture is passed over.
pub fn read(mut source: impl Read + Seek) -> Result<(Provenance, Vec<u32>), PartialError> {
    let length = source.seek(SeekFrom::End(0))?;
    source.rewind()?;
    let reader = exr::block::read(BufReader::with_capacity(BUFFER, source), false).map_err(unreadable)?;
    let headers = reader.headers();
    let said = |name: &str| {
        let found = headers.iter().find_map(|part| part.own_attributes.other.get(&text(name)))?;
        found.to_text().ok().map(|text| text.to_string())
    };
    let Some(provenance) = said(ATTRIBUTE) else {
        return Err(PartialError::Other("an EXR file of another program".to_owned()));
    };
    let named = |part: &Header| part.own_attributes.layer_name.as_ref().is_some_and(|name| *name == *SUMS);
    let Some((sums, rows)) = headers.iter().enumerate().find(|(_, part)| named(part)).and_then(rows) else {
        return Err(PartialError::Other("an image without its sums: no part of one".to_owned()));
    };
    if said(SEAL) != Some(seal(&provenance)) {
        return Err(PartialError::Damaged("what it says of itself is not what was written".to_owned()));
    }
    let provenance: Provenance = serde_json::from_str(&provenance).map_err(|error| {
        PartialError::Other(format!("an EXR file with an attribute `{ATTRIBUTE}` of another kind: {error}"))
    })?;
    if rows as u64 * ROW_BYTES as u64 > length {
        return Err(PartialError::Damaged("sums are missing".to_owned()));
    }
    let chunks = reader.filter_chunks(false, |_, _, block| block.layer == sums).map_err(unreadable)?;
    let mut words = vec![0; rows * ROW];
    let mut read = 0;
    for chunk in chunks {
        let CompressedBlock::ScanLine(line) = chunk.map_err(unreadable)?.compressed_block else {
            return Err(PartialError::Damaged("sums of another kind".to_owned()));
        };
        let row = usize::try_from(line.y_coordinate).ok().filter(|row| *row < rows);
        let bytes = line.compressed_pixels_le.as_slice();
        let (Some(row), ROW_BYTES) = (row, bytes.len()) else {
            return Err(PartialError::Damaged("a row of sums of another size or place".to_owned()));
        };
        let (list, _) = bytes.as_chunks::<4>();
        words[row * ROW..].iter_mut().zip(list).for_each(|(word, bytes)| *word = u32::from_le_bytes(*bytes));
        read += 1;
    }
    if read < rows {
        return Err(PartialError::Damaged("rows of sums are missing".to_owned()));
    }
    Ok((provenance, words))
}

/// The number of the part that holds the sums and its rows, if they are as [`write`] writes them.
fn rows((number, part): (usize, &Header)) -> Option<(usize, usize)> {
    let [channel] = part.channels.list.as_slice() else { return None };
    let plain = part.compression == Compression::Uncompressed
        && part.blocks == BlockDescription::ScanLines
        && !part.deep
        && channel.sample_type == SampleType::U32
        && channel.sampling == Vec2(1, 1)
        && part.layer_size.width() == ROW;
    plain.then_some((number, part.layer_size.height()))
}

fn unreadable(error: exr::error::Error) -> PartialError {
    match error {
        exr::error::Error::Io(error) => match error.kind() {
            // places in the file that cannot be
            ErrorKind::InvalidInput | ErrorKind::InvalidData | ErrorKind::UnexpectedEof => {
                PartialError::Damaged(format!("no part of it can be where it says: {error}"))
            }
            _ => PartialError::Io(error),
        },
        other => PartialError::Other(format!("no OpenEXR file that can be read: {other}")),
    }
}

/// The checksum of a text, in hexadecimal.
fn seal(text: &str) -> String {
    let words: Vec<u32> = text.bytes().map(u32::from).collect();
    format!("{:016x}", checksum(&words))
}

/// A number that changes with any word: to find damage, not malice. That of the rows' numbers.
pub fn checksum(words: &[u32]) -> u64 {
    let row = |row: &[u32]| {
        let (groups, rest) = row.as_chunks::<{ 2 * LANES }>();
        let mut lanes = [row.len() as u64; LANES];
        for group in groups {
            for (i, lane) in lanes.iter_mut().enumerate() {
                *lane = combine(*lane, u64::from(group[2 * i]) | u64::from(group[2 * i + 1]) << 32);
            }
        }
        let sum = lanes.into_iter().fold(0, combine);
        rest.iter().fold(sum, |sum, word| combine(sum, u64::from(*word)))
    };
    let rows: Vec<u64> = words.par_chunks(ROW).map(row).collect();
    rows.into_iter().fold(words.len() as u64, combine)
}

/// Sums of a row that do not wait for each other.
const LANES: usize = 4;
