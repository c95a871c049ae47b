//! Numbers and space: vectors, boxes, frames, robust arithmetic, random values.
//!
//! Nothing here knows of light. Everything is a pure function of its arguments.

mod aabb;

pub use aabb::Aabb;
pub use glam::{DAffine3, DMat3, DVec2, DVec3, Vec2, Vec3};
