//! `study`: what accuracy costs in time, knob by knob.

use super::check::{load_and_report, set_threads};
use super::exit::{FAILED, Failure, UNREADABLE};
use super::progress::{Reporter, duration};
use super::report::{self, Terminal};
use super::study_args::StudyArgs;
use std::path::Path;
use std::time::Instant;
use terrarium::description::Loaded;
use terrarium::measure::study::{FILE, Study, StudyError, study};
use terrarium::output::atomic;

pub fn run(args: &StudyArgs, terminal: &Terminal) -> Result<(), Failure> {
    let began = Instant::now();
    set_threads(args.threads)?;
    let loaded = load_and_report(&args.scene, &args.reading, args.options().overrides.unread(), terminal)?;
    prepare(&args.output)?;
    let reporter = Reporter::new(args.progress, args.quiet, terminal);
    let scene = args.scene.display().to_string();
    let done = study(&loaded, &scene, &args.options(), &args.asked(), &args.output, &reporter);
    let done = done.map_err(|error| {
        reporter.complete();
        failure(error, &loaded, terminal)
    })?;
    reporter.complete();
    if args.json {
        report::print(&done.study.json())?;
    }
    if !args.quiet {
        say(&done.study, terminal);
        let reference = if done.rendered_reference { " and the reference" } else { "" };
        terminal.say(&format!(
            "rendered {}{reference} in {}; see {}",
            done.rendered,
            duration(began.elapsed().as_secs_f64()),
            args.output.join("index.html").display()
        ));
    }
    Ok(())
}

/// A sentence a knob.
fn say(study: &Study, terminal: &Terminal) {
    for line in &study.lines {
        let knob =
            if line.line == line.knob.key() { String::new() } else { format!("{}: ", line.knob.key()) };
        terminal.say(&format!("{knob}{}: {}", line.line, line.sentence));
    }
    if !study.complete {
        terminal.warning(
            "the time was over before all renders were made; the same call with more --time goes on",
        );
    }
}

/// Makes the folder, and sees whether files can be written there.
fn prepare(folder: &Path) -> Result<(), Failure> {
    let name = folder.display().to_string();
    std::fs::create_dir_all(folder).map_err(|error| Failure::writing(&name, error))?;
    atomic::probe(&folder.join(FILE)).map_err(|error| Failure::writing(&name, error))
}

fn failure(error: StudyError, loaded: &Loaded, terminal: &Terminal) -> Failure {
    match error {
        StudyError::Render(error) => super::render::unbuildable(error, loaded, terminal),
        StudyError::Output(path, error) => Failure::writing(&path, error),
        StudyError::Unreadable(..) => Failure::new(UNREADABLE, error.to_string()),
        StudyError::Reference(reason) => Failure::new(FAILED, reason),
    }
}
