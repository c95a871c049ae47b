//! Everything before the first tile: the plan, the world, pilots, the first pass's photons, a forecast.

use super::clock::Clock;
use super::photons::{PassMaps, PassStages};
use super::share::{Work, stretches};
use super::{Options, Planned, Progress, RenderError, room};
use crate::build::{self, Built, World};
use crate::description::Loaded;
use crate::forecast::{Cost, Pace, PhotonSeconds};
use crate::plan::{Antialiasing, Plan};
use crate::scatter::Photon;
use crate::survey::Survey;
use crate::trace::{self, Tracer, Wants};
use std::path::PathBuf;

/// A render that is ready to trace.
pub(super) struct Prepared {
    pub plan: Plan,
    pub world: World,
    pub wants: Wants,
    pub warnings: Vec<String>,
    pub files: Vec<PathBuf>,
    pub stages: PassStages,
    pub survey: Survey,
    reference_level: f32,
    /// Bytes that making a pass's photons takes.
    photon_bytes: u64,
    /// Of those that are traced here.
    pub first_pass: u32,
}

impl Prepared {
    /// The world with its pilots, and the photons of its first pass.
    pub fn new(
        loaded: &Loaded,
        options: &Options,
        progress: &dyn Progress,
        clock: &mut Clock,
    ) -> Result<(Prepared, PassMaps), RenderError> {
        let plan = Plan::new(&loaded.scene, &options.request())?;
        options.check(&plan, loaded.scene.image.width, loaded.scene.image.height)?;
        room::check(options, plan.passes, loaded.scene.image.width, loaded.scene.image.height)?;
        room::check_scene(options, &loaded.scene)?;
        clock.lap("plan");

        progress.start("build", 1, "scene");
        let Built { world, warnings, files } = build::build(&loaded.scene, &plan)?;
        progress.finish();
        clock.lap("build");

        let wants = options.wants(world.camera.width, world.camera.height, plan.passes);
        let mut reference_level = 1.0;
        if matches!(plan.antialiasing, Antialiasing::Adaptive { .. }) {
            let tracer = Tracer {
                world: &world,
                plan: &plan,
                wants,
                reference_level,
                caustics: None,
                indirect: None,
                resting: None,
            };
            reference_level = trace::reference_level(&tracer);
        }
        let stages = PassStages::new(&world, &plan, options.halt.as_ref());
        if stages.any() || matches!(plan.antialiasing, Antialiasing::Adaptive { .. }) {
            clock.lap("pilot");
        }
        let survey = Survey::new(&world, &plan, stages.emission());
        clock.lap("survey");
        room::check_photons(options, stages.expected(), BESIDE_EACH_OTHER)?;
        let first_pass = stretches(options, &plan).first().map_or(plan.first_pass, |stretch| stretch.start);
        let first = stages.pass(&world, first_pass);
        if stages.any() {
            clock.lap("photons");
        }
        let maps = first.memory_bytes();
        let threads = rayon::current_num_threads() as u64;
        let photon_bytes = if maps == 0 { 0 } else { (MAKING * maps as f64) as u64 + threads * RETAINED };
        let ready = Prepared {
            plan,
            world,
            wants,
            warnings,
            files,
            stages,
            survey,
            reference_level,
            photon_bytes,
            first_pass,
        };
        Ok((ready, first))
    }

    /// Traces passes with the photons of one of them.
    pub fn tracer<'a>(&'a self, maps: &'a PassMaps) -> Tracer<'a> {
        Tracer {
            world: &self.world,
            plan: &self.plan,
            wants: self.wants,
            reference_level: self.reference_level,
            caustics: self.stages.caustics(maps),
            indirect: self.stages.indirect(maps),
            resting: None,
        }
    }

    /// What all of it will take.
    pub fn planned(
        &self,
        first: &PassMaps,
        options: &Options,
        progress: &dyn Progress,
        clock: &mut Clock,
    ) -> Planned {
        let work = Work::of(options, &self.plan, &self.world.camera);
        let guess = work.passes.min(if self.plan.until.is_any() { GUESS } else { u32::MAX });
        // Radii shrink; this pass's is the typical one.
        let typical = self.first_pass + (TYPICAL * f64::from(guess)) as u32;
        let tracer = Tracer {
            caustics: self.stages.caustics_of(first, typical),
            indirect: self.stages.indirect_of(first, typical),
            ..self.tracer(first)
        };
        let pace = Pace::measure(&tracer, typical, guess);
        let threads = rayon::current_num_threads() as f64;
        let later = if self.stages.one_map() { PhotonSeconds::default() } else { first.seconds() };
        let photons = later.times(threads);
        let cost = |passes| Cost::forecast(&pace, work.pixels, photons, passes);
        let spent = options.began.map_or(clock.sum(), |began| began.elapsed().as_secs_f64());
        let passes = self.plan.until.passes(work.passes, spent, cost(1).seconds, cost(2).seconds);
        clock.lap("forecast");
        let planned = Planned::new(self, first, options, clock, cost(passes), &Work { passes, ..work });
        progress.planned(&planned);
        planned
    }

    pub fn photon_bytes(&self) -> u64 {
        self.photon_bytes
    }
}

/// Bytes of a stored photon, at the least, while its map is made: it stands there as it was stored, and with its
/// places in the tree and in the map.
const BESIDE_EACH_OTHER: f64 = 1.6 * size_of::<Photon>() as f64;

/// What making a map takes beside the one that is gathered from: itself, and the places of photons in the tree that
/// divides them, with their order; and what allocators come to keep of the tree's own buffers over tens of passes.
/// What photons are stored in is kept from pass to pass.
const MAKING: f64 = 3.2;

/// What a thread's allocator has not given back of the photons that it has scattered: found as the middle of the
/// repository's scenes of small maps (`benches/plan.py forecast`).
const RETAINED: u64 = 3 << 19;

/// The passes before the one whose squared radius is the mean of all, as a share: for r² ∝ n^(−1/3) that is
/// (2/3)³.
const TYPICAL: f64 = 8.0 / 27.0;

/// Passes that are reckoned with before it is known how many a time allows.
const GUESS: u32 = 64;
