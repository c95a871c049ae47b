//! Emission from spheres, placed by any affine map, by the lines that cross them: those of one direction are
//! uniform over the disk perpendicular to it, in the sphere's own space as in the world, so that all photons
//! of a direction weigh the same.

use super::bounds::Bound;
use super::four::{Drawn, Left};
use super::source::{Kind, Source, Start};
use super::surfaces::{Point, material};
use super::window::Windows;
use crate::build::{Geometry, World};
use crate::math::doubles::{Doubles, Four, Wide, Wide3};
use crate::math::{DVec2, DVec3, Frame, Ray, robust, sampling};
use crate::optics::{Shape, ShapeHit, Sphere, TexturePoint};
use std::f64::consts::PI;

/// A ball that its placement leaves round, in the world.
#[derive(Clone, Copy, Debug)]
pub(super) struct Round {
    /// Metres.
    pub center: DVec3,
    radius: f64,
    pub inverse_radius: f64,
    /// Bound of the errors of its surface's points, metres.
    p_error: f64,
    /// What all of it sends, W·m⁻²·sr⁻¹, unless a texture says more of it.
    radiance: Option<DVec3>,
    transmits: bool,
}

/// How unevenly a ball may be scaled, relative, that counts as round.
pub(super) const UNEVEN: f64 = 1e-12;

impl Round {
    pub fn of(world: &World, instance: u32) -> Option<Round> {
        let Geometry::Shape(shape @ Shape::Sphere(sphere)) = world.geometry(instance) else { return None };
        let placed = &world.instances[instance as usize];
        let scale = super::casters::round_scale(&placed.placement)?;
        let radius = scale * sphere.radius();
        let reach = sphere.center().abs() + sphere.radius();
        let p_error = robust::placed_error_within(&placed.placement, reach, shape.p_error());
        let material = material(world, world.bindings[placed.binding as usize][0]);
        Some(Round {
            center: placed.placement.point(sphere.center()),
            radius,
            inverse_radius: 1.0 / radius,
            p_error: p_error + UNEVEN * radius,
            radiance: (!material.emission.textured()).then(|| material.emission.factor().as_dvec3()),
            transmits: material.transmits(),
        })
    }
}

impl Round {
    /// Where photons leave it in these directions, if they do so within the window from which targets can be met;
    /// A⊥ is share·R².
    #[inline(always)]
    pub fn left_by_four<L: Doubles>(
        &self,
        l: L,
        targets: &[Bound],
        outwards: bool,
        dir: Wide3<L>,
        u: &[Four; 2],
    ) -> [Option<Left>; 4] {
        let (zero, one) = (Wide::splat(l, 0.0), Wide::splat(l, 1.0));
        let (s, t) = axes_around(l, dir);
        let window = Windows::of_ball(l, targets, self, s, t);
        let u = [Wide::of(l, &u[0]), Wide::of(l, &u[1])];
        let [mut x, mut y] = window.at(u);
        let mut share = window.area();
        // All of the disk is less than its square from here on.
        let wide = Wide::splat(l, PI).le(share);
        if wide.bits() != 0 {
            let disk = sampling::disk_four(l, u);
            (x, y) = (wide.select(disk[0], x), wide.select(disk[1], y));
            share = wide.select(Wide::splat(l, PI), share);
        }
        let height2 = one - (x * x + y * y);
        let meets = window.bits(l) & (zero.lt(height2).bits() | wide.bits());
        let up = height2.max(zero).sqrt() * Wide::splat(l, if outwards { 1.0 } else { -1.0 });
        let n = s * x + t * y + dir * up;
        let p = Wide3::splat(l, self.center) + n * Wide::splat(l, self.radius);
        let (p, n, share) = (p.to_vectors(), n.to_vectors(), share.to_array());
        std::array::from_fn(|i| {
            (meets >> i & 1 == 1).then(|| Left { p: p[i], n: n[i], share: share[i], uv: DVec2::ZERO })
        })
    }
}

