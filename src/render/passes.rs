//! Pass after pass, until the plan's last or until a rule says that it is enough.

use super::photons::{AllPhotons, PassMaps};
use super::prepare::Prepared;
use super::stop::Stop;
use super::{Options, Planned, Progress};
use crate::film::Film;
use crate::trace::{self, Tally, Tracer};
use rayon::prelude::*;
use std::ops::Range;

/// One sample in so many is timed by its parts.
const TIMED: u32 = 61;

/// Passes that a tile works through before progress is reported.
const BATCH: u32 = 8;

/// What tracing leaves.
pub(super) struct Traced {
    pub film: Film,
    pub tally: Tally,
    pub photons: AllPhotons,
    /// Passes that were traced.
    pub passes: u32,
}

pub(super) fn trace(
    ready: &Prepared,
    first: PassMaps,
    options: &Options,
    planned: &Planned,
    progress: &dyn Progress,
) -> Traced {
    let Prepared { plan, world, wants, stages, .. } = ready;
    let mut film = Film::new(world.camera.width, world.camera.height, options.tile, trace::layers(wants));
    let mut tally = Tally::default();
    let mut photons = stages.stats(world);
    let mut stop = Stop::new(plan, options, &film);
    progress.start("trace", film.tiles.len() as u64 * u64::from(planned.passes), "tiles");
    let last = plan.first_pass + plan.passes;
    let several = stages.one_map() && !plan.until.is_any() && !progress.looks_on();
    let batch = if several { BATCH } else { 1 };
    let mut maps = first;
    let mut begin = plan.first_pass;
    while begin < last {
        let passes: Range<u32> = begin..(begin + batch).min(last);
        if !stages.one_map() || begin == plan.first_pass {
            stages.count(&mut photons, &mut tally.health, &maps);
        }
        let tracer = Tracer { resting: stop.resting(), ..ready.tracer(&maps) };
        let stop_here = &stop;
        let trace = || -> Vec<Tally> {
            film.tiles
                .par_iter_mut()
                .filter_map(|tile| {
                    if stop_here.is_late() {
                        return None;
                    }
                    let tally = trace::passes(&tracer, passes.clone(), tile, TIMED);
                    progress.advance(u64::from(passes.end - passes.start));
                    Some(tally)
                })
                .collect()
        };
        // The next pass's photons are scattered beside this pass's tiles.
        let another = !stages.one_map() && passes.end < last && stop.allows_another();
        let (tallies, next) = rayon::join(trace, || another.then(|| stages.pass(world, passes.end)));
        tallies.iter().for_each(|t| tally.add(t));
        begin = passes.end;
        if progress.picture(&film, begin - plan.first_pass).is_break() {
            break;
        }
        if stop.now(begin - plan.first_pass, &film, progress) {
            break;
        }
        maps = match next {
            Some(maps) => maps,
            None if stages.one_map() || begin == last => maps,
            None => stages.pass(world, begin),
        };
    }
    progress.finish();
    Traced { film, tally, photons, passes: begin - plan.first_pass }
}
