//! Exit codes, and failures that carry one.

use terrarium::output::OutputError;
use terrarium::render::RenderError;

/// The render failed.
pub const FAILED: u8 = 1;
/// The scene is invalid, or the program was called wrongly.
pub const USAGE: u8 = 2;
/// A file that is read is missing or can't be read.
pub const UNREADABLE: u8 = 3;
/// A file can't be written.
pub const NOT_WRITABLE: u8 = 4;

/// A limit on what a render may take.
pub const REFUSED: u8 = 5;

/// Stopped early from outside; what was there is written.
pub const STOPPED: u8 = 6;

/// Why the program ends with a code other than 0; an empty message if all has been said.
#[derive(Debug)]
pub struct Failure {
    pub code: u8,
    pub message: String,
    /// For programs: all of the reason, where a part of it has been said already.
    pub said: Option<String>,
}

impl Failure {
    pub fn new(code: u8, message: impl Into<String>) -> Self {
        Failure { code, message: message.into(), said: None }
    }

    /// All has been said; programs are told `said`.
    pub fn said(code: u8, said: String) -> Self {
        Failure { code, message: String::new(), said: Some(said) }
    }

    /// The reason, on one line.
    pub fn reason(&self) -> String {
        let text = self.said.as_ref().unwrap_or(&self.message);
        let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
        if line.is_empty() { "the scene cannot be rendered".to_owned() } else { line }
    }

    /// `path` could not be written.
    pub fn writing(path: &str, error: impl std::fmt::Display) -> Self {
        Failure::new(NOT_WRITABLE, format!("can't write {path}: {error}"))
    }

    /// Writing the image to `path` failed.
    pub fn image(path: &str, error: OutputError) -> Self {
        match error {
            OutputError::Io(error) => Failure::writing(path, error),
            other => Failure::new(FAILED, format!("can't write {path}: {other}")),
        }
    }
}

impl From<RenderError> for Failure {
    fn from(error: RenderError) -> Self {
        let code = match &error {
            RenderError::NotSupported(_) | RenderError::Invalid(_) => USAGE,
            RenderError::Io(_) => UNREADABLE,
            RenderError::TooLarge(_) => REFUSED,
            RenderError::Stopped => STOPPED,
            RenderError::Failed(_) | RenderError::Already => FAILED,
        };
        Failure::new(code, error.to_string())
    }
}
