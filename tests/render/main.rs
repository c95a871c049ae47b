//! Renders of small scenes, held against closed forms, symmetries and brute force.
//!
//! Everything goes the way a user's scene goes: text, description, world, image. Seeds are fixed.
//! Marks such as H17 number the hard cases of the field that a test guards against.

mod antialiasing;
mod broken_meshes;
mod caustics;
mod determinism;
mod dispersion;
mod glass;
mod layers;
mod light;
mod materials;
mod media;
pub(crate) mod meshes;
mod mirrors;
mod robustness;
mod scatter;
mod seen_light;
pub(crate) mod shot;
mod stability;
mod textures;
