//! Reading: text → tree → `include` → `--set` → types → checks, with every mistake in one report.

mod animate;
mod de;
mod fault;
mod include;
mod recover;
mod ron;
mod set;
mod toml;

use super::check;
use super::diagnostic::{Diagnostic, Kind, Report, Severity};
use super::places::Places;
use super::source::{self, MAX_FILE_BYTES, Source, Sources};
use super::tree::{Index, Node, Span};
use super::{Animation, Reach, Scene, Terms, assets};
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The two languages of scene files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Ron,
    Toml,
}

impl Format {
    /// By the ending `.ron` or `.toml`.
    pub fn from_path(path: &Path) -> Option<Format> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        match ending.as_str() {
            "ron" => Some(Format::Ron),
            "toml" => Some(Format::Toml),
            _ => None,
        }
    }
}

/// A scene that has been read and checked.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// With everything that it includes; paths of meshes and images start from the working directory
    /// (or are absolute), and `include` is empty.
    pub scene: Scene,
    pub warnings: Vec<Diagnostic>,
    /// The scene file and those that it includes.
    pub files: Vec<PathBuf>,
    /// The folder that the scene's paths were relative to.
    pub folder: PathBuf,
    /// The meshes and images that the scene names; paths as in the scene.
    pub assets: Vec<PathBuf>,
    /// What of the scene changes with the frame; the scene itself is that of one frame and has none.
    pub animation: Option<Animation>,
    /// SHA-256 of what the scene says, whatever the format, the layout or the folder it is read from.
    pub hash: [u8; 32],
    pub(super) places: Arc<Places>,
}

/// Reads and checks a scene file, after `overrides` (`path.to.key=value`) have been applied to it.
pub fn load(path: &Path, overrides: &[String]) -> Result<Loaded, Report> {
    load_on(&Terms::default(), path, overrides)
}

/// As [`load`], on these terms.
pub fn load_on(terms: &Terms, path: &Path, overrides: &[String]) -> Result<Loaded, Report> {
    let (text, format) = open(path)?;
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    Reading::new(folder, terms).load(Some(path.to_owned()), text, format, overrides)
}

/// Reads and checks a scene that is at hand as text; its paths are relative to `folder`.
pub fn load_str(text: &str, format: Format, folder: &Path, overrides: &[String]) -> Result<Loaded, Report> {
    load_str_on(&Terms::default(), text, format, folder, overrides)
}

/// As [`load_str`], on these terms.
pub fn load_str_on(
    terms: &Terms,
    text: &str,
    format: Format,
    folder: &Path,
    overrides: &[String],
) -> Result<Loaded, Report> {
    let text = source::without_mark(text.to_owned());
    Reading::new(folder.to_owned(), terms).load(None, text, format, overrides)
}

/// The scene of a file alone, for `convert`: `include` and paths as written, values not checked.
pub fn load_as_written(path: &Path, overrides: &[String]) -> Result<Scene, Report> {
    let (text, format) = open(path)?;
    let mut reading = Reading::new(path.parent().unwrap_or(Path::new("")).to_owned(), &Terms::default());
    reading.as_written(Some(path.to_owned()), text, format, overrides)
}

/// As `load_as_written`, from text.
pub fn load_str_as_written(text: &str, format: Format, overrides: &[String]) -> Result<Scene, Report> {
    let text = source::without_mark(text.to_owned());
    Reading::new(PathBuf::new(), &Terms::default()).as_written(None, text, format, overrides)
}

/// RON as scenes are written: `Some` may be left out, and the parentheses of a struct within a variant.
pub(crate) fn convert_options() -> ::ron::Options {
    use ::ron::extensions::Extensions;
    ::ron::Options::default()
        .with_default_extension(Extensions::IMPLICIT_SOME | Extensions::UNWRAP_VARIANT_NEWTYPES)
        .with_recursion_limit(512)
}

/// The tree of RON text that was written by us.
pub(crate) fn tree_of_ron(text: &str) -> Result<Node, String> {
    ron::own(text, 0).map_err(|errors| errors[0].1.clone())
}

fn open(path: &Path) -> Result<(String, Format), Report> {
    let format = Format::from_path(path).ok_or_else(|| {
        let message = "a scene file's name ends in .ron or .toml".to_owned();
        Diagnostic::of_file(path, Kind::NotSupported, message)
    })?;
    Ok((source::read(path, &Reach::default(), MAX_FILE_BYTES)?, format))
}

struct Reading {
    folder: PathBuf,
    sources: Sources,
    diagnostics: Vec<Diagnostic>,
    /// An included file could not be read: names may be missing for that reason.
    incomplete: bool,
    terms: Terms,
}

impl Reading {
    fn new(folder: PathBuf, terms: &Terms) -> Reading {
        Reading {
            folder,
            sources: Sources::default(),
            diagnostics: Vec::new(),
            incomplete: false,
            terms: terms.clone(),
        }
    }

