//! The last step of building: insides are ranked, what cannot be seen or felt is left out, and the
//! tree over all placed objects is built.

use super::bvh::Bvh;
use super::contact::Contacts;
use super::lights::Lights;
use super::materials::{Surfaces, rgb};
use super::media::Medium;
use super::objects::Placed;
use super::precision::Precision;
use super::sights::Sights;
use super::vista::Vista;
use super::world::{Geometry, Instance, World};
use super::{BuildError, Built};
use crate::description::Scene;
use crate::math::{Aabb, Color};
use crate::optics::{Camera, Cauchy, Emitter, EmitterKind, Material, Spectrum, Weight};
use crate::plan::Plan;
use rayon::prelude::*;

pub(super) fn assemble(
    scene: &Scene,
    plan: &Plan,
    camera: Camera,
    surfaces: Surfaces,
    mut placed: Placed,
    lights: Lights,
) -> Result<Built, BuildError> {
    let origin = placed.origin;
    let mut warnings = surfaces.images.warnings().to_vec();
    warnings.append(&mut placed.meshes.warnings);
    let mut files = surfaces.images.files().to_vec();
    files.append(&mut placed.meshes.files);

    let mut bounds: Vec<Aabb> = placed
        .instances
        .par_iter()
        .map(|i| World::placed_bounds(&placed.geometries[i.geometry as usize], &i.placement))
        .collect();
    let all_bounds = bounds.clone();
    let mut media = Transmissive::find(&placed, &surfaces.materials, &bounds);
    if plan.forced() {
        media.ranked.splice(0..0, media.null.drain(..));
    }
    warnings.extend(media.open_meshes(&placed));
    for (instance, bounds) in placed.instances.iter_mut().zip(&mut bounds) {
        let [x, y, z] = bounds.extent().to_array();
        instance.breadth = x.min(y).max(x.max(y).min(z));
        if !instance.visible {
            *bounds = Aabb::EMPTY;
        }
    }
    for &null in &media.null {
        bounds[null as usize] = Aabb::EMPTY;
    }
    for (rank, &instance) in media.ranked.iter().enumerate() {
        let instance = &mut placed.instances[instance as usize];
        instance.rank = rank as u32 + 1;
        let mut materials = placed.bindings[instance.binding as usize].iter();
        instance.clear = !materials.any(|id| surfaces.materials[id.0 as usize].keeps_photons());
    }
    let coincidence = media.coincidence(&placed.instances, &placed.geometries, &bounds);
    let mut precision = Precision::new(&placed.geometries);
    let (contacts, flush) =
        Contacts::find(&media.ranked, &placed.instances, [&bounds, &all_bounds], &mut precision);
    placed.instances.iter_mut().zip(flush).for_each(|(instance, error)| instance.flush_error = error);
    let media: Vec<Medium> = media
        .ranked
        .iter()
        .filter_map(|&i| {
            let (ior, absorption) = inside(&placed.instances[i as usize], &placed, &surfaces.materials)?;
            let error = precision.of(&placed.instances[i as usize]);
            Some(Medium { instance: i, ior, absorption, error, bounds: all_bounds[i as usize] })
        })
        .collect();
    let tree = Bvh::build(&bounds);
    let in_glass = |emitter: &Emitter| {
        let near = |bounds: &Aabb| tree.any_in(bounds, |i| placed.instances[i as usize].rank != 0);
        match emitter.kind {
            EmitterKind::Point { position, .. } | EmitterKind::Spot { position, .. } => {
                near(&Aabb::from_f64(position, position))
            }
            EmitterKind::Shape { instance } | EmitterKind::Mesh { instance, .. } => {
                near(&all_bounds[instance as usize])
            }
            EmitterKind::Directional { .. } | EmitterKind::Environment => false,
        }
    };
    let emitters_in_glass = lights.emitters.iter().map(in_glass).collect();
    let sights = Sights::new(&placed.instances, &placed.geometries, &bounds, &all_bounds, &lights.emitters);
    let mut world = World {
        origin,
        vista: Vista::new(&camera, &bounds),
        camera,
        tree,
        sights,
        geometries: placed.geometries,
        instances: placed.instances,
        bindings: placed.bindings,
        materials: surfaces.materials,
        material_names: surfaces.material_names,
        textures: surfaces.textures,
        emitters: lights.emitters,
        emitters_in_glass,
        environment: lights.environment,
        environment_visible: lights.environment_visible,
        spectrum: media.iter().any(|m| m.ior.disperses()).then(Spectrum::new),
        media_error: media.iter().map(|medium| medium.error).fold(0.0, f64::max),
        media,
        contacts,
        coincidence,
        background: rgb(&scene.background),
        ambient: rgb(&scene.ambient),
        object_names: placed.object_names,
    };
    if world.move_points_off_faces() {
        let World { instances, geometries, emitters, .. } = &world;
        world.sights = Sights::new(instances, geometries, &bounds, &all_bounds, emitters);
    }
    Ok(Built { world, warnings, files })
}

