//! Image → files: EXR and PNG with provenance, written whole or not at all; dependency files.
//!
//! The writers take any sink; `atomic` puts files in place. Nothing here prints: what a writer had
//! to change is returned (`Written`).

pub mod atomic;
mod camera_view;
pub mod depfile;
mod display;
pub mod exr;
mod image;
pub mod partial;
mod parts;
pub mod png;
mod provenance;
pub mod srgb;

pub use self::image::{Image, Layer, Within};
pub use camera_view::CameraView;
pub use display::Display;
pub use png::{Bits, PngSettings};
pub use provenance::{COLOR_SPACE, Provenance, Stamp, hex};

use std::io::{self, Seek, Write};
use std::path::Path;

/// A file format that images are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Exr,
    Png,
}

/// What a writer had to change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Written {
    /// Values that were NaN or infinite and are 0 in the file.
    pub non_finite: u64,
    /// Pixels outside the range of the format, clamped to it (PNG only).
    pub clamped_pixels: u64,
}

/// Why an image could not be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    #[error("not supported: {0}")]
    NotSupported(String),
    #[error("invalid image: {0}")]
    Invalid(String),
    #[error("{0}")]
    Io(#[from] io::Error),
}

impl Format {
    /// The format that a file name's ending states, in any case of letters.
    pub fn from_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?;
        [(Format::Exr, "exr"), (Format::Png, "png")]
            .into_iter()
            .find_map(|(format, name)| extension.eq_ignore_ascii_case(name).then_some(format))
    }

    /// Writes the image in this format.
    pub fn write(
        self,
        sink: impl Write + Seek,
        image: &Image,
        provenance: &Provenance,
        settings: PngSettings,
    ) -> Result<Written, OutputError> {
        match self {
            Format::Exr => exr::write(sink, image, provenance),
            Format::Png => png::write(sink, image, provenance, settings),
        }
    }
}

impl Written {
    /// The sum of both.
    pub fn plus(self, other: Self) -> Self {
        Written {
            non_finite: self.non_finite + other.non_finite,
            clamped_pixels: self.clamped_pixels + other.clamped_pixels,
        }
    }
}
