//! Samples of emitters as a shading point sees them.

use super::Tracer;
use crate::build::{Geometry, Hit, Shading, Surface};
use crate::math::{Color, DVec3, Frame, Ray, sampling};
use crate::optics::{EmitterKind, Shape, TexturePoint, sample_triangle_direction, spot_falloff};
use std::f64::consts::FRAC_1_PI;

/// Light from one direction.
pub struct LightSample {
    /// Unit direction to the light.
    pub wi: DVec3,
    /// Radiance over density (1/sr), or intensity over squared distance: W·m⁻² for a surface that
    /// faces it.
    pub value: Color,
    /// Metres to the light along `wi`; infinite for light from afar.
    pub distance: f64,
    pub arrival: Arrival,
}

/// Where the light comes from.
#[derive(Clone, Copy)]
pub enum Arrival {
    Infinite,
    /// A point in the open.
    Point {
        p: DVec3,
    },
    /// A point just off an emitting mesh, as far as its own error.
    Facet {
        p: DVec3,
        p_error: f64,
        instance: u32,
    },
    /// The first point of a convex emitter.
    Shape {
        p: DVec3,
        instance: u32,
    },
}

impl Arrival {
    /// What shines, if it is an object or a light with an extent.
    pub fn instance(&self) -> Option<u32> {
        match *self {
            Arrival::Infinite | Arrival::Point { .. } => None,
            Arrival::Facet { instance, .. } | Arrival::Shape { instance, .. } => Some(instance),
        }
    }
}

impl LightSample {
    /// Of an emitter without an extent, as the point `p` sees it.
    #[inline(always)]
    pub fn without_extent(kind: &EmitterKind, p: DVec3) -> Option<LightSample> {
        match kind {
            EmitterKind::Point { position, intensity, falloff } => {
                let (wi, distance, inverse) = towards(p, *position)?;
                let attenuation = match falloff {
                    None => inverse * inverse,
                    Some([c0, c1, c2]) => 1.0 / (c0 + c1 * distance + c2 * distance * distance),
                };
                let value = *intensity * attenuation as f32;
                Some(LightSample { wi, value, distance, arrival: Arrival::Point { p: *position } })
            }
            EmitterKind::Spot { position, axis, cos_inner, cos_outer, intensity } => {
                let (wi, distance, inverse) = towards(p, *position)?;
                let share = spot_falloff(-wi.dot(*axis), *cos_inner, *cos_outer) * inverse * inverse;
                let value = *intensity * share as f32;
                Some(LightSample { wi, value, distance, arrival: Arrival::Point { p: *position } })
            }
            EmitterKind::Directional { to_light, irradiance } => {
                let (wi, value) = (*to_light, *irradiance);
                Some(LightSample { wi, value, distance: f64::INFINITY, arrival: Arrival::Infinite })
            }
            _ => None,
        }
    }
}

