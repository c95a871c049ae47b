//! RON text to a tree. The `ron` crate has no values with places, so it judges the syntax first, and
//! this parser reads what it has let through (it still checks what it reads).
//!
//! Grammar: <https://github.com/ron-rs/ron/blob/master/docs/grammar.md>.

mod brackets;
mod literal;

use super::toml::SyntaxError;
use crate::description::tree::{Entry, Node, Span, Style, Value};
use brackets::Brackets;
use serde::de::IgnoredAny;

/// Deeper nesting is refused.
const MAX_DEPTH: u32 = 120;

/// From here on a second thread is worth its start.
const LARGE_BYTES: usize = 1 << 18;

/// A whole file.
pub(super) fn parse(text: &str, source: usize) -> Result<Node, Vec<SyntaxError>> {
    // the own parser is the more precise about places, `ron` the stricter
    let strict = || super::convert_options().from_str::<IgnoredAny>(text);
    let refused =
        |error: ron::error::SpannedError| vec![(offset(text, &error.span.start), error.code.to_string())];
    if text.len() < LARGE_BYTES {
        let node = own(text, source)?;
        return strict().map(|_| node).map_err(refused);
    }
    let (node, judged) = rayon::join(|| own(text, source), strict);
    let node = node?;
    judged.map(|_| node).map_err(refused)
}

/// Text that `ron` has written.
pub(super) fn own(text: &str, source: usize) -> Result<Node, Vec<SyntaxError>> {
    let mut parser = Parser::new(text, source);
    let read = parser.file();
    let mut errors = parser.errors;
    match read {
        Ok(node) if errors.is_empty() => Ok(node),
        read => {
            errors.extend(read.err());
            Err(errors)
        }
    }
}

/// A single value, for `--set`.
pub(super) fn parse_value(text: &str, source: usize, start: usize) -> Result<Node, SyntaxError> {
    let mut parser = Parser::new(text, source);
    parser.at = start;
    let node = parser.value()?;
    parser.end()?;
    if parser.errors.is_empty() { Ok(node) } else { Err(parser.errors.swap_remove(0)) }
}

/// The byte offset of a line and column (characters, from 1).
fn offset(text: &str, place: &ron::error::Position) -> usize {
    let start: usize = text.split_inclusive('\n').take(place.line.saturating_sub(1)).map(str::len).sum();
    let column = place.col.saturating_sub(1);
    start + text[start..].char_indices().nth(column).map_or(text.len() - start, |(i, _)| i)
}

/// After an error reading goes on behind the next comma, if the brackets around it match: then it is
/// known where that is, and what follows is judged on its own.
struct Parser<'a> {
    text: &'a str,
    source: usize,
    at: usize,
    depth: u32,
    /// Those that were got over.
    errors: Vec<SyntaxError>,
    brackets: Option<Brackets>,
}

/// After so many errors the rest is not looked for.
const MOST_ERRORS: usize = 100;

type Parsed<T> = Result<T, SyntaxError>;

