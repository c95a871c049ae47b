//! Names must lead somewhere: textures, materials, definitions, surfaces to scatter over; no
//! definition may contain itself; every visible surface needs a material.

use super::objects::list;
use super::{Checker, Kind, Severity};
use crate::description::suggest::{listed, nearest, question};
use crate::description::tree::Path;
use crate::description::{Object, Shape, Source};
use std::collections::HashSet;

pub(super) fn check(c: &mut Checker) {
    for (name, material) in c.scene.materials.iter() {
        let path = Path::of("materials").key(name);
        let sources = [
            ("diffuse", &material.diffuse),
            ("specular", &material.specular),
            ("reflection", &material.reflection),
            ("transmission", &material.transmission),
            ("emission", &material.emission),
        ];
        for (key, source) in sources {
            if let Source::Texture(texture) = source {
                let plain = path.key(key).key("texture");
                let full = plain.key("name");
                let place = if c.root.find(&full).whole { full } else { plain };
                texture_exists(c, &place, &texture.name);
            }
        }
        if let Some(map) = &material.normal_map {
            texture_exists(c, &path.key("normal_map").key("texture"), &map.texture);
        }
        if let Some(map) = &material.bump_map {
            texture_exists(c, &path.key("bump_map").key("texture"), &map.texture);
        }
    }
    for (name, object) in c.scene.definitions.iter() {
        names_of(c, &Path::of("definitions").key(name), object);
    }
    for (i, object) in c.scene.objects.iter().enumerate() {
        names_of(c, &list().index(i), object);
    }
    let cycles = cycles(c);
    if !cycles {
        let mut seen = HashSet::new();
        for (i, object) in c.scene.objects.iter().enumerate() {
            has_material(c, &list().index(i), object, false, &mut seen);
        }
    }
}

fn missing<'a>(c: &mut Checker, place: &Path, what: &str, name: &str, known: impl Iterator<Item = &'a str>) {
    let known: Vec<&str> = known.collect();
    let compared = known.len() <= c.comparisons;
    let near = if compared { nearest(name, known.iter().copied()) } else { None };
    c.comparisons = c.comparisons.saturating_sub(known.len());
    let help = match near {
        None if known.is_empty() => Some(format!("the scene has no {what}s")),
        None => Some(format!("known: {}", listed(known.iter().copied()))),
        Some(_) => None,
    };
    let message = format!("no {what} `{name}`{}", question(name, near));
    c.report(Severity::Error, Kind::Invalid, &[place], message, help);
}

fn texture_exists(c: &mut Checker, place: &Path, name: &str) {
    let scene = c.scene;
    if !c.textures.contains(name) {
        missing(c, place, "texture", name, scene.textures.names());
    }
}

fn material_exists(c: &mut Checker, place: &Path, name: &str) {
    let scene = c.scene;
    if !c.materials.contains(name) {
        missing(c, place, "material", name, scene.materials.names());
    }
}

fn definition_exists(c: &mut Checker, place: &Path, name: &str) {
    let scene = c.scene;
    if !c.definitions.contains_key(name) {
        missing(c, place, "definition", name, scene.definitions.names());
    }
}

fn names_of(c: &mut Checker, path: &Path, object: &Object) {
    if let Some(material) = &object.material {
        material_exists(c, &path.key("material"), material);
    }
    let shape = path.key("shape");
    match &object.shape {
        Shape::Mesh { parts, .. } => {
            for (part, material) in parts.iter() {
                let place = shape.key("mesh").key("parts").key(part);
                material_exists(c, &place, material);
            }
        }
        Shape::Instance { of } => {
            definition_exists(c, &shape.key("instance").key("of"), of);
        }
        Shape::Scatter(scatter) => {
            let path = shape.key("scatter");
            for (i, of) in scatter.of.iter().enumerate() {
                definition_exists(c, &path.key("of").index(i), of);
            }
            surface(c, &path.key("over"), &scatter.over);
        }
        Shape::Group { objects } => {
            for (i, object) in objects.iter().enumerate() {
                names_of(c, &shape.key("group").key("objects").index(i), object);
            }
        }
        _ => {}
    }
}

fn surface(c: &mut Checker, place: &Path, over: &str) {
    let scene = c.scene;
    let object = c.objects.get(over).copied();
    let definition = c.definitions.get(over).copied();
    match (object, definition) {
        (Some(_), Some(_)) => {
            c.error(
                place,
                format!("`{over}` is the name of an object and of a definition: which one is not clear"),
            );
        }
        (Some(one), None) | (None, Some(one)) => {
            if matches!(one.shape, Shape::Scatter(_)) {
                c.error(place, format!("`{over}` is itself a scatter, not a surface"));
            }
        }
        (None, None) => {
            let mut objects: Vec<&str> = c.objects.keys().copied().collect();
            objects.sort_unstable();
            let known = objects.into_iter().chain(scene.definitions.names());
            missing(c, place, "object or definition", over, known);
        }
    }
}

