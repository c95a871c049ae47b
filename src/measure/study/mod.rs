//! What accuracy costs in time, for one scene: renders over a ladder of passes and over single knobs, each
//! with several seeds, measured against a reference.
//!
//! [`study`] goes on where an earlier study of the same scene by the same program was broken off, renders
//! what is missing, and writes everything that people and programs read of it into a folder.

mod budget;
mod change;
mod fit;
mod knob;
mod ladder;
mod lines;
mod page;
pub mod plot;
mod record;
mod reference;
mod rungs;
mod sphere_mesh;
mod table;
mod theory;

pub use change::Change;
pub use fit::{pareto, reaches, slope, spread};
pub use knob::Knob;
pub use record::{Asked, FILE, Honest, LeftOut, Line, Reference, Run, Rung, Study, Subject, Summary};
pub use table::COLUMNS;

use crate::description::Loaded;
use crate::output::hex;
use crate::plan::{LONGEST, Plan};
use crate::render::{Options, Progress, RenderError};
use reference::Truth;
use std::io;
use std::path::Path;
use std::time::Instant;

/// Why a study could not be made.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    #[error(transparent)]
    Render(#[from] RenderError),
    /// A file cannot be written.
    #[error("can't write {0}: {1}")]
    Output(String, io::Error),
    /// The given reference cannot be read.
    #[error("can't read {0}: {1}")]
    Unreadable(String, String),
    /// Nothing can be measured against this reference.
    #[error("{0}")]
    Reference(String),
}

/// What a call did.
#[derive(Debug)]
pub struct Done {
    pub study: Study,
    /// Renders that this call made, the reference not counted.
    pub rendered: usize,
    /// Whether this call rendered the reference.
    pub rendered_reference: bool,
}

/// The share of the time that the reference is given.
const REFERENCE_TIME: f64 = 0.5;

/// The share of the rest that the rungs are designed for: forecasts may be off.
const RUNGS_TIME: f64 = 0.85;

/// Makes the study, or what is missing of it, in an existing folder.
///
/// Of `options` effects, seed and threads count. `scene` is what the scene is called.
///
/// # Errors
/// The scene cannot be rendered, a file not be written, or the reference not be used.
pub fn study(
    loaded: &Loaded,
    scene: &str,
    options: &Options,
    asked: &Asked,
    folder: &Path,
    progress: &dyn Progress,
) -> Result<Done, StudyError> {
    let began = Instant::now();
    let plan = Plan::new(&loaded.scene, &options.request()).map_err(RenderError::from)?;
    let subject = subject(loaded, &plan, options);
    let earlier = Study::read(folder).filter(|s| s.subject == subject && reference::unchanged(&s.files));
    let left = || asked.seconds - began.elapsed().as_secs_f64();

    let (image, reference, rendered_reference, files) =
        match known_reference(asked, earlier.as_ref(), folder)? {
            Some((image, reference)) => (image, reference, false, Vec::new()),
            None => {
                progress.note("reference: rendered first, by half of the time");
                let best = budget::top(&loaded.scene, asked.ladder);
                let made =
                    reference::rendered(loaded, options, best, REFERENCE_TIME * asked.seconds, progress)?;
                put(&folder.join(reference::FILE), &made.file)?;
                (made.image, made.reference, true, made.files)
            }
        };
    let truth = Truth::new(image, subject.width, subject.height)?;
    let earlier = earlier.filter(|study| study.reference.sha256 == reference.sha256);
    progress.note(&said(&reference));

    let mut study = match earlier.as_ref().filter(|study| study.asked == *asked) {
        Some(study) => study.clone(),
        None => {
            let seconds = RUNGS_TIME * left();
            let worst_passes = reference.ladder_passes.unwrap_or(f64::INFINITY);
            let design = budget::design(loaded, &plan, options, asked, worst_passes, seconds, progress)?;
            design.notes.iter().for_each(|note| progress.note(note));
            Study {
                version: env!("CARGO_PKG_VERSION").to_owned(),
                scene: scene.to_owned(),
                asked: asked.clone(),
                threads: subject.threads,
                subject,
                reference,
                files: reference::hashes(&files),
                rungs: design.rungs,
                left_out: design.left_out,
                notes: design.notes,
                lines: Vec::new(),
                honest: Honest::default(),
                complete: false,
            }
        }
    };
    if let Some(earlier) = &earlier {
        if study.files.is_empty() {
            study.files.clone_from(&earlier.files);
        }
        take_over(&mut study, earlier, folder);
    }
    for left_out in &study.left_out {
        progress.note(&format!("{}: left out: {}", left_out.knob.key(), left_out.reason));
    }
    let deadline = began + std::time::Duration::from_secs_f64(asked.seconds.min(LONGEST));
    let rendered = rungs::render(&mut study, loaded, options, &truth, folder, deadline, progress)?;
    lines::conclude(&mut study, &plan);
    write_all(&study, &truth, loaded, folder)?;
    Ok(Done { study, rendered, rendered_reference })
}

