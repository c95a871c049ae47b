//! The parts of an OpenEXR file, and the chunks that their scan lines become.
//!
//! The `exr` crate lays out the file. Chunks are made here for two reasons: lines are gathered from the channels
//! as they lie in memory, without a copy of the image, and ZIP chunks are deflated at level 1 (see [`LEVEL`]).

use exr::block::chunk::{Chunk, CompressedBlock, CompressedScanLineBlock};
use exr::block::writer::ChunksWriter;
use exr::meta::BlockDescription;
use exr::meta::attribute::{ChannelDescription, SampleType};
use exr::meta::header::Header;
use exr::prelude::{Compression, ImageAttributes, LayerAttributes, LineOrder, SmallVec, Text, Vec2};
use miniz_oxide::deflate::core::{
    CompressorOxide, TDEFLFlush, TDEFLStatus, compress, create_comp_flags_from_zip_params,
};
use rayon::prelude::*;
use std::io::{Seek, Write};

/// Of deflating: the `exr` crate's own level, 4, takes four times as long for files that are 1 to 6 % smaller.
const LEVEL: i32 = 1;

/// Of zlib's format, in bits: the largest.
const WINDOW: i32 = 15;

/// Chunks that are made side by side before they are written, by thread.
const WAVE: usize = 4;

/// The values of a channel, row by row.
pub enum Values<'a> {
    /// Those that are not finite are written as 0.
    F32(&'a [f32]),
    U32(&'a [u32]),
}

/// A part of a file: scan lines of channels.
pub struct Part<'a> {
    header: Header,
    /// In the header's order.
    channels: Vec<Values<'a>>,
}

impl<'a> Part<'a> {
    /// Of width × height values a channel; the channels in any order.
    ///
    /// `compression` is [`Compression::Uncompressed`], `ZIP1` or `ZIP16`.
    pub fn new(
        size: Vec2<usize>,
        compression: Compression,
        attributes: LayerAttributes,
        mut channels: Vec<(Text, Values<'a>)>,
    ) -> Part<'a> {
        // A file's channels are in the order of their names.
        channels.sort_by(|a, b| a.0.cmp(&b.0));
        let described =
            |(name, values): &(Text, Values)| ChannelDescription::named(name.clone(), values.kind());
        let header = Header::new(Text::default(), size, channels.iter().map(described).collect())
            .with_encoding(compression, BlockDescription::ScanLines, LineOrder::Increasing)
            .with_attributes(attributes);
        Part { header, channels: channels.into_iter().map(|(_, values)| values).collect() }
    }

    /// The lines of a chunk, counted from the top.
    fn lines(&self, chunk: usize) -> std::ops::Range<usize> {
        let lines = self.header.compression.scan_lines_per_block();
        chunk * lines..((chunk + 1) * lines).min(self.header.layer_size.height())
    }

    fn chunk(&self, part: usize, chunk: usize, deflater: &mut Deflater) -> Chunk {
        let (lines, width) = (self.lines(chunk), self.header.layer_size.width());
        let plain = || {
            let mut bytes = Vec::with_capacity(lines.len() * width * self.channels.len() * 4);
            self.each_word(lines.clone(), |word| bytes.extend(word));
            bytes
        };
        let packed = if self.header.compression == Compression::Uncompressed {
            None
        } else {
            deflater.begin(lines.len() * width * self.channels.len() * 4);
            let mut at = 0;
            self.each_word(lines.clone(), |word| {
                deflater.put(at, word);
                at += 1;
            });
            deflater.deflated()
        };
        let y_coordinate = lines.start as i32 + self.header.own_attributes.layer_position.y();
        // What would not become smaller is stored as it is.
        let compressed_pixels_le = packed.unwrap_or_else(plain);
        let block = CompressedScanLineBlock { y_coordinate, compressed_pixels_le };
        Chunk { layer_index: part, compressed_block: CompressedBlock::ScanLine(block) }
    }

    /// The values of lines in the order of the file: line by line, channel by channel.
    fn each_word(&self, lines: std::ops::Range<usize>, mut put: impl FnMut([u8; 4])) {
        let width = self.header.layer_size.width();
        for line in lines {
            let row = line * width..(line + 1) * width;
            for channel in &self.channels {
                match channel {
                    Values::F32(values) => values[row.clone()]
                        .iter()
                        .for_each(|v| put(if v.is_finite() { v.to_le_bytes() } else { [0; 4] })),
                    Values::U32(values) => values[row.clone()].iter().for_each(|v| put(v.to_le_bytes())),
                }
            }
        }
    }
}

impl Values<'_> {
    fn kind(&self) -> SampleType {
        match self {
            Values::F32(_) => SampleType::F32,
            Values::U32(_) => SampleType::U32,
        }
    }
}

