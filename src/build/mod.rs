//! From what the scene file says to what the renderer sees.

pub mod images;
