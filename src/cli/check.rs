//! `check`, and reading a scene for every command.

use super::args::{CheckArgs, CheckFormat, Reading};
use super::exit::{FAILED, Failure, UNREADABLE, USAGE};
use super::report::{self, Terminal};
use std::io::Read;
use std::path::Path;
use terrarium::build;
use terrarium::description::{self, Diagnostic, Loaded, Reach, Report, Terms, Unread};

/// A scene on standard input ends here; larger ones are mistakes.
const LONGEST_INPUT: u64 = 256 << 20;

/// Checks every scene and reports all mistakes; the worst exit code counts.
pub fn run(args: &CheckArgs, terminal: &Terminal) -> Result<(), Failure> {
    let mut results = Vec::new();
    let mut worst = 0;
    for scene in &args.scenes {
        let (mut diagnostics, mut code, keys) = judge(scene, &args.reading)?;
        if args.reading.frame.is_none() && code == 0 {
            // what lies between two keys is valid if they are
            for frame in keys.into_iter().skip(1).take(MOST_KEYS) {
                let (more, worse, _) = judge(scene, &Reading { frame: Some(frame), ..args.reading.clone() })?;
                let new: Vec<_> = more.into_iter().filter(|found| !diagnostics.contains(found)).collect();
                diagnostics.extend(new);
                code = code.max(worse);
            }
            diagnostics.sort_by_key(|diagnostic| diagnostic.severity);
        }
        worst = worst.max(code);
        if args.format == CheckFormat::Text {
            diagnostics.iter().for_each(|diagnostic| terminal.diagnostic(diagnostic));
            let verdict = if code == 0 { "valid" } else { "invalid" };
            terminal.say(&format!("{}: {verdict}", scene.display()));
        } else {
            results.push(serde_json::json!({
                "file": scene.display().to_string(),
                "valid": code == 0,
                "diagnostics": diagnostics,
            }));
        }
    }
    if args.format == CheckFormat::Json {
        report::print(&format!("{:#}\n", serde_json::Value::Array(results)))?;
    }
    if worst == 0 { Ok(()) } else { Err(Failure::new(worst, "")) }
}

/// So many frames of an animation with different keys are looked at.
const MOST_KEYS: usize = 64;

/// All that is said about a scene, the exit code, and the frames at which its animation has keys.
fn judge(scene: &Path, reading: &Reading) -> Result<(Vec<Diagnostic>, u8, Vec<u32>), Failure> {
    Ok(match load(scene, reading, Unread::default())? {
        Ok(loaded) => {
            let report = files(&loaded);
            let code = if report.errors().next().is_none() { 0 } else { report.exit_code() };
            let mut diagnostics = report.diagnostics;
            diagnostics.extend(loaded.warnings);
            diagnostics.sort_by_key(|diagnostic| diagnostic.severity);
            let several = scene != Path::new("-");
            let keys = loaded.animation.filter(|_| several).map(|animation| animation.key_frames());
            (diagnostics, code, keys.unwrap_or_default())
        }
        Err(report) => {
            let code = report.exit_code();
            (report.diagnostics, code, Vec::new())
        }
    })
}

/// What is wrong with the files that a sound scene names.
pub fn files(loaded: &Loaded) -> Report {
    loaded.report(build::examine(&loaded.scene))
}

/// Reads and checks a scene; `-` is standard input. Missing files of what is left `unread` are
/// warnings. The outer error is a wrong call.
pub fn load(scene: &Path, reading: &Reading, unread: Unread) -> Result<Result<Loaded, Report>, Failure> {
    let (set, from_input) = (&reading.set, scene == Path::new("-"));
    let folder = if from_input { Path::new(".") } else { scene.parent().unwrap_or(Path::new("")) };
    let reach = Reach::within(folder, &reading.allow)
        .map_err(|(folder, error)| Failure::new(USAGE, format!("--allow {}: {error}", folder.display())))?;
    let terms = Terms { unread, reach, frame: reading.frame };
    if !from_input {
        return Ok(description::load_on(&terms, scene, set));
    }
    let (text, format) = standard_input(reading)?;
    Ok(description::load_str_on(&terms, &text, format, folder, set))
}

/// The scene on standard input, and its language.
pub fn standard_input(reading: &Reading) -> Result<(String, description::Format), Failure> {
    let Some(format) = reading.scene_format else {
        return Err(Failure::new(USAGE, "a scene from standard input needs --scene-format ron or toml"));
    };
    let mut text = String::new();
    let unreadable = |reason: &str| {
        Failure::new(UNREADABLE, format!("can't read the scene from standard input: {reason}"))
    };
    let length = std::io::stdin()
        .lock()
        .take(LONGEST_INPUT + 1)
        .read_to_string(&mut text)
        .map_err(|error| unreadable(&error.to_string()))?;
    if length as u64 > LONGEST_INPUT {
        return Err(unreadable("it is longer than 256 MiB"));
    }
    Ok((text, format.into()))
}

/// Reads a scene and prints its mistakes and warnings.
pub fn load_and_report(
    scene: &Path,
    reading: &Reading,
    unread: Unread,
    terminal: &Terminal,
) -> Result<Loaded, Failure> {
    match load(scene, reading, unread)? {
        Ok(loaded) => {
            loaded.warnings.iter().for_each(|warning| terminal.diagnostic(warning));
            Ok(loaded)
        }
        Err(report) => Err(refused(&report, terminal)),
    }
}

/// Prints all that is wrong with a scene.
pub fn refused(report: &Report, terminal: &Terminal) -> Failure {
    report.diagnostics.iter().for_each(|diagnostic| terminal.diagnostic(diagnostic));
    let mut errors = report.errors();
    let first = errors.next().map_or(String::new(), |error| error.headline());
    let said = match errors.count() {
        0 => first,
        more => format!("{first}; and {more} more"),
    };
    Failure::said(report.exit_code(), said)
}

/// Every stage that uses threads uses this many, writing included.
pub fn set_threads(threads: Option<u16>) -> Result<(), Failure> {
    let Some(threads) = threads else { return Ok(()) };
    rayon::ThreadPoolBuilder::new()
        .num_threads(usize::from(threads))
        .build_global()
        .map_err(|error| Failure::new(FAILED, format!("can't start {threads} threads: {error}")))
}