/// Writes a file of these parts. The same parts give the same bytes, with any number of threads.
pub fn write<const N: usize>(
    sink: impl Write + Seek,
    shared: &ImageAttributes,
    parts: &[Part; N],
) -> exr::error::UnitResult {
    let headers = parts
        .iter()
        .map(|part| part.header.clone().with_shared_attributes(shared.clone()))
        .collect::<SmallVec<_>>();
    let wave = WAVE * rayon::current_num_threads();
    exr::block::write(sink, headers, true, |_, file| {
        for (number, part) in parts.iter().enumerate() {
            let count = part.header.chunk_count;
            for begin in (0..count).step_by(wave) {
                let chunks: Vec<Chunk> = (begin..(begin + wave).min(count))
                    .into_par_iter()
                    .map_init(Deflater::default, |deflater, chunk| part.chunk(number, chunk, deflater))
                    .collect();
                for (chunk, made) in (begin..).zip(chunks) {
                    file.write_chunk(chunk, made)?;
                }
            }
        }
        Ok(())
    })
}

/// Makes ZIP chunks: bytes of even and of odd places apart, the difference of each to the one before, deflated
/// (OpenEXR's file layout, "ZIP").
struct Deflater {
    compressor: Box<CompressorOxide>,
    bytes: Vec<u8>,
}

impl Default for Deflater {
    fn default() -> Deflater {
        let flags = create_comp_flags_from_zip_params(LEVEL, WINDOW, 0);
        Deflater { compressor: Box::new(CompressorOxide::new(flags)), bytes: Vec::new() }
    }
}

impl Deflater {
    /// Makes room for a chunk of so many bytes, a multiple of 4.
    fn begin(&mut self, len: usize) {
        self.bytes.resize(len, 0);
    }

    /// Puts a chunk's word with this number to its places.
    #[inline]
    fn put(&mut self, number: usize, [a, b, c, d]: [u8; 4]) {
        let half = self.bytes.len() / 2;
        let (even, odd) = self.bytes.split_at_mut(half);
        even[2 * number..][..2].copy_from_slice(&[a, c]);
        odd[2 * number..][..2].copy_from_slice(&[b, d]);
    }

    /// The chunk, if that is smaller than its bytes.
    fn deflated(&mut self) -> Option<Vec<u8>> {
        let mut before = self.bytes[0];
        for byte in &mut self.bytes[1..] {
            let difference = byte.wrapping_sub(before).wrapping_add(128);
            before = std::mem::replace(byte, difference);
        }
        let mut chunk = vec![0; self.bytes.len() - 1];
        self.compressor.reset();
        let (status, _, len) = compress(&mut self.compressor, &self.bytes, &mut chunk, TDEFLFlush::Finish);
        chunk.truncate(len);
        (status == TDEFLStatus::Done).then_some(chunk)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use exr::prelude::*;
    use std::io::Cursor;

    /// Values that deflate well, not at all, and are not finite here and there; chunks of one line and of sixteen,
    /// the last one shorter; a part beside the corner.
    #[test]
    fn what_is_written_is_read_back_to_the_bit() {
        const WIDTH: usize = 37;
        for height in [1, 16, 35] {
            let n = WIDTH * height;
            let chance = |i: usize| f32::from_bits((i as u32 + 1).wrapping_mul(0x9e37_79b9));
            let noise: Vec<f32> = (0..n).map(chance).collect();
            let even = vec![0.25f32; n];
            let words: Vec<u32> = (0..n as u32).map(|i| i.wrapping_mul(0x85eb_ca6b)).collect();
            let name = |name: &str| LayerAttributes::named(name);
            let [a, b] = [Compression::ZIP16, Compression::ZIP1].map(|compression| {
                let mut attributes = name(&compression.to_string());
                attributes.layer_position = Vec2(3, 5);
                let channels =
                    vec![(Text::from("noise"), Values::F32(&noise)), ("even".into(), Values::F32(&even))];
                Part::new(Vec2(WIDTH, height), compression, attributes, channels)
            });
            let plain = vec![("word".into(), Values::U32(&words))];
            let c = Part::new(Vec2(WIDTH, height), Compression::Uncompressed, name("plain"), plain);
            let mut file = Cursor::new(Vec::new());
            let shared = ImageAttributes::new(IntegerBounds::from_dimensions(Vec2(100, 100)));
            write(&mut file, &shared, &[a, b, c]).expect("it is written");

            let reader =
                read().no_deep_data().largest_resolution_level().all_channels().all_layers().all_attributes();
            let image = reader.pedantic().from_buffered(Cursor::new(file.into_inner())).expect("it is read");
            let finite = |v: f32| if v.is_finite() { v } else { 0.0 };
            assert!(noise.iter().any(|v| !v.is_finite()) || height == 1);
            for layer in &image.layer_data[..2] {
                let [first, second] = &layer.channel_data.list[..] else { panic!("two channels") };
                assert_eq!((&first.name, &second.name), (&Text::from("even"), &Text::from("noise")));
                let FlatSamples::F32(values) = &second.sample_data else { panic!("of singles") };
                let bits =
                    |values: &mut dyn Iterator<Item = f32>| values.map(f32::to_bits).collect::<Vec<_>>();
                assert_eq!(bits(&mut values.iter().copied()), bits(&mut noise.iter().map(|&v| finite(v))));
                assert!(first.sample_data.values_as_f32().all(|v| v == 0.25));
                assert_eq!(layer.attributes.layer_position, Vec2(3, 5));
            }
            let channel = &image.layer_data[2].channel_data.list[0];
            assert!(matches!(&channel.sample_data, FlatSamples::U32(read) if *read == words));
        }
    }
}
