//! `--set path.to.key=value`: edits of the tree before it is typed, so that the same types check them.

use super::{Format, Reading, ron};
use crate::description::diagnostic::Kind;
use crate::description::source::Source;
use crate::description::suggest::{listed, question};
use crate::description::tree::{Entry, Node, Span, Style, Value};
use std::path::PathBuf;

/// Maps whose names must exist already: what an entry is called there.
const NAMED: [(&str, &str); 4] =
    [("textures", "texture"), ("materials", "material"), ("lights", "light"), ("definitions", "definition")];

/// Applies every override, in order.
pub(super) fn apply(reading: &mut Reading, root: &mut Node, overrides: &[String]) {
    for argument in overrides {
        let source = reading.sources.add(Source {
            file: None,
            argument: true,
            base: PathBuf::new(),
            format: Format::Ron,
            text: argument.clone(),
        });
        if let Err((span, message)) = Edit::new(argument, source).and_then(|edit| edit.apply(root)) {
            reading.error(Kind::Invalid, span, message);
        }
    }
}

type Outcome<T> = Result<T, (Span, String)>;

struct Edit {
    path: Vec<(String, Span)>,
    value: Node,
}

impl Edit {
    fn new(argument: &str, source: usize) -> Outcome<Edit> {
        let whole = Span { source, start: 0, end: argument.len() };
        let equals =
            unquoted(argument, '=').next().ok_or((whole, "expected path.to.key=value".to_owned()))?;
        let part = |start, end| Span { source, start, end };
        let path = steps(&argument[..equals], whole, part)?;
        if path[0].0 == "include" {
            let message = "what is included is read before anything is set: write it into the scene file";
            return Err((path[0].1, message.to_owned()));
        }
        Ok(Edit { path, value: value(argument, equals + 1, source) })
    }

    fn apply(self, root: &mut Node) -> Outcome<()> {
        let (first, _) = &self.path[0];
        if let (Some((_, what)), Some((name, span))) =
            (NAMED.iter().find(|(map, _)| map == first), self.path.get(1))
        {
            let entries = root.entry(first).map_or(&[][..], |entry| entry.node.entries());
            let names = || entries.iter().map(|entry| entry.key.as_str());
            if !names().any(|known| known == name) {
                return Err((*span, format!("no {what} `{name}`{}", question(name, names()))));
            }
        }
        put(root, &self.path, &mut Vec::new(), self.value)
    }
}

/// Where a sign stands outside of quotation marks.
fn unquoted(text: &str, sign: char) -> impl Iterator<Item = usize> {
    let mut quoted = false;
    text.char_indices().filter_map(move |(i, c)| {
        quoted ^= c == '"';
        (c == sign && !quoted).then_some(i)
    })
}

/// A path's names, each with the span of its bytes; in quotation marks, as messages show them, those with dots.
fn steps(path: &str, whole: Span, span: impl Fn(usize, usize) -> Span) -> Outcome<Vec<(String, Span)>> {
    let mut steps = Vec::new();
    let mut start = 0;
    for end in unquoted(path, '.').chain([path.len()]) {
        let (key, span) = (path[start..end].trim(), span(start, end));
        let key = key.strip_prefix('"').and_then(|key| key.strip_suffix('"')).unwrap_or(key);
        if key.is_empty() {
            return Err((span, "a name is missing in the path".into()));
        }
        steps.push((key.to_owned(), span));
        start = end + 1;
    }
    if steps.len() > 64 {
        return Err((whole, "the path is too long".into()));
    }
    Ok(steps)
}

/// Puts a value of the scene's own at a path; `span` is where the scene names it.
pub(super) fn put_at(root: &mut Node, path: &str, span: Span, value: Node) -> Outcome<()> {
    let path = steps(path, span, |_, _| span)?;
    if path[0].0 == "animation" || path[0].0 == "include" {
        return Err((span, format!("`{}` is the same for all frames", path[0].0)));
    }
    Edit { path, value }.apply(root)
}

/// The value behind `=`: RON, or else plain text.
fn value(argument: &str, start: usize, source: usize) -> Node {
    let text = argument[start..].trim();
    let span =
        Span { source, start: argument.len() - argument[start..].trim_start().len(), end: argument.len() };
    match ron::parse_value(argument, source, start) {
        Ok(Node { value: Value::Word(word), span }) => Node { value: Value::Bare(word), span },
        Ok(node) => node,
        Err(_) => Node { value: Value::Bare(text.to_owned()), span },
    }
}

/// Whether the scene's types have an enum there, whose variant a path may leave out.
fn enum_at(walked: &[String]) -> bool {
    match walked {
        [map, _] if map == "lights" || map == "textures" => true,
        [only] => only == "antialiasing",
        [.., last] => last == "shape" || last == "map",
        [] => false,
    }
}

fn put(node: &mut Node, path: &[(String, Span)], walked: &mut Vec<String>, value: Node) -> Outcome<()> {
    let Some(((key, span), rest)) = path.split_first() else {
        *node = value;
        return Ok(());
    };
    match &mut node.value {
        Value::Tagged(tag, _, content) if tag == key && rest.is_empty() => {
            let entry = Entry { key: key.clone(), key_span: *span, node: value };
            let span = content.span;
            *node = Node { value: Value::Map(vec![entry], Style::Table), span };
            Ok(())
        }
        Value::Tagged(tag, _, content) => {
            let named = tag == key;
            if named {
                walked.push(key.clone());
            }
            put(inner(content), if named { rest } else { path }, walked, value)
        }
        Value::Map(entries, Style::Table)
            if entries.len() == 1 && entries[0].key != *key && enum_at(walked) =>
        {
            walked.push(entries[0].key.clone());
            put(&mut entries[0].node, path, walked, value)
        }
        Value::Map(entries, _) => {
            walked.push(key.clone());
            let at = entries.iter().position(|entry| entry.key == *key).unwrap_or_else(|| {
                let node = Node { value: Value::Map(Vec::new(), Style::Table), span: *span };
                entries.push(Entry { key: key.clone(), key_span: *span, node });
                entries.len() - 1
            });
            put(&mut entries[at].node, rest, walked, value)
        }
        Value::Seq(items) => {
            let at = position(items, key).map_err(|message| (*span, message))?;
            walked.push(key.clone());
            put(&mut items[at], rest, walked, value)
        }
        _ => {
            // a plain value gives way to fields; the types say whether there are any
            node.value = Value::Map(Vec::new(), Style::Table);
            put(node, path, walked, value)
        }
    }
}

fn inner(content: &mut Node) -> &mut Node {
    let single = matches!(&content.value, Value::Seq(items) if items.len() == 1);
    if single { content.child_mut(0).expect("a list of one value has a first") } else { content }
}

/// The item with that number, or the one whose `name` it is.
fn position(items: &[Node], key: &str) -> Result<usize, String> {
    if let Ok(index) = key.parse::<usize>() {
        let count = items.len();
        return if index < count {
            Ok(index)
        } else {
            Err(format!("there is no entry {index}, the list has {count}"))
        };
    }
    let name = |item: &Node| match item.entry("name").map(|entry| entry.node.value.clone()) {
        Some(Value::Str(name) | Value::Bare(name)) => Some(name),
        _ => None,
    };
    let names: Vec<Option<String>> = items.iter().map(name).collect();
    names.iter().position(|name| name.as_deref() == Some(key)).ok_or_else(|| {
        let known = || names.iter().flatten().map(String::as_str);
        let have =
            if known().next().is_some() { format!(" (known: {})", listed(known())) } else { String::new() };
        format!("no entry is named `{key}`{}{have}", question(key, known()))
    })
}
