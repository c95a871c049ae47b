//! What is taken for the truth: a given file, or the scene rendered until its own stated error is a tenth of
//! that of the best rung.
//!
//! A rendered reference is made by the program that is studied: what it gets wrong always, such as facets,
//! three colours or its depth limit, shows in no error of the study. It has another seed than all rungs,
//! progressive antialiasing and photons, and stops by the same rule as `--error`. It sends out more photons a pass, so
//! that its blur is not that of the rungs, which would hide theirs.

use super::record::Reference;
use super::{Change, StudyError, ladder};
use crate::description::{Antialiasing, Loaded, Photons, Scene};
use crate::measure::read::{self, FileImage};
use crate::measure::relative::LUMINANCE;
use crate::output::{exr, hex};
use crate::plan::{FEWEST, MOST_PASSES, Plan, Until};
use crate::render::{self, Options, Progress, RenderError};
use sha2::{Digest, Sha256};
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Between the seeds of the rungs and that of the reference.
const SEED: u64 = 1 << 32;

/// The reference's error over that of the best rung, as it should be.
pub const BETTER: f64 = 0.1;

/// The same, where the time allows no more: independent errors add up by squares, so that noise four times
/// as large is found 3 % too large.
const ENOUGH: f64 = 0.25;

/// Photons of its passes over those of the rungs', and how many they become at most so. The square of the first radius
/// falls by as much, and with it the blur.
const MORE_PHOTONS: u32 = 4;
const MOST_PHOTONS: u32 = 4_000_000;

/// The file of a rendered reference.
pub const FILE: &str = "reference.exr";

/// The truth's colours.
pub struct Truth {
    pub image: FileImage,
}

impl Truth {
    /// # Errors
    /// It has no colours, is of another size, or black.
    pub fn new(image: FileImage, width: usize, height: usize) -> Result<Truth, StudyError> {
        let wrong = |what: String| Err(StudyError::Reference(what));
        if (image.width, image.height) != (width, height) {
            let [w, h] = [image.width, image.height];
            return wrong(format!("the reference has {w} × {h} pixels, the scene {width} × {height}"));
        }
        let truth = Truth { image };
        let Some(planes) = truth.planes() else {
            return wrong("the reference has no layer of colours".to_owned());
        };
        let sum = |plane: &[f32]| plane.iter().filter(|v| v.is_finite()).map(|v| f64::from(*v)).sum::<f64>();
        let luminance: f64 = planes.iter().zip(LUMINANCE).map(|(plane, weight)| weight * sum(plane)).sum();
        if luminance > 0.0 && luminance.is_finite() {
            Ok(truth)
        } else {
            wrong("the reference is black: an error relative to it means nothing".to_owned())
        }
    }

    pub fn planes(&self) -> Option<[&[f32]; 3]> {
        self.image.layers.iter().find_map(|layer| layer.colour())
    }
}

/// A given file.
pub fn given(path: &Path) -> Result<(FileImage, Reference), StudyError> {
    let name = path.display().to_string();
    let unreadable = |reason: String| StudyError::Unreadable(name.clone(), reason);
    let bytes = std::fs::read(path).map_err(|error| unreadable(error.to_string()))?;
    let image = read::decode(&bytes).map_err(|error| unreadable(error.to_string()))?;
    let sha256 = hex(&Sha256::digest(&bytes).into());
    let reference = Reference { given: true, file: name.clone(), sha256, ..Reference::default() };
    Ok((image, reference))
}

/// The file of an earlier study, where it still is what it was.
pub fn earlier(folder: &Path, reference: &Reference) -> Option<FileImage> {
    let bytes = std::fs::read(folder.join(FILE)).ok()?;
    let same = hex(&Sha256::digest(&bytes).into()) == reference.sha256;
    if same { read::decode(&bytes).ok() } else { None }
}

/// The scene as it converges to the truth.
pub fn converging(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    scene.antialiasing = Antialiasing::Progressive;
    if let Photons::Classic { count, kernel, max_radius_m, .. } = scene.photons {
        scene.photons =
            Photons::Progressive { count: Some(count), k: None, alpha: Photons::ALPHA, kernel, max_radius_m };
    }
    scene.render.error = None;
    scene.render.time_s = None;
    scene
}

