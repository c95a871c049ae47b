//! Photon scatter: emitters → photon paths → photons, the first stage of every pass.
//!
//! A photon is stored where light from an emitter meets a non-specular surface after one mirror or
//! interface at least (L S⁺ D), and nowhere else: what reaches a surface directly is direct light.
//!
//! An emission is planned once for a render: each light is divided into cells, those that cannot reach
//! a mirror or an interface are left out, and a pilot shares the photons among the rest. A pass then
//! takes its own stretch of each cell's well-distributed sequence, so that any pass can be computed
//! alone, every pass is right in the mean, and the passes together are spread as evenly as one.

mod apart;
mod balls;
mod bounds;
mod casters;
mod distant;
mod four;
mod ledger;
mod path;
mod photon;
mod photons;
mod pilot;
mod projection;
mod quads;
mod reach;
mod shelf;
mod source;
mod surfaces;
mod window;

use crate::build::World;
use crate::math::random::{Items, Scramble, Sequence, Stage, combine, mix, unit};
use crate::math::{Health, Ray};
use crate::plan::Plan;
pub use apart::apart;
use bounds::Bound;
use four::{FOUR, Quartet};
pub use ledger::Ledger;
use path::{Sink, Walk};
pub use photon::Photon;
pub use photons::Photons;
use rayon::prelude::*;
pub use reach::{Aimed, reached};
use shelf::Shelf;
use source::{Domain, Source, Start};
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Which light becomes photons.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Store {
    /// L S⁺ D.
    Caustics,
    /// L D: what shadow rays find as well, to compare the two.
    Direct,
    /// L (S|D)* D S* D: what diffuse surfaces have sent on, up to the plan's number of bounces.
    Indirect,
}

/// Where photons are sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aim {
    /// Where they can reach a mirror or an interface.
    Casters,
    /// Where they can reach anything.
    Scene,
}

/// What photons are sent from where, for all passes of a render.
#[derive(Clone, Debug)]
pub struct Emission {
    seed: u64,
    max_depth: u32,
    bounces: u32,
    store: Store,
    sources: Vec<Source>,
    aim: Aim,
    targets: Vec<Bound>,
    cells: Vec<Cell>,
    found: Vec<pilot::Found>,
    emitters: usize,
    /// For the photons of chunks.
    shelf: Shelf,
    /// Set from outside: photons are of no use any more.
    halt: Option<Arc<AtomicBool>>,
}

#[derive(Clone, Debug)]
struct Cell {
    source: u32,
    domain: Domain,
    /// Of all photons.
    share: f64,
}

/// The photons of one pass.
#[derive(Clone, Debug, Default)]
pub struct Scattered {
    pub photons: Photons,
    pub ledger: Ledger,
    /// Samples taken; some of them found nothing to emit.
    pub emitted: u64,
    /// By emitter of the world.
    pub by_light: Vec<Ledger>,
    pub health: Health,
}

/// What the pilot says of an emitter.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LightShare {
    pub cells: usize,
    /// Watts into the cells, all channels together.
    pub flux: f64,
    /// The part of it that arrives as photons; a path may store several.
    pub yield_share: f64,
    /// Of all photons.
    pub share: f64,
}

/// The photons of a pass, counted over all cells.
struct Schedule {
    /// By cell, its stretch of the cell's own sequence, and the number of its first photon.
    runs: Vec<Range<u64>>,
    starts: Vec<u64>,
    emitted: u64,
}

/// Cells of all lights together, and of each at the least and at the most.
const CELLS: usize = 8192;
const CELLS_OF_A_LIGHT: [usize; 2] = [48, 2048];

/// Photons that are followed one after the other.
const CHUNK: u64 = 1024;

impl Emission {
    /// Photons that are asked for once `halt` is set are left out.
    pub fn halted_by(self, halt: Arc<AtomicBool>) -> Emission {
        Emission { halt: Some(halt), ..self }
    }

    /// For caustics. `None` where no light reaches a mirror or an interface.
    pub fn new(world: &World, plan: &Plan) -> Option<Emission> {
        Emission::of(world, plan, Store::Caustics, Aim::Casters)
    }

