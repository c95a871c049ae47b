//! The photon stages of every pass: scatter, then index, ready to be gathered.

use super::Halt;
use crate::build::World;
use crate::film::Rates;
use crate::forecast::PhotonSeconds;
use crate::index::{Bandwidth, Caustics, Kernel, PhotonMap, Reach, shrink};
use crate::math::{Health, Rare};
use crate::plan::{self, Carriers, IndirectBy, PhotonBudget, PhotonEngine, Plan};
use crate::scatter::{Aim, Emission, Ledger, Scattered, Store};
use serde::Serialize;
use std::time::Instant;

/// Photons of the pilot that tells how many a pass stores, and from which the first radius comes.
const PILOT: (u32, u32) = (10_000, 100_000);

/// The largest radius as a share of the size of what focuses light.
const MAX_RADIUS: f64 = 0.25;

/// The same for indirect light, as a share of the size of the scene.
const MAX_INDIRECT_RADIUS: f64 = 0.1;

/// The part of the light that diffuse surfaces send on which reaches others, from which on photons find it better.
const ENCLOSED: f64 = 0.5;

/// All that the passes' photons have in common.
pub struct PhotonStage {
    emission: Emission,
    budget: PhotonBudget,
    reach: Rule,
    kernel: Kernel,
    max_radius: f32,
    /// Photons that a pass is expected to store.
    expected: f64,
}

enum Rule {
    Shrinking { first: Bandwidth, alpha: f64 },
    Nearest { k: usize },
}

/// One pass's photons.
pub struct PassPhotons {
    map: PhotonMap,
    factor: f32,
    emitted: u64,
    ledger: Ledger,
    health: Health,
    /// Wall time of making them.
    seconds: f64,
}

impl PhotonStage {
    /// `None` where the plan has no caustics, or no light reaches a mirror or an interface.
    pub fn caustic(world: &World, plan: &Plan) -> Option<PhotonStage> {
        let budget = plan.photons?;
        let emission = Emission::new(world, plan);
        let radius = MAX_RADIUS * emission.as_ref().map_or(0.0, Emission::caster_radius);
        let emission =
            if plan.forced() { Emission::of(world, plan, Store::Caustics, Aim::Scene) } else { emission }?;
        Some(PhotonStage::of(world, emission, budget, radius))
    }

    /// `None` where indirect light is not asked for or is better found by paths.
    pub fn indirect(world: &World, plan: &Plan) -> Option<PhotonStage> {
        if plan.bounces == 0 || plan.indirect_by == IndirectBy::Paths {
            return None;
        }
        let emission = Emission::of(world, plan, Store::Indirect, Aim::Scene)?;
        let (flux, arrived) = emission
            .lights()
            .iter()
            .fold((0.0, 0.0), |(flux, arrived), l| (flux + l.flux, arrived + l.flux * l.yield_share));
        if plan.indirect_by == IndirectBy::Auto && arrived < ENCLOSED * flux {
            return None;
        }
        let radius = MAX_INDIRECT_RADIUS * emission.caster_radius();
        Some(PhotonStage::of(world, emission, plan.indirect_photons, radius))
    }

    fn of(world: &World, emission: Emission, budget: PhotonBudget, max_radius: f64) -> PhotonStage {
        let max_radius = budget.max_radius.unwrap_or(max_radius) as f32;
        let most = if matches!(budget.engine, PhotonEngine::Classic { .. }) { PILOT.0 } else { PILOT.1 };
        let count = budget.count.clamp(PILOT.0, most);
        let pilot = emission.pilot().scatter(world, 0, count.into());
        let expected = pilot.photons.len() as f64 * f64::from(budget.count) / f64::from(count);
        let reach = match budget.engine {
            PhotonEngine::Classic { k } => Rule::Nearest { k: k as usize },
            PhotonEngine::Progressive { alpha, k } => {
                let first = Bandwidth::new(pilot.photons, expected, f64::from(k), 0.0, max_radius);
                Rule::Shrinking { first, alpha }
            }
        };
        let kernel = match budget.kernel {
            plan::Kernel::Disc => Kernel::Disc,
            plan::Kernel::Cone => Kernel::Cone { kappa: 1.1 },
            plan::Kernel::Epanechnikov => Kernel::Epanechnikov,
        };
        PhotonStage { emission, budget, reach, kernel, max_radius, expected }
    }

