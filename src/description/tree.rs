//! The syntax tree of a scene file: values with their places, the same for RON and TOML.
//!
//! Everything between text and types works on it: `include` merges trees, `--set` edits them, the
//! reader deserialises from them, and the checks find the place of a value by its path.

use std::collections::HashMap;
use std::fmt::{self, Write};
use std::sync::Arc;

/// A byte range of a source, `Sources::get(source)`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Span {
    pub source: usize,
    pub start: usize,
    pub end: usize,
}

#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub value: Value,
    pub span: Span,
}

/// How a map was written; it decides what it can be read as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Style {
    /// RON `(field: value)`.
    Fields,
    /// RON `{ "name": value }`.
    Braces,
    /// A TOML table, or a map made by `--set`: whatever is asked for.
    Table,
}

#[derive(Clone, Debug)]
pub(crate) struct Entry {
    pub key: String,
    pub key_span: Span,
    pub node: Node,
}

#[derive(Clone, Debug)]
pub(crate) enum Value {
    Bool(bool),
    Int(i128),
    Float(f64),
    Str(String),
    /// A RON identifier that stands alone: `progressive`, `None`.
    Word(String),
    /// The same as the whole value of a `--set`: a word or a string.
    Bare(String),
    Seq(Vec<Node>),
    Map(Vec<Entry>, Style),
    /// RON `tag(…)`: the content is a `Seq` or a `Map`.
    Tagged(String, Span, Box<Node>),
    /// Something that the grammar knows and no scene needs, by name.
    Other(&'static str),
    /// A value that was wrong and has been reported: reads as anything.
    Hole,
}

impl Node {
    pub fn hole(span: Span) -> Node {
        Node { value: Value::Hole, span }
    }

    pub fn is_hole(&self) -> bool {
        matches!(self.value, Value::Hole)
    }

    /// What the node is, for messages.
    pub fn described(&self) -> String {
        match &self.value {
            Value::Bool(b) => format!("`{b}`"),
            Value::Int(i) => format!("`{i}`"),
            Value::Float(x) => format!("`{}`", number(*x)),
            Value::Str(s) => format!("the text {:?}", shortened(s)),
            Value::Word(w) | Value::Bare(w) => format!("`{}`", shortened(w)),
            Value::Seq(items) if items.len() == 1 => "a list of 1 value".into(),
            Value::Seq(items) => format!("a list of {} values", items.len()),
            Value::Map(_, Style::Fields) => "fields in ( )".into(),
            Value::Map(_, Style::Braces) => "a map in { }".into(),
            Value::Map(_, Style::Table) => "a table".into(),
            Value::Tagged(tag, ..) => format!("`{}(…)`", shortened(tag)),
            Value::Other(what) => (*what).into(),
            Value::Hole => "nothing".into(),
        }
    }

    pub fn entries(&self) -> &[Entry] {
        match &self.value {
            Value::Map(entries, _) => entries,
            _ => &[],
        }
    }

    pub fn entry(&self, key: &str) -> Option<&Entry> {
        self.entries().iter().find(|entry| entry.key == key)
    }

    /// By position: of an item, of an entry, or 0 for the content of a tag.
    pub fn child_mut(&mut self, index: usize) -> Option<&mut Node> {
        match &mut self.value {
            Value::Seq(items) => items.get_mut(index),
            Value::Map(entries, _) => entries.get_mut(index).map(|entry| &mut entry.node),
            Value::Tagged(_, _, content) => (index == 0).then_some(content),
            _ => None,
        }
    }

    /// The node at the end of `steps`, or the deepest one on the way to it that exists, and whether the way met a hole.
    fn find(&self, steps: &[&Step]) -> Found<'_> {
        let mut node = self;
        let mut whole = true;
        for step in steps {
            if node.is_hole() {
                break;
            }
            match node.step(step) {
                Some(next) => node = next,
                None => {
                    whole = false;
                    break;
                }
            }
        }
        Found { node, whole, hole: node.is_hole() }
    }

    fn step(&self, step: &Step) -> Option<&Node> {
        match (&self.value, step) {
            (Value::Map(..), Step::Key(key)) => self.entry(key).map(|entry| &entry.node),
            (Value::Seq(items), Step::Index(i)) => items.get(*i),
            (Value::Tagged(tag, _, content), Step::Key(key)) if **tag == **key => Some(unwrapped(content)),
            (Value::Tagged(tag, _, content), _) if tag == "Some" => unwrapped(content).step(step),
            (Value::Tagged(_, _, content), _) => content.step(step),
            _ => None,
        }
    }
}

