//! Boxes over leaves in nodes of eight, without pointers: child c of node i of a level is node
//! 8i + c of the next, and below the last level, leaf 8i + c. Leaves that follow one another lie
//! together in space (they come from a kd-tree, in its order), so that is all it takes.

use crate::math::Vec3;
use crate::math::lanes::{Array, Lanes, Machine, Work};

const WIDTH: usize = 8;
/// Eight to the tenth leaves are more than a photon's index can count.
const DEEPEST: usize = 10;

/// A box; the empty one has `lo` above `hi`.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    pub lo: Vec3,
    pub hi: Vec3,
}

impl Bounds {
    pub const EMPTY: Bounds = Bounds { lo: Vec3::INFINITY, hi: Vec3::NEG_INFINITY };

    pub fn with(self, p: Vec3) -> Bounds {
        Bounds { lo: self.lo.min(p), hi: self.hi.max(p) }
    }

    fn union(self, other: Bounds) -> Bounds {
        Bounds { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }
}

/// Eight boxes, by axis. Places without a child hold the empty box, which is infinitely far.
#[derive(Clone, Debug)]
#[repr(align(64))]
struct Node {
    lo: [[f32; WIDTH]; 3],
    hi: [[f32; WIDTH]; 3],
}

impl Node {
    fn new(children: &[Bounds]) -> Node {
        let child = |c: usize| children.get(c).copied().unwrap_or(Bounds::EMPTY);
        let by_axis =
            |of: fn(Bounds) -> Vec3| std::array::from_fn(|axis| std::array::from_fn(|c| of(child(c))[axis]));
        Node { lo: by_axis(|b| b.lo), hi: by_axis(|b| b.hi) }
    }

    /// Squared distances to the boxes. None is larger than that to any point in its box, as computed
    /// in the same order, because rounding is monotone.
    #[inline(always)]
    fn distances_squared<L: Lanes>(&self, l: L, p: [L::F; 3]) -> L::F {
        let x = outside(l, &self.lo[0], &self.hi[0], p[0]);
        let y = outside(l, &self.lo[1], &self.hi[1], p[1]);
        let z = outside(l, &self.lo[2], &self.hi[2], p[2]);
        l.add(l.add(l.mul(x, x), l.mul(y, y)), l.mul(z, z))
    }

    /// Metres²: the larger face of the box around all children.
    fn area(&self) -> f32 {
        let extent = |axis: usize| {
            let lo = self.lo[axis].iter().fold(f32::INFINITY, |lo, v| lo.min(*v));
            self.hi[axis].iter().fold(f32::NEG_INFINITY, |hi, v| hi.max(*v)) - lo
        };
        let [x, y, z] = [extent(0), extent(1), extent(2)];
        (x * y).max(y * z).max(z * x)
    }
}

/// How far a coordinate is outside each of eight intervals.
#[inline(always)]
fn outside<L: Lanes>(l: L, lo: &Array, hi: &Array, p: L::F) -> L::F {
    l.max(l.max(l.sub(l.load(lo), p), l.sub(p, l.load(hi))), l.splat(0.0))
}

/// What is done at the leaves near a point.
pub trait Visitor {
    /// Leaves farther than this are not visited, metres²; finite. May fall from leaf to leaf.
    fn bound(&self) -> f32;
    fn leaf<L: Lanes>(&mut self, lanes: L, leaf: usize);
}

/// Boxes of all leaves.
#[derive(Clone, Debug, Default)]
pub struct Boxes {
    nodes: Vec<Node>,
    /// Where each level begins in `nodes`, the root first.
    levels: Vec<u32>,
    /// Metres² for each leaf of a node, for the nodes of the last level.
    areas: Vec<f32>,
}

impl Boxes {
    pub fn new(leaves: Vec<Bounds>) -> Boxes {
        let mut levels: Vec<Vec<Node>> = Vec::new();
        let count = leaves.len();
        let mut bounds = leaves;
        while levels.last().map_or(!bounds.is_empty(), |level| level.len() > 1) {
            levels.push(bounds.chunks(WIDTH).map(Node::new).collect());
            let joined =
                |children: &[Bounds]| children.iter().fold(Bounds::EMPTY, |joined, b| joined.union(*b));
            bounds = bounds.chunks(WIDTH).map(joined).collect();
        }
        let mut boxes = Boxes::default();
        if let Some(last) = levels.first() {
            let children = |node: usize| (count - node * WIDTH).min(WIDTH);
            let areas = last.iter().enumerate().map(|(i, node)| node.area() / children(i) as f32);
            boxes.areas = areas.collect();
        }
        boxes.nodes.reserve_exact(levels.iter().map(Vec::len).sum());
        for level in levels.into_iter().rev() {
            boxes.levels.push(boxes.nodes.len() as u32);
            boxes.nodes.extend(level);
        }
        boxes
    }

