//! A node: eight boxes, coordinate by coordinate, and what each of them holds.

use super::lanes::Array;
use crate::math::{Aabb, Vec3};

/// What a box of a node holds: another node, or a leaf by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Child {
    Node(u32),
    Leaf(u32),
}

const LEAF: u32 = 1 << 31;

/// The largest number of leaves, or of nodes, that a tree can have.
pub const MAX_COUNT: usize = LEAF as usize - 1;

impl Child {
    #[inline(always)]
    pub fn from_bits(bits: u32) -> Child {
        if bits & LEAF == 0 { Child::Node(bits) } else { Child::Leaf(bits & !LEAF) }
    }

    pub fn to_bits(self) -> u32 {
        match self {
            Child::Node(n) => n,
            Child::Leaf(n) => n | LEAF,
        }
    }
}

/// Eight boxes and their contents. A lane that holds nothing has the empty box, which no ray
/// enters.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct Node {
    /// Smallest x, y, z, then largest x, y, z of each box, then the bits of its child. There are
    /// eight rows, so that masking a row's number keeps it in range.
    rows: [Array; 8],
}

const CHILDREN: usize = 6;

impl Node {
    pub fn empty() -> Node {
        let (lo, hi, none) = ([f32::INFINITY; 8], [f32::NEG_INFINITY; 8], [0.0; 8]);
        Node { rows: [lo, lo, lo, hi, hi, hi, none, none] }
    }

    #[inline(always)]
    pub fn row(&self, i: usize) -> &Array {
        &self.rows[i & 7]
    }

    /// The bits of the child in a lane.
    #[inline(always)]
    pub fn child(&self, lane: usize) -> u32 {
        self.rows[CHILDREN][lane & 7].to_bits()
    }

    pub fn set(&mut self, lane: usize, bounds: &Aabb, child: Child) {
        for k in 0..3 {
            self.rows[k][lane] = bounds.min[k];
            self.rows[3 + k][lane] = bounds.max[k];
        }
        self.set_child(lane, child);
    }

    pub fn set_child(&mut self, lane: usize, child: Child) {
        self.rows[CHILDREN][lane] = f32::from_bits(child.to_bits());
    }

    pub fn bounds(&self, lane: usize) -> Aabb {
        let corner = |i: usize| Vec3::from_array(std::array::from_fn(|k| self.rows[i + k][lane]));
        Aabb { min: corner(0), max: corner(3) }
    }

    #[cfg(test)]
    pub fn to_bits(&self) -> [u32; 64] {
        std::array::from_fn(|i| self.rows[i / 8][i % 8].to_bits())
    }

    /// The lanes that hold something: box and content.
    pub fn filled(&self) -> impl Iterator<Item = (Aabb, Child)> + '_ {
        (0..8)
            .map(|lane| (self.bounds(lane), Child::from_bits(self.child(lane))))
            .filter(|(b, _)| !b.is_empty())
    }
}