    /// At which its noise and its bias fall.
    fn rates(&self) -> Rates {
        match self.reach {
            Rule::Shrinking { alpha, .. } => Rates::progressive(alpha),
            Rule::Nearest { .. } => Rates::one_map(),
        }
    }

    /// Whether all passes gather the same photons.
    pub fn one_map(&self) -> bool {
        matches!(self.reach, Rule::Nearest { .. })
    }

    /// The photons of a pass; where one map serves all, those of the first.
    pub fn pass(&self, world: &World, pass: u32) -> PassPhotons {
        let began = Instant::now();
        let pass = if self.one_map() { 0 } else { pass };
        let Scattered { photons, ledger, emitted, health, .. } =
            self.emission.scatter(world, pass, self.budget.count.into());
        let factor = self.factor(pass);
        let map = PhotonMap::new(photons);
        if self.one_map() {
            self.emission.give_up_memory();
        }
        PassPhotons { map, factor, emitted, ledger, health, seconds: began.elapsed().as_secs_f64() }
    }

    /// A pass's radius over the first's.
    fn factor(&self, pass: u32) -> f32 {
        match self.reach {
            Rule::Shrinking { alpha, .. } => shrink(pass, alpha) as f32,
            Rule::Nearest { .. } => 1.0,
        }
    }

    pub fn caustics<'a>(&'a self, photons: &'a PassPhotons) -> Caustics<'a> {
        self.gathered(photons, photons.factor)
    }

    fn gathered<'a>(&'a self, photons: &'a PassPhotons, factor: f32) -> Caustics<'a> {
        let reach = match &self.reach {
            Rule::Shrinking { first, .. } => Reach::Shrinking { first, factor },
            Rule::Nearest { k } => Reach::Nearest { k: *k, max: self.max_radius },
        };
        Caustics { map: &photons.map, kernel: self.kernel, reach }
    }
}

/// The photon stages that the plan calls for.
pub struct PassStages {
    caustic: Option<PhotonStage>,
    indirect: Option<PhotonStage>,
}

/// What the photon stages make for one pass.
pub struct PassMaps {
    caustic: Option<PassPhotons>,
    indirect: Option<PassPhotons>,
    /// Wall time of making both.
    seconds: f64,
}

impl PassMaps {
    /// Wall time of making them, by what they are for.
    pub fn seconds(&self) -> PhotonSeconds {
        let of = |photons: &Option<PassPhotons>| photons.as_ref().map_or(0.0, |photons| photons.seconds);
        let each = PhotonSeconds { caustics: of(&self.caustic), indirect: of(&self.indirect) };
        // Both are made at once, and each waits for the other.
        each.times(self.seconds / each.sum().max(f64::MIN_POSITIVE))
    }

    pub fn memory_bytes(&self) -> usize {
        [&self.caustic, &self.indirect].into_iter().flatten().map(|photons| photons.map.memory_bytes()).sum()
    }
}

impl PassStages {
    pub fn new(world: &World, plan: &Plan, halt: Option<&Halt>) -> PassStages {
        let indirect = PhotonStage::indirect(world, plan);
        // Where photons find indirect light, nothing else asks for caustics behind matt surfaces.
        let seen = plan.carried.first.with(plan.carried.behind).any(Carriers::CAUSTICS);
        let caustic = if seen || indirect.is_none() { PhotonStage::caustic(world, plan) } else { None };
        let halting = |stage: PhotonStage| match halt {
            Some(Halt(halt)) => PhotonStage { emission: stage.emission.halted_by(halt.clone()), ..stage },
            None => stage,
        };
        PassStages { caustic: caustic.map(halting), indirect: indirect.map(halting) }
    }

