//! `diff`: how far one image is from another, for people, for programs, and as an exit code.

use super::diff_args::DiffArgs;
use super::diff_text;
use super::exit::{FAILED, Failure, NOT_WRITABLE, UNREADABLE, USAGE};
use super::report::{self, Terminal};
use super::target::same_file;
use serde::Serialize;
use std::path::{Path, PathBuf};
use terrarium::measure::heat::{ScreenPicture, beside, heat_map, shown};
use terrarium::measure::read::{self, FileImage};
use terrarium::measure::{CompareError, Comparison, Settings, Verdict, compare_files, pairs};
use terrarium::output::{Format, atomic};

/// Everything that `--json` prints.
#[derive(Debug, Serialize)]
struct Document<'a> {
    version: &'static str,
    image: String,
    reference: String,
    /// Whether the program ends with code 0.
    passed: bool,
    limits: &'a [Verdict],
    #[serde(flatten)]
    found: &'a Comparison,
}

pub fn run(args: &DiffArgs, terminal: &Terminal) -> Result<(), Failure> {
    if args.image == Path::new("-") && args.reference == Path::new("-") {
        return Err(Failure::new(USAGE, "only one of the two images can come from standard input"));
    }
    let outputs: Vec<&PathBuf> = args.heat.iter().chain(&args.side_by_side).collect();
    check_outputs(args, &outputs)?;
    let (image, reference) = (load(&args.image)?, load(&args.reference)?);
    let layers: Vec<String> = args.layer.clone();
    let settings = Settings { layers, exposure_ev: args.exposure, fast: args.fast };
    let found = compare_files(&image, &reference, &settings).map_err(incomparable)?;
    let limits = args.limits();
    let verdicts = limits.verdicts(&image, &reference, &settings.layers, &found).map_err(incomparable)?;
    draw(args, &image, &reference, &settings, &found)?;

    let problems = problems(args, &found, &verdicts, limits.can_fail());
    if args.json {
        let document = Document {
            version: env!("CARGO_PKG_VERSION"),
            image: args.image.display().to_string(),
            reference: args.reference.display().to_string(),
            passed: problems.is_empty(),
            limits: &verdicts,
            found: &found,
        };
        let document = serde_json::to_value(&document).expect("numbers, strings and lists of them");
        report::print(&format!("{document:#}\n"))?;
    } else if !args.quiet {
        let heading = format!("{} against {}", args.image.display(), args.reference.display());
        report::print(&diff_text::text(&heading, &found))?;
    }
    for verdict in verdicts.iter().filter(|verdict| verdict.exceeded && !verdict.fatal) {
        terminal.warning(&diff_text::exceeded(verdict));
    }
    if problems.is_empty() {
        return Ok(());
    }
    let sound = found.layers.iter().all(|layer| layer.values.non_finite.unmatched == 0);
    if !args.quiet || limits.can_fail() || !sound {
        problems.iter().for_each(|problem| terminal.error(problem));
    }
    Err(Failure::new(FAILED, ""))
}

/// What makes the images different: limits that are exceeded, or without limits any differing bit; and always
/// values that are not finite in one image only.
fn problems(args: &DiffArgs, found: &Comparison, verdicts: &[Verdict], limited: bool) -> Vec<String> {
    let mut problems: Vec<String> =
        verdicts.iter().filter(|v| v.exceeded && v.fatal).map(diff_text::exceeded).collect();
    for layer in &found.layers {
        let non_finite = &layer.values.non_finite;
        if let Some([x, y]) = non_finite.first {
            problems.push(format!(
                "{}: {} values are not finite in one image only, the first at ({x}, {y})",
                diff_text::title(&layer.name),
                non_finite.unmatched
            ));
        }
    }
    if !limited && !found.same && problems.is_empty() {
        problems.push(format!("{} and {} differ", args.image.display(), args.reference.display()));
    }
    problems
}

fn load(path: &Path) -> Result<FileImage, Failure> {
    let (name, read) = if path == Path::new("-") {
        ("the image from standard input".to_owned(), read::from_reader(std::io::stdin().lock()))
    } else {
        (path.display().to_string(), read::load(path))
    };
    read.map_err(|error| Failure::new(UNREADABLE, format!("can't read {name}: {error}")))
}

fn incomparable(error: CompareError) -> Failure {
    let code = if matches!(error, CompareError::NoLayer { .. }) { USAGE } else { FAILED };
    Failure::new(code, error.to_string())
}

fn check_outputs(args: &DiffArgs, outputs: &[&PathBuf]) -> Result<(), Failure> {
    for (i, output) in outputs.iter().enumerate() {
        let name = output.display();
        if Format::from_path(output) != Some(Format::Png) {
            return Err(Failure::new(USAGE, format!("{name}: a map's name ends in .png")));
        }
        if [&args.image, &args.reference].into_iter().any(|input| same_file(input, output)) {
            return Err(Failure::new(USAGE, format!("{name} is read and would be overwritten")));
        }
        if outputs[..i].iter().any(|other| same_file(other, output)) {
            return Err(Failure::new(USAGE, format!("{name} is given as an output twice")));
        }
        atomic::probe(output).map_err(|error| Failure::writing(&name.to_string(), error))?;
    }
    Ok(())
}

/// Writes the heat map, and the images with it, of the first layer with colours.
fn draw(
    args: &DiffArgs,
    image: &FileImage,
    reference: &FileImage,
    settings: &Settings,
    found: &Comparison,
) -> Result<(), Failure> {
    if args.heat.is_none() && args.side_by_side.is_none() {
        return Ok(());
    }
    let pairs = pairs(image, reference, &settings.layers).map_err(incomparable)?;
    let colours = pairs
        .iter()
        .zip(&found.layers)
        .find_map(|((a, r), layer)| Some((a.colour()?, r.colour()?, layer.colour.as_ref()?.exposure_ev)));
    let Some((a, r, exposure_ev)) = colours else {
        return Err(Failure::new(USAGE, "no colour layer is compared, of which a map could be drawn"));
    };
    let heat = heat_map(a, r, image.width);
    if let Some(path) = &args.side_by_side {
        let sides = [shown(a, image.width, exposure_ev), shown(r, image.width, exposure_ev), heat.clone()];
        write(path, &beside(&sides))?;
    }
    args.heat.as_ref().map_or(Ok(()), |path| write(path, &heat))
}

fn write(path: &Path, picture: &ScreenPicture) -> Result<(), Failure> {
    let name = path.display().to_string();
    let mut bytes = Vec::new();
    picture
        .write_png(&mut bytes)
        .map_err(|error| Failure::new(NOT_WRITABLE, format!("can't write {name}: {error}")))?;
    atomic::write(path, &bytes).map_err(|error| Failure::writing(&name, error))
}
