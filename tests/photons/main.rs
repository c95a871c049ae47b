//! Photons of small scenes, held against closed forms and against themselves, unaimed.
//!
//! Everything goes the way a user's scene goes as far as the photons. Seeds are fixed.

mod aimed;
pub(crate) mod bent;
mod direct;
pub(crate) mod directions;
mod distant;
mod emitters;
mod glass;
mod indirect;
pub(crate) mod lab;
pub(crate) mod ledger;
mod many;
