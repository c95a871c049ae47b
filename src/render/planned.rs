//! What a render will do and what that will take.

use super::clock::Clock;
use super::photons::PassMaps;
use super::prepare::Prepared;
use super::prices::first_photons;
use super::share::Work;
use super::{AllPhotons, Memory, Options, SceneSize, StageTime};
use crate::forecast::{Bill, Cost, memory};
use crate::math::Color;
use crate::plan::{Antialiasing, Plan, Until};
use crate::survey::Survey;
use crate::trace::{self, Rays, Sample, Wants};
use serde::Serialize;

/// A plan with its prices, on this machine. Serialised as it stands by `terrarium plan --json`.
#[derive(Clone, Debug, Serialize)]
pub struct Planned {
    #[serde(flatten)]
    pub survey: Survey,
    /// What is doubtful about meshes and images.
    pub warnings: Vec<String>,
    /// As many as there will be; with an error to be reached, at least.
    pub passes: u32,
    pub until: Until,
    /// Wall seconds from reading the plan to the finished image in memory.
    pub seconds: f64,
    /// The same by stage: those before `trace` are measured.
    pub stages: Vec<StageTime>,
    /// By what they are spent on; building and the forecast itself are not in it.
    pub prices: Bill,
    /// Camera samples.
    pub samples: u64,
    pub rays: Rays,
    /// Of the first pass: each further one sends out as many.
    #[serde(flatten)]
    pub photons: AllPhotons,
    /// Highest memory of the process, where the system tells what it holds.
    pub peak_bytes: Option<u64>,
    /// What that is made of.
    #[serde(skip)]
    pub(super) held: Option<memory::Held>,
    #[serde(skip)]
    pub(super) later: memory::Later,
    pub memory: Memory,
    #[serde(rename = "scene_size")]
    pub scene: SceneSize,
}

impl Planned {
    pub(super) fn new(
        ready: &Prepared,
        first: &PassMaps,
        options: &Options,
        clock: &Clock,
        cost: Cost,
        work: &Work,
    ) -> Planned {
        let Prepared { plan, world, wants, stages, .. } = ready;
        let mut photons = stages.stats(world);
        stages.count(&mut photons, &mut Default::default(), first);
        let (passes, pixels) = (work.passes, work.pixels as u64);
        let film = (pixels as f64 * trace::Tile::bytes_per_pixel(trace::layers(wants))) as u64;
        let several = passes > 1 && !stages.one_map();
        let later = memory::Later {
            film,
            photons: if several { ready.photon_bytes() } else { 0 },
            tiles: kept_by_tiles(
                plan,
                options,
                wants,
                [world.camera.width, world.camera.height],
                cost.samples as f64 / (pixels * u64::from(passes)).max(1) as f64,
            ),
            image: options.image_bytes_per_pixel() * pixels,
        };
        let held = memory::held();
        let mut prices = cost.bill;
        prices.add_photons(first_photons(first, clock));
        let mut done = clock.stages.clone();
        done.push(StageTime { name: "trace".to_owned(), seconds: cost.seconds });
        Planned {
            survey: ready.survey.clone(),
            warnings: ready.warnings.clone(),
            passes,
            until: plan.until,
            seconds: clock.sum() + cost.seconds,
            stages: done,
            prices,
            samples: cost.samples,
            rays: cost.rays,
            peak_bytes: held.map(|held| held.peak(&later)),
            later,
            held,
            memory: Memory::of(world, film as usize, &photons),
            scene: SceneSize::of(world),
            photons,
        }
    }
}

/// Adaptive antialiasing keeps what a tile's samples yield, and their places, in storage that doubles as they
/// come; busy tiles have more of them than others.
fn kept_by_tiles(
    plan: &Plan,
    options: &Options,
    wants: &Wants,
    [width, height]: [u32; 2],
    samples_per_pixel: f64,
) -> u64 {
    if !matches!(plan.antialiasing, Antialiasing::Adaptive { .. }) {
        return 0;
    }
    let whole = wants.whole_samples();
    let each = size_of::<Color>() + size_of::<(u64, u32)>() + if whole { size_of::<Sample>() } else { 0 };
    let side = |length: u32| f64::from(options.tile.min(length));
    let (width, height) = options.crop.map_or((width, height), |crop| (crop.width(), crop.height()));
    let tiles = (f64::from(width) / side(width)).ceil() * (f64::from(height) / side(height)).ceil();
    let at_once = tiles.min(rayon::current_num_threads() as f64);
    // No tile of an image of one is busier than the mean.
    let busy = BUSY.min(tiles);
    (3.0 * busy * samples_per_pixel * side(width) * side(height) * each as f64 * at_once) as u64
}

/// Samples of the busiest tiles over those of the mean.
const BUSY: f64 = 2.0;
