//! The files that a scene names: meshes, textures, environment maps.

use super::tree::{Path, Step};
use super::{EnvironmentMap, Light, Object, Scene, Shape, Texture};

/// Calls `visit` with each file's path, which it may change, and the place of that path in the scene.
pub(crate) fn for_each(scene: &mut Scene, visit: &mut dyn FnMut(&mut String, &Path)) {
    for (name, texture) in scene.textures.iter_mut() {
        if let Texture::Image { path, .. } = texture {
            visit(path, &Path::of("textures").key(name).key("image").key("path"));
        }
    }
    for (name, light) in scene.lights.iter_mut() {
        if let Light::Environment { map: EnvironmentMap::Image { path, .. }, .. } = light {
            let place = Path::of("lights").key(name).key("environment").key("map").key("image").key("path");
            visit(path, &place);
        }
    }
    for (name, object) in scene.definitions.iter_mut() {
        of_object(object, &Path::of("definitions").key(name), visit);
    }
    for (i, object) in scene.objects.iter_mut().enumerate() {
        of_object(object, &Path(vec![Step::Key("objects".into()), Step::Index(i)]), visit);
    }
}

fn of_object(object: &mut Object, place: &Path, visit: &mut dyn FnMut(&mut String, &Path)) {
    match &mut object.shape {
        Shape::Mesh { path, .. } => visit(path, &place.key("shape").key("mesh").key("path")),
        Shape::Group { objects } => {
            let list = place.key("shape").key("group").key("objects");
            for (i, object) in objects.iter_mut().enumerate() {
                of_object(object, &list.index(i), visit);
            }
        }
        _ => {}
    }
}
