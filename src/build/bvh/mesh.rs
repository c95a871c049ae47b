//! The tree over a mesh's triangles, which are copied into packets of eight, a leaf each, in the
//! order in which the tree names them. The caller's vertices and indices are not kept.

use super::binned::{self, Item};
use super::collapse::{Leaf, collapse};
use super::node::{self, MAX_COUNT};
use super::packet::{self, Packet, Shear, TriangleHit};
use super::ray::{BoxRay, Slabs};
use super::store::Store;
use super::traverse::walk;
use super::tree::check;
use crate::math::lanes::{Lanes, Machine, Work};
use crate::math::{Aabb, Vec3};
use rayon::prelude::*;

/// Triangles in a packet, and so in a leaf.
const LANES: usize = 8;

/// The triangles of a mesh and the tree over them.
///
/// Coordinates may reach from 1e-18 to 1e18 in magnitude: beyond, the triangle test's products
/// leave single precision, and hits are missed.
#[derive(Clone, Debug)]
pub struct TriangleBvh {
    pub(super) nodes: Store<node::Rows>,
    pub(super) packets: Store<packet::Rows>,
    bounds: Aabb,
    triangles: usize,
    pub(super) machine: Machine,
}

impl TriangleBvh {
    /// Builds the tree. Left out are triangles of no area, with a vertex that is not finite, or
    /// with an index past the vertices. Parallel; the result does not depend on the number of
    /// threads.
    pub fn build(vertices: &[Vec3], triangles: &[[u32; 3]]) -> TriangleBvh {
        assert!(triangles.len() <= MAX_COUNT, "a mesh holds less than 2^31 triangles");
        let mut items: Vec<Item> = triangles
            .par_iter()
            .enumerate()
            .filter_map(|(i, t)| solid(vertices, t).map(|v| Item::new(&Aabb::from_points(v), i as u32)))
            .collect();
        let machine = Machine::detect();
        if items.is_empty() {
            let (nodes, packets) = (Store::zeroed(0), Store::zeroed(0));
            return TriangleBvh { nodes, packets, bounds: Aabb::EMPTY, triangles: 0, machine };
        }
        let binary = binned::build(&mut items, LANES);
        let order: Vec<u32> = items.par_iter().map(Item::index).collect();
        drop(items);
        let wide = collapse(&binary);
        drop(binary);
        let mut nodes = Store::zeroed(wide.nodes.len());
        nodes.blocks_mut().copy_from_slice(&wide.nodes);
        let mut packets = Store::zeroed(wide.leaves.len());
        let fill = |(rows, leaf): (&mut packet::Rows, &Leaf)| {
            *rows = packet(leaf, &order, vertices, triangles);
        };
        packets.blocks_mut().par_iter_mut().zip(&wide.leaves).for_each(fill);
        let bounds = node::root_bounds(&wide.nodes);
        TriangleBvh { nodes, packets, bounds, triangles: order.len(), machine }
    }

    /// The nearest hit with 0 < t < `t_max`, on either side of a triangle. Of hits at one distance,
    /// the one on the triangle of smallest index. No ray passes between triangles that share an
    /// edge.
    #[inline]
    pub fn nearest(&self, ray: &BoxRay, t_max: f32) -> Option<TriangleHit> {
        self.machine.run(Nearest { mesh: self, ray, t_max })
    }

    /// Whether there is a hit with 0 < t < `t_max`.
    #[inline]
    pub fn any(&self, ray: &BoxRay, t_max: f32) -> bool {
        self.machine.run(Any { mesh: self, ray, t_max })
    }

    /// The box around the triangles, empty if there are none.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Triangles that can be hit: those given, less those left out.
    pub fn triangles(&self) -> usize {
        self.triangles
    }

    /// Bytes that the tree takes.
    pub fn memory_bytes(&self) -> usize {
        self.nodes.bytes() + self.packets.bytes()
    }