fn subject(loaded: &Loaded, plan: &Plan, options: &Options) -> Subject {
    let image = &loaded.scene.image;
    Subject {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        program: std::env::current_exe().ok().and_then(|file| reference::hash_of(&file)),
        threads: options.threads.unwrap_or_else(rayon::current_num_threads),
        scene_hash: hex(&loaded.hash),
        effects: if plan.overrides.is_empty() { String::new() } else { plan.overrides.to_string() },
        seed: plan.seed,
        width: image.width as usize,
        height: image.height as usize,
    }
}

type Known = Option<(super::read::FileImage, Reference)>;

/// The given reference, or that of an earlier study.
fn known_reference(asked: &Asked, earlier: Option<&Study>, folder: &Path) -> Result<Known, StudyError> {
    if let Some(file) = &asked.reference {
        return reference::given(Path::new(file)).map(Some);
    }
    let earlier = earlier.map(|study| &study.reference).filter(|reference| !reference.given);
    Ok(earlier.and_then(|known| Some((reference::earlier(folder, known)?, known.clone()))))
}

/// Runs of the same settings, where their pictures are still there.
fn take_over(study: &mut Study, earlier: &Study, folder: &Path) {
    for rung in &mut study.rungs {
        let like = earlier.rungs.iter().find(|other| other.name == rung.name && other.is_like(rung));
        let drawn = [rung.picture(), rung.error_map()].iter().all(|file| folder.join(file).is_file());
        rung.runs = like.filter(|_| drawn).map_or_else(Vec::new, |other| other.runs.clone());
        rung.runs.truncate(study.asked.seeds as usize);
    }
    study.complete = false;
}

/// A sentence on what is taken for the truth.
pub fn said(reference: &Reference) -> String {
    let Reference { given, file, seed, passes, error, .. } = reference;
    if *given {
        return format!("reference: {file}, as given; its own error is not known here");
    }
    let error = error.map_or("unknown".to_owned(), |e| format!("{} %", table::figures(100.0 * e)));
    format!(
        "reference: rendered by this program ({} passes, seed {}), its own stated error is {error}; what the \
         program always gets wrong shows in no error here",
        passes.unwrap_or_default(),
        seed.unwrap_or_default()
    )
}

/// Everything but the pictures of the rungs, which are there already.
fn write_all(study: &Study, truth: &Truth, loaded: &Loaded, folder: &Path) -> Result<(), StudyError> {
    put(&folder.join("study.csv"), table::csv(study).as_bytes())?;
    let chart = plot::chart(study);
    put(&folder.join("plot.svg"), plot::svg(&chart).as_bytes())?;
    put(&folder.join("plot.png"), &rungs::png(&plot::raster(&chart))?)?;
    rungs::draw_reference(truth, study, loaded, folder)?;
    put(&folder.join("index.html"), page::html(study, &chart, folder).as_bytes())?;
    study.write(folder).map_err(|error| StudyError::Output(place(folder, FILE), error))
}

fn place(folder: &Path, name: &str) -> String {
    folder.join(name).display().to_string()
}

fn put(path: &Path, bytes: &[u8]) -> Result<(), StudyError> {
    crate::output::atomic::write(path, bytes)
        .map_err(|error| StudyError::Output(path.display().to_string(), error))
}
