//! Counters for events that should be rare, each with the frequency that is still healthy.
//!
//! Counters travel with the work that they describe and are summed; nothing is global.

use super::Color;
use serde::{Deserialize, Serialize};
use std::fmt;

/// An event that should be rare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rare {
    /// A sample with NaN or infinity in it, or more than can be added up: dropped, counted and located.
    NonFiniteSample,
    /// More overlapping transmissive objects at one point than a path keeps track of.
    MediaOverflow,
    /// A shading normal that sent a mirrored or refracted direction through the surface.
    DirectionThroughSurface,
    /// A photon with NaN or infinity in it: left out and counted.
    NonFinitePhoton,
}

impl Rare {
    pub const ALL: [Rare; 4] =
        [Rare::NonFiniteSample, Rare::MediaOverflow, Rare::DirectionThroughSurface, Rare::NonFinitePhoton];

    /// The share of trials up to which the event is healthy.
    pub fn allowed(self) -> f64 {
        match self {
            Rare::NonFiniteSample | Rare::NonFinitePhoton | Rare::MediaOverflow => 0.0,
            Rare::DirectionThroughSurface => 0.02,
        }
    }

    pub fn name(self) -> &'static str {
        match self {
            Rare::NonFiniteSample => "non-finite samples",
            Rare::NonFinitePhoton => "non-finite photons",
            Rare::MediaOverflow => "media overflows",
            Rare::DirectionThroughSurface => "directions through the surface",
        }
    }
}

/// Where a non-finite sample was dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Place {
    pub x: u32,
    pub y: u32,
    pub pass: u32,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "pixel ({}, {}), pass {}", self.x, self.y, self.pass)
    }
}

/// Counts of rare events, with the number of trials they are a share of.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Health {
    counts: [u64; Rare::ALL.len()],
    /// Camera samples, and photons that were sent out: together what every event is a share of.
    pub samples: u64,
    pub photons: u64,
    /// The first few places of non-finite samples.
    pub places: Vec<Place>,
    /// The brightest channel of all finite samples, W·m⁻²·sr⁻¹.
    #[serde(default)]
    pub brightest: f32,
}

/// Places kept; the count goes on.
const PLACES: usize = 16;

impl Health {
    pub fn count(&mut self, event: Rare) {
        self.counts[event as usize] += 1;
    }

    pub fn count_many(&mut self, event: Rare, times: u64) {
        self.counts[event as usize] += times;
    }

    pub fn non_finite(&mut self, place: Place) {
        self.count(Rare::NonFiniteSample);
        if self.places.len() < PLACES && !self.places.contains(&place) {
            self.places.push(place);
        }
    }

    /// Looks at a finite sample's radiance.
    #[inline]
    pub fn see(&mut self, radiance: Color) {
        let brightest = radiance.max_element();
        // Not `max`, which would look for what is not a number.
        if brightest > self.brightest {
            self.brightest = brightest;
        }
    }

    pub fn of(&self, event: Rare) -> u64 {
        self.counts[event as usize]
    }

    pub fn add(&mut self, other: &Health) {
        for (sum, count) in self.counts.iter_mut().zip(other.counts) {
            *sum += count;
        }
        self.samples += other.samples;
        self.photons += other.photons;
        self.brightest = self.brightest.max(other.brightest);
        for place in &other.places {
            if self.places.len() < PLACES && !self.places.contains(place) {
                self.places.push(*place);
            }
        }
    }

    /// Paths from the eye and from lights: what events are a share of.
    pub fn trials(&self) -> u64 {
        self.samples + self.photons
    }

    /// Events above their healthy share.
    pub fn excesses(&self) -> impl Iterator<Item = (Rare, u64)> {
        Rare::ALL.into_iter().filter_map(|event| {
            let count = self.of(event);
            (count as f64 > event.allowed() * self.trials() as f64).then_some((event, count))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One more than the allowed share is an excess, the share itself is not; sums are those of the parts.
    #[test]
    fn events_above_their_share_are_excesses() {
        for event in Rare::ALL {
            let (samples, photons) = (300, 200);
            let allowed = (event.allowed() * 500.0) as u64;
            let mut health = Health { samples, photons, ..Health::default() };
            health.count_many(event, allowed);
            assert_eq!(health.excesses().count(), 0, "{}", event.name());
            let mut one = Health::default();
            one.count(event);
            health.add(&one);
            assert_eq!(health.excesses().collect::<Vec<_>>(), [(event, allowed + 1)]);
            assert_eq!((health.trials(), health.of(event)), (500, allowed + 1));
        }
    }

    #[test]
    fn the_first_places_are_kept_and_all_are_counted() {
        let mut health = Health::default();
        for x in 0..100 {
            let mut tile = Health::default();
            tile.non_finite(Place { x, y: 0, pass: 0 });
            health.add(&tile);
        }
        let kept: Vec<u32> = health.places.iter().map(|place| place.x).collect();
        assert_eq!(kept, (0..PLACES as u32).collect::<Vec<_>>());
        assert_eq!(health.of(Rare::NonFiniteSample), 100);
    }
}
