//! What lies in a box: the leaves of a tree whose boxes it overlaps.

use super::mesh::TriangleBvh;
use super::node::{Child, Node, Rows};
use super::packet::Packet;
use super::tree::Bvh;
use crate::math::lanes::{Lanes, Work};
use crate::math::{Aabb, Vec3};

impl Bvh {
    /// Calls `visit(box index)` for boxes that overlap or touch `wanted`, until it returns true; returns whether it
    /// did.
    #[inline]
    pub fn any_in(&self, wanted: &Aabb, visit: impl FnMut(u32) -> bool) -> bool {
        self.machine.run(Overlap { nodes: &self.nodes, wanted, least: 0.0, visit })
    }
}

impl TriangleBvh {
    /// Calls `visit` with the corners of triangles whose bounds overlap or touch `wanted`, until it returns true;
    /// returns whether it did. Left out are triangles in boxes with a diagonal below `least`, which bounds their
    /// edges.
    #[inline]
    pub fn any_in(&self, wanted: &Aabb, least: f32, mut visit: impl FnMut([Vec3; 3]) -> bool) -> bool {
        let packets = self.packets.blocks();
        let visit = |leaf: u32| {
            let near = |corners: &[Vec3; 3]| Aabb::from_points(*corners).overlaps(wanted);
            Packet(&packets[leaf as usize]).filled().any(|(_, corners)| near(&corners) && visit(corners))
        };
        self.machine.run(Overlap { nodes: self.nodes.blocks(), wanted, least, visit })
    }
}

struct Overlap<'a, V> {
    nodes: &'a [Rows],
    wanted: &'a Aabb,
    /// Diagonals of boxes that matter.
    least: f32,
    visit: V,
}

/// What is left to be looked at, at most, but for trees of boxes on top of each other: those go on on the heap.
const STACK: usize = 96;

impl<V: FnMut(u32) -> bool> Work for Overlap<'_, V> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(mut self, l: L) -> bool {
        if self.nodes.is_empty() {
            return false;
        }
        let (lo, hi) = (self.wanted.min.to_array(), self.wanted.max.to_array());
        let least = l.splat(self.least * self.least);
        let (mut stack, mut top, mut more) = ([0u32; STACK], 1, Vec::new());
        loop {
            let at = if let Some(at) = more.pop() {
                at
            } else if top > 0 {
                top -= 1;
                stack[top]
            } else {
                return false;
            };
            let node = Node(&self.nodes[at as usize]);
            let (mut mask, mut diagonal) = (u32::MAX, l.splat(0.0));
            for k in 0..3 {
                let (min, max) = (l.load(node.row(k)), l.load(node.row(k + 3)));
                let extent = l.sub(max, min);
                diagonal = l.add(diagonal, l.mul(extent, extent));
                mask &= l.le(min, l.splat(hi[k])) & l.le(l.splat(lo[k]), max);
            }
            mask &= l.le(least, diagonal);
            while mask != 0 {
                let lane = mask.trailing_zeros() as usize & 7;
                mask &= mask - 1;
                match Child::from_bits(node.child(lane)) {
                    Child::Node(n) if top < STACK => {
                        stack[top] = n;
                        top += 1;
                    }
                    Child::Node(n) => more.push(n),
                    Child::Leaf(leaf) => {
                        if (self.visit)(leaf) {
                            return true;
                        }
                    }
                }
            }
        }
    }
}
