//! The rungs of a study: which values each knob takes in this scene, or why it takes none.

use super::change::{has_samples, spelt};
use super::record::{LeftOut, Rung};
use super::{Change, Knob, sphere_mesh};
use crate::description::{Antialiasing, Scene};
use crate::plan::{Effect, PhotonBudget, PhotonEngine, Plan};

/// How far the ladders go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reach {
    /// The most passes of the ladder of passes: a power of 2.
    pub top: u32,
    /// The passes that rungs of other knobs have.
    pub base: u32,
}

/// Sides of the grid that a rung of `progressive` antialiasing has as many samples as.
const SIDES: [u32; 3] = [2, 4, 8];

/// The rungs of these knobs, and the knobs that have nothing to change.
pub fn ladder(scene: &Scene, plan: &Plan, knobs: &[Knob], reach: Reach) -> (Vec<Rung>, Vec<LeftOut>) {
    let (mut rungs, mut left_out) = (Vec::new(), Vec::new());
    for knob in knobs {
        let found = match knob {
            Knob::Passes => passes(scene, plan, reach),
            Knob::Photons => photons(scene, plan, reach),
            Knob::K => k(scene, plan, reach),
            Knob::Antialiasing => Ok(antialiasing(scene, reach)),
            Knob::Threshold => threshold(scene, reach),
            Knob::Depth => depth(scene, reach),
            Knob::ShadowRays => shadow_rays(scene, plan, reach),
            Knob::Mesh => mesh(scene, reach),
        };
        match found {
            Ok(found) => rungs.extend(found),
            Err(reason) => left_out.push(LeftOut { knob: *knob, reason }),
        }
    }
    (rungs, left_out)
}

fn rung(scene: &Scene, knob: Knob, value: String, x: f64, passes: u32, change: Option<Change>) -> Rung {
    let plain: String =
        value.chars().map(|c| if c.is_ascii_alphanumeric() || c == '.' { c } else { '-' }).collect();
    let mut name = format!("{}-{}", knob.key(), plain.trim_matches('-'));
    while name.contains("--") {
        name = name.replace("--", "-");
    }
    Rung {
        name,
        knob,
        line: knob.key().to_owned(),
        value,
        x: Some(x),
        passes,
        change,
        set: change.map_or_else(Vec::new, |change| change.set(scene)),
        predicted_seconds: 0.0,
        runs: Vec::new(),
        result: None,
    }
}

/// A rung for each number.
fn numbers(
    scene: &Scene,
    knob: Knob,
    passes: u32,
    values: impl IntoIterator<Item = u32>,
    change: impl Fn(u32) -> Change,
) -> Vec<Rung> {
    let mut values: Vec<u32> = values.into_iter().collect();
    values.sort_unstable();
    values.dedup();
    let of = |n: u32| rung(scene, knob, n.to_string(), f64::from(n), passes, Some(change(n)));
    values.into_iter().map(of).collect()
}

/// Whether passes differ by more than what roulette does to branches of little weight.
pub fn passes_differ(scene: &Scene, plan: &Plan) -> bool {
    let by_chance =
        [Effect::SoftShadows, Effect::Caustics, Effect::Indirect, Effect::DepthOfField, Effect::Environment];
    scene.antialiasing == Antialiasing::Progressive || by_chance.iter().any(|effect| plan.is_on(*effect))
}

fn passes(scene: &Scene, plan: &Plan, reach: Reach) -> Result<Vec<Rung>, String> {
    if !passes_differ(scene, plan) {
        return Err(format!(
            "every pass is all but the same: with `antialiasing: {}` and nothing blurred, only branches of little \
             weight are left to chance",
            spelt(scene.antialiasing)
        ));
    }
    let ladder = (0..).map(|i| 1u32 << i).take_while(|n| *n <= reach.top);
    Ok(ladder.map(|n| rung(scene, Knob::Passes, n.to_string(), f64::from(n), n, None)).collect())
}

/// The budget of photons that runs, of caustics or of indirect light; or why there is none.
pub fn budget(plan: &Plan) -> Result<PhotonBudget, String> {
    plan.photon_budgets().next().ok_or_else(|| {
        let why = plan.decisions.iter().find(|decision| decision.effect == Effect::Caustics);
        format!("no photons are sent: {}", why.map_or_else(String::new, ToString::to_string))
    })
}

fn photons(scene: &Scene, plan: &Plan, reach: Reach) -> Result<Vec<Rung>, String> {
    let count = budget(plan)?.count;
    let values = [count / 16, count / 4, count, count.saturating_mul(4)].map(|n| n.clamp(1, 100_000_000));
    Ok(numbers(scene, Knob::Photons, reach.base, values, Change::Photons))
}