impl Tracer<'_> {
    /// The same of an emitter with an extent.
    #[inline(never)]
    pub(super) fn extended_sample(
        &self,
        kind: &EmitterKind,
        surface: &Surface,
        shading: &Shading,
        u: impl FnOnce() -> [f64; 2],
    ) -> Option<LightSample> {
        let p = surface.p;
        match kind {
            EmitterKind::Point { .. } | EmitterKind::Spot { .. } | EmitterKind::Directional { .. } => None,
            // From where the shadow ray starts: a lamp's own surface must not be met from its other side.
            EmitterKind::Shape { instance } => {
                self.shape_sample(*instance, p + shading.ng * surface.p_error, shading, u())
            }
            EmitterKind::Mesh { instance, triangles, cumulative } => {
                self.mesh_sample(*instance, triangles, cumulative, p, u())
            }
            EmitterKind::Environment => self.environment_sample(shading, u()),
        }
    }

    /// A direction within the solid angle of a placed shape, or, where a highlight is narrower than that, from
    /// the balance of the two (Veach & Guibas 1995), so that neither wide lamps nor narrow highlights are
    /// noisy. An affine map takes the density along: p_world = p_object·‖Mω‖³ / |det M|.
    fn shape_sample(&self, index: u32, p: DVec3, shading: &Shading, u: [f64; 2]) -> Option<LightSample> {
        let instance = &self.world.instances[index as usize];
        let Geometry::Shape(shape) = self.world.geometry(index) else { return None };
        let placement = &instance.placement;
        let from = placement.local_point(p);
        let by_shape = |u| -> Option<(DVec3, f64)> {
            let sample = shape.sample_direction(from, u)?;
            let dir = placement.vector(sample.dir);
            let length = dir.length();
            Some((dir / length, sample.pdf * length * length * length / placement.det().abs()))
        };
        let (dir, pdf) = by_shape(u)?;
        let narrow = |highlight: &Highlight| self.plan.soft_shadows && highlight.peak() > pdf;
        let (dir, pdf) = match Highlight::of(shading).filter(narrow) {
            None => (dir, pdf),
            Some(highlight) => {
                let first = u[0] < 0.5;
                let u = [2.0 * u[0] - if first { 0.0 } else { 1.0 }, u[1]];
                let (dir, pdf) = if first {
                    by_shape(u)?
                } else {
                    let dir = highlight.sample(u);
                    let local = placement.local_vector(dir);
                    let length = local.length();
                    let pdf = shape.direction_pdf(from, local / length);
                    if pdf == 0.0 {
                        return None;
                    }
                    (dir, pdf / (length * length * length * placement.det().abs()))
                };
                (dir, 0.5 * (pdf + highlight.pdf(dir)))
            }
        };
        if dir.dot(shading.ns) <= 0.0 {
            return None;
        }
        let ray = Ray { origin: p, dir };
        let hit = self.world.nearest_of(index, &ray, f64::INFINITY).or_else(|| {
            // Rounding leads the ray past a sphere that is very small for its distance.
            let Shape::Sphere(sphere) = shape else { return None };
            let t = sphere.nearest_to_center(&placement.local_ray(&ray))?;
            Some(Hit { t, instance: index, primitive: 0, b: [0.0; 3] })
        })?;
        let radiance = self.emitted_towards(&ray, &hit);
        (pdf > 0.0 && pdf.is_finite() && radiance != Color::ZERO).then(|| LightSample {
            wi: ray.dir,
            value: radiance / pdf as f32,
            distance: hit.t,
            arrival: Arrival::Shape { p: ray.at(hit.t), instance: index },
        })
    }

    fn mesh_sample(
        &self,
        index: u32,
        triangles: &[u32],
        cumulative: &[f64],
        p: DVec3,
        u: [f64; 2],
    ) -> Option<LightSample> {
        let Geometry::Mesh(mesh) = self.world.geometry(index) else { return None };
        let placement = &self.world.instances[index as usize].placement;
        let total = *cumulative.last()?;
        let at = u[0] * total;
        let i = cumulative.partition_point(|&sum| sum <= at).min(triangles.len() - 1);
        let below = if i == 0 { 0.0 } else { cumulative[i - 1] };
        let area = cumulative[i] - below;
        // What the choice has left of the first value is uniform again.
        let rest = ((at - below) / area).clamp(0.0, 1.0 - f64::EPSILON);
        let triangle = triangles[i];
        let corners = mesh.surface.triangles[triangle as usize]
            .map(|v| placement.point(mesh.surface.positions[v as usize].as_dvec3()));
        let sample = sample_triangle_direction(p, corners, [rest, u[1]])?;
        let pdf = sample.pdf * area / total;
        let ray = Ray { origin: p, dir: sample.dir };
        let (t, b) = plane_hit(&ray, corners)?;
        let hit = Hit { t, instance: index, primitive: triangle, b };
        let radiance = self.emitted_towards(&ray, &hit);
        if pdf.is_nan() || pdf <= 0.0 || radiance == Color::ZERO {
            return None;
        }
        let there = self.world.surface(&ray, &hit);
        let end = Ray::leaving(there.p, there.p_error, there.ng, -ray.dir).origin;
        let value = radiance / pdf as f32;
        Some(LightSample {
            wi: ray.dir,
            value,
            distance: t,
            arrival: Arrival::Facet { p: end, p_error: there.p_error, instance: index },
        })
    }

    /// One direction from the balance of several densities (Veach & Guibas 1995): the environment's own;
    /// the cosine of the surface, which serves wide and even skies better; and its highlight's, if it has one.
    fn environment_sample(&self, shading: &Shading, u: [f64; 2]) -> Option<LightSample> {
        let environment = self.world.environment.as_ref()?;
        if !self.plan.soft_shadows {
            // The middle of the surface's cosine, which stands for all of the sky.
            let (wi, value) = (shading.ns, environment.radiance(shading.ns) * std::f32::consts::PI);
            return (value != Color::ZERO).then_some(LightSample {
                wi,
                value,
                distance: f64::INFINITY,
                arrival: Arrival::Infinite,
            });
        }
        let highlight = Highlight::of(shading);
        let strategies = if highlight.is_some() { 3.0 } else { 2.0 };
        let choice = strategies * u[0];
        let u = [(choice - choice.floor()).clamp(0.0, 1.0 - f64::EPSILON), u[1]];
        let wi = match &highlight {
            _ if choice < 1.0 => environment.sample(u)?.dir,
            Some(highlight) if choice >= 2.0 => highlight.sample(u),
            _ => Frame::around(shading.ns).to_world(sampling::cosine_hemisphere(u)),
        };
        let highlight = highlight.map_or(0.0, |highlight| highlight.pdf(wi));
        let cosine = wi.dot(shading.ns).max(0.0) * FRAC_1_PI;
        let pdf = (environment.pdf(wi) + cosine + highlight) / strategies;
        let radiance = environment.radiance(wi);
        (pdf > 0.0 && radiance != Color::ZERO).then(|| LightSample {
            wi,
            value: radiance / pdf as f32,
            distance: f64::INFINITY,
            arrival: Arrival::Infinite,
        })
    }

    /// Radiance that an emitting surface sends back along a ray that hits it.
    fn emitted_towards(&self, ray: &Ray, hit: &Hit) -> Color {
        let world = self.world;
        let binding = &world.bindings[world.instances[hit.instance as usize].binding as usize];
        if let [only] = binding[..] {
            let material = &world.materials[only.0 as usize];
            if let (crate::optics::Weight::Constant(radiance), true) =
                (material.emission, material.emits_back)
            {
                return radiance;
            }
        }
        let surface = world.surface(ray, hit);
        let material = &world.materials[surface.material.0 as usize];
        if !material.emits_back && surface.ng.dot(ray.dir) >= 0.0 {
            return Color::ZERO;
        }
        let point = TexturePoint {
            uv: world.coordinates(&surface).uv,
            duv: Default::default(),
            p: surface.local,
            dp: 0.0,
        };
        material.emission.at(&world.textures, &point)
    }
}

