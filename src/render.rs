//! The stages in order, each timed: the whole program on one screen.

mod clock;
mod image;
mod options;
mod photons;
mod planned;
mod prepare;
mod prices;
mod stats;

use crate::description::Loaded;
use crate::film::Film;
use crate::math::Rare;
use crate::output;
use crate::plan::Plan;
use crate::survey::Survey;
use crate::trace::{self, Tally};
use clock::Clock;
pub use options::{Aov, Options, Progress, RenderError, Silent};
use photons::PassMaps;
pub use photons::{AllPhotons, LightPhotons, PhotonStats, Watts};
pub use planned::Planned;
use prepare::Prepared;
pub use prices::Priced;
use rayon::prelude::*;
pub use stats::{Memory, RareEvent, SceneSize, StageTime, Stats};
use std::path::PathBuf;

/// A finished render.
#[derive(Debug)]
pub struct Rendered {
    pub image: output::Image,
    pub provenance: output::Provenance,
    /// The plan's decisions, as the built world refines them.
    pub survey: Survey,
    pub stats: Stats,
    pub warnings: Vec<String>,
    /// Every asset file that was read.
    pub files: Vec<PathBuf>,
}

/// One sample in so many is timed by its parts.
const TIMED: u32 = 61;

/// Passes that a tile works through before progress is reported.
const BATCH: u32 = 8;

/// Renders a checked scene.
pub fn render(loaded: &Loaded, options: &Options, progress: &dyn Progress) -> Result<Rendered, RenderError> {
    on_threads(options, || stages(loaded, options, progress))
}

/// Plans a checked scene: all that [`render`] does before it traces, and what that will take.
pub fn plan(loaded: &Loaded, options: &Options, progress: &dyn Progress) -> Result<Planned, RenderError> {
    on_threads(options, || {
        let mut clock = Clock::start();
        let (ready, first) = Prepared::new(loaded, options, progress, &mut clock)?;
        Ok(ready.planned(&first, options, progress, &mut clock))
    })
}

/// A caller that has set up rayon's own threads renders on them.
fn on_threads<T: Send>(
    options: &Options,
    work: impl FnOnce() -> Result<T, RenderError> + Send,
) -> Result<T, RenderError> {
    let Some(threads) = options.threads else { return work() };
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|e| RenderError::Failed(format!("no threads could be started: {e}")))?;
    pool.install(work)
}

fn stages(loaded: &Loaded, options: &Options, progress: &dyn Progress) -> Result<Rendered, RenderError> {
    let mut clock = Clock::start();
    let (ready, first) = Prepared::new(loaded, options, progress, &mut clock)?;
    let planned = ready.planned(&first, options, progress, &mut clock);
    let before = prices::first_photons(&first, &clock);
    let traced = trace_passes(&ready, first, options, progress);
    clock.lap("trace");

    let Prepared { plan, world, mut warnings, files, .. } = ready;
    let Traced { film, tally, photons } = traced;
    warnings.extend(health_warnings(&tally, &plan));
    warnings.extend(photons.warnings(plan.max_depth));
    if options.strict {
        refuse_excesses(&tally)?;
    }
    let image = image::assemble(&film, options);
    let provenance = image::provenance(loaded, &plan, &world, &tally, &film);
    let taken = prices::taken(&tally, clock.of("trace"), &photons, before);
    let prices = prices::beside(&taken, &planned.prices);
    let stats = Stats::new(clock.stages, &tally, &film, &world, photons, prices, &planned);
    Ok(Rendered { image, provenance, survey: planned.survey, stats, warnings, files })
}

/// What tracing leaves.
struct Traced {
    film: Film,
    tally: Tally,
    photons: AllPhotons,
}

fn trace_passes(ready: &Prepared, first: PassMaps, options: &Options, progress: &dyn Progress) -> Traced {
    let Prepared { plan, world, wants, stages, .. } = ready;
    let mut film = Film::new(world.camera.width, world.camera.height, options.tile, trace::layers(wants));
    let mut tally = Tally::default();
    let mut photons = stages.stats(world);
    progress.start("trace", film.tiles.len() as u64 * u64::from(plan.passes), "tiles");
    let last = plan.first_pass + plan.passes;
    let batch = if stages.one_map() { BATCH } else { 1 };
    let mut maps = first;
    for first in (plan.first_pass..last).step_by(batch as usize) {
        let passes = first..(first + batch).min(last);
        if batch == 1 || first == plan.first_pass {
            stages.count(&mut photons, &mut tally.health, &maps);
        }
        let tracer = ready.tracer(&maps);
        let trace = || -> Vec<Tally> {
            film.tiles
                .par_iter_mut()
                .map(|tile| {
                    let tally = trace::passes(&tracer, passes.clone(), tile, TIMED);
                    progress.advance(u64::from(passes.end - passes.start));
                    tally
                })
                .collect()
        };
        // The next pass's photons are scattered beside this pass's tiles.
        let another = batch == 1 && passes.end < last;
        let (tallies, next) = rayon::join(trace, || another.then(|| stages.pass(world, passes.end)));
        tallies.iter().for_each(|t| tally.add(t));
        maps = next.unwrap_or(maps);
    }
    progress.finish();
    Traced { film, tally, photons }
}

fn health_warnings(tally: &Tally, plan: &Plan) -> Vec<String> {
    let health = &tally.health;
    let mut warnings = Vec::new();
    for (event, count) in health.excesses() {
        let places: Vec<String> = health.places.iter().take(3).map(ToString::to_string).collect();
        let at = if event == Rare::NonFiniteSample {
            format!(", first at {}", places.join("; "))
        } else {
            String::new()
        };
        warnings.push(format!(
            "{}: {count} in {} samples, more than {} is unhealthy{at}",
            event.name(),
            health.samples,
            event.allowed()
        ));
    }
    let cut = &tally.cut;
    if cut.paths > 0 {
        warnings.push(format!(
            "{} paths were cut after {} specular events in a row (render.max_depth), {:.2e} of all weight",
            cut.paths,
            plan.max_depth,
            cut.weight / health.samples as f64
        ));
    }
    warnings
}

fn refuse_excesses(tally: &Tally) -> Result<(), RenderError> {
    let excesses: Vec<String> =
        tally.health.excesses().map(|(event, count)| format!("{count} {}", event.name())).collect();
    if excesses.is_empty() {
        return Ok(());
    }
    Err(RenderError::Failed(format!("unhealthy: {} (--strict)", excesses.join(", "))))
}