    /// Checks the tree against what it was built from: every triangle with an area is there once,
    /// unaltered, within all the boxes above it.
    pub fn validate(&self, vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<(), String> {
        let mut seen = vec![false; triangles.len()];
        check(self.nodes.blocks(), &mut |leaf, bounds| {
            let packet = self.packets.blocks().get(leaf as usize).ok_or("a leaf names no packet")?;
            for (i, corners) in Packet(packet).filled() {
                let given = triangles.get(i as usize).and_then(|t| solid(vertices, t));
                if given != Some(corners) || std::mem::replace(&mut seen[i as usize], true) {
                    return Err("a triangle is there twice, or altered");
                }
                if !corners.iter().all(|v| bounds.contains(*v)) {
                    return Err("a triangle leaves its box");
                }
            }
            Ok(())
        })?;
        match seen.iter().zip(triangles).position(|(seen, t)| *seen != solid(vertices, t).is_some()) {
            Some(i) => Err(format!("triangle {i} is missing")),
            None => Ok(()),
        }
    }

    /// Everything that the tree holds, for comparing trees.
    #[cfg(test)]
    pub(super) fn fingerprint(&self) -> (Vec<[u32; 64]>, Vec<Vec<u32>>) {
        let bits = |rows| node::Node(rows).to_bits();
        let ids = |rows| Packet(rows).filled().map(|(i, _)| i).collect();
        (self.nodes.blocks().iter().map(bits).collect(), self.packets.blocks().iter().map(ids).collect())
    }

    #[cfg(test)]
    pub(super) fn portable(mut self) -> TriangleBvh {
        self.machine = Machine::portable();
        self
    }
}

/// The corners of a triangle that has an area: whose normal, in double precision, is not 0.
fn solid(vertices: &[Vec3], triangle: &[u32; 3]) -> Option<[Vec3; 3]> {
    let corner = |i: usize| vertices.get(triangle[i] as usize).copied().filter(|v| v.is_finite());
    let v = [corner(0)?, corner(1)?, corner(2)?];
    let [a, b, c] = v.map(|v| v.as_dvec3());
    ((b - a).cross(c - a).abs().max_element() > 0.0).then_some(v)
}

fn packet(leaf: &Leaf, order: &[u32], vertices: &[Vec3], triangles: &[[u32; 3]]) -> packet::Rows {
    let mut rows = packet::EMPTY;
    let ids = &order[leaf.first as usize..][..leaf.count as usize];
    for (lane, &id) in ids.iter().enumerate() {
        packet::set(&mut rows, lane, id, triangles[id as usize].map(|v| vertices[v as usize]));
    }
    rows
}

struct Nearest<'a> {
    mesh: &'a TriangleBvh,
    ray: &'a BoxRay,
    t_max: f32,
}

impl Work for Nearest<'_> {
    type Output = Option<TriangleHit>;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Option<TriangleHit> {
        if !self.ray.is_valid() {
            return None;
        }
        let slabs = Slabs::new(lanes, self.ray, &self.mesh.bounds);
        let shear = Shear::new(lanes, self.ray, &self.mesh.bounds);
        let (nodes, packets) = (self.mesh.nodes.blocks(), self.mesh.packets.blocks());
        let mut best = TriangleHit { t: self.t_max, triangle: 0, b: [0.0; 3] };
        let mut found = false;
        walk::<L, true>(
            lanes,
            nodes,
            &slabs,
            self.t_max,
            #[inline(always)]
            |leaf, _| {
                found |= Packet(&packets[leaf as usize]).nearest(lanes, &shear, &mut best);
                best.t
            },
        );
        found.then_some(best)
    }
}

struct Any<'a> {
    mesh: &'a TriangleBvh,
    ray: &'a BoxRay,
    t_max: f32,
}

impl Work for Any<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> bool {
        if !self.ray.is_valid() {
            return false;
        }
        let slabs = Slabs::new(lanes, self.ray, &self.mesh.bounds);
        let shear = Shear::new(lanes, self.ray, &self.mesh.bounds);
        let (nodes, packets) = (self.mesh.nodes.blocks(), self.mesh.packets.blocks());
        let mut found = false;
        walk::<L, false>(
            lanes,
            nodes,
            &slabs,
            self.t_max,
            #[inline(always)]
            |leaf, t_max| {
                found = Packet(&packets[leaf as usize]).any(lanes, &shear, t_max);
                if found { -1.0 } else { t_max }
            },
        );
        found
    }
}