impl<'a> Parser<'a> {
    fn new(text: &'a str, source: usize) -> Parser<'a> {
        Parser { text, source, at: 0, depth: 0, errors: Vec::new(), brackets: None }
    }

    fn file(&mut self) -> Parsed<Node> {
        self.space()?;
        while self.rest().starts_with("#!") {
            match self.rest().find(']') {
                Some(end) => self.at += end + 1,
                None => return Err(self.error("this attribute is not closed with `]`")),
            }
            self.space()?;
        }
        let node = self.value()?;
        self.end()?;
        Ok(node)
    }

    fn end(&mut self) -> Parsed<()> {
        self.space()?;
        match self.peek() {
            None => Ok(()),
            Some(c) => {
                Err(self.error(&format!("nothing can follow the value, found `{}`", c.escape_default())))
            }
        }
    }

    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    fn error(&self, message: &str) -> SyntaxError {
        (self.at, message.to_owned())
    }

    fn take(&mut self, c: char) -> bool {
        let found = self.peek() == Some(c);
        if found {
            self.at += c.len_utf8();
        }
        found
    }

    fn span(&self, start: usize) -> Span {
        Span { source: self.source, start, end: self.at }
    }

    /// White space and comments; block comments nest.
    fn space(&mut self) -> Parsed<()> {
        loop {
            let rest = self.rest();
            let trimmed = rest.trim_start();
            self.at += rest.len() - trimmed.len();
            if trimmed.starts_with("//") {
                self.at += trimmed.find('\n').unwrap_or(trimmed.len());
            } else if trimmed.starts_with("/*") {
                self.block_comment()?;
            } else {
                return Ok(());
            }
        }
    }

    fn block_comment(&mut self) -> Parsed<()> {
        let start = self.at;
        let mut open = 0;
        loop {
            let rest = self.rest();
            let step = if rest.starts_with("/*") {
                open += 1;
                2
            } else if rest.starts_with("*/") {
                open -= 1;
                2
            } else {
                rest.chars()
                    .next()
                    .map(char::len_utf8)
                    .ok_or((start, "this comment is not closed".to_owned()))?
            };
            self.at += step;
            if open == 0 {
                return Ok(());
            }
        }
    }

    fn value(&mut self) -> Parsed<Node> {
        if self.depth >= MAX_DEPTH {
            return Err(self.error(&format!("nested deeper than {MAX_DEPTH}")));
        }
        self.depth += 1;
        self.space()?;
        let start = self.at;
        let value = match self.peek() {
            None => return Err(self.error("a value is expected, but the file ends here")),
            Some('(') => self.parens()?,
            Some('[') => {
                self.at += 1;
                Value::Seq(self.items(start, ']')?)
            }
            Some('{') => self.braces()?,
            Some('"') => Value::Str(self.string()?),
            Some('\'') => self.character()?,
            Some('0'..='9' | '+' | '-' | '.') => self.number()?,
            Some(c) if c == '_' || c.is_alphabetic() => self.word()?,
            Some(c) => {
                return Err(self.error(&format!("a value is expected, found `{}`", c.escape_default())));
            }
        };
        self.depth -= 1;
        Ok(Node { value, span: self.span(start) })
    }

    /// Values up to `close`; the bracket at `open` has been read.
    fn items(&mut self, open: usize, close: char) -> Parsed<Vec<Node>> {
        let mut items = Vec::new();
        self.list(open, close, &mut |parser| {
            items.push(parser.value()?);
            Ok(())
        })?;
        Ok(items)
    }

    /// `element`, separated by commas, up to `close`; the bracket at `open` has been read.
    fn list(
        &mut self,
        open: usize,
        close: char,
        element: &mut dyn FnMut(&mut Self) -> Parsed<()>,
    ) -> Parsed<()> {
        let depth = self.depth;
        loop {
            self.space()?;
            if self.take(close) {
                return Ok(());
            }
            if let Err(error) = element(self).and_then(|()| self.separator(close)) {
                self.depth = depth;
                self.get_over(error, open)?;
            }
        }
    }

    /// Goes on behind the next comma, or at the end, of the list that begins at `open`.
    fn get_over(&mut self, error: SyntaxError, open: usize) -> Parsed<()> {
        let text = self.text;
        let brackets = self.brackets.get_or_insert_with(|| Brackets::of(text));
        match brackets.resume(open, error.0.max(open + 1)) {
            Some(at) if self.errors.len() + 1 < MOST_ERRORS => {
                self.at = at;
                self.errors.push(error);
                Ok(())
            }
            _ => Err(error),
        }
    }

    fn separator(&mut self, close: char) -> Parsed<()> {
        self.space()?;
        match self.peek() {
            Some(',') => {
                self.at += 1;
                Ok(())
            }
            Some(c) if c == close => Ok(()),
            Some(c) => {
                Err(self.error(&format!("`,` or `{close}` is expected, found `{}`", c.escape_default())))
            }
            None => Err(self.error(&format!("`{close}` is expected, but the file ends here"))),
        }
    }

    /// `(a, b)` or `(a: 1, b: 2)`.
    fn parens(&mut self) -> Parsed<Value> {
        let open = self.at;
        self.at += 1;
        self.space()?;
        let start = self.at;
        let named = self.identifier().is_some() && {
            self.space()?;
            // `=`, which is wrong, is taken for what it was meant to be
            matches!(self.peek(), Some(':' | '='))
        };
        self.at = start;
        if !named {
            let items = self.items(open, ')')?;
            return Ok(if items.is_empty() {
                Value::Map(Vec::new(), Style::Fields)
            } else {
                Value::Seq(items)
            });
        }
        let mut entries = Vec::new();
        self.list(open, ')', &mut |parser| {
            let start = parser.at;
            let key = parser.identifier().ok_or_else(|| parser.error("a field's name is expected"))?;
            entries.push(parser.entry(key.to_owned(), start)?);
            Ok(())
        })?;
        Ok(Value::Map(entries, Style::Fields))
    }

    /// `{ "name": value }`; a name without quotes is let through and refused with its place later.
    fn braces(&mut self) -> Parsed<Value> {
        let open = self.at;
        self.at += 1;
        let mut entries = Vec::new();
        self.list(open, '}', &mut |parser| {
            let start = parser.at;
            let quoted = match parser.peek() {
                Some('"') => true,
                Some('r') => !parser.rest().starts_with("r#") || parser.rest().starts_with("r#\""),
                _ => false,
            };
            if !quoted {
                return Err((start, "a name in quotes is expected".into()));
            }
            let Value::Str(key) = parser.value()?.value else {
                return Err((start, "names in { } are written in quotes".into()));
            };
            entries.push(parser.entry(key, start)?);
            Ok(())
        })?;
        Ok(Value::Map(entries, Style::Braces))
    }

    fn entry(&mut self, key: String, start: usize) -> Parsed<Entry> {
        let key_span = self.span(start);
        self.space()?;
        if !self.take(':') {
            return Err(self.error(&format!("`:` is expected after `{key}`")));
        }
        Ok(Entry { key, key_span, node: self.value()? })
    }
}
