//! OpenEXR files: the first layer with red, green and blue, or with luminance, at its full resolution.

use super::Limits;
use super::error::Reason;
use crate::optics::texture::Texels;
use exr::block::UncompressedBlock;
use exr::block::reader::{ChunksReader, Reader};
use exr::meta::BlockDescription;
use exr::meta::attribute::{ChannelList, SampleType};
use exr::meta::header::Header;
use std::io::Cursor;

/// Width, height and texels by rows from the top.
pub fn decode(bytes: &[u8], limits: &Limits) -> Result<(usize, usize, Texels), Reason> {
    let reader = Reader::read_from_buffered(Cursor::new(bytes), false)?;
    let (layer, channels) = chosen_layer(reader.headers())?;
    let header = &reader.headers()[layer];
    check(header, bytes.len(), limits)?;
    let chunks: u64 = reader.headers().iter().map(|h| h.chunk_count as u64).sum();
    // Each chunk has eight bytes in the table of offsets, and a header of as many.
    if chunks > bytes.len() as u64 / 16 {
        return Err(Reason::Invalid(format!(
            "{} bytes cannot hold {chunks} blocks of an EXR file",
            bytes.len()
        )));
    }

    let (width, height) = (header.layer_size.0, header.layer_size.1);
    let list = header.channels.clone();
    let mut texels = vec![[0f32; 3]; width * height];
    let mut blocks = reader
        .filter_chunks(false, |_, tile, block| block.layer == layer && tile.is_largest_resolution_level())?
        .sequential_decompressor(false);
    while let Some(block) = blocks.decompress_next_block() {
        copy(&block?, &list, channels, width, &mut texels)?;
    }
    Ok((width, height, Texels::F32(texels)))
}

/// The first layer that has a colour, and the channels of its red, green and blue.
fn chosen_layer(headers: &[Header]) -> Result<(usize, [usize; 3]), Reason> {
    let flat = headers.iter().enumerate().filter(|(_, h)| !h.deep);
    let found = flat.clone().find_map(|(i, h)| Some((i, colour_channels(&h.channels)?)));
    found.ok_or_else(|| {
        let names: Vec<_> =
            headers.iter().flat_map(|h| &h.channels.list).map(|c| c.name.to_string()).collect();
        let deep = if headers.iter().any(|h| h.deep) { "; deep layers are not read" } else { "" };
        Reason::NotSupported(format!("EXR without R, G, B or Y channels; found {}{deep}", names.join(", ")))
    })
}

/// R, G and B by themselves or within a group (`diffuse.R`), or Y for all three.
fn colour_channels(channels: &ChannelList) -> Option<[usize; 3]> {
    let names: Vec<String> = channels.list.iter().map(|c| c.name.to_string()).collect();
    let find = |name: &str| names.iter().position(|n| n == name);
    let group = |prefix: &str| {
        let [r, g, b] = ["R", "G", "B"].map(|c| find(&format!("{prefix}{c}")));
        Some([r?, g?, b?])
    };
    let grouped = || names.iter().filter_map(|n| n.strip_suffix('R')).find_map(group);
    group("").or_else(grouped).or_else(|| find("Y").map(|y| [y; 3]))
}

/// Sizes and kinds, from the header alone.
fn check(header: &Header, file_bytes: usize, limits: &Limits) -> Result<(), Reason> {
    let (width, height) = (header.layer_size.0 as u64, header.layer_size.1 as u64);
    // Texels as read and their pyramid, and all of a texel's channels in the block being decoded.
    let channel_bytes = header.channels.bytes_per_pixel as u64;
    limits.check(width, height, 12 + 4)?;
    if let BlockDescription::Tiles(tiles) = header.blocks {
        let (w, h) = (tiles.tile_size.0 as u64, tiles.tile_size.1 as u64);
        limits.check(w.min(width), h.min(height), 2 * channel_bytes)?;
    } else {
        // Blocks of scan lines have at most 256.
        limits.check(width, height.min(256), 2 * channel_bytes)?;
    }
    if header.channels.list.iter().any(|c| (c.sampling.0, c.sampling.1) != (1, 1)) {
        return Err(Reason::NotSupported("EXR with subsampled channels".into()));
    }
    let raw = u128::from(width) * u128::from(height) * u128::from(channel_bytes);
    if header.compression == exr::compression::Compression::Uncompressed && raw > file_bytes as u128 {
        return Err(Reason::Invalid(format!(
            "the EXR file ends early: {raw} bytes of texels in {file_bytes}"
        )));
    }
    Ok(())
}

/// Writes a block's three channels into the texels.
fn copy(
    block: &UncompressedBlock,
    list: &ChannelList,
    channels: [usize; 3],
    width: usize,
    texels: &mut [[f32; 3]],
) -> Result<(), Reason> {
    let outside = || Reason::Invalid("an EXR block outside of its image".into());
    for line in block.lines(list) {
        let (x, y, count) = (line.location.position.0, line.location.position.1, line.location.sample_count);
        if !channels.contains(&line.location.channel) {
            continue;
        }
        if x + count > width {
            return Err(outside());
        }
        let start = y * width + x;
        let row = texels.get_mut(start..start + count).ok_or_else(outside)?;
        let mut store = |i: usize, value: f32| {
            for (c, channel) in channels.iter().enumerate() {
                if *channel == line.location.channel {
                    row[i][c] = value;
                }
            }
        };
        match list.list[line.location.channel].sample_type {
            SampleType::F16 => {
                for (i, v) in line.read_samples::<exr::prelude::f16>().enumerate() {
                    store(i, v?.to_f32());
                }
            }
            SampleType::F32 => {
                for (i, v) in line.read_samples::<f32>().enumerate() {
                    store(i, v?);
                }
            }
            SampleType::U32 => {
                for (i, v) in line.read_samples::<u32>().enumerate() {
                    store(i, v? as f32);
                }
            }
        }
    }
    Ok(())
}
