//! `plan`: what a render would do, why, and what that would take.

use super::args::PlanArgs;
use super::check::{load_and_report, set_threads};
use super::exit::{Failure, USAGE};
use super::measure;
use super::progress::{Reporter, duration, short};
use super::report::{self, Terminal};
use super::summary::{mebibytes, rays};
use serde::Serialize;
use std::path::Path;
use std::time::Instant;
use terrarium::description::Loaded;
use terrarium::measure::{Expected, expected};
use terrarium::output::hex;
use terrarium::plan::Effect;
use terrarium::render::{self, Planned};

/// Everything that `--json` prints of one scene.
#[derive(Debug, Serialize)]
struct Document<'a> {
    version: &'static str,
    scene: String,
    scene_hash: String,
    width: u32,
    height: u32,
    threads: usize,
    /// Reading the scene.
    load_seconds: f64,
    #[serde(flatten)]
    planned: &'a Planned,
    #[serde(skip_serializing_if = "Option::is_none")]
    measured: Option<&'a measure::Table>,
    #[serde(skip_serializing_if = "Option::is_none")]
    accuracy: Option<&'a Expected>,
}

/// Plans every scene, whatever is wrong with others; the worst exit code counts.
pub fn run(args: &PlanArgs, terminal: &Terminal) -> Result<(), Failure> {
    if args.scenes.iter().filter(|scene| scene.as_path() == Path::new("-")).count() > 1 {
        return Err(Failure::new(USAGE, "standard input can be read once only: name `-` once"));
    }
    set_threads(args.work.threads)?;
    let (mut documents, mut worst) = (Vec::new(), 0);
    for scene in &args.scenes {
        match plan(scene, args, terminal) {
            Ok(found) => documents.push(found),
            Err(failure) => {
                if !failure.message.is_empty() {
                    terminal.error(&format!("{}: {}", scene.display(), failure.message));
                }
                worst = worst.max(failure.code);
                documents.push(serde_json::json!({
                    "version": env!("CARGO_PKG_VERSION"),
                    "scene": scene.display().to_string(),
                    "exit_code": failure.code,
                }));
            }
        }
    }
    if args.json {
        let one = documents.len() == 1;
        let all = serde_json::Value::Array(documents);
        report::print(&format!("{:#}\n", if one { &all[0] } else { &all }))?;
    }
    if worst == 0 { Ok(()) } else { Err(Failure::new(worst, "")) }
}

/// Plans one scene and prints that, or gives back its document.
fn plan(scene: &Path, args: &PlanArgs, terminal: &Terminal) -> Result<serde_json::Value, Failure> {
    let began = Instant::now();
    let options = args.work.options();
    let loaded = load_and_report(scene, &args.reading, options.overrides.unread(), terminal)?;
    let load_seconds = began.elapsed().as_secs_f64();
    let reporter = Reporter::new(args.progress, args.quiet, terminal);
    let planned = render::plan(&loaded, &options, &reporter);
    let planned = planned.map_err(|error| super::render::unbuildable(error, &loaded, terminal))?;
    planned.warnings.iter().for_each(|warning| terminal.warning(warning));
    let measured =
        if args.measure { Some(measure::table(&loaded, &options, &planned, &reporter)?) } else { None };
    let accuracy = if args.accuracy { Some(expected(&loaded, &options, &planned, &reporter)?) } else { None };
    if !args.json {
        let mut text = format!("{}\n", heading(scene, &loaded, &planned));
        text += &lines(&planned);
        if let Some(table) = &measured {
            text += &table.text();
        }
        if let Some(accuracy) = &accuracy {
            text += &(super::summary::expected(accuracy).join("\n") + "\n");
        }
        report::print(&report::printable(&text))?;
        return Ok(serde_json::Value::Null);
    }
    let image = &loaded.scene.image;
    let document = Document {
        version: env!("CARGO_PKG_VERSION"),
        scene: scene.display().to_string(),
        scene_hash: hex(&loaded.hash),
        width: image.width,
        height: image.height,
        threads: rayon::current_num_threads(),
        load_seconds,
        planned: &planned,
        measured: measured.as_ref(),
        accuracy: accuracy.as_ref(),
    };
    Ok(serde_json::to_value(&document).expect("numbers, strings and maps of strings"))
}

fn heading(scene: &Path, loaded: &Loaded, planned: &Planned) -> String {
    let image = &loaded.scene.image;
    let passes = if planned.passes == 1 { "1 pass".to_owned() } else { format!("{} passes", planned.passes) };
    let until = match (planned.until.error, planned.until.seconds) {
        (Some(error), _) => format!(" or more, until the error is {} %", short(100.0 * error)),
        (None, Some(seconds)) => format!(" in {}", duration(seconds)),
        (None, None) => String::new(),
    };
    format!("{}: {} × {} pixels, {passes}{until}", scene.display(), image.width, image.height)
}

/// One line an effect, then what all of it takes.
fn lines(planned: &Planned) -> String {
    let mut text = String::new();
    for decision in &planned.survey.decisions {
        let seconds = planned.prices.of(decision.effect.key());
        let price =
            if decision.on && seconds > 0.0 { format!("; {}", duration(seconds)) } else { String::new() };
        text += &format!("  {decision}{price}\n");
        if decision.effect == Effect::Caustics {
            let dark = planned.survey.lights.iter().filter(|light| decision.on && !light.on);
            text.extend(dark.map(|light| format!("  {light}\n")));
        }
    }
    text.extend(planned.survey.notes.iter().map(|note| format!("note: {note}\n")));
    text += &format!("rays: {}\n", rays(&planned.rays));
    for (what, photons) in
        [("photons", &planned.photons.photons), ("indirect photons", &planned.photons.indirect_photons)]
    {
        if let Some(photons) = photons {
            text += &format!(
                "{what}: {} sent out a map, {} stored\n",
                short(photons.emitted as f64),
                short(photons.stored as f64)
            );
        }
    }
    text += &format!("time: {}\n", time(planned));
    if let Some(memory) = memory(planned) {
        text += &format!("memory: {memory}\n");
    }
    text
}

/// The whole, by stage.
fn time(planned: &Planned) -> String {
    let stages: Vec<String> = planned
        .stages
        .iter()
        .filter(|stage| stage.seconds >= 0.005)
        .map(|stage| format!("{} {}", stage.name, duration(stage.seconds)))
        .collect();
    let least = if planned.until.error.is_some() { "at least" } else { "about" };
    let stages = if stages.is_empty() { String::new() } else { format!(" ({})", stages.join(", ")) };
    format!("{least} {}{stages}", duration(planned.seconds))
}

fn memory(planned: &Planned) -> Option<String> {
    Some(format!("about {} at most", mebibytes(planned.peak_bytes?)))
}

/// The paragraph that a render begins with: which effects, and what they will take.
pub fn summary(planned: &Planned) -> String {
    let on: Vec<String> = planned
        .survey
        .decisions
        .iter()
        .filter(|decision| decision.on)
        .map(|decision| {
            let seconds = planned.prices.of(decision.effect.key());
            let name = decision.effect.name();
            if seconds >= 0.05 { format!("{name} {}", duration(seconds)) } else { name.to_owned() }
        })
        .collect();
    let memory = memory(planned).map_or(String::new(), |memory| format!(", {memory}"));
    format!("plan: {}; in all {}{memory}", on.join(", "), time(planned))
}
