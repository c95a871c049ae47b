//! The stages in order, each timed: the whole program on one screen.

mod clock;
mod health;
mod image;
mod keeper;
mod kept;
mod merge;
mod next;
mod options;
mod passes;
mod photons;
mod planned;
mod prepare;
mod prices;
mod replay;
mod room;
mod share;
mod stats;
mod stop;

use crate::description::Loaded;
use crate::film::Film;
use crate::output;
pub use crate::output::partial::PartialError;
use crate::survey::Survey;
use clock::Clock;
pub use health::{unhealthy, warnings as health_warnings};
use keeper::Keeper;
pub use keeper::{Checkpoint, Halt};
use kept::Form;
pub use kept::{Part, save, write};
pub use merge::{MergeError, Merged, list as shard_list, merge, numbered as shards_numbered};
pub use next::{Factor, Next, not_seen};
pub use options::{Aov, Options, Progress, RenderError, Silent};
use passes::Traced;
pub use photons::{AllPhotons, LightPhotons, PhotonStats, Watts};
pub use planned::Planned;
use prepare::Prepared;
pub use prices::Priced;
pub use replay::{Replay, replay};
pub use share::{By, Shards};
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
    /// What of the image is there, and its sums: of a shard, and of a render that was stopped from outside.
    pub part: Option<(Part, Film)>,
    pub halted: bool,
}

/// Renders a checked scene.
pub fn render(loaded: &Loaded, options: &Options, progress: &dyn Progress) -> Result<Rendered, RenderError> {
    on_threads(options, || stages(loaded, options, progress))
}

/// Plans a checked scene: all that [`render`] does before it traces, and what that will take.
pub fn plan(loaded: &Loaded, options: &Options, progress: &dyn Progress) -> Result<Planned, RenderError> {
    on_threads(options, || {
        let mut clock = Clock::start();
        let (ready, first) = Prepared::new(loaded, options, progress, &mut clock)?;
        let planned = ready.planned(&first, options, progress, &mut clock);
        room::foreseen(options, &planned)?;
        Ok(planned)
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
    room::foreseen(options, &planned)?;
    let before = prices::first_photons(&first, &clock);
    let mut provenance = image::provenance(loaded, &ready.plan, &planned.survey, &ready.world);
    let camera = &ready.world.camera;
    let assets = keeper::assets(options, &ready.files)?;
    let shown = (loaded.scene.image.exposure_ev, loaded.scene.image.png_bits);
    let form =
        Form::new(&ready.plan, options, [camera.width, camera.height], assets, shown, ready.stages.rates());
    let mut keeper = Keeper::new(options, &provenance, form);
    let traced = passes::trace(&ready, first, &mut keeper, options, &planned, progress)?;
    clock.lap("trace");

    let Prepared { plan, world, mut warnings, files, .. } = ready;
    let Traced { film, mut tally, photons, passes, part, halted, checkpoints } = traced;
    // What is rare is told of the whole, of what a checkpoint had as well.
    let whole = &part.counts;
    tally.health = whole.health.clone();
    (tally.cut.paths, tally.cut.weight) = (whole.cut_paths, whole.cut_weight);
    warnings.extend(health::warnings(&part.counts.health));
    warnings.extend(health::cut(&part.counts, plan.max_depth));
    warnings.extend(photons.warnings(plan.max_depth));
    warnings.extend(stop::exceeded(&plan, options, passes));
    if options.strict {
        health::refuse_excesses(&part.counts.health)?;
    }
    let image = image::assemble(&film, &options.aovs);
    warnings.extend(image::beyond(&image));
    // Passes of a shard are no sample of all.
    let accuracy = if options.shards.is_some() { None } else { film.accuracy() };
    image::found(&mut provenance, &film, passes, &part.counts, accuracy.as_ref());
    if halted {
        provenance.partial = Some(serde_json::json!({ "stoppedAfterPasses": passes }));
    }
    let taken = prices::taken(&tally, clock.of("trace"), &photons, before);
    let prices = prices::beside(&taken, &planned.prices);
    let stats = Stats::new(
        clock.stages,
        &tally,
        &film,
        &world,
        photons,
        prices,
        &planned,
        passes,
        accuracy,
        next::not_seen(&plan),
        checkpoints,
    );
    let part = (options.shards.is_some() || halted).then_some((part, film));
    Ok(Rendered { image, provenance, survey: planned.survey, stats, warnings, files, part, halted })
}
