//! Running bond: rows of bricks in (u, v), each second row shifted by half a brick.
//!
//! As a colour the mortar has sharp edges, averaged over the footprint's bounding box in closed form;
//! as a height the bricks' edges are bevelled.

use super::filter::{fraction, pulses, smoothstep};
use super::{Colors, TexturePoint};
use glam::DVec2;

#[derive(Clone, Debug)]
pub struct Brick {
    pub(super) colors: Colors,
    bricks: DVec2,
    /// Half the joint: in brick lengths along u, in row heights along v.
    joint: DVec2,
    /// Width of the bevel, in the same units.
    bevel: DVec2,
}

impl Brick {
    /// `bricks` along u and rows along v within [0, 1], above 0. `mortar`, 0 to 0.5: the joint's
    /// share of a row's height; upright joints are as wide in u as the others are in v.
    pub fn new(colors: Colors, bricks: DVec2, mortar: f64) -> Brick {
        let along_v = 0.5 * mortar.clamp(0.0, 0.5);
        let joint = DVec2::new((along_v * bricks.x / bricks.y).min(0.25), along_v);
        Brick { colors, bricks, joint, bevel: joint.min(0.5 - joint) }
    }

    /// Mean of the bricks (1) and the mortar (0) over the footprint.
    pub(super) fn weight(&self, at: &TexturePoint) -> f64 {
        let x = at.uv * self.bricks;
        let half = at.half_extent() * self.bricks.abs();
        let (j, h) = (self.joint, half);
        // Rows of either parity: how much of the box they cover, and what share of that is brick.
        let parity = |p: f64| {
            let rows = pulses(0.5 * (x.y - p), 0.5 * h.y, 0.5 * j.y, 0.5 * (1.0 - j.y));
            rows * pulses(x.x + 0.5 * p, h.x, j.x, 1.0 - j.x)
        };
        parity(0.0) + parity(1.0)
    }

    /// The bricks' height: 0 on the mortar, 1 on their face.
    pub(super) fn height(&self, at: &TexturePoint) -> f64 {
        let x = at.uv * self.bricks;
        let shift = if fraction(0.5 * x.y) < 0.5 { 0.0 } else { 0.5 };
        let ramp = |x: f64, joint: f64, bevel: f64| {
            let f = fraction(x);
            if bevel > 0.0 { smoothstep(joint, joint + bevel, f.min(1.0 - f)) } else { 1.0 }
        };
        ramp(x.x + shift, self.joint.x, self.bevel.x) * ramp(x.y, self.joint.y, self.bevel.y)
    }

    pub(super) fn step(&self) -> DVec2 {
        (self.bevel / 64.0).max(DVec2::splat(1e-6)) / self.bricks.abs()
    }
}