    /// What photons of caustics are sent from where.
    pub fn emission(&self) -> Option<&Emission> {
        self.caustic.as_ref().map(|stage| &stage.emission)
    }

    /// At which the photons' noise and bias fall; where paths bring indirect light, theirs is that of samples.
    pub fn rates(&self) -> Rates {
        let caustics = self.caustic.as_ref().map(PhotonStage::rates);
        let indirect = self.indirect.as_ref().map(PhotonStage::rates);
        let of = caustics.or(indirect).unwrap_or_default();
        Rates {
            caustics: of.caustics,
            indirect: indirect.map_or(1.0, |rates| rates.indirect),
            bias: of.bias.min(indirect.map_or(f64::INFINITY, |rates| rates.bias)),
        }
    }

    /// Whether one set of maps serves all passes.
    pub fn one_map(&self) -> bool {
        [&self.caustic, &self.indirect].into_iter().flatten().all(PhotonStage::one_map)
    }

    pub fn pass(&self, world: &World, pass: u32) -> PassMaps {
        let of = |stage: &Option<PhotonStage>| stage.as_ref().map(|stage| stage.pass(world, pass));
        let began = Instant::now();
        let (caustic, indirect) = rayon::join(|| of(&self.caustic), || of(&self.indirect));
        PassMaps { caustic, indirect, seconds: began.elapsed().as_secs_f64() }
    }

    pub fn caustics<'a>(&'a self, maps: &'a PassMaps) -> Option<Caustics<'a>> {
        Some(self.caustic.as_ref()?.caustics(maps.caustic.as_ref()?))
    }

    pub fn indirect<'a>(&'a self, maps: &'a PassMaps) -> Option<Caustics<'a>> {
        Some(self.indirect.as_ref()?.caustics(maps.indirect.as_ref()?))
    }

    /// As if the photons were those of pass number `pass`.
    pub fn caustics_of<'a>(&'a self, maps: &'a PassMaps, pass: u32) -> Option<Caustics<'a>> {
        let stage = self.caustic.as_ref()?;
        Some(stage.gathered(maps.caustic.as_ref()?, stage.factor(pass)))
    }

    pub fn indirect_of<'a>(&'a self, maps: &'a PassMaps, pass: u32) -> Option<Caustics<'a>> {
        let stage = self.indirect.as_ref()?;
        Some(stage.gathered(maps.indirect.as_ref()?, stage.factor(pass)))
    }

    /// Photons that a pass is expected to store, for caustics and for indirect light.
    pub fn expected(&self) -> f64 {
        [&self.caustic, &self.indirect].into_iter().flatten().map(|stage| stage.expected).sum()
    }

    /// Whether there are photons at all.
    pub fn any(&self) -> bool {
        self.caustic.is_some() || self.indirect.is_some()
    }

    pub(super) fn stats(&self, world: &World) -> AllPhotons {
        let of = |stage: &Option<PhotonStage>| stage.as_ref().map(|stage| PhotonStats::new(stage, world));
        AllPhotons { photons: of(&self.caustic), indirect_photons: of(&self.indirect) }
    }

    /// Takes down what the maps of a pass came to.
    pub(super) fn count(&self, stats: &mut AllPhotons, health: &mut Health, maps: &PassMaps) {
        for map in [&maps.caustic, &maps.indirect].into_iter().flatten() {
            health.add(&map.health);
            health.count_many(Rare::NonFinitePhoton, map.map.refused() as u64);
        }
        let one =
            |stats: &mut Option<PhotonStats>, stage: &Option<PhotonStage>, map: &Option<PassPhotons>| {
                if let (Some(stats), Some(stage), Some(map)) = (stats, stage, map) {
                    stats.add(stage, map);
                }
            };
        one(&mut stats.photons, &self.caustic, &maps.caustic);
        one(&mut stats.indirect_photons, &self.indirect, &maps.indirect);
    }
}

