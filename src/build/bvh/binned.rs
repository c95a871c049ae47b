//! The binary tree: top-down splits by the surface area heuristic over bins of centroids
//! (Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies").
//!
//! Halves are built in parallel; what is built depends on the boxes alone, not on the threads.

use crate::math::{Aabb, Vec3};
use glam::Vec4;

const BINS: usize = 16;

/// Fewer boxes than this are built by one task, into one vector.
const TASK: usize = 1 << 13;

/// From this depth on, lists are halved without looking, so that the depth is bounded by this
/// plus the logarithm of the number of boxes.
const BLIND_DEPTH: usize = 64;

/// A box to sort, 32 bytes: its corners, with the index of what it holds in the first one's `w`.
#[derive(Clone, Copy, Debug)]
pub struct Item {
    min: Vec4,
    max: Vec4,
}

impl Item {
    pub fn new(b: &Aabb, index: u32) -> Item {
        // The 1 hides the index, a subnormal number, from the arithmetic on centres.
        Item { min: b.min.extend(f32::from_bits(index)), max: b.max.extend(1.0) }
    }

    pub fn index(&self) -> u32 {
        self.min.w.to_bits()
    }

    /// Twice the centroid; `w` is of no meaning.
    #[inline(always)]
    fn centre(&self) -> Vec4 {
        self.min + self.max
    }
}

/// A box in four lanes, whose last one is of no meaning.
#[derive(Clone, Copy, Debug)]
pub struct Box4 {
    min: Vec4,
    max: Vec4,
}

impl Box4 {
    const EMPTY: Box4 = Box4 { min: Vec4::INFINITY, max: Vec4::NEG_INFINITY };

    #[inline(always)]
    fn grow(&mut self, min: Vec4, max: Vec4) {
        self.min = min.min(self.min);
        self.max = max.max(self.max);
    }

    #[inline(always)]
    fn union(mut self, other: &Box4) -> Box4 {
        self.grow(other.min, other.max);
        self
    }

    #[inline(always)]
    fn half_area(&self) -> f32 {
        let e = self.max - self.min;
        e.x * (e.y + e.z) + e.y * e.z
    }

    fn aabb(&self) -> Aabb {
        let xyz = |v: Vec4| Vec3::new(v.x, v.y, v.z);
        Aabb { min: xyz(self.min), max: xyz(self.max) }
    }
}

/// A binary node: two further nodes, or a range of the sorted items.
#[derive(Clone, Debug)]
pub struct BinaryNode {
    pub bounds: Aabb,
    /// Items below this node.
    pub count: u32,
    /// First item of a leaf; for an inner node, the second child's place in the same vector (the
    /// first child follows its parent directly).
    pub at: u32,
    pub leaf: bool,
}

/// The binary tree. Its upper part is made of single nodes, each built by a task of its own; its
/// lower parts are vectors, one a task.
#[derive(Debug)]
pub enum Binary {
    Split { bounds: Aabb, count: u32, halves: Box<[Binary; 2]> },
    Part(Vec<BinaryNode>),
}

/// What is known of a range of items before it is split.
#[derive(Clone, Copy)]
struct Range {
    first: usize,
    bounds: Box4,
    centres: Box4,
    depth: usize,
}

/// Sorts `items` into the leaves' order and returns their tree. Leaves hold at most `max_leaf`.
pub fn build(items: &mut [Item], max_leaf: usize) -> Binary {
    let (mut bounds, mut centres) = (Box4::EMPTY, Box4::EMPTY);
    for item in items.iter() {
        bounds.grow(item.min, item.max);
        centres.grow(item.centre(), item.centre());
    }
    build_top(items, Range { first: 0, bounds, centres, depth: 0 }, max_leaf)
}

fn build_top(items: &mut [Item], range: Range, max_leaf: usize) -> Binary {
    if items.len() <= TASK {
        let mut nodes = Vec::with_capacity(items.len() / max_leaf * 3);
        build_part(items, range, max_leaf, &mut nodes);
        return Binary::Part(nodes);
    }
    let (bounds, count) = (range.bounds.aabb(), items.len() as u32);
    let [left, right] = split(items, &range, max_leaf);
    let (a, b) = items.split_at_mut(right.first - range.first);
    let (a, b) = rayon::join(|| build_top(a, left, max_leaf), || build_top(b, right, max_leaf));
    Binary::Split { bounds, count, halves: Box::new([a, b]) }
}

fn build_part(items: &mut [Item], range: Range, max_leaf: usize, nodes: &mut Vec<BinaryNode>) {
    let leaf = items.len() <= max_leaf;
    let here = nodes.len();
    nodes.push(BinaryNode {
        bounds: range.bounds.aabb(),
        count: items.len() as u32,
        at: range.first as u32,
        leaf,
    });
    if leaf {
        return;
    }
    let [left, right] = split(items, &range, max_leaf);
    let (a, b) = items.split_at_mut(right.first - range.first);
    build_part(a, left, max_leaf, nodes);
    nodes[here].at = nodes.len() as u32;
    build_part(b, right, max_leaf, nodes);
}

/// From centres to bins, by one addition: the sum with 3·2²² has the rounded value in its low bits.
#[derive(Clone, Copy)]
struct Binning {
    origin: Vec4,
    scale: Vec4,
}

