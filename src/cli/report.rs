//! Messages to people, on standard error; what was asked for, on standard output.
//!
//! A stream that is closed at the other end is no reason to panic: messages are lost then, and
//! what was asked for ends quietly.

use super::args::ColorChoice;
use super::exit::{Failure, NOT_WRITABLE};
use std::borrow::Cow;
use std::io::{self, IsTerminal, Write};
use std::panic;
use std::sync::{Arc, Mutex};
use terrarium::description::Diagnostic;

/// How standard error takes messages.
#[derive(Clone, Debug)]
pub struct Terminal {
    color: bool,
    /// Whether a line may be drawn over: a terminal that knows how.
    pub redraws: bool,
}

impl Terminal {
    /// Colour by choice, else by `NO_COLOR`, `CLICOLOR_FORCE` and whether standard error is a terminal.
    pub fn new(choice: ColorChoice) -> Self {
        let set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty() && value != "0");
        let capable = std::env::var_os("TERM").is_none_or(|term| term != "dumb");
        let redraws = io::stderr().is_terminal() && capable;
        let color = match choice {
            ColorChoice::Always => true,
            ColorChoice::Never => false,
            ColorChoice::Auto if std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty()) => false,
            ColorChoice::Auto => set("CLICOLOR_FORCE") || redraws,
        };
        Terminal { color, redraws }
    }

    /// One message.
    pub fn say(&self, text: &str) {
        self.begin_with("", text);
    }

    pub fn error(&self, text: &str) {
        self.begin_with("error:", &format!(" {text}"));
    }

    pub fn note(&self, text: &str) {
        self.begin_with("note:", &format!(" {text}"));
    }

    pub fn warning(&self, text: &str) {
        self.begin_with("warning:", &format!(" {text}"));
    }

    /// A message whose first word may be in colour.
    fn begin_with(&self, word: &str, text: &str) {
        let _ = writeln!(io::stderr().lock(), "{}{}", self.paint(word), printable(text));
    }

    /// A diagnostic, with the word that it begins with in colour.
    pub fn diagnostic(&self, diagnostic: &Diagnostic) {
        let text = diagnostic.to_string();
        let word = ["error", "warning"].into_iter().find(|word| text.starts_with(word)).unwrap_or("");
        self.begin_with(word, &text[word.len()..]);
    }

    fn paint(&self, word: &str) -> String {
        match (self.color, word.starts_with('e')) {
            (false, _) => word.to_string(),
            (true, true) => format!("\x1b[1;31m{word}\x1b[0m"),
            (true, false) if word.is_empty() => String::new(),
            (true, false) => format!("\x1b[1;33m{word}\x1b[0m"),
        }
    }
}

/// Names come from files: what would move a terminal's cursor, or change its colours, is told instead of done.
pub fn printable(text: &str) -> Cow<'_, str> {
    let harmful = |c: char| c.is_control() && c != '\n' && c != '\t';
    if !text.contains(harmful) {
        return Cow::Borrowed(text);
    }
    let told = |c: char| if harmful(c) { c.escape_default().to_string() } else { c.to_string() };
    Cow::Owned(text.chars().map(told).collect())
}

/// Writes to standard output. A reader that has gone away got all it wanted.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::new(NOT_WRITABLE, format!("can't write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Keeps a panic's message and place instead of printing them, the first of several.
pub fn keep_panics() -> Arc<Mutex<String>> {
    let kept = Arc::new(Mutex::new(String::new()));
    let keep = Arc::clone(&kept);
    panic::set_hook(Box::new(move |info| {
        if let Ok(mut text) = keep.lock()
            && text.is_empty()
        {
            let payload = info.payload();
            let message = payload
                .downcast_ref::<&str>()
                .map(|message| message.to_string())
                .or_else(|| payload.downcast_ref::<String>().cloned())
                .unwrap_or_default();
            *text = match info.location() {
                Some(place) => format!("{message} ({}:{})", place.file(), place.line()),
                None => message,
            };
        }
    }));
    kept
}
