//! Objects are flattened: groups, definitions and scattered copies become placed instances of shared
//! geometry.

use super::materials::Surfaces;
use super::meshes::Meshes;
use super::obj::PartName;
use super::world::{Geometry, Instance};
use super::{BuildError, scatter};
use crate::description::{MAX_INSTANCES, MAX_NESTING, Object, Scene, Shape as Described, Transform};
use crate::math::{DAffine3, DVec3, Placement};
use crate::optics::{Cone, Cuboid, Disk, MaterialId, Polyhedron, Quad, Shape, Solid, Sphere};
use std::collections::HashMap;

/// All placed objects of a scene.
pub(super) struct Placed {
    /// Where the renderer's coordinates begin, in the scene's.
    pub origin: DVec3,
    pub geometries: Vec<Geometry>,
    pub instances: Vec<Instance>,
    pub bindings: Vec<Vec<MaterialId>>,
    pub object_names: Vec<String>,
    pub meshes: Meshes,
}

pub(super) struct Placer<'a> {
    pub scene: &'a Scene,
    surfaces: &'a Surfaces,
    pub placed: Placed,
    /// Geometry by the place of its description in memory: one definition is built once.
    shapes: HashMap<usize, u32>,
    binding_ids: HashMap<Vec<MaterialId>, u32>,
    origin: DVec3,
    /// Whether the object being placed only carries others, so that its materials do not matter.
    carrying: bool,
}

/// What a nested object takes from those around it.
#[derive(Clone, Copy)]
pub(super) struct Context<'a> {
    pub world_from_parent: DAffine3,
    pub material: Option<&'a str>,
    pub object: u32,
    pub nesting: u32,
}

/// Places all objects; `origin` is subtracted from the scene's coordinates.
pub(super) fn place(scene: &Scene, origin: DVec3, surfaces: &Surfaces) -> Result<Placed, BuildError> {
    let placed = Placed {
        origin,
        geometries: Vec::new(),
        instances: Vec::new(),
        bindings: Vec::new(),
        object_names: Vec::new(),
        meshes: Meshes::within(&scene.reach),
    };
    let mut placer = Placer {
        scene,
        surfaces,
        placed,
        shapes: HashMap::new(),
        binding_ids: HashMap::new(),
        origin,
        carrying: false,
    };
    for (i, object) in scene.objects.iter().enumerate() {
        let id = placer.placed.object_names.len() as u32;
        placer.placed.object_names.push(object.name.clone().unwrap_or_else(|| format!("objects.{i}")));
        let context = Context {
            world_from_parent: DAffine3::from_translation(-origin),
            material: None,
            object: id,
            nesting: 0,
        };
        placer.object(object, context)?;
    }
    Ok(placer.placed)
}

impl<'a> Placer<'a> {
    pub fn object(&mut self, object: &'a Object, around: Context<'a>) -> Result<(), BuildError> {
        if around.nesting > MAX_NESTING {
            return Err(BuildError::Invalid(format!("objects are nested deeper than {MAX_NESTING}")));
        }
        let context = Context {
            world_from_parent: around.world_from_parent * composed(&object.transform),
            material: object.material.as_deref().or(around.material),
            nesting: around.nesting + 1,
            ..around
        };
        match &object.shape {
            Described::Group { objects } => objects.iter().try_for_each(|o| self.object(o, context)),
            Described::Instance { of } => {
                let definition = self.definition(of)?;
                self.object(definition, context)
            }
            Described::Scatter(scatter) => scatter::strew(self, scatter, context),
            Described::Mesh { .. } => self.mesh(object, context),
            _ => self.shape(object, context),
        }
    }

