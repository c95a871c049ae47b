//! Photon index: photons → a map that answers what light arrives near a point, the second stage of
//! every pass.
//!
//! `kiddo` builds the kd-tree, on photons turned by a fixed rotation so that no axis of the scene is
//! an axis of the tree (a floor gives a million equal coordinates), down to buckets of some hundreds.
//! Those are divided into leaves of sixteen, with their boxes above them in nodes of eight. A visit
//! tests eight boxes or eight photons at a time, and sees each photon's surface before it counts it,
//! which a search that knows points only cannot.
//!
//! - `photon.rs`: sixteen bytes that hold all of a photon but its position.
//! - `boxes.rs`: boxes over leaves, visited near a point.
//! - `map.rs`: [`PhotonMap`], its construction.
//! - `search.rs`: which photons count at a point, within a radius or the k nearest.
//! - `kernel.rs`, `gather.rs`: the density estimate.
//! - `bandwidth.rs`: the first radius of progressive passes, and how it shrinks.
//! - `caustics.rs`: a pass's map with the rule of its radius, as tracing asks for it.

mod bandwidth;
mod boxes;
mod caustics;
mod gather;
mod kernel;
mod map;
mod photon;
mod search;
#[cfg(test)]
mod tests;

pub use bandwidth::{Bandwidth, shrink};
pub use caustics::{Caustics, Reach};
pub use gather::{Gathered, Query, Radius};
pub use kernel::Kernel;
pub use map::PhotonMap;
pub use search::{Hit, apart_squared};
