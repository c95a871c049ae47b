//! The files that a scene names must be there and readable. An image that no placed object's material
//! names, or that is left out, is not read: only a warning.

use super::{Checker, Kind, Severity};
use crate::description::suggest::nearest;
use crate::description::tree::Path;
use crate::description::{EnvironmentMap, Light, Material, Reach, Unread, used_materials};
use std::collections::{HashMap, HashSet};
use std::io::ErrorKind;
use std::path::Path as FilePath;

pub(super) fn check(c: &mut Checker, files: &[(String, Path)], unread: Unread) {
    let idle = idle_images(c, unread);
    let mut problems: HashMap<&str, Option<String>> = HashMap::new();
    for (path, place) in files {
        if path.is_empty() {
            c.error(place, "a file's path cannot be empty");
            continue;
        }
        let problem = problems.entry(path).or_insert_with(|| problem(&c.folder.join(path), &c.scene.reach));
        if let Some(message) = problem.clone() {
            let severity = if idle.contains(place) { Severity::Warning } else { Severity::Error };
            c.report(severity, Kind::Io, &[place], message, None);
        }
    }
}

/// The places of images that are not read.
fn idle_images(c: &Checker, unread: Unread) -> Vec<Path> {
    let scene = c.scene.simplified();
    let used = used_materials(&scene);
    let materials = scene.materials.iter().filter(|(name, _)| used.contains(name));
    let read: HashSet<&str> = materials.flat_map(|(_, material)| read_by(material, unread)).collect();
    let textures = c.scene.textures.names().filter(|name| !read.contains(name)).map(Path::image_texture);
    let sky = |light: &Light| matches!(light, Light::Environment { map: EnvironmentMap::Image { .. }, .. });
    let skies = scene.lights.iter().filter(|(_, light)| unread.environment || !sky(light));
    let skies = skies.map(|(name, _)| Path::environment_image(name));
    textures.chain(skies).collect()
}

/// The textures that a material needs.
fn read_by(material: &Material, unread: Unread) -> impl Iterator<Item = &str> {
    let highlight = material.specular.texture().filter(|_| unread.highlights).map(|t| t.name.as_str());
    let others = [&material.diffuse, &material.reflection, &material.transmission, &material.emission];
    let elsewhere = move |name: &str| others.iter().filter_map(|w| w.texture()).any(|t| t.name == name);
    let maps = [
        material.normal_map.as_ref().filter(|_| !unread.normal_maps).map(|map| map.texture.as_str()),
        material.bump_map.as_ref().filter(|_| !unread.bump_maps).map(|map| map.texture.as_str()),
    ];
    material
        .colours()
        .filter(move |&name| highlight != Some(name) || elsewhere(name))
        .chain(maps.into_iter().flatten())
}

/// Why a file cannot be read.
fn problem(file: &FilePath, reach: &Reach) -> Option<String> {
    let problem = reach.open(file).err()?;
    // a folder out of reach is not looked into
    let near = match problem.kind() {
        ErrorKind::NotFound => neighbour(file).map(|name| format!("; did you mean `{name}`?")),
        _ => None,
    };
    Some(format!("`{}` cannot be read: {problem}{}", file.display(), near.unwrap_or_default()))
}

/// A file of the same folder with nearly that name.
fn neighbour(file: &FilePath) -> Option<String> {
    let name = file.file_name()?.to_str()?;
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(FilePath::new("."));
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .ok()?
        .take(10_000)
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .collect();
    names.sort();
    nearest(name, names.iter().map(String::as_str).filter(|other| *other != name)).map(str::to_owned)
}
