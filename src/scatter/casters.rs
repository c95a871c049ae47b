//! Casters: what makes caustics, as the bounds that photons are aimed at.

use super::balls::UNEVEN;
use super::bounds::Bound;
use crate::build::{Instance, World};
use crate::math::{Color, Placement};

/// Bounds that aiming tells apart; more casters than this are merged by nearness.
const MOST: usize = 32;

/// Bounds of all mirrors and interfaces, merged to a few.
pub(super) fn casters(world: &World) -> Vec<Bound> {
    merged(specular(world).into_iter().map(|(_, bound)| bound).collect())
}

/// All mirrors and interfaces.
///
/// What transmits counts where it has been given a rank as a medium: an object of the same index of
/// refraction as all around it, which light does not notice, has none.
pub(super) fn specular(world: &World) -> Vec<(u32, Bound)> {
    let specular = |instance: &Instance| {
        instance.rank != 0
            || world.bindings[instance.binding as usize]
                .iter()
                .any(|id| world.materials[id.0 as usize].reflection.bound(&world.textures) != Color::ZERO)
    };
    (0u32..)
        .zip(&world.instances)
        .filter(|(_, instance)| instance.visible && specular(instance))
        .filter_map(|(i, instance)| Some((i, of_instance(world, instance)?)))
        .collect()
}

/// Bounds of all that rays can meet; `None` for an empty scene.
pub(super) fn scene(world: &World) -> Option<Bound> {
    let all = world.tree.bounds();
    (!all.is_empty()).then(|| Bound::of_aabb(&all))
}

/// `None` for a geometry of nothing.
pub(super) fn of_instance(world: &World, instance: &Instance) -> Option<Bound> {
    let geometry = &world.geometries[instance.geometry as usize];
    let aabb = World::placed_bounds(geometry, &instance.placement);
    if aabb.is_empty() {
        return None;
    }
    // The placed ball lies within the ball of its longest half-axis, which this bounds.
    let placement = &instance.placement;
    let stretch = round_scale(placement).map_or(placement.stretch(), |scale| scale * (1.0 + UNEVEN));
    let (center, radius) = geometry.ball();
    Some(Bound::of_aabb(&aabb).with_ball(placement.point(center), radius * stretch))
}

/// The scale of a placement that leaves spheres round.
pub(super) fn round_scale(placement: &Placement) -> Option<f64> {
    let m = placement.world_from_object.matrix3;
    let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis];
    let size = x.length_squared();
    let uneven = (size - y.length_squared()).abs() + (size - z.length_squared()).abs();
    let skew = x.dot(y).abs() + y.dot(z).abs() + z.dot(x).abs();
    (uneven + skew <= UNEVEN * size).then(|| size.sqrt())
}

/// At most `MOST` bounds of the same things, neighbours together.
fn merged(bounds: Vec<Bound>) -> Vec<Bound> {
    let mut groups = vec![bounds];
    while groups.len() < MOST {
        // The group whose bounds are spread the widest.
        let spread = |group: &[Bound]| if group.len() < 2 { 0.0 } else { spread(group).1 };
        let widest = (0..groups.len()).max_by(|&a, &b| spread(&groups[a]).total_cmp(&spread(&groups[b])));
        let Some(i) = widest.filter(|&i| spread(&groups[i]) > 0.0) else { break };
        let mut group = std::mem::take(&mut groups[i]);
        let (axis, _) = self::spread(&group);
        group.sort_by(|a, b| a.center[axis].total_cmp(&b.center[axis]));
        let upper = group.split_off(group.len() / 2);
        groups[i] = group;
        groups.push(upper);
    }
    groups.iter().filter_map(|group| group.iter().copied().reduce(|a, b| a.union(&b))).collect()
}

/// The axis along which the centres are furthest apart, and how far.
fn spread(group: &[Bound]) -> (usize, f64) {
    let least = group.iter().fold(group[0].center, |m, b| m.min(b.center));
    let most = group.iter().fold(group[0].center, |m, b| m.max(b.center));
    let extent = most - least;
    let axis = (0..3).max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(0);
    (axis, extent[axis])
}
