//! `farm`: the files with which an engine renders a scene in parts, on many machines.
//!
//! One module an engine; all of them are given the same [`Job`]. No engine is talked to: the user submits.

mod kubernetes;
mod openjd;
mod slurm;

use super::check::load_and_report;
use super::exit::{Failure, USAGE};
use super::farm_args::{Engine, FarmArgs};
use super::frames;
use super::progress::{Reporter, duration};
use super::report::{self, Terminal};
use super::summary::mebibytes;
use super::target::{same_file, targets_of};
use std::path::{Path, PathBuf};
use std::time::Instant;
use terrarium::output::atomic;
use terrarium::plan::Plan;
use terrarium::render::{self, By, Options, Planned, RenderError, Shards};

/// What is asked of an engine.
struct Job {
    /// In letters, digits and `-`.
    name: String,
    program: String,
    /// The scene and what `render` and `merge` are to be told beside it.
    scene: PathBuf,
    render: Vec<String>,
    outputs: Vec<PathBuf>,
    /// Where partial images go.
    parts: PathBuf,
    /// The folder that the names of files start from.
    folder: PathBuf,
    shards: u32,
    cpus: u32,
    /// Of one shard and of the merge: limits, not expectations.
    seconds: u64,
    bytes: u64,
    merge_bytes: u64,
    image: String,
}

/// Limits over predictions: a loaded or slower machine must not be stopped for it.
const SPARE_TIME: f64 = 3.0;
const SPARE_MEMORY: f64 = 1.3;
/// The least that is asked for.
const LEAST_SECONDS: u64 = 300;
const LEAST_BYTES: u64 = 256 << 20;

/// A file to write.
struct Sheet {
    name: String,
    text: String,
}

pub fn run(args: &FarmArgs, terminal: &Terminal) -> Result<(), Failure> {
    if args.scene == Path::new("-") {
        return Err(Failure::new(USAGE, "a scene that many machines read must be a file"));
    }
    if args.output.iter().any(|path| path == Path::new("-")) {
        return Err(Failure::new(
            USAGE,
            "a job's image goes to a file, not to standard output: `-o image.exr`",
        ));
    }
    let outputs: Vec<PathBuf> = args.output.iter().map(|path| of_frame(path, args.reading.frame)).collect();
    targets_of(&outputs, super::args::ImageFormat::default())?;
    if args.parts.is_file() || outputs.iter().any(|path| same_file(path, &args.parts)) {
        let message = format!("--parts {}: parts go to a folder, and that is a file", args.parts.display());
        return Err(Failure::new(USAGE, message));
    }
    for path in &outputs {
        atomic::probe(path).map_err(|error| Failure::writing(&path.display().to_string(), error))?;
    }
    let (job, planned) = job(args, terminal)?;
    let sheets = match args.engine {
        Engine::Slurm => slurm::sheets(&job),
        Engine::Openjd => openjd::sheets(&job),
        Engine::Kubernetes => kubernetes::sheets(&job),
    };
    let folder = args.folder.clone().unwrap_or_else(|| PathBuf::from("."));
    std::fs::create_dir_all(&folder)
        .map_err(|error| Failure::writing(&folder.display().to_string(), error))?;
    for sheet in &sheets {
        let path = folder.join(&sheet.name);
        atomic::write(&path, sheet.text.as_bytes())
            .map_err(|error| Failure::writing(&path.display().to_string(), error))?;
        report::print(&format!("{}\n", path.display()))?;
    }
    terminal.say(&format!(
        "{} shards of about {} on {} threads as this machine's, {} each",
        job.shards,
        duration(planned.seconds),
        rayon::current_num_threads(),
        planned.peak_bytes.map_or("memory unknown".to_owned(), mebibytes)
    ));
    Ok(())
}

