//! `render`: a scene in, images out.
//!
//! In this order: the call, the scene, whether the outputs can be written, the render, all images
//! under temporary names, the dependency file, then the images' names. Whatever fails, a file that
//! was there before stays as it was.

use super::args::RenderArgs;
use super::check::{files, load_and_report, refused, set_threads};
use super::exit::{Failure, STOPPED, USAGE};
use super::finished::finished;
use super::frames::{self, Place};
use super::machine;
use super::progress::{Reporter, duration, short};
use super::replay;
use super::report::{self, Terminal};
use super::signals::{halt, stop_on_signals};
use super::summary::{Summary, worst};
use super::target::{self, Target, png_settings, same_file, targets};
use super::viewer::Viewer;
use std::path::{Path, PathBuf};
use std::time::Instant;
use terrarium::description::{Loaded, Scene};
use terrarium::film::Film;
use terrarium::forecast::memory;
use terrarium::output::{Format, Stamp, Written, atomic, depfile};
use terrarium::plan::{MOST_PASSES, Plan, Until};
use terrarium::render::{self, Checkpoint, Options, Part, Progress, RenderError, Rendered, Shards};

pub fn run(args: &RenderArgs, terminal: &Terminal) -> Result<(), Failure> {
    if let Some(pixel) = args.replay.pixel {
        return replay::run(args, pixel, terminal);
    }
    set_threads(args.work.threads)?;
    let (progress, shown) = (args.progress, terminal.clone());
    stop_on_signals(move || {
        let failure = Failure::new(STOPPED, NOTHING_TRACED);
        machine::failed(progress, &failure, Place::default(), &shown);
        shown.error(&failure.message);
    });
    let asked = frames::asked(args)?;
    frames::each(args, &asked, terminal, |args, place| frame(args, place, terminal))
}

const NOTHING_TRACED: &str = "stopped before anything was traced: nothing further is written";

