//! The photon map and its construction.

use super::boxes::{Bounds, Boxes};
use super::photon::{NO_DIRECTION, Packed};
use crate::math::Vec3;
use crate::math::lanes::Array;
use crate::scatter::{Photon, Photons, apart};
use kiddo::kd_tree::KdTreeAccessor;
use kiddo::{Eytzinger, FlatVec, KdTree, LeafStrategy};
use rayon::prelude::*;

/// Photons of one leaf.
pub const LEAF: usize = 8 * HALVES;
pub const HALVES: usize = 2;
/// Most photons of a leaf of `kiddo`'s. It makes a power of two of them, so that they are half full at
/// worst; leaves of [`LEAF`] made from such buckets are all full but the last.
const BUCKET: usize = 512;
/// Fewer photons than this are divided by one thread; how many never changes the tree.
const WORTH_A_THREAD: usize = 1 << 14;

/// Watts: more could not be stored, nor come from a lamp.
const MOST_POWER: f32 = 1e38;

type Tree = KdTree<f32, u32, Eytzinger, FlatVec<f32, u32, 3, BUCKET>, 3, BUCKET>;

/// Positions of a leaf's photons, metres, by axis. Places without a photon hold NaN, which is within
/// no distance of anything.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub struct Positions {
    pub x: [Array; HALVES],
    pub y: [Array; HALVES],
    pub z: [Array; HALVES],
}

impl Positions {
    const NONE: Positions =
        Positions { x: [[f32::NAN; 8]; HALVES], y: [[f32::NAN; 8]; HALVES], z: [[f32::NAN; 8]; HALVES] };

    fn of(places: &[Place]) -> Positions {
        let mut all = Positions::NONE;
        for (i, place) in places.iter().enumerate() {
            let (half, lane) = (i / 8, i % 8);
            [all.x[half][lane], all.y[half][lane], all.z[half][lane]] = place.position.to_array();
        }
        all
    }

    /// Photons of the leaf, which come first.
    fn count(&self) -> usize {
        self.x.iter().flatten().take_while(|x| !x.is_nan()).count()
    }

    fn bounds(&self, count: usize) -> Bounds {
        (0..count).fold(Bounds::EMPTY, |bounds, place| bounds.with(self.at(place)))
    }

    #[inline(always)]
    pub fn at(&self, place: usize) -> Vec3 {
        let (half, lane) = (place / 8, place % 8);
        Vec3::new(self.x[half][lane], self.y[half][lane], self.z[half][lane])
    }
}

/// Photons, ready to be gathered.
#[derive(Clone, Debug, Default)]
pub struct PhotonMap {
    pub(super) boxes: Boxes,
    pub(super) positions: Vec<Positions>,
    /// The rest of the photon in place i of leaf l is at l · LEAF + i.
    pub(super) packed: Vec<Packed>,
    /// The code of the normal that all photons of a leaf have, or [`NO_DIRECTION`].
    pub(super) normals: Vec<u32>,
    count: usize,
    refused: usize,
}

impl PhotonMap {
    /// The map of these photons. Those with a value that is not finite, or with power outside 0 to
    /// 1e38 W, are left out and counted. The same photons in the same order make the same map, whatever the
    /// number of threads.
    pub fn new(photons: impl Into<Photons>) -> PhotonMap {
        let photons = photons.into();
        let all = photons.len();
        let photons = photons.only(is_sound);
        let (order, buckets) = partition(&photons);
        let leaves = buckets.iter().map(|len| len.div_ceil(LEAF)).sum();
        let (mut positions, mut packed) = (apart(leaves), apart(leaves * LEAF));
        positions.resize(leaves, Positions::NONE);
        packed.resize(leaves * LEAF, Packed::default());
        let mut work = Vec::with_capacity(buckets.len());
        let (mut o, mut at, mut rest) = (&order[..], &mut positions[..], &mut packed[..]);
        for len in buckets {
            let leaves = len.div_ceil(LEAF);
            work.push((
                o.split_off(..len).expect("a bucket's photons"),
                at.split_off_mut(..leaves).expect("its leaves"),
                rest.split_off_mut(..leaves * LEAF).expect("and their places"),
            ));
        }
        work.into_par_iter().for_each(|(order, positions, packed)| fill(&photons, order, positions, packed));
        let counts = packed.chunks(LEAF).zip(&positions).map(|(packed, at)| (packed, at.count()));
        let (normals, bounds) = counts
            .zip(&positions)
            .map(|((packed, n), at)| (common_normal(&packed[..n]), at.bounds(n)))
            .unzip();
        PhotonMap {
            normals,
            boxes: Boxes::new(bounds),
            positions,
            packed,
            count: photons.len(),
            refused: all - photons.len(),
        }
    }

