//! Pixels become tiles: camera samples, the paths behind them, and their mean over each pixel.
//!
//! `path` knows no tiles and `antialias` no physics. A pixel's value in a pass is a function of the
//! scene, the pixel and the pass alone, so that tiles of any size on any number of threads agree.

mod antialias;
mod bounce;
mod branch;
mod caustic;
mod departure;
mod direct;
mod light;
mod path;
mod probe;
mod record;
mod reference_level;
mod resting;
mod sample;
mod tile;
mod watch;
mod words;

use crate::build::World;
use crate::index::Caustics;
use crate::math::{Color, DVec3, Health, Place};
use crate::plan::Plan;
pub use path::Scratch;
pub use probe::{Kind, LUMINANCE, Look, Parts, Probe, Probes};
pub use record::{
    Event, Fate, InterfaceRecord, LightRecord, Met, PhotonRecord, Recorder, SampleRecord, Sent, Vertex,
};
pub use reference_level::reference_level;
pub use resting::Resting;
pub use sample::{Sample, Wants};
use serde::Serialize;
use std::time::Instant;
pub use tile::{Layer, Layers, Measured, PixelValue, Tile};
pub use watch::{Part, Spent, Watch};
pub use words::{Reader, Words};

/// Rays by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Rays {
    pub camera: u64,
    pub shadow: u64,
    pub reflection: u64,
    pub refraction: u64,
    /// On from diffuse surfaces, for indirect light.
    pub diffuse: u64,
    /// Short ones, for where a surface ends under a caustic.
    pub probe: u64,
}

impl Rays {
    pub fn total(&self) -> u64 {
        self.camera + self.shadow + self.reflection + self.refraction + self.diffuse + self.probe
    }
}

/// What tracing counts as it goes.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    pub rays: Rays,
    pub health: Health,
    pub cut: Cut,
    pub watch: Watch,
    /// Of one thread, on tiles.
    pub seconds: f64,
    /// Whether the bias of photons is looked at; and what it is by [`Look`], of caustic and indirect light,
    /// summed over the samples since it was cleared.
    probing: bool,
    bias: [[Color; 2]; 2],
    /// Takes down what is traced, where that is asked for.
    recorder: Option<Box<Recorder>>,
}

impl Tally {
    /// Notes the blur's bias, by [`Look`], of caustic (0) or indirect (1) light that the camera sees so much of.
    fn blurred(&mut self, kind: usize, throughput: Color, bias: [Color; 2]) {
        for (sums, seen) in self.bias.iter_mut().zip(bias) {
            sums[kind] += throughput * seen;
        }
    }
}

/// Paths that the depth limit has cut.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Cut {
    pub paths: u64,
    /// Sum of their weights; divided by the number of camera samples, the share of an image of
    /// uniform radiance that is missing at most.
    pub weight: f64,
}

impl Tally {
    pub fn add(&mut self, other: &Tally) {
        self.rays.camera += other.rays.camera;
        self.rays.shadow += other.rays.shadow;
        self.rays.reflection += other.rays.reflection;
        self.rays.refraction += other.rays.refraction;
        self.rays.diffuse += other.rays.diffuse;
        self.rays.probe += other.rays.probe;
        self.health.add(&other.health);
        self.cut.paths += other.cut.paths;
        self.cut.weight += other.cut.weight;
        self.watch.add(&other.watch);
        self.seconds += other.seconds;
    }
}

/// Everything that stays the same while tiles are traced.
pub struct Tracer<'a> {
    pub world: &'a World,
    pub plan: &'a Plan,
    pub wants: Wants,
    /// Luminance that counts as middling in this scene: see [`reference_level`].
    pub reference_level: f32,
    /// The photons of the passes that are traced; none where the plan has no caustics.
    pub caustics: Option<Caustics<'a>>,
    /// Those of indirect light, where it is found by photons.
    pub indirect: Option<Caustics<'a>>,
    /// Pixels that progressive antialiasing leaves as they are.
    pub resting: Option<&'a Resting>,
}

/// Adds the passes of `passes` to a tile, in order, and times one sample in `timed` by its parts.
pub fn passes(tracer: &Tracer, passes: std::ops::Range<u32>, tile: &mut Tile, timed: u32) -> Tally {
    let began = Instant::now();
    let mut tally = Tally { watch: Watch::new(timed), ..Tally::default() };
    let mut scratch = Scratch::new(tracer);
    for pass in passes {
        tile.begin(pass);
        antialias::pass(tracer, pass, tile, &mut scratch, &mut tally);
    }
    tally.watch.end();
    tally.seconds = began.elapsed().as_secs_f64();
    tally
}

/// One pixel of one pass again: its value, and the samples that it was made of or that were looked at for it.
pub fn replay(tracer: &Tracer, place: Place) -> (DVec3, Vec<SampleRecord>) {
    let mut tally = Tally::default();
    tally.record();
    let mut tile = Tile::new(place.x, place.y, 1, 1, layers(&tracer.wants));
    antialias::pass(tracer, place.pass, &mut tile, &mut Scratch::new(tracer), &mut tally);
    let samples = tally.recorder.map(|recorder| recorder.into_samples()).unwrap_or_default();
    (tile.mean(0), samples)
}

/// The layers that a film needs for what is wanted of each sample.
pub fn layers(wants: &Wants) -> Layers {
    Layers {
        first_hit: wants.first_hit,
        split: wants.split,
        variance: wants.variance,
        photons: wants.photons,
        bias: wants.bias,
        probes: wants.probes,
        parts: Parts::Growing,
        one_pass: wants.one_pass,
    }
}
