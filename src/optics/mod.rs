//! What light meets: shapes, surfaces, materials, emitters, textures and the camera, as the
//! renderer sees them. No files and no scene descriptions are known here.
//!
//! Directions `wo` (known) and `wi` (sampled) both point away from the surface.

mod camera;
mod emitter;
pub mod environment;
mod face;
mod fresnel;
mod material;
mod mesh;
mod shape;
mod spectrum;
mod surface;
pub mod texture;

pub use camera::Camera;
pub use emitter::{Emitter, EmitterKind, spot_falloff};
pub use environment::{Environment, EnvironmentSample};
pub use face::Face;
pub use fresnel::{Interface, reflected, refracted};
pub use material::{Material, MaterialId, Relief, TextureId, Weight};
pub use mesh::{Facet, TriangleMesh};
pub use shape::{
    AreaSample, BareSurface, Cone, Cuboid, DirectionSample, Disk, Polyhedron, Quad, Shape, ShapeHit, Solid,
    Sphere, sample_triangle_direction, triangle_direction_pdf,
};
pub use spectrum::{Cauchy, Spectrum, WavelengthSample};
pub use surface::{Coordinates, LocalSurface};
pub use texture::{Texture, TexturePoint, bumped_normal, perturbed_normal_from_map};
