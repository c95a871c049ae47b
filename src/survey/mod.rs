//! What only the built world can tell of the plan: which light reaches which mirror or interface, how much
//! of it is aimed at them, and which media overlap.
//!
//! A cheap look at bounds. "No" is certain; "yes" may be wrong where something stands between.

mod caustics;
mod nested;
mod objects;

use crate::build::World;
use crate::plan::{Decision, Effect, Plan};
use crate::scatter::Emission;
pub use caustics::LightReach;
pub use nested::Nested;
use serde::Serialize;

/// The plan's decisions, looked at again in the built world.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Survey {
    /// Each light, whether caustics come from it; none where the plan has no caustics.
    pub lights: Vec<LightReach>,
    pub nested: Nested,
    /// One an effect, in their order: the plan's, refined.
    pub decisions: Vec<Decision>,
}

impl Survey {
    /// `emission`: that of caustics, where some light reaches what focuses it.
    pub fn new(world: &World, plan: &Plan, emission: Option<&Emission>) -> Survey {
        let lights = if plan.photons.is_some() { caustics::lights(world, emission) } else { Vec::new() };
        let nested = Nested::find(world);
        let refined = |decision: &Decision| match decision.effect {
            Effect::Caustics if decision.on => caustics::refined(world, decision, &lights),
            Effect::NestedMedia if decision.on => nested.refined(decision),
            _ => decision.clone(),
        };
        let decisions = plan.decisions.iter().map(refined).collect();
        Survey { lights, nested, decisions }
    }

    /// One line an effect, and one a light that caustics could have come from and do not.
    pub fn text(&self) -> String {
        let decisions = self.decisions.iter().map(ToString::to_string);
        let lights = self.lights.iter().filter(|light| !light.on).map(ToString::to_string);
        decisions.chain(lights).map(|line| line + "\n").collect()
    }
}
