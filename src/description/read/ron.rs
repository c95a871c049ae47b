//! RON text to a tree. The `ron` crate has no values with places, so it judges the syntax first, and
//! this parser reads what it has let through (it still checks what it reads).
//!
//! Grammar: <https://github.com/ron-rs/ron/blob/master/docs/grammar.md>.

use super::toml::SyntaxError;
use crate::description::tree::{Entry, Node, Span, Style, Value};
use serde::de::IgnoredAny;

/// Deeper nesting is refused.
const MAX_DEPTH: u32 = 120;

/// A whole file.
pub(super) fn parse(text: &str, source: usize) -> Result<Node, Vec<SyntaxError>> {
    // the own parser is the more precise about places, `ron` the stricter
    let tree = Parser::new(text, source).file();
    match (tree, super::convert_options().from_str::<IgnoredAny>(text)) {
        (Err(error), _) => Err(vec![error]),
        (Ok(_), Err(error)) => Err(vec![(offset(text, &error.span.start), error.code.to_string())]),
        (Ok(node), Ok(_)) => Ok(node),
    }
}

/// A single value, for `--set`.
pub(super) fn parse_value(text: &str, source: usize, start: usize) -> Result<Node, SyntaxError> {
    let mut parser = Parser::new(text, source);
    parser.at = start;
    let node = parser.value()?;
    parser.end()?;
    Ok(node)
}

/// The byte offset of a line and column (characters, from 1).
fn offset(text: &str, place: &ron::error::Position) -> usize {
    let start: usize = text.split_inclusive('\n').take(place.line.saturating_sub(1)).map(str::len).sum();
    let column = place.col.saturating_sub(1);
    start + text[start..].char_indices().nth(column).map_or(text.len() - start, |(i, _)| i)
}

struct Parser<'a> {
    text: &'a str,
    source: usize,
    at: usize,
    depth: u32,
}

type Parsed<T> = Result<T, SyntaxError>;

