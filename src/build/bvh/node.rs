//! A node: eight boxes, coordinate by coordinate, and what each of them holds.

use crate::math::lanes::Array;
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

/// The memory of a node: smallest x, y, z, then largest x, y, z of each box, then the bits of its
/// child. There are eight rows, so that masking a row's number keeps it in range. A lane that holds
/// nothing has the empty box, which no ray enters.
pub type Rows = [Array; 8];

const CHILDREN: usize = 6;

/// Eight lanes that hold nothing.
pub const EMPTY: Rows = {
    let (lo, hi, none) = ([f32::INFINITY; 8], [f32::NEG_INFINITY; 8], [0.0; 8]);
    [lo, lo, lo, hi, hi, hi, none, none]
};

/// Fills a lane.
pub fn set(rows: &mut Rows, lane: usize, bounds: &Aabb, child: Child) {
    for k in 0..3 {
        rows[k][lane] = bounds.min[k];
        rows[3 + k][lane] = bounds.max[k];
    }
    set_child(rows, lane, child);
}

/// Replaces what a lane's box holds.
pub fn set_child(rows: &mut Rows, lane: usize, child: Child) {
    rows[CHILDREN][lane] = f32::from_bits(child.to_bits());
}

/// Eight boxes and their contents.
#[derive(Clone, Copy, Debug)]
pub struct Node<'a>(pub &'a Rows);

impl<'a> Node<'a> {
    #[inline(always)]
    pub fn row(self, i: usize) -> &'a Array {
        &self.0[i & 7]
    }

    /// The bits of the child in a lane.
    #[inline(always)]
    pub fn child(self, lane: usize) -> u32 {
        self.0[CHILDREN][lane & 7].to_bits()
    }

    pub fn bounds(self, lane: usize) -> Aabb {
        let corner = |i: usize| Vec3::from_array(std::array::from_fn(|k| self.0[i + k][lane]));
        Aabb { min: corner(0), max: corner(3) }
    }

    /// The lanes that hold something: number, box and content.
    pub fn filled(self) -> impl Iterator<Item = (usize, Aabb, Child)> + 'a {
        (0..8)
            .map(move |lane| (lane, self.bounds(lane), Child::from_bits(self.child(lane))))
            .filter(|(_, b, _)| !b.is_empty())
    }

    #[cfg(test)]
    pub fn to_bits(self) -> [u32; 64] {
        std::array::from_fn(|i| self.0[i / 8][i % 8].to_bits())
    }
}

/// The box around all boxes of the first node: of the whole tree.
pub fn root_bounds(nodes: &[Rows]) -> Aabb {
    let boxes = nodes.first().into_iter().flat_map(|root| Node(root).filled());
    boxes.fold(Aabb::EMPTY, |all, (_, b, _)| all.union(b))
}
