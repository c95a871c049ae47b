//! What lies in a direction from a point, or from anywhere in a box, for scenes of a handful of objects: which of
//! them a ray may meet, without a test of their bounds.
//!
//! The directions are a cube, each of its faces divided into cells; a cell holds the set of the objects whose
//! bounds reach into its pyramid. Around a lamp's point this is the light buffer of Haines & Greenberg 1986 (The
//! Light Buffer, CG&A 6(9)). Around a box, what is seen from any of its points is what is seen from 0 of the
//! Minkowski difference: the object's bounds, widened by the box's size.

use super::world::{Geometry, Instance};
use crate::math::{Aabb, DVec3};
use crate::optics::Shape;

/// Objects at most: bits of a cell.
pub(super) const FEW: usize = 16;

/// The objects around a place, by direction; `SIDE` cells along an edge of the cube.
#[derive(Clone, Debug)]
pub struct Sight<const SIDE: usize> {
    /// The nearest bounds first, each with its least distance; bit i of a cell stands for the i-th.
    instances: Vec<(u32, f64)>,
    /// By instance of the world: its bit if it is convex, so that a ray that leaves its outer side cannot
    /// meet it again.
    convex: Vec<u16>,
    /// Rows of columns of faces −x, +x, −y, +y, −z, +z.
    cells: Vec<u16>,
}

/// Bounds seen from the place along one face's axis, and across it.
struct Seen<const SIDE: usize> {
    along: [f64; 2],
    across: [[f64; 2]; 2],
}

/// The objects of a direction that are still to be looked at.
#[derive(Clone, Copy)]
pub(super) struct Left(u16);

impl<const SIDE: usize> Sight<SIDE> {
    /// From anywhere between the corners of `from`; `bounds` are the instances'. `None` where they are too many.
    pub(super) fn new(
        from: [DVec3; 2],
        instances: &[Instance],
        geometries: &[Geometry],
        bounds: &[Aabb],
    ) -> Option<Self> {
        let [least, most] = from;
        // Between the nearest points of two boxes.
        let gap =
            |b: &Aabb| (b.min.as_dvec3() - most).max(least - b.max.as_dvec3()).max(DVec3::ZERO).length();
        let mut near: Vec<(u32, f64)> = (0u32..)
            .zip(bounds)
            .filter(|(_, b)| b.min.cmple(b.max).all())
            .map(|(i, b)| (i, (gap(b) - room(from, b)).max(0.0) * (1.0 - 1e-9)))
            .collect();
        if near.len() > FEW || !(least.is_finite() && most.is_finite()) {
            return None;
        }
        near.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        let mut sight =
            Sight { instances: near, convex: vec![0; instances.len()], cells: vec![0; 6 * SIDE * SIDE] };
        for bit in 0..sight.instances.len() {
            let i = sight.instances[bit].0 as usize;
            sight.enter(from, &bounds[i], 1 << bit);
            if convex(&geometries[instances[i].geometry as usize]) {
                sight.convex[i] = 1 << bit;
            }
        }
        Some(sight)
    }

    /// Sets the bit in every cell that the bounds reach into.
    fn enter(&mut self, from: [DVec3; 2], bounds: &Aabb, bit: u16) {
        let room = room(from, bounds);
        let (min, max) = (bounds.min.as_dvec3() - from[1] - room, bounds.max.as_dvec3() - from[0] + room);
        for face in 0..6 {
            let axis = face / 2;
            let along = if face % 2 == 0 { [-max[axis], -min[axis]] } else { [min[axis], max[axis]] };
            if along[1] <= 0.0 {
                continue;
            }
            let across = [1, 2].map(|k| [min[(axis + k) % 3], max[(axis + k) % 3]]);
            let seen = Seen::<SIDE> { along: [along[0].max(0.0), along[1]], across };
            let columns: [bool; SIDE] = std::array::from_fn(|i| seen.reaches(0, i));
            for row in (0..SIDE).filter(|&row| seen.reaches(1, row)) {
                let start = (face * SIDE + row) * SIDE;
                for (cell, _) in self.cells[start..start + SIDE].iter_mut().zip(columns).filter(|c| c.1) {
                    *cell |= bit;
                }
            }
        }
    }

    /// The objects that may lie in a direction of any length.
    #[inline]
    pub(super) fn towards(&self, dir: DVec3) -> Left {
        let size = dir.abs();
        let (axis, across) = if size.x >= size.y && size.x >= size.z {
            (0, [dir.y, dir.z])
        } else if size.y >= size.z {
            (1, [dir.z, dir.x])
        } else {
            (2, [dir.x, dir.y])
        };
        let face = 2 * axis + usize::from(dir[axis] > 0.0);
        let scale = 0.5 * SIDE as f64 / size[axis];
        let cell = |x: f64| {
            // Rounded to a whole number by adding one so large that its last bit is 1: on the border of two cells
            // either will do. Comparisons, unlike `clamp`, take NaN to 0.
            const LARGE: f64 = 1.5 * (1u64 << 52) as f64;
            let at = x * scale + (0.5 * SIDE as f64 - 0.5);
            let at = if at > 0.0 { at } else { 0.0 };
            let at = if at < SIDE as f64 - 1.0 { at } else { SIDE as f64 - 1.0 };
            (at + LARGE).to_bits() as usize % SIDE
        };
        Left(self.cells[(face * SIDE + cell(across[1])) * SIDE + cell(across[0])])
    }

