//! Rules that end a render before its last pass: a time, an error.
//!
//! The time is that of the whole process. Tiles of a last pass that would come too late are left as they
//! are: a pixel's value is the mean of the passes that it has, and which those are does not depend on what
//! they found. The error is looked at after 4 passes and then where it is likely to be reached, and never
//! before half as many more were traced.

use super::{Options, Progress};
use crate::film::Film;
use crate::plan::{FEWEST, Plan, Until};
use std::time::{Duration, Instant};

pub(super) struct Stop {
    until: Until,
    /// When tracing has to end, so that the images can be written.
    deadline: Option<Instant>,
    pass_began: Instant,
    slowest_pass: Duration,
    check_at: u32,
}

/// Seconds kept for writing the images: at the least, and by value of the image.
const WRITING: (f64, f64) = (0.02, 60e-9);

impl Stop {
    pub fn new(plan: &Plan, options: &Options, film: &Film) -> Stop {
        let now = Instant::now();
        let values = f64::from(film.width) * f64::from(film.height) * (3 + 3 * options.aovs.len()) as f64;
        let deadline = plan.until.seconds.map(|seconds| {
            let left = (seconds - WRITING.0 - WRITING.1 * values).max(0.0);
            options.began.unwrap_or(now) + Duration::from_secs_f64(left)
        });
        Stop { until: plan.until, deadline, pass_began: now, slowest_pass: Duration::ZERO, check_at: FEWEST }
    }

    /// Whether tiles would come too late. The first pass is always traced.
    pub fn is_late(&self) -> bool {
        !self.slowest_pass.is_zero() && self.deadline.is_some_and(|deadline| Instant::now() >= deadline)
    }

    /// Whether photons for another pass would be of use.
    pub fn allows_another(&self) -> bool {
        self.deadline.is_none_or(|deadline| Instant::now() + self.slowest_pass < deadline)
    }

    /// Whether `passes` passes are enough.
    pub fn now(&mut self, passes: u32, film: &Film, progress: &dyn Progress) -> bool {
        let now = Instant::now();
        self.slowest_pass = self.slowest_pass.max(now - self.pass_began);
        self.pass_began = now;
        if self.deadline.is_some_and(|deadline| now >= deadline) {
            return true;
        }
        let Some(target) = self.until.error.filter(|_| passes >= self.check_at) else { return false };
        let Some(accuracy) = film.accuracy() else { return false };
        progress.error(accuracy.error, target);
        if accuracy.error <= target {
            return true;
        }
        let likely = accuracy.passes_for(target).ceil().min(f64::from(u32::MAX / 4)) as u32;
        self.check_at = likely.clamp(passes + passes.div_ceil(2), 4 * passes);
        false
    }
}
