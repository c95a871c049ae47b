//! Everything that is wrong with the files of a scene, in one go.
//!
//! Building stops at the first file that it cannot use. This reads all of them as building does, but
//! places nothing and makes no trees, and says where the scene names each.

use super::materials::Surfaces;
use super::obj::{self, PartName};
use crate::description::{
    EnvironmentMap, Finding, Kind, Light, NameMap, Object, Place, Scene, Severity, Shape, listed, question,
};
use std::collections::{HashMap, HashSet};
use std::fmt::Display;
use std::path::{Path, PathBuf};

/// After so many findings the rest is left out.
const MOST: usize = 1000;

/// What is wrong or doubtful with the meshes and images that a checked scene names and would use, and
/// with what it takes from them. Asset paths in it are relative to the current folder.
pub fn examine(scene: &Scene) -> Vec<Finding> {
    let scene = &*scene.simplified();
    let mut findings = Findings(Vec::new());
    let mut surfaces = Surfaces::examine(scene, &mut findings);
    for (name, light) in scene.lights.iter() {
        let Light::Environment { map: map @ EnvironmentMap::Image { .. }, .. } = light else { continue };
        let place = Place::environment_image(name);
        let known = surfaces.warnings().len();
        let read = surfaces.environment(map, 1.0, 0.0).map(drop);
        findings.image(&place, &read, &surfaces.warnings()[known..]);
    }
    let mut meshes = Meshes { scene, files: HashMap::new(), seen: HashSet::new(), findings };
    for (i, object) in scene.objects.iter().enumerate() {
        meshes.object(object, &Place::of("objects").index(i), Needs::Material);
    }
    meshes.findings.0
}

/// What was found so far, each once.
pub(super) struct Findings(Vec<Finding>);

impl Findings {
    pub fn add(&mut self, severity: Severity, kind: Kind, place: &Place, message: String) {
        let finding = Finding { severity, kind, place: place.clone(), message };
        if self.0.len() < MOST && !self.0.contains(&finding) {
            self.0.push(finding);
        }
    }

    /// How the reading of an image went; whether it can be used.
    pub fn image(&mut self, place: &Place, read: &Result<(), impl Display>, warnings: &[String]) -> bool {
        for warning in warnings {
            self.add(Severity::Warning, Kind::Invalid, place, warning.clone());
        }
        if let Err(error) = read {
            self.add(Severity::Error, Kind::Io, place, error.to_string());
        }
        read.is_ok()
    }
}

/// Whether a mesh without a material of its own still lacks one.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Needs {
    Material,
    /// A group or instance around it has one, or it only carries scattered copies.
    Nothing,
}

struct Meshes<'a> {
    scene: &'a Scene,
    /// The parts of each file that was read; none where it cannot be used.
    files: HashMap<PathBuf, Option<Vec<PartName>>>,
    /// Definitions that have been looked at.
    seen: HashSet<(&'a str, Needs)>,
    findings: Findings,
}

impl<'a> Meshes<'a> {
    fn object(&mut self, object: &'a Object, place: &Place, needs: Needs) {
        let needs = if object.material.is_some() { Needs::Nothing } else { needs };
        match &object.shape {
            Shape::Mesh { path, parts, .. } => self.mesh(path, parts, place, needs),
            Shape::Group { objects } => {
                for (i, object) in objects.iter().enumerate() {
                    self.object(object, &place.member(i), needs);
                }
            }
            Shape::Instance { of } => self.definition(of, needs),
            Shape::Scatter(scatter) => {
                scatter.of.iter().for_each(|of| self.definition(of, needs));
                // a placed object that carries is looked at where it stands
                self.definition(&scatter.over, Needs::Nothing);
            }
            _ => {}
        }
    }

    fn definition(&mut self, name: &'a str, needs: Needs) {
        if let Some(object) = self.scene.definitions.get(name)
            && self.seen.insert((name, needs))
        {
            self.object(object, &Place::of("definitions").key(name), needs);
        }
    }

    fn mesh(&mut self, path: &str, named: &NameMap<String>, place: &Place, needs: Needs) {
        let file = Path::new(path);
        let key = file.canonicalize().unwrap_or_else(|_| file.to_owned());
        let (scene, findings) = (self.scene, &mut self.findings);
        let parts = self.files.entry(key).or_insert_with(|| match obj::load_within(&scene.reach, file) {
            Ok(mesh) => {
                for warning in mesh.warnings {
                    findings.add(Severity::Warning, Kind::Invalid, &place.mesh(), warning);
                }
                Some(mesh.part_names)
            }
            Err(error) => {
                findings.add(Severity::Error, Kind::Io, &place.mesh(), error.to_string());
                None
            }
        });
        let Some(parts) = parts else { return };
        for name in named.names().filter(|name| !parts.iter().any(|part| is(part, name))) {
            let message = no_such_part(path, name, parts);
            findings.add(Severity::Error, Kind::Invalid, &place.mesh_part(name), message);
        }
        let rest: Vec<&str> = parts
            .iter()
            .filter(|part| !named.names().any(|name| is(part, name)))
            .map(|part| if part.group.is_empty() { part.material.as_str() } else { &part.group })
            .collect();
        if needs == Needs::Material && !rest.is_empty() {
            let names = rest.iter().copied().filter(|name| !name.is_empty());
            let what = match listed(names.clone()) {
                names if names.is_empty() => "faces that have no name".to_owned(),
                names => names,
            };
            let message = format!(
                "no `material` is given, here or by a group, and `parts` leaves out some of {path}: {what}"
            );
            findings.add(Severity::Error, Kind::Invalid, place, message);
        }
    }
}

/// Whether a part of a mesh file goes by this name.
fn is(part: &PartName, name: &str) -> bool {
    part.group == name || part.material == name
}

fn no_such_part(path: &str, name: &str, parts: &[PartName]) -> String {
    let all = || parts.iter().flat_map(|part| [part.group.as_str(), part.material.as_str()]);
    let known = || all().filter(|name| !name.is_empty());
    let has = if known().next().is_none() { "none".to_owned() } else { listed(known()) };
    format!("{path} has no part named `{name}`{}; it has {has}", question(name, known()))
}