/// The first two axes of [`Frame::around`].
#[inline(always)]
fn axes_around<L: Doubles>(l: L, n: Wide3<L>) -> (Wide3<L>, Wide3<L>) {
    let (zero, one) = (Wide::splat(l, 0.0), Wide::splat(l, 1.0));
    let sign = n.z.lt(zero).select(-one, one);
    let a = -one / (sign + n.z);
    let b = n.x * n.y * a;
    let s = Wide3 { x: one + sign * n.x * n.x * a, y: sign * b, z: -sign * n.x };
    let t = Wide3 { x: b, y: sign + n.y * n.y * a, z: -n.y };
    (s, t)
}

impl Source {
    /// Power: Lₑ·Ω·A⊥, with A⊥ the placed sphere's area as seen along ω, or that of the window from which
    /// targets can be met.
    pub(super) fn sent_by_ball(&self, world: &World, drawn: &Drawn, solid_angle: f64) -> Option<Start> {
        let Kind::Ball { instance, outwards, round } = &self.kind else { return None };
        let mut start = match (round, drawn.left) {
            (Some(round), Some(left)) => self.sent_by_round(world, round, left?, drawn.dir, solid_angle),
            _ => self.sent_by_ellipsoid(world, drawn.dir, solid_angle, drawn.u[1]),
        }?;
        if !outwards && !world.instances[*instance as usize].visible {
            // Rays do not meet the lamp, but its light does: from outside only its first surface shines.
            start.within = Some(*instance);
        }
        Some(start)
    }

    /// A⊥ = πR² or less.
    fn sent_by_round(
        &self,
        world: &World,
        round: &Round,
        Left { p, n, share, .. }: Left,
        dir: DVec3,
        solid_angle: f64,
    ) -> Option<Start> {
        let Kind::Ball { instance, .. } = self.kind else { return None };
        let radiance = match round.radiance {
            Some(radiance) => radiance,
            None => {
                let Geometry::Shape(Shape::Sphere(sphere)) = world.geometry(instance) else { return None };
                let placed = &world.instances[instance as usize];
                let texture = texture_point(sphere, placed.placement.local_vector(n).normalize());
                let material = material(world, world.bindings[placed.binding as usize][0]);
                material.emission.at(&world.textures, &texture).as_dvec3()
            }
        };
        let power = radiance * (solid_angle * share * round.radius * round.radius);
        (power != DVec3::ZERO).then(|| self.off(world, p, round.p_error, n, dir, power, round.transmits))
    }

    /// A⊥ = πR²·|det M|·|M⁻¹ω|.
    fn sent_by_ellipsoid(&self, world: &World, dir: DVec3, solid_angle: f64, u: [f64; 2]) -> Option<Start> {
        let Kind::Ball { instance: index, outwards, .. } = self.kind else { return None };
        let instance = &world.instances[index as usize];
        let Geometry::Shape(shape @ Shape::Sphere(sphere)) = world.geometry(index) else { return None };
        let placement = &instance.placement;
        let along = placement.local_vector(dir);
        let length = along.length();
        let d = sampling::disk(u);
        let height = (1.0 - d.length_squared()).max(0.0).sqrt();
        let n = Frame::around(along / length).to_world(d.extend(if outwards { height } else { -height }));
        let material = material(world, world.bindings[instance.binding as usize][0]);
        let texture = texture_point(sphere, n);
        let p = sphere.center() + n * sphere.radius();
        let p_error = robust::placed_error(placement, p, shape.p_error());
        let point = Point { p, p_error, ng: n, texture };
        let across = PI * sphere.radius() * sphere.radius() * placement.det().abs() * length;
        self.leaving(world, placement, material, &point, dir, solid_angle * across)
    }
}

/// The sphere's own coordinates of the point whose normal is `n`, as a ray finds them.
fn texture_point(sphere: &Sphere, n: DVec3) -> TexturePoint {
    let p = sphere.center() + n * sphere.radius();
    let probe = Ray { origin: p + n * sphere.radius(), dir: -n };
    let hit = ShapeHit { t: sphere.radius(), face: 0 };
    TexturePoint::at(Shape::Sphere(*sphere).surface(&probe, hit).uv, p)
}
