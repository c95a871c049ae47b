//! Boxes over leaves in nodes of eight, without pointers: child c of node i of a level is node
//! 8i + c of the next, and below the last level, leaf 8i + c. Leaves that follow one another lie
//! together in space (they come from a kd-tree, in its order), so that is all it takes.

use crate::math::Vec3;

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
        let by_axis = |of: fn(Bounds) -> Vec3| {
            std::array::from_fn(|axis| std::array::from_fn(|c| of(child(c))[axis]))
        };
        Node { lo: by_axis(|b| b.lo), hi: by_axis(|b| b.hi) }
    }

    /// Squared distances to the boxes. None is larger than that to any point in its box, as computed
    /// in the same order, because rounding is monotone.
    #[inline(always)]
    fn distances_squared(&self, p: Vec3) -> [f32; WIDTH] {
        let p = p.to_array();
        let larger = |a: f32, b: f32| if a > b { a } else { b };
        let along = |axis: usize, c: usize| {
            larger(larger(self.lo[axis][c] - p[axis], p[axis] - self.hi[axis][c]), 0.0)
        };
        std::array::from_fn(|c| {
            let (x, y, z) = (along(0, c), along(1, c), along(2, c));
            x * x + y * y + z * z
        })
    }
}

/// What is done at the leaves near a point.
pub trait Visitor {
    /// Whether nearer leaves should come first, because [`Visitor::bound`] will fall.
    const NEAREST_FIRST: bool;
    /// Leaves farther than this are not visited, metres²; finite.
    fn bound(&self) -> f32;
    fn leaf(&mut self, leaf: usize);
}

/// Boxes of all leaves.
#[derive(Clone, Debug, Default)]
pub struct Boxes {
    nodes: Vec<Node>,
    /// Where each level begins in `nodes`, the root first.
    levels: Vec<u32>,
}

#[derive(Clone, Copy, Default)]
struct Pending {
    distance_squared: f32,
    level: u32,
    node: u32,
}

impl Boxes {
    pub fn new(leaves: Vec<Bounds>) -> Boxes {
        let mut levels: Vec<Vec<Node>> = Vec::new();
        let mut bounds = leaves;
        while levels.last().map_or(!bounds.is_empty(), |level| level.len() > 1) {
            levels.push(bounds.chunks(WIDTH).map(Node::new).collect());
            let joined =
                |children: &[Bounds]| children.iter().fold(Bounds::EMPTY, |joined, b| joined.union(*b));
            bounds = bounds.chunks(WIDTH).map(joined).collect();
        }
        let mut boxes = Boxes::default();
        boxes.nodes.reserve_exact(levels.iter().map(Vec::len).sum());
        for level in levels.into_iter().rev() {
            boxes.levels.push(boxes.nodes.len() as u32);
            boxes.nodes.extend(level);
        }
        boxes
    }

    pub fn memory_bytes(&self) -> usize {
        self.nodes.capacity() * size_of::<Node>() + self.levels.capacity() * size_of::<u32>()
    }

    /// Visits the leaves whose boxes are no farther from `p` than the visitor's bound.
    #[inline(always)]
    pub fn visit<V: Visitor>(&self, p: Vec3, visitor: &mut V) {
        if self.nodes.is_empty() {
            return;
        }
        let last = self.levels.len() as u32 - 1;
        let mut stack = [Pending::default(); (WIDTH - 1) * DEEPEST + 1];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let Pending { distance_squared, level, node } = stack[height];
            if V::NEAREST_FIRST && distance_squared > visitor.bound() {
                continue;
            }
            let place = self.levels[level as usize] + node;
            let distances = self.nodes[place as usize].distances_squared(p);
            let (near, count) = near_children::<V>(&distances, visitor.bound());
            if level == last {
                for &c in &near[..count] {
                    if !V::NEAREST_FIRST || distances[c as usize] <= visitor.bound() {
                        visitor.leaf(node as usize * WIDTH + c as usize);
                    }
                }
            } else {
                for &c in near[..count].iter().rev() {
                    let c = u32::from(c);
                    let distance_squared = distances[c as usize];
                    stack[height] =
                        Pending { distance_squared, level: level + 1, node: node * WIDTH as u32 + c };
                    height += 1;
                }
            }
        }
    }
}

/// Children within the bound, nearest first where the visitor wants that; and how many.
#[inline(always)]
fn near_children<V: Visitor>(distances: &[f32; WIDTH], bound: f32) -> ([u8; WIDTH], usize) {
    let mut near = [0u8; WIDTH];
    let mut count = 0;
    for c in 0..WIDTH {
        if distances[c] <= bound {
            let mut at = count;
            if V::NEAREST_FIRST {
                while at > 0 && distances[near[at - 1] as usize] > distances[c] {
                    near[at] = near[at - 1];
                    at -= 1;
                }
            }
            near[at] = c as u8;
            count += 1;
        }
    }
    (near, count)
}
