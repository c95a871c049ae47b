//! Which part of an image's work is done here: some of its passes, or some of its tiles.

use super::{Options, RenderError};
use crate::film::Window;
use crate::optics::Camera;
use crate::plan::Plan;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Some of the `of` parts that a render is divided into, by number from 0 on, in rising order.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shards {
    pub numbers: Vec<u32>,
    pub of: u32,
}

/// What a render is divided by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum By {
    Passes,
    Tiles,
}

impl By {
    /// Passes, where each part gets one at least.
    pub fn of(shards: &Shards, plan: &Plan) -> By {
        if plan.passes >= shards.of { By::Passes } else { By::Tiles }
    }
}

impl Shards {
    /// Refuses numbers that are not there, and rules that end a render before its last pass.
    pub(super) fn check(&self, plan: &Plan) -> Result<(), RenderError> {
        let invalid = |message: String| Err(RenderError::Invalid(message));
        if let Some(number) = self.numbers.iter().find(|number| **number >= self.of) {
            return invalid(format!(
                "there is no shard {number} of {}: they are numbered from 0 to {}",
                self.of,
                self.of.saturating_sub(1)
            ));
        }
        if self.numbers.is_empty() {
            return invalid("no shard is named".to_owned());
        }
        if plan.until.is_any() {
            return invalid(
                "a shard renders its share of a known number of passes: it can't end at a time or an error. \
                 Set the passes and leave `--time`, `--error`, `render.time_s` and `render.error` out"
                    .to_owned(),
            );
        }
        Ok(())
    }

    /// The stretches of a plan's passes, in order.
    pub(super) fn passes(&self, plan: &Plan) -> Vec<Range<u32>> {
        let all = plan.first_pass..plan.first_pass + plan.passes;
        if By::of(self, plan) == By::Tiles {
            return vec![all];
        }
        let start = |number: u32| {
            plan.first_pass + (u64::from(number) * u64::from(plan.passes) / u64::from(self.of)) as u32
        };
        let mut stretches: Vec<Range<u32>> = Vec::new();
        for &number in &self.numbers {
            let stretch = start(number)..start(number + 1);
            match stretches.last_mut().filter(|last| last.end == stretch.start) {
                Some(last) => last.end = stretch.end,
                None => stretches.push(stretch),
            }
        }
        stretches
    }

    /// Whether a tile is among the shards, where tiles are divided: neighbours go to different shards, as one
    /// end of a picture may take longer than the other.
    pub fn has_tile(&self, tile: usize) -> bool {
        self.numbers.binary_search(&((tile % self.of as usize) as u32)).is_ok()
    }
}

/// The stretches of passes that are traced here, in order.
pub(super) fn stretches(options: &Options, plan: &Plan) -> Vec<Range<u32>> {
    match &options.shards {
        Some(shards) => shards.passes(plan),
        None => std::iter::once(plan.first_pass..plan.first_pass + plan.passes).collect(),
    }
}

/// How much is traced here.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Work {
    pub passes: u32,
    /// Of each pass.
    pub pixels: f64,
}

impl Work {
    pub fn of(options: &Options, plan: &Plan, camera: &Camera) -> Work {
        let window = options.crop.unwrap_or(Window::all(camera.width, camera.height));
        let pixels = window.pixels() as f64;
        match &options.shards {
            Some(shards) if By::of(shards, plan) == By::Tiles => {
                let share = shards.numbers.len() as f64 / f64::from(shards.of);
                Work { passes: plan.passes, pixels: share * pixels }
            }
            _ => {
                let passes = stretches(options, plan).iter().map(|stretch| stretch.end - stretch.start).sum();
                Work { passes, pixels }
            }
        }
    }
}

/// Passes in steps that are traced at one go.
pub(super) struct Steps {
    stretches: Vec<Range<u32>>,
    most: u32,
}

impl Steps {
    /// At most `most` passes a step, beginning with pass `begin`.
    pub fn new(mut stretches: Vec<Range<u32>>, most: u32, begin: u32) -> Steps {
        stretches.iter_mut().for_each(|stretch| stretch.start = stretch.start.max(begin));
        stretches.retain(|stretch| stretch.start < stretch.end);
        stretches.reverse();
        Steps { stretches, most }
    }

    /// Passes that are left.
    pub fn passes(&self) -> u64 {
        self.stretches.iter().map(|stretch| u64::from(stretch.end - stretch.start)).sum()
    }

    /// The pass after those that were handed out.
    pub fn peek(&self) -> Option<u32> {
        self.stretches.last().map(|stretch| stretch.start)
    }
}

impl Iterator for Steps {
    type Item = Range<u32>;

    fn next(&mut self) -> Option<Range<u32>> {
        let stretch = self.stretches.last_mut()?;
        let step = stretch.start..(stretch.start + self.most).min(stretch.end);
        stretch.start = step.end;
        if stretch.start == stretch.end {
            self.stretches.pop();
        }
        Some(step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_go_through_every_pass_once() {
        let steps = |begin| Steps::new(vec![2..13, 20..21], 4, begin).collect::<Vec<_>>();
        assert_eq!(steps(0), [2..6, 6..10, 10..13, 20..21]);
        assert_eq!(steps(12), [12..13, 20..21]);
        assert_eq!(steps(21), []);
        assert_eq!(Steps::new(vec![2..13, 20..21], 4, 15).peek(), Some(20));
    }
}
