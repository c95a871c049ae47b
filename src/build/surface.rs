//! The surface that a ray has met, in the world.

use super::world::{Geometry, Hit, World};
use crate::math::{DVec2, DVec3, Placement, Ray};
use crate::optics::{LocalSurface, MaterialId, TriangleMesh};

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
    pub uv: DVec2,
    pub dpdu: DVec3,
    pub dpdv: DVec3,
    /// The point in object space, for solid textures.
    pub local: DVec3,
    pub material: MaterialId,
    pub instance: u32,
    /// Face of a shape, triangle of a mesh.
    pub primitive: u32,
    /// Where shadow rays start: `p`, or lifted off the facets of a smooth mesh.
    pub shadow_p: DVec3,
}

impl World {
    /// The surface at a hit of `ray`, whose direction is of unit length. Coordinates and their
    /// derivatives are left at 0 on shapes whose material asks for none.
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
                let material = binding[0];
                let local_ray = placement.local_ray(ray);
                let at = World::shape_hit(hit);
                if self.materials[material.0 as usize].textured {
                    return placed(ray, hit, placement, &shape.surface(&local_ray, at), material, None);
                }
                let bare = shape.bare_surface(&local_ray, at);
                let p = placement.point(bare.p);
                let ng = placement.unit_normal(bare.ng);
                Surface {
                    t: (p - ray.origin).dot(ray.dir),
                    p,
                    p_error: placed_error(placement, p, bare.p, bare.p_error),
                    ng,
                    ns: ng,
                    uv: DVec2::ZERO,
                    dpdu: DVec3::ZERO,
                    dpdv: DVec3::ZERO,
                    local: bare.p,
                    material,
                    instance: hit.instance,
                    primitive: hit.primitive,
                    shadow_p: p,
                }
            }
            Geometry::Mesh(mesh) => {
                let m = &mesh.surface;
                let part = m.part(hit.primitive) as usize;
                let (local, lifted) = mesh_surface(m, ray, hit, placement);
                placed(ray, hit, placement, &local, binding[part.min(binding.len() - 1)], lifted)
            }
        }
    }
}

/// A mesh's surface, and where its shadow rays start if not there.
#[inline(never)]
fn mesh_surface(
    mesh: &TriangleMesh,
    ray: &Ray,
    hit: &Hit,
    placement: &Placement,
) -> (LocalSurface, Option<DVec3>) {
    let facet = mesh.facet(hit.primitive, hit.b);
    let lifted = (!mesh.normals.is_empty()).then(|| {
        let front = placement.normal(facet.ng()).dot(ray.dir) < 0.0;
        facet.shadow_terminator_point(front)
    });
    (facet.surface(), lifted)
}

/// `lifted`: where shadow rays start, in object space.
#[inline(never)]
fn placed(
    ray: &Ray,
    hit: &Hit,
    placement: &Placement,
    local: &LocalSurface,
    material: MaterialId,
    lifted: Option<DVec3>,
) -> Surface {
    let p = placement.point(local.p);
    let ng = placement.unit_normal(local.ng);
    let ns = if local.ns == local.ng { ng } else { placement.unit_normal(local.ns) };
    Surface {
        t: (p - ray.origin).dot(ray.dir),
        p,
        p_error: placed_error(placement, p, local.p, local.p_error),
        ng,
        ns: if ns.dot(ng) > 0.0 { ns } else { ng },
        uv: local.uv,
        dpdu: placement.vector(local.dpdu),
        dpdv: placement.vector(local.dpdv),
        local: local.p,
        material,
        instance: hit.instance,
        primitive: hit.primitive,
        shadow_p: lifted.map_or(p, |q| placement.point(q)),
    }
}

/// The error of a point in the world: its shape's, and what placement adds to it, there and back.
#[inline]
fn placed_error(placement: &Placement, world: DVec3, local: DVec3, error: f64) -> f64 {
    // Sums of the coordinates' sizes bound the lengths, without square roots.
    let sum = world.abs().element_sum() + placement.stretch() * local.abs().element_sum();
    error * placement.stretch() + 16.0 * f64::EPSILON * sum
}
