//! Wall time by stage.

use super::StageTime;
use std::time::Instant;

/// Laps, from the moment it was made.
pub(super) struct Clock {
    pub stages: Vec<StageTime>,
    last: Instant,
}

impl Clock {
    pub fn start() -> Clock {
        Clock { stages: Vec::new(), last: Instant::now() }
    }

    /// The stage that began with the last lap is over.
    pub fn lap(&mut self, name: &str) {
        let now = Instant::now();
        let seconds = (now - self.last).as_secs_f64();
        self.last = now;
        self.stages.push(StageTime { name: name.to_owned(), seconds });
    }

    /// Seconds of a stage; 0 for one that did not run.
    pub fn of(&self, name: &str) -> f64 {
        self.stages.iter().filter(|stage| stage.name == name).map(|stage| stage.seconds).sum()
    }

    /// Seconds of all stages.
    pub fn sum(&self) -> f64 {
        self.stages.iter().map(|stage| stage.seconds).sum()
    }
}
