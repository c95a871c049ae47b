//! Doubts: what is named but not used, and scenes with nothing to see. Warnings only, and none about
//! entries of included files, which may well be libraries.

use super::objects::list;
use super::{Checker, Report, Severity};
use crate::description::tree::Path;
use crate::description::{EnvironmentMap, IndirectBy, Light, Object, Photons, Shape, uses};
use std::collections::HashSet;

pub(super) fn check(c: &mut Checker) {
    let scene = c.scene;
    let mut materials = HashSet::new();
    let mut definitions = HashSet::new();
    for object in scene.objects.iter().chain(scene.definitions.iter().map(|(_, object)| object)) {
        collect(object, &mut materials, &mut definitions);
    }
    let textures: HashSet<&str> =
        scene.materials.iter().flat_map(|(_, material)| material.textures()).collect();
    unused(c, "textures", "texture", &textures);
    unused(c, "materials", "material", &materials);
    unused(c, "definitions", "definition", &definitions);
    if scene.objects.is_empty() && !c.root.find(&list()).hole {
        c.warn(&Path::default(), "the scene has no objects");
    }
    idle_settings(c);
    idle_sky(c);
    let simple = scene.simplified();
    let emits = simple.materials.iter().any(|(_, m)| m.emits());
    let lit = !scene.lights.is_empty() || !scene.ambient.is_zero() || !scene.background.is_zero();
    if !lit && !emits {
        c.warn(
            &Path::default(),
            "nothing shines in the scene: no light, no emission, no ambient, no background",
        );
    }
}

/// Settings of light that this scene cannot have.
fn idle_settings(c: &mut Checker) {
    let scene = c.scene.simplified();
    let uses = uses(&scene);
    let any = |of: fn(&crate::description::Material) -> bool| uses.iter().any(|u| of(u.material));
    let lit = c.scene.lights.iter().any(|(_, light)| !light.is_black()) || any(|m| m.emits());
    let why = if !lit {
        Some("the scene has no light")
    } else if !any(|m| m.receives()) {
        Some("nothing placed can show it: every material only reflects, transmits or is black")
    } else {
        None
    };
    let (indirect, by) = (Path::of("indirect"), Path::of("indirect_by"));
    let (lights, materials) = (Path::of("lights"), Path::of("materials"));
    match why {
        Some(why) if !c.scene.indirect.is_off() => {
            c.idle(&[&indirect, &lights, &materials], format!("`indirect` does nothing: {why}"))
        }
        None if !c.scene.indirect.is_off() && !c.scene.ambient.is_zero() => {
            let message = "`ambient` stands for `indirect`: with both, that light is counted twice";
            c.idle(&[&Path::of("ambient"), &indirect], message);
        }
        None if c.scene.indirect.is_off() && c.scene.indirect_by != IndirectBy::default() => {
            c.idle(&[&by, &indirect], "`indirect_by` does nothing without `indirect`");
        }
        _ => {}
    }
    let photons = !c.scene.photons.is_default() && c.scene.photons != Photons::Off;
    let by_photons = !c.scene.indirect.is_off() && c.scene.indirect_by != IndirectBy::Paths;
    if photons && !by_photons && !any(|m| m.is_specular()) {
        let message = "`photons` do nothing: nothing placed reflects or transmits";
        c.idle(&[&Path::of("photons"), &materials], message);
    }
}

/// What a sky hides, and its turn where it looks the same from all sides.
fn idle_sky(c: &mut Checker) {
    let scene = c.scene;
    for (name, light) in scene.lights.iter() {
        let Light::Environment { map, turn_deg, visible, .. } = light else { continue };
        let place = Path::of("lights").key(name).key("environment");
        if *turn_deg != 0.0 && !matches!(map, EnvironmentMap::Image { .. }) {
            c.idle(&[&place.key("turn_deg")], "`turn_deg` does nothing: this map is the same all around");
        }
        if *visible && !scene.background.is_zero() {
            let background = Path::of("background");
            let message = format!("`background` does nothing: the environment `{name}` is seen in its place");
            c.idle(&[&background, &place], message);
        }
    }
}

fn collect<'a>(object: &'a Object, materials: &mut HashSet<&'a str>, definitions: &mut HashSet<&'a str>) {
    materials.extend(object.material.as_deref());
    match &object.shape {
        Shape::Mesh { parts, .. } => materials.extend(parts.iter().map(|(_, material)| material.as_str())),
        Shape::Instance { of } => drop(definitions.insert(of)),
        Shape::Scatter(scatter) => {
            definitions.extend(scatter.of.iter().map(String::as_str));
            definitions.insert(&scatter.over);
        }
        Shape::Group { objects } => objects.iter().for_each(|object| collect(object, materials, definitions)),
        _ => {}
    }
}

fn unused(c: &mut Checker, map: &str, what: &str, used: &HashSet<&str>) {
    let entries = c.root.root.entry(map).map_or(&[][..], |entry| entry.node.entries());
    let own = entries.iter().filter(|entry| entry.key_span.source == 0 && !used.contains(entry.key.as_str()));
    for entry in own.take(Report::MOST) {
        let message = format!("the {what} is not used");
        let mut diagnostic =
            c.sources.diagnostic(Severity::Warning, super::Kind::Invalid, entry.key_span, message);
        diagnostic.path = Some(Path::of(map).key(&entry.key).to_string());
        c.diagnostics.push(diagnostic);
    }
}
