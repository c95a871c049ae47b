//! Emission from surfaces: Lₑ·|cosθ| per area and solid angle.
//!
//! From a sphere, placed by any affine map, by the lines that cross it: those of one direction are
//! uniform over the disk perpendicular to it, in the sphere's own space as in the world, so that all
//! photons of a direction weigh the same. From other surfaces by a point uniform in area.

use super::bounds::Bound;
use super::source::{Kind, Round, Source, Start};
use super::window::Window;
use crate::build::{Geometry, World};
use crate::math::{DVec2, DVec3, Frame, Placement, Ray, robust, sampling};
use crate::optics::{EmitterKind, Material, MaterialId, Quad, Shape, ShapeHit, TexturePoint};
use std::f64::consts::PI;

/// A point on an emitting surface, in object space.
struct Point {
    p: DVec3,
    /// In the world, metres.
    p_error: f64,
    ng: DVec3,
    texture: TexturePoint,
}

/// Errors of a point by which light starts off its lamp: its own, and as much of a surface that is known no better.
const FLUSH: f64 = 4.0;

impl Source {
    /// Power: Lₑ·Ω·A⊥, with A⊥ = πR²·|det M|·|M⁻¹ω| the placed sphere's area as seen along ω, or that of
    /// the window from which targets can be met.
    pub(super) fn sent_by_ball(
        &self,
        world: &World,
        targets: &[Bound],
        dir: DVec3,
        solid_angle: f64,
        u: [f64; 2],
    ) -> Option<Start> {
        let Kind::Ball { instance: index, outwards, round } = self.kind else { return None };
        let instance = &world.instances[index as usize];
        let Geometry::Shape(shape @ Shape::Sphere(sphere)) = world.geometry(index) else { return None };
        let placement = &instance.placement;
        let along = placement.local_vector(dir);
        let (unit, length) = match &round {
            Some(Round { scale, inverse, .. }) => (along * *scale, *inverse),
            None => {
                let length = along.length();
                (along / length, length)
            }
        };
        let frame = Frame::around(unit);
        let (d, share) = in_disk(&frame, targets, placement, round.as_ref(), u)?;
        let height = (1.0 - d.length_squared()).max(0.0).sqrt();
        let n = frame.to_world(d.extend(if outwards { height } else { -height }));
        let material = material(world, world.bindings[instance.binding as usize][0]);
        let p = sphere.center() + n * sphere.radius();
        let texture = if material.emission.textured() {
            // The sphere's own coordinates of the point, as a ray finds them.
            let probe = Ray { origin: p + n * sphere.radius(), dir: -n };
            TexturePoint::at(shape.surface(&probe, ShapeHit { t: sphere.radius(), face: 0 }).uv, p)
        } else {
            TexturePoint::at(Default::default(), p)
        };
        let p_error = match &round {
            Some(round) => round.p_error,
            None => robust::placed_error(placement, p, shape.p_error()),
        };
        let point = Point { p, p_error, ng: n, texture };
        let across = share * sphere.radius() * sphere.radius() * placement.det().abs() * length;
        let mut start = self.leaving(world, placement, material, &point, dir, solid_angle * across)?;
        if !outwards && !instance.visible {
            // Rays do not meet the lamp, but its light does: from outside only its first surface shines.
            start.within = Some(index);
        }
        Some(start)
    }

    /// Power: Lₑ·Ω·|cosθ| / pdf, with the density per area of the world.
    pub(super) fn sent_by_shape(
        &self,
        world: &World,
        targets: &[Bound],
        index: u32,
        dir: DVec3,
        solid_angle: f64,
        u: [f64; 2],
    ) -> Option<Start> {
        let instance = &world.instances[index as usize];
        let Geometry::Shape(shape) = world.geometry(index) else { return None };
        let placement = &instance.placement;
        let (u, share) = match shape {
            Shape::Quad(quad) => {
                let at = |u| placement.point(quad_point(quad, u));
                let corner = at([0.0, 0.0]);
                let edges = [at([1.0, 0.0]) - corner, at([0.0, 1.0]) - corner];
                let window = Window::of_parallelogram(targets, corner, edges, dir)?;
                (window.at(u).to_array(), window.area())
            }
            _ => (u, 1.0),
        };
        let sample = shape.sample_area(u);
        let material = material(world, world.bindings[instance.binding as usize][0]);
        let cos = placement.unit_normal(sample.ng).dot(dir);
        if cos == 0.0 || (cos < 0.0 && !material.emits_back) {
            return None;
        }
        let area = share * placement.area_factor(sample.ng) / sample.pdf;
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
    fn leaving(
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
        let (p, p_error) = (placement.point(point.p), point.p_error);
        let ng = placement.unit_normal(point.ng);
        // Beyond a ceiling that may coincide with the lamp's surface: where shadow rays end as well.
        let mut start = self.start(world, Ray::leaving(p, FLUSH * p_error, ng, dir), power);
        // What shines and transmits has its light from its own surface, across no gap.
        let flush_error = self.flush_error;
        if flush_error > 0.0 && !material.transmits() {
            let flush = world.departure(&Ray { origin: p, dir }, [p_error, flush_error], ng, &start.media);
            if let Some(departure) = flush {
                (start.ray, start.media, start.entry) = (departure.ray, departure.media, departure.entry);
            }
        }
        Some(start)
    }
}

/// A point of the unit disk that is the sphere as seen along `frame.n`, and the area that it stands for.
fn in_disk(
    frame: &Frame,
    targets: &[Bound],
    placement: &Placement,
    round: Option<&Round>,
    u: [f64; 2],
) -> Option<(DVec2, f64)> {
    if let Some(round) = round {
        let turned = |v: DVec3| placement.vector(v) * round.inverse;
        let seen = Frame { s: turned(frame.s), t: turned(frame.t), n: turned(frame.n) };
        let window = Window::of_ball(targets, round, &seen)?;
        if window.area() < PI {
            let d = window.at(u);
            return (d.length_squared() < 1.0).then(|| (d, window.area()));
        }
    }
    Some((sampling::disk(u), PI))
}

fn quad_point(quad: &Quad, u: [f64; 2]) -> DVec3 {
    Shape::Quad(*quad).sample_area(u).p
}

fn material(world: &World, id: MaterialId) -> &Material {
    &world.materials[id.0 as usize]
}
