//! `merge`: partial images in, the image out.

use super::exit::{FAILED, Failure, UNREADABLE, USAGE};
use super::farm_args::MergeArgs;
use super::progress::{duration, short};
use super::report::Terminal;
use super::target::{Staged, same_file, targets_of};
use std::path::{Path, PathBuf};
use std::time::Instant;
use terrarium::output::atomic;
use terrarium::render::{
    MergeError, Merged, PartialError, health_warnings, merge, shards_numbered, unhealthy,
};

pub fn run(args: &MergeArgs, terminal: &Terminal) -> Result<(), Failure> {
    let began = Instant::now();
    let parts = parts(&args.parts)?;
    let targets = targets_of(&args.output, args.format)?;
    for path in targets.iter().filter_map(|target| target.path()) {
        if let Some(part) = parts.iter().find(|part| same_file(part, path)) {
            return Err(Failure::new(USAGE, format!("{} is a part and can't be an output", part.display())));
        }
        atomic::probe(path).map_err(|error| Failure::writing(&path.display().to_string(), error))?;
    }
    let merged = merge(&parts, args.allow_missing).map_err(failure)?;
    health_warnings(&merged.health).iter().for_each(|warning| terminal.warning(warning));
    if args.strict
        && let Some(what) = unhealthy(&merged.health)
    {
        return Err(Failure::new(FAILED, what));
    }
    let staged: Vec<Staged> = targets
        .iter()
        .map(|target| Ok(target.stage(&merged.image, &merged.provenance, merged.png)?.0))
        .collect::<Result<_, Failure>>()?;
    staged.into_iter().try_for_each(Staged::commit)?;
    if !args.quiet {
        say(args, &merged, began, terminal);
    }
    Ok(())
}

fn failure(error: MergeError) -> Failure {
    let hint = "; parts are what `render --shard`, `--shards` or a job of `farm` writes";
    match &error {
        MergeError::Unreadable(_, PartialError::Other(_)) => {
            Failure::new(UNREADABLE, format!("{error}{hint}"))
        }
        MergeError::Unreadable(..) => Failure::new(UNREADABLE, error.to_string()),
        MergeError::Invalid(_) => Failure::new(USAGE, error.to_string()),
    }
}

/// The files that are named, and those in folders that are named as partial images are.
fn parts(named: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut parts = Vec::new();
    for path in named {
        if !path.is_dir() {
            parts.push(path.clone());
            continue;
        }
        let unreadable = |error| Failure::new(UNREADABLE, format!("can't read {}: {error}", path.display()));
        let mut found = Vec::new();
        for entry in std::fs::read_dir(path).map_err(unreadable)? {
            let file = entry.map_err(unreadable)?.path();
            if is_part(&file) {
                found.push(file);
            }
        }
        if found.is_empty() {
            let name = path.display();
            return Err(Failure::new(USAGE, format!("no file in {name} is named like a part: *.shard*.exr")));
        }
        found.sort();
        parts.extend(found);
    }
    Ok(parts)
}

fn is_part(file: &Path) -> bool {
    let name = file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    name.ends_with(".exr") && name.contains(".shard") && !name.starts_with('.')
}

fn say(args: &MergeArgs, merged: &Merged, began: Instant, terminal: &Terminal) {
    let outputs: Vec<String> = args.output.iter().map(|path| path.display().to_string()).collect();
    let there = merged.of as usize - merged.missing.len();
    let error = match &merged.accuracy {
        Some(accuracy) => {
            let [low, high] = accuracy.interval.map(|e| short(100.0 * e));
            format!("error {} % ({low} to {high} %)", short(100.0 * accuracy.error))
        }
        None => "error unknown".to_owned(),
    };
    terminal.say(&format!(
        "wrote {}: {there} of {} shards, {} passes, {error}, in {}",
        outputs.join(", "),
        merged.of,
        merged.passes,
        duration(began.elapsed().as_secs_f64())
    ));
    if !merged.missing.is_empty() {
        terminal.warning(&format!(
            "of {} shards, {} not there: this is the image of the rest",
            merged.of,
            shards_numbered(&merged.missing)
        ));
    }
}