/// The Phong lobe of a surface around its mirror direction.
struct Highlight {
    mirror: DVec3,
    exponent: f64,
}

impl Highlight {
    fn of(shading: &Shading) -> Option<Highlight> {
        (shading.ks != Color::ZERO).then(|| Highlight {
            mirror: shading.ns * (2.0 * shading.wo.dot(shading.ns)) - shading.wo,
            exponent: shading.material.shininess,
        })
    }

    fn sample(&self, u: [f64; 2]) -> DVec3 {
        Frame::around(self.mirror).to_world(sampling::phong_lobe(self.exponent, u))
    }

    /// 1/sr.
    fn pdf(&self, wi: DVec3) -> f64 {
        sampling::phong_lobe_pdf(self.exponent, wi.dot(self.mirror))
    }

    /// The greatest density.
    fn peak(&self) -> f64 {
        (self.exponent + 1.0) / std::f64::consts::TAU
    }
}

/// Unit direction and distance from one point to another, and the inverse of the distance.
#[inline]
fn towards(from: DVec3, to: DVec3) -> Option<(DVec3, f64, f64)> {
    let d = to - from;
    let distance = d.length();
    let inverse = 1.0 / distance;
    (distance > 0.0).then(|| (d * inverse, distance, inverse))
}

/// Where a ray meets the plane of a triangle, with barycentric coordinates put inside of it.
fn plane_hit(ray: &Ray, [a, b, c]: [DVec3; 3]) -> Option<(f64, [f32; 3])> {
    let n = (b - a).cross(c - a);
    let t = (a - ray.origin).dot(n) / ray.dir.dot(n);
    if !(t > 0.0 && t.is_finite()) {
        return None;
    }
    let p = ray.at(t);
    let inverse = 1.0 / n.length_squared();
    let v = ((p - a).cross(c - a).dot(n) * inverse).clamp(0.0, 1.0);
    let w = ((b - a).cross(p - a).dot(n) * inverse).clamp(0.0, 1.0 - v);
    Some((t, [(1.0 - v - w) as f32, v as f32, w as f32]))
}
