//! Partial images: OpenEXR files that show a picture and hold the sums that it was made of.
//!
//! Two parts. The first is the picture, as any viewer shows it; its provenance says under `partial` what of the
//! image is there. The second, `sums`, has one channel of unsigned 32-bit integers, `word`: the sums, row after
//! row, the last row filled up with zeros. They are not compressed: most of their bits are chance.

use super::exr::{ATTRIBUTE, picture, save, text};
use super::{Image, OutputError, Provenance};
use crate::math::random::combine;
use exr::image::{Blocks, Encoding};
use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Compression, FlatSamples, Layer, LayerAttributes, LineOrder,
    ReadChannels, ReadLayers, SmallVec, read as reading,
};
use std::io::{BufReader, Read, Seek, Write};

/// Words in a row of the file.
const ROW: usize = 8192;

/// Names of the parts.
const PICTURE: &str = "picture";
const SUMS: &str = "sums";

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
    let (mut first, _) = picture(image, provenance)?;
    first.attributes.layer_name = Some(text(PICTURE));
    let rows = words.len().div_ceil(ROW).max(1);
    words.resize(rows * ROW, 0);
    let encoding = Encoding {
        compression: Compression::Uncompressed,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let channels = SmallVec::from_iter([AnyChannel::new("word", FlatSamples::U32(words))]);
    let sums = Layer::new((ROW, rows), LayerAttributes::named(SUMS), encoding, AnyChannels::sort(channels));
    save(sink, image, [first, sums])
}

/// The provenance of a partial image, and its sums with the zeros at their end.
pub fn read(source: impl Read + Seek + Send) -> Result<(Provenance, Vec<u32>), PartialError> {
    let file = reading()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .from_buffered(BufReader::new(source))
        .map_err(|error| match error {
            exr::error::Error::Io(error) => PartialError::Io(error),
            other => PartialError::Other(format!("no OpenEXR file that can be read: {other}")),
        })?;
    let provenance = file.layer_data.iter().find_map(|layer| layer.attributes.other.get(&text(ATTRIBUTE)));
    let Some(AttributeValue::Text(provenance)) = provenance else {
        return Err(PartialError::Other("an EXR file of another program".to_owned()));
    };
    let provenance: Provenance = serde_json::from_str(&provenance.to_string()).map_err(|error| {
        PartialError::Other(format!("an EXR file with an attribute `{ATTRIBUTE}` of another kind: {error}"))
    })?;
    let sums = file
        .layer_data
        .into_iter()
        .find(|layer| layer.attributes.layer_name.as_ref().is_some_and(|name| *name == *SUMS));
    let words = sums.and_then(|layer| match layer.channel_data.list.into_iter().next()?.sample_data {
        FlatSamples::U32(words) => Some(words),
        _ => None,
    });
    match words {
        Some(words) => Ok((provenance, words)),
        None => Err(PartialError::Other("an image without its sums: no part of one".to_owned())),
    }
}

/// A number that changes with any word: to find damage, not malice.
pub fn checksum(words: &[u32]) -> u64 {
    let (pairs, rest) = words.as_chunks::<2>();
    let of = |sum: u64, [low, high]: [u32; 2]| combine(sum, u64::from(low) | u64::from(high) << 32);
    let sum = pairs.iter().fold(words.len() as u64, |sum, pair| of(sum, *pair));
    rest.iter().fold(sum, |sum, word| of(sum, [*word, 0]))
}
