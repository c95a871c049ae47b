//! The texts that a scene is read from: files, standard input, `--set` arguments.

use super::diagnostic::{Diagnostic, Excerpt, Kind, Severity};
use super::tree::Span;
use super::{Format, Reach};
use std::path::{Path, PathBuf};

/// A scene file with all that it includes may have so many bytes.
pub(crate) const MAX_FILE_BYTES: u64 = 256 << 20;

#[derive(Debug)]
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

#[derive(Debug, Default)]
pub(crate) struct Sources {
    sources: Vec<Source>,
    /// Where each line of each source starts.
    lines: Vec<Vec<usize>>,
}

/// Line and column (from 1, in characters) of a place in a text, the line itself, and the place in it, bytes.
struct Position<'a> {
    line: usize,
    column: usize,
    text: &'a str,
    at: usize,
}

impl Sources {
    pub fn add(&mut self, source: Source) -> usize {
        let newlines = source.text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        self.lines.push(std::iter::once(0).chain(newlines.map(|(i, _)| i + 1)).collect());
        self.sources.push(source);
        self.sources.len() - 1
    }

    pub fn get(&self, index: usize) -> &Source {
        &self.sources[index]
    }

    /// Bytes of each text.
    pub fn sizes(&self) -> impl Iterator<Item = usize> {
        self.sources.iter().map(|source| source.text.len())
    }

    pub fn files(&self) -> Vec<PathBuf> {
        self.sources.iter().filter_map(|source| source.file.clone()).collect()
    }

    /// A diagnostic that points at `span`.
    pub fn diagnostic(&self, severity: Severity, kind: Kind, span: Span, message: String) -> Diagnostic {
        let source = self.get(span.source);
        let Position { line, column, text, at } = self.position(span);
        Diagnostic {
            severity,
            kind,
            file: source.file.clone(),
            line: (!source.argument).then_some(line as u32),
            column: Some(column as u32),
            path: None,
            message,
            help: None,
            argument: source.argument.then(|| source.text.clone()),
            excerpt: (!source.argument).then(|| Excerpt::of(text, at)),
            order: (span.source, span.start),
        }
    }

    /// Of a span's start.
    fn position(&self, span: Span) -> Position<'_> {
        let text = &self.get(span.source).text;
        let lines = &self.lines[span.source];
        let mut offset = span.start.min(text.len());
        while !text.is_char_boundary(offset) {
            offset -= 1;
        }
        let line = lines.partition_point(|start| *start <= offset);
        let start = lines[line - 1];
        let end = lines.get(line).map_or(text.len(), |next| next - 1);
        // as many characters as bytes that do not continue one
        let before = text[start..offset].bytes().filter(|byte| byte & 0xc0 != 0x80).count();
        let shown = text[start..end].trim_end_matches('\r');
        Position { line, column: before + 1, text: shown, at: (offset - start).min(shown.len()) }
    }

    /// `file:line:column` of a span, for messages that name a second place.
    pub fn place(&self, span: Span) -> String {
        let source = self.get(span.source);
        let Position { line, column, .. } = self.position(span);
        match (&source.file, source.argument) {
            (_, true) => format!("--set {}", source.text),
            (Some(file), _) => format!("{}:{line}:{column}", file.display()),
            (None, _) => format!("{line}:{column}"),
        }
    }
}

/// Reads a scene file's text: at most `most` bytes of UTF-8, without a byte order mark.
pub(crate) fn read(path: &Path, reach: &Reach, most: u64) -> Result<String, Box<Diagnostic>> {
    let io = |error: std::io::Error| {
        Box::new(Diagnostic::of_file(path, Kind::Io, format!("cannot be read: {error}")))
    };
    let file = reach.open(path).map_err(io)?;
    if file.metadata().map_err(io)?.len() > most {
        return Err(too_large(path));
    }
    let mut bytes = Vec::new();
    std::io::Read::read_to_end(&mut std::io::Read::take(file, most + 1), &mut bytes).map_err(io)?;
    if bytes.len() as u64 > most {
        return Err(too_large(path));
    }
    match String::from_utf8(bytes) {
        Ok(text) => Ok(without_mark(text)),
        Err(error) => {
            let at = error.utf8_error().valid_up_to();
            let valid = String::from_utf8_lossy(&error.as_bytes()[..at]).into_owned();
            let line = valid.matches('\n').count() + 1;
            let column = valid.rsplit('\n').next().map_or(0, |last| last.chars().count()) + 1;
            let mut diagnostic =
                Diagnostic::of_file(path, Kind::Invalid, format!("byte {at} is not valid UTF-8"));
            (diagnostic.line, diagnostic.column) = (Some(line as u32), Some(column as u32));
            Err(Box::new(diagnostic))
        }
    }
}

pub(crate) fn without_mark(text: String) -> String {
    match text.strip_prefix('\u{feff}') {
        Some(rest) => rest.to_owned(),
        None => text,
    }
}

fn too_large(path: &Path) -> Box<Diagnostic> {
    let limit = MAX_FILE_BYTES >> 20;
    Box::new(Diagnostic::of_file(
        path,
        Kind::NotSupported,
        format!("scene files of more than {limit} MiB, with all that they include, are not read"),
    ))
}
