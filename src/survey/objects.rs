//! Instances told apart by the names of their objects, and what they are made of.

use crate::build::World;
use crate::math::Color;
use crate::optics::{Material, Weight};
use std::collections::HashSet;

/// The names of the objects of some instances, each once, in order.
pub(super) fn names(world: &World, instances: impl IntoIterator<Item = u32>) -> Vec<String> {
    let mut seen = HashSet::new();
    let object = |instance: u32| world.instances[instance as usize].object;
    let objects = instances.into_iter().map(object).filter(|&object| seen.insert(object));
    objects.map(|object| world.object_names[object as usize].clone()).collect()
}

/// The materials of an instance.
pub(super) fn materials(world: &World, instance: u32) -> impl Iterator<Item = &Material> {
    let binding = &world.bindings[world.instances[instance as usize].binding as usize];
    binding.iter().map(|id| &world.materials[id.0 as usize])
}

/// Whether light that falls on it can be seen on it.
pub(super) fn receives(material: &Material) -> bool {
    let full = |weight: &Weight| *weight == Weight::Constant(Color::ONE);
    let matt = !material.diffuse.is_zero() && !full(&material.reflection) && !full(&material.transmission);
    matt || !material.specular.is_zero()
}
