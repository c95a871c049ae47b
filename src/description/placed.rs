//! The materials of placed objects: only these can call for anything.

use super::{Material, Object, Scene, Shape};
use std::collections::{HashMap, HashSet};
use std::fmt;

/// A material with the objects of the scene that are made of it.
pub struct Use<'a> {
    pub name: &'a str,
    pub material: &'a Material,
    /// Each once: by its name, or that of the definition or group that it is in, or its place: `objects.3`.
    pub objects: Vec<String>,
}

/// The materials in the order in which the scene's objects first use them. Names that the scene does not
/// have are left out.
pub fn uses(scene: &Scene) -> Vec<Use<'_>> {
    let mut uses: Vec<Use> = Vec::new();
    let mut places = HashMap::new();
    let walk = Walk::of(scene);
    for (label, name) in walk.found {
        let Some(material) = scene.materials.get(name) else { continue };
        let place = *places.entry(name).or_insert_with(|| {
            uses.push(Use { name, material, objects: Vec::new() });
            uses.len() - 1
        });
        uses[place].objects.push(label.to_string());
    }
    uses
}

/// The names of all materials that placed objects use.
pub fn used_materials(scene: &Scene) -> HashSet<&str> {
    Walk::of(scene).found.into_iter().map(|(_, material)| material).collect()
}

/// What an object is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Label<'a> {
    Name(&'a str),
    Place(usize),
}

impl fmt::Display for Label<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Label::Name(name) => f.write_str(name),
            Label::Place(i) => write!(f, "objects.{i}"),
        }
    }
}

/// What a nested object takes from those around it.
#[derive(Clone, Copy)]
struct Around<'a> {
    label: Label<'a>,
    material: Option<&'a str>,
    nesting: u32,
}

struct Walk<'a> {
    scene: &'a Scene,
    /// Objects with their materials, each pair once, in the order of the scene.
    found: Vec<(Label<'a>, &'a str)>,
    pairs: HashSet<(Label<'a>, &'a str)>,
    /// Definitions that were gone through, with the name and the material that were handed down to them.
    seen: HashSet<(Label<'a>, &'a str, Option<&'a str>)>,
}

/// Objects within objects at most.
pub const MAX_NESTING: u32 = 256;

impl<'a> Walk<'a> {
    fn of(scene: &'a Scene) -> Walk<'a> {
        let mut walk = Walk { scene, found: Vec::new(), pairs: HashSet::new(), seen: HashSet::new() };
        for (i, object) in scene.objects.iter().enumerate() {
            walk.visit(object, Around { label: Label::Place(i), material: None, nesting: 0 });
        }
        walk
    }

    fn visit(&mut self, object: &'a Object, around: Around<'a>) {
        if around.nesting > MAX_NESTING {
            return;
        }
        let around = Around {
            label: object.name.as_deref().map_or(around.label, Label::Name),
            material: object.material.as_deref().or(around.material),
            nesting: around.nesting + 1,
        };
        let named = object.name.is_some();
        match &object.shape {
            Shape::Group { objects } => objects.iter().for_each(|object| self.visit(object, around)),
            Shape::Instance { of } => self.definition(of, named, around),
            Shape::Scatter(scatter) if scatter.count == 0 => {}
            Shape::Scatter(scatter) => {
                scatter.of.iter().for_each(|name| self.definition(name, named, around))
            }
            Shape::Mesh { parts, .. } => {
                self.add(around.label, around.material);
                parts.iter().for_each(|(_, part)| self.add(around.label, Some(part)));
            }
            _ => self.add(around.label, around.material),
        }
    }

    /// A copy of a definition, by whose name it goes unless it is `named`.
    fn definition(&mut self, name: &'a str, named: bool, around: Around<'a>) {
        let label = if named { around.label } else { Label::Name(name) };
        if self.seen.insert((label, name, around.material))
            && let Some(object) = self.scene.definitions.get(name)
        {
            self.visit(object, Around { label, ..around });
        }
    }

    fn add(&mut self, label: Label<'a>, material: Option<&'a str>) {
        if let Some(material) = material
            && self.pairs.insert((label, material))
        {
            self.found.push((label, material));
        }
    }
}
