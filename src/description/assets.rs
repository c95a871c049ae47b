//! The files that a scene names: meshes, textures, environment maps.

use super::tree::Path;
use super::{EnvironmentMap, Light, Object, Scene, Shape, Texture};

impl Scene {
    /// Whether it names files that are read with it.
    pub fn names_files(&self) -> bool {
        let mut any = !self.include.is_empty();
        for_each(&mut self.clone(), &mut |_, _| any = true);
        any
    }
}

/// Calls `visit` with each file's path, which it may change, and the place of that path in the scene.
pub(crate) fn for_each(scene: &mut Scene, visit: &mut dyn FnMut(&mut String, &Path)) {
    for (name, texture) in scene.textures.iter_mut() {
        if let Texture::Image { path, .. } = texture {
            visit(path, &Path::image_texture(name));
        }
    }
    for (name, light) in scene.lights.iter_mut() {
        if let Light::Environment { map: EnvironmentMap::Image { path, .. }, .. } = light {
            visit(path, &Path::environment_image(name));
        }
    }
    for (name, object) in scene.definitions.iter_mut() {
        of_object(object, &Path::of("definitions").key(name), visit);
    }
    for (i, object) in scene.objects.iter_mut().enumerate() {
        of_object(object, &Path::of("objects").index(i), visit);
    }
}

fn of_object(object: &mut Object, place: &Path, visit: &mut dyn FnMut(&mut String, &Path)) {
    match &mut object.shape {
        Shape::Mesh { path, .. } => visit(path, &place.mesh()),
        Shape::Group { objects } => {
            for (i, object) in objects.iter_mut().enumerate() {
                of_object(object, &place.member(i), visit);
            }
        }
        _ => {}
    }
}
