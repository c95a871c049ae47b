//! What a more accurate picture would cost.

use crate::film::Accuracy;
use crate::plan::{Antialiasing, PhotonEngine, Plan};
use serde::Serialize;

/// The price of half the error, at the rates at which it has fallen so far.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Next {
    pub error: f64,
    /// Passes in all.
    pub passes: f64,
    /// Wall time beyond that of this render.
    pub seconds: f64,
    /// By effect, the factor in passes that halves its own error.
    pub by_effect: Vec<Factor>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Factor {
    pub effect: &'static str,
    pub passes: f64,
}

impl Next {
    /// After `done` passes, each of which takes `seconds` of wall time. `None` where there is no error.
    pub fn after(done: f64, accuracy: &Accuracy, seconds: f64) -> Option<Next> {
        let error = 0.5 * accuracy.error_after(done);
        let passes = accuracy.passes_for(error);
        let by_effect = accuracy.by_effect.iter().map(|part| {
            let alone = Accuracy {
                error: part.noise.hypot(part.bias),
                noise: part.noise,
                bias: part.bias,
                by_effect: vec![part.clone()],
                ..accuracy.clone()
            };
            Factor { effect: part.effect, passes: alone.passes_for(0.5 * alone.error_after(done)) / done }
        });
        let by_effect = by_effect.collect();
        let seconds = (passes - done) * seconds;
        (error > 0.0 && passes.is_finite()).then_some(Next { error, passes, seconds, by_effect })
    }
}

/// What no pass of this plan shows of its error, in words.
pub fn not_seen(plan: &Plan) -> Vec<String> {
    let mut list = Vec::new();
    let samples = match plan.antialiasing {
        Antialiasing::Progressive => None,
        Antialiasing::None => Some("a pixel's one sample is always at its centre"),
        Antialiasing::Grid(_) => Some("a pixel's samples always lie on the same grid"),
        Antialiasing::Adaptive { .. } => Some("adaptive samples always begin at the same corners"),
    };
    list.extend(samples.map(str::to_owned));
    if plan.photon_budgets().any(|budget| matches!(budget.engine, PhotonEngine::Classic { .. })) {
        list.push("all passes gather the same photons".to_owned());
    }
    if plan.bounces != 0 && plan.bounces != u32::MAX {
        list.push(format!("light of more than {} bounces is left out", plan.bounces));
    }
    list
}