fn job(args: &FarmArgs, terminal: &Terminal) -> Result<(Job, Planned), Failure> {
    let loaded =
        load_and_report(&args.scene, &args.reading, args.work.options().overrides.unread(), terminal)?;
    let reporter = Reporter::new(super::args::ProgressChoice::None, true, terminal);
    let shards = Shards { numbers: vec![0], of: args.shards };
    let options = Options { shards: Some(shards), began: Some(Instant::now()), ..args.work.options() };
    let planned = render::plan(&loaded, &options, &reporter)?;
    let threads = rayon::current_num_threads() as f64;
    let cpus = args.cpus.unwrap_or(4);
    let shard = planned.seconds * threads / f64::from(cpus).min(threads);
    let peak = planned.peak_bytes.unwrap_or(0) as f64;
    let sums = planned.memory.film_bytes as f64;
    // A shard of tiles has its own pixels alone.
    let plan = Plan::new(&loaded.scene, &options.request()).map_err(RenderError::from)?;
    let parts = options.shards.as_ref().map_or(1, |s| if By::of(s, &plan) == By::Tiles { s.of } else { 1 });
    let whole = sums * f64::from(parts);
    let stem = args.scene.file_stem().map_or("scene".into(), |stem| stem.to_string_lossy());
    let name: String =
        stem.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' }).collect();
    let place = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    let folder =
        std::env::current_dir().map_err(|e| Failure::new(USAGE, format!("no working directory: {e}")))?;
    Ok((
        Job {
            name: format!("terrarium-{}", name.trim_matches('-')),
            program: args.program.clone(),
            scene: place(&args.scene),
            render: again(args),
            outputs: args.output.iter().map(|path| place(&of_frame(path, args.reading.frame))).collect(),
            parts: place(&args.parts).join(own_folder(args)),
            folder,
            shards: args.shards,
            cpus,
            seconds: ((SPARE_TIME * shard) as u64).max(LEAST_SECONDS),
            // The picture and its sums are held twice as they are written.
            bytes: ((SPARE_MEMORY * (peak + 2.0 * sums)) as u64).max(LEAST_BYTES),
            merge_bytes: ((SPARE_MEMORY * 6.0 * whole) as u64).max(LEAST_BYTES),
            image: args.image.clone(),
        },
        planned,
    ))
}

/// A folder of the job's own among the parts, so that its merge finds no others.
fn own_folder(args: &FarmArgs) -> String {
    let stem = args.scene.file_stem().map_or("scene".into(), |stem| stem.to_string_lossy());
    let frame = args.reading.frame.map_or(String::new(), |frame| format!(".{frame:04}"));
    format!("{stem}{frame}.of-{:04}", args.shards)
}

/// An image's name, with the frame's number in its place.
fn of_frame(path: &Path, frame: Option<u32>) -> PathBuf {
    frame.map_or(path.to_path_buf(), |frame| frames::named(path, frame))
}

/// The options of the render, as they were typed.
fn again(args: &FarmArgs) -> Vec<String> {
    let mut list = Vec::new();
    let mut add = |name: &str, value: String| list.extend([name.to_owned(), value]);
    args.reading.set.iter().for_each(|set| add("--set", set.clone()));
    let place = |path: &PathBuf| text(&std::path::absolute(path).unwrap_or_else(|_| path.clone()));
    args.reading.allow.iter().for_each(|folder| add("--allow", place(folder)));
    args.reading.frame.iter().for_each(|frame| add("--frame", frame.to_string()));
    let work = &args.work;
    if let Some(passes) = &work.passes {
        add("--passes", format!("{}..{}", passes.start, passes.end));
    }
    if let Some(seed) = work.seed {
        add("--seed", seed.to_string());
    }
    let names =
        |list: &[terrarium::plan::Effect]| list.iter().map(|e| e.name()).collect::<Vec<_>>().join(",");
    for (name, effects) in
        [("--without", &work.effects.without), ("--only", &work.effects.only), ("--with", &work.effects.with)]
    {
        if !effects.is_empty() {
            add(name, names(effects));
        }
    }
    if !work.aov.is_empty() {
        add("--aov", work.aov.iter().map(|aov| aov.name()).collect::<Vec<_>>().join(","));
    }
    list
}

impl Job {
    /// `render` of the part that the engine's own options name.
    fn render_words(&self, part: &[&str]) -> Vec<String> {
        let mut words = vec![self.program.clone(), "render".to_owned(), text(&self.scene)];
        words.extend(self.render.iter().cloned());
        words.extend(part.iter().map(|word| (*word).to_owned()));
        words.extend(["--of".to_owned(), self.shards.to_string()]);
        words.extend(["--out-dir".to_owned(), text(&self.parts), "--resume".to_owned()]);
        words
    }

    fn merge_words(&self) -> Vec<String> {
        let mut words = vec![self.program.clone(), "merge".to_owned(), text(&self.parts)];
        for output in &self.outputs {
            words.extend(["-o".to_owned(), text(output)]);
        }
        words
    }
}

fn text(path: &Path) -> String {
    path.display().to_string()
}

/// A word as a POSIX shell reads it back.
fn shell(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "_-./=:,@%+".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}

fn shell_line(words: &[String]) -> String {
    words.iter().map(|word| shell(word)).collect::<Vec<_>>().join(" ")
}

/// A text as YAML reads it back: JSON's strings are YAML's.
fn yaml(word: &str) -> String {
    serde_json::to_string(word).expect("a text")
}

fn yaml_list(words: &[String]) -> String {
    format!("[{}]", words.iter().map(|word| yaml(word)).collect::<Vec<_>>().join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_survive_the_shell() {
        for word in ["plain-1.exr", "two words", "it's", "a$b`c`", "", "x;rm -rf y", "ä"] {
            let out = std::process::Command::new("sh")
                .args(["-c", &format!("printf %s {}", shell(word))])
                .output()
                .expect("a shell");
            assert_eq!(String::from_utf8_lossy(&out.stdout), word);
        }
    }
}