    fn error(&mut self, kind: Kind, span: Span, message: String) {
        self.diagnostics.push(self.sources.diagnostic(Severity::Error, kind, span, message));
    }

    /// The tree of a text, or its syntax errors.
    fn parse(&mut self, source: Source) -> Option<Node> {
        let index = self.sources.add(source);
        let Source { text, format, .. } = self.sources.get(index);
        let parsed = match format {
            Format::Ron => ron::parse(text, index),
            Format::Toml => toml::parse(text, index),
        };
        match parsed {
            Ok(node) => Some(node),
            Err(errors) => {
                for (start, message) in errors {
                    self.error(Kind::Invalid, Span { source: index, start, end: start }, message);
                }
                None
            }
        }
    }

    fn main_source(file: Option<PathBuf>, text: String, format: Format) -> Source {
        Source { file, argument: false, base: PathBuf::new(), format, text }
    }

    fn as_written(
        &mut self,
        file: Option<PathBuf>,
        text: String,
        format: Format,
        overrides: &[String],
    ) -> Result<Scene, Report> {
        let scene = self.parse(Self::main_source(file, text, format)).and_then(|mut root| {
            set::apply(self, &mut root, overrides);
            recover::read::<Scene>(&mut root, &self.sources, &mut self.diagnostics)
        });
        self.finish(scene)
    }

    fn load(
        mut self,
        file: Option<PathBuf>,
        text: String,
        format: Format,
        overrides: &[String],
    ) -> Result<Loaded, Report> {
        let (mut spans, mut animation) = (Vec::new(), None);
        let scene = self.parse(Self::main_source(file, text, format)).and_then(|mut root| {
            include::merge(&mut self, &mut root);
            set::apply(&mut self, &mut root, overrides);
            let mut scene: Scene = recover::read(&mut root, &self.sources, &mut self.diagnostics)?;
            if let Some(moving) = scene.animation.take() {
                scene = self.frame(&mut root, &moving, overrides)?;
                animation = Some(moving);
            }
            scene.include.clear();
            // a single file's paths need no change
            let included = self.sources.files().len() > 1;
            let index = Index::new(&root);
            let mut named = Vec::new();
            assets::for_each(&mut scene, &mut |path, place| {
                if included {
                    rebase(path, &self.sources.get(index.find(place).node.span.source).base);
                }
                named.push((path.clone(), place.clone()));
            });
            scene.reach = self.terms.reach.clone();
            let (folder, sound) = (&self.folder, self.diagnostics.is_empty());
            let found = check::check(
                &scene,
                &index,
                &self.sources,
                folder,
                (&named, self.terms.unread),
                self.incomplete,
                sound,
            );
            self.diagnostics.extend(found);
            spans = Places::find(&scene, &index);
            Some(scene)
        });
        let mut scene = self.finish(scene)?;
        let hash = hash(&scene);
        let mut assets = Vec::new();
        assets::for_each(&mut scene, &mut |path, _| {
            rebase(path, &self.folder);
            assets.push(PathBuf::from(&*path));
        });
        let warnings = Report::new(self.diagnostics).diagnostics;
        let files = self.sources.files();
        let places = Arc::new(Places::new(self.sources, spans));
        Ok(Loaded { scene, warnings, files, folder: self.folder, assets, animation, hash, places })
    }

    /// The scene of the frame that was asked for.
    fn frame(&mut self, root: &mut Node, moving: &Animation, overrides: &[String]) -> Option<Scene> {
        let frame = self.terms.frame.unwrap_or(1);
        animate::apply(self, root, moving, frame);
        animate::warn_of_overrides(self, root, moving, overrides);
        let mut scene: Scene = recover::read(root, &self.sources, &mut self.diagnostics)?;
        scene.animation = None;
        if let (Some(camera), Some(orbit)) = (&mut scene.camera, &moving.orbit) {
            animate::orbit(camera, orbit, frame, moving.frames);
        }
        Some(scene)
    }

    /// The scene if nothing is wrong with it.
    fn finish(&mut self, scene: Option<Scene>) -> Result<Scene, Report> {
        let wrong = self.diagnostics.iter().any(|d| d.severity == Severity::Error);
        match scene {
            Some(scene) if !wrong => Ok(scene),
            _ => Err(Report::new(std::mem::take(&mut self.diagnostics))),
        }
    }
}

/// A path relative to `base` made relative to what `base` is relative to.
fn rebase(path: &mut String, base: &Path) {
    if !base.as_os_str().is_empty() {
        *path = base.join(&*path).to_string_lossy().into_owned();
    }
}

fn hash(scene: &Scene) -> [u8; 32] {
    let canonical = serde_json::to_vec(scene).expect("a scene has only text keys and finite numbers");
    Sha256::digest(canonical).into()
}
