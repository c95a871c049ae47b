//! Copies strewn over a surface, uniformly by area.

use super::BuildError;
use super::objects::{Context, Placer, composed};
use super::world::Geometry;
use crate::description::{Object, Scatter, Shape as Described};
use crate::math::random::{Counter, Stage};
use crate::math::{DAffine3, DVec3, Placement, rotation};

/// Draws for one copy before the ground is said to be too steep.
const MAX_DRAWS: u32 = 10_000;

/// A piece of the carrying surface, in the scatter object's own coordinates.
struct Patch {
    geometry: u32,
    placement: Placement,
    area: f64,
    /// For a mesh: the running sum of its triangles' areas.
    cumulative: Vec<f64>,
}

/// Places the copies of `scatter` in the coordinates of `context`.
pub(super) fn strew<'a>(
    placer: &mut Placer<'a>,
    scatter: &'a Scatter,
    context: Context<'a>,
) -> Result<(), BuildError> {
    let invalid =
        |message: String| BuildError::Invalid(format!("scatter over `{}`: {message}", scatter.over));
    let patches = carrier(placer, scatter, context)?;
    let total: f64 = patches.iter().map(|p| p.area).sum();
    if total.is_nan() || total <= 0.0 {
        return Err(invalid("the surface has no area".to_owned()));
    }
    let definitions: Vec<&Object> =
        scatter.of.iter().map(|name| placer.definition(name)).collect::<Result<_, _>>()?;
    let cos_max_slope = libm::cos(scatter.max_slope_deg.to_radians());
    for copy in 0..scatter.count {
        let mut random = Counter::new(scatter.seed, Stage::Placement, u64::from(copy));
        let (p, n) = (0..MAX_DRAWS)
            .find_map(|_| {
                let (p, n) = draw(placer, &patches, total, &mut random)?;
                let up = if n.y < 0.0 { -n } else { n };
                (scatter.max_slope_deg >= 90.0 || up.y >= cos_max_slope).then_some((p, up))
            })
            .ok_or_else(|| {
                invalid(format!(
                    "no ground flatter than {}° was found in {MAX_DRAWS} draws",
                    scatter.max_slope_deg
                ))
            })?;
        let between = |range: [f64; 2], x: f64| range[0] + (range[1] - range[0]) * x;
        let scale = between(scatter.scale, random.value());
        let turn = between(scatter.turn_deg, random.value());
        let which = ((random.value() * definitions.len() as f64) as usize).min(definitions.len() - 1);
        let up = DVec3::Y.lerp(n, scatter.align).normalize();
        let map = DAffine3::from_translation(p)
            * upright_to(up)
            * rotation(DVec3::Y, turn)
            * DAffine3::from_scale(DVec3::splat(scale))
            * DAffine3::from_translation(DVec3::new(0.0, -scatter.sink_m, 0.0));
        let placed = Context { world_from_parent: context.world_from_parent * map, ..context };
        placer.object(definitions[which], placed)?;
    }
    Ok(())
}

/// The shortest turn that takes +y to the unit vector `up`.
fn upright_to(up: DVec3) -> DAffine3 {
    let axis = DVec3::Y.cross(up);
    let sin = axis.length();
    if sin < 1e-12 {
        return if up.y > 0.0 { DAffine3::IDENTITY } else { rotation(DVec3::X, 180.0) };
    }
    rotation(axis, libm::atan2(sin, up.y).to_degrees())
}

