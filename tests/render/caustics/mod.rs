//! Light that glass and mirrors focus, from the scene's text to the picture: against closed forms,
//! against references, and against itself seen in another way.

pub(crate) mod absent;
mod beneath;
mod flush;
pub(crate) mod lab;
mod lights;
pub(crate) mod neighbours;
pub(crate) mod parts;
mod radius;
pub(crate) mod scales;
pub(crate) mod surfaces;
mod touching;
mod transmission;
mod yardstick;
