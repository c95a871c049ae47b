//! Photons of small scenes, held against closed forms and against themselves, unaimed.
//!
//! Everything goes the way a user's scene goes as far as the photons. Seeds are fixed.

mod aimed;
mod bent;
mod direct;
mod directions;
mod distant;
mod emitters;
mod glass;
mod indirect;
mod lab;
mod ledger;
mod many;
