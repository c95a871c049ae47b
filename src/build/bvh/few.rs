//! A handful of boxes, all tested at once and without a tree, as small scenes have them.
//!
//! The boxes that a ray enters are listed first and visited afterwards, so that what is visited need
//! not share registers with the slab test.

use super::node::{self, Child, EMPTY, Node, Rows};
use super::ray::{BoxRay, Slabs};
use crate::math::Aabb;
use crate::math::lanes::{Lanes, Machine, Work};

/// Boxes at most.
pub(super) const FEW: usize = 16;

/// Up to [`FEW`] boxes in blocks of eight.
#[derive(Clone, Debug)]
pub(super) struct Few {
    blocks: Vec<Rows>,
}

/// The boxes that a ray enters: entry distance in the upper half, number in the lower.
pub(super) struct Entered {
    keys: [u64; FEW],
    len: usize,
}

impl Entered {
    #[inline]
    pub fn keys(&self) -> &[u64] {
        &self.keys[..self.len]
    }
}

impl Few {
    /// The leaves of a tree of at most [`FEW`] leaves.
    pub fn of(nodes: &[Rows]) -> Few {
        let leaves =
            nodes.iter().flat_map(|rows| Node(rows).filled()).filter_map(|(_, bounds, child)| match child {
                Child::Leaf(_) => Some((bounds, child)),
                Child::Node(_) => None,
            });
        let mut blocks = Vec::new();
        for (i, (bounds, child)) in leaves.enumerate() {
            if i % 8 == 0 {
                blocks.push(EMPTY);
            }
            node::set(&mut blocks[i / 8], i % 8, &bounds, child);
        }
        Few { blocks }
    }

    pub fn memory_bytes(&self) -> usize {
        self.blocks.capacity() * size_of::<Rows>()
    }

    /// The largest entry that a box may have to hold a hit at up to `t_max`.
    #[inline]
    pub fn limit(t_max: f32) -> f32 {
        Slabs::<crate::math::lanes::Portable>::limit(t_max)
    }

    /// The boxes that the ray enters at a t in [0, t_max], nearest first if `ordered`.
    #[inline]
    pub fn entered(
        &self,
        machine: Machine,
        ray: &BoxRay,
        bounds: &Aabb,
        t_max: f32,
        ordered: bool,
    ) -> Entered {
        machine.run(Test { few: self, ray, bounds, t_max, ordered })
    }
}

struct Test<'a> {
    few: &'a Few,
    ray: &'a BoxRay,
    bounds: &'a Aabb,
    t_max: f32,
    ordered: bool,
}

impl Work for Test<'_> {
    type Output = Entered;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Entered {
        let mut entered = Entered { keys: [0; FEW], len: 0 };
        if !self.ray.is_valid() {
            return entered;
        }
        let slabs = Slabs::new(lanes, self.ray, self.bounds);
        let limit = lanes.splat(Slabs::<L>::limit(self.t_max));
        for rows in &self.few.blocks {
            let node = Node(rows);
            let (entries, mut mask) = slabs.enter(lanes, node, limit);
            let entries = lanes.store(entries);
            while mask != 0 {
                let lane = mask.trailing_zeros() as usize & 7;
                mask &= mask - 1;
                let Child::Leaf(number) = Child::from_bits(node.child(lane)) else { continue };
                // Non-negative floats compare as their bits do.
                let key = u64::from(entries[lane].to_bits()) << 32 | u64::from(number);
                let mut at = entered.len;
                while self.ordered && at > 0 && entered.keys[at - 1] > key {
                    entered.keys[at] = entered.keys[at - 1];
                    at -= 1;
                }
                entered.keys[at] = key;
                entered.len += 1;
            }
        }
        entered
    }
}
