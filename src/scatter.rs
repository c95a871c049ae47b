//! Photon scatter: emitters → photon paths → photons, the first stage of every pass.
//!
//! A photon is stored where light from an emitter meets its first non-specular surface after one
//! mirror or interface at least (L S⁺ D), and nowhere else. No plan of this version calls for
//! caustics, so no photon is scattered; `Plan` says so for every scene.

use crate::math::Vec3;
use crate::plan::{Effect, Plan};

/// Light that has arrived at a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Photon {
    /// Metres, in the coordinates of the `World`.
    pub position: Vec3,
    /// Unit direction from which it came, away from the surface.
    pub wi: Vec3,
    /// Unit geometric normal on the side on which it arrived: `wi · normal` > 0.
    pub normal: Vec3,
    /// Watts a channel, 0 or more.
    pub power: Vec3,
}

/// The photons of a pass; none where the plan has no caustics.
pub fn photons(plan: &Plan) -> Option<Vec<Photon>> {
    plan.is_on(Effect::Caustics).then(Vec::new)
}
