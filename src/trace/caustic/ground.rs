//! The ground of a density estimate: those places of the disc around a point on which photons can lie and be
//! counted there.
//!
//! The estimate is divided by the kernel's integral over the ground, so that it is even up to where the ground
//! ends: at the edge of its face, at a mirror or something black let into it, at the foot of a wall. What a wall
//! cuts off is no part of the ground, and photons there are none of the estimate's, whichever surface goes on
//! behind it: the two have to agree about every place, or the estimate has a bias where light is even.

use crate::build::{Obstacles, Shading, Surface, World};
use crate::index::{Kernel, apart_squared};
use crate::math::random::Sequence;
use crate::math::{DVec3, Frame, Ray, Vec3};
use crate::optics::Face;
use std::f64::consts::TAU;

/// Counts of trials whose mean is taken, and the most trials of each: ground that fills less of the disc
/// than that is taken for noise.
const COUNTS: u32 = 2;
const MOST_TRIALS: u32 = 32;
/// The same where things are in the way: a corner of three walls is an eighth of the disc, and less is clutter.
const MOST_TRIALS_AMONG: u32 = 16;

/// Heights over the tangent plane in radii: where what lies at a place is looked for from and how far down, more
/// than a surface bends whose photons count; and that of the sight from place to place.
const ABOVE: f64 = 0.25;
const BELOW: f64 = 0.6;
const SIGHT: f64 = 0.125;

/// The surface around a point, where it may not be even ground for the whole radius.
pub(super) struct Ground<'a> {
    world: &'a World,
    surface: &'a Surface,
    /// On the side that is seen.
    n: DVec3,
    face: Face,
    radius: f64,
    /// How high over the surface the sight from place to place goes, metres, and what may be in its way.
    sight: f64,
    obstacles: Obstacles,
    /// Whether photons may lie beneath one of them.
    lit_beneath: bool,
}

impl<'a> Ground<'a> {
    /// None where the ground is even all round the point.
    pub fn around(
        world: &'a World,
        surface: &'a Surface,
        shading: &Shading,
        radius: f32,
    ) -> Option<Ground<'a>> {
        let (n, radius) = (shading.ng, f64::from(radius));
        let obstacles = world.obstacles(surface, n, radius, ABOVE * radius);
        let even = !shading.material.patchy && world.clearance(surface) >= radius;
        if obstacles.are_none() && even {
            return None;
        }
        let mut sight = SIGHT * radius;
        if !obstacles.are_none() {
            // Under something lower than twice that, half-way up to it.
            let up = Ray { origin: surface.p + n * surface.p_error, dir: n };
            sight = world.nearest_unclear(&up, 2.0 * sight).map_or(sight, |hit| 0.5 * hit.t);
        }
        let (face, lit_beneath) = (world.face(surface, n), world.any_transmits(&obstacles));
        Some(Ground { world, surface, n, face, radius, sight, obstacles, lit_beneath })
    }

    /// Whether anything may cut places off from the point.
    pub fn is_crowded(&self) -> bool {
        !self.obstacles.are_none()
    }

    /// Whether a photon this far away lies on the ground.
    pub fn holds(&self, offset: Vec3) -> bool {
        let place = self.surface.p + offset.as_dvec3();
        self.reaches(place)
            && (!self.lit_beneath || self.is_open(place, self.rounding(place), self.surface.instance))
    }

    /// By how much a photon may lie off its place: it is known in single precision.
    fn rounding(&self, place: DVec3) -> f64 {
        self.surface.p_error + 2.0 * f64::from(f32::EPSILON) * place.abs().max_element()
    }

    fn reaches(&self, place: DVec3) -> bool {
        let up = self.n * self.sight;
        !self.is_crowded() || !self.world.cut_off(&self.obstacles, self.surface.p + up, place + up)
    }

    /// The same ground with nothing in the way.
    pub fn cleared(self) -> Ground<'a> {
        Ground { obstacles: Obstacles::default(), lit_beneath: false, ..self }
    }

    /// What the estimate is multiplied by: the inverse of the kernel's integral over the ground. As many places as
    /// are drawn from the kernel until one lies on the ground are that inverse in the mean, which leaves no bias.
    /// With the number of places. None where none of them lies on the ground.
    pub fn correction(&self, kernel: Kernel, sequence: Sequence) -> (Option<f32>, u32) {
        let frame = Frame::around(self.n);
        let on_ground = |count: u32, trial: u32| {
            let [u, v] = sequence.dimension(u64::from(trial)).split(count, COUNTS).pair();
            let (sin, cos) = libm::sincos(TAU * v);
            self.has((frame.s * cos + frame.t * sin) * (kernel.distance(u) * self.radius))
        };
        let most = if self.is_crowded() { MOST_TRIALS_AMONG } else { MOST_TRIALS };
        let mut places = 0;
        for count in 0..COUNTS {
            let Some(found) = (1..=most).find(|&trial| on_ground(count, trial)) else {
                return (None, places + most);
            };
            places += found;
        }
        (Some(places as f32 / COUNTS as f32), places)
    }

    /// Whether the ground has a place over or under this point of the tangent plane.
    fn has(&self, away: DVec3) -> bool {
        let Ground { world, surface, n, radius, .. } = *self;
        let above = ABOVE * radius + surface.p_error;
        let ray = Ray { origin: surface.p + away + n * above, dir: -n };
        world.any_face(&ray, above + BELOW * radius, |place| {
            let up = if place.ng.dot(n) < 0.0 { -place.ng } else { place.ng };
            let offset = (place.p - surface.p).as_vec3();
            let apart = apart_squared(Vec3::ZERO, n.as_vec3(), offset, up.as_vec3());
            let rough =
                world.is_roughness(place.instance, radius) || world.is_roughness(surface.instance, radius);
            apart.is_some_and(|e2| {
                (rough && (place.p - surface.p).dot(n).abs() <= ABOVE * radius)
                    || f64::from(e2) <= radius * radius
            }) && world.face(place, n) == self.face
                && !(self.face == Face::Outer && world.is_covered(place))
                && self.keeps_photons(place)
                && self.is_open(place.p, place.p_error, place.instance)
                && self.reaches(place.p)
        })
    }

    /// Whether nothing lies on a place, such as a mat that is lower than the sight.
    fn is_open(&self, place: DVec3, p_error: f64, instance: u32) -> bool {
        // What lies in one plane with it may be met above it.
        let from = 2.0 * p_error + self.world.flush_band(instance).unwrap_or(0.0);
        let on = |height| place + self.n * height;
        !self.is_crowded()
            || from >= self.sight
            || !self.world.cut_off(&self.obstacles, on(from), on(self.sight))
    }

    fn keeps_photons(&self, place: &Surface) -> bool {
        Shading::of_photon(self.world, place, self.n, false).keeps_photons()
    }
}
