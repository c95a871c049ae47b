//! From what the scene says to what rays meet: acceleration structures and the built world.

pub mod bvh;