/// The same with more photons a pass.
fn sharper(scene: &Scene, options: &Options) -> Result<Scene, StudyError> {
    let plan = Plan::new(scene, &options.request()).map_err(RenderError::from)?;
    let mut scene = scene.clone();
    if let Ok(budget) = ladder::budget(&plan) {
        let more = budget.count.saturating_mul(MORE_PHOTONS).min(MOST_PHOTONS);
        Change::Photons(more.max(budget.count)).apply(&mut scene, Path::new(""));
    }
    Ok(scene)
}

/// A reference with what it says of itself.
pub struct Rendered {
    pub image: FileImage,
    pub file: Vec<u8>,
    pub reference: Reference,
    /// Those that the scene reads.
    pub files: Vec<PathBuf>,
}

/// Renders the reference: to a tenth of the error that `best` passes have, or for so many seconds.
pub fn rendered(
    loaded: &Loaded,
    options: &Options,
    best: u32,
    seconds: f64,
    progress: &dyn Progress,
) -> Result<Rendered, StudyError> {
    let began = Instant::now();
    let mut scene = loaded.clone();
    scene.scene = converging(&loaded.scene);
    let seed = options.seed.unwrap_or(loaded.scene.render.seed).wrapping_add(SEED);
    let mut options = Options { seed: Some(seed), began: Some(began), ..options.clone() };

    // A few passes tell what error the best rung will have.
    let few = best.clamp(FEWEST, 2 * FEWEST);
    options.passes = Some(0..few);
    let first = render::render(&scene, &options, progress)?;
    let best_error = first.stats.accuracy.as_ref().map(|accuracy| {
        let bits = |target: f64| accuracy.passes_for(target) > f64::from(best);
        let (mut low, mut high) = (accuracy.error * 1e-6, accuracy.error * 1e3);
        for _ in 0..80 {
            let middle = (low * high).sqrt();
            if bits(middle) { low = middle } else { high = middle }
        }
        (low * high).sqrt()
    });
    let left = (seconds - began.elapsed().as_secs_f64()).max(0.1);
    options.passes = Some(0..MOST_PASSES);
    options.began = None;
    options.until = Until { seconds: Some(left), error: best_error.map(|error| BETTER * error) };
    if best_error.is_none() {
        options.passes = Some(0..100 * few);
    }
    scene.scene = sharper(&scene.scene, &options)?;
    let done = render::render(&scene, &options, progress)?;

    let mut file = Cursor::new(Vec::new());
    exr::write(&mut file, &done.image, &done.provenance)
        .map_err(|error| StudyError::Reference(format!("the reference can't be written: {error}")))?;
    let file = file.into_inner();
    let accuracy = done.stats.accuracy.as_ref();
    let reference = Reference {
        given: false,
        file: FILE.to_owned(),
        sha256: hex(&Sha256::digest(&file).into()),
        seed: Some(seed),
        passes: Some(done.stats.passes),
        seconds: Some(began.elapsed().as_secs_f64()),
        error: accuracy.map(|accuracy| accuracy.error),
        interval: accuracy.map(|accuracy| accuracy.interval),
        ladder_passes: accuracy.map(|a| a.passes_for(a.error / ENOUGH)).filter(|n| n.is_finite()),
    };
    Ok(Rendered { image: FileImage::from(&done.image), file, reference, files: done.files })
}

/// The files with their SHA-256, each once; those that can't be read are left out.
pub fn hashes(files: &[PathBuf]) -> Vec<(String, String)> {
    let mut files: Vec<&PathBuf> = files.iter().collect();
    files.sort();
    files.dedup();
    files.into_iter().filter_map(|file| Some((file.display().to_string(), hash_of(file)?))).collect()
}

/// Whether the files still are what they were.
pub fn unchanged(files: &[(String, String)]) -> bool {
    files.iter().all(|(file, hash)| hash_of(Path::new(file)).as_ref() == Some(hash))
}

pub fn hash_of(path: &Path) -> Option<String> {
    Some(hex(&Sha256::digest(std::fs::read(path).ok()?).into()))
}
