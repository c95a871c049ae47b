//! The stages in order, each timed: the whole program on one screen.

mod image;
mod options;
mod photons;
mod stats;

use crate::build::{self, Built};
use crate::description::Loaded;
use crate::film::Film;
use crate::math::Rare;
use crate::output;
use crate::plan::{Antialiasing, Plan};
use crate::survey::Survey;
use crate::trace::{self, Tally, Tracer};
pub use options::{Aov, Options, Progress, RenderError, Silent};
use photons::PassStages;
pub use photons::{AllPhotons, LightPhotons, PhotonStats, Watts};
use rayon::prelude::*;
pub use stats::{RareEvent, StageTime, Stats};
use std::path::PathBuf;
use std::time::Instant;

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

/// Passes that a tile works through before progress is reported.
const BATCH: u32 = 8;

/// Renders a checked scene.
pub fn render(loaded: &Loaded, options: &Options, progress: &dyn Progress) -> Result<Rendered, RenderError> {
    // A caller that has set up rayon's own threads renders on them.
    let Some(threads) = options.threads else { return stages(loaded, options, progress) };
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|e| RenderError::Failed(format!("no threads could be started: {e}")))?;
    pool.install(|| stages(loaded, options, progress))
}

fn stages(loaded: &Loaded, options: &Options, progress: &dyn Progress) -> Result<Rendered, RenderError> {
    let mut clock = Clock::default();
    let plan = Plan::new(&loaded.scene, &options.request())?;
    options.check(&plan)?;
    clock.lap("plan");

    progress.start("build", 1, "scene");
    let Built { world, mut warnings, files } = build::build(&loaded.scene, &plan)?;
    progress.finish();
    clock.lap("build");

    let wants = options.wants();
    let mut tracer =
        Tracer { world: &world, plan: &plan, wants, reference_level: 1.0, caustics: None, indirect: None };
    if matches!(plan.antialiasing, Antialiasing::Adaptive { .. }) {
        tracer.reference_level = trace::reference_level(&tracer);
    }
    let stages = PassStages::new(&world, &plan);
    let mut photon_stats = stages.stats(&world);
    clock.lap("pilot");
    let survey = Survey::new(&world, &plan, stages.emission());
    clock.lap("survey");

    let mut film = Film::new(world.camera.width, world.camera.height, options.tile, trace::layers(&wants));
    let mut tally = Tally::default();
    progress.start("trace", film.tiles.len() as u64 * u64::from(plan.passes), "tiles");
    let last = plan.first_pass + plan.passes;
    let batch = if stages.one_map() { BATCH } else { 1 };
    let mut photons = stages.pass(&world, plan.first_pass);
    for first in (plan.first_pass..last).step_by(batch as usize) {
        let passes = first..(first + batch).min(last);
        if batch == 1 || first == plan.first_pass {
            stages.count(&mut photon_stats, &mut tally.health, &photons);
        }
        let tracer =
            Tracer { caustics: stages.caustics(&photons), indirect: stages.indirect(&photons), ..tracer };
        let trace = || -> Vec<Tally> {
            film.tiles
                .par_iter_mut()
                .map(|tile| {
                    let tally = trace::passes(&tracer, passes.clone(), tile);
                    progress.advance(u64::from(passes.end - passes.start));
                    tally
                })
                .collect()
        };
        // The next pass's photons are scattered beside this pass's tiles.
        let another = batch == 1 && passes.end < last;
        let (tallies, next) = rayon::join(trace, || another.then(|| stages.pass(&world, passes.end)));
        tallies.iter().for_each(|t| tally.add(t));
        photons = next.unwrap_or(photons);
    }
    progress.finish();
    clock.lap("trace");

    warnings.extend(health_warnings(&tally, &plan));
    warnings.extend(photon_stats.warnings(plan.max_depth));
    if options.strict {
        refuse_excesses(&tally)?;
    }
    let image = image::assemble(&film, options);
    let stats = Stats::new(clock.stages, &tally, &plan, &film, &world, photon_stats);
    let provenance = image::provenance(loaded, &plan, &world, &tally, &film);
    Ok(Rendered { image, provenance, survey, stats, warnings, files })
}

#[derive(Default)]
struct Clock {
    stages: Vec<StageTime>,
    last: Option<Instant>,
}

impl Clock {
    fn lap(&mut self, name: &str) {
        let now = Instant::now();
        let seconds = self.last.map_or(0.0, |last| (now - last).as_secs_f64());
        self.last = Some(now);
        self.stages.push(StageTime { name: name.to_owned(), seconds });
    }
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