/// Renders the scene, or one frame of it.
fn frame(args: &RenderArgs, place: Place, terminal: &Terminal) -> Result<(), Failure> {
    let began = Instant::now();
    let shards = args.batch.divided()?;
    let targets = match &shards {
        Some(shards) => vec![part_target(args, shards)?],
        None => targets(args)?,
    };
    refuse_mixed_up_files(args, &targets)?;
    let stamp = args.stamp.then(stamp).transpose()?;
    let loaded =
        load_and_report(&args.scene, &args.reading, args.work.options().overrides.unread(), terminal)?;
    refuse_overwriting(&targets, &loaded.files)?;
    let plan = Plan::new(&loaded.scene, &options(args, began).request()).map_err(RenderError::from)?;
    let viewer = args.display_server.as_deref().map(|address| Viewer::new(address, &args.scene));
    let reporter = Reporter::new(args.progress, args.quiet, terminal)
        .telling_plan(!args.quiet)
        .of_frame(place)
        .shown_by(viewer.transpose()?);
    // Of several frames those that are there are left.
    let skips = (place.frame.is_some() || args.batch.resume) && !args.several.again;
    let checkpoint = args.batch.checkpoints(targets.iter().find_map(Target::path), skips)?;
    let begun = checkpoint.as_ref().is_some_and(|checkpoint| checkpoint.path.exists());
    let goes_on = place.frame.is_some() || (args.batch.resume && !begun);
    let whole = shards.is_none() && args.batch.crop.is_none();
    if goes_on && !args.several.again && whole && finished(args, &targets, &loaded, &plan) {
        already(args, terminal, &reporter);
        return Ok(());
    }
    probe(args, &targets)?;
    if !args.quiet {
        terminal.say(&announcement(args, &loaded.scene, &plan, shards.as_ref()));
    }

    tell_of_checkpoint(checkpoint.as_ref(), terminal);
    let written_down = checkpoint.as_ref().map(|checkpoint| checkpoint.path.clone());
    let options = Options { shards, checkpoint, halt: halt(), ..options(args, began) };
    let mut rendered = match render::render(&loaded, &options, &reporter) {
        Ok(rendered) => rendered,
        Err(RenderError::Already) => {
            already(args, terminal, &reporter);
            return Ok(());
        }
        Err(RenderError::Stopped) => return Err(Failure::new(STOPPED, NOTHING_TRACED)),
        Err(error) => {
            reporter.finish();
            return Err(unbuildable(error, &loaded, terminal));
        }
    };
    refuse_overwriting(&targets, &rendered.files)?;
    rendered.provenance.stamp = stamp;

    if let (true, Some((part, _)), true) = (rendered.halted, &rendered.part, options.shards.is_some()) {
        return Err(stopped(part.done, written_down.as_deref(), "no partial image is written"));
    }
    if !rendered.halted {
        reporter.start("write", targets.len() as u64, "images");
    }
    let (mut staged, mut written) = (Vec::new(), Vec::new());
    for target in &targets {
        let settings = png_settings(&loaded.scene.image);
        let (image, changed) = match (&rendered.part, target) {
            (Some((part, film)), Target::File(path, _)) if options.shards.is_some() => {
                stage_part(path, &rendered, part, film)?
            }
            _ => target.stage(&rendered.image, &rendered.provenance, settings)?,
        };
        staged.push(image);
        written.push(changed);
        reporter.advance(1);
    }
    // before the images: with them, make would take the old dependencies for current
    if !rendered.halted {
        write_depfile(args, &targets, &loaded, &rendered)?;
    }
    staged.into_iter().try_for_each(target::Staged::commit)?;
    if let (true, Some((part, _))) = (rendered.halted, &rendered.part) {
        reporter.finish();
        return Err(stopped(part.done, written_down.as_deref(), "the image is of what was there"));
    }
    if let Some(file) = &written_down {
        // There may be none.
        let _ = std::fs::remove_file(file);
    }
    reporter.show(&rendered.image);
    reporter.complete();

    rendered.warnings.iter().for_each(|warning| terminal.warning(warning));
    let written = worst(&written);
    let summary = Summary {
        part: options.shards.is_some(),
        v: machine::VERSION,
        version: env!("CARGO_PKG_VERSION"),
        frame: place.frame,
        scene: args.scene.display().to_string(),
        scene_hash: &rendered.provenance.scene_hash,
        seed: rendered.provenance.seed,
        width: rendered.image.width,
        height: rendered.image.height,
        outputs: targets.iter().map(Target::name).collect(),
        threads: rayon::current_num_threads(),
        seconds: began.elapsed().as_secs_f64(),
        peak_bytes: memory::held().map(|held| held.most),
        non_finite_values: written.non_finite,
        clamped_pixels: written.clamped_pixels,
        warnings: &rendered.warnings,
        stats: &rendered.stats,
    };
    match args.stats.as_deref() {
        Some(path) if path == Path::new("-") => report::print(&summary.json())?,
        Some(path) => write_text(path, &summary.json())?,
        None => {}
    }
    if !args.quiet {
        summary.say(terminal);
    }
    if args.verbose {
        verbose(&loaded, &rendered, terminal);
    }
    Ok(())
}

/// Where a part of a render goes.
fn part_target(args: &RenderArgs, shards: &Shards) -> Result<Target, Failure> {
    if let Some(folder) = &args.batch.out_dir {
        std::fs::create_dir_all(folder)
            .map_err(|error| Failure::writing(&folder.display().to_string(), error))?;
        return Ok(Target::File(
            folder.join(args.batch.name(&args.scene, args.reading.frame, shards)),
            Format::Exr,
        ));
    }
    match targets(args)?.as_slice() {
        [Target::File(path, Format::Exr)] => Ok(Target::File(path.clone(), Format::Exr)),
        _ => Err(Failure::new(
            USAGE,
            "a part of a render is one EXR file: `-o part.exr` or `--out-dir parts`; `terrarium merge` makes images of parts",
        )),
    }
}

