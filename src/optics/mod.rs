//! What light meets: shapes, surfaces, materials, emitters, textures and the camera, as the
//! renderer sees them. No files and no scene descriptions are known here.
//!
//! Directions `wo` (known) and `wi` (sampled) both point away from the surface.

mod mesh;
mod shape;
mod surface;

pub use mesh::TriangleMesh;
pub use shape::{
    AreaSample, Cone, Cuboid, DirectionSample, Disk, Polyhedron, Quad, Shape, ShapeHit, Solid, Sphere,
    sample_triangle_direction, triangle_direction_pdf,
};
pub use surface::LocalSurface;
