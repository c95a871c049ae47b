//! Reads a tree into the types and reports every mistake: after each error the offending node is
//! put right (a misspelt name) or made a hole, and the tree is read again.

use super::de::{De, one_of};
use super::fault::{Fault, Located};
use crate::description::diagnostic::{Diagnostic, Kind, Report, Severity};
use crate::description::source::Sources;
use crate::description::suggest::{nearest, question};
use crate::description::tree::{Entry, Node, Path, Span, Step, Style, Value};
use serde::Deserialize;
use std::collections::HashMap;

/// After so many mistakes of structure the rest is not looked for; each costs a reading of the tree, so
/// in very large files it is fewer.
const MAX_MISTAKES: usize = 200;
const MIN_MISTAKES: usize = 10;
const LARGE_BYTES: usize = 1 << 20;

pub(super) fn read<'s, T: for<'a> Deserialize<'a>>(
    root: &mut Node,
    sources: &'s Sources,
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<T> {
    let mut recovery = Recovery { sources, diagnostics };
    recovery.before_types(root, &Trail::Root);
    let size: usize = sources.sizes().sum();
    let most = (MAX_MISTAKES * LARGE_BYTES / size.max(LARGE_BYTES)).max(MIN_MISTAKES);
    for _ in 0..most {
        match T::deserialize(De(root)) {
            Ok(value) => return Some(value),
            Err(error) => recovery.put_right(root, error)?,
        }
    }
    let message = format!("there may be more mistakes: reading stopped after {most}");
    recovery.report(root.span, &Path::default(), message, None);
    None
}

/// A path that costs nothing until it is asked for.
enum Trail<'a> {
    Root,
    Key(&'a Trail<'a>, &'a str),
    Item(&'a Trail<'a>, usize),
}

impl Trail<'_> {
    fn path(&self) -> Path {
        match self {
            Trail::Root => Path::default(),
            Trail::Key(before, key) => before.path().key(key),
            Trail::Item(before, index) => before.path().index(*index),
        }
    }
}

struct Recovery<'s, 'd> {
    sources: &'s Sources,
    diagnostics: &'d mut Vec<Diagnostic>,
}

impl Recovery<'_, '_> {
    fn report(&mut self, span: Span, path: &Path, message: String, help: Option<String>) {
        if self.diagnostics.len() >= 2 * Report::MOST {
            return;
        }
        let mut diagnostic =
            self.sources.diagnostic(Severity::Error, Kind::Invalid, span, message).with_help(help);
        diagnostic.path = Some(path.to_string());
        self.diagnostics.push(diagnostic);
    }

    /// What no type can see: names given twice, and numbers that are not finite.
    fn before_types(&mut self, node: &mut Node, trail: &Trail) {
        match &mut node.value {
            Value::Float(x) if !x.is_finite() => {
                let what = if x.is_nan() { "not a number" } else { "infinite or beyond 1.8e308" };
                let message = format!("a finite number is expected, this is {what}");
                self.report(node.span, &trail.path(), message, None);
                node.value = Value::Hole;
            }
            Value::Seq(items) => {
                for (i, item) in items.iter_mut().enumerate() {
                    self.before_types(item, &Trail::Item(trail, i));
                }
            }
            Value::Tagged(tag, _, content) => {
                let inner = Trail::Key(trail, tag);
                match &mut content.value {
                    Value::Seq(items) if items.len() == 1 => self.before_types(&mut items[0], &inner),
                    _ => self.before_types(content, &inner),
                }
            }
            Value::Map(entries, _) => {
                self.drop_doubles(entries, trail);
                for Entry { key, node, .. } in entries {
                    self.before_types(node, &Trail::Key(trail, key));
                }
            }
            _ => {}
        }
    }

    /// Of entries with the same key the first stays, the others are reported.
    fn drop_doubles(&mut self, entries: &mut Vec<Entry>, trail: &Trail) {
        // Most maps are a few fields, which need no table to be compared.
        let few = entries.len() <= 16;
        if few && (1..entries.len()).all(|i| entries[..i].iter().all(|e| e.key != entries[i].key)) {
            return;
        }
        let mut first: HashMap<String, Span> = HashMap::new();
        entries.retain(|entry| match first.get(&entry.key) {
            None => {
                first.insert(entry.key.clone(), entry.key_span);
                true
            }
            Some(&span) => {
                let place = self.sources.place(span);
                let message = format!("`{}` is given twice; the first is at {place}", entry.key);
                self.report(entry.key_span, &trail.path(), message, None);
                false
            }
        });
    }