/// The content of `tag(value)`: the value itself.
pub(crate) fn unwrapped(content: &Node) -> &Node {
    match &content.value {
        Value::Seq(items) if items.len() == 1 => &items[0],
        _ => content,
    }
}

pub(crate) struct Found<'a> {
    pub node: &'a Node,
    /// The path led all the way.
    pub whole: bool,
    /// It led to a value that has been reported already.
    pub hole: bool,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    Key(Box<str>),
    Index(usize),
}

/// A place in the scene: `materials.ball.ior`, `objects.3.shape`. Longer ones share their beginning.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Path(Option<Arc<(Path, Step)>>);

impl Path {
    /// From a dotted text without names of the user's: `camera.eye`.
    pub fn of(text: &str) -> Path {
        text.split('.').fold(Path::default(), |path, part| path.key(part))
    }

    pub fn key(&self, key: &str) -> Path {
        self.then(Step::Key(key.into()))
    }

    pub fn index(&self, index: usize) -> Path {
        self.then(Step::Index(index))
    }

    /// The file of an image texture.
    pub fn image_texture(name: &str) -> Path {
        Path::of("textures").key(name).key("image").key("path")
    }

    /// The file of an environment light.
    pub fn environment_image(name: &str) -> Path {
        Path::of("lights").key(name).key("environment").key("map").key("image").key("path")
    }

    /// The file of the mesh at this object.
    pub fn mesh(&self) -> Path {
        self.key("shape").key("mesh").key("path")
    }

    /// The material of a part of the mesh at this object.
    pub fn mesh_part(&self, part: &str) -> Path {
        self.key("shape").key("mesh").key("parts").key(part)
    }

    /// An object of the group at this object.
    pub fn member(&self, index: usize) -> Path {
        self.key("shape").key("group").key("objects").index(index)
    }

    pub(crate) fn then(&self, step: Step) -> Path {
        Path(Some(Arc::new((self.clone(), step))))
    }

    /// From the scene's root on.
    pub(crate) fn steps(&self) -> Vec<&Step> {
        let mut steps = Vec::new();
        let mut path = self;
        while let Some((before, step)) = path.0.as_deref() {
            steps.push(step);
            path = before;
        }
        steps.reverse();
        steps
    }
}

impl fmt::Display for Path {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        for (i, step) in self.steps().into_iter().enumerate() {
            if i > 0 {
                f.write_char('.')?;
            }
            match step {
                Step::Index(index) => write!(f, "{index}")?,
                Step::Key(key) if key.is_empty() || key.contains(['.', ' ', '"', '\n']) => {
                    write!(f, "{:?}", shortened(key))?;
                }
                Step::Key(key) => f.write_str(&shortened(key))?,
            }
        }
        Ok(())
    }
}

/// A tree whose maps of names (`materials`, `textures`, …) are searched without going through them.
pub(crate) struct Index<'a> {
    pub root: &'a Node,
    named: HashMap<(&'a str, &'a str), &'a Node>,
}

impl<'a> Index<'a> {
    pub fn new(root: &'a Node) -> Index<'a> {
        let maps = root.entries().iter().flat_map(|map| {
            map.node.entries().iter().map(move |entry| ((map.key.as_str(), entry.key.as_str()), &entry.node))
        });
        Index { root, named: maps.collect() }
    }

    /// As `Node::find` from the root.
    pub fn find(&self, path: &Path) -> Found<'a> {
        let steps = path.steps();
        if let [Step::Key(map), Step::Key(name), rest @ ..] = &steps[..]
            && let Some(node) = self.named.get(&(&**map, &**name))
        {
            return node.find(rest);
        }
        self.root.find(&steps)
    }
}

/// A number as a user would write it.
pub(crate) fn number(x: f64) -> String {
    let size = x.abs();
    if x != 0.0 && x.is_finite() && !(1e-4..1e15).contains(&size) { format!("{x:e}") } else { format!("{x}") }
}

/// A text of the user's, cut so that a message stays a message.
pub(crate) fn shortened(text: &str) -> String {
    match text.char_indices().nth(60) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}
