//! What each effect really costs and brings: the scene rendered without it.

use super::{Difference, compare};
use crate::description::Loaded;
use crate::plan::{Decision, Effect, Overrides};
use crate::render::{self, Options, Progress, RenderError};
use serde::Serialize;

/// A whole render beside renders without one effect each.
#[derive(Clone, Debug, Serialize)]
pub struct Prices {
    /// Wall time of the render with everything, images not written.
    pub seconds: f64,
    pub left_out: Vec<LeftOut>,
}

/// A render without one effect.
#[derive(Clone, Debug, Serialize)]
pub struct LeftOut {
    pub effect: Effect,
    pub seconds: f64,
    /// How far its image is from the whole one: see [`Difference`].
    pub relative_rms: f64,
    pub mean_change: f64,
    /// Whether the images are the same, bit for bit.
    pub same: bool,
}

/// Renders the scene as it is, and without each effect that is on and can be left out, `passes` passes each.
/// Seeds stay the same: what differs is the effect's.
pub fn prices(
    loaded: &Loaded,
    options: &Options,
    passes: u32,
    decisions: &[Decision],
    progress: &dyn Progress,
) -> Result<Prices, RenderError> {
    let first = options.passes.as_ref().map_or(0, |passes| passes.start);
    let mut loaded = loaded.clone();
    (loaded.scene.render.time_s, loaded.scene.render.error) = (None, None);
    let options =
        Options { passes: Some(first..first + passes), until: Default::default(), ..options.clone() };
    let whole = render::render(&loaded, &options, progress)?;
    let mut left_out = Vec::new();
    for effect in decisions.iter().filter(|d| d.on).map(|d| d.effect) {
        let Some(overrides) = without(&options.overrides, effect) else { continue };
        let part = render::render(&loaded, &Options { overrides, ..options.clone() }, progress)?;
        let Difference { relative_rms, mean_change, same } =
            compare(&part.image, &whole.image).expect("two images of one scene");
        left_out.push(LeftOut { effect, seconds: seconds(&part.stats), relative_rms, mean_change, same });
    }
    Ok(Prices { seconds: seconds(&whole.stats), left_out })
}

/// The overrides with one more effect left out; `None` for one that has to stay.
fn without(overrides: &Overrides, effect: Effect) -> Option<Overrides> {
    let mut overrides = overrides.clone();
    overrides.with.retain(|with| *with != effect);
    if let Some(only) = &mut overrides.only
        && effect.carries_light()
    {
        only.retain(|only| *only != effect);
        // Of nothing there is no image.
        return (!only.is_empty()).then_some(overrides);
    }
    overrides.without.push(effect);
    (effect != Effect::NestedMedia).then_some(overrides)
}

fn seconds(stats: &render::Stats) -> f64 {
    stats.stages.iter().map(|stage| stage.seconds).sum()
}
