//! The materials of placed objects: only these can call for anything.

use crate::description::{Material, Object, Scene, Shape};
use std::collections::{HashMap, HashSet};

/// A material with the objects of the scene that are made of it.
pub(super) struct Use<'a> {
    pub name: &'a str,
    pub material: &'a Material,
    /// Each once, by its name or, without one, by its place: `objects.3`.
    pub objects: Vec<String>,
}

/// The materials in the order in which the scene's objects first use them. Names that the scene does not
/// have are left out.
pub(super) fn uses(scene: &Scene) -> Vec<Use<'_>> {
    let mut uses: Vec<Use> = Vec::new();
    let mut places = HashMap::new();
    for (object, name) in placed(scene) {
        let Some(material) = scene.materials.get(name) else { continue };
        let place = *places.entry(name).or_insert_with(|| {
            uses.push(Use { name, material, objects: Vec::new() });
            uses.len() - 1
        });
        uses[place].objects.push(label(scene, object));
    }
    uses
}

/// The names of all materials that placed objects use.
pub fn used_materials(scene: &Scene) -> HashSet<&str> {
    placed(scene).into_iter().map(|(_, material)| material).collect()
}

fn label(scene: &Scene, object: usize) -> String {
    scene.objects[object].name.clone().unwrap_or_else(|| format!("objects.{object}"))
}

/// The index of each object with its materials, each pair once, in the order of the scene.
fn placed(scene: &Scene) -> Vec<(usize, &str)> {
    let mut walk = Walk { scene, object: 0, found: Vec::new(), pairs: HashSet::new(), seen: HashSet::new() };
    for (i, object) in scene.objects.iter().enumerate() {
        walk.object = i;
        walk.visit(object, None, 0);
    }
    walk.found
}

struct Walk<'a> {
    scene: &'a Scene,
    object: usize,
    found: Vec<(usize, &'a str)>,
    pairs: HashSet<(usize, &'a str)>,
    /// Definitions that were gone through, with what was handed down to them.
    seen: HashSet<(usize, &'a str, Option<&'a str>)>,
}

/// As deep as objects are placed.
const MAX_NESTING: u32 = 256;

impl<'a> Walk<'a> {
    fn visit(&mut self, object: &'a Object, around: Option<&'a str>, nesting: u32) {
        if nesting > MAX_NESTING {
            return;
        }
        let material = object.material.as_deref().or(around);
        match &object.shape {
            Shape::Group { objects } => objects.iter().for_each(|o| self.visit(o, material, nesting + 1)),
            Shape::Instance { of } => self.definition(of, material, nesting),
            Shape::Scatter(scatter) if scatter.count == 0 => {}
            Shape::Scatter(scatter) => {
                scatter.of.iter().for_each(|name| self.definition(name, material, nesting));
            }
            Shape::Mesh { parts, .. } => {
                self.add(material);
                parts.iter().for_each(|(_, part)| self.add(Some(part)));
            }
            _ => self.add(material),
        }
    }

    fn definition(&mut self, name: &'a str, around: Option<&'a str>, nesting: u32) {
        if self.seen.insert((self.object, name, around))
            && let Some(object) = self.scene.definitions.get(name)
        {
            self.visit(object, around, nesting + 1);
        }
    }

    fn add(&mut self, material: Option<&'a str>) {
        if let Some(material) = material
            && self.pairs.insert((self.object, material))
        {
            self.found.push((self.object, material));
        }
    }
}