impl<'a> Parser<'a> {
    fn new(text: &'a str, source: usize) -> Parser<'a> {
        Parser { text, source, at: 0, depth: 0 }
    }

    fn file(mut self) -> Parsed<Node> {
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
                Value::Seq(self.items(']')?)
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

    /// Values up to `close`, whose opening has been read.
    fn items(&mut self, close: char) -> Parsed<Vec<Node>> {
        let mut items = Vec::new();
        loop {
            self.space()?;
            if self.take(close) {
                return Ok(items);
            }
            items.push(self.value()?);
            self.separator(close)?;
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
        self.at += 1;
        self.space()?;
        let start = self.at;
        let named = self.identifier().is_some() && {
            self.space()?;
            self.peek() == Some(':')
        };
        self.at = start;
        if !named {
            let items = self.items(')')?;
            return Ok(if items.is_empty() {
                Value::Map(Vec::new(), Style::Fields)
            } else {
                Value::Seq(items)
            });
        }
        let mut entries = Vec::new();
        loop {
            self.space()?;
            if self.take(')') {
                return Ok(Value::Map(entries, Style::Fields));
            }
            let start = self.at;
            let key = self.identifier().ok_or_else(|| self.error("a field's name is expected"))?.to_owned();
            entries.push(self.entry(key, start)?);
            self.separator(')')?;
        }
    }

    /// `{ "name": value }`; a name without quotes is let through and refused with its place later.
    fn braces(&mut self) -> Parsed<Value> {
        self.at += 1;
        let mut entries = Vec::new();
        loop {
            self.space()?;
            if self.take('}') {
                return Ok(Value::Map(entries, Style::Braces));
            }
            let start = self.at;
            let key = match self.peek() {
                Some('"' | 'r') if !self.rest().starts_with("r#") || self.rest().starts_with("r#\"") => {
                    match self.value()?.value {
                        Value::Str(key) => key,
                        _ => return Err((start, "names in { } are written in quotes".into())),
                    }
                }
                _ => return Err((start, "a name in quotes is expected".into())),
            };
            entries.push(self.entry(key, start)?);
            self.separator('}')?;
        }
    }

    fn entry(&mut self, key: String, start: usize) -> Parsed<Entry> {
        let key_span = self.span(start);
        self.space()?;
        if !self.take(':') {
            return Err(self.error(&format!("`:` is expected after `{key}`")));
        }
        Ok(Entry { key, key_span, node: self.value()? })
    }

    fn identifier(&mut self) -> Option<&'a str> {
        let rest = self.rest();
        let raw =
            rest.strip_prefix("r#").filter(|r| r.starts_with(|c: char| c == '_' || c.is_alphanumeric()));
        let name = raw.unwrap_or(rest);
        if raw.is_none() && !name.starts_with(|c: char| c == '_' || c.is_alphabetic()) {
            return None;
        }
        let end = name.find(|c: char| !(c == '_' || c.is_alphanumeric())).unwrap_or(name.len());
        self.at += rest.len() - name.len() + end;
        Some(&name[..end])
    }

    /// A word, `tag(…)`, a raw string or a byte string.
    fn word(&mut self) -> Parsed<Value> {
        let rest = self.rest();
        if rest.starts_with("r\"") || rest.starts_with("r#\"") || rest.starts_with("r##") {
            return self.raw_string().map(Value::Str);
        }
        if rest.starts_with("b\"")
            || rest.starts_with("b'")
            || rest.starts_with("br") && rest[2..].starts_with(['"', '#'])
        {
            return Err(self.error("byte strings have no place in a scene"));
        }
        let start = self.at;
        let name = self.identifier().ok_or_else(|| self.error("a value is expected"))?.to_owned();
        let tag = self.span(start);
        match name.as_str() {
            "true" => return Ok(Value::Bool(true)),
            "false" => return Ok(Value::Bool(false)),
            "inf" | "inff32" | "inff64" => return Ok(Value::Float(f64::INFINITY)),
            "NaN" | "NaNf32" | "NaNf64" => return Ok(Value::Float(f64::NAN)),
            _ => {}
        }
        let end = self.at;
        self.space()?;
        if self.peek() != Some('(') {
            self.at = end;
            return Ok(Value::Word(name));
        }
        let start = self.at;
        let content = self.parens()?;
        Ok(Value::Tagged(name, tag, Box::new(Node { value: content, span: self.span(start) })))
    }

    fn number(&mut self) -> Parsed<Value> {
        let rest = self.rest();
        let signed = rest.strip_prefix(['+', '-']).unwrap_or(rest);
        let end = rest
            .char_indices()
            .find(|&(i, c)| {
                let exponent_sign = i > 0 && matches!(c, '+' | '-') && rest[..i].ends_with(['e', 'E']);
                !(c.is_alphanumeric() || c == '.' || c == '_' || i == 0 || exponent_sign)
            })
            .map_or(rest.len(), |(i, _)| i);
        let word = &rest[..end];
        let negative = word.starts_with('-');
        let plain = signed[..end - (rest.len() - signed.len())].replace('_', "");
        let bad = || (self.at, format!("`{word}` is not a number"));
        let sign = |i: i128| if negative { -i } else { i };
        let value =
            if let Some(radix) = [("0x", 16), ("0o", 8), ("0b", 2)].iter().find(|r| plain.starts_with(r.0)) {
                Value::Int(sign(i128::from_str_radix(&plain[2..], radix.1).map_err(|_| bad())?))
            } else if matches!(plain.as_str(), "inf" | "NaN") {
                Value::Float(f64::NAN)
            } else if !plain.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
                return Err(bad());
            } else if let Ok(i) = plain.parse() {
                Value::Int(sign(i))
            } else {
                let x: f64 = plain.parse().map_err(|_| bad())?;
                Value::Float(if negative { -x } else { x })
            };
        self.at += end;
        Ok(value)
    }

    fn character(&mut self) -> Parsed<Value> {
        let start = self.at;
        self.at += 1;
        while let Some(c) = self.peek() {
            self.at += c.len_utf8();
            match c {
                '\\' => self.at += self.peek().map_or(0, char::len_utf8),
                '\'' => return Ok(Value::Other("a character in single quotes")),
                _ => {}
            }
        }
        Err((start, "this character is not closed".into()))
    }

    fn raw_string(&mut self) -> Parsed<String> {
        let start = self.at;
        let rest = &self.rest()[1..];
        let hashes = rest.len() - rest.trim_start_matches('#').len();
        let open = || (start, "this raw text is not closed".to_owned());
        let body = rest[hashes..].strip_prefix('"').ok_or_else(open)?;
        let close = format!("\"{}", "#".repeat(hashes));
        let end = body.find(&close).ok_or_else(open)?;
        self.at += 1 + hashes + 1 + end + close.len();
        Ok(body[..end].to_owned())
    }

    fn string(&mut self) -> Parsed<String> {
        let start = self.at;
        self.at += 1;
        let mut text = String::new();
        while let Some(c) = self.peek() {
            self.at += c.len_utf8();
            match c {
                '"' => return Ok(text),
                '\\' => self.escape(&mut text)?,
                _ => text.push(c),
            }
        }
        Err((start, "this text is not closed with `\"`".into()))
    }

    fn escape(&mut self, text: &mut String) -> Parsed<()> {
        let bad = (self.at - 1, "this escape is not known".to_owned());
        let c = self.peek().ok_or(bad.clone())?;
        self.at += c.len_utf8();
        match c {
            'n' => text.push('\n'),
            'r' => text.push('\r'),
            't' => text.push('\t'),
            '0' => text.push('\0'),
            '\\' | '"' | '\'' => text.push(c),
            '\n' | '\r' => {
                let rest = self.rest();
                self.at += rest.len() - rest.trim_start().len();
            }
            'x' | 'u' => {
                let rest = self.rest();
                let (digits, length) = match (c, rest.strip_prefix('{')) {
                    ('u', Some(inner)) => {
                        inner.find('}').map(|end| (&inner[..end], end + 2)).ok_or(bad.clone())?
                    }
                    ('x', _) => rest.get(..2).map(|digits| (digits, 2)).ok_or(bad.clone())?,
                    _ => return Err(bad),
                };
                text.push(u32::from_str_radix(digits, 16).ok().and_then(char::from_u32).ok_or(bad)?);
                self.at += length;
            }
            _ => return Err(bad),
        }
        Ok(())
    }
}
