//! How far off their true places the points of an instance may be met.

use super::world::{Geometry, Instance};
use crate::math::{Aabb, DVec3};
use std::collections::HashMap;

/// Bounds of the `p_error` of instances' surfaces, metres, each geometry being looked at once.
pub(super) struct Precision<'a> {
    geometries: &'a [Geometry],
    known: HashMap<u32, f64>,
}

impl<'a> Precision<'a> {
    pub fn new(geometries: &'a [Geometry]) -> Precision<'a> {
        Precision { geometries, known: HashMap::new() }
    }

    pub fn of(&mut self, instance: &Instance) -> f64 {
        let geometry = &self.geometries[instance.geometry as usize];
        let local = *self.known.entry(instance.geometry).or_insert_with(|| match geometry {
            Geometry::Shape(shape) => shape.p_error(),
            Geometry::Mesh(mesh) => mesh.surface.most_error(),
        });
        let (min, max) = geometry.bounds();
        let corner = min.abs().max(max.abs()).length();
        let placement = &instance.placement;
        let (stretch, away) = (placement.stretch(), placement.world_from_object.translation.length());
        // Sums of coordinates, as those errors are told by, are up to √3 times their lengths.
        local * stretch + 32.0 * f64::EPSILON * (away + 2.0 * stretch * corner)
    }

    /// Whether a box lies so deep in a solid shape that nothing in it is near the shape's surface. False of meshes.
    pub fn holds(&self, solid: &Instance, bounds: &Aabb) -> bool {
        let Geometry::Shape(shape) = &self.geometries[solid.geometry as usize] else { return false };
        let (_, radius) = shape.ball();
        // Solid shapes are convex: with its corners the box is inside, at their depth at the least.
        let deep = |corner: DVec3| shape.depth(solid.placement.local_point(corner)) > DEEP * radius;
        let [min, max] = [bounds.min.as_dvec3(), bounds.max.as_dvec3()];
        let pick = |i: u32, bit: u32, axis: usize| if i & bit == 0 { min[axis] } else { max[axis] };
        shape.closed() && (0..8).all(|i| deep(DVec3::new(pick(i, 1, 0), pick(i, 2, 1), pick(i, 4, 2))))
    }
}

/// Of a shape's radius: far more than any surface's error.
const DEEP: f64 = 1e-3;
