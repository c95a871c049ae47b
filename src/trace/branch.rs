//! A path that is still to be followed, and what an event makes of it: its weight, whether it goes on, and
//! which random values are its own.

use super::record::Fate;
use super::{Part, Tally, Tracer, bounce};
use crate::build::{Cone, MediaSet, Start};
use crate::math::random::Sequence;
use crate::math::{Color, Ray};
use std::num::NonZeroU32;

/// The first specular event of a path, which decides the layer that its light counts to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Class {
    Direct,
    Reflection,
    Refraction,
}

impl Class {
    fn then(self, event: Class) -> Class {
        if self == Class::Direct { event } else { self }
    }
}

/// A part of a path that is still to be followed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Branch {
    pub ray: Ray,
    /// The surface on which the ray starts; of no meaning at the eye.
    pub start: Start,
    pub throughput: Color,
    pub media: MediaSet,
    pub cone: Cone,
    /// Specular events in a row.
    pub depth: u32,
    /// Diffuse surfaces behind it.
    pub bounces: u32,
    /// µm, once something has dispersed.
    pub wavelength: Option<f64>,
    pub sequence: Sequence,
    pub class: Class,
    /// What it crosses where it starts, as its place in the list of these, counted from 1.
    pub entry: Option<NonZeroU32>,
}

impl Branch {
    /// What the time of following it counts to.
    pub fn part(&self) -> Part {
        match self.class {
            _ if self.bounces > 0 => Part::Bounce,
            Class::Direct => Part::Camera,
            Class::Reflection => Part::Reflection,
            Class::Refraction => Part::Refraction,
        }
    }
}

/// What becomes of a branch by an event, but for where it goes.
pub(super) struct Step {
    throughput: Color,
    depth: u32,
    sequence: Sequence,
    class: Class,
}

impl Step {
    #[inline]
    pub fn take(self, branch: &mut Branch) {
        let Step { throughput, depth, sequence, class } = self;
        (branch.throughput, branch.depth) = (throughput, depth);
        (branch.sequence, branch.class) = (sequence, class);
    }
}

/// Dimensions of a path vertex's random values.
pub(super) const LIGHTS: u64 = 1;
const ROULETTE: u64 = 2;
pub(super) const MIRROR: u64 = 3;
pub(super) const REFLECTED: u64 = 4;
pub(super) const REFRACTED: u64 = 5;

pub(super) const BOUNCE: u64 = 7;
pub(super) const COVERAGE: u64 = 8;
pub(super) const INNER: u64 = 10;
pub(super) const OUTER: u64 = 11;
pub(super) const WAVELENGTH: u64 = 9;

/// Dimensions of a camera sample.
pub(super) const LENS: u64 = 6;

impl Tracer<'_> {
    /// One event further on a branch. `None` where it ends: by chance, in proportion to its weight, or by the
    /// depth limit.
    #[inline]
    pub(super) fn step(
        &self,
        branch: &Branch,
        weight: Color,
        event: u64,
        class: Class,
        tally: &mut Tally,
    ) -> Option<Step> {
        let mut throughput = branch.throughput * weight;
        let depth = branch.depth + u32::from(event != BOUNCE);
        let sequence = branch.sequence.dimension(event);
        let heaviest = throughput.max_element();
        if heaviest <= 0.0 || heaviest.is_nan() {
            tally.note(|recorder| recorder.send(throughput, event, Fate::Weightless));
            return None;
        }
        if depth > self.plan.max_depth {
            tally.cut.paths += 1;
            tally.cut.weight += f64::from(heaviest);
            tally.note(|recorder| recorder.send(throughput, event, Fate::DepthLimit));
            return None;
        }
        let survival = if event == BOUNCE {
            bounce::survival(f64::from(heaviest), branch.bounces)
        } else {
            f64::from(heaviest) / self.plan.split_weight
        };
        if survival < 1.0 {
            if sequence.dimension(ROULETTE).value() >= survival {
                tally.note(|recorder| recorder.send(throughput, event, Fate::Roulette));
                return None;
            }
            throughput /= survival as f32;
        }
        tally.note(|recorder| recorder.send(throughput, event, Fate::Followed));
        Some(Step { throughput, depth, sequence, class: branch.class.then(class) })
    }
}
