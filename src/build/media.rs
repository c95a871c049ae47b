//! Nested and touching dielectrics: which medium a point lies in.
//!
//! Every transmissive instance has a rank; where several overlap, the highest counts (Schmidt &
//! Budge, Simple Nested Dielectrics in Ray Traced Images, JGT 7(2), 2002). Rank follows the
//! material's priority, then the smaller volume, so that an object inside of another of like
//! priority is itself. A path carries the set of ranks that it is inside of; entering and leaving are
//! idempotent, so that a surface met twice does no harm.

use super::world::World;
use crate::math::{Aabb, Color, DVec3, Ray};
use crate::optics::Cauchy;

/// The inside of a transmissive instance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Medium {
    pub instance: u32,
    pub ior: Cauchy,
    /// 1/m.
    pub absorption: Color,
    /// Bound of the `p_error` of its surface, metres.
    pub error: f64,
    /// Of the placed surface.
    pub bounds: Aabb,
}

/// Media whose bounds are looked at one by one.
const FEW: usize = 8;

/// Transmissive objects that may overlap at one point.
const CAPACITY: usize = 7;

/// The set of ranks that a point is inside of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MediaSet {
    /// The highest first, the others in any order; 0 behind them.
    ranks: [u32; CAPACITY],
    len: u32,
}

impl MediaSet {
    /// The rank that counts; 0 is the surrounding vacuum.
    #[inline]
    pub fn top(&self) -> u32 {
        self.ranks[0]
    }

    #[inline]
    pub fn contains(&self, rank: u32) -> bool {
        self.entries().contains(&rank)
    }

    /// The set after crossing a surface of `rank` inwards or outwards. `None` when too many objects
    /// overlap to be kept track of.
    #[inline]
    pub fn crossed(self, rank: u32, inwards: bool) -> Option<MediaSet> {
        let mut alone = MediaSet::default();
        match (inwards, self.len) {
            (true, 0) => {
                alone.ranks[0] = rank;
                alone.len = 1;
                Some(alone)
            }
            (false, 1) if self.ranks[0] == rank => Some(alone),
            _ => self.crossed_of_several(rank, inwards),
        }
    }

    #[inline(never)]
    fn crossed_of_several(mut self, rank: u32, inwards: bool) -> Option<MediaSet> {
        let len = self.len as usize;
        let position = self.entries().iter().position(|&r| r == rank);
        match (inwards, position) {
            (true, None) if len == CAPACITY => return None,
            (true, None) => {
                self.ranks[len] = rank;
                self.len += 1;
            }
            (false, Some(i)) => {
                self.ranks[i] = self.ranks[len - 1];
                self.ranks[len - 1] = 0;
                self.len -= 1;
            }
            _ => {}
        }
        let highest = (0..CAPACITY).max_by_key(|&i| self.ranks[i]).unwrap_or(0);
        self.ranks.swap(0, highest);
        Some(self)
    }

    /// All of them, in any order.
    pub fn ranks(&self) -> impl Iterator<Item = u32> + '_ {
        self.entries().iter().copied()
    }

    fn entries(&self) -> &[u32] {
        &self.ranks[..self.len as usize]
    }
}

impl World {
    /// The medium of a set's highest rank.
    #[inline]
    pub fn medium(&self, set: &MediaSet) -> (Cauchy, Color) {
        match set.top() {
            0 => (Cauchy::VACUUM, Color::ZERO),
            rank => {
                let medium = &self.media[rank as usize - 1];
                (medium.ior, medium.absorption)
            }
        }
    }

    /// The transmissive objects around a point: those whose first surface on the way out faces away,
    /// by majority of three directions, so that no single edge decides.
    pub fn media_at(&self, p: DVec3) -> MediaSet {
        let directions =
            [DVec3::new(0.36, 0.48, 0.8), DVec3::new(-0.64, 0.6, 0.48), DVec3::new(0.48, -0.8, -0.36)];
        let mut set = MediaSet::default();
        for (i, medium) in self.media.iter().enumerate() {
            if !medium.bounds.near(p, medium.error) {
                continue;
            }
            let votes = directions.iter().filter(|&&dir| self.leaves(medium.instance, p, dir)).count();
            if votes >= 2 {
                set = set.crossed(i as u32 + 1, true).unwrap_or(set);
            }
        }
        set
    }

    /// Whether the bounds of a transmissive object come within `distance` of a point.
    pub fn has_medium_near(&self, p: DVec3, distance: f64) -> bool {
        self.media.iter().any(|medium| medium.bounds.near(p, distance))
    }

    /// The same at once: where they are many, always.
    #[inline]
    pub(super) fn may_have_medium_near(&self, p: DVec3, distance: f64) -> bool {
        self.media.len() > FEW || self.has_medium_near(p, distance)
    }

    fn leaves(&self, instance: u32, p: DVec3, dir: DVec3) -> bool {
        let ray = Ray { origin: p, dir };
        self.nearest_of(instance, &ray, f64::INFINITY)
            .is_some_and(|hit| self.surface(&ray, &hit).ng.dot(dir) > 0.0)
    }

    /// Crossings of other transmissive instances within `tolerance` metres, along the normal, of the
    /// surface point `p` of `instance` that the unit direction `dir` crosses: surfaces that coincide
    /// with it. Calls `found(rank, inwards)` for each.
    #[inline(never)]
    pub fn coincident(
        &self,
        p: DVec3,
        ng: DVec3,
        dir: DVec3,
        instance: u32,
        tolerance: f64,
        mut found: impl FnMut(u32, bool),
    ) {
        let band = tolerance / dir.dot(ng).abs().max(1e-3);
        let ray = Ray { origin: p - dir * band, dir };
        let mut look = |rank: u32, other: u32| {
            if other != instance
                && let Some(hit) = self.nearest_of(other, &ray, 2.0 * band)
            {
                found(rank, self.surface(&ray, &hit).ng.dot(dir) < 0.0);
            }
        };
        if self.media.len() <= FEW {
            let near = (1..).zip(&self.media).filter(|(_, medium)| medium.bounds.near(p, band));
            return near.for_each(|(rank, medium)| look(rank, medium.instance));
        }
        let traversal = super::bvh::BoxRay::rounded(&ray);
        self.tree.nearest(&traversal, crate::math::round_up(2.0 * band), |other, _| {
            let rank = self.instances[other as usize].rank;
            if rank != 0 {
                look(rank, other);
            }
            None
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entering_and_leaving_are_idempotent_and_never_underflow() {
        let empty = MediaSet::default();
        let glass = empty.crossed(2, true).expect("room");
        assert_eq!(glass.crossed(2, true).expect("room"), glass);
        assert_eq!(empty.crossed(2, false).expect("room"), empty);
        let both = glass.crossed(1, true).expect("room");
        assert_eq!(both.top(), 2);
        assert_eq!(both.crossed(2, false).expect("room").top(), 1);
        assert_eq!(glass.crossed(2, false).expect("room").top(), 0);
    }

    #[test]
    fn more_overlaps_than_fit_are_reported() {
        let mut set = MediaSet::default();
        for rank in 1..=CAPACITY as u32 {
            set = set.crossed(rank, true).expect("room");
        }
        assert_eq!(set.crossed(99, true), None);
    }
}
