//! How long each part of a path takes, from a few samples that are timed.
//!
//! Every `every`-th sample of a tile reads the clock where its path goes from one part to another; the
//! others pay a branch. Clocks change no value.

use std::sync::OnceLock;
use std::time::Instant;

/// What a sample's time goes to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Part {
    /// From the eye to the first surface, its material, and the film.
    #[default]
    Camera,
    /// Whatever follows a first reflection, or a first refraction.
    Reflection,
    Refraction,
    /// Paths on from diffuse surfaces.
    Bounce,
    /// Lights sampled, with their shadow rays.
    Direct,
    /// Photons of caustics, or of indirect light, gathered.
    Caustics,
    Indirect,
}

/// Seconds by part, of the samples that were timed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spent([f64; Part::COUNT]);

impl Part {
    pub const ALL: [Part; 7] = [
        Part::Camera,
        Part::Reflection,
        Part::Refraction,
        Part::Bounce,
        Part::Direct,
        Part::Caustics,
        Part::Indirect,
    ];
    const COUNT: usize = Part::ALL.len();
}

impl Spent {
    pub fn on(&self, part: Part) -> f64 {
        self.0[part as usize]
    }

    /// The part's share of all that was timed; 0 where nothing was.
    pub fn share(&self, part: Part) -> f64 {
        let sum: f64 = self.0.iter().sum();
        if sum > 0.0 { self.on(part) / sum } else { 0.0 }
    }

    pub fn add(&mut self, other: &Spent) {
        self.0.iter_mut().zip(other.0).for_each(|(sum, seconds)| *sum += seconds);
    }
}

/// A stopwatch that runs for some samples only.
#[derive(Clone, Debug, Default)]
pub struct Watch {
    every: u32,
    samples: u32,
    running: Option<(Part, Instant)>,
    spent: Spent,
}

impl Watch {
    /// Times one sample in `every`, the first among them; none for 0.
    pub fn new(every: u32) -> Watch {
        Watch { every, ..Watch::default() }
    }

    pub fn spent(&self) -> &Spent {
        &self.spent
    }

    pub(super) fn add(&mut self, other: &Watch) {
        self.spent.add(&other.spent);
    }

    /// A sample begins.
    #[inline]
    pub(super) fn begin(&mut self) {
        if self.every == 0 {
            return;
        }
        self.end();
        if self.samples == 0 {
            self.samples = self.every;
            self.running = Some((Part::Camera, Instant::now()));
        }
        self.samples -= 1;
    }

    /// The sample's time goes to `part` from now on.
    #[inline]
    pub(super) fn enter(&mut self, part: Part) {
        if let Some((before, since)) = self.running {
            self.turn(before, since, part);
        }
    }

    #[cold]
    fn turn(&mut self, before: Part, since: Instant, part: Part) {
        let now = Instant::now();
        self.spent.0[before as usize] += ((now - since).as_secs_f64() - reading()).max(0.0);
        self.running = Some((part, now));
    }

    /// The sample ends.
    #[inline]
    pub(super) fn end(&mut self) {
        if let Some((part, since)) = self.running {
            self.turn(part, since, part);
            self.running = None;
        }
    }
}

/// Seconds that reading the clock takes.
fn reading() -> f64 {
    static READING: OnceLock<f64> = OnceLock::new();
    *READING.get_or_init(|| {
        let batch = || {
            let start = Instant::now();
            (0..READINGS).for_each(|_| {
                std::hint::black_box(Instant::now());
            });
            start.elapsed().as_secs_f64() / f64::from(READINGS + 1)
        };
        (0..8).map(|_| batch()).fold(f64::INFINITY, f64::min)
    })
}

const READINGS: u32 = 31;

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    /// Waiting in a part counts to it, and to no other; samples in between are not timed.
    #[test]
    fn time_goes_to_the_part_that_spends_it() {
        let mut watch = Watch::new(2);
        let wait = |ms| std::thread::sleep(Duration::from_millis(ms));
        watch.begin();
        watch.enter(Part::Direct);
        wait(20);
        watch.enter(Part::Camera);
        watch.begin();
        watch.enter(Part::Caustics);
        wait(20);
        watch.begin();
        watch.enter(Part::Reflection);
        wait(5);
        watch.end();
        let spent = watch.spent();
        assert!(spent.on(Part::Direct) >= 0.02 && spent.on(Part::Reflection) >= 0.005, "{spent:?}");
        assert_eq!(spent.on(Part::Caustics), 0.0);
        assert!(spent.share(Part::Direct) > 0.5);
    }
}
