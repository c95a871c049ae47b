//! How far off their true places the points of an instance may be met.

use super::world::{Geometry, Instance};
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
}
