//! Four photons of a cell at a time: their random values, their directions, and where they leave a lamp.
//!
//! Photon by photon, each step would wait for the one before. What depends on more of the world is added one by one.

use super::bounds::Bound;
use super::source::{Domain, Kind, Source};
use crate::math::doubles::{Four, Wide};
use crate::math::lanes::{Lanes, Machine, Work};
use crate::math::random::Scramble;
use crate::math::{DVec2, DVec3};

pub(super) const FOUR: usize = 4;

/// Where a photon leaves a lamp.
#[derive(Clone, Copy, Debug)]
pub(super) struct Left {
    pub p: DVec3,
    pub n: DVec3,
    /// What this point stands for, of the lamp's parameters.
    pub share: f64,
    pub uv: DVec2,
}

/// What is known of four photons before they leave.
pub(super) struct Quartet {
    /// Two pairs of [0, 1).
    u: [[Four; 2]; 2],
    dir: [DVec3; FOUR],
    /// Where they leave a round lamp or a quad, if they do.
    left: Option<[Option<Left>; FOUR]>,
}

/// One of them.
#[derive(Clone, Copy)]
pub(super) struct Drawn {
    pub u: [[f64; 2]; 2],
    /// In the cell, where it is one of directions.
    pub dir: DVec3,
    pub left: Option<Option<Left>>,
}

impl Quartet {
    /// The photons from `index` on.
    pub fn new(
        source: &Source,
        targets: &[Bound],
        domain: &Domain,
        scrambles: &[Scramble; 2],
        index: u32,
    ) -> Quartet {
        Machine::detect().run(Draw { source, targets, domain, scrambles, index })
    }

    #[inline]
    pub fn at(&self, lane: usize) -> Drawn {
        let [[a, b], [c, d]] = &self.u;
        Drawn {
            u: [[a[lane], b[lane]], [c[lane], d[lane]]],
            dir: self.dir[lane],
            left: self.left.as_ref().map(|left| left[lane]),
        }
    }
}

struct Draw<'a> {
    source: &'a Source,
    targets: &'a [Bound],
    domain: &'a Domain,
    scrambles: &'a [Scramble; 2],
    index: u32,
}

impl Work for Draw<'_> {
    type Output = Quartet;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Quartet {
        let l = l.doubles();
        let u = [self.scrambles[0].pairs(self.index), self.scrambles[1].pairs(self.index)];
        let mut quartet = Quartet { u, dir: [DVec3::ZERO; FOUR], left: None };
        if let Domain::Directions(cell) = self.domain {
            let dir = cell.sample_four(l, [Wide::of(l, &u[0][0]), Wide::of(l, &u[0][1])]);
            quartet.dir = dir.to_vectors();
            quartet.left = match &self.source.kind {
                Kind::Ball { outwards, round: Some(round), .. } => {
                    Some(round.left_by_four(l, self.targets, *outwards, dir, &u[1]))
                }
                Kind::Quad { flat, .. } => Some(flat.left_by_four(l, self.targets, dir, &u[1])),
                _ => None,
            };
        }
        quartet
    }
}
