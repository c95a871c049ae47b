//! The point of a shape that a ray has met, in the shape's own space.

use glam::{DVec2, DVec3};

/// A surface point in object space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalSurface {
    pub p: DVec3,
    /// Bound on how far, along the normal, `p` may lie from the surface that a further ray through it
    /// would find. Same unit as `p`. Rays that leave start this far off the surface.
    pub p_error: f64,
    /// Unit geometric normal, out of the solid; for open shapes the side of +y, or of the mesh's winding.
    pub ng: DVec3,
    /// Unit shading normal, in the hemisphere of `ng`.
    pub ns: DVec3,
    /// Surface coordinates; [0, 1]² on all analytic shapes.
    pub uv: DVec2,
    /// ∂p/∂u and ∂p/∂v, in the plane of `ng`; zero where the coordinates are singular.
    pub dpdu: DVec3,
    pub dpdv: DVec3,
}

/// Where a surface point lies in its shape's coordinates, and how they run there: as in [`LocalSurface`], or in
/// the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coordinates {
    pub uv: DVec2,
    pub dpdu: DVec3,
    pub dpdv: DVec3,
}
