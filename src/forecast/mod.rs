//! What a render will take, before it is rendered: seconds by stage and by effect, rays, memory.
//!
//! Nothing is assumed of the machine. A few blocks of pixels are traced as the render itself will trace
//! them, with the first pass's photons, on all threads; their time by pixel, times the pixels and passes,
//! is the forecast of tracing. What has been done by then (building, pilots, the first photons) is
//! measured. Memory is what the process holds by then and what is still to come.

pub mod memory;
mod pilot;

use crate::trace::{Part, Rays, Spent};
pub use pilot::Pace;
use serde::Serialize;

/// A forecast, or what a finished render really took, in the same terms.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Cost {
    /// Wall time of what is left when the forecast is made: tracing, and the photons of later passes.
    pub seconds: f64,
    /// The same by what it is spent on.
    pub bill: Bill,
    /// Camera samples.
    pub samples: u64,
    pub rays: Rays,
}

/// Wall time by what it is spent on.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Bill(pub Vec<Price>);

/// One row of a bill.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Price {
    /// `camera` (to the first surface, with its material), or an effect's key.
    pub effect: &'static str,
    /// Wall time.
    pub seconds: f64,
}

/// Time of one thread that photons take, by what they are for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PhotonSeconds {
    pub caustics: f64,
    pub indirect: f64,
}

impl PhotonSeconds {
    pub fn sum(&self) -> f64 {
        self.caustics + self.indirect
    }

    pub fn times(&self, factor: f64) -> PhotonSeconds {
        PhotonSeconds { caustics: self.caustics * factor, indirect: self.indirect * factor }
    }
}

impl Cost {
    /// Of so many passes over `pixels` pixels, where the photons of each but the first take `photons`.
    pub fn forecast(pace: &Pace, pixels: f64, photons: PhotonSeconds, passes: u32) -> Cost {
        let pixels = pixels * f64::from(passes);
        let later = photons.times(f64::from(passes.saturating_sub(1)));
        let count = |of: f64| (of * pixels).round() as u64;
        let threads = rayon::current_num_threads() as f64;
        Cost {
            seconds: (pace.seconds * pixels + later.sum()) / threads,
            bill: Bill::new(&pace.spent, pace.seconds * pixels / threads, later.times(1.0 / threads)),
            samples: count(pace.samples),
            rays: pace.rays.map(count),
        }
    }
}

impl Bill {
    /// `seconds` of tracing, divided as the timed samples were, and the photons' own.
    pub fn new(spent: &Spent, seconds: f64, photons: PhotonSeconds) -> Bill {
        let mut bill = Bill::default();
        for (effect, part) in [
            ("camera", Part::Camera),
            ("direct", Part::Direct),
            ("reflection", Part::Reflection),
            ("refraction", Part::Refraction),
            ("caustics", Part::Caustics),
            ("indirect", Part::Bounce),
            ("indirect", Part::Indirect),
        ] {
            bill.add(effect, seconds * spent.share(part));
        }
        bill.add_photons(photons);
        bill
    }

    pub fn add_photons(&mut self, photons: PhotonSeconds) {
        self.add("caustics", photons.caustics);
        self.add("indirect", photons.indirect);
    }

    fn add(&mut self, effect: &'static str, seconds: f64) {
        if seconds <= 0.0 {
            return;
        }
        match self.0.iter_mut().find(|price| price.effect == effect) {
            Some(price) => price.seconds += seconds,
            None => self.0.push(Price { effect, seconds }),
        }
    }

    /// Seconds of an effect; 0 where it has no row.
    pub fn of(&self, effect: &str) -> f64 {
        self.0.iter().filter(|price| price.effect == effect).map(|price| price.seconds).sum()
    }
}
