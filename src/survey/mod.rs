//! What only the built world can tell of the plan: which light reaches which mirror or interface, how much
//! of it is aimed at them, and which media overlap.
//!
//! A cheap look at bounds. "No" is certain; "yes" may be wrong where something stands between.

mod caustics;
mod nested;
mod objects;

use crate::build::World;
use crate::plan::{Cause, Decision, Effect, Plan};
use crate::scatter::{self, Emission};
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
    /// Overrides that change nothing, and why.
    pub notes: Vec<String>,
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
        let decisions: Vec<Decision> = plan.decisions.iter().map(refined).collect();
        let mut notes = plan.notes.clone();
        notes.extend(idle_caustics(world, plan, &decisions));
        Survey { lights, nested, decisions, notes }
    }

    /// One line an effect, and one a light that caustics could have come from and do not.
    pub fn text(&self) -> String {
        let decisions = self.decisions.iter().map(ToString::to_string);
        let lights = self.lights.iter().filter(|light| !light.on).map(ToString::to_string);
        decisions.chain(lights).map(|line| line + "\n").collect()
    }
}

/// What of an override about caustics has no effect, as no light reaches what could focus it.
fn idle_caustics(world: &World, plan: &Plan, decisions: &[Decision]) -> Option<String> {
    let decided = |decisions: &[Decision]| decisions.iter().find(|d| d.effect == Effect::Caustics).cloned();
    let (before, after) = (decided(&plan.decisions)?, decided(decisions)?);
    let overrides = &plan.overrides;
    if before.on && !after.on {
        let asked = |list: &[Effect]| list.contains(&Effect::Caustics);
        if asked(&overrides.with) {
            return Some(format!("--with caustics adds nothing: {}", after.reason));
        }
        if overrides.only.as_deref().is_some_and(asked) {
            return Some(format!("--only caustics shows nothing of it: {}", after.reason));
        }
    }
    let left_out = !before.on && before.cause == Cause::Overridden;
    let reached = || scatter::reached(world).iter().any(|objects| !objects.is_empty());
    (left_out && overrides.without.contains(&Effect::Caustics) && !reached()).then(|| {
        "--without caustics leaves out nothing: no light reaches what bends or mirrors it".to_owned()
    })
}
