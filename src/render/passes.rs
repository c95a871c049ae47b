//! Pass after pass, until the plan's last or until a rule says that it is enough.

use super::keeper::{Checkpoints, Keeper};
use super::kept::{Counts, Part};
use super::photons::{AllPhotons, PassMaps};
use super::prepare::Prepared;
use super::share::{Steps, stretches};
use super::stop::Stop;
use super::{Options, Planned, Progress, RenderError};
use crate::film::Film;
use crate::plan::Antialiasing;
use crate::trace::{self, Tally, Tracer};
use rayon::prelude::*;
use std::ops::Range;

/// One sample in so many is timed by its parts: where they are millions, fewer of them tell as much.
const TIMED: [u32; 2] = [61, 251];
const MILLIONS: u64 = 3_000_000;

/// Of all tiles, by thread, at least.
const PIECES: usize = 256;

/// Passes that a tile works through before progress is reported.
const BATCH: u32 = 8;

/// What tracing leaves.
pub(super) struct Traced {
    pub film: Film,
    pub tally: Tally,
    pub photons: AllPhotons,
    /// Passes that were traced, now and before.
    pub passes: u32,
    /// What of the image is there.
    pub part: Part,
    /// Whether it was stopped from outside.
    pub halted: bool,
    pub checkpoints: Checkpoints,
}

pub(super) fn trace(
    ready: &Prepared,
    first: PassMaps,
    keeper: &mut Keeper,
    options: &Options,
    planned: &Planned,
    progress: &dyn Progress,
) -> Result<Traced, RenderError> {
    let Prepared { plan, world, stages, .. } = ready;
    let resumed = keeper.resume(progress)?;
    let (mut film, begin, mut done, part) = match resumed {
        Some(resumed) => (resumed.film, resumed.begin, resumed.done, Some(resumed.part)),
        None => (keeper.film(), plan.first_pass, 0, None),
    };
    let mut stop = Stop::new(plan, options, &film);
    part.and_then(|part| part.stop).iter().for_each(|state| stop.resume(state));
    let several = stages.one_map() && !plan.until.is_any() && !progress.looks_on();
    let batch = if several { BATCH } else { 1 };
    let mut steps = Steps::new(stretches(options, plan), batch, begin);
    let mut tally = Tally::default();
    let mut photons = stages.stats(world);
    let tiles = film.tiles.len() as u64;
    let most: u64 = u64::from(done) + steps.passes();
    // An error to be reached is told from the first passes on, and how many it takes only then.
    let total = if plan.until.error.is_some() && plan.until.seconds.is_none() {
        0
    } else {
        tiles * most.min(u64::from(done) + u64::from(planned.passes))
    };
    progress.start("trace", total, "tiles");
    progress.resume(tiles * u64::from(done));
    let mut maps = first;
    let mut of = ready.first_pass;
    let (mut at, mut counted, mut halted) = (begin, false, false);
    while let Some(step) = steps.next() {
        at = step.start;
        if !stages.one_map() && of != step.start {
            (maps, of, counted) = (stages.pass(world, step.start), step.start, false);
        }
        if !counted {
            stages.count(&mut photons, &mut tally.health, &maps);
            counted = true;
        }
        // The next pass's photons are scattered beside this pass's tiles.
        let next = steps.peek().filter(|_| !stages.one_map() && stop.allows_another());
        let mut upcoming = None;
        loop {
            let tracer = Tracer { resting: stop.resting(), ..ready.tracer(&maps) };
            let waits = || stop.is_late() || keeper.pauses();
            let scatter = || next.filter(|_| upcoming.is_none()).map(|pass| (stages.pass(world, pass), pass));
            let (tallies, scattered) =
                rayon::join(|| tiles_of(&mut film, &tracer, &step, &waits, progress), scatter);
            upcoming = scattered.or(upcoming);
            tallies.iter().for_each(|t| tally.add(t));
            if keeper.halted() || stop.is_late() || film.tiles.iter().all(|tile| tile.next >= step.end) {
                break;
            }
            let part = keeper.part(at, done, Counts::of(&tally), Some(&stop));
            keeper.save(&film, &part, progress);
        }
        let unfinished = film.tiles.iter().any(|tile| tile.next < step.end);
        halted = keeper.halted() && (unfinished || steps.peek().is_some());
        if halted && unfinished {
            break;
        }
        (at, done) = (step.end, done + (step.end - step.start));
        if let Some((upcoming, pass)) = upcoming {
            (maps, of, counted) = (upcoming, pass, false);
        }
        if halted || progress.picture(&film, done).is_break() || stop.now(done, &film, progress) {
            break;
        }
        if let Some(likely) = stop.likely().filter(|_| total == 0) {
            progress.expect(tiles * most.min(likely.into()));
        }
        if keeper.pauses() {
            let part = keeper.part(at, done, Counts::of(&tally), Some(&stop));
            keeper.save(&film, &part, progress);
        }
    }
    progress.finish();
    if halted && done == 0 && film.tiles.iter().all(|tile| tile.next <= plan.first_pass) {
        return Err(RenderError::Stopped);
    }
    let part = keeper.part(at, done, Counts::of(&tally), halted.then_some(&stop));
    if halted {
        keeper.save(&film, &part, progress);
    }
    let checkpoints = keeper.checkpoints;
    Ok(Traced { film, tally, photons, passes: done, part, halted, checkpoints })
}

/// Traces those of a step's passes that tiles have not yet, unless they have to wait.
fn tiles_of(
    film: &mut Film,
    tracer: &Tracer,
    step: &Range<u32>,
    waits: &(impl Fn() -> bool + Sync),
    progress: &dyn Progress,
) -> Vec<Tally> {
    let a_pass = if let Antialiasing::Grid(n) = tracer.plan.antialiasing { u64::from(n * n) } else { 1 };
    let samples = film.window.pixels() as u64 * u64::from(step.end - step.start) * a_pass;
    let timed = TIMED[usize::from(samples > MILLIONS)];
    // A piece that one thread has begun no other takes over: many pieces, but not one for each of millions of tiles.
    let most = (film.tiles.len() / (PIECES * rayon::current_num_threads())).max(1);
    film.tiles
        .par_iter_mut()
        .with_max_len(most)
        .fold(Tally::default, |mut sum, tile| {
            let passes = tile.next.max(step.start)..step.end;
            if !passes.is_empty() && !waits() {
                let count = u64::from(passes.end - passes.start);
                sum.add(&trace::passes(tracer, passes, tile, timed));
                progress.advance(count);
            }
            sum
        })
        .collect()
}
