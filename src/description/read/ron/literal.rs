//! What a value of RON is made of when it is not a list or map: words, numbers, characters and texts.

use super::{Parsed, Parser};
use crate::description::tree::{Node, Value};

impl<'a> Parser<'a> {
    pub(super) fn identifier(&mut self) -> Option<&'a str> {
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
    pub(super) fn word(&mut self) -> Parsed<Value> {
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

    pub(super) fn number(&mut self) -> Parsed<Value> {
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

    pub(super) fn character(&mut self) -> Parsed<Value> {
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

    pub(super) fn string(&mut self) -> Parsed<String> {
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
