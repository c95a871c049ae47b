//! How accurate a planned picture will be, from its first passes.

use crate::description::Loaded;
use crate::plan::Plan;
use crate::render::{self, Next, Options, Planned, Progress, RenderError};
use serde::Serialize;

/// What the planned passes will reach.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Expected {
    /// Passes that were traced to tell it.
    pub from_passes: u32,
    /// Planned; or, where an error or a time ends the render, those that it will take.
    pub passes: f64,
    /// Relative RMS error after them; `None` where no pass tells it.
    pub error: Option<f64>,
    /// Wall seconds of tracing until then.
    pub seconds: f64,
    /// The price of half of that.
    pub next: Option<Next>,
    /// What of the error no pass shows.
    pub not_seen: Vec<String>,
}

/// Passes that tell of later ones.
const PASSES: u32 = 8;

/// Traces the first passes of a planned render, 8 or as many as it has, and says where the rest will lead.
pub fn expected(
    loaded: &Loaded,
    options: &Options,
    planned: &Planned,
    progress: &dyn Progress,
) -> Result<Expected, RenderError> {
    let plan = Plan::new(&loaded.scene, &options.request())?;
    let not_seen = render::not_seen(&plan);
    let from_passes = planned.passes.max(if planned.until.error.is_some() { PASSES } else { 1 }).min(PASSES);
    let mut shorter = loaded.clone();
    (shorter.scene.render.time_s, shorter.scene.render.error) = (None, None);
    let first = plan.first_pass;
    let options = Options {
        passes: Some(first..first + from_passes),
        until: Default::default(),
        aovs: Vec::new(),
        ..options.clone()
    };
    let unknown = Expected {
        from_passes: 0,
        passes: f64::from(planned.passes),
        error: None,
        seconds: 0.0,
        next: None,
        not_seen,
    };
    if from_passes < 2 {
        return Ok(unknown);
    }
    let stats = render::render(&shorter, &options, progress)?.stats;
    let Some(accuracy) = stats.accuracy else { return Ok(unknown) };
    let traced: f64 = stats.stages.iter().filter(|s| s.name == "trace").map(|s| s.seconds).sum();
    let each = traced / f64::from(stats.passes.max(1));
    let by_error = planned
        .until
        .error
        .map(|error| accuracy.passes_for(accuracy.aim(error)).max(f64::from(crate::plan::FEWEST)));
    let planned_passes = if planned.until.error.is_some() && planned.until.seconds.is_none() {
        f64::from(plan.passes)
    } else {
        f64::from(planned.passes)
    };
    let passes = by_error.map_or(planned_passes, |n| n.min(planned_passes));
    let error = accuracy.error_after(passes);
    let next = Next::after(passes, &accuracy, each);
    Ok(Expected { from_passes, passes, error: Some(error), seconds: passes * each, next, ..unknown })
}
