//! How far the ladders go in the time that there is: the plan's forecast of every rung, and what is given up
//! where they are too many.

use super::ladder::{Reach, ladder, passes_differ};
use super::record::{LeftOut, Rung};
use super::{Change, Knob};
use crate::description::{Antialiasing, Loaded, Scene};
use crate::plan::Plan;
use crate::render::{self, Options, Progress, RenderError, Silent};
use std::path::Path;

/// Passes of the scene, and of the ladder, where nothing says how many.
const MOST_RUNGS: u32 = 10;

/// The longest ladder that makes sense where samples lie where they always lie.
const MOST_RUNGS_FIXED: u32 = 5;

/// The shortest that shows a slope.
const FEWEST_RUNGS: u32 = 3;

/// With fewer passes than this, edges hide what the other knobs do.
const FEWEST_BASE: u32 = 4;

/// Rungs with their foretold seconds, and the knobs without any.
pub struct Design {
    pub rungs: Vec<Rung>,
    pub left_out: Vec<LeftOut>,
    /// What was given up, in words.
    pub notes: Vec<String>,
}

/// The most passes that are wished for.
pub fn top(scene: &Scene, ladder: Option<u32>) -> u32 {
    let fixed = scene.antialiasing != Antialiasing::Progressive;
    1 << (ladder.unwrap_or(if fixed { MOST_RUNGS_FIXED } else { MOST_RUNGS }).clamp(1, 20) - 1)
}

/// What a setting takes: seconds before the first tile, and seconds a pass.
struct Cost {
    setting: Option<Change>,
    fixed: f64,
    pass: f64,
}

impl Cost {
    fn of(&self, passes: u32) -> f64 {
        self.fixed + self.pass * f64::from(passes)
    }
}

/// The rungs that `seconds` allow for `seeds` renders each. `worst_passes`: with more, the reference would
/// not be better by enough.
pub fn design(
    loaded: &Loaded,
    plan: &Plan,
    options: &Options,
    asked: &super::Asked,
    worst_passes: f64,
    seconds: f64,
    progress: &dyn Progress,
) -> Result<Design, RenderError> {
    let scene = &loaded.scene;
    let mut notes = Vec::new();
    let mut wished = top(scene, asked.ladder);
    let fewest = 1 << (FEWEST_RUNGS - 1);
    let progressive = scene.antialiasing == Antialiasing::Progressive;
    while progressive && asked.ladder.is_none() && f64::from(wished) > worst_passes && wished > fewest {
        wished /= 2;
    }
    let passes = if passes_differ(scene, plan) { plan.passes } else { 1 };
    let mut reach = Reach { top: wished, base: passes.min(wished.max(fewest)) };
    let rungs = |reach: Reach| ladder(scene, plan, &asked.knobs, reach);
    let costs = forecast(loaded, options, &rungs(reach).0, progress)?;
    let price = |rung: &Rung| {
        costs.iter().find(|cost| cost.setting == rung.change).map_or(0.0, |cost| cost.of(rung.passes))
    };
    let wish = reach;
    let least = passes.min(FEWEST_BASE);
    loop {
        let (mut found, left_out) = rungs(reach);
        found.iter_mut().for_each(|rung| rung.predicted_seconds = price(rung));
        let sum = |ladder: bool| -> f64 {
            let of = found.iter().filter(|rung| (rung.knob == Knob::Passes) == ladder);
            of.map(|rung| rung.predicted_seconds).sum()
        };
        let (ladder_s, others) = (sum(true), sum(false));
        let seeds = f64::from(asked.seeds);
        let shorter = reach.top > fewest && asked.ladder.is_none();
        if (ladder_s + others) * seeds <= seconds || !(shorter || reach.base > least) {
            if reach.top < wish.top && asked.knobs.contains(&Knob::Passes) {
                notes.push(format!("the ladder ends at {} passes, as the time allows no more", reach.top));
            }
            let others = |rung: &Rung| !matches!(rung.knob, Knob::Passes | Knob::Antialiasing);
            if reach.base < passes && found.iter().any(others) {
                notes.push(format!(
                    "other knobs are turned at {} passes instead of the scene's {}, to fit the time and the \
                     reference",
                    reach.base, passes
                ));
            }
            // A scene's own adaptive antialiasing is what grids are compared with.
            let own = matches!(scene.antialiasing, Antialiasing::Adaptive { .. });
            let kept = |rung: &Rung| rung.knob == Knob::Passes || own && rung.line == "adaptive";
            let dropped = drop_dear(&mut found, seconds / seeds, kept);
            if !dropped.is_empty() {
                notes.push(format!("left out, as they take too long: {}", dropped.join(", ")));
            }
            return Ok(Design { rungs: found, left_out, notes });
        }
        if shorter && (ladder_s > others || reach.base <= least) {
            reach.top /= 2;
            reach.base = reach.base.min(reach.top.max(least));
        } else {
            reach.base = (reach.base / 2).max(least);
        }
    }
}

/// Drops the dearest rungs until all of them take `seconds`, but none that is `kept`. Returns their names.
fn drop_dear(rungs: &mut Vec<Rung>, seconds: f64, kept: impl Fn(&Rung) -> bool) -> Vec<String> {
    let mut dropped = Vec::new();
    while rungs.iter().map(|rung| rung.predicted_seconds).sum::<f64>() > seconds {
        let others = rungs.iter().enumerate().filter(|(_, rung)| !kept(rung));
        let dearest = others.max_by(|a, b| a.1.predicted_seconds.total_cmp(&b.1.predicted_seconds));
        let Some((at, _)) = dearest else { break };
        let rung = rungs.remove(at);
        dropped.push(format!("{} {}", rung.knob.key().replace('_', " "), rung.value));
    }
    dropped
}

/// What settings take, from plans of two passes. Those that take about what the scene itself takes are not
/// planned: meshes for spheres, k, and all but the most photons and shadow rays.
fn forecast(
    loaded: &Loaded,
    options: &Options,
    rungs: &[Rung],
    progress: &dyn Progress,
) -> Result<Vec<Cost>, RenderError> {
    let options = Options { passes: Some(0..2), ..options.clone() };
    let plan = |setting: Option<Change>| -> Result<Cost, RenderError> {
        let mut changed = loaded.clone();
        if let Some(change) = setting {
            change.apply(&mut changed.scene, Path::new(""));
        }
        let planned = render::plan(&changed, &options, &Silent)?;
        let traced: f64 = planned.stages.iter().filter(|s| s.name == "trace").map(|s| s.seconds).sum();
        Ok(Cost { setting, fixed: planned.seconds - traced, pass: 0.5 * traced })
    };
    let most = |of: fn(Change) -> Option<u32>| rungs.iter().filter_map(|rung| of(rung.change?)).max();
    let photons = most(|change| if let Change::Photons(n) = change { Some(n) } else { None });
    let rays = most(|change| if let Change::ShadowRays(n) = change { Some(n) } else { None });
    let alike = |change: Change| match change {
        Change::Antialiasing(_) => false,
        Change::K(_) | Change::Mesh(_) => true,
        Change::Photons(n) => Some(n) < photons,
        Change::ShadowRays(n) => Some(n) < rays,
    };
    progress.start("forecast", rungs.len() as u64, "settings");
    let own = plan(None)?;
    let mut costs = vec![Cost { ..own }];
    for rung in rungs {
        progress.advance(1);
        if costs.iter().any(|cost| cost.setting == rung.change) {
            continue;
        }
        costs.push(match rung.change {
            Some(change) if !alike(change) => plan(rung.change)?,
            setting => Cost { setting, ..own },
        });
    }
    progress.finish();
    Ok(costs)
}
