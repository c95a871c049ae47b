//! Numbers and space: vectors, boxes, frames, robust arithmetic, random values.
//!
//! Nothing here knows of light. Everything is a pure function of its arguments.

mod aabb;
pub mod doubles;
mod exact;
mod frame;
mod health;
pub mod lanes;
mod maps;
mod placement;
pub mod random;
mod ray;
pub mod robust;
pub mod sampling;

pub use aabb::{Aabb, round_down, round_up};
pub use exact::Exact;
pub use frame::Frame;
/// Linear red, green and blue, in one register: whole when it is stored and read back.
pub use glam::Vec3A as Color;
pub use glam::{DAffine3, DMat3, DVec2, DVec3, Vec2, Vec3};
pub use health::{Health, Place, Rare};
pub use maps::{parallelogram, rotation};
pub use placement::{MAX_SQUEEZE, Placement, flattens};
pub use ray::Ray;
