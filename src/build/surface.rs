//! The surface that a ray has met, in the world.

use super::sights::Start;
use super::world::{Geometry, Hit, Instance, Mesh, World};
use crate::math::{DVec2, DVec3, Placement, Ray};
use crate::optics::{Coordinates, Face, Facet, MaterialId, TriangleMesh};

/// A surface point in world space.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// Distance along the ray.
    pub t: f64,
    pub p: DVec3,
    /// Offset along the normal beyond which a leaving ray cannot meet this surface again, metres.
    pub p_error: f64,
    /// Unit geometric normal, out of the object.
    pub ng: DVec3,
    /// Unit shading normal, in the hemisphere of `ng`, before any normal map.
    pub ns: DVec3,
    /// Those of a mesh; other shapes' are found where they are asked for: see [`World::coordinates`].
    mesh_coordinates: Option<Coordinates>,
    /// The point in object space, for solid textures.
    pub local: DVec3,
    pub material: MaterialId,
    pub instance: u32,
    /// Face of a shape, triangle of a mesh.
    pub primitive: u32,
    /// Where shadow rays start if not at `p`: lifted off the facets of a smooth mesh.
    pub lifted: Option<DVec3>,
}

impl Surface {
    /// Of a ray that leaves it in this direction.
    #[inline]
    pub fn start(&self, dir: DVec3) -> Start {
        Start { instance: self.instance, outside: dir.dot(self.ng) > 0.0 }
    }
}

impl World {
    /// Which face of its object a surface is on the side of the unit normal `n`.
    #[inline]
    pub fn face(&self, surface: &Surface, n: DVec3) -> Face {
        match self.instances[surface.instance as usize].rank {
            0 => Face::Opaque,
            _ if surface.ng.dot(n) > 0.0 => Face::Outer,
            _ => Face::Inner,
        }
    }

