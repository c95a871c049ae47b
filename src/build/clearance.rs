//! How far a surface goes on around a point of it, where that can be told from its shape alone.

use super::surface::Surface;
use super::world::{Geometry, World};

impl World {
    /// A lower bound on the distance along the surface from a point of it to where its face ends, metres;
    /// 0 where nothing is known.
    pub fn clearance(&self, surface: &Surface) -> f64 {
        let placement = &self.instances[surface.instance as usize].placement;
        match self.geometry(surface.instance) {
            Geometry::Shape(shape) => shape.clearance(surface.local) * placement.least_stretch(),
            Geometry::Mesh(_) => 0.0,
        }
    }
}