    pub fn definition(&self, name: &str) -> Result<&'a Object, BuildError> {
        let scene = self.scene;
        scene
            .definitions
            .get(name)
            .ok_or_else(|| BuildError::Invalid(format!("no definition is named `{name}`")))
    }

    fn shape(&mut self, object: &'a Object, context: Context<'a>) -> Result<(), BuildError> {
        let key = std::ptr::from_ref(object) as usize;
        let geometry = match self.shapes.get(&key) {
            Some(&geometry) => geometry,
            None => {
                let shape = analytic(&object.shape).ok_or_else(|| {
                    BuildError::Invalid("a group, instance or mesh is no analytic shape".to_owned())
                })?;
                let geometry = self.add_geometry(Geometry::Shape(shape));
                self.shapes.insert(key, geometry);
                geometry
            }
        };
        let material = self.material(context)?;
        self.instance(geometry, vec![material], context, DVec3::ZERO)
    }

    fn mesh(&mut self, object: &'a Object, context: Context<'a>) -> Result<(), BuildError> {
        let Described::Mesh { path, smooth, parts } = &object.shape else {
            return Err(BuildError::Invalid("not a mesh".to_owned()));
        };
        let geometries = &mut self.placed.geometries;
        let loaded = self.placed.meshes.get(path, *smooth, |mesh| {
            geometries.push(Geometry::Mesh(mesh));
            geometries.len() as u32 - 1
        })?;
        if let Some(unknown) = parts.names().find(|name| !loaded.parts.iter().any(|p| is(p, name))) {
            let known: Vec<&str> = loaded
                .parts
                .iter()
                .flat_map(|p| [p.group.as_str(), p.material.as_str()])
                .filter(|n| !n.is_empty())
                .collect();
            return Err(BuildError::Invalid(format!(
                "{path} has no part named `{unknown}`; it has {}",
                if known.is_empty() { "none".to_owned() } else { format!("`{}`", known.join("`, `")) }
            )));
        }
        let mut binding = Vec::with_capacity(loaded.parts.len().max(1));
        for part in &loaded.parts {
            let own = parts.iter().find(|(name, _)| is(part, name));
            binding.push(match own {
                Some((_, material)) if !self.carrying => self.surfaces.id(material)?,
                _ => self.material(context)?,
            });
        }
        if binding.is_empty() {
            binding.push(self.material(context)?);
        }
        self.instance(loaded.geometry, binding, context, loaded.center)
    }

    /// Places an object whose materials do not matter: it carries scattered copies.
    pub fn carry(&mut self, object: &'a Object, context: Context<'a>) -> Result<(), BuildError> {
        let carrying = std::mem::replace(&mut self.carrying, true);
        let result = self.object(object, context);
        self.carrying = carrying;
        result
    }

    /// The map from the scene's coordinates to those of `context`.
    pub fn own_from_scene(&self, context: Context) -> DAffine3 {
        context.world_from_parent.inverse() * DAffine3::from_translation(-self.origin)
    }

    fn material(&self, context: Context) -> Result<MaterialId, BuildError> {
        if self.carrying {
            return Ok(MaterialId(0));
        }
        let name = context.material.ok_or_else(|| {
            BuildError::Invalid(format!(
                "object `{}` has no material",
                self.placed.object_names[context.object as usize]
            ))
        })?;
        self.surfaces.id(name)
    }

    fn instance(
        &mut self,
        geometry: u32,
        binding: Vec<MaterialId>,
        context: Context,
        center: DVec3,
    ) -> Result<(), BuildError> {
        let name = || self.placed.object_names[context.object as usize].clone();
        let placement = Placement::new(context.world_from_parent * DAffine3::from_translation(center))
            .ok_or_else(|| {
                BuildError::Invalid(format!("the transforms of object `{}` flatten it", name()))
            })?;
        if self.placed.instances.len() >= MAX_INSTANCES {
            return Err(BuildError::NotSupported(format!(
                "the scene has more than {MAX_INSTANCES} instances"
            )));
        }
        let bindings = &mut self.placed.bindings;
        let binding = *self.binding_ids.entry(binding).or_insert_with_key(|materials| {
            bindings.push(materials.clone());
            bindings.len() as u32 - 1
        });
        self.placed.instances.push(Instance {
            geometry,
            binding,
            placement,
            rank: 0,
            clear: false,
            flush_error: 0.0,
            breadth: 0.0,
            object: context.object,
            visible: true,
        });
        Ok(())
    }

    fn add_geometry(&mut self, geometry: Geometry) -> u32 {
        self.placed.geometries.push(geometry);
        self.placed.geometries.len() as u32 - 1
    }
}

/// Whether a part of a mesh file goes by this name.
fn is(part: &PartName, name: &str) -> bool {
    part.group == name || part.material == name
}

/// The analytic shape that a description names.
fn analytic(shape: &Described) -> Option<Shape> {
    use crate::description::Polyhedron as Kind;
    Some(match shape {
        Described::Sphere { radius, center } => Shape::Sphere(Sphere::new(*radius, (*center).into())),
        Described::Box { size, center } => Shape::Cuboid(Cuboid::new((*size).into(), (*center).into())),
        Described::Cone { radius, height, top_radius, caps } => {
            Shape::Cone(Cone::new(*radius, *top_radius, *height, *caps))
        }
        Described::Cylinder { radius, height, caps } => {
            Shape::Cone(Cone::new(*radius, *radius, *height, *caps))
        }
        Described::Disk { radius, inner_radius } => Shape::Disk(Disk::new(*radius, *inner_radius)),
        Described::Quad { size } => Shape::Quad(Quad::new(*size)),
        Described::Polyhedron { kind, radius } => {
            let solid = match kind {
                Kind::Tetrahedron => Solid::Tetrahedron,
                Kind::Cube => Solid::Cube,
                Kind::Octahedron => Solid::Octahedron,
                Kind::Dodecahedron => Solid::Dodecahedron,
                Kind::Icosahedron => Solid::Icosahedron,
            };
            Shape::Polyhedron(Polyhedron::new(solid, *radius))
        }
        Described::Mesh { .. }
        | Described::Group { .. }
        | Described::Instance { .. }
        | Described::Scatter(_) => {
            return None;
        }
    })
}

/// The map of a list of transforms, the first applied first.
pub(super) fn composed(transforms: &[Transform]) -> DAffine3 {
    transforms.iter().fold(DAffine3::IDENTITY, |map, step| step.map() * map)
}
