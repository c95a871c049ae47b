//! Checkpoints: what has been traced so far is written down now and then, and gone on from later.

use super::kept::{self, Counts, Form, Kept, Part};
use super::stop::Stop;
use super::{Options, Progress, RenderError, image};
use crate::film::Film;
use crate::output::{Provenance, hex};
use serde::Serialize;
use sha2::{Digest, Sha256};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Where and how often checkpoints are written, and whether one is gone on from.
#[derive(Clone, Debug)]
pub struct Checkpoint {
    pub path: PathBuf,
    pub every: Duration,
    /// Whether to write less often where that would take more than a fiftieth of the time.
    pub sparing: bool,
    /// Goes on from the file, if it is there.
    pub resume: bool,
    /// The partial image that is to become of it, where nothing is to be done if it is there.
    pub part: Option<PathBuf>,
}

/// Told from outside to stop.
#[derive(Clone, Debug, Default)]
pub struct Halt(pub Arc<AtomicBool>);

impl Halt {
    pub fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// SHA-256 of every asset file, one after the other: where what is rendered may be put together with what was
/// rendered elsewhere or earlier.
pub(super) fn assets(options: &Options, files: &[PathBuf]) -> Result<String, RenderError> {
    let mut hash = Sha256::new();
    if options.shards.is_some() || options.checkpoint.is_some() {
        for file in files {
            let failed = |error| RenderError::Io(format!("can't read {}: {error}", file.display()));
            let bytes = std::fs::read(file).map_err(failed)?;
            hash.update((bytes.len() as u64).to_le_bytes());
            hash.update(bytes);
        }
    }
    Ok(hex(&hash.finalize().into()))
}

pub(super) struct Keeper<'a> {
    options: &'a Options,
    provenance: &'a Provenance,
    form: Form,
    shards: Vec<u32>,
    due: Option<Instant>,
    /// Of what was gone on from.
    pub before: Counts,
    pub checkpoints: Checkpoints,
}

/// Checkpoints that were written.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Checkpoints {
    pub written: u32,
    /// For which tracing waited.
    pub seconds: f64,
}

/// The time between checkpoints that are sparing, in their own time.
const SPARING: u32 = 50;

/// Where a render goes on.
pub(super) struct Resumed {
    pub film: Film,
    pub begin: u32,
    pub done: u32,
    pub part: Part,
}

impl<'a> Keeper<'a> {
    pub fn new(options: &'a Options, provenance: &'a Provenance, form: Form) -> Keeper<'a> {
        let shards = options.shards.as_ref().map_or(vec![0], |shards| shards.numbers.clone());
        let due = options.checkpoint.as_ref().map(|checkpoint| Instant::now() + checkpoint.every);
        Keeper {
            options,
            provenance,
            form,
            shards,
            due,
            before: Counts::default(),
            checkpoints: Checkpoints::default(),
        }
    }

    /// The film to begin with.
    pub fn film(&self) -> Film {
        self.form.film(&self.shards)
    }

    /// What an earlier run left, if that is asked for and there is anything.
    pub fn resume(&mut self, progress: &dyn Progress) -> Result<Option<Resumed>, RenderError> {
        let Some(checkpoint) = &self.options.checkpoint else { return Ok(None) };
        if !checkpoint.resume || !checkpoint.path.exists() {
            let part = checkpoint.part.as_ref().and_then(|path| kept::load(path).ok());
            let same = |kept: &Kept| kept.other_than(self.provenance, &self.form, &self.shards).is_none();
            let there = part.is_some_and(|kept| kept.part.finished && same(&kept));
            return if there { Err(RenderError::Already) } else { Ok(None) };
        }
        let name = checkpoint.path.display();
        let failed = |error: String| {
            RenderError::Io(format!("can't go on from {name}: {error}; delete it to begin anew"))
        };
        let kept: Kept = kept::load(&checkpoint.path).map_err(|error| failed(error.to_string()))?;
        if let Some(difference) = kept.other_than(self.provenance, &self.form, &self.shards) {
            return Err(RenderError::Invalid(format!(
                "can't go on from {name}: it is of another render: {difference}; delete it to begin anew"
            )));
        }
        let film = kept.film().map_err(|error| failed(error.to_string()))?;
        self.before = kept.part.counts.clone();
        progress.note(&format!("going on from {name}, {} passes are done", kept.part.done));
        Ok(Some(Resumed { film, begin: kept.part.begin, done: kept.part.done, part: kept.part }))
    }

    /// Whether tiles wait for a checkpoint, or for good.
    pub fn pauses(&self) -> bool {
        self.halted() || self.due.is_some_and(|due| Instant::now() >= due)
    }

    pub fn halted(&self) -> bool {
        self.options.halt.as_ref().is_some_and(Halt::is_set)
    }

    /// What is there of the image.
    pub fn part(&self, begin: u32, done: u32, counts: Counts, stop: Option<&Stop>) -> Part {
        Part {
            form: self.form.clone(),
            shards: self.shards.clone(),
            begin,
            done,
            finished: stop.is_none(),
            counts: self.before.clone().plus(counts),
            stop: stop.and_then(Stop::state),
            words: 0,
            checksum: 0,
        }
    }

    /// Writes a checkpoint, if they are wanted. One that can't be written is told and does not end the render.
    pub fn save(&mut self, film: &Film, part: &Part, progress: &dyn Progress) -> bool {
        let Some(checkpoint) = &self.options.checkpoint else { return false };
        let began = Instant::now();
        let mut picture = image::assemble(film, &[]);
        picture.layers.truncate(1);
        let saved = kept::save(&checkpoint.path, &picture, self.provenance, part, film);
        if let Err(error) = &saved {
            progress.note(&format!("no checkpoint: {}: {error}", checkpoint.path.display()));
        }
        let took = began.elapsed();
        self.checkpoints.written += u32::from(saved.is_ok());
        self.checkpoints.seconds += took.as_secs_f64();
        let least = if checkpoint.sparing { took.saturating_mul(SPARING) } else { Duration::ZERO };
        self.due = Some(Instant::now() + checkpoint.every.max(least));
        saved.is_ok()
    }
}