/// The index of refraction and absorption of an instance's first transmissive part.
fn inside(instance: &Instance, placed: &Placed, materials: &[Material]) -> Option<(Cauchy, Color)> {
    let m = transmissive(instance, placed, materials)?;
    Some((m.ior, m.absorption))
}

fn transmissive<'a>(instance: &Instance, placed: &Placed, materials: &'a [Material]) -> Option<&'a Material> {
    placed.bindings[instance.binding as usize]
        .iter()
        .map(|id| &materials[id.0 as usize])
        .find(|m| m.transmits())
}

/// Instances that light can enter.
struct Transmissive {
    /// From the lowest rank to the highest.
    ranked: Vec<u32>,
    /// Those that light does not notice: of the same index of refraction as their surroundings.
    null: Vec<u32>,
}

impl Transmissive {
    fn find(placed: &Placed, materials: &[Material], bounds: &[Aabb]) -> Transmissive {
        let all: Vec<(u32, &Material)> = (0u32..)
            .zip(&placed.instances)
            .filter_map(|(i, instance)| Some((i, transmissive(instance, placed, materials)?)))
            .collect();
        let is_null = |&(i, m): &(u32, &Material)| {
            changes_nothing(m)
                && placed.bindings[placed.instances[i as usize].binding as usize].len() == 1
                && !all.iter().any(|&(j, _)| j != i && bounds[i as usize].overlaps(&bounds[j as usize]))
        };
        let (null, mut ranked): (Vec<_>, Vec<_>) = all.iter().partition(|entry| is_null(entry));
        let volume = |i: u32| {
            let e = bounds[i as usize].extent();
            f64::from(e.x) * f64::from(e.y) * f64::from(e.z)
        };
        ranked.sort_by(|(i, a), (j, b)| {
            a.priority.cmp(&b.priority).then(volume(*j).total_cmp(&volume(*i))).then(j.cmp(i))
        });
        let indices = |entries: Vec<(u32, &Material)>| entries.into_iter().map(|(i, _)| i).collect();
        Transmissive { ranked: indices(ranked), null: indices(null) }
    }

    /// Within how many metres along the normal two surfaces count as one; 0 where none can coincide.
    fn coincidence(&self, instances: &[Instance], geometries: &[Geometry], bounds: &[Aabb]) -> f64 {
        // A sweep along x finds whether any two overlap.
        let mut order: Vec<u32> = self.ranked.clone();
        order.sort_by(|a, b| bounds[*a as usize].min.x.total_cmp(&bounds[*b as usize].min.x));
        let touches = order.iter().enumerate().any(|(k, &i)| {
            order[k + 1..]
                .iter()
                .take_while(|&&j| bounds[j as usize].min.x <= bounds[i as usize].max.x)
                .any(|&j| bounds[i as usize].overlaps(&bounds[j as usize]))
        });
        if !touches {
            return 0.0;
        }
        // Single-precision vertices are rounded by half an ulp of their coordinates in object space.
        self.ranked
            .iter()
            .map(|&i| {
                let instance = &instances[i as usize];
                let geometry = &geometries[instance.geometry as usize];
                let (min, max) = geometry.bounds();
                let reach = min.abs().max(max.abs()).max_element() * instance.placement.stretch();
                let ulps = match geometry {
                    Geometry::Shape(_) => 64.0 * f64::EPSILON,
                    Geometry::Mesh(_) => 4.0 * f64::from(f32::EPSILON),
                };
                reach * ulps
            })
            .fold(0.0, f64::max)
    }

    /// A warning for each mesh that light can enter and that is not closed.
    fn open_meshes(&self, placed: &Placed) -> Vec<String> {
        let mut seen = std::collections::BTreeSet::new();
        let mut warnings = Vec::new();
        for &i in &self.ranked {
            let index = placed.instances[i as usize].geometry;
            if !seen.insert(index) {
                continue;
            }
            let name = &placed.object_names[placed.instances[i as usize].object as usize];
            match &placed.geometries[index as usize] {
                Geometry::Mesh(mesh) => {
                    let edges = mesh.surface.boundary_edges();
                    if edges > 0 {
                        warnings.push(format!(
                            "object `{name}`: the transmissive mesh {} is not closed ({edges} boundary edges); \
                             where light leaves it is ambiguous",
                            mesh.name
                        ));
                    }
                }
                // what is wrong with shapes the description tells
                Geometry::Shape(_) => {}
            }
        }
        warnings
    }
}

/// Whether a material in the vacuum leaves light as it is.
fn changes_nothing(m: &Material) -> bool {
    m.ior == Cauchy::new(1.0, 0.0)
        && m.transmission == Weight::Constant(Color::ONE)
        && m.reflection.is_zero()
        && m.specular.is_zero()
        && m.emission.is_zero()
        && !m.absorbs()
}