    pub fn of(world: &World, plan: &Plan, store: Store, aim: Aim) -> Option<Emission> {
        let scene = casters::scene(world)?;
        let specular = casters::specular(world);
        let targets = match aim {
            Aim::Casters => casters::casters(world),
            Aim::Scene => vec![scene],
        };
        let sources = Source::all(world, &scene);
        let sends = |source: &Source| aim == Aim::Scene || reach::reaches_any(world, source, &specular);
        let [least, most] = CELLS_OF_A_LIGHT;
        let most = (CELLS / sources.len().max(1)).clamp(least, most);
        let cells: Vec<Cell> = (0u32..)
            .zip(&sources)
            .filter(|(_, source)| sends(source))
            .flat_map(|(i, source)| {
                let domains = projection::domains(world, source, &targets, most);
                domains.into_iter().map(move |domain| Cell { source: i, domain, share: 0.0 })
            })
            .collect();
        let mut emission = Emission {
            // Photons of different kinds are independent.
            seed: if store == Store::Indirect { mix(plan.seed ^ INDIRECT) } else { plan.seed },
            max_depth: plan.max_depth,
            bounces: plan.bounces,
            store,
            sources,
            aim,
            targets,
            cells,
            found: Vec::new(),
            shelf: Shelf::default(),
            halt: None,
            emitters: world.emitters.len(),
        };
        emission.found = pilot::explore(&emission, world);
        let of: Vec<u32> = emission.cells.iter().map(|c| c.source).collect();
        let shares = pilot::shares(&emission.found, &of)?;
        emission.cells.iter_mut().zip(shares).for_each(|(cell, share)| cell.share = share);
        Some(emission)
    }

    /// The radius, metres, of the middling one of what focuses light; casters that are many count in groups.
    pub fn caster_radius(&self) -> f64 {
        let mut radii: Vec<f64> = self.targets.iter().map(|target| target.radius).collect();
        radii.sort_by(f64::total_cmp);
        radii.get(radii.len() / 2).copied().unwrap_or(0.0)
    }

    /// The same, for photons that are no pass's: independent of all of theirs.
    pub fn pilot(&self) -> Emission {
        Emission { seed: mix(self.seed ^ PILOT), ..self.clone() }
    }

    /// By emitter of the world, what the pilot found and decided.
    pub fn lights(&self) -> Vec<LightShare> {
        let mut lights = vec![LightShare::default(); self.emitters];
        for (cell, found) in self.cells.iter().zip(&self.found) {
            let light = &mut lights[self.sources[cell.source as usize].emitter as usize];
            light.cells += 1;
            light.flux += found.flux;
            light.yield_share += found.arrived;
            light.share += cell.share;
        }
        for light in &mut lights {
            light.yield_share /= if light.flux > 0.0 { light.flux } else { 1.0 };
        }
        lights
    }

    /// The photons of pass `pass`, of about `count` samples: exactly so many in the mean over passes.
    pub fn scatter(&self, world: &World, pass: u32, count: u64) -> Scattered {
        let Schedule { runs, starts, emitted } = self.schedule(pass, count);
        let walk = self.walk(world);
        let chunks: Vec<u64> = (0..emitted.div_ceil(CHUNK)).collect();
        let sinks: Vec<(Sink, Vec<(u32, Ledger)>)> = chunks
            .par_iter()
            .map(|&chunk| {
                if self.halt.as_ref().is_some_and(|halt| halt.load(Ordering::Relaxed)) {
                    return Default::default();
                }
                let of = chunk * CHUNK..((chunk + 1) * CHUNK).min(emitted);
                let sink = Sink { photons: self.shelf.take(), ..Sink::default() };
                self.chunk(&walk, &runs, &starts, of, count as f64, sink)
            })
            .collect();
        let mut all =
            Scattered { emitted, by_light: vec![Ledger::default(); self.emitters], ..Default::default() };
        let mut photons = Vec::with_capacity(sinks.len());
        for (sink, ledgers) in sinks {
            photons.push(sink.photons);
            all.health.add(&sink.health);
            ledgers.iter().for_each(|(light, ledger)| all.by_light[*light as usize].add(ledger));
        }
        all.photons = Photons::of_chunks(photons, Some(self.shelf.clone()));
        all.by_light.iter().for_each(|ledger| all.ledger.add(ledger));
        all
    }

    /// Gives up the memory that is kept for the photons of later passes.
    pub fn give_up_memory(&self) {
        self.shelf.clear();
    }

    /// The rays that [`Emission::scatter`] traces, path by path: for measurements.
    pub fn rays(&self, world: &World, pass: u32, count: u64) -> Vec<Ray> {
        let Schedule { runs, starts, emitted } = self.schedule(pass, count);
        let sink = Sink { rays: Some(Vec::new()), ..Sink::default() };
        self.chunk(&self.walk(world), &runs, &starts, 0..emitted, count as f64, sink)
            .0
            .rays
            .unwrap_or_default()
    }