/// Of caustics, and of indirect light where photons find it.
#[derive(Clone, Debug, Default, Serialize)]
pub struct AllPhotons {
    pub photons: Option<PhotonStats>,
    pub indirect_photons: Option<PhotonStats>,
}

/// What the photons of all passes came to.
#[derive(Clone, Debug, Default, Serialize)]
pub struct PhotonStats {
    pub maps: u32,
    pub emitted: u64,
    pub stored: u64,
    /// Photons with a number in them that is not finite: left out.
    pub refused: u64,
    /// Watts a map, channels added, by what became of them.
    pub watts: Watts,
    pub lights: Vec<LightPhotons>,
    /// The largest gather radius, metres.
    pub max_radius: f32,
    /// The last pass's radius over the first's.
    pub radius_factor: f32,
    /// Of the largest map and the pilot's.
    pub map_bytes: usize,
}

impl AllPhotons {
    /// What of the photons' light is missing and should not be.
    pub(super) fn warnings(&self, max_depth: u32) -> Vec<String> {
        let mut warnings = Vec::new();
        for photons in [&self.photons, &self.indirect_photons].into_iter().flatten() {
            let cut = photons.watts.cut_off / photons.watts.emitted.max(f64::MIN_POSITIVE);
            if cut > 1e-3 {
                warnings.push(format!(
                    "{:.2} % of the photons' power was cut off after {max_depth} specular events in a row (render.max_depth)",
                    100.0 * cut
                ));
            }
        }
        warnings
    }
}

/// The ledger of a map.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Watts {
    pub emitted: f64,
    pub stored: f64,
    pub absorbed: f64,
    pub escaped: f64,
    pub cut_off: f64,
}

/// One light's part.
#[derive(Clone, Debug, Serialize)]
pub struct LightPhotons {
    pub name: String,
    /// Of the photons sent out.
    pub share: f64,
    /// The part of the power sent towards what focuses it that arrives as a caustic.
    #[serde(rename = "yield")]
    pub yields: f64,
}

impl PhotonStats {
    pub(super) fn new(stage: &PhotonStage, world: &World) -> PhotonStats {
        let lights = world.emitters.iter().zip(stage.emission.lights());
        PhotonStats {
            lights: lights
                .map(|(emitter, share)| LightPhotons {
                    name: emitter.name.clone(),
                    share: share.share,
                    yields: share.yield_share,
                })
                .collect(),
            max_radius: stage.max_radius,
            ..PhotonStats::default()
        }
    }

    pub(super) fn add(&mut self, stage: &PhotonStage, photons: &PassPhotons) {
        self.maps += 1;
        self.emitted += photons.emitted;
        self.stored += photons.map.len() as u64;
        self.refused += photons.map.refused() as u64;
        self.radius_factor = photons.factor;
        let pilot = match &stage.reach {
            Rule::Shrinking { first, .. } => first.memory_bytes(),
            Rule::Nearest { .. } => 0,
        };
        self.map_bytes = self.map_bytes.max(photons.map.memory_bytes() + pilot);
        let ledger = &photons.ledger;
        let n = f64::from(self.maps);
        let mean = |before: f64, now: f64| before + (now - before) / n;
        let w = &mut self.watts;
        w.emitted = mean(w.emitted, ledger.emitted.element_sum());
        w.stored = mean(w.stored, ledger.stored.element_sum());
        w.absorbed = mean(w.absorbed, ledger.absorbed.element_sum());
        w.escaped = mean(w.escaped, ledger.escaped.element_sum());
        w.cut_off = mean(w.cut_off, ledger.cut.element_sum());
    }
}
