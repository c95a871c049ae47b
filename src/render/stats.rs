//! What a render cost and counted, for people and machines.

use super::keeper::Checkpoints;
use super::{AllPhotons, Next, Planned, Priced};
use crate::build::{Geometry, Mesh, World};
use crate::film::{Accuracy, Film};
use crate::math::Rare;
use crate::trace::{Rays, Tally};
use serde::Serialize;

/// Statistics of a render; serialised as they stand by `--stats`.
#[derive(Clone, Debug, Serialize)]
pub struct Stats {
    pub stages: Vec<StageTime>,
    /// What the stages' time was spent on, beside what was predicted.
    pub prices: Vec<Priced>,
    /// Of all stages, as it was before the first tile.
    pub predicted_seconds: f64,
    pub predicted_peak_bytes: Option<u64>,
    pub passes: u32,
    /// How far the picture still is from the truth; unknown after one pass.
    pub accuracy: Option<Accuracy>,
    /// What of the error no pass shows.
    pub not_seen: Vec<String>,
    /// The price of half the error.
    pub next: Option<Next>,
    /// Camera samples.
    pub samples: u64,
    pub rays: Rays,
    /// Paths cut by the depth limit.
    pub truncated_paths: u64,
    /// The weight of those paths as a share of all camera samples.
    pub truncated_weight: f64,
    pub rare_events: Vec<RareEvent>,
    /// Without caustics: none.
    #[serde(flatten)]
    pub photons: AllPhotons,
    pub memory: Memory,
    pub checkpoints: Checkpoints,
    #[serde(rename = "scene_size")]
    pub scene: SceneSize,
}

/// Wall time of one stage.
#[derive(Clone, Debug, Serialize)]
pub struct StageTime {
    pub name: String,
    pub seconds: f64,
}

/// A rare event against its healthy share of `of` trials.
#[derive(Clone, Debug, Serialize)]
pub struct RareEvent {
    pub name: &'static str,
    pub count: u64,
    pub of: u64,
    pub allowed: f64,
}

/// Bytes held by the large parts of a render.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Memory {
    pub geometry_bytes: usize,
    pub trees_bytes: usize,
    pub textures_bytes: usize,
    pub film_bytes: usize,
    /// The largest photon map.
    pub photons_bytes: usize,
}

/// What the built world holds.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct SceneSize {
    pub instances: usize,
    /// Stored triangles; instances share them.
    pub triangles: usize,
    pub emitters: usize,
}

impl Stats {
    #[expect(clippy::too_many_arguments, reason = "all that a render leaves")]
    pub(super) fn new(
        stages: Vec<StageTime>,
        tally: &Tally,
        film: &Film,
        world: &World,
        photons: AllPhotons,
        prices: Vec<Priced>,
        planned: &Planned,
        passes: u32,
        accuracy: Option<Accuracy>,
        not_seen: Vec<String>,
        checkpoints: Checkpoints,
    ) -> Stats {
        let health = &tally.health;
        let rare_events = Rare::ALL.into_iter().map(|event| RareEvent {
            name: event.name(),
            count: health.of(event),
            of: health.trials(),
            allowed: event.allowed(),
        });
        let traced =
            stages.iter().filter(|stage| stage.name == "trace").map(|stage| stage.seconds).sum::<f64>();
        Stats {
            stages,
            prices,
            predicted_seconds: planned.seconds,
            predicted_peak_bytes: planned.peak_bytes,
            passes,
            next: accuracy
                .as_ref()
                .and_then(|a| Next::after(f64::from(a.passes), a, traced / f64::from(passes.max(1)))),
            accuracy,
            not_seen,
            checkpoints,
            samples: health.samples,
            rays: tally.rays,
            truncated_paths: tally.cut.paths,
            truncated_weight: tally.cut.weight / (health.samples.max(1) as f64),
            rare_events: rare_events.collect(),
            memory: Memory::of(world, film.memory_bytes(), &photons),
            scene: SceneSize::of(world),
            photons,
        }
    }
}

fn meshes(world: &World) -> impl Iterator<Item = &Mesh> {
    world.geometries.iter().filter_map(|geometry| match geometry {
        Geometry::Mesh(mesh) => Some(mesh),
        Geometry::Shape(_) => None,
    })
}

impl Memory {
    pub(super) fn of(world: &World, film_bytes: usize, photons: &AllPhotons) -> Memory {
        let photons = [&photons.photons, &photons.indirect_photons].into_iter().flatten();
        Memory {
            geometry_bytes: meshes(world).map(|m| m.surface.memory_bytes()).sum::<usize>()
                + size_of_val(world.instances.as_slice()),
            trees_bytes: meshes(world).map(|m| m.tree.memory_bytes()).sum::<usize>()
                + world.tree.memory_bytes(),
            textures_bytes: world.textures.iter().map(|t| t.memory_bytes()).sum(),
            film_bytes,
            photons_bytes: photons.map(|p| p.map_bytes).sum(),
        }
    }
}

impl SceneSize {
    pub(super) fn of(world: &World) -> SceneSize {
        SceneSize {
            instances: world.instances.len(),
            triangles: meshes(world).map(|m| m.surface.triangles.len()).sum(),
            emitters: world.emitters.len(),
        }
    }
}
