//! Description and plan become the world: files are read, objects are placed, trees are built.
//!
//! The only translator between what a scene says and what the renderer traces.

mod assemble;
pub mod bvh;
mod camera;
mod clearance;
mod contact;
mod crossing;
mod examine;
mod flush;
mod footprint;
pub mod images;
mod inside;
mod lights;
mod lobes;
mod materials;
mod media;
mod meshes;
mod nearby;
pub mod obj;
mod objects;
mod points;
mod precision;
mod scatter;
mod shading;
mod sight;
mod sights;
mod surface;
mod vista;
mod world;

use crate::description::Scene;
use crate::math::DVec3;
use crate::plan::Plan;
pub use contact::{Beside, Contacts, Met};
pub use crossing::{Colour, Crossing};
pub use examine::examine;
pub use flush::{Departure, Entry};
pub use footprint::Cone;
pub use media::MediaSet;
pub use nearby::Obstacles;
pub use shading::Shading;
pub use sight::Sight;
pub use sights::{Sights, Start};
use std::path::PathBuf;
pub use surface::Surface;
pub use vista::{Candidates, Vista};
pub use world::{Geometry, Hit, Instance, Mesh, World};

/// Why a world could not be built.
#[derive(Debug, thiserror::Error)]
pub enum BuildError {
    /// The scene asks for something that is not there yet.
    #[error("{0}")]
    NotSupported(String),
    /// The scene or one of its files says something that cannot be.
    #[error("{0}")]
    Invalid(String),
    /// A file could not be read.
    #[error("{0}")]
    Io(String),
}

/// A world, and what was noticed on the way.
pub struct Built {
    pub world: World,
    pub warnings: Vec<String>,
    /// Every asset file that was read.
    pub files: Vec<PathBuf>,
}

/// Builds the world of a checked scene, as the plan's overrides leave it. Asset paths in it are relative to the current folder.
pub fn build(scene: &Scene, plan: &Plan) -> Result<Built, BuildError> {
    let scene = &*plan.edited(scene);
    let description =
        scene.camera.as_ref().ok_or_else(|| BuildError::Invalid("the scene has no camera".to_owned()))?;
    let origin = DVec3::from(description.target);
    let mut surfaces = materials::Surfaces::load(scene, plan)?;
    let mut placed = objects::place(scene, origin, &surfaces)?;
    let lights = lights::translate(scene, plan, origin, &mut surfaces, &mut placed)?;
    let camera = camera::translate(description, &scene.image, origin);
    assemble::assemble(scene, plan, camera, surfaces, placed, lights)
}

impl From<images::ImageError> for BuildError {
    fn from(error: images::ImageError) -> BuildError {
        let message = error.to_string();
        match error {
            images::ImageError::Io { .. } => BuildError::Io(message),
            images::ImageError::NotSupported { .. } => BuildError::NotSupported(message),
            images::ImageError::Invalid { .. } | images::ImageError::TooLarge { .. } => {
                BuildError::Invalid(message)
            }
        }
    }
}

impl From<obj::ObjError> for BuildError {
    fn from(error: obj::ObjError) -> BuildError {
        let message = error.to_string();
        match error {
            obj::ObjError::Io { .. } => BuildError::Io(message),
            obj::ObjError::NotSupported { .. } => BuildError::NotSupported(message),
            obj::ObjError::Invalid { .. } => BuildError::Invalid(message),
        }
    }
}
