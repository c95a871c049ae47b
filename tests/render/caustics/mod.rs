//! Light that glass and mirrors focus, from the scene's text to the picture: against closed forms,
//! against references, and against itself seen in another way.

mod absent;
mod lab;
mod lights;
mod parts;
mod radius;
mod scales;
mod seen;
mod surfaces;
mod transmission;
mod yardstick;