impl Binning {
    fn new(centres: &Box4) -> Binning {
        let extent = centres.max - centres.min;
        // A hair under the number of bins, so that the last centre falls into the last bin.
        let scale = Vec4::splat(BINS as f32 * (1.0 - 1e-5)) / extent;
        let usable = extent.cmpgt(Vec4::ZERO) & scale.cmplt(Vec4::INFINITY);
        Binning { origin: centres.min, scale: Vec4::select(usable, scale, Vec4::ZERO) }
    }

    #[inline(always)]
    fn bins(&self, centre: Vec4) -> [usize; 4] {
        const INTEGERS: f32 = 12_582_912.0;
        let x = (centre - self.origin) * self.scale - Vec4::splat(0.5) + Vec4::splat(INTEGERS);
        x.to_array().map(|v| v.to_bits() as usize & (BINS - 1))
    }
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: Box4,
    count: u32,
}

const NO_BIN: Bin = Bin { bounds: Box4::EMPTY, count: 0 };

/// Reorders the items into two non-empty parts and describes them.
fn split(items: &mut [Item], range: &Range, max_leaf: usize) -> [Range; 2] {
    if range.depth < BLIND_DEPTH {
        // A leaf of one box holds what is dear to meet.
        if max_leaf == 1
            && let Some(parts) = without_large(items, range)
        {
            return parts;
        }
        let binning = Binning::new(&range.centres);
        let bins = fill_bins(items, &binning);
        if let Some((axis, bin)) = best_split(&bins, max_leaf) {
            return partition(items, range, |item| binning.bins(item.centre())[axis] < bin);
        }
    }
    let half = items.len() / 2;
    let mut place = 0;
    partition(items, range, |_| {
        place += 1;
        place <= half
    })
}

/// Boxes of a node at least that are worth setting its large ones apart, and large ones at most: those of one node of
/// eight beside all the others.
const MANY: usize = 16;
const LARGE: usize = 7;

/// From this share of a node's area on a box is large in it.
const SHARE: f32 = 0.25;

/// A part with the few boxes that are large beside all others, if there are such. What is as large as the whole node
/// makes as large every node above it, however far down it is sorted by its centre: a ray through a thicket within
/// a bowl would enter nodes of blades to find the bowl.
fn without_large(items: &mut [Item], range: &Range) -> Option<[Range; 2]> {
    if items.len() < MANY {
        return None;
    }
    let least = SHARE * range.bounds.half_area();
    let large = |item: &Item| Box4 { min: item.min, max: item.max }.half_area() >= least;
    let count = items.iter().filter(|item| large(item)).take(LARGE + 1).count();
    (1..=LARGE).contains(&count).then(|| partition(items, range, |item| !large(item)))
}

fn fill_bins(items: &[Item], binning: &Binning) -> [[Bin; BINS]; 3] {
    let mut bins = [[NO_BIN; BINS]; 3];
    for item in items {
        let at = binning.bins(item.centre());
        for axis in 0..3 {
            let bin = &mut bins[axis][at[axis]];
            bin.bounds.grow(item.min, item.max);
            bin.count += 1;
        }
    }
    bins
}

/// The axis, and the first bin of the right side, of the cheapest split; the cost of a side is its
/// area times the number of leaves that it needs at least. `None` if no split has two sides.
fn best_split(bins: &[[Bin; BINS]; 3], max_leaf: usize) -> Option<(usize, usize)> {
    let leaves = |count: u32| (count as usize).div_ceil(max_leaf) as f32;
    let mut best = (f32::INFINITY, None);
    for (axis, bins) in bins.iter().enumerate() {
        let mut right_cost = [0.0; BINS];
        let mut right = NO_BIN;
        for i in (1..BINS).rev() {
            right.bounds = right.bounds.union(&bins[i].bounds);
            right.count += bins[i].count;
            right_cost[i] =
                if right.count == 0 { f32::INFINITY } else { right.bounds.half_area() * leaves(right.count) };
        }
        let mut left = NO_BIN;
        for i in 1..BINS {
            left.bounds = left.bounds.union(&bins[i - 1].bounds);
            left.count += bins[i - 1].count;
            let cost = left.bounds.half_area() * leaves(left.count) + right_cost[i];
            if left.count > 0 && cost < best.0 {
                best = (cost, Some((axis, i)));
            }
        }
    }
    best.1
}

/// In place, in one sweep from both ends. `is_left` is asked once for each item.
fn partition(items: &mut [Item], range: &Range, mut is_left: impl FnMut(&Item) -> bool) -> [Range; 2] {
    let side = Range { bounds: Box4::EMPTY, centres: Box4::EMPTY, depth: range.depth + 1, ..*range };
    let (mut left, mut right) = (side, side);
    let (mut i, mut j) = (0, items.len());
    while i < j {
        let item = items[i];
        let centre = item.centre();
        if is_left(&item) {
            left.bounds.grow(item.min, item.max);
            left.centres.grow(centre, centre);
            i += 1;
        } else {
            right.bounds.grow(item.min, item.max);
            right.centres.grow(centre, centre);
            j -= 1;
            items.swap(i, j);
        }
    }
    right.first += i;
    [left, right]
}
