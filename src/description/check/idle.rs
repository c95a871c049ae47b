//! Settings of a material that change nothing: warnings, but for those of included files, which may well be
//! libraries, and for values that an animation changes.

use super::Checker;
use crate::description::tree::Path;
use crate::description::{Dispersion, Material, Source};

pub(super) fn check(c: &mut Checker) {
    let entries = c.root.root.entry("materials").map_or(&[][..], |entry| entry.node.entries());
    for entry in entries.iter().filter(|entry| entry.key_span.source == 0) {
        if let Some(material) = c.scene.materials.get(&entry.key) {
            let material = Of { path: Path::of("materials").key(&entry.key), m: material };
            material.settings(c);
            material.hidden(c);
            material.dispersion(c);
            material.maps(c);
        }
    }
}

struct Of<'a> {
    path: Path,
    m: &'a Material,
}

impl Of<'_> {
    /// What does nothing where another is 0.
    fn settings(&self, c: &mut Checker) {
        let m = self.m;
        for (key, given) in [
            ("ior", m.ior.is_some()),
            ("dispersion", m.dispersion.is_some()),
            ("absorption", !m.absorption.is_zero()),
            ("priority", m.priority != 0),
        ] {
            if given {
                self.needs(c, key, "transmission", &m.transmission);
            }
        }
        if m.shininess.is_some() {
            self.needs(c, "shininess", "specular", &m.specular);
        }
        for (key, source) in self.weights() {
            if let Some(texture) = source.texture().filter(|texture| texture.scale.is_zero()) {
                let message = format!("scaled by 0, the texture `{}` does nothing", texture.name);
                c.idle(&[&self.path.key(key).key("texture").key("scale")], message);
            }
        }
    }

    fn weights(&self) -> [(&'static str, &Source); 5] {
        let m = self.m;
        [
            ("diffuse", &m.diffuse),
            ("specular", &m.specular),
            ("reflection", &m.reflection),
            ("transmission", &m.transmission),
            ("emission", &m.emission),
        ]
    }

    fn needs(&self, c: &mut Checker, key: &str, other: &str, source: &Source) {
        if !c.scene.is_zero(source) {
            return;
        }
        let message = format!("`{key}` does nothing where `{other}` is 0");
        let texture = source.texture().map(|texture| Path::of("textures").key(&texture.name));
        let own = [self.path.key(key), self.path.key(other)];
        let paths: Vec<&Path> = own.iter().chain(&texture).collect();
        c.idle(&paths, message);
    }

    /// What is below a layer that lets nothing through.
    fn hidden(&self, c: &mut Checker) {
        for (above, below) in
            [("reflection", "diffuse"), ("reflection", "transmission"), ("transmission", "diffuse")]
        {
            let of = |name: &str| {
                self.weights().into_iter().find(|(key, _)| *key == name).map(|(_, source)| source)
            };
            let (Some(over), Some(under)) = (of(above), of(below)) else { continue };
            if over.is_one() && !under.is_zero() {
                let message = format!("`{below}` does nothing where `{above}` is 1: it lies below");
                c.idle(&[&self.path.key(below), &self.path.key(above)], message);
            }
        }
    }

    fn dispersion(&self, c: &mut Checker) {
        let place = self.path.key("dispersion");
        if self.m.transmission.is_zero() {
            return;
        }
        match self.m.dispersion {
            Some(Dispersion::Cauchy(0.0)) => c.idle(&[&place.key("cauchy")], "a dispersion of 0 does nothing"),
            Some(Dispersion::Abbe(_)) if self.m.index() == 1.0 => c.idle(
                &[&place.key("abbe"), &self.path.key("ior")],
                "an Abbe number does nothing where `ior` is 1: it spreads `ior` − 1; `cauchy` gives the spread itself",
            ),
            _ => {}
        }
    }

    fn maps(&self, c: &mut Checker) {
        let texture = |name: &str| Path::of("textures").key(name);
        if let Some(map) = self.m.normal_map.as_ref().filter(|map| c.scene.is_flat(map)) {
            let place = self.path.key("normal_map");
            match map.strength == 0.0 {
                true => c.idle(&[&place.key("strength")], "a normal map of strength 0 does nothing"),
                false => c.idle(
                    &[&place.key("texture"), &texture(&map.texture)],
                    "this normal map does nothing: its texture is flat everywhere",
                ),
            }
        }
        if let Some(map) = self.m.bump_map.as_ref().filter(|map| c.scene.is_level(map)) {
            let place = self.path.key("bump_map");
            match map.height_m == 0.0 {
                true => c.idle(&[&place.key("height_m")], "a bump map of height 0 does nothing"),
                false => c.idle(
                    &[&place.key("texture"), &texture(&map.texture)],
                    "this bump map does nothing: its texture is of one colour",
                ),
            }
        }
    }
}
