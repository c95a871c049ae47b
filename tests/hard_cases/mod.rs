//! The hard cases: what breaks renderers, each as one test named for its row of the catalogue.
//!
//! `rows` is the catalogue, `record` how a row is measured and told, `table` the page that is made of it
//! (`docs/hard-cases.md`, by `make hard`). A figure is asserted through the library's or the program's
//! public face. Seeds are fixed. `HARD_CASES=full` takes the catalogue's own numbers of rays and samples.

mod agreement;
mod emission;
mod frames;
mod furnaces;
mod inputs;
mod interfaces;
mod intersection;
mod lights;
mod malformed;
mod meshes;
mod nested;
mod optics;
mod output;
mod photons;
mod pixels;
mod proofs;
mod rays;
mod record;
mod rows;
mod same;
mod seen;
pub mod solids;
mod table;
mod transforms;
