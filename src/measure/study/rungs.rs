//! Rendering the rungs: seed by seed, so that whatever else the machine does falls on all of them alike, and
//! cheap ones first.

use super::record::{Run, Rung, Study, Summary};
use super::reference::{BETTER, Truth, hashes};
use super::{Change, StudyError, place, put, sphere_mesh, spread, table};
use crate::description::Loaded;
use crate::forecast::memory;
use crate::measure::heat::{ScreenPicture, heat_map, shown};
use crate::measure::read::FileImage;
use crate::measure::relative::relative;
use crate::output::exr;
use crate::render::{self, Options, Progress, Silent};
use std::io::Cursor;
use std::path::Path;
use std::time::Instant;

/// Rungs that are rendered once whatever the time says: fewer show nothing.
const ALWAYS: usize = 3;

/// Parts that a study's progress is told in.
const PARTS: f64 = 1000.0;

/// Renders what is missing, and keeps `study.json` up to date. Returns how many renders that were.
pub fn render(
    study: &mut Study,
    loaded: &Loaded,
    options: &Options,
    truth: &Truth,
    folder: &Path,
    deadline: Instant,
    progress: &dyn Progress,
) -> Result<usize, StudyError> {
    for name in ["pictures", "errors"] {
        let made = std::fs::create_dir_all(folder.join(name));
        made.map_err(|error| StudyError::Output(place(folder, name), error))?;
    }
    write_meshes(study, loaded, folder)?;
    let mut order: Vec<usize> = (0..study.rungs.len()).collect();
    order.sort_by(|a, b| study.rungs[*a].predicted_seconds.total_cmp(&study.rungs[*b].predicted_seconds));
    let seeds = study.asked.seeds;
    let missing = |study: &Study| -> f64 {
        let of =
            |rung: &Rung| f64::from(seeds.saturating_sub(rung.runs.len() as u32)) * rung.predicted_seconds;
        study.rungs.iter().map(of).sum()
    };
    let whole = missing(study).max(f64::MIN_POSITIVE);
    let mut told = 0.0;
    let mut rendered = 0;
    progress.start("study", PARTS as u64, "‰");
    for round in 0..seeds {
        for (place_in_order, &at) in order.iter().enumerate() {
            let rung = &study.rungs[at];
            if rung.runs.len() > round as usize {
                continue;
            }
            // The same setting may stand on several lines: it is rendered once.
            let twin = |other: &&Rung| {
                other.name != rung.name && other.is_like(rung) && other.runs.len() > round as usize
            };
            if let Some(twin) = study.rungs.iter().find(twin).cloned() {
                copy_pictures(&twin, &study.rungs[at], folder)?;
                study.rungs[at].runs.push(twin.runs[round as usize]);
                continue;
            }
            let expected = rung.result.map_or(rung.predicted_seconds, |result| result.seconds[0]);
            let late = Instant::now() + std::time::Duration::from_secs_f64(expected) > deadline;
            let needed = round == 0 && place_in_order < ALWAYS;
            if late && !needed {
                continue;
            }
            let (run, image) = one(study, at, round, loaded, options, truth, folder)?;
            rendered += 1;
            if round == 0 {
                draw(&study.rungs[at], &image, truth, loaded, folder)?;
                if study.files.is_empty() {
                    study.files = hashes(&image.1);
                }
            }
            study.rungs[at].runs.push(run);
            progress.note(&line(&study.rungs[at], &run));
            sum_up(study);
            let error = |error| StudyError::Output(place(folder, super::FILE), error);
            study.write(folder).map_err(error)?;
            let done = (PARTS * (1.0 - missing(study) / whole)).floor().max(told);
            progress.advance((done - told) as u64);
            told = done;
        }
    }
    progress.finish();
    sum_up(study);
    Ok(rendered)
}

/// A rendered picture, and the files that were read for it.
type Picture = (FileImage, Vec<std::path::PathBuf>);

fn one(
    study: &Study,
    at: usize,
    round: u32,
    loaded: &Loaded,
    options: &Options,
    truth: &Truth,
    folder: &Path,
) -> Result<(Run, Picture), StudyError> {
    let rung = &study.rungs[at];
    let seed = study.subject.seed.wrapping_add(u64::from(round));
    let mut changed = loaded.clone();
    if let Some(change) = rung.change {
        change.apply(&mut changed.scene, &folder.join(MESHES));
    }
    // These end renders before their passes are done.
    changed.scene.render.time_s = None;
    changed.scene.render.error = None;
    let options = Options { passes: Some(0..rung.passes), seed: Some(seed), ..options.clone() };
    memory::forget_most();
    let began = Instant::now();
    let done = render::render(&changed, &options, &Silent)?;
    let mut file = Cursor::new(Vec::new());
    exr::write(&mut file, &done.image, &done.provenance)
        .map_err(|error| StudyError::Reference(format!("{}: {error}", rung.name)))?;
    let seconds = began.elapsed().as_secs_f64();
    let peak_bytes = memory::held().map(|held| held.most);
    let image = FileImage::from(&done.image);
    let picture = image.layers.iter().find_map(|layer| layer.colour()).zip(truth.planes());
    let (picture, planes) = picture.expect("a render has a picture, and the truth was found to have one");
    let found = relative(picture, planes);
    let accuracy = done.stats.accuracy.as_ref();
    let run = Run {
        seed,
        seconds,
        error: found.relative_rms,
        rel_mse: found.rel_mse,
        stated: accuracy.map(|accuracy| accuracy.error),
        interval: accuracy.map(|accuracy| accuracy.interval),
        stated_bias: accuracy.map(|accuracy| accuracy.bias),
        camera_rays: done.stats.rays.camera,
        peak_bytes,
    };
    Ok((run, (image, done.files)))
}

