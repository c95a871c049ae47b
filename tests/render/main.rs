//! Renders of small scenes, held against closed forms, symmetries and brute force.
//!
//! Everything goes the way a user's scene goes: text, description, world, image. Seeds are fixed.
//! What breaks renderers is in `hard_cases`.

mod antialiasing;
pub(crate) mod caustics;
pub(crate) mod determinism;
mod dispersion;
pub(crate) mod glass;
mod layers;
pub(crate) mod light;
pub(crate) mod materials;
pub(crate) mod media;
pub(crate) mod meshes;
mod mirrors;
mod robustness;
mod scatter;
mod seen_light;
pub(crate) mod shot;
pub(crate) mod stability;
pub(crate) mod textures;