    /// Which photons of which cell a pass has.
    fn schedule(&self, pass: u32, count: u64) -> Schedule {
        let runs: Vec<Range<u64>> =
            (0..self.cells.len()).map(|cell| self.run(cell, pass, count as f64)).collect();
        let mut before = 0;
        let starts: Vec<u64> = runs
            .iter()
            .map(|run| {
                let start = before;
                before += run.end - run.start;
                start
            })
            .collect();
        Schedule { runs, starts, emitted: before }
    }

    /// The stretch of a cell's sequence that belongs to a pass. The stretches of successive passes
    /// follow each other without a gap, and are of the expected length in the mean over the offset.
    fn run(&self, cell: usize, pass: u32, count: f64) -> Range<u64> {
        let expected = count * self.cells[cell].share;
        let key = combine(combine(mix(self.seed), Stage::Photons as u64), cell as u64);
        let offset = unit(combine(key, OFFSET));
        let end = |passes: f64| (passes * expected + offset) as u64;
        end(f64::from(pass))..end(f64::from(pass) + 1.0)
    }

    /// Photons `of` a pass, counted over all cells.
    fn chunk(
        &self,
        walk: &Walk,
        runs: &[Range<u64>],
        starts: &[u64],
        of: Range<u64>,
        count: f64,
        mut sink: Sink,
    ) -> (Sink, Vec<(u32, Ledger)>) {
        sink.photons.reserve((of.end - of.start) as usize);
        let mut ledgers = Vec::new();
        let items = Items::of(self.seed, Stage::Photons);
        // The last of the cells that begin here: those before it are empty.
        let mut cell = starts.partition_point(|&start| start <= of.start) - 1;
        let mut i = of.start;
        while i < of.end {
            let end = (starts[cell] + runs[cell].end - runs[cell].start).min(of.end);
            let weight = 1.0 / (count * self.cells[cell].share);
            let sequence = items.sequence(cell as u64, 0);
            let scrambles = scrambles(sequence);
            let first = runs[cell].start + (i - starts[cell]);
            self.starts(walk.world, cell, &scrambles, first..first + (end - i), |index, start| {
                if self.may_arrive(start) {
                    start.power *= weight;
                    walk.follow(start, sequence.at(index as u32), &mut sink);
                }
            });
            i = end;
            let light = |cell: usize| self.sources[self.cells[cell].source as usize].emitter;
            let (here, next) = (light(cell), self.cells.get(cell + 1).map(|_| light(cell + 1)));
            if i == of.end || next != Some(here) {
                ledgers.push((here, std::mem::take(&mut sink.ledger)));
            }
            cell += 1;
        }
        (sink, ledgers)
    }

    /// The photons of a cell that leave, of those with these indices.
    #[inline]
    fn starts(
        &self,
        world: &World,
        cell: usize,
        scrambles: &[Scramble; 2],
        of: Range<u64>,
        mut follow: impl FnMut(u64, &mut Start),
    ) {
        let Cell { source, domain, .. } = &self.cells[cell];
        let source = &self.sources[*source as usize];
        for first in of.clone().step_by(FOUR) {
            let quartet = Quartet::new(source, &self.targets, domain, scrambles, first as u32);
            for index in first..(first + FOUR as u64).min(of.end) {
                let drawn = quartet.at((index - first) as usize);
                let mut start = source.sample(world, &self.targets, domain, &drawn);
                if let Some(start) = &mut start {
                    follow(index, start);
                }
            }
        }
    }

    /// What passes all mirrors and interfaces by would be traced for nothing.
    #[inline]
    fn may_arrive(&self, start: &Start) -> bool {
        self.aim == Aim::Scene || self.targets.iter().any(|target| target.may_meet(&start.ray))
    }

    fn walk<'a>(&'a self, world: &'a World) -> Walk<'a> {
        Walk { world, store: self.store, max_depth: self.max_depth, bounces: self.bounces }
    }
}

/// Dimensions of a photon's values: where it starts; a path's own follow.
const WHERE: [u64; 2] = [0, 1];

fn scrambles(sequence: Sequence) -> [Scramble; 2] {
    WHERE.map(|dimension| sequence.dimension(dimension).scramble())
}

const OFFSET: u64 = u64::MAX;

const INDIRECT: u64 = 0x1d1e_c7ed;
const PILOT: u64 = 0x0b5e_7fae;