    /// The surface at a hit of `ray`, whose direction is of unit length.
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        self.surface_here(ray, hit)
    }

    /// The same, compiled into its place: a surface is large to hand over.
    #[inline(always)]
    pub fn surface_here(&self, ray: &Ray, hit: &Hit) -> Surface {
        let instance = &self.instances[hit.instance as usize];
        let placement = &instance.placement;
        let binding = &self.bindings[instance.binding as usize];
        match &self.geometries[instance.geometry as usize] {
            Geometry::Shape(shape) => {
                let bare = shape.bare_surface(&placement.local_ray(ray), World::shape_hit(hit));
                let p = placement.point(bare.p);
                let ng = placement.unit_normal(bare.ng);
                Surface {
                    t: (p - ray.origin).dot(ray.dir),
                    p,
                    p_error: placed_error(placement, p, bare.p, bare.p_error),
                    ng,
                    ns: ng,
                    mesh_coordinates: None,
                    local: bare.p,
                    material: binding[0],
                    instance: hit.instance,
                    primitive: hit.primitive,
                    lifted: None,
                }
            }
            Geometry::Mesh(mesh) => {
                let material = self.material_of(mesh, instance, hit);
                self.mesh_surface(&mesh.surface, ray, hit, placement, material)
            }
        }
    }

    /// The surface at a hit of a photon, which needs no normal but the facet's where nothing specular is, unless
    /// it is scattered there, coordinates for textures alone, and nowhere a place for shadow rays.
    #[inline(always)]
    pub fn surface_of_photon(&self, ray: &Ray, hit: &Hit, scatters: bool) -> Surface {
        let instance = &self.instances[hit.instance as usize];
        if let Geometry::Mesh(mesh) = &self.geometries[instance.geometry as usize] {
            let id = self.material_of(mesh, instance, hit);
            let material = &self.materials[id.0 as usize];
            let placement = &instance.placement;
            if !scatters && !material.specular_somewhere() {
                return self.flat_surface(&mesh.surface, ray, hit, placement, id);
            }
            if !material.textured {
                return self.bare_mesh_surface(&mesh.surface, ray, hit, placement, id);
            }
        }
        self.surface_here(ray, hit)
    }

    #[inline]
    fn material_of(&self, mesh: &Mesh, instance: &Instance, hit: &Hit) -> MaterialId {
        let binding = &self.bindings[instance.binding as usize];
        binding[(mesh.surface.part(hit.primitive) as usize).min(binding.len() - 1)]
    }

    #[inline(never)]
    fn flat_surface(
        &self,
        mesh: &TriangleMesh,
        ray: &Ray,
        hit: &Hit,
        placement: &Placement,
        material: MaterialId,
    ) -> Surface {
        on_facet(&mesh.flat_facet(hit.primitive, hit.b), ray, hit, placement, material)
    }

    /// Without coordinates.
    #[inline(never)]
    fn bare_mesh_surface(
        &self,
        mesh: &TriangleMesh,
        ray: &Ray,
        hit: &Hit,
        placement: &Placement,
        material: MaterialId,
    ) -> Surface {
        bent(&mesh.facet(hit.primitive, hit.b), ray, hit, placement, material)
    }

    #[inline(never)]
    fn mesh_surface(
        &self,
        mesh: &TriangleMesh,
        ray: &Ray,
        hit: &Hit,
        placement: &Placement,
        material: MaterialId,
    ) -> Surface {
        let facet = mesh.facet(hit.primitive, hit.b);
        let mut surface = bent(&facet, ray, hit, placement, material);
        surface.mesh_coordinates = Some(placed_coordinates(placement, facet.coordinates()));
        if !mesh.normals.is_empty() {
            let front = placement.normal(facet.ng()).dot(ray.dir) < 0.0;
            let lifted = placement.point(facet.shadow_terminator_point(front));
            surface.lifted = (lifted != surface.p).then_some(lifted);
        }
        surface
    }

    /// A surface's coordinates, as they run in the world.
    #[inline]
    pub fn coordinates(&self, surface: &Surface) -> Coordinates {
        match (surface.mesh_coordinates, self.geometry(surface.instance)) {
            (None, Geometry::Shape(shape)) => {
                let placement = &self.instances[surface.instance as usize].placement;
                placed_coordinates(placement, shape.coordinates(surface.local, surface.primitive))
            }
            (found, _) => {
                found.unwrap_or(Coordinates { uv: DVec2::ZERO, dpdu: DVec3::ZERO, dpdv: DVec3::ZERO })
            }
        }
    }
}

/// The surface of a facet as it is flat, without coordinates.
#[inline(always)]
fn on_facet(facet: &Facet, ray: &Ray, hit: &Hit, placement: &Placement, material: MaterialId) -> Surface {
    let (local, p_error) = facet.place();
    let (p, ng) = (placement.point(local), placement.unit_normal(facet.ng()));
    Surface {
        t: (p - ray.origin).dot(ray.dir),
        p,
        p_error: placed_error(placement, p, local, p_error),
        ng,
        ns: ng,
        mesh_coordinates: None,
        local,
        material,
        instance: hit.instance,
        primitive: hit.primitive,
        lifted: None,
    }
}

/// The same with its shading normal.
#[inline(always)]
fn bent(facet: &Facet, ray: &Ray, hit: &Hit, placement: &Placement, material: MaterialId) -> Surface {
    let mut surface = on_facet(facet, ray, hit, placement, material);
    let ns = facet.shading_normal();
    if ns != facet.ng() {
        let bent = placement.unit_normal(ns);
        surface.ns = if bent.dot(surface.ng) > 0.0 { bent } else { surface.ng };
    }
    surface
}

#[inline]
fn placed_coordinates(placement: &Placement, local: Coordinates) -> Coordinates {
    Coordinates { uv: local.uv, dpdu: placement.vector(local.dpdu), dpdv: placement.vector(local.dpdv) }
}

/// The error of a point in the world: its shape's, and what placement adds to it, there and back.
#[inline]
fn placed_error(placement: &Placement, world: DVec3, local: DVec3, error: f64) -> f64 {
    // Sums of the coordinates' sizes bound the lengths, without square roots.
    let sum = world.abs().element_sum() + placement.stretch() * local.abs().element_sum();
    error * placement.stretch() + 16.0 * f64::EPSILON * sum
}
