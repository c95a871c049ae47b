//! Glass and water need an inside: a warning for each placed shape that has none.

use super::Checker;
use super::objects::list;
use crate::description::tree::Path;
use crate::description::{Object, Shape};
use std::collections::HashSet;

pub(super) fn check(c: &mut Checker) {
    let scene = c.scene;
    let simple = scene.simplified();
    let interfaces =
        simple.materials.iter().filter(|(_, m)| m.is_interface()).map(|(name, _)| name.to_owned());
    let mut walk = Walk { interfaces: interfaces.collect(), c, seen: HashSet::new() };
    for (i, object) in scene.objects.iter().enumerate() {
        walk.object(object, &list().index(i), None);
    }
}

struct Walk<'w, 'a> {
    c: &'w mut Checker<'a>,
    /// The names of materials that light passes through and that bend it.
    interfaces: HashSet<String>,
    /// Definitions that were looked at, with the material of what places them.
    seen: HashSet<(&'a str, Option<&'a str>)>,
}

impl<'a> Walk<'_, 'a> {
    fn object(&mut self, object: &'a Object, path: &Path, around: Option<&'a str>) {
        let material = object.material.as_deref().or(around);
        match &object.shape {
            Shape::Group { objects } => {
                let list = path.key("shape").key("group").key("objects");
                for (i, object) in objects.iter().enumerate() {
                    self.object(object, &list.index(i), material);
                }
            }
            Shape::Instance { of } => self.definition(of, material),
            Shape::Scatter(scatter) => scatter.of.iter().for_each(|of| self.definition(of, material)),
            shape => {
                if let (Some((tag, help)), Some(material)) = (open(shape), material) {
                    self.warn(&path.key("shape").key(tag), material, help);
                }
            }
        }
    }

    fn definition(&mut self, name: &'a str, material: Option<&'a str>) {
        if self.seen.insert((name, material))
            && let Some(object) = self.c.definitions.get(name).copied()
        {
            self.object(object, &Path::of("definitions").key(name), material);
        }
    }

    fn warn(&mut self, path: &Path, material: &str, help: &str) {
        if !self.interfaces.contains(material) {
            return;
        }
        let message = format!(
            "the material `{material}` transmits, and this shape has no inside: how far light goes through it, \
             and where it leaves, is not defined; {help}"
        );
        self.c.warn(path, message);
    }
}

/// The tag of a shape that light can enter without leaving, and what to take for it. Of meshes only their
/// files can tell.
fn open(shape: &Shape) -> Option<(&'static str, &'static str)> {
    const CAPS: &str = "give it `caps`";
    match shape {
        Shape::Quad { .. } => Some(("quad", "take a thin `box`")),
        Shape::Disk { .. } => Some(("disk", "take a flat `cylinder`")),
        Shape::Cone { caps: false, .. } => Some(("cone", CAPS)),
        Shape::Cylinder { caps: false, .. } => Some(("cylinder", CAPS)),
        _ => None,
    }
}
