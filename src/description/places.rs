//! Where in its files a loaded scene names what only `build` can judge: meshes, images, and what is
//! made of them. Kept so that mistakes found there get the same messages as all others.

use super::diagnostic::{Diagnostic, Finding, Report};
use super::read::Loaded;
use super::source::Sources;
use super::tree::{Index, Path, Span};
use super::{EnvironmentMap, Light, Material, Object, Scene, Shape, Source, Texture};

#[derive(Debug)]
pub(crate) struct Places {
    sources: Sources,
    spans: Vec<(Path, Span)>,
}

impl Places {
    /// The spans of the scene's places, whose tree is `root`.
    pub fn find(scene: &Scene, root: &Index) -> Vec<(Path, Span)> {
        let span = |place: &Path| root.find(place).node.span;
        all(scene).into_iter().map(|place| (place.clone(), span(&place))).collect()
    }

    pub fn new(sources: Sources, spans: Vec<(Path, Span)>) -> Places {
        Places { sources, spans }
    }
}

impl Loaded {
    /// Findings about this scene as its own mistakes are reported: with file, line and column.
    pub fn report(&self, findings: Vec<Finding>) -> Report {
        Report::new(findings.into_iter().map(|finding| self.diagnostic(finding)).collect())
    }

    fn diagnostic(&self, finding: Finding) -> Diagnostic {
        let Finding { severity, kind, place, message } = finding;
        let Places { sources, spans } = &*self.places;
        let mut diagnostic = match spans.iter().find(|(known, _)| *known == place) {
            Some((_, span)) => sources.diagnostic(severity, kind, *span, message),
            None => Diagnostic { severity, ..Diagnostic::plain(kind, message) },
        };
        diagnostic.path = Some(place.to_string());
        diagnostic
    }
}

fn all(scene: &Scene) -> Vec<Path> {
    let mut found = Vec::new();
    for (name, texture) in scene.textures.iter() {
        if let Texture::Image { .. } = texture {
            found.push(Path::image_texture(name));
        }
    }
    for (name, light) in scene.lights.iter() {
        if let Light::Environment { map: EnvironmentMap::Image { .. }, .. } = light {
            found.push(Path::environment_image(name));
        }
    }
    let textured = scene.materials.iter().filter(|(_, material)| textured(material));
    found.extend(textured.map(|(name, _)| Path::of("materials").key(name)));
    for (name, object) in scene.definitions.iter() {
        of_object(object, &Path::of("definitions").key(name), &mut found);
    }
    for (i, object) in scene.objects.iter().enumerate() {
        of_object(object, &Path::of("objects").index(i), &mut found);
    }
    found
}

fn textured(material: &Material) -> bool {
    let weights = [&material.diffuse, &material.specular, &material.reflection, &material.transmission];
    weights.iter().any(|source| matches!(source, Source::Texture(_)))
}

fn of_object(object: &Object, place: &Path, found: &mut Vec<Path>) {
    match &object.shape {
        Shape::Mesh { parts, .. } => {
            found.extend([place.clone(), place.mesh()]);
            found.extend(parts.names().map(|part| place.mesh_part(part)));
        }
        Shape::Group { objects } => {
            for (i, object) in objects.iter().enumerate() {
                of_object(object, &place.member(i), found);
            }
        }
        _ => {}
    }
}