/// What an object is made of, by name: definitions and, for `over`, objects.
fn uses<'a>(object: &'a Object, found: &mut Vec<&'a str>) {
    match &object.shape {
        Shape::Instance { of } => found.push(of),
        Shape::Scatter(scatter) => {
            found.extend(scatter.of.iter().map(String::as_str));
            found.push(&scatter.over);
        }
        Shape::Group { objects } => objects.iter().for_each(|object| uses(object, found)),
        _ => {}
    }
}

/// Objects that have a name, with their places: this one and those within it.
fn named<'a>(object: &'a Object, place: &Path, found: &mut Vec<(&'a str, &'a Object, Path)>) {
    if let Some(name) = &object.name {
        found.push((name, object, place.clone()));
    }
    if let Shape::Group { objects } = &object.shape {
        let list = place.key("shape").key("group").key("objects");
        for (i, object) in objects.iter().enumerate() {
            named(object, &list.index(i), found);
        }
    }
}

/// Reports definitions and named objects that contain themselves; whether there are any.
fn cycles(c: &mut Checker) -> bool {
    let scene = c.scene;
    let definitions = scene.definitions.iter().map(|(name, o)| (name, o, Path::of("definitions").key(name)));
    let mut nodes: Vec<(&str, &Object, Path)> = definitions.collect();
    for (i, object) in scene.objects.iter().enumerate() {
        named(object, &list().index(i), &mut nodes);
    }
    let index: std::collections::HashMap<&str, usize> =
        nodes.iter().enumerate().rev().map(|(i, (name, ..))| (*name, i)).collect();
    let edges: Vec<Vec<usize>> = nodes
        .iter()
        .map(|(_, object, _)| {
            let mut found = Vec::new();
            uses(object, &mut found);
            let mut seen = HashSet::new();
            found.iter().filter_map(|name| index.get(name).copied()).filter(|to| seen.insert(*to)).collect()
        })
        .collect();
    // depth-first without recursion: 0 new, 1 on the way, 2 done
    let mut state = vec![0_u8; nodes.len()];
    let mut any = false;
    for start in 0..nodes.len() {
        let mut way: Vec<(usize, usize)> = if state[start] == 0 { vec![(start, 0)] } else { Vec::new() };
        while let Some((node, next)) = way.last_mut() {
            let node = *node;
            state[node] = 1;
            let Some(&to) = edges[node].get(*next) else {
                state[node] = 2;
                way.pop();
                continue;
            };
            *next += 1;
            if state[to] == 1 {
                any = true;
                let from = way.iter().position(|(n, _)| *n == to).unwrap_or(0);
                let chain: Vec<&str> =
                    way[from..].iter().map(|(n, _)| nodes[*n].0).chain([nodes[to].0]).collect();
                c.error(&nodes[to].2.clone(), format!("contains itself: {}", chain.join(" → ")));
            } else if state[to] == 0 {
                way.push((to, 0));
            }
        }
    }
    any
}

/// Every leaf below `object` must get a material; definitions take that of what places them.
fn has_material<'a>(
    c: &mut Checker<'a>,
    path: &Path,
    object: &'a Object,
    inherited: bool,
    seen: &mut HashSet<(&'a str, bool)>,
) {
    let given = inherited || object.material.is_some() || c.root.find(&path.key("material")).hole;
    let mut placed = |c: &mut Checker<'a>, name: &'a str| {
        if let Some(definition) = c.definitions.get(name).copied()
            && seen.insert((name, given))
        {
            has_material(c, &Path::of("definitions").key(name), definition, given, seen);
        }
    };
    match &object.shape {
        Shape::Group { objects } => {
            for (i, object) in objects.iter().enumerate() {
                let place = path.key("shape").key("group").key("objects").index(i);
                has_material(c, &place, object, given, seen);
            }
        }
        Shape::Instance { of } => placed(c, of),
        Shape::Scatter(scatter) => scatter.of.iter().for_each(|of| placed(c, of)),
        // whether these are all the parts that there are, only the file can tell
        Shape::Mesh { parts, .. } if !parts.is_empty() => {}
        _ if !given => {
            let help =
                c.scene.materials.names().next().map(|name| format!("add `material`, such as {name:?}"));
            let message = "no `material` is given, here or by a group".to_owned();
            c.report(Severity::Error, Kind::Invalid, &[path, &path.key("shape")], message, help);
        }
        _ => {}
    }
}