    /// Reports the error and changes the tree so that it does not come again.
    fn put_right(&mut self, root: &mut Node, mut error: Located) -> Option<()> {
        if let Fault::UnknownField { name, known } = &error.fault {
            let index = error.at.first().copied()?;
            let (parent, path) = walk(root, &error.at[1..])?;
            return self.unknown_field(parent, &path, index, name, known);
        }
        let (node, path) = walk(root, &error.at)?;
        let span = node.span;
        match error.fault {
            Fault::Missing(field) => {
                self.report(span, &path, format!("`{field}` is missing"), None);
                let entry = Entry { key: field.into(), key_span: span, node: Node::hole(span) };
                match &mut node.value {
                    Value::Map(entries, _) => entries.push(entry),
                    _ => node.value = Value::Hole,
                }
            }
            Fault::FieldsMissing(tag) => {
                let message = format!("`{tag}` needs its values: {}", self.form(span, &tag));
                self.report(span, &path, message, None);
                node.value = Value::Hole;
            }
            Fault::Brackets(form) => {
                self.report(span, &path, format!("expected {form}, found {}", node.described()), None);
                if let Value::Map(_, style) = &mut node.value {
                    *style = Style::Table;
                }
            }
            Fault::UnknownVariant { name, known } => {
                let message = format!("there is no `{name}` here{}", question(&name, known.iter().copied()));
                let tag_span = variant_span(node);
                self.report(tag_span, &path, message, Some(format!("known: {}", one_of(known))));
                match nearest(&name, known.iter().copied()) {
                    Some(near) => rename_variant(node, near),
                    None => node.value = Value::Hole,
                }
            }
            fault if node.is_hole() => {
                // what stands in for a reported value does not fit either: widen the hole
                if error.at.is_empty() {
                    return None;
                }
                error.at.remove(0);
                let (parent, _) = walk(root, &error.at)?;
                let _ = fault;
                parent.value = Value::Hole;
            }
            Fault::Type(expected) => {
                self.report(span, &path, format!("expected {expected}, found {}", node.described()), None);
                node.value = Value::Hole;
            }
            Fault::Message(message) => {
                self.report(span, &path, message, None);
                node.value = Value::Hole;
            }
            Fault::UnknownField { .. } => {}
        }
        Some(())
    }

    fn form(&self, span: Span, tag: &str) -> String {
        match self.sources.get(span.source).format {
            crate::description::Format::Ron => format!("`{tag}(…)`"),
            crate::description::Format::Toml => format!("`{{ {tag} = … }}`"),
        }
    }

    /// Reports and drops all at once what is no field: one by one, a table of a million would take hours.
    fn no_fields(&mut self, entries: &mut Vec<Entry>, path: &Path, known: &'static [&'static str]) {
        entries.retain(|entry| {
            let is_known = known.contains(&entry.key.as_str());
            if !is_known && self.diagnostics.len() < Report::MOST {
                let message = format!("there is no field `{}` here", entry.key);
                self.report(entry.key_span, path, message, Some(format!("known: {}", one_of(known))));
            }
            is_known
        });
    }

    fn unknown_field(
        &mut self,
        parent: &mut Node,
        path: &Path,
        index: usize,
        name: &str,
        known: &'static [&'static str],
    ) -> Option<()> {
        let Value::Map(entries, _) = &mut parent.value else {
            parent.value = Value::Hole;
            return Some(());
        };
        if entries.len() > MOST_FIELDS {
            self.no_fields(entries, path, known);
            return Some(());
        }
        let present: Vec<String> = entries.iter().map(|entry| entry.key.clone()).collect();
        let free = || known.iter().copied().filter(|field| !present.iter().any(|p| p == field));
        let near = nearest(name, free());
        // a name that is there already is suggested, but cannot be meant a second time
        let shown = near.or_else(|| nearest(name, known.iter().copied()));
        let message = format!("there is no field `{name}` here{}", question(name, shown));
        let help = match (name, known.contains(&"intensity") || known.contains(&"irradiance")) {
            ("samples" | "shadow_rays", true) => {
                "this light has no extent: one shadow ray tells all; `sphere`, `quad` and `disk` have"
                    .to_owned()
            }
            _ => format!("known: {}", one_of(known)),
        };
        self.report(entries.get(index)?.key_span, path, message, Some(help));
        match near {
            Some(near) => entries[index].key = near.to_owned(),
            None => drop(entries.remove(index)),
        }
        Some(())
    }
}

/// No type has as many fields: what has more is no slip of the pen.
const MOST_FIELDS: usize = 1000;

/// The node at child indices given from the inside out, and its path in the scene.
fn walk<'a>(root: &'a mut Node, at: &[usize]) -> Option<(&'a mut Node, Path)> {
    let mut path = Path::default();
    let mut node = root;
    let mut content_of_tag = false;
    for &index in at.iter().rev() {
        let step = match &node.value {
            Value::Map(entries, _) => Some(Step::Key(entries.get(index)?.key.as_str().into())),
            Value::Tagged(tag, ..) if tag != "Some" => Some(Step::Key(tag.as_str().into())),
            Value::Seq(items) if !(content_of_tag && items.len() == 1) => Some(Step::Index(index)),
            _ => None,
        };
        if let Some(step) = step {
            path = path.then(step);
        }
        content_of_tag = matches!(node.value, Value::Tagged(..));
        node = node.child_mut(index)?;
    }
    Some((node, path))
}

fn variant_span(node: &Node) -> Span {
    match &node.value {
        Value::Tagged(_, span, _) => *span,
        Value::Map(entries, _) if !entries.is_empty() => entries[0].key_span,
        _ => node.span,
    }
}

fn rename_variant(node: &mut Node, name: &str) {
    match &mut node.value {
        Value::Tagged(tag, ..) => *tag = name.to_owned(),
        Value::Word(word) | Value::Bare(word) | Value::Str(word) => *word = name.to_owned(),
        Value::Map(entries, _) if !entries.is_empty() => entries[0].key = name.to_owned(),
        value => *value = Value::Hole,
    }
}
