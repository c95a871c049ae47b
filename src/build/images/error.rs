//! Why an image could not be had.

use std::path::{Path, PathBuf};
use thiserror::Error;

/// An image file that could not be used.
#[derive(Debug, Error)]
pub enum ImageError {
    #[error("{}: cannot be read: {source}", path.display())]
    Io {
        path: PathBuf,
        #[source]
        source: std::io::Error,
    },
    /// Malformed.
    #[error("{}: {reason}", path.display())]
    Invalid { path: PathBuf, reason: String },
    /// Well-formed as far as can be told, but of a kind that is not read.
    #[error("{}: not supported: {reason}", path.display())]
    NotSupported { path: PathBuf, reason: String },
    /// A limit refused it before it was decoded.
    #[error("{}: too large: {reason}", path.display())]
    TooLarge { path: PathBuf, reason: String },
}

/// An error without its path.
#[derive(Debug)]
pub(super) enum Reason {
    Invalid(String),
    NotSupported(String),
    TooLarge(String),
}

impl ImageError {
    pub(super) fn new(path: &Path, reason: Reason) -> ImageError {
        let path = path.to_owned();
        match reason {
            Reason::Invalid(reason) => ImageError::Invalid { path, reason },
            Reason::NotSupported(reason) => ImageError::NotSupported { path, reason },
            Reason::TooLarge(reason) => ImageError::TooLarge { path, reason },
        }
    }

    pub(super) fn io(path: &Path, source: std::io::Error) -> ImageError {
        ImageError::Io { path: path.to_owned(), source }
    }

    pub fn path(&self) -> &Path {
        match self {
            ImageError::Io { path, .. }
            | ImageError::Invalid { path, .. }
            | ImageError::NotSupported { path, .. }
            | ImageError::TooLarge { path, .. } => path,
        }
    }
}

impl From<image::ImageError> for Reason {
    fn from(error: image::ImageError) -> Reason {
        match error {
            image::ImageError::Unsupported(e) => Reason::NotSupported(e.to_string()),
            image::ImageError::Limits(e) => Reason::TooLarge(e.to_string()),
            e => Reason::Invalid(e.to_string()),
        }
    }
}

impl From<exr::error::Error> for Reason {
    fn from(error: exr::error::Error) -> Reason {
        match error {
            exr::error::Error::NotSupported(e) => Reason::NotSupported(e.into_owned()),
            e => Reason::Invalid(format!("malformed EXR: {e}")),
        }
    }
}
