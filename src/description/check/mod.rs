//! What the types cannot see: ranges, energy, references, files. Every violation of a scene is
//! reported, with its path and its place.

mod energy;
mod files;
mod idle;
mod instances;
mod lights;
mod materials;
mod objects;
mod open;
mod photons;
mod references;
mod settings;
mod usage;

use super::Unread;
use super::diagnostic::{Diagnostic, Kind, Report, Severity};
use super::source::Sources;
use super::tree::{Index, Path, number};
use super::{Object, Scene, Shape};
use glam::DVec3;
use std::collections::{HashMap, HashSet};
use std::path::Path as FilePath;

/// All that is wrong or doubtful with a scene whose tree is `root`; the paths of `files`, which it
/// names, are relative to `folder`; those of what is left `unread` may be missing. In an `incomplete` scene (an included file is missing) no names are looked up; only a
/// `sound` one, without mistakes so far, can give rise to doubts.
pub(super) fn check(
    scene: &Scene,
    root: &Index,
    sources: &Sources,
    folder: &FilePath,
    (files, unread): (&[(String, Path)], Unread),
    incomplete: bool,
    sound: bool,
) -> Vec<Diagnostic> {
    let mut checker = Checker {
        scene,
        root,
        sources,
        folder,
        diagnostics: Vec::new(),
        textures: scene.textures.names().collect(),
        materials: scene.materials.names().collect(),
        definitions: scene.definitions.iter().collect(),
        objects: HashMap::new(),
        comparisons: MOST_COMPARISONS,
    };
    for object in &scene.objects {
        named(object, &mut checker.objects);
    }
    settings::check(&mut checker);
    photons::check(&mut checker);
    materials::textures(&mut checker);
    materials::check(&mut checker);
    lights::check(&mut checker);
    objects::check(&mut checker);
    files::check(&mut checker, files, unread);
    if !incomplete {
        references::check(&mut checker);
        // a wrong name makes another one unused: nothing that needs saying
        if sound && !checker.diagnostics.iter().any(|d| d.severity == Severity::Error) {
            usage::check(&mut checker);
            instances::check(&mut checker);
            open::check(&mut checker);
            idle::check(&mut checker);
        }
    }
    checker.diagnostics
}

struct Checker<'a> {
    scene: &'a Scene,
    root: &'a Index<'a>,
    sources: &'a Sources,
    folder: &'a FilePath,
    diagnostics: Vec<Diagnostic>,
    textures: HashSet<&'a str>,
    materials: HashSet<&'a str>,
    definitions: HashMap<&'a str, &'a Object>,
    /// Placed objects by name, those within groups too.
    objects: HashMap<&'a str, &'a Object>,
    /// How many names may still be compared with misspelt ones.
    comparisons: usize,
}

/// A tenth of a second's worth.
const MOST_COMPARISONS: usize = 100_000;

fn named<'a>(object: &'a Object, found: &mut HashMap<&'a str, &'a Object>) {
    if let Some(name) = &object.name {
        found.entry(name).or_insert(object);
    }
    if let Shape::Group { objects } = &object.shape {
        objects.iter().for_each(|object| named(object, found));
    }
}

impl Checker<'_> {
    /// Reports at the first of the paths; silent if the value at any of them was reported before.
    fn report(
        &mut self,
        severity: Severity,
        kind: Kind,
        paths: &[&Path],
        message: String,
        help: Option<String>,
    ) {
        if self.diagnostics.len() >= Report::MOST || paths.iter().any(|path| self.root.find(path).hole) {
            return;
        }
        let Some(path) = paths.first() else { return };
        let mut diagnostic =
            self.sources.diagnostic(severity, kind, self.root.find(path).node.span, message).with_help(help);
        diagnostic.path = Some(path.to_string()).filter(|path| !path.is_empty());
        self.diagnostics.push(diagnostic);
    }

    fn error(&mut self, path: &Path, message: impl Into<String>) {
        self.report(Severity::Error, Kind::Invalid, &[path], message.into(), None);
    }

    fn error_about(&mut self, paths: &[&Path], message: impl Into<String>) {
        self.report(Severity::Error, Kind::Invalid, paths, message.into(), None);
    }

    /// A doubt about several values together.
    fn warn_about(&mut self, paths: &[&Path], message: impl Into<String>) {
        self.report(Severity::Warning, Kind::Invalid, paths, message.into(), None);
    }

    /// A doubt that these values do nothing: none where an animation gives one of them others.
    fn idle(&mut self, paths: &[&Path], message: impl Into<String>) {
        if !paths.iter().any(|path| self.moves(path)) {
            self.warn_about(paths, message);
        }
    }

    fn warn(&mut self, path: &Path, message: impl Into<String>) {
        self.report(Severity::Warning, Kind::Invalid, &[path], message.into(), None);
    }

    /// Whether an animation gives the value other values in other frames.
    fn moves(&self, path: &Path) -> bool {
        let path = path.to_string();
        let keys = self.root.root.entry("animation").and_then(|animation| animation.node.entry("keys"));
        keys.map_or(&[][..], |keys| keys.node.entries())
            .iter()
            .any(|entry| leads(&entry.key, &path) || leads(&path, &entry.key))
    }

    /// `low ≤ x ≤ high`.
    fn within(&mut self, path: &Path, x: f64, low: f64, high: f64) {
        if !(low..=high).contains(&x) {
            self.error(path, format!("{} is outside [{}, {}]", number(x), number(low), number(high)));
        }
    }

    fn positive(&mut self, path: &Path, x: f64) {
        if x.is_nan() || x <= 0.0 {
            self.error(path, format!("{} is not above 0", number(x)));
        }
    }

    fn not_negative(&mut self, path: &Path, x: f64) {
        if x.is_nan() || x < 0.0 {
            self.error(path, format!("{} is below 0", number(x)));
        }
    }

    /// Every channel at least 0.
    fn colour(&mut self, path: &Path, rgb: &super::Rgb) {
        if let Some(x) = rgb.0.iter().find(|x| **x < 0.0) {
            self.error(path, format!("{} is below 0", number(*x)));
        }
    }

    fn direction(&mut self, path: &Path, v: super::Vector) {
        if v == [0.0; 3] {
            self.error(path, "a direction cannot be (0, 0, 0)");
        } else if DVec3::from(v).try_normalize().is_none() {
            self.error(
                path,
                "a direction this long or short cannot be told: its square leaves the range of numbers",
            );
        }
    }
}

/// Whether a path leads to a place or to what it is in: its names follow each other in the place's, which may have
/// a light's or a shape's kind between, `lights.lamp.sphere.radius` for `lights.lamp.radius`.
fn leads(path: &str, place: &str) -> bool {
    let mut names = place.split('.');
    path.split('.').all(|name| names.any(|other| other == name))
}
