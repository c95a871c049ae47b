//! What is said about a scene: one diagnostic a mistake, each with its place.

use super::tree::Path;
use serde::Serialize;
use std::fmt;
use std::path::PathBuf;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    Error,
    Warning,
}

/// What sort of mistake: it decides the exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Well formed, but beyond what is supported.
    NotSupported,
    /// The scene is wrong.
    Invalid,
    /// A file is missing or cannot be read.
    Io,
}

/// One mistake or doubt, with its place.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Diagnostic {
    pub severity: Severity,
    pub kind: Kind,
    /// The file; none for standard input and for a `--set` argument.
    pub file: Option<PathBuf>,
    /// From 1.
    pub line: Option<u32>,
    /// In characters, from 1; within the argument for `--set`.
    pub column: Option<u32>,
    /// The place in the scene: `materials.ball.ior`.
    pub path: Option<String>,
    pub message: String,
    pub help: Option<String>,
    /// The `--set` argument that is at fault.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub argument: Option<String>,
    /// The line of the source, for display.
    #[serde(skip)]
    pub(crate) excerpt: Option<Excerpt>,
    /// Source and offset, for sorting.
    #[serde(skip)]
    pub(crate) order: (usize, usize),
}

impl Diagnostic {
    /// An error about a file as a whole.
    pub(crate) fn of_file(path: &std::path::Path, kind: Kind, message: String) -> Diagnostic {
        Diagnostic { file: Some(path.to_owned()), ..Diagnostic::plain(kind, message) }
    }

    pub(crate) fn plain(kind: Kind, message: String) -> Diagnostic {
        Diagnostic {
            severity: Severity::Error,
            kind,
            file: None,
            line: None,
            column: None,
            path: None,
            message,
            help: None,
            argument: None,
            excerpt: None,
            order: (0, 0),
        }
    }

    pub(crate) fn with_help(mut self, help: Option<String>) -> Diagnostic {
        self.help = help;
        self
    }

    /// The first line of `Display`: place, severity, path and message, without excerpt and help.
    pub fn headline(&self) -> String {
        let mut text = match (&self.argument, &self.file) {
            (Some(argument), _) => format!("--set {argument}"),
            (None, Some(file)) => file.display().to_string(),
            (None, None) => "<input>".to_owned(),
        };
        for number in [self.line, self.column].into_iter().flatten() {
            text.push_str(&format!(":{number}"));
        }
        text.push_str(match self.severity {
            Severity::Error => ": error: ",
            Severity::Warning => ": warning: ",
        });
        if let Some(path) = self.path.as_deref().filter(|path| !path.is_empty()) {
            text.push_str(&format!("{path}: "));
        }
        text.push_str(&self.message);
        text
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.headline())?;
        if let (Some(line), Some(Excerpt { text, caret })) = (self.line, &self.excerpt) {
            let gutter = " ".repeat(line.to_string().len());
            write!(f, "\n {line} | {text}\n {gutter} | {}^", " ".repeat(*caret))?;
        }
        match &self.help {
            Some(help) => write!(f, "\n  help: {help}"),
            None => Ok(()),
        }
    }
}

/// What was found of a loaded scene when its files were looked into, by its place in the scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    pub severity: Severity,
    pub kind: Kind,
    pub place: Path,
    pub message: String,
}

/// At most 100 characters of a line, and where in them the mistake is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Excerpt {
    text: String,
    caret: usize,
}

impl Excerpt {
    /// Of the line around the character at byte `at`; tabs are shown as spaces.
    pub fn of(line: &str, at: usize) -> Excerpt {
        let before = line[..at].char_indices().rev().take(70);
        let (caret, from) = before.enumerate().last().map_or((0, at), |(i, (start, _))| (i + 1, start));
        let shown = line[from..].chars().take(100);
        Excerpt { text: shown.map(|c| if c.is_control() { ' ' } else { c }).collect(), caret }
    }
}

/// Everything that is wrong with a scene: errors first, each group in the order of the files.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Report {
    pub diagnostics: Vec<Diagnostic>,
}

impl Report {
    /// After so many diagnostics of one stage the rest is left out.
    pub(crate) const MOST: usize = 1000;

    pub(crate) fn new(mut diagnostics: Vec<Diagnostic>) -> Report {
        diagnostics.sort_by_key(|d| (d.severity, d.order));
        Report { diagnostics }
    }

    pub fn errors(&self) -> impl Iterator<Item = &Diagnostic> {
        self.diagnostics.iter().filter(|d| d.severity == Severity::Error)
    }

    /// 3 if all that is wrong is that files cannot be read, else 2.
    pub fn exit_code(&self) -> u8 {
        if self.errors().all(|d| d.kind == Kind::Io) { 3 } else { 2 }
    }
}

impl From<Diagnostic> for Report {
    fn from(diagnostic: Diagnostic) -> Report {
        Report { diagnostics: vec![diagnostic] }
    }
}

impl From<Box<Diagnostic>> for Report {
    fn from(diagnostic: Box<Diagnostic>) -> Report {
        Report::from(*diagnostic)
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        for (i, diagnostic) in self.diagnostics.iter().enumerate() {
            if i > 0 {
                f.write_str("\n")?;
            }
            diagnostic.fmt(f)?;
        }
        Ok(())
    }
}

impl std::error::Error for Report {}
