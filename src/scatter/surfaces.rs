//! Emission from surfaces: Lₑ·|cosθ| per area and solid angle, here by a point uniform in area.

use super::source::{Source, Start};
use crate::build::{Geometry, World};
use crate::math::{DVec3, Placement, Ray, robust, sampling};
use crate::optics::{EmitterKind, Material, MaterialId, TexturePoint};

/// A point on an emitting surface, in object space.
pub(super) struct Point {
    pub p: DVec3,
    /// In the world, metres.
    pub p_error: f64,
    pub ng: DVec3,
    pub texture: TexturePoint,
}

/// Errors of a point by which light starts off its lamp: its own, and as much of a surface that is known no better.
const FLUSH: f64 = 4.0;

impl Source {
    /// Power: Lₑ·Ω·|cosθ| / pdf, with the density per area of the world.
    pub(super) fn sent_by_shape(
        &self,
        world: &World,
        index: u32,
        dir: DVec3,
        solid_angle: f64,
        u: [f64; 2],
    ) -> Option<Start> {
        let instance = &world.instances[index as usize];
        let Geometry::Shape(shape) = world.geometry(index) else { return None };
        let placement = &instance.placement;
        let sample = shape.sample_area(u);
        let material = material(world, world.bindings[instance.binding as usize][0]);
        let cos = placement.unit_normal(sample.ng).dot(dir);
        if cos == 0.0 || (cos < 0.0 && !material.emits_back) {
            return None;
        }
        let area = placement.area_factor(sample.ng) / sample.pdf;
        let point = Point {
            p: sample.p,
            p_error: robust::placed_error(placement, sample.p, shape.p_error()),
            ng: sample.ng,
            texture: TexturePoint::at(sample.uv, sample.p),
        };
        self.leaving(world, placement, material, &point, dir, solid_angle * cos.abs() * area)
    }

    /// Power: Lₑ·Ω·|cosθ|·A, the triangle drawn by its share of the area A.
    pub(super) fn sent_by_mesh(
        &self,
        world: &World,
        index: u32,
        dir: DVec3,
        solid_angle: f64,
        u: [f64; 2],
    ) -> Option<Start> {
        let instance = &world.instances[index as usize];
        let EmitterKind::Mesh { triangles, cumulative, .. } = &world.emitters[self.emitter as usize].kind
        else {
            return None;
        };
        let Geometry::Mesh(mesh) = world.geometry(index) else { return None };
        let placement = &instance.placement;
        let total = *cumulative.last()?;
        let at = u[0] * total;
        let i = cumulative.partition_point(|&sum| sum <= at).min(triangles.len() - 1);
        let below = if i == 0 { 0.0 } else { cumulative[i - 1] };
        // What the choice has left of the first value is uniform again.
        let rest = ((at - below) / (cumulative[i] - below)).clamp(0.0, 1.0 - f64::EPSILON);
        let b = sampling::triangle([rest, u[1]]).map(|b| b as f32);
        let local = mesh.surface.facet(triangles[i], b).surface();
        let binding = &world.bindings[instance.binding as usize];
        let part = mesh.surface.part(triangles[i]) as usize;
        let material = material(world, binding[part.min(binding.len() - 1)]);
        let cos = placement.unit_normal(local.ng).dot(dir);
        if cos == 0.0 || (cos < 0.0 && !material.emits_back) {
            return None;
        }
        let texture = TexturePoint::at(local.uv, local.p);
        let p_error = robust::placed_error(placement, local.p, local.p_error);
        let point = Point { p: local.p, p_error, ng: local.ng, texture };
        self.leaving(world, placement, material, &point, dir, solid_angle * cos.abs() * total)
    }

    /// The photon of a point of the surface: `extent` in m²·sr takes radiance to power.
    pub(super) fn leaving(
        &self,
        world: &World,
        placement: &Placement,
        material: &Material,
        point: &Point,
        dir: DVec3,
        extent: f64,
    ) -> Option<Start> {
        let radiance = material.emission.at(&world.textures, &point.texture).as_dvec3();
        let power = radiance * extent;
        if power == DVec3::ZERO {
            return None;
        }
        let p = placement.point(point.p);
        let ng = placement.unit_normal(point.ng);
        Some(self.off(world, p, point.p_error, ng, dir, power, material.transmits()))
    }

    /// The photon that starts at `p`, known to within `p_error` metres.
    #[expect(clippy::too_many_arguments, reason = "one photon's all, from two places")]
    #[inline]
    pub(super) fn off(
        &self,
        world: &World,
        p: DVec3,
        p_error: f64,
        ng: DVec3,
        dir: DVec3,
        power: DVec3,
        transmits: bool,
    ) -> Start {
        // Beyond a ceiling that may coincide with the lamp's surface: where shadow rays end as well.
        let mut start = self.start(world, Ray::leaving(p, FLUSH * p_error, ng, dir), power);
        // What shines and transmits has its light from its own surface, across no gap.
        let flush_error = self.flush_error;
        if flush_error > 0.0 && !transmits {
            let flush = world.departure(&Ray { origin: p, dir }, [p_error, flush_error], ng, &start.media);
            if let Some(departure) = flush {
                (start.ray, start.media, start.entry) = (departure.ray, departure.media, departure.entry);
            }
        }
        start
    }
}

pub(super) fn material(world: &World, id: MaterialId) -> &Material {
    &world.materials[id.0 as usize]
}
