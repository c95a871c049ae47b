//! What light meets: shapes, surfaces, materials, emitters, textures and the camera, as the
//! renderer sees them. No files and no scene descriptions are known here.
//!
//! Directions `wo` (known) and `wi` (sampled) both point away from the surface.

pub mod environment;
mod surface;
pub mod texture;

pub use environment::{Environment, EnvironmentSample};
pub use surface::LocalSurface;
pub use texture::{Texture, TexturePoint};
