//! What each effect really costs and brings: the scene rendered without it.

use super::{Difference, compare};
use crate::description::Loaded;
use crate::plan::{Decision, Effect};
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

/// Renders the scene as it is, and without each effect that is on and can be left out. Seeds stay the same:
/// what differs is the effect's.
pub fn prices(
    loaded: &Loaded,
    options: &Options,
    decisions: &[Decision],
    progress: &dyn Progress,
) -> Result<Prices, RenderError> {
    let whole = render::render(loaded, options, progress)?;
    let mut left_out = Vec::new();
    for effect in decisions.iter().filter(|d| d.on && d.effect != Effect::NestedMedia).map(|d| d.effect) {
        let mut without = options.clone();
        without.overrides.without.push(effect);
        let part = render::render(loaded, &without, progress)?;
        let Difference { relative_rms, mean_change, same } =
            compare(&part.image, &whole.image).expect("two images of one scene");
        left_out.push(LeftOut { effect, seconds: seconds(&part.stats), relative_rms, mean_change, same });
    }
    Ok(Prices { seconds: seconds(&whole.stats), left_out })
}

fn seconds(stats: &render::Stats) -> f64 {
    stats.stages.iter().map(|stage| stage.seconds).sum()
}
