//! Which effects a scene calls for, why, and how much of each.
//!
//! Decided from the description alone, before any file is read. An effect that is off does not run,
//! allocate or load.

mod carried;
mod decide;
mod decision;
mod effect;
mod lighting;
mod overrides;
mod photons;
mod until;

pub use crate::description::Antialiasing;
pub use crate::description::IndirectBy;
use crate::description::{Indirect, Light, Scene};
pub use carried::{Carried, Carriers};
pub use decision::{Cause, Decision, few};
pub use effect::Effect;
pub use overrides::{Overrides, Refused};
pub use photons::{Kernel, PhotonBudget, PhotonEngine};
use std::borrow::Cow;
use std::ops::Range;
pub use until::{FEWEST, LONGEST, MOST_PASSES, Until};

/// What a caller asks for beyond the scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Request {
    /// The numbers of the passes, from the first to the one after the last.
    pub passes: Option<Range<u32>>,
    pub seed: Option<u64>,
    pub until: Until,
    pub overrides: Overrides,
}

/// What a render will do.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    pub antialiasing: Antialiasing,
    /// Independent passes whose mean is the image.
    pub passes: u32,
    /// The number of the first of them.
    pub first_pass: u32,
    /// What may end the render before its last pass.
    pub until: Until,
    pub seed: u64,
    /// Specular events in a row after which a path is cut.
    pub max_depth: u32,
    /// Branches of at least this weight are always followed; lighter ones survive by chance, in
    /// proportion, with their weight raised to it.
    pub split_weight: f64,
    /// Caustics, where the scene calls for them.
    pub photons: Option<PhotonBudget>,
    /// Bounces between diffuse surfaces at most; 0 without indirect light.
    pub bounces: u32,
    pub indirect_by: IndirectBy,
    /// Photons of indirect light, should it be found by them.
    pub indirect_photons: PhotonBudget,
    /// Which light the eye's paths carry.
    pub carried: Carried,
    /// Whether shadow rays are traced; without them nothing hides a light.
    pub shadows: bool,
    /// Whether lights with an extent are sampled all over; else at their middle.
    pub soft_shadows: bool,
    /// One an effect, in the order of [`Effect::ALL`].
    pub decisions: Vec<Decision>,
    pub overrides: Overrides,
    /// What of the overrides has no effect, and why.
    pub notes: Vec<String>,
}

/// Passes of progressive antialiasing where the scene does not say.
const DEFAULT_PASSES: u32 = 64;

/// Shadow rays a shading point on an area light, where one pass has to do.
const SINGLE_PASS_LIGHT_SAMPLES: u32 = 16;

impl Plan {
    /// The plan of a checked scene; what is asked for overrides what the scene says.
    ///
    /// # Errors
    /// Overrides that contradict each other, or ask for what the scene cannot have.
    pub fn new(scene: &Scene, request: &Request) -> Result<Plan, Refused> {
        let overrides = request.overrides.clone();
        let simple = scene.simplified();
        let own = decide::decide(&simple, scene);
        let notes = overrides.check(&own)?;
        let carried = overrides.carried(scene);
        let written = scene;
        let scene = &*overrides::edited(&simple, &overrides, &carried);
        let decisions = if overrides.is_empty() {
            own
        } else {
            overrides.decide(&own, &decide::decide(scene, written), &carried)
        };
        let until = Until::of(scene, request.until);
        until.check(scene).map_err(Refused)?;
        let progressive = scene.antialiasing == Antialiasing::Progressive;
        let runs = |effect| overrides.forced || decisions.iter().any(|d| d.effect == effect && d.on);
        let (caustics, indirect) = (runs(Effect::Caustics), runs(Effect::Indirect));
        let passes = request.passes.clone();
        Ok(Plan {
            antialiasing: scene.antialiasing,
            passes: passes
                .as_ref()
                .map(|range| range.end.saturating_sub(range.start))
                .or(scene.render.passes)
                .unwrap_or(match (until.is_any(), progressive) {
                    (true, _) => MOST_PASSES,
                    (false, true) => DEFAULT_PASSES,
                    (false, false) => 1,
                })
                .max(1),
            first_pass: passes.map_or(0, |range| range.start),
            until,
            seed: request.seed.unwrap_or(scene.render.seed),
            max_depth: scene.render.max_depth,
            // One sample of many averages its chances out; one of few must not show them.
            split_weight: if progressive { 0.01 } else { 1.0 / 256.0 },
            photons: photons::budget(scene).filter(|_| caustics),
            indirect_by: scene.indirect_by,
            indirect_photons: photons::indirect(scene),
            bounces: match scene.indirect {
                Indirect::On if indirect => u32::MAX,
                Indirect::Bounces(n) if indirect => n,
                _ => 0,
            },
            carried,
            shadows: !overrides.leaves_out(Effect::Shadows),
            soft_shadows: !overrides.leaves_out(Effect::SoftShadows),
            decisions,
            overrides,
            notes,
        })
    }

    /// The scene that is rendered: without what changes nothing, and with the overrides that can be said in
    /// a scene.
    pub fn edited<'a>(&self, scene: &'a Scene) -> Cow<'a, Scene> {
        match scene.simplified() {
            Cow::Borrowed(scene) => overrides::edited(scene, &self.overrides, &self.carried),
            Cow::Owned(scene) => {
                Cow::Owned(overrides::edited(&scene, &self.overrides, &self.carried).into_owned())
            }
        }
    }

    pub fn is_on(&self, effect: Effect) -> bool {
        self.decisions.iter().any(|d| d.effect == effect && d.on)
    }

    /// The budgets of photons that are asked for: of caustics, and of indirect light where photons are to bring it.
    pub fn photon_budgets(&self) -> impl Iterator<Item = PhotonBudget> + use<> {
        let indirect = self.is_on(Effect::Indirect) && self.indirect_by == IndirectBy::Photons;
        self.photons.into_iter().chain(indirect.then_some(self.indirect_photons))
    }

    /// Whether an override leaves it out.
    pub fn leaves_out(&self, effect: Effect) -> bool {
        self.overrides.leaves_out(effect)
    }

    /// Whether stages run that nothing calls for: for tests.
    #[doc(hidden)]
    pub fn forced(&self) -> bool {
        self.overrides.forced
    }

    /// Shadow rays a shading point on this light.
    pub fn light_samples(&self, light: &Light) -> u32 {
        let (Light::Sphere { samples, .. }
        | Light::Quad { samples, .. }
        | Light::Disk { samples, .. }
        | Light::Environment { samples, .. }) = light
        else {
            return 1;
        };
        if self.soft_shadows { samples.unwrap_or(self.area_samples()).max(1) } else { 1 }
    }

    /// Shadow rays a shading point on an emitting object.
    pub fn area_samples(&self) -> u32 {
        let one = self.antialiasing == Antialiasing::Progressive || !self.soft_shadows;
        if one { 1 } else { SINGLE_PASS_LIGHT_SAMPLES }
    }

    /// One line an effect, and the overrides: as decided from the description alone.
    pub fn text(&self) -> String {
        self.decisions.iter().map(|d| d.to_string() + "\n").collect::<String>() + &self.overridden()
    }

    /// A line of the overrides; nothing without.
    pub fn overridden(&self) -> String {
        if self.overrides.is_empty() { String::new() } else { format!("overrides: {}\n", self.overrides) }
    }
}