    pub fn memory_bytes(&self) -> usize {
        self.nodes.capacity() * size_of::<Node>()
            + (self.levels.capacity() + self.areas.capacity()) * size_of::<u32>()
    }

    /// Which of a node's eight boxes are within the bound.
    #[inline(always)]
    fn near<L: Lanes>(&self, l: L, node: u32, p: [L::F; 3], bound: f32) -> u32 {
        l.le(self.nodes[node as usize].distances_squared(l, p), l.splat(bound))
    }

    /// Visits the leaves whose boxes are no farther from `p` than the visitor's bound, in their order.
    #[inline(always)]
    pub fn visit<V: Visitor>(&self, p: Vec3, visitor: &mut V) {
        // Infinity is at no distance from the empty box, and NaN from any.
        if !self.nodes.is_empty() && p.is_finite() {
            Machine::detect().run(Visit { boxes: self, p, visitor });
        }
    }

    /// Metres²: the area around `p` that holds about as many photons as fill one leaf.
    pub fn area_of_a_leaf(&self, p: Vec3) -> f32 {
        let mut area = 0.0;
        if !self.nodes.is_empty() && p.is_finite() {
            Machine::detect().run(Descend { boxes: self, p, area: &mut area });
        }
        area
    }
}

struct Visit<'a, V> {
    boxes: &'a Boxes,
    p: Vec3,
    visitor: &'a mut V,
}

impl<V: Visitor> Work for Visit<'_, V> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let Visit { boxes, p, visitor } = self;
        let p = [l.splat(p.x), l.splat(p.y), l.splat(p.z)];
        let levels = &boxes.levels[..];
        // Nodes that wait, by level: each level has at most eight, in the bits of a mask.
        let mut stack = [(0u32, 0u32); DEEPEST];
        let mut level = 0;
        stack[0] = (0, boxes.near(l, 0, p, visitor.bound()));
        loop {
            let (node, mask) = stack[level];
            if mask == 0 {
                if level == 0 {
                    return;
                }
                level -= 1;
                continue;
            }
            let child = node * WIDTH as u32 + mask.trailing_zeros();
            stack[level].1 = mask & (mask - 1);
            if level + 1 == levels.len() {
                visitor.leaf(l, child as usize);
            } else {
                level += 1;
                stack[level] = (child, boxes.near(l, levels[level] + child, p, visitor.bound()));
            }
        }
    }
}

/// Goes down to the nearest box of each node.
struct Descend<'a> {
    boxes: &'a Boxes,
    p: Vec3,
    area: &'a mut f32,
}

impl Work for Descend<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let p = [l.splat(self.p.x), l.splat(self.p.y), l.splat(self.p.z)];
        let mut node = 0;
        for (level, first) in self.boxes.levels.iter().enumerate() {
            if level + 1 == self.boxes.levels.len() {
                *self.area = self.boxes.areas[node];
                return;
            }
            let distances = l.store(self.boxes.nodes[*first as usize + node].distances_squared(l, p));
            let nearest = (1..WIDTH).fold(0, |best, c| if distances[c] < distances[best] { c } else { best });
            node = node * WIDTH + nearest;
        }
    }
}