/// The surface named by `over`: a placed object where it stands, or a definition that is not seen.
fn carrier<'a>(
    placer: &mut Placer<'a>,
    scatter: &'a Scatter,
    context: Context<'a>,
) -> Result<Vec<Patch>, BuildError> {
    let scene = placer.scene;
    let first = placer.placed.instances.len();
    let into_own = if let Some(definition) = scene.definitions.get(&scatter.over) {
        placer.carry(definition, Context { world_from_parent: DAffine3::IDENTITY, ..context })?;
        DAffine3::IDENTITY
    } else {
        let (object, world_from_parent) = find(&scene.objects, &scatter.over, DAffine3::IDENTITY)
            .ok_or_else(|| {
                BuildError::Invalid(format!("no object or definition is named `{}`", scatter.over))
            })?;
        placer.carry(object, Context { world_from_parent, ..context })?;
        placer.own_from_scene(context)
    };
    let carried = placer.placed.instances.split_off(first);
    let patches = carried.iter().map(|instance| {
        let placement = Placement::new(into_own * instance.placement.world_from_object)
            .ok_or_else(|| BuildError::Invalid(format!("`{}` cannot be scattered over", scatter.over)))?;
        Ok(patch(&placer.placed.geometries[instance.geometry as usize], instance.geometry, placement))
    });
    patches.collect()
}

/// An object by name, with the map from its parent's coordinates to the scene's.
fn find<'a>(objects: &'a [Object], name: &str, around: DAffine3) -> Option<(&'a Object, DAffine3)> {
    objects.iter().find_map(|object| {
        if object.name.as_deref() == Some(name) {
            return Some((object, around));
        }
        match &object.shape {
            Described::Group { objects } => find(objects, name, around * composed(&object.transform)),
            _ => None,
        }
    })
}

fn patch(geometry: &Geometry, index: u32, placement: Placement) -> Patch {
    let mut cumulative = Vec::new();
    let area = match geometry {
        Geometry::Mesh(mesh) => {
            let mut sum = 0.0;
            cumulative.extend(mesh.surface.triangles.iter().map(|triangle| {
                let [a, b, c] =
                    triangle.map(|v| placement.point(mesh.surface.positions[v as usize].as_dvec3()));
                sum += 0.5 * (b - a).cross(c - a).length();
                sum
            }));
            sum
        }
        Geometry::Shape(shape) => {
            // The mean factor of area over the shape, on a fixed grid.
            let n = 32;
            let mean = (0..n * n)
                .map(|i| {
                    let u =
                        [(f64::from(i / n) + 0.5) / f64::from(n), (f64::from(i % n) + 0.5) / f64::from(n)];
                    area_factor(&placement, shape.sample_area(u).ng)
                })
                .sum::<f64>()
                / f64::from(n * n);
            shape.area() * mean
        }
    };
    Patch { geometry: index, placement, area, cumulative }
}

/// By how much a placement stretches area across the unit normal `n`: |det M|·‖M⁻ᵀn‖.
fn area_factor(placement: &Placement, n: DVec3) -> f64 {
    placement.det().abs() * (placement.object_from_world.matrix3.transpose() * n).length()
}

/// One point, uniform by area, with its normal. `None` where a draw has to be repeated.
fn draw(placer: &Placer, patches: &[Patch], total: f64, random: &mut Counter) -> Option<(DVec3, DVec3)> {
    let mut pick = random.value() * total;
    let patch = patches.iter().find(|patch| {
        pick -= patch.area;
        pick < 0.0
    });
    let patch = patch.unwrap_or(patches.last()?);
    let u = random.pair();
    match &placer.placed.geometries[patch.geometry as usize] {
        Geometry::Mesh(mesh) => {
            let at = random.value() * patch.area;
            let i = patch.cumulative.partition_point(|&sum| sum <= at).min(patch.cumulative.len() - 1);
            let corners = mesh.surface.triangles[i].map(|v| mesh.surface.positions[v as usize].as_dvec3());
            let root = u[0].sqrt();
            let p =
                corners[0] * (1.0 - root) + corners[1] * (root * (1.0 - u[1])) + corners[2] * (root * u[1]);
            let n = (corners[1] - corners[0]).cross(corners[2] - corners[0]).try_normalize()?;
            Some((patch.placement.point(p), patch.placement.normal(n)))
        }
        Geometry::Shape(shape) => {
            let sample = shape.sample_area(u);
            // Rejection makes a density that is uniform in object space uniform by world area.
            let placement = &patch.placement;
            let bound = placement.stretch() * placement.stretch();
            (random.value() * bound <= area_factor(placement, sample.ng))
                .then(|| (placement.point(sample.p), placement.normal(sample.ng)))
        }
    }
}
