//! From the binary tree to nodes of eight: a node takes in the grandchildren of its largest child
//! again and again until its eight lanes are full (Wald, Benthin & Boulos 2008, "Getting Rid of
//! Packets"; Dammertz, Hanika & Keller 2008).

use super::binned::{Binary, BinaryNode};
use super::node::{self, Child, Node, Rows};
use crate::math::Aabb;
use rayon::prelude::*;

/// Subtrees with more items than this are collapsed by tasks of their own.
const TASK: u32 = 1 << 15;

/// A range of the sorted items.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Leaf {
    pub first: u32,
    pub count: u32,
}

/// Nodes in depth-first order, the root first, and their leaves, in the order in which the nodes
/// name them.
#[derive(Debug, Default)]
pub struct Wide {
    pub nodes: Vec<Rows>,
    pub leaves: Vec<Leaf>,
}

/// A place in the binary tree.
#[derive(Clone, Copy)]
enum Place<'a> {
    Top(&'a Binary),
    Part(&'a [BinaryNode], usize),
}

impl<'a> Place<'a> {
    fn root(tree: &'a Binary) -> Place<'a> {
        match tree {
            Binary::Part(nodes) => Place::Part(nodes, 0),
            split => Place::Top(split),
        }
    }

    fn bounds(&self) -> Aabb {
        match self {
            Place::Top(Binary::Split { bounds, .. }) => *bounds,
            Place::Top(Binary::Part(nodes)) => nodes[0].bounds,
            Place::Part(nodes, i) => nodes[*i].bounds,
        }
    }

    fn count(&self) -> u32 {
        match self {
            Place::Top(Binary::Split { count, .. }) => *count,
            Place::Top(Binary::Part(nodes)) => nodes[0].count,
            Place::Part(nodes, i) => nodes[*i].count,
        }
    }

    fn leaf(&self) -> Option<Leaf> {
        match self {
            Place::Part(nodes, i) if nodes[*i].leaf => {
                Some(Leaf { first: nodes[*i].at, count: nodes[*i].count })
            }
            _ => None,
        }
    }

    fn children(&self) -> Option<[Place<'a>; 2]> {
        match *self {
            Place::Top(Binary::Split { halves, .. }) => {
                Some([Place::root(&halves[0]), Place::root(&halves[1])])
            }
            Place::Top(Binary::Part(nodes)) => Place::Part(nodes, 0).children(),
            Place::Part(nodes, i) if nodes[i].leaf => None,
            Place::Part(nodes, i) => {
                Some([Place::Part(nodes, i + 1), Place::Part(nodes, nodes[i].at as usize)])
            }
        }
    }
}

/// The nodes of eight for a binary tree.
pub fn collapse(tree: &Binary) -> Wide {
    let mut wide = Wide::default();
    append(Place::root(tree), &mut wide);
    wide
}

/// Appends the subtree at `place`, whose node comes first.
fn append(place: Place, wide: &mut Wide) {
    let lanes = lanes_of(place);
    let here = wide.nodes.len();
    wide.nodes.push(node::EMPTY);
    let mut parts = if place.count() > TASK {
        let task = |p: &Place| {
            let mut part = Wide::default();
            if p.leaf().is_none() {
                append(*p, &mut part);
            }
            part
        };
        lanes.par_iter().map(task).collect()
    } else {
        Vec::new()
    }
    .into_iter();
    for (lane, p) in lanes.iter().enumerate() {
        let part = parts.next();
        let child = match (p.leaf(), part) {
            (Some(leaf), _) => {
                wide.leaves.push(leaf);
                Child::Leaf(wide.leaves.len() as u32 - 1)
            }
            (None, Some(part)) => splice(part, wide),
            (None, None) => {
                let root = wide.nodes.len() as u32;
                append(*p, wide);
                Child::Node(root)
            }
        };
        node::set(&mut wide.nodes[here], lane, &p.bounds(), child);
    }
}

/// Up to eight places that together hold what `place` holds.
fn lanes_of(place: Place) -> Vec<Place> {
    let mut lanes = Vec::with_capacity(8);
    lanes.push(place);
    while lanes.len() < 8 {
        let mut largest: Option<(f32, usize)> = None;
        for (i, p) in lanes.iter().enumerate() {
            let area = p.bounds().half_area();
            if p.leaf().is_none() && largest.is_none_or(|(a, _)| area > a) {
                largest = Some((area, i));
            }
        }
        let Some((_, i)) = largest else { break };
        let [a, b] = lanes[i].children().expect("a place that is no leaf has children");
        lanes[i] = a;
        lanes.insert(i + 1, b);
    }
    lanes
}

/// Appends a finished subtree, and returns its root.
fn splice(mut part: Wide, wide: &mut Wide) -> Child {
    let (nodes, leaves) = (wide.nodes.len() as u32, wide.leaves.len() as u32);
    for rows in &mut part.nodes {
        for (lane, _, child) in Node(&rows.clone()).filled() {
            let moved = match child {
                Child::Node(n) => Child::Node(n + nodes),
                Child::Leaf(n) => Child::Leaf(n + leaves),
            };
            node::set_child(rows, lane, moved);
        }
    }
    wide.nodes.append(&mut part.nodes);
    wide.leaves.append(&mut part.leaves);
    Child::Node(nodes)
}
