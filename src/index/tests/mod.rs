//! The photon map against brute force and closed forms.

mod estimate;
mod surfaces;
mod tree;

use super::*;
use crate::math::Vec3;
use crate::math::random::{Counter, Stage};
use crate::optics::Face;
use crate::scatter::Photon;

/// A photon of one watt a channel from straight above a surface.
fn photon(position: Vec3, normal: Vec3) -> Photon {
    Photon { position, wi: normal, normal, power: Vec3::ONE, face: Face::Opaque }
}

fn counter(item: u64) -> Counter {
    Counter::new(20, Stage::Test, item)
}

/// Uniform photons on [0, 1]² of the plane y = 0, seen from above.
fn floor(count: usize, item: u64) -> Vec<Photon> {
    let mut random = counter(item);
    let mut at = || {
        let [x, z] = random.pair();
        photon(Vec3::new(x as f32, 0.0, z as f32), Vec3::Y)
    };
    (0..count).map(|_| at()).collect()
}