fn stage_part(
    path: &Path,
    rendered: &Rendered,
    part: &Part,
    film: &Film,
) -> Result<(target::Staged, Written), Failure> {
    let name = path.display().to_string();
    let mut file = atomic::Pending::create(path).map_err(|error| Failure::writing(&name, error))?;
    render::write(&mut file, &rendered.image, &rendered.provenance, part, film)
        .map_err(|error| Failure::image(&name, error))?;
    Ok((target::Staged::File(file, path.to_path_buf()), Written::default()))
}

/// What an earlier run left is not lost without a word.
fn tell_of_checkpoint(checkpoint: Option<&Checkpoint>, terminal: &Terminal) {
    if let Some(Checkpoint { path, resume: false, .. }) = checkpoint
        && path.exists()
    {
        terminal.note(&format!("{} is of an earlier run: --resume would go on with it", path.display()));
    }
}

fn stopped(done: u32, checkpoint: Option<&Path>, written: &str) -> Failure {
    let resume = checkpoint
        .filter(|path| path.exists())
        .map_or(String::new(), |path| format!("; --resume goes on from {}", path.display()));
    Failure::new(
        STOPPED,
        format!("stopped after {done} pass{}: {written}{resume}", if done == 1 { "" } else { "es" }),
    )
}

/// Building stops at the first file that it cannot use: all that is wrong with them is told instead.
pub fn unbuildable(error: RenderError, loaded: &Loaded, terminal: &Terminal) -> Failure {
    if matches!(error, RenderError::Failed(_) | RenderError::TooLarge(_)) {
        return Failure::from(error);
    }
    let report = files(loaded);
    if report.errors().next().is_none() { Failure::from(error) } else { refused(&report, terminal) }
}

fn options(args: &RenderArgs, began: Instant) -> Options {
    Options {
        tile: args.tile,
        strict: args.strict,
        began: Some(began),
        crop: args.batch.crop,
        ..args.work.options()
    }
}

/// Nothing is left to do.
fn already(args: &RenderArgs, terminal: &Terminal, reporter: &Reporter) {
    if !args.quiet {
        let names: Vec<String> = args.output.iter().map(|path| path.display().to_string()).collect();
        let what = match args.reading.frame {
            Some(frame) => format!("frame {frame}"),
            None => args.scene.display().to_string(),
        };
        let names = if names.is_empty() { String::new() } else { format!(" {}:", names.join(", ")) };
        terminal.say(&format!(
            "{what}:{names} there already, of the same scene and settings (--again renders it)"
        ));
    }
    reporter.complete();
}

/// The first line: what is rendered, how large, until when, with how many threads.
fn announcement(args: &RenderArgs, scene: &Scene, plan: &Plan, shards: Option<&Shards>) -> String {
    let plural = |n: usize, word: &str| format!("{n} {word}{}", if n == 1 { "" } else { "s" });
    let until = until(plan);
    let frame = args.reading.frame.map_or(String::new(), |frame| format!(", frame {frame}"));
    let mut line = format!(
        "{}{frame}: {} × {} pixels, {until}, {}",
        args.scene.display(),
        scene.image.width,
        scene.image.height,
        plural(rayon::current_num_threads(), "thread")
    );
    if let Some(Shards { numbers, of }) = shards {
        line += &format!(", of which shard {} of {of}", render::shard_list(numbers));
    }
    if !plan.overrides.is_empty() {
        line += &format!(", {}", plan.overrides);
    }
    line
}

/// When the render will end.
pub fn until(plan: &Plan) -> String {
    let Until { seconds, error } = plan.until;
    let time = seconds.map(|seconds| format!("until {} are over", duration(seconds)));
    let error = error.map(|error| format!("until the error is {} %", short(100.0 * error)));
    let passes = match plan.passes {
        1 => Some("1 pass".to_owned()),
        n if n < MOST_PASSES => Some(format!("{n} passes")),
        _ => None,
    };
    let rules: Vec<String> = passes.into_iter().chain(time).chain(error).collect();
    rules.join(" or ")
}

