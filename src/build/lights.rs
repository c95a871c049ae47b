//! Lights become emitters; those with an extent become placed geometry that emits.

use super::BuildError;
use super::materials::{Surfaces, rgb};
use super::objects::Placed;
use super::world::{Geometry, Instance};
use crate::description::{Light, Scene};
use crate::math::{Color, DAffine3, DMat3, DVec3, Frame, Placement, parallelogram};
use crate::optics::{Disk, Emitter, EmitterKind, Environment, MaterialId, Quad, Shape, Sphere};
use crate::plan::Plan;

/// The scene's lights, ready to shine.
#[derive(Default)]
pub(super) struct Lights {
    pub emitters: Vec<Emitter>,
    pub environment: Option<Environment>,
    pub environment_visible: bool,
}

/// Translates the lights; shapes of lights join the placed objects.
pub(super) fn translate(
    scene: &Scene,
    plan: &Plan,
    origin: DVec3,
    surfaces: &mut Surfaces,
    placed: &mut Placed,
) -> Result<Lights, BuildError> {
    let mut lights = Lights::default();
    objects_that_emit(plan, surfaces, placed, &mut lights);
    for (name, light) in scene.lights.iter() {
        let at = |p: &[f64; 3]| DVec3::from(*p) - origin;
        let samples = plan.light_samples(light);
        let kind = match light {
            Light::Point { position, intensity, falloff } => Some(EmitterKind::Point {
                position: at(position),
                intensity: rgb(intensity),
                falloff: *falloff,
            }),
            Light::Spot { position, target, intensity, inner_deg, outer_deg } => Some(EmitterKind::Spot {
                position: at(position),
                axis: (DVec3::from(*target) - DVec3::from(*position)).normalize(),
                cos_inner: libm::cos(inner_deg.to_radians()),
                cos_outer: libm::cos(outer_deg.to_radians()),
                intensity: rgb(intensity),
            }),
            Light::Directional { direction, irradiance } => Some(EmitterKind::Directional {
                to_light: -DVec3::from(*direction).normalize(),
                irradiance: rgb(irradiance),
            }),
            Light::Environment { map, scale, turn_deg, visible, .. } => {
                lights.environment = Some(surfaces.images.environment(map, *scale, *turn_deg)?);
                lights.environment_visible = *visible;
                Some(EmitterKind::Environment)
            }
            Light::Sphere { .. } | Light::Quad { .. } | Light::Disk { .. } => {
                luminous_shape(name, light, &at, surfaces, placed)?
            }
        };
        // The shape of a black light still stands in the scene.
        if let Some(kind) = kind.filter(|_| !light.is_black()) {
            lights.emitters.push(Emitter { kind, samples, name: name.to_owned() });
        }
    }
    Ok(lights)
}

fn luminous_shape(
    name: &str,
    light: &Light,
    at: &impl Fn(&[f64; 3]) -> DVec3,
    surfaces: &mut Surfaces,
    placed: &mut Placed,
) -> Result<Option<EmitterKind>, BuildError> {
    let (shape, map, radiance, emits_back, visible) = match light {
        Light::Sphere { center, radius, radiance, visible, .. } => (
            Shape::Sphere(Sphere::new(*radius, DVec3::ZERO)),
            DAffine3::from_translation(at(center)),
            radiance,
            true,
            *visible,
        ),
        Light::Quad { corner, edge_u, edge_v, radiance, two_sided, visible, .. } => {
            let (u, v) = (DVec3::from(*edge_u), DVec3::from(*edge_v));
            let map = DAffine3 { matrix3: parallelogram(u, v), translation: at(corner) + (u + v) / 2.0 };
            (Shape::Quad(Quad::new([1.0, 1.0])), map, radiance, *two_sided, *visible)
        }
        Light::Disk { center, normal, radius, radiance, two_sided, visible, .. } => {
            let f = Frame::around(DVec3::from(*normal).normalize());
            let map = DAffine3 { matrix3: DMat3::from_cols(f.t, f.n, f.s), translation: at(center) };
            (Shape::Disk(Disk::new(*radius, 0.0)), map, radiance, *two_sided, *visible)
        }
        _ => return Ok(None),
    };
    let placement =
        Placement::new(map).ok_or_else(|| BuildError::Invalid(format!("light `{name}` has no extent")))?;
    let material = surfaces.add_light(name, rgb(radiance), emits_back);
    let instance = placed.instances.len() as u32;
    placed.geometries.push(Geometry::Shape(shape));
    placed.bindings.push(vec![material]);
    placed.object_names.push(name.to_owned());
    placed.instances.push(Instance {
        geometry: placed.geometries.len() as u32 - 1,
        binding: placed.bindings.len() as u32 - 1,
        placement,
        rank: 0,
        clear: false,
        flush_error: 0.0,
        breadth: 0.0,
        object: placed.object_names.len() as u32 - 1,
        visible,
    });
    Ok(Some(EmitterKind::Shape { instance }))
}

/// Objects whose material emits.
fn objects_that_emit(plan: &Plan, surfaces: &Surfaces, placed: &Placed, lights: &mut Lights) {
    let emits = |id: &MaterialId| {
        let m = &surfaces.materials[id.0 as usize];
        m.emits() && m.emission.bound(&surfaces.textures) != Color::ZERO
    };
    for (i, instance) in placed.instances.iter().enumerate() {
        let binding = &placed.bindings[instance.binding as usize];
        if !binding.iter().any(emits) {
            continue;
        }
        let index = i as u32;
        let kind = match &placed.geometries[instance.geometry as usize] {
            Geometry::Shape(_) => EmitterKind::Shape { instance: index },
            Geometry::Mesh(mesh) => {
                let (mut triangles, mut cumulative, mut sum) = (Vec::new(), Vec::new(), 0.0);
                for (t, corners) in mesh.surface.triangles.iter().enumerate() {
                    let part = mesh.surface.parts.get(t).copied().unwrap_or(0) as usize;
                    let [a, b, c] = corners
                        .map(|v| instance.placement.point(mesh.surface.positions[v as usize].as_dvec3()));
                    let area = 0.5 * (b - a).cross(c - a).length();
                    if emits(&binding[part.min(binding.len() - 1)]) && area > 0.0 {
                        sum += area;
                        triangles.push(t as u32);
                        cumulative.push(sum);
                    }
                }
                EmitterKind::Mesh { instance: index, triangles, cumulative }
            }
        };
        let name = placed.object_names[instance.object as usize].clone();
        lights.emitters.push(Emitter { kind, samples: plan.area_samples(), name });
    }
}
