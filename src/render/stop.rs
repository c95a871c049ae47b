//! Rules that end a render before its last pass: a time, an error.
//!
//! An error to be reached sends samples where the error is: from time to time, blocks of pixels whose own error
//! is well below it come to rest.
//!
//! The time is that of the whole process. Tiles of a last pass that would come too late are left as they
//! are: a pixel's value is the mean of the passes that it has, and which those are does not depend on what
//! they found. The error is looked at after 4 passes and then where it is likely to be reached, and never
//! before half as many more were traced.

use super::{Options, Progress};
use crate::film::Film;
use crate::plan::{FEWEST, LONGEST, Plan, Until};
use crate::trace::Resting;
use serde::{Deserialize, Serialize};
use std::time::{Duration, Instant};

pub(super) struct Stop {
    until: Until,
    /// When tracing has to end, so that the images can be written.
    deadline: Option<Instant>,
    pass_began: Instant,
    slowest_pass: Duration,
    check_at: u32,
    resting: Option<Resting>,
    /// Passes after which the error is likely to be found to be reached.
    likely: Option<u32>,
}

/// Blocks may rest after this many passes, and twice as many, and so on: full parts of a sequence that is well
/// distributed.
const FIRST_REST: u32 = 16;

/// The part of the squared error to be reached that a block which rests may have.
const SETTLED: f64 = 0.5;

/// Seconds kept for writing the images: at the least, and by value of the image.
const WRITING: (f64, f64) = (0.02, 60e-9);

/// What a render that goes on later has to know.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct StopState {
    check_at: u32,
    /// Blocks that rest.
    resting: Vec<usize>,
}

impl Stop {
    /// As it has to be known later; `None` where it has not.
    pub fn state(&self) -> Option<StopState> {
        let blocks = self.resting.as_ref()?.blocks();
        let resting = (0..blocks.len()).filter(|block| blocks[*block]).collect();
        Some(StopState { check_at: self.check_at, resting })
    }

    /// Goes on where another run stopped.
    pub fn resume(&mut self, state: &StopState) {
        self.check_at = state.check_at;
        if let Some(resting) = &mut self.resting {
            let blocks = resting.blocks().len();
            state.resting.iter().filter(|block| **block < blocks).for_each(|block| resting.rest(*block));
        }
    }

    pub fn new(plan: &Plan, options: &Options, film: &Film) -> Stop {
        let now = Instant::now();
        let values = film.window.pixels() as f64 * (3 + 3 * options.aovs.len()) as f64;
        let deadline = plan.until.seconds.map(|seconds| {
            let left = (seconds - WRITING.0 - WRITING.1 * values).max(0.0);
            options.began.unwrap_or(now) + Duration::from_secs_f64(left.min(LONGEST))
        });
        let resting = plan.until.error.map(|_| Resting::none(film.width, film.height));
        let slowest_pass = Duration::ZERO;
        Stop {
            until: plan.until,
            deadline,
            pass_began: now,
            slowest_pass,
            check_at: FEWEST,
            resting,
            likely: None,
        }
    }

    /// Whether tiles would come too late. The first pass is always traced.
    pub fn is_late(&self) -> bool {
        !self.slowest_pass.is_zero() && self.deadline.is_some_and(|deadline| Instant::now() >= deadline)
    }

    /// Whether photons for another pass would be of use.
    pub fn allows_another(&self) -> bool {
        self.deadline.is_none_or(|deadline| Instant::now() + self.slowest_pass < deadline)
    }

    /// Passes in all after which the error is likely to be reached, once that is known.
    pub fn likely(&self) -> Option<u32> {
        self.likely
    }

    /// Pixels that need no more passes.
    pub fn resting(&self) -> Option<&Resting> {
        self.resting.as_ref()
    }

    /// Whether `passes` passes are enough.
    pub fn now(&mut self, passes: u32, film: &Film, progress: &dyn Progress) -> bool {
        let now = Instant::now();
        self.slowest_pass = self.slowest_pass.max(now - self.pass_began);
        self.pass_began = now;
        if self.deadline.is_some_and(|deadline| now >= deadline) {
            return true;
        }
        let Some(target) = self.until.error else { return false };
        let rests = passes >= FIRST_REST && passes.is_power_of_two();
        let looks = passes >= self.check_at;
        let Some(accuracy) = (rests || looks).then(|| film.accuracy()).flatten() else { return false };
        if looks {
            progress.error(accuracy.error, target);
        }
        let target = accuracy.aim(target);
        if accuracy.error <= target {
            return true;
        }
        if let Some(resting) = self.resting.as_mut().filter(|_| rests) {
            film.rest(&accuracy, SETTLED * target * target, resting);
            if resting.all() {
                *resting = Resting::none(film.width, film.height);
            }
        }
        if !looks {
            return false;
        }
        let likely = accuracy.passes_for(target).ceil().min(f64::from(u32::MAX / 4)) as u32;
        self.check_at = likely.clamp(passes + passes.div_ceil(2), 4 * passes);
        self.likely = Some(likely.max(self.check_at));
        false
    }
}

/// How much later than its time a render may end: seconds, and a share.
const LATE: (f64, f64) = (0.5, 0.03);

/// A warning where the first pass alone took longer than there was.
pub(super) fn exceeded(plan: &Plan, options: &Options, passes: u32) -> Option<String> {
    let (limit, began) = (plan.until.seconds?, options.began?);
    let taken = began.elapsed().as_secs_f64();
    (passes <= 1 && taken > limit + LATE.0.max(LATE.1 * limit)).then(|| {
        format!(
            "the first pass, of which no tile may be missing, ended after {taken:.1} s: more than the {limit} s that were \
             given; a smaller image or fewer photons (photons.count) take less"
        )
    })
}
