//! When a render ends.

use crate::description::{Antialiasing, Photons, Scene};
use serde::Serialize;

/// Rules beside the number of passes; whichever comes first ends the render.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Until {
    /// Wall seconds of the whole process, from its start to the images' names.
    pub seconds: Option<f64>,
    /// The picture's relative RMS error, 0.01 for 1 %.
    pub error: Option<f64>,
}

/// What a longer time counts as, in seconds: 30 years, which clocks can add.
pub const LONGEST: f64 = 1e9;

/// Passes from which on an error can be told.
pub const FEWEST: u32 = 4;

/// Passes at most where another rule ends the render.
pub const MOST_PASSES: u32 = 1 << 20;

impl Until {
    /// `asked` before what the scene says.
    pub(super) fn of(scene: &Scene, asked: Until) -> Until {
        Until { seconds: asked.seconds.or(scene.render.time_s), error: asked.error.or(scene.render.error) }
    }

    pub fn is_any(&self) -> bool {
        self.seconds.is_some() || self.error.is_some()
    }

    /// The passes to reckon with, of at most `most`: as many as the time allows, where `spent` seconds are over
    /// and the first pass and the first two will take so many; the fewest that can tell an error.
    pub fn passes(&self, most: u32, spent: f64, first: f64, first_two: f64) -> u32 {
        let by_time = self.seconds.map(|seconds| {
            let more = (seconds - spent - first) / (first_two - first).max(f64::MIN_POSITIVE);
            1 + more.clamp(0.0, f64::from(MOST_PASSES)) as u32
        });
        let by_error = self.error.filter(|_| by_time.is_none() && most == MOST_PASSES).map(|_| FEWEST);
        most.min(by_time.or(by_error).unwrap_or(most))
    }

    /// Refuses an error that the passes of this scene could never tell.
    pub(super) fn check(&self, scene: &Scene) -> Result<(), String> {
        if self.error.is_none() {
            return Ok(());
        }
        if scene.antialiasing != Antialiasing::Progressive {
            return Err(
                "rendering to an error needs `antialiasing: progressive`: the samples of the others lie \
                        where they always lie, and what they miss shows in no pass"
                    .to_owned(),
            );
        }
        if matches!(scene.photons, Photons::Classic { .. }) {
            return Err(
                "rendering to an error needs `photons: progressive()`: one map for all passes keeps its \
                        error, and no pass shows it"
                    .to_owned(),
            );
        }
        Ok(())
    }
}
