//! OpenEXR: every flat part and channel, at full resolution, of any compression that the `exr` crate reads.

use super::layers::{Part, grouped};
use super::{FileImage, ReadError, Samples, check_size};
use exr::meta::MetaData;
use exr::meta::header::Header;
use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, Vec2, read};
use std::io::Cursor;

pub fn decode(bytes: &[u8]) -> Result<FileImage, ReadError> {
    let headers = MetaData::read_from_buffered(Cursor::new(bytes), false)?.headers;
    check(&headers, bytes.len())?;
    let file = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))?;
    let window = file.attributes.display_window;
    let several = file.layer_data.len() > 1;
    let mut notes = Vec::new();
    let mut parts = Vec::new();
    for layer in file.layer_data {
        let placed = Placed {
            shown: window.size,
            stored: layer.size,
            offset: layer.attributes.layer_position - window.position,
        };
        if let Some(note) = placed.note()
            && !notes.contains(&note)
        {
            notes.push(note);
        }
        let name = layer.attributes.layer_name.as_ref().map(ToString::to_string);
        let channels = layer.channel_data.list.into_iter().map(|channel| {
            let samples = match channel.sample_data {
                FlatSamples::F32(values) => Samples::F32(placed.shown(values)),
                FlatSamples::F16(values) => {
                    Samples::F32(placed.shown(values.into_iter().map(|v| v.to_f32()).collect()))
                }
                FlatSamples::U32(values) => Samples::U32(placed.shown(values)),
            };
            (channel.name.to_string(), samples)
        });
        parts.push(Part { name: name.filter(|_| several), channels: channels.collect() });
    }
    let layers = grouped(parts);
    if layers.is_empty() {
        return Err(ReadError::Invalid("an EXR file without channels".to_owned()));
    }
    Ok(FileImage { width: window.size.0, height: window.size.1, layers, encoded: false, notes })
}

/// Sizes and kinds, from the headers alone.
fn check(headers: &[Header], bytes: usize) -> Result<(), ReadError> {
    if headers.iter().any(|header| header.deep) {
        return Err(ReadError::NotSupported("EXR with deep data".to_owned()));
    }
    // each chunk has eight bytes in the table of offsets, and a header of as many
    let chunks: u64 = headers.iter().map(|header| header.chunk_count as u64).sum();
    if chunks > bytes as u64 / 16 {
        return Err(ReadError::Invalid(format!("{bytes} bytes cannot hold {chunks} blocks of an EXR file")));
    }
    let channels = headers.iter().map(|header| header.channels.list.len()).sum();
    for header in headers {
        let shown = header.shared_attributes.display_window.size;
        check_size(shown.0, shown.1, channels)?;
        check_size(header.layer_size.0, header.layer_size.1, channels)?;
        if header.channels.list.iter().any(|channel| channel.sampling != Vec2(1, 1)) {
            return Err(ReadError::NotSupported("EXR with subsampled channels".to_owned()));
        }
    }
    Ok(())
}

/// A data window in a display window.
struct Placed {
    shown: Vec2<usize>,
    stored: Vec2<usize>,
    /// Of the data window's corner from the display window's.
    offset: Vec2<i32>,
}

impl Placed {
    fn note(&self) -> Option<String> {
        let Placed { shown, stored, offset } = self;
        (stored != shown || *offset != Vec2(0, 0)).then(|| {
            format!(
                "stores {} × {} pixels at ({}, {}) of {} × {}; missing ones are 0, those outside are left out",
                stored.0, stored.1, offset.0, offset.1, shown.0, shown.1
            )
        })
    }

    /// The stored values as the display window has them.
    fn shown<T: Copy + Default>(&self, values: Vec<T>) -> Vec<T> {
        if self.note().is_none() {
            return values;
        }
        // first stored and first shown place, and how many are both, along one axis
        let overlap = |shown: usize, stored: usize, offset: i32| {
            let (skip, start) = (offset.min(0).unsigned_abs() as usize, offset.max(0) as usize);
            (skip, start, stored.saturating_sub(skip).min(shown.saturating_sub(start)))
        };
        let (skip_x, start_x, columns) = overlap(self.shown.0, self.stored.0, self.offset.0);
        let (skip_y, start_y, rows) = overlap(self.shown.1, self.stored.1, self.offset.1);
        let mut whole = vec![T::default(); self.shown.0 * self.shown.1];
        for row in 0..rows {
            let from = (skip_y + row) * self.stored.0 + skip_x;
            let to = (start_y + row) * self.shown.0 + start_x;
            if columns > 0 {
                whole[to..to + columns].copy_from_slice(&values[from..from + columns]);
            }
        }
        whole
    }
}

impl From<exr::error::Error> for ReadError {
    fn from(error: exr::error::Error) -> Self {
        match error {
            exr::error::Error::Io(error) => ReadError::Invalid(format!("the EXR file is cut short: {error}")),
            exr::error::Error::NotSupported(what) => ReadError::NotSupported(what.into_owned()),
            other => ReadError::Invalid(format!("malformed EXR: {other}")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_data_window_lands_where_it_lies_in_the_display_window() {
        let placed = |shown, stored, offset| Placed { shown, stored, offset };
        let inner = placed(Vec2(4, 3), Vec2(2, 1), Vec2(1, 2));
        assert_eq!(inner.shown(vec![7, 8]), [0, 0, 0, 0, 0, 0, 0, 0, 0, 7, 8, 0]);
        let over = placed(Vec2(2, 2), Vec2(4, 3), Vec2(-1, -1));
        assert_eq!(over.shown((0..12).collect()), [5, 6, 9, 10]);
        let apart = placed(Vec2(2, 1), Vec2(2, 1), Vec2(5, 0));
        assert_eq!(apart.shown(vec![1, 2]), [0, 0]);
        let left = placed(Vec2(2, 1), Vec2(2, 1), Vec2(-9, 0));
        assert_eq!(left.shown(vec![1, 2]), [0, 0]);
        assert!(placed(Vec2(2, 1), Vec2(2, 1), Vec2(0, 0)).note().is_none());
    }
}
