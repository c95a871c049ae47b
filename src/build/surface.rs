//! The surface that a ray has met, in the world.

use super::world::{Geometry, Hit, World};
use crate::math::{DVec2, DVec3, Ray};
use crate::optics::MaterialId;

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
    /// Where shadow rays start: `p`, or lifted off the facets of a smooth mesh.
    pub shadow_p: DVec3,
}

impl World {
    /// The surface at a hit of `ray`, whose direction is of unit length. Coordinates and their
    /// derivatives are left at 0 on shapes whose material asks for none.
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let instance = &self.instances[hit.instance as usize];
        let placement = &instance.placement;
        let binding = &self.bindings[instance.binding as usize];
        let (local, part, lifted) = match &self.geometries[instance.geometry as usize] {
            Geometry::Shape(shape) => {
                let local = placement.local_ray(ray);
                let hit = World::shape_hit(hit);
                let textured = self.materials[binding[0].0 as usize].textured;
                (if textured { shape.surface(&local, hit) } else { shape.bare_surface(&local, hit) }, 0, None)
            }
            Geometry::Mesh(mesh) => {
                let m = &mesh.surface;
                let local = m.surface(hit.primitive, hit.b);
                let lifted = (!m.normals.is_empty()).then(|| {
                    let front = placement.normal(local.ng).dot(ray.dir) < 0.0;
                    m.shadow_terminator_point(hit.primitive, hit.b, front)
                });
                (local, m.part(hit.primitive), lifted)
            }
        };
        let p = placement.point(local.p);
        let ng = placement.unit_normal(local.ng);
        let ns = if local.ns == local.ng { ng } else { placement.unit_normal(local.ns) };
        Surface {
            t: (p - ray.origin).dot(ray.dir),
            p,
            p_error: local.p_error * placement.stretch() + rounding(p, local.p, placement.stretch()),
            ng,
            ns: if ns.dot(ng) > 0.0 { ns } else { ng },
            uv: local.uv,
            dpdu: placement.vector(local.dpdu),
            dpdv: placement.vector(local.dpdv),
            local: local.p,
            material: binding[(part as usize).min(binding.len() - 1)],
            instance: hit.instance,
            shadow_p: lifted.map_or(p, |q| placement.point(q)),
        }
    }
}

/// What double-precision placement adds to a point's error, there and back.
fn rounding(world: DVec3, local: DVec3, stretch: f64) -> f64 {
    // Sums of the coordinates' sizes bound the lengths, without square roots.
    16.0 * f64::EPSILON * (world.abs().element_sum() + stretch * local.abs().element_sum())
}