fn k(scene: &Scene, plan: &Plan, reach: Reach) -> Result<Vec<Rung>, String> {
    let (PhotonEngine::Progressive { k, .. } | PhotonEngine::Classic { k }) = budget(plan)?.engine;
    let values = [k / 4, k / 2, k, k.saturating_mul(2), k.saturating_mul(4)].map(|n| n.clamp(2, 10_000));
    Ok(numbers(scene, Knob::K, reach.base, values, Change::K))
}

/// The scene's own adaptive antialiasing, or else the default one.
fn adaptive(scene: &Scene) -> (f64, u32) {
    match scene.antialiasing {
        Antialiasing::Adaptive { threshold, depth } => (threshold, depth),
        _ => (0.1, 2),
    }
}

/// One pass of each kind that makes do with one, and progressive passes of as many samples.
fn antialiasing(scene: &Scene, reach: Reach) -> Vec<Rung> {
    let kind = |kind: Antialiasing, line: &str, value: String, x: f64, passes: u32| {
        let change = Some(Change::Antialiasing(kind));
        let mut rung = rung(scene, Knob::Antialiasing, value, x, passes, change);
        line.clone_into(&mut rung.line);
        rung
    };
    let grid = |n: u32| kind(Antialiasing::Grid(n), "grid", format!("grid({n})"), f64::from(n), 1);
    let (threshold, depth) = adaptive(scene);
    let fine = Antialiasing::Adaptive { threshold, depth };
    let mut rungs = vec![kind(Antialiasing::None, "grid", "none".to_owned(), 1.0, 1)];
    rungs.extend([2, 3, 4, 8].map(grid));
    rungs.push(kind(fine, "adaptive", spelt(fine).replace("threshold: ", "").replace("depth: ", ""), 1.0, 1));
    // The reference limits the passes of a progressive scene.
    let most = match scene.antialiasing {
        Antialiasing::Progressive => reach.top.max(SIDES[0] * SIDES[0]),
        _ => u32::MAX,
    };
    for side in SIDES.into_iter().filter(|side| side * side <= most) {
        let value = format!("progressive, {} passes", side * side);
        rungs.push(kind(Antialiasing::Progressive, "progressive", value, f64::from(side), side * side));
    }
    rungs
}

/// The scene's adaptive antialiasing, or why it has none.
fn own_adaptive(scene: &Scene) -> Result<(f64, u32), String> {
    match scene.antialiasing {
        Antialiasing::Adaptive { threshold, depth } => Ok((threshold, depth)),
        other => Err(format!("the scene's antialiasing is `{}`, not `adaptive`", spelt(other))),
    }
}

fn threshold(scene: &Scene, reach: Reach) -> Result<Vec<Rung>, String> {
    let (threshold, depth) = own_adaptive(scene)?;
    let mut values: Vec<f64> = [4.0, 2.0, 1.0, 0.5, 0.25].map(|times| (threshold * times).min(1.0)).to_vec();
    values.dedup();
    let of = |threshold: f64| {
        let change = Change::Antialiasing(Antialiasing::Adaptive { threshold, depth });
        rung(scene, Knob::Threshold, threshold.to_string(), threshold, reach.base, Some(change))
    };
    Ok(values.into_iter().filter(|threshold| *threshold > 0.0).map(of).collect())
}

fn depth(scene: &Scene, reach: Reach) -> Result<Vec<Rung>, String> {
    let (threshold, own) = own_adaptive(scene)?;
    let of = |depth: u32| {
        let change = Change::Antialiasing(Antialiasing::Adaptive { threshold, depth });
        rung(scene, Knob::Depth, depth.to_string(), f64::from(1u32 << depth), reach.base, Some(change))
    };
    Ok((1..=own.clamp(4, 8)).map(of).collect())
}

fn shadow_rays(scene: &Scene, plan: &Plan, reach: Reach) -> Result<Vec<Rung>, String> {
    if !plan.is_on(Effect::SoftShadows) {
        let why = plan.decisions.iter().find(|decision| decision.effect == Effect::SoftShadows);
        return Err(why.map_or_else(String::new, ToString::to_string));
    }
    if !scene.lights.iter().any(|(_, light)| has_samples(light)) {
        return Err(
            "only objects with `emission` have an extent, and their shadow rays can't be set".to_owned()
        );
    }
    Ok(numbers(scene, Knob::ShadowRays, reach.base, [1, 4, 16, 64], Change::ShadowRays))
}

fn mesh(scene: &Scene, reach: Reach) -> Result<Vec<Rung>, String> {
    if sphere_mesh::spheres(scene) == 0 {
        let why = "no object or definition is a sphere by itself, which a mesh could stand for";
        return Err(why.to_owned());
    }
    Ok(numbers(scene, Knob::Mesh, reach.base, [16, 32, 64, 128], Change::Mesh))
}
