//! The textures, a file each.

pub mod bark;
pub mod brick;
pub mod dots;
pub mod grid;
pub mod land;
pub mod leaf;
pub mod rock;
pub mod wood;
