//! The tree over boxes. Each lane of a node is one box or one node: what a box holds is dear to
//! intersect, so it is reached only if its own box is entered.

use super::binned::{self, Item};
use super::collapse::collapse;
use super::few::{FEW, Few};
use super::node::{self, Child, MAX_COUNT, Node, Rows};
use super::ray::{BoxRay, Slabs};
use super::traverse::walk;
use crate::math::Aabb;
use crate::math::lanes::{Lanes, Machine, Work};

/// A tree over boxes: the top level of a scene.
#[derive(Clone, Debug)]
pub struct Bvh {
    pub(super) nodes: Vec<Rows>,
    /// All boxes in one row of blocks, where they are few: no tree is needed then.
    few: Option<Few>,
    bounds: Aabb,
    pub(super) machine: Machine,
}

impl Bvh {
    /// Builds the tree. Empty boxes, and boxes with a NaN, are left out. Parallel; the result does
    /// not depend on the number of threads.
    pub fn build(boxes: &[Aabb]) -> Bvh {
        assert!(boxes.len() <= MAX_COUNT, "a tree holds less than 2^31 boxes");
        let solid = |b: &Aabb| b.min.cmple(b.max).all();
        let mut items: Vec<Item> =
            (0u32..).zip(boxes).filter(|(_, b)| solid(b)).map(|(i, b)| Item::new(b, i)).collect();
        let bounds = boxes.iter().filter(|b| solid(b)).fold(Aabb::EMPTY, |all, b| all.union(*b));
        let nodes = nodes(&mut items);
        let few = (items.len() <= FEW).then(|| Few::of(&nodes));
        Bvh { nodes, few, bounds, machine: Machine::detect() }
    }

    /// The box around everything, empty for a tree of nothing.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Nearest boxes first, calls `visit(box index, t_max)` for every box that the ray enters at a
    /// t in [0, t_max]; `Some(t)` lowers t_max to `t`.
    #[inline]
    pub fn nearest(&self, ray: &BoxRay, t_max: f32, mut visit: impl FnMut(u32, f32) -> Option<f32>) {
        if let Some(few) = &self.few {
            let entered = few.entered(self.machine, ray, &self.bounds, t_max, true);
            let mut limit = t_max;
            for &key in entered.keys() {
                if f32::from_bits((key >> 32) as u32) > Few::limit(limit) {
                    return;
                }
                limit = visit(key as u32, limit).map_or(limit, |t| t.min(limit));
            }
            return;
        }
        self.machine.run(Nearest { tree: self, ray, t_max, visit });
    }

    /// Calls `visit(box index)` for boxes that the ray enters at a t in [0, t_max], in no
    /// particular order, until it returns true; returns whether it did.
    #[inline]
    pub fn any(&self, ray: &BoxRay, t_max: f32, mut visit: impl FnMut(u32) -> bool) -> bool {
        if let Some(few) = &self.few {
            let entered = few.entered(self.machine, ray, &self.bounds, t_max, false);
            for &key in entered.keys() {
                if visit(key as u32) {
                    return true;
                }
            }
            return false;
        }
        self.machine.run(Any { tree: self, ray, t_max, visit })
    }

    /// Checks the tree against the boxes that it was built from: each box is there once, and lies
    /// within all the boxes above it.
    pub fn validate(&self, boxes: &[Aabb]) -> Result<(), String> {
        let mut seen = vec![false; boxes.len()];
        check(&self.nodes, &mut |leaf, bounds| {
            let held = boxes.get(leaf as usize).ok_or("a leaf names no box")?;
            let first = !std::mem::replace(&mut seen[leaf as usize], true);
            if first && *held == bounds { Ok(()) } else { Err("a box is there twice, or altered") }
        })?;
        let solid = |b: &Aabb| b.min.cmple(b.max).all();
        match seen.iter().zip(boxes).position(|(seen, b)| *seen != solid(b)) {
            Some(i) => Err(format!("box {i} is missing")),
            None => Ok(()),
        }
    }

    /// Bytes on the heap.
    pub fn memory_bytes(&self) -> usize {
        self.nodes.capacity() * size_of::<Rows>() + self.few.as_ref().map_or(0, Few::memory_bytes)
    }

    #[cfg(test)]
    pub(super) fn portable(mut self) -> Bvh {
        self.machine = Machine::portable();
        self
    }
}

fn nodes(items: &mut [Item]) -> Vec<Rows> {
    if items.is_empty() {
        return Vec::new();
    }
    let tree = binned::build(items, 1);
    let mut wide = collapse(&tree);
    for rows in &mut wide.nodes {
        for (lane, _, child) in Node(&rows.clone()).filled() {
            if let Child::Leaf(n) = child {
                let item = &items[wide.leaves[n as usize].first as usize];
                node::set_child(rows, lane, Child::Leaf(item.index()));
            }
        }
    }
    wide.nodes.shrink_to_fit();
    wide.nodes
}

/// Walks the whole tree; `leaf(number, box)` checks a leaf. Every node must be reached once, and
/// the boxes in it must lie in the box that its parent has for it.
pub(super) fn check(
    nodes: &[Rows],
    leaf: &mut impl FnMut(u32, Aabb) -> Result<(), &'static str>,
) -> Result<(), String> {
    let mut reached = 0;
    let mut stack = vec![(0, node::root_bounds(nodes)); nodes.len().min(1)];
    while let Some((n, outer)) = stack.pop() {
        reached += 1;
        if reached > nodes.len() {
            return Err("a node is reached twice".into());
        }
        let node = nodes.get(n as usize).ok_or("a child names no node")?;
        for (_, bounds, child) in Node(node).filled() {
            if bounds.union(outer) != outer {
                return Err(format!("node {n} has a box outside of its own"));
            }
            match child {
                Child::Node(c) => stack.push((c, bounds)),
                Child::Leaf(l) => leaf(l, bounds).map_err(|e| format!("node {n}: {e}"))?,
            }
        }
    }
    if reached == nodes.len() { Ok(()) } else { Err("a node is never reached".into()) }
}

struct Nearest<'a, V> {
    tree: &'a Bvh,
    ray: &'a BoxRay,
    t_max: f32,
    visit: V,
}

impl<V: FnMut(u32, f32) -> Option<f32>> Work for Nearest<'_, V> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) {
        if !self.ray.is_valid() {
            return;
        }
        let slabs = Slabs::new(lanes, self.ray, &self.tree.bounds);
        walk::<L, true>(
            lanes,
            &self.tree.nodes,
            &slabs,
            self.t_max,
            #[inline(always)]
            |i, t_max| (self.visit)(i, t_max).map_or(t_max, |t| t.min(t_max)),
        );
    }
}

struct Any<'a, V> {
    tree: &'a Bvh,
    ray: &'a BoxRay,
    t_max: f32,
    visit: V,
}

impl<V: FnMut(u32) -> bool> Work for Any<'_, V> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) -> bool {
        if !self.ray.is_valid() {
            return false;
        }
        let slabs = Slabs::new(lanes, self.ray, &self.tree.bounds);
        let mut found = false;
        walk::<L, false>(
            lanes,
            &self.tree.nodes,
            &slabs,
            self.t_max,
            #[inline(always)]
            |i, t_max| {
                found = (self.visit)(i);
                if found { -1.0 } else { t_max }
            },
        );
        found
    }
}
