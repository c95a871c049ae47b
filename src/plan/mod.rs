//! Which effects a scene calls for, why, and how much of each.
//!
//! Decided from the description alone, before any file is read. An effect that is off does not run,
//! allocate or load.

mod effects;
mod photons;

pub use crate::description::Antialiasing;
pub use crate::description::IndirectBy;
use crate::description::{Indirect, Light, Scene};
pub use effects::{Decision, Effect};
pub use photons::{Kernel, PhotonBudget, PhotonEngine};
use std::ops::Range;

/// What a render will do.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    pub antialiasing: Antialiasing,
    /// Independent passes whose mean is the image.
    pub passes: u32,
    /// The number of the first of them.
    pub first_pass: u32,
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
    pub decisions: Vec<Decision>,
}

/// Passes of progressive antialiasing where the scene does not say.
const DEFAULT_PASSES: u32 = 64;

/// Shadow rays a shading point on an area light, where one pass has to do.
const SINGLE_PASS_LIGHT_SAMPLES: u32 = 16;

impl Plan {
    /// `passes` (the numbers from the first to the one after the last) and `seed` override the scene's.
    pub fn new(scene: &Scene, passes: Option<Range<u32>>, seed: Option<u64>) -> Plan {
        let progressive = scene.antialiasing == Antialiasing::Progressive;
        let decisions = effects::decide(scene);
        let caustics = decisions.iter().any(|d| d.effect == Effect::Caustics && d.on);
        Plan {
            antialiasing: scene.antialiasing,
            passes: passes
                .as_ref()
                .map(|range| range.end.saturating_sub(range.start))
                .or(scene.render.passes)
                .unwrap_or(if progressive { DEFAULT_PASSES } else { 1 })
                .max(1),
            first_pass: passes.map_or(0, |range| range.start),
            seed: seed.unwrap_or(scene.render.seed),
            max_depth: scene.render.max_depth,
            // One sample of many averages its chances out; one of few must not show them.
            split_weight: if progressive { 0.1 } else { 1.0 / 256.0 },
            photons: photons::budget(scene).filter(|_| caustics),
            indirect_by: scene.indirect_by,
            indirect_photons: photons::indirect(scene),
            bounces: match scene.indirect {
                Indirect::Off => 0,
                Indirect::On => u32::MAX,
                Indirect::Bounces(n) => n,
            },
            decisions,
        }
    }

    pub fn is_on(&self, effect: Effect) -> bool {
        self.decisions.iter().any(|d| d.effect == effect && d.on)
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
        samples.unwrap_or(self.area_samples()).max(1)
    }

    /// Shadow rays a shading point on an emitting object.
    pub fn area_samples(&self) -> u32 {
        if self.antialiasing == Antialiasing::Progressive { 1 } else { SINGLE_PASS_LIGHT_SAMPLES }
    }

    /// One line an effect, for the image's provenance.
    pub fn text(&self) -> String {
        self.decisions.iter().map(|d| d.to_string() + "\n").collect()
    }
}
