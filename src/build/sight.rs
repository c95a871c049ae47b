//! What can hide a lamp's point, for scenes of a handful of objects, without a test of their bounds.
//!
//! The directions are a cube around the point, each of its faces divided into cells; a cell holds the set of
//! the objects whose bounds reach into its pyramid: the light buffer of Haines & Greenberg 1986 (The Light
//! Buffer, CG&A 6(9)).

use super::world::{Geometry, Instance, World};
use crate::math::{Aabb, DVec3, Ray};
use crate::optics::Shape;

/// Objects at most: bits of a cell.
const FEW: usize = 16;

/// Cells along an edge of the cube.
const SIDE: usize = 64;

/// The objects around a point, by direction.
#[derive(Clone, Debug)]
pub struct Sight {
    /// The nearest bounds first; bit i of a cell stands for the i-th.
    instances: Vec<u32>,
    /// By instance of the world: its bit if it is convex, so that a ray that leaves its outer side cannot
    /// meet it again.
    convex: Vec<u16>,
    /// Rows of columns of faces −x, +x, −y, +y, −z, +z.
    cells: Vec<u16>,
}

/// Bounds seen from the point along one face's axis, and across it.
struct Seen {
    along: [f64; 2],
    across: [[f64; 2]; 2],
}

impl Sight {
    /// From the point `from`; `bounds` are the instances'. `None` where they are too many.
    pub(super) fn new(
        from: DVec3,
        instances: &[Instance],
        geometries: &[Geometry],
        bounds: &[Aabb],
    ) -> Option<Sight> {
        let mut near: Vec<(f64, u32)> = (0u32..)
            .zip(bounds)
            .filter(|(_, b)| b.min.cmple(b.max).all())
            .map(|(i, b)| (from.clamp(b.min.as_dvec3(), b.max.as_dvec3()).distance(from), i))
            .collect();
        if near.len() > FEW || !from.is_finite() {
            return None;
        }
        near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut sight = Sight {
            instances: near.iter().map(|&(_, i)| i).collect(),
            convex: vec![0; instances.len()],
            cells: vec![0; 6 * SIDE * SIDE],
        };
        for (bit, &(_, i)) in near.iter().enumerate() {
            sight.enter(from, &bounds[i as usize], 1 << bit);
            if convex(&geometries[instances[i as usize].geometry as usize]) {
                sight.convex[i as usize] = 1 << bit;
            }
        }
        Some(sight)
    }

