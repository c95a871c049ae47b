//! A photon: light that has arrived at a surface.

use crate::math::Vec3;
use crate::optics::Face;

/// What arrived, where and from where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Photon {
    /// Metres, in the world's coordinates.
    pub position: Vec3,
    /// Unit direction from which it came, away from the surface.
    pub wi: Vec3,
    /// Unit geometric normal on the side on which it arrived: wi·normal > 0.
    pub normal: Vec3,
    /// Watts a channel, before the surface has taken its share; ≥ 0.
    pub power: Vec3,
    pub face: Face,
}
