//! Which light can reach which mirror or interface, by bounds alone, and what of its emission that is.
//!
//! "No" is certain: the cone of a spot misses the object's bounds, or they lie behind a lamp that shines to
//! one side only. What stands in between is not looked at.

use super::bounds::Bound;
use super::source::{Domain, Kind, Source};
use super::{Emission, casters, projection};
use crate::build::World;
use std::collections::BTreeMap;

/// The part of an emitter's light that photons are sent from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Aimed {
    pub cells: usize,
    /// Of all directions; 0 for light from afar.
    pub share_of_sphere: f64,
    /// Of parallel light, m² across it; 0 for any other.
    pub area_m2: f64,
}

impl Emission {
    /// By emitter of the world.
    pub fn aimed(&self) -> Vec<Aimed> {
        let mut by_source = vec![Aimed::default(); self.sources.len()];
        for cell in &self.cells {
            let aimed = &mut by_source[cell.source as usize];
            aimed.cells += 1;
            match &cell.domain {
                Domain::Directions(cell) => {
                    aimed.share_of_sphere += cell.solid_angle() / (4.0 * std::f64::consts::PI);
                }
                Domain::Rectangle { min, max } => aimed.area_m2 += (*max - *min).element_product(),
                Domain::Sky { .. } => {}
            }
        }
        let mut lights = vec![Aimed::default(); self.emitters];
        for (source, aimed) in self.sources.iter().zip(&by_source) {
            // A sphere's inside and outside are two sources of one lamp.
            let light = &mut lights[source.emitter as usize];
            light.cells += aimed.cells;
            light.share_of_sphere = light.share_of_sphere.max(aimed.share_of_sphere).min(1.0);
            light.area_m2 += aimed.area_m2;
        }
        lights
    }
}

/// For each emitter of the world, what bends or mirrors light and can be reached by its light: of the instances that
/// share object and materials the first one that is reached stands for all, as many lamps and many beads would
/// make very many pairs.
pub fn reached(world: &World) -> Vec<Vec<u32>> {
    let mut by_light = vec![Vec::new(); world.emitters.len()];
    let Some(scene) = casters::scene(world) else { return by_light };
    let mut alike: BTreeMap<(u32, u32), Vec<(u32, Bound)>> = BTreeMap::new();
    for (i, bound) in casters::specular(world) {
        let instance = &world.instances[i as usize];
        alike.entry((instance.object, instance.binding)).or_default().push((i, bound));
    }
    for source in Source::all(world, &scene) {
        let first = |group: &Vec<(u32, Bound)>| {
            group.iter().find(|(_, bound)| may_reach(world, &source, bound)).map(|(i, _)| *i)
        };
        by_light[source.emitter as usize].extend(alike.values().filter_map(first));
    }
    for found in &mut by_light {
        found.sort_unstable();
        found.dedup();
    }
    by_light
}

/// Whether a source can reach any of what is specular.
pub(super) fn reaches_any(world: &World, source: &Source, specular: &[(u32, Bound)]) -> bool {
    specular.iter().any(|(_, bound)| may_reach(world, source, bound))
}

fn may_reach(world: &World, source: &Source, target: &Bound) -> bool {
    match &source.kind {
        Kind::Spot { position, axis, cos_outer, .. } => {
            let to = target.center - *position;
            let distance = to.length();
            let sin = target.radius / distance;
            if sin.is_nan() || sin >= 1.0 {
                return true;
            }
            // The angle to the centre against the cone's and the ball's half-angles together.
            let cos = ((1.0 - sin) * (1.0 + sin)).sqrt();
            let sin_outer = ((1.0 - cos_outer) * (1.0 + cos_outer)).max(0.0).sqrt();
            let both_reach_round = *cos_outer <= -cos;
            both_reach_round || to.dot(*axis) / distance >= cos_outer * cos - sin_outer * sin - 1e-12
        }
        Kind::Quad { instance, .. } | Kind::Shape { instance } => {
            let Some((normal, true)) = projection::flat(world, *instance) else { return true };
            target.most(normal) >= source.bound.least(normal)
        }
        _ => true,
    }
}