    /// Sets the bit in every cell that the bounds reach into, with room for what traversal in single
    /// precision makes of a ray.
    fn enter(&mut self, from: DVec3, bounds: &Aabb, bit: u16) {
        let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let room = (from.abs() + min.abs().max(max.abs())).max_element() * 16.0 * f64::from(f32::EPSILON);
        let (min, max) = (min - from - room, max - from + room);
        for face in 0..6 {
            let axis = face / 2;
            let along = if face % 2 == 0 { [-max[axis], -min[axis]] } else { [min[axis], max[axis]] };
            if along[1] <= 0.0 {
                continue;
            }
            let across = [1, 2].map(|k| [min[(axis + k) % 3], max[(axis + k) % 3]]);
            let seen = Seen { along: [along[0].max(0.0), along[1]], across };
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
    fn towards(&self, dir: DVec3) -> u16 {
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
        let cell = |x: f64| ((x * scale + 0.5 * SIDE as f64) as i32).clamp(0, SIDE as i32 - 1) as usize;
        self.cells[(face * SIDE + cell(across[1])) * SIDE + cell(across[0])]
    }
}

impl Seen {
    /// Whether the bounds reach between the two planes through the point that bound a column (0) or row (1).
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

impl World {
    /// Whether anything lies on the way of a ray at 0 < t < 1 that ends in the position of an emitter
    /// without extent, by its index. `leaving`: the instance whose outer side (of a flat shape: either side)
    /// the ray leaves.
    #[inline]
    pub fn hidden_from(&self, emitter: usize, ray: &Ray, leaving: Option<u32>) -> bool {
        let Some(Some(sight)) = self.sights.get(emitter) else { return self.occluded(ray, 1.0, None) };
        let mut left = sight.towards(-ray.dir);
        if let Some(instance) = leaving {
            left &= !sight.convex[instance as usize];
        }
        while left != 0 {
            let instance = sight.instances[left.trailing_zeros() as usize];
            left &= left - 1;
            if self.hides(instance, ray, 1.0) {
                return true;
            }
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;
    use crate::math::random::{Counter, Stage};
    use crate::optics::EmitterKind;

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
            let mut sight =
                Sight { instances: Vec::new(), convex: Vec::new(), cells: vec![0; 6 * SIDE * SIDE] };
            for (bit, bounds) in boxes.iter().enumerate() {
                sight.enter(from, bounds, 1 << bit);
            }
            let mut alone = 0;
            for _ in 0..500 {
                // A point of a box, or its corner.
                let bit = (vector(1.0).x.abs() * 2.0 * FEW as f64) as usize;
                let (min, max) = (boxes[bit].min.as_dvec3(), boxes[bit].max.as_dvec3());
                let share = (vector(3.0) + 0.5).clamp(DVec3::ZERO, DVec3::ONE);
                let mask = sight.towards(min + (max - min) * share - from);
                assert!(mask >> bit & 1 == 1, "round {round}, box {bit}");
                alone += u32::from(mask.count_ones() < 8);
            }
            assert!(alone > 0, "every direction lists nearly everything");
        }
    }

    /// The same answers as the tree's, for rays all over a scene of every shape, lit from within it.
    #[test]
    fn a_lamp_is_hidden_where_the_tree_finds_something() {
        let text = r#"(camera: (eye: (0.3, 1.5, 4), target: (0, 0.4, 0)), image: (width: 8, height: 8),
            materials: { "m": (diffuse: 0.5), "glass": (transmission: 1) },
            lights: { "lamp": point(position: (-1, 2, 1), intensity: 1) },
            objects: [(shape: quad(size: (9, 9)), material: "m"), (shape: sphere(radius: 0.5, center: (-0.6, 0.5, 0)), material: "glass"),
                (shape: box(size: (1, 1, 1), center: (0, 0.5, 0)), material: "m", transform: [rotate(axis: (0, 1, 0), deg: 30), translate((1.4, 0, -1))]),
                (shape: cone(radius: 0.4, height: 1.2), material: "m", transform: [translate((0.6, 0, 0.4))]),
                (shape: disk(radius: 0.7), material: "m", transform: [rotate(axis: (1, 0, 0), deg: 70), translate((0, 1.6, -1))])])"#;
        let format = crate::description::Format::Ron;
        let scene =
            crate::description::load_str(text, format, std::path::Path::new(""), &[]).expect("valid").scene;
        let plan = crate::plan::Plan::new(&scene, &Default::default()).expect("nothing is overridden");
        let world = crate::build::build(&scene, &plan).expect("it can be built").world;
        assert!(world.sights[0].is_some());
        let EmitterKind::Point { position, .. } = world.emitters[0].kind else { unreachable!() };
        let mut random = Counter::new(8, Stage::Test, 0);
        let (mut met, mut hidden) = (0, 0);
        for _ in 0..20_000 {
            let u = [(); 3].map(|()| random.value());
            let aim = DVec3::new(5.0 * u[0] - 2.5, 2.0 * u[1] - 0.4, 4.0 * u[2] - 2.5);
            let ray = Ray { origin: world.camera.eye, dir: (aim - world.camera.eye).normalize() };
            let hit = world.nearest(&ray, f64::INFINITY);
            let Some(hit) = hit else { continue };
            met += 1;
            let surface = world.surface(&ray, &hit);
            let side = if ray.dir.dot(surface.ng) < 0.0 { 1.0 } else { -1.0 };
            let origin = surface.p + surface.ng * (side * surface.p_error);
            let shadow = Ray { origin, dir: position - origin };
            let outside = side > 0.0 && shadow.dir.dot(surface.ng) > 0.0;
            let expected = world.occluded(&shadow, 1.0, None);
            assert_eq!(world.hidden_from(0, &shadow, outside.then_some(surface.instance)), expected);
            hidden += u32::from(expected);
        }
        assert!(met > 5_000 && hidden > 200 && hidden < met, "{met} met, {hidden} hidden");
    }

    #[test]
    fn a_direction_without_a_length_is_looked_up() {
        let sight = Sight { instances: Vec::new(), convex: Vec::new(), cells: vec![0; 6 * SIDE * SIDE] };
        for dir in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY] {
            assert_eq!(sight.towards(dir), 0);
        }
        let far = Aabb { min: Vec3::splat(1.0), max: Vec3::splat(2.0) };
        let mut sight = sight;
        sight.enter(DVec3::ZERO, &far, 1);
        assert_eq!((sight.towards(DVec3::ONE), sight.towards(DVec3::NEG_ONE)), (1, 0));
    }
}
