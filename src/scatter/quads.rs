//! Emission from rectangles, placed by any affine map, by a point uniform in area.

use super::bounds::Bound;
use super::four::{Drawn, Left};
use super::source::{Kind, Source, Start};
use super::surfaces::material;
use super::window::Windows;
use crate::build::{Geometry, World};
use crate::math::doubles::{Doubles, Four, Wide, Wide3};
use crate::math::{DVec2, DVec3, robust};
use crate::optics::{Shape, TexturePoint};

/// A placed quad, in the world.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flat {
    /// Where its parameters are 0, metres.
    pub corner: DVec3,
    edges: [DVec3; 2],
    /// The edges' cross product, as long as the area.
    pub across: DVec3,
    /// What has the parameters as products with a point of its plane from the corner.
    pub duals: [DVec3; 2],
    normal: DVec3,
    /// Bound of the errors of its points, metres.
    p_error: f64,
    /// What all of it sends, W·m⁻²·sr⁻¹, unless a texture says more of it.
    radiance: Option<DVec3>,
    transmits: bool,
    both_sides: bool,
}

impl Flat {
    pub fn of(world: &World, instance: u32) -> Option<Flat> {
        let Geometry::Shape(shape @ Shape::Quad(_)) = world.geometry(instance) else { return None };
        let placed = &world.instances[instance as usize];
        let placement = &placed.placement;
        let local = |u| shape.sample_area(u).p;
        let corner = placement.point(local([0.0, 0.0]));
        // Not from points of the world, whose differences have lost the digits of a thin lamp far away.
        let edges = [[1.0, 0.0], [0.0, 1.0]].map(|u| placement.vector(local(u) - local([0.0, 0.0])));
        let across = edges[0].cross(edges[1]);
        if !(across.length_squared() > 0.0 && across.is_finite()) {
            return None;
        }
        let rounding = corner.abs() + edges[0].abs() + edges[1].abs();
        let p_error = robust::placed_error_within(placement, local([0.0, 0.0]).abs(), shape.p_error());
        let material = material(world, world.bindings[placed.binding as usize][0]);
        Some(Flat {
            corner,
            edges,
            across,
            duals: [edges[1].cross(across), across.cross(edges[0])]
                .map(|dual| dual / across.length_squared()),
            normal: placement.unit_normal(DVec3::Y),
            p_error: p_error + robust::gamma(4) * rounding.length(),
            radiance: (!material.emission.textured()).then(|| material.emission.factor().as_dvec3()),
            transmits: material.transmits(),
            both_sides: material.emits_back,
        })
    }

    /// Where photons leave it in these directions, if they do so within the window from which targets can be met.
    #[inline(always)]
    pub fn left_by_four<L: Doubles>(
        &self,
        l: L,
        targets: &[Bound],
        dir: Wide3<L>,
        u: &[Four; 2],
    ) -> [Option<Left>; 4] {
        let window = Windows::of_parallelogram(l, targets, self, dir);
        let [u, v] = window.at([Wide::of(l, &u[0]), Wide::of(l, &u[1])]);
        let (right, up) = (Wide3::splat(l, self.edges[0]), Wide3::splat(l, self.edges[1]));
        let p = (Wide3::splat(l, self.corner) + right * u + up * v).to_vectors();
        let (u, v, share) = (u.to_array(), v.to_array(), window.area().to_array());
        let there = window.bits(l);
        std::array::from_fn(|i| {
            let left = Left { p: p[i], n: self.normal, share: share[i], uv: DVec2::new(u[i], v[i]) };
            (there >> i & 1 == 1).then_some(left)
        })
    }
}

impl Source {
    /// Power: Lₑ·Ω·|cosθ|·A, with the window's share of the area.
    pub(super) fn sent_by_quad(
        &self,
        world: &World,
        flat: &Flat,
        drawn: &Drawn,
        solid_angle: f64,
    ) -> Option<Start> {
        let (Kind::Quad { instance, .. }, Left { p, n, share, uv }) = (&self.kind, drawn.left??) else {
            return None;
        };
        let cos = n.dot(drawn.dir);
        if cos == 0.0 || (cos < 0.0 && !flat.both_sides) {
            return None;
        }
        let radiance = match flat.radiance {
            Some(radiance) => radiance,
            None => {
                let Geometry::Shape(shape) = world.geometry(*instance) else { return None };
                let sample = shape.sample_area(uv.to_array());
                let placed = &world.instances[*instance as usize];
                let material = material(world, world.bindings[placed.binding as usize][0]);
                material.emission.at(&world.textures, &TexturePoint::at(sample.uv, sample.p)).as_dvec3()
            }
        };
        let power = radiance * (solid_angle * cos.abs() * share * flat.across.length());
        (power != DVec3::ZERO).then(|| self.off(world, p, flat.p_error, n, drawn.dir, power, flat.transmits))
    }
}
