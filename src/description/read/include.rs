//! `include`: the textures, materials, lights, definitions and objects of other files, merged as trees
//! so that every value keeps its place.

use super::{Format, Reading};
use crate::description::diagnostic::Kind;
use crate::description::source::{self, MAX_FILE_BYTES, Source};
use crate::description::tree::{Entry, Node, Span, Style, Value};
use std::path::{Path, PathBuf};

const MAX_DEPTH: usize = 16;
const MAX_FILES: usize = 256;

/// What an included file may say, and whether it is a map of names.
const SHARED: [(&str, bool); 5] =
    [("textures", true), ("materials", true), ("lights", true), ("definitions", true), ("objects", false)];
const MAIN_ONLY: [&str; 7] =
    ["camera", "animation", "image", "antialiasing", "render", "background", "ambient"];

/// Merges into `root`, the tree of source 0, all that it includes.
pub(super) fn merge(reading: &mut Reading, root: &mut Node) {
    let file = reading.sources.get(0).file.clone();
    let main = file.as_deref().and_then(|file| file.canonicalize().ok());
    let shown = file.unwrap_or_else(|| "<input>".into());
    let mut merge =
        Merge { seen: main.iter().cloned().collect(), chain: vec![(shown, main.unwrap_or_default())] };
    let includes = includes(root);
    for (path, span) in includes {
        merge.file(reading, root, &path, span);
    }
}

/// The paths in a tree's `include`; whatever else stands there is the type's business.
fn includes(root: &Node) -> Vec<(String, Span)> {
    let Some(Entry { node: Node { value: Value::Seq(items), .. }, .. }) = root.entry("include") else {
        return Vec::new();
    };
    items
        .iter()
        .filter_map(|item| match &item.value {
            Value::Str(path) => Some((path.clone(), item.span)),
            _ => None,
        })
        .collect()
}

struct Merge {
    /// Canonical paths of files that are in already.
    seen: Vec<PathBuf>,
    /// From the main file to the one being read: as shown, and canonical.
    chain: Vec<(PathBuf, PathBuf)>,
}

impl Merge {
    fn file(&mut self, reading: &mut Reading, root: &mut Node, path: &str, span: Span) {
        let base = reading.sources.get(span.source).base.join(path);
        let file = reading.folder.join(&base);
        let refused = |reading: &mut Reading, kind, message| {
            reading.incomplete = true;
            reading.error(kind, span, message);
        };
        let canonical = file.canonicalize().unwrap_or_else(|_| file.clone());
        if let Some(start) = self.chain.iter().position(|(_, known)| *known == canonical) {
            let mut names: Vec<String> =
                self.chain[start..].iter().map(|(f, _)| f.display().to_string()).collect();
            names.push(names[0].clone());
            return refused(
                reading,
                Kind::Invalid,
                format!("files include each other: {}", names.join(" → ")),
            );
        }
        if self.seen.contains(&canonical) {
            return;
        }
        if self.chain.len() >= MAX_DEPTH || self.seen.len() >= MAX_FILES {
            let message =
                format!("more than {MAX_DEPTH} levels or {MAX_FILES} files of `include` are not read");
            return refused(reading, Kind::NotSupported, message);
        }
        let Some(format) = Format::from_path(&file) else {
            return refused(reading, Kind::NotSupported, format!("`{path}` does not end in .ron or .toml"));
        };
        let read: usize = reading.sources.sizes().sum();
        let left = MAX_FILE_BYTES.saturating_sub(read as u64);
        let text = match source::read(&file, &reading.terms.reach, left) {
            Ok(text) => text,
            Err(error) => {
                let message = format!("`{}` {}", file.display(), error.message);
                return refused(reading, error.kind, message);
            }
        };
        self.seen.push(canonical.clone());
        let folder = base.parent().unwrap_or(Path::new("")).to_owned();
        let source = Source { file: Some(file.clone()), argument: false, base: folder, format, text };
        let Some(included) = reading.parse(source) else {
            reading.incomplete = true;
            return;
        };
        let deeper = includes(&included);
        take_in(reading, root, included);
        self.chain.push((file, canonical));
        for (path, span) in deeper {
            self.file(reading, root, &path, span);
        }
        self.chain.pop();
    }
}

/// Moves the shared entries of an included tree into the main one.
fn take_in(reading: &mut Reading, root: &mut Node, included: Node) {
    let span = included.span;
    let Value::Map(entries, _) = included.value else {
        reading.error(Kind::Invalid, span, "a scene is expected: (materials: …, …)".into());
        return;
    };
    let Value::Map(main, _) = &mut root.value else { return };
    for entry in entries {
        if let Some((_, named)) = SHARED.iter().find(|(key, _)| *key == entry.key) {
            append(reading, main, entry, *named);
        } else if MAIN_ONLY.contains(&entry.key.as_str()) {
            let message = format!("`{}` belongs to the main file, an included file cannot set it", entry.key);
            reading.error(Kind::Invalid, entry.key_span, message);
        } else if entry.key != "include" {
            let near = crate::description::suggest::question(&entry.key, SHARED.iter().map(|(key, _)| *key));
            reading.error(
                Kind::Invalid,
                entry.key_span,
                format!("there is no field `{}` here{near}", entry.key),
            );
        }
    }
}

fn append(reading: &mut Reading, main: &mut Vec<Entry>, entry: Entry, named: bool) {
    let Some(at) = main.iter().position(|existing| existing.key == entry.key) else {
        main.push(entry);
        return;
    };
    let described = entry.node.described();
    match (&mut main[at].node.value, entry.node.value) {
        (Value::Map(into, style), Value::Map(more, other)) if named => {
            // names of mixed origin: brackets are judged by the looser file
            if *style != other && (*style == Style::Table || other == Style::Table) {
                *style = Style::Table;
            }
            into.extend(more);
        }
        (Value::Seq(into), Value::Seq(more)) if !named => into.extend(more),
        (Value::Map(into, Style::Fields), Value::Seq(more)) if !named && into.is_empty() => {
            main[at].node.value = Value::Seq(more);
        }
        (Value::Map(..), _) | (Value::Seq(_), _) => {
            let expected = if named { "a map from names to entries" } else { "a list [ ]" };
            reading.error(Kind::Invalid, entry.node.span, format!("expected {expected}, found {described}"));
        }
        // the main file's own entry is wrong, which its type will say
        _ => {}
    }
}
