//! The texts that a scene is read from: files, standard input, `--set` arguments.

use super::Format;
use super::diagnostic::{Diagnostic, Kind, Severity};
use super::tree::Span;
use std::path::{Path, PathBuf};

/// Scene files above this size are refused, bytes.
pub(crate) const MAX_FILE_BYTES: u64 = 256 << 20;

pub(crate) struct Source {
    /// Where it was read from; none for standard input and `--set`.
    pub file: Option<PathBuf>,
    /// The `--set` argument, as given.
    pub argument: bool,
    /// The folder that its paths are relative to, from the main file's folder; empty for the main file.
    pub base: PathBuf,
    pub format: Format,
    pub text: String,
}

#[derive(Default)]
pub(crate) struct Sources(Vec<Source>);

impl Sources {
    pub fn add(&mut self, source: Source) -> usize {
        self.0.push(source);
        self.0.len() - 1
    }

    pub fn get(&self, index: usize) -> &Source {
        &self.0[index]
    }

    /// Bytes of each text.
    pub fn sizes(&self) -> impl Iterator<Item = usize> {
        self.0.iter().map(|source| source.text.len())
    }

    pub fn files(&self) -> Vec<PathBuf> {
        self.0.iter().filter_map(|source| source.file.clone()).collect()
    }

    /// A diagnostic that points at `span`.
    pub fn diagnostic(&self, severity: Severity, kind: Kind, span: Span, message: String) -> Diagnostic {
        let source = self.get(span.source);
        let (line, column, text) = position(&source.text, span.start);
        Diagnostic {
            severity,
            kind,
            file: source.file.clone(),
            line: (!source.argument).then_some(line),
            column: Some(column),
            path: None,
            message,
            help: None,
            argument: source.argument.then(|| source.text.clone()),
            excerpt: (!source.argument).then(|| text.to_owned()),
            order: (span.source, span.start),
        }
    }

    /// `file:line:column` of a span, for messages that name a second place.
    pub fn place(&self, span: Span) -> String {
        let source = self.get(span.source);
        let (line, column, _) = position(&source.text, span.start);
        match (&source.file, source.argument) {
            (_, true) => format!("--set {}", source.text),
            (Some(file), _) => format!("{}:{line}:{column}", file.display()),
            (None, _) => format!("{line}:{column}"),
        }
    }
}

/// Line and column (from 1, in characters) of a byte offset, and the line's text.
pub(crate) fn position(text: &str, offset: usize) -> (u32, u32, &str) {
    let mut offset = offset.min(text.len());
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    let start = text[..offset].rfind('\n').map_or(0, |newline| newline + 1);
    let end = text[start..].find('\n').map_or(text.len(), |length| start + length);
    let line = text[..start].bytes().filter(|&b| b == b'\n').count() + 1;
    let column = text[start..offset].chars().count() + 1;
    (line as u32, column as u32, text[start..end].trim_end_matches('\r'))
}

/// Reads a scene file's text: at most `MAX_FILE_BYTES` of UTF-8, without a byte order mark.
pub(crate) fn read(path: &Path) -> Result<String, Diagnostic> {
    let io = |error: &dyn std::fmt::Display| {
        Diagnostic::of_file(path, Kind::Io, format!("cannot be read: {error}"))
    };
    let size = std::fs::metadata(path).map_err(|e| io(&e))?;
    if size.is_dir() {
        return Err(io(&"it is a folder"));
    }
    if size.len() > MAX_FILE_BYTES {
        return Err(too_large(path));
    }
    let file = std::fs::File::open(path).map_err(|e| io(&e))?;
    let mut bytes = Vec::new();
    std::io::Read::read_to_end(&mut std::io::Read::take(file, MAX_FILE_BYTES + 1), &mut bytes)
        .map_err(|e| io(&e))?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(too_large(path));
    }
    match String::from_utf8(bytes) {
        Ok(text) => Ok(without_mark(text)),
        Err(error) => {
            let at = error.utf8_error().valid_up_to();
            let valid = String::from_utf8_lossy(&error.as_bytes()[..at]).into_owned();
            let (line, column, _) = position(&valid, at);
            let mut diagnostic =
                Diagnostic::of_file(path, Kind::Invalid, format!("byte {at} is not valid UTF-8"));
            (diagnostic.line, diagnostic.column) = (Some(line), Some(column));
            Err(diagnostic)
        }
    }
}

pub(crate) fn without_mark(text: String) -> String {
    match text.strip_prefix('\u{feff}') {
        Some(rest) => rest.to_owned(),
        None => text,
    }
}

fn too_large(path: &Path) -> Diagnostic {
    let limit = MAX_FILE_BYTES >> 20;
    Diagnostic::of_file(path, Kind::NotSupported, format!("scene files above {limit} MiB are not read"))
}