/// Images, statistics and dependency file must be different files.
fn refuse_mixed_up_files(args: &RenderArgs, targets: &[Target]) -> Result<(), Failure> {
    let mut files: Vec<&Path> = targets.iter().filter_map(Target::path).collect();
    if args.depfile.is_some() && files.is_empty() {
        return Err(Failure::new(USAGE, "--depfile needs an image that is a file"));
    }
    let stats = args.stats.as_deref().filter(|path| *path != Path::new("-"));
    for file in [stats, args.depfile.as_deref()].into_iter().flatten() {
        if files.iter().any(|other| same_file(other, file)) || same_file(file, &args.scene) {
            return Err(Failure::new(USAGE, format!("{} is named for two purposes", file.display())));
        }
        files.push(file);
    }
    Ok(())
}

/// An image never replaces a file that it was made from.
fn refuse_overwriting(targets: &[Target], inputs: &[PathBuf]) -> Result<(), Failure> {
    let outputs = targets.iter().filter_map(Target::path);
    for output in outputs {
        if inputs.iter().any(|input| same_file(input, output)) {
            let name = output.display();
            return Err(Failure::new(USAGE, format!("{name} is read by the scene and can't be an output")));
        }
    }
    Ok(())
}

/// Whether everything can be written, before the first ray.
fn probe(args: &RenderArgs, targets: &[Target]) -> Result<(), Failure> {
    let side = [args.stats.as_deref(), args.depfile.as_deref()].into_iter().flatten();
    let side = side.filter(|path| *path != Path::new("-"));
    for path in targets.iter().filter_map(Target::path).chain(side) {
        atomic::probe(path).map_err(|error| Failure::writing(&path.display().to_string(), error))?;
    }
    Ok(())
}

fn write_depfile(
    args: &RenderArgs,
    targets: &[Target],
    loaded: &Loaded,
    rendered: &Rendered,
) -> Result<(), Failure> {
    let Some(path) = &args.depfile else { return Ok(()) };
    let images: Vec<&Path> = targets.iter().filter_map(Target::path).collect();
    let files: Vec<&Path> = loaded.files.iter().chain(&rendered.files).map(PathBuf::as_path).collect();
    let rules = depfile::rules(&images, &files)
        .map_err(|error| Failure::new(USAGE, format!("--depfile: {error}")))?;
    write_text(path, &rules)
}

fn write_text(path: &Path, text: &str) -> Result<(), Failure> {
    atomic::write(path, text.as_bytes()).map_err(|error| Failure::writing(&path.display().to_string(), error))
}

/// Now and here; with `SOURCE_DATE_EPOCH`, then and nowhere.
fn stamp() -> Result<Stamp, Failure> {
    if let Some(epoch) = std::env::var_os("SOURCE_DATE_EPOCH") {
        let unix_time = epoch.to_str().and_then(|text| text.parse().ok()).ok_or_else(|| {
            Failure::new(USAGE, "SOURCE_DATE_EPOCH is not a whole number of seconds since 1970")
        })?;
        return Ok(Stamp { unix_time, host: None });
    }
    let since_1970 = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    let host = std::fs::read_to_string("/proc/sys/kernel/hostname").ok().map(|name| name.trim().to_string());
    Ok(Stamp { unix_time: since_1970.map_or(0, |time| time.as_secs()), host })
}

fn verbose(loaded: &Loaded, rendered: &Rendered, terminal: &Terminal) {
    terminal.say(rendered.survey.text().trim_end());
    for file in loaded.files.iter().chain(&rendered.files) {
        terminal.say(&format!("read {}", file.display()));
    }
}
