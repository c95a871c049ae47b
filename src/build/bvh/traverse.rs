//! The walk of one ray through the tree: nearest boxes first, or in any order.
//!
//! The stack is a fixed array. A tree deep enough to fill it (many boxes on top of each other) is
//! finished with a stack on the heap, so no depth can fail.

use super::node::{Child, Node, Rows};
use super::ray::Slabs;
use crate::math::lanes::Lanes;

const STACK: usize = 48;

/// An entry distance and a child's bits, ordered by distance: non-negative floats compare as
/// their bits do.
#[inline(always)]
fn key(entry: f32, child: u32) -> u64 {
    u64::from(entry.to_bits()) << 32 | u64::from(child)
}

#[inline(always)]
fn entry_of(key: u64) -> f32 {
    f32::from_bits((key >> 32) as u32)
}

/// Calls `leaf(number, t_max)` for the leaves whose boxes the ray enters by `t_max`; it returns the
/// new `t_max`, below 0 to stop. With `ORDERED`, nearer boxes come first.
#[inline(always)]
pub(super) fn walk<L: Lanes, const ORDERED: bool>(
    lanes: L,
    nodes: &[Rows],
    slabs: &Slabs<L>,
    mut t_max: f32,
    mut leaf: impl FnMut(u32, f32) -> f32,
) {
    let mut stack = [0u64; STACK];
    let mut top = 0;
    let mut limit = Slabs::<L>::limit(t_max);
    let mut current = 0u32;
    if nodes.is_empty() {
        return;
    }
    loop {
        match Child::from_bits(current) {
            Child::Node(n) => {
                let node = Node(&nodes[n as usize]);
                let (entries, mut mask) = slabs.enter(lanes, node, lanes.splat(limit));
                if mask != 0 {
                    let first = mask.trailing_zeros() as usize & 7;
                    mask &= mask - 1;
                    if mask == 0 {
                        current = node.child(first);
                        continue;
                    }
                    if top + 8 > STACK {
                        let waiting = stack[..top].to_vec();
                        return walk_on_heap::<L>(lanes, nodes, slabs, t_max, &mut leaf, waiting, current);
                    }
                    let entries = lanes.store(entries);
                    if !ORDERED {
                        current = node.child(first);
                        while mask != 0 {
                            let lane = mask.trailing_zeros() as usize & 7;
                            mask &= mask - 1;
                            stack[top] = key(entries[lane], node.child(lane));
                            top += 1;
                        }
                        continue;
                    }
                    let mut nearest = key(entries[first], node.child(first));
                    let base = top;
                    while mask != 0 {
                        let lane = mask.trailing_zeros() as usize & 7;
                        mask &= mask - 1;
                        let k = key(entries[lane], node.child(lane));
                        let (near, far) = if k < nearest { (k, nearest) } else { (nearest, k) };
                        nearest = near;
                        // Keep stack[base..top] falling, the nearest on top.
                        let mut at = top;
                        while at > base && stack[at - 1] < far {
                            stack[at] = stack[at - 1];
                            at -= 1;
                        }
                        stack[at] = far;
                        top += 1;
                    }
                    current = nearest as u32;
                    continue;
                }
            }
            Child::Leaf(n) => {
                t_max = leaf(n, t_max);
                if t_max < 0.0 {
                    return;
                }
                limit = Slabs::<L>::limit(t_max);
            }
        }
        loop {
            if top == 0 {
                return;
            }
            top -= 1;
            let waiting = stack[top];
            if entry_of(waiting) <= limit {
                current = waiting as u32;
                break;
            }
        }
    }
}

/// The rest of a walk whose stack is full: the same visits, by a stack without an end.
#[cold]
#[inline(never)]
fn walk_on_heap<L: Lanes>(
    lanes: L,
    nodes: &[Rows],
    slabs: &Slabs<L>,
    mut t_max: f32,
    leaf: &mut impl FnMut(u32, f32) -> f32,
    mut stack: Vec<u64>,
    current: u32,
) {
    stack.push(key(0.0, current));
    while let Some(waiting) = stack.pop() {
        let limit = Slabs::<L>::limit(t_max);
        if entry_of(waiting) > limit {
            continue;
        }
        match Child::from_bits(waiting as u32) {
            Child::Leaf(n) => {
                t_max = leaf(n, t_max);
                if t_max < 0.0 {
                    return;
                }
            }
            Child::Node(n) => {
                let node = Node(&nodes[n as usize]);
                let (entries, mask) = slabs.enter(lanes, node, lanes.splat(limit));
                let (entries, base) = (lanes.store(entries), stack.len());
                let entered = (0..8).filter(|lane| mask >> lane & 1 == 1);
                stack.extend(entered.map(|lane| key(entries[lane], node.child(lane))));
                stack[base..].sort_unstable_by(|a, b| b.cmp(a));
            }
        }
    }
}