    /// Leaves out an instance whose outer side (of a flat shape: either side) the ray leaves, if it is convex.
    #[inline]
    pub(super) fn but(&self, Left(left): Left, instance: u32) -> Left {
        Left(left & !self.convex[instance as usize])
    }

    /// The next object, the nearest bounds first, with the distance at which it may begin.
    #[inline]
    pub(super) fn next(&self, left: &mut Left) -> Option<(u32, f64)> {
        if left.0 == 0 {
            return None;
        }
        let bit = left.0.trailing_zeros();
        left.0 &= left.0 - 1;
        Some(self.instances[bit as usize])
    }

    pub(super) fn memory_bytes(&self) -> usize {
        size_of_val(self.instances.as_slice())
            + size_of_val(self.convex.as_slice())
            + size_of_val(self.cells.as_slice())
    }
}

/// Room for what rounding makes of a ray: of traversal in single precision, and of where a ray starts that
/// leaves a surface.
fn room(from: [DVec3; 2], bounds: &Aabb) -> f64 {
    let size =
        from[0].abs().max(from[1].abs()) + bounds.min.as_dvec3().abs().max(bounds.max.as_dvec3().abs());
    size.max_element() * 64.0 * f64::from(f32::EPSILON)
}

impl<const SIDE: usize> Seen<SIDE> {
    /// Whether the bounds reach between the two planes through the place that bound a column (0) or row (1).
    fn reaches(&self, way: usize, i: usize) -> bool {
        // Wider than the rounding of a lookup.
        let at = |i: f64| 2.0 * i / SIDE as f64 - 1.0;
        let (low, high) = (at(i as f64 - 1e-6), at(i as f64 + 1.0 + 1e-6));
        let [near, far] = self.along;
        let [from, to] = self.across[way];
        to >= (low * near).min(low * far) && from <= (high * near).max(high * far)
    }
}

/// Whether a ray that leaves the outer side (of a flat shape: either side) cannot meet it again.
fn convex(geometry: &Geometry) -> bool {
    match geometry {
        Geometry::Shape(Shape::Cone(cone)) => cone.capped(),
        Geometry::Shape(_) => true,
        Geometry::Mesh(_) => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;
    use crate::math::random::{Counter, Stage};

    fn empty() -> Sight<64> {
        Sight { instances: Vec::new(), convex: Vec::new(), cells: vec![0; 6 * 64 * 64] }
    }

    /// Of boxes of all sizes, near and far and around the point, every one that a line from the point meets
    /// is among those of its direction.
    #[test]
    fn everything_in_a_direction_is_listed_there() {
        let mut random = Counter::new(7, Stage::Test, 0);
        let mut vector = |scale: f64| DVec3::from([(); 3].map(|()| (random.value() - 0.5) * scale));
        for round in 0..200 {
            let scale = [1e-3, 1.0, 1e3][round % 3];
            let from = vector(4.0 * scale);
            let boxes: Vec<Aabb> = (0..FEW)
                .map(|i| {
                    let (middle, half) = (vector(4.0 * scale), vector([0.1, 1.0, 4.0][i % 3] * scale).abs());
                    Aabb::from_f64(middle - half, middle + half)
                })
                .collect();
            // From a point, or from anywhere in a box around it.
            let half = vector([0.0, 0.3 * scale][round % 2]).abs();
            let around = [from - half, from + half];
            let mut sight = empty();
            for (bit, bounds) in boxes.iter().enumerate() {
                sight.enter(around, bounds, 1 << bit);
            }
            let mut alone = 0;
            for _ in 0..500 {
                // A point of a box, or its corner.
                let bit = (vector(1.0).x.abs() * 2.0 * FEW as f64) as usize;
                let (min, max) = (boxes[bit].min.as_dvec3(), boxes[bit].max.as_dvec3());
                let share = (vector(3.0) + 0.5).clamp(DVec3::ZERO, DVec3::ONE);
                let from = from + 2.0 * half * vector(1.0);
                let Left(mask) = sight.towards(min + (max - min) * share - from);
                assert!(mask >> bit & 1 == 1, "round {round}, box {bit}");
                alone += u32::from(mask.count_ones() < 8);
            }
            assert!(alone > 0, "every direction lists nearly everything");
        }
    }

    #[test]
    fn a_direction_without_a_length_is_looked_up() {
        let sight = empty();
        for dir in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY] {
            assert_eq!(sight.towards(dir).0, 0);
        }
        let far = Aabb { min: Vec3::splat(1.0), max: Vec3::splat(2.0) };
        let mut sight = sight;
        sight.enter([DVec3::ZERO; 2], &far, 1);
        assert_eq!((sight.towards(DVec3::ONE).0, sight.towards(DVec3::NEG_ONE).0), (1, 0));
    }
}
