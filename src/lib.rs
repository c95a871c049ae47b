//! Terrarium: a batch renderer for light that passes through glass and water.
//!
//! The modules are the stages of the pipeline, in the order in which a render passes through
//! them; a module names only modules above it (`tests/layers.rs` enforces that).
#![forbid(unsafe_code)]

pub mod math;

pub mod optics;

pub mod description;

pub mod plan;

pub mod build;

pub mod scatter;

pub mod survey;

pub mod index;

pub mod trace;

pub mod film;

pub mod output;

pub mod forecast;

pub mod render;

pub mod measure;