/// Where meshes that stand for spheres are.
const MESHES: &str = "meshes";

fn write_meshes(study: &Study, loaded: &Loaded, folder: &Path) -> Result<(), StudyError> {
    for rung in &study.rungs {
        let Some(Change::Mesh(segments)) = rung.change else { continue };
        let meshes = folder.join(MESHES);
        let made = std::fs::create_dir_all(&meshes);
        made.map_err(|error| StudyError::Output(place(folder, MESHES), error))?;
        for (path, text) in sphere_mesh::files(&loaded.scene, segments, &meshes) {
            if std::fs::read(&path).ok().as_deref() != Some(text.as_bytes()) {
                put(&path, text.as_bytes())?;
            }
        }
    }
    Ok(())
}

fn draw(
    rung: &Rung,
    image: &Picture,
    truth: &Truth,
    loaded: &Loaded,
    folder: &Path,
) -> Result<(), StudyError> {
    let colours = image.0.layers.iter().find_map(|layer| layer.colour()).zip(truth.planes());
    let Some((picture, planes)) = colours else { return Ok(()) };
    let exposure = loaded.scene.image.exposure_ev;
    put(&folder.join(rung.picture()), &png(&shown(picture, image.0.width, exposure))?)?;
    put(&folder.join(rung.error_map()), &png(&heat_map(picture, planes, image.0.width))?)
}

/// The pictures of another rung with the same setting.
fn copy_pictures(from: &Rung, to: &Rung, folder: &Path) -> Result<(), StudyError> {
    for [from, to] in [[from.picture(), to.picture()], [from.error_map(), to.error_map()]] {
        let bytes = std::fs::read(folder.join(&from));
        put(&folder.join(&to), &bytes.map_err(|error| StudyError::Output(place(folder, &from), error))?)?;
    }
    Ok(())
}

/// The reference as the rungs are shown.
pub fn draw_reference(
    truth: &Truth,
    study: &Study,
    loaded: &Loaded,
    folder: &Path,
) -> Result<(), StudyError> {
    let file = folder.join("pictures/reference.png");
    let Some(planes) = truth.planes() else { return Ok(()) };
    put(&file, &png(&shown(planes, study.subject.width, loaded.scene.image.exposure_ev))?)
}

/// The bytes of a PNG file.
pub fn png(picture: &ScreenPicture) -> Result<Vec<u8>, StudyError> {
    let mut bytes = Vec::new();
    let written = picture.write_png(&mut bytes);
    written.map_err(|error| StudyError::Reference(format!("a picture can't be written: {error}")))?;
    Ok(bytes)
}

/// What is told of a render.
fn line(rung: &Rung, run: &Run) -> String {
    let stated = run.stated.map_or("unknown".to_owned(), |e| format!("{} %", table::figures(100.0 * e)));
    format!(
        "{}: error {} % (stated: {stated}) in {} s",
        rung.title(),
        table::figures(100.0 * run.error),
        table::figures(run.seconds)
    )
}

/// Medians and ranges of all rungs, and which of them nothing beats.
fn sum_up(study: &mut Study) {
    let reference = study.reference.error.unwrap_or(0.0);
    for rung in &mut study.rungs {
        let runs = &rung.runs;
        let of = |value: &dyn Fn(&Run) -> Option<f64>| spread(runs.iter().filter_map(value));
        let end = |i: usize| of(&|run| Some(run.interval?[i])).map(|[median, ..]| median);
        rung.result = of(&|run| Some(run.seconds))
            .zip(of(&|run| Some(run.error)))
            .zip(of(&|run| Some(run.rel_mse)))
            .map(|((seconds, error), rel_mse)| Summary {
                seconds,
                error,
                rel_mse,
                stated: of(&|run| run.stated),
                interval: end(0).zip(end(1)).map(|(low, high)| [low, high]),
                peak_bytes: runs.iter().filter_map(|run| run.peak_bytes).max(),
                camera_rays: runs.first().map_or(0, |run| run.camera_rays),
                pareto: false,
                near_reference: BETTER * error[0] < reference,
            });
    }
    let mut results: Vec<&mut Summary> = study.rungs.iter_mut().filter_map(|r| r.result.as_mut()).collect();
    let points: Vec<[f64; 2]> = results.iter().map(|r| [r.seconds[0], r.error[0]]).collect();
    for (result, front) in results.iter_mut().zip(super::pareto(&points)) {
        result.pareto = front;
    }
}
