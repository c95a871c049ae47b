//! Image files of any program as layers of numbers: EXR and PNG, told apart by their content.
//!
//! An image covers its file's display window: pixels that the file does not store are 0, what it stores
//! outside is left out, and a note says so. Values stay as stored, not finite ones too; half floats become
//! single ones, exactly. PNG is decoded from sRGB to linear light.

mod layers;
mod open_exr;
mod png;

use crate::output::Image;
use std::io::Read;
use std::path::Path;

/// All channels of an image together may have this many values: 2 GiB.
const MOST_VALUES: u64 = 1 << 29;

/// Longest file that is read, in bytes.
const MOST_BYTES: u64 = 4 << 30;

/// An image file's content.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FileImage {
    pub width: usize,
    pub height: usize,
    /// The picture itself first, if there is one; then in the file's order.
    pub layers: Vec<FileLayer>,
    /// Whether colours were stored for the screen (PNG) and not as light (EXR).
    pub encoded: bool,
    /// What is not as in most files, one sentence each.
    pub notes: Vec<String>,
}

/// Channels that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct FileLayer {
    /// As the file spells it; empty for the picture itself.
    pub name: String,
    pub kind: Kind,
    pub channels: Vec<Channel>,
}

/// What a layer's numbers are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Linear light in red, green and blue, or grey (`Y`).
    Colour,
    /// Anything else: depths, normals, numbers of objects, coverage, variances.
    Data,
}

/// `width · height` values, rows from top to bottom.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    pub name: String,
    pub samples: Samples,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    F32(Vec<f32>),
    U32(Vec<u32>),
}

/// Why a file could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    #[error("not supported: {0}")]
    NotSupported(String),
    #[error("{0}")]
    Invalid(String),
    #[error("{0}")]
    Io(#[from] std::io::Error),
}

/// Reads an image file of up to 4 GiB.
///
/// # Errors
/// It cannot be read, is malformed or neither EXR nor PNG, or of a kind that is not supported.
pub fn load(path: &Path) -> Result<FileImage, ReadError> {
    from_reader(std::fs::File::open(path)?)
}

/// As [`load`], from any source.
///
/// # Errors
/// As [`load`].
pub fn from_reader(source: impl Read) -> Result<FileImage, ReadError> {
    let mut bytes = Vec::new();
    let length = source.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
    if length as u64 > MOST_BYTES {
        return Err(ReadError::NotSupported("a file of more than 4 GiB".to_owned()));
    }
    decode(&bytes)
}

/// Decodes an image file's content.
///
/// # Errors
/// As [`load`].
pub fn decode(bytes: &[u8]) -> Result<FileImage, ReadError> {
    let decoder: fn(&[u8]) -> Result<FileImage, ReadError> = match bytes {
        [0x76, 0x2f, 0x31, 0x01, ..] => open_exr::decode,
        [0x89, b'P', b'N', b'G', b'\r', b'\n', 0x1a, b'\n', ..] => png::decode,
        [] => return Err(ReadError::Invalid("the file is empty".to_owned())),
        _ => return Err(ReadError::Invalid("the content is not that of an EXR or PNG file".to_owned())),
    };
    // the decoders are other people's: should one panic on a malformed file, that is the file's error
    std::panic::catch_unwind(|| decoder(bytes))
        .unwrap_or_else(|_| Err(ReadError::Invalid("the decoder failed on this file".to_owned())))
}

impl FileImage {
    pub fn layer(&self, name: &str) -> Option<&FileLayer> {
        self.layers.iter().find(|layer| layer.name == name)
    }
}

impl FileLayer {
    /// Red, green and blue; grey stands for all three. `None` of data.
    pub fn colour(&self) -> Option<[&[f32]; 3]> {
        match (self.kind, self.channels.as_slice()) {
            (Kind::Colour, [r, g, b]) => Some([r.light()?, g.light()?, b.light()?]),
            (Kind::Colour, [y]) => Some([y.light()?; 3]),
            _ => None,
        }
    }

    /// The layer's name as messages show it.
    pub fn title(&self) -> &str {
        if self.name.is_empty() { "picture" } else { &self.name }
    }
}

impl Channel {
    fn light(&self) -> Option<&[f32]> {
        match &self.samples {
            Samples::F32(values) => Some(values),
            Samples::U32(_) => None,
        }
    }
}

impl Samples {
    /// The value as a number that holds every float and every integer exactly.
    pub fn get(&self, at: usize) -> f64 {
        match self {
            Samples::F32(values) => f64::from(values[at]),
            Samples::U32(values) => f64::from(values[at]),
        }
    }

    pub fn len(&self) -> usize {
        match self {
            Samples::F32(values) => values.len(),
            Samples::U32(values) => values.len(),
        }
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// A rendered image as its EXR file would be read.
impl From<&Image> for FileImage {
    fn from(image: &Image) -> Self {
        let channels = image.layers.iter().flat_map(|layer| {
            layer.channels.iter().map(|(channel, values)| {
                (crate::output::exr::spelling(&layer.name, channel), Samples::F32(values.clone()))
            })
        });
        let mut channels: Vec<(String, Samples)> = channels.collect();
        channels.sort_by(|a, b| a.0.cmp(&b.0));
        let layers = layers::grouped(vec![layers::Part { name: None, channels }]);
        FileImage { width: image.width, height: image.height, layers, ..FileImage::default() }
    }
}

/// Refuses sizes of zero and those that take more memory than allowed.
fn check_size(width: usize, height: usize, channels: usize) -> Result<(), ReadError> {
    if width == 0 || height == 0 {
        return Err(ReadError::Invalid(format!("an image of {width} × {height} pixels")));
    }
    let values = (width as u64).checked_mul(height as u64).and_then(|n| n.checked_mul(channels as u64));
    if values.is_none_or(|values| values > MOST_VALUES) {
        return Err(ReadError::NotSupported(format!(
            "{width} × {height} pixels of {channels} channels: more than {MOST_VALUES} values"
        )));
    }
    Ok(())
}
