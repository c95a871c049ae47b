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
        self.machine.run(Overlap { nodes: &self.nodes, wanted, visit })
    }
}

impl TriangleBvh {
    /// Calls `visit` with the corners of triangles whose bounds overlap or touch `wanted`, until it returns true;
    /// returns whether it did.
    #[inline]
    pub fn any_in(&self, wanted: &Aabb, mut visit: impl FnMut([Vec3; 3]) -> bool) -> bool {
        let packets = self.packets.blocks();
        let visit = |leaf: u32| {
            let near = |corners: &[Vec3; 3]| Aabb::from_points(*corners).overlaps(wanted);
            Packet(&packets[leaf as usize]).filled().any(|(_, corners)| near(&corners) && visit(corners))
        };
        self.machine.run(Overlap { nodes: self.nodes.blocks(), wanted, visit })
    }
}

struct Overlap<'a, V> {
    nodes: &'a [Rows],
    wanted: &'a Aabb,
    visit: V,
}

impl<V: FnMut(u32) -> bool> Work for Overlap<'_, V> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) -> bool {
        !self.nodes.is_empty() && within(lanes, self.nodes, 0, self.wanted, &mut self.visit)
    }
}

/// Trees are some ten nodes deep.
fn within<L: Lanes>(
    l: L,
    nodes: &[Rows],
    at: u32,
    wanted: &Aabb,
    visit: &mut impl FnMut(u32) -> bool,
) -> bool {
    let node = Node(&nodes[at as usize]);
    let mut mask = (0..3).fold(u32::MAX, |mask, k| {
        let (lo, hi) = (l.load(node.row(k)), l.load(node.row(k + 3)));
        mask & l.le(lo, l.splat(wanted.max[k])) & l.le(l.splat(wanted.min[k]), hi)
    });
    while mask != 0 {
        let lane = mask.trailing_zeros() as usize & 7;
        mask &= mask - 1;
        let found = match Child::from_bits(node.child(lane)) {
            Child::Node(n) => within(l, nodes, n, wanted, visit),
            Child::Leaf(leaf) => visit(leaf),
        };
        if found {
            return true;
        }
    }
    false
}
