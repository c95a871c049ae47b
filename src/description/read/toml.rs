//! TOML text to a tree; the `toml` crate parses, with all its syntax errors in one run.

use crate::description::tree::{Entry, Node, Span, Style, Value};
use toml::de::{DeTable, DeValue};

/// A syntax error: byte offset and message.
pub(super) type SyntaxError = (usize, String);

pub(super) fn parse(text: &str, source: usize) -> Result<Node, Vec<SyntaxError>> {
    let (table, errors) = DeTable::parse_recoverable(text);
    if !errors.is_empty() {
        let place = |e: &toml::de::Error| e.span().map_or(0, |span| span.start);
        let mut errors: Vec<SyntaxError> =
            errors.iter().map(|e| (place(e), e.message().replace('\n', "; "))).collect();
        errors.sort();
        errors.dedup();
        return Err(errors);
    }
    let mut numbers = Vec::new();
    let root = Node {
        value: entries(table.get_ref(), source, &mut numbers),
        span: Span { source, start: 0, end: 0 },
    };
    if numbers.is_empty() { Ok(root) } else { Err(numbers) }
}

fn entries(table: &DeTable, source: usize, errors: &mut Vec<SyntaxError>) -> Value {
    let mut entries: Vec<Entry> = table
        .iter()
        .map(|(key, value)| {
            let key_span = span(key.span(), source);
            let node = Node {
                value: convert(value.get_ref(), key_span, source, errors),
                span: span(value.span(), source),
            };
            Entry { key: key.get_ref().to_string(), key_span, node }
        })
        .collect();
    entries.sort_by_key(|entry| entry.key_span.start);
    Value::Map(entries, Style::Table)
}

fn convert(value: &DeValue, place: Span, source: usize, errors: &mut Vec<SyntaxError>) -> Value {
    match value {
        DeValue::String(text) => Value::Str(text.to_string()),
        DeValue::Boolean(b) => Value::Bool(*b),
        DeValue::Integer(i) => i128::from_str_radix(i.as_str(), i.radix()).map_or_else(
            |_| {
                errors.push((place.start, format!("the number {i} is too large")));
                Value::Hole
            },
            Value::Int,
        ),
        DeValue::Float(x) => Value::Float(x.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Datetime(_) => Value::Other("a date or time"),
        DeValue::Array(items) => Value::Seq(
            items
                .iter()
                .map(|item| {
                    let span = span(item.span(), source);
                    Node { value: convert(item.get_ref(), span, source, errors), span }
                })
                .collect(),
        ),
        DeValue::Table(table) => entries(table, source, errors),
    }
}

fn span(range: std::ops::Range<usize>, source: usize) -> Span {
    Span { source, start: range.start, end: range.end }
}
