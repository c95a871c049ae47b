//! What is said of rare events, of this run and of the parts before it.

use super::RenderError;
use super::kept::Counts;
use crate::math::{Exact, Health, Place, Rare};

/// A warning for each event above its healthy share.
pub fn warnings(health: &Health) -> Vec<String> {
    let warning = |(event, count): (Rare, u64)| {
        let places: Vec<String> = health.places.iter().take(3).map(ToString::to_string).collect();
        let at = if event == Rare::NonFiniteSample {
            format!(" (beyond 3.5e13 counts as infinite), first at {}{}", places.join("; "), replayed(health))
        } else {
            String::new()
        };
        format!(
            "{}: {count} in {} paths, more than {} is unhealthy{at}",
            event.name(),
            health.trials(),
            event.allowed()
        )
    };
    health.excesses().map(warning).chain(faint(health)).collect()
}

/// A picture darker than this has fewer than 24 bits over the unit of [`Exact`] sums.
const FAINT: f32 = 1.0 / (1u64 << 36) as f32;

/// A warning where the sums' unit shows.
fn faint(health: &Health) -> Option<String> {
    let brightest = health.brightest;
    (0.0 < brightest && brightest < FAINT).then(|| {
        format!(
            "the brightest sample has a radiance of {brightest:.2e}, and pixels are summed in steps of {:.1e}: \
             they are coarse, or black; give lights and emission {:.0e} times as much",
            Exact::UNIT,
            1.0 / brightest
        )
    })
}

/// A warning where the depth limit has cut paths.
pub(super) fn cut(counts: &Counts, max_depth: u32) -> Option<String> {
    (counts.cut_paths > 0).then(|| {
        format!(
            "{} paths were cut after {max_depth} specular events in a row (render.max_depth), {:.2e} of all weight",
            counts.cut_paths,
            counts.cut_weight / counts.health.samples as f64
        )
    })
}

/// How the first sample that was dropped can be looked at.
fn replayed(health: &Health) -> String {
    let Some(Place { x, y, pass }) = health.places.first() else { return String::new() };
    format!("; `terrarium render` with `--pixel {x},{y} --pass {pass}` replays the first")
}

/// For `--strict`: what is unhealthy, if anything is.
pub fn unhealthy(health: &Health) -> Option<String> {
    let excesses: Vec<String> =
        health.excesses().map(|(event, count)| format!("{count} {}", event.name())).collect();
    let what = || format!("unhealthy: {} (--strict){}", excesses.join(", "), replayed(health));
    (!excesses.is_empty()).then(what)
}

pub(super) fn refuse_excesses(health: &Health) -> Result<(), RenderError> {
    unhealthy(health).map_or(Ok(()), |what| Err(RenderError::Failed(what)))
}
