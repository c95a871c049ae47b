//! A scene as text, in either format, laid out to be read by people; defaults are left out where the
//! types leave them out, and the text reads back as an equal scene.

use super::tree::{Node, Style, Value, number};
use super::{Format, Scene, read};
use serde::Serialize;

/// Lines are broken beyond this many characters.
const WIDTH: usize = 100;

/// Why a scene has no text in a format: TOML's whole numbers end at 2⁶³ − 1.
#[derive(Debug, thiserror::Error)]
#[error("this scene cannot be written: {0}")]
pub struct NotWritable(String);

/// The scene in `format`.
pub fn to_string(scene: &Scene, format: Format) -> Result<String, NotWritable> {
    match format {
        Format::Toml => {
            let mut buffer = toml::ser::Buffer::new();
            scene.serialize(toml::Serializer::new(&mut buffer)).map_err(|e| NotWritable(e.to_string()))?;
            // `Display` writes it out in one go; `toml::to_string` moves the rest of the text for each table.
            Ok(buffer.to_string())
        }
        Format::Ron => {
            let plain = read::convert_options().to_string(scene).map_err(|e| NotWritable(e.to_string()))?;
            let tree = read::tree_of_ron(&plain).map_err(NotWritable)?;
            let mut text = String::new();
            lay_out(&tree, 0, 0, &mut text);
            text.push('\n');
            Ok(text)
        }
    }
}

/// Appends a node: on one line if it fits after `used` characters, else one part a line.
fn lay_out(node: &Node, depth: usize, used: usize, text: &mut String) {
    // Nothing that holds more values than a line has characters fits on it.
    let short = depth > 0 && values(node, WIDTH) < WIDTH;
    if short {
        let line = one_line(node);
        if depth * 4 + used + line.chars().count() <= WIDTH {
            text.push_str(&line);
            return;
        }
    }
    let mut block = |open: &str, parts: Vec<(String, &Node)>, close: &str| {
        text.push_str(open);
        for (label, part) in parts {
            text.push('\n');
            text.push_str(&"    ".repeat(depth + 1));
            text.push_str(&label);
            lay_out(part, depth + 1, label.chars().count() + 1, text);
            text.push(',');
        }
        text.push('\n');
        text.push_str(&"    ".repeat(depth));
        text.push_str(close);
    };
    match &node.value {
        Value::Seq(items) if !items.is_empty() => {
            block("[", items.iter().map(|i| (String::new(), i)).collect(), "]")
        }
        Value::Map(entries, style) if !entries.is_empty() => {
            let braces = *style == Style::Braces;
            let parts = entries.iter().map(|e| (format!("{}: ", key(&e.key, braces)), &e.node)).collect();
            if braces { block("{", parts, "}") } else { block("(", parts, ")") }
        }
        Value::Tagged(tag, _, content) => {
            text.push_str(tag);
            match &content.value {
                Value::Seq(items) if items.len() == 1 => {
                    text.push('(');
                    lay_out(&items[0], depth, used + tag.len() + 1, text);
                    text.push(')');
                }
                _ => lay_out(content, depth, used + tag.len(), text),
            }
        }
        _ => text.push_str(&one_line(node)),
    }
}

/// How many values a node holds, itself included; counted up to about `most`.
fn values(node: &Node, most: usize) -> usize {
    let sum = |parts: &mut dyn Iterator<Item = &Node>| {
        let mut count = 1;
        for part in parts {
            if count >= most {
                break;
            }
            count += values(part, most - count);
        }
        count
    };
    match &node.value {
        Value::Seq(items) => sum(&mut items.iter()),
        Value::Map(entries, _) => sum(&mut entries.iter().map(|entry| &entry.node)),
        Value::Tagged(_, _, content) => values(content, most),
        _ => 1,
    }
}

fn key(key: &str, quoted: bool) -> String {
    if quoted { quote(key) } else { key.to_owned() }
}

fn quote(text: &str) -> String {
    ron::to_string(text).expect("any text can be written")
}

/// Vectors and matrices are tuples, everything else is a list.
fn is_tuple(items: &[Node]) -> bool {
    !items.is_empty()
        && items.iter().all(|item| match &item.value {
            Value::Int(_) | Value::Float(_) => true,
            Value::Seq(inner) => is_tuple(inner),
            _ => false,
        })
}

fn one_line(node: &Node) -> String {
    let list = |items: &[Node]| items.iter().map(one_line).collect::<Vec<_>>().join(", ");
    match &node.value {
        Value::Bool(b) => b.to_string(),
        Value::Int(i) => i.to_string(),
        Value::Float(x) if *x == 0.0 && x.is_sign_negative() => "-0.0".to_owned(),
        Value::Float(x) => number(*x),
        Value::Str(text) => quote(text),
        Value::Word(word) | Value::Bare(word) => word.clone(),
        Value::Seq(items) if is_tuple(items) => format!("({})", list(items)),
        Value::Seq(items) => format!("[{}]", list(items)),
        Value::Map(entries, style) => {
            let braces = *style == Style::Braces;
            let parts: Vec<String> =
                entries.iter().map(|e| format!("{}: {}", key(&e.key, braces), one_line(&e.node))).collect();
            let inside = parts.join(", ");
            if braces { format!("{{ {inside} }}") } else { format!("({inside})") }
        }
        Value::Tagged(tag, _, content) => match &content.value {
            Value::Seq(items) => format!("{tag}({})", list(items)),
            _ => format!("{tag}{}", one_line(content)),
        },
        Value::Other(what) => (*what).to_owned(),
        Value::Hole => "()".to_owned(),
    }
}