    /// Photons in the map.
    pub fn len(&self) -> usize {
        self.count
    }

    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Photons that were left out because they are not finite.
    pub fn refused(&self) -> usize {
        self.refused
    }

    /// All that the map holds: under 32 bytes a photon, from some hundreds of photons on.
    pub fn memory_bytes(&self) -> usize {
        self.boxes.memory_bytes()
            + self.positions.len() * size_of::<Positions>()
            + self.packed.len() * size_of::<Packed>()
            + self.normals.capacity() * size_of::<u32>()
    }
}

fn is_sound(photon: &Photon) -> bool {
    let Photon { position, wi, normal, power, .. } = photon;
    [position, wi, normal, power].into_iter().all(|v| v.is_finite())
        && power.cmpge(Vec3::ZERO).all()
        && power.max_element() <= MOST_POWER
}

fn common_normal(packed: &[Packed]) -> u32 {
    let first = packed[0].normal;
    if packed.iter().all(|p| p.normal == first) { first } else { NO_DIRECTION }
}

/// A rotation (times 3/8) whose axes are far from the scene's: a tree that divides along its own
/// axes in turn would waste one level in three on a floor.
fn turned(p: Vec3) -> [f32; 3] {
    let p = p / 8.0;
    [2.0 * p.x - p.y + 2.0 * p.z, 2.0 * p.x + 2.0 * p.y - p.z, 2.0 * p.y + 2.0 * p.z - p.x]
}

/// Photons in the order of a kd-tree's buckets, and how many each bucket has.
fn partition(photons: &Photons) -> (Vec<u32>, Vec<usize>) {
    if photons.is_empty() {
        return (Vec::new(), Vec::new());
    }
    let mut points: Vec<[f32; 3]> = apart(photons.len());
    photons.map_into(&mut points, |photon| turned(photon.position));
    let tree: Tree = Tree::builder()
        .with_parallel_construction_threshold(WORTH_A_THREAD)
        .build_from_slice(&points)
        .expect("coordinates are finite, and photons fewer than 2^32");
    let mut order: Vec<u32> = apart(photons.len());
    order.extend(tree.iter().map(|(index, _)| index));
    let len = |bucket| LeafStrategy::<f32, u32, Eytzinger, 3, BUCKET>::leaf_len(tree.leaves(), bucket);
    (order, (0..tree.leaf_count()).map(len).collect())
}

/// Divides a bucket's photons into leaves, all full but the last. They lie anywhere in memory, and are fetched once.
fn fill(photons: &Photons, order: &[u32], positions: &mut [Positions], packed: &mut [Packed]) {
    let mut places: Vec<Place> =
        order.iter().map(|&index| Place { position: photons.at(index as usize).position, index }).collect();
    divide(&mut places);
    for (leaf, at) in places.chunks(LEAF).zip(positions) {
        *at = Positions::of(leaf);
    }
    for (place, packed) in places.iter().zip(packed) {
        *packed = Packed::new(photons.at(place.index as usize), place.index as usize);
    }
}

/// A photon's position, and its place among all.
#[derive(Clone, Copy)]
struct Place {
    position: Vec3,
    index: u32,
}

/// Orders photons so that each [`LEAF`] of them in turn lie together, by planes across the longest
/// side of their box, which leave whole leaves on the lower side.
fn divide(places: &mut [Place]) {
    if places.len() <= LEAF {
        return;
    }
    let box_of_all = places.iter().fold(Bounds::EMPTY, |bounds, place| bounds.with(place.position));
    let axis = (box_of_all.hi - box_of_all.lo).max_position();
    let lower = places.len().div_ceil(2 * LEAF) * LEAF;
    let key = |place: &Place| place.position[axis];
    places.select_nth_unstable_by(lower, |a, b| key(a).total_cmp(&key(b)).then(a.index.cmp(&b.index)));
    let (lower, upper) = places.split_at_mut(lower);
    divide(lower);
    divide(upper);
}
