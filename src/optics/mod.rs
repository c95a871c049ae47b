//! What light meets: shapes, surfaces, materials, emitters, textures and the camera, as the
//! renderer sees them. No files and no scene descriptions are known here.
//!
//! Directions `wo` (known) and `wi` (sampled) both point away from the surface.

mod surface;

pub use surface::LocalSurface;
