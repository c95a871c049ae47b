//! Sources: where photons start, one or two for each emitter, and the domains that their emission is
//! divided into. A sample of a domain estimates, in the mean over [0, 1)⁴, the power that the source
//! sends through it.

use super::balls::Round;
use super::bounds::Bound;
use super::casters;
use super::four::Drawn;
use super::quads::Flat;
use crate::build::{Entry, Geometry, MediaSet, World};
use crate::math::sampling::SphericalCell;
use crate::math::{DVec2, DVec3, Frame, Ray};
use crate::optics::{EmitterKind, Shape, spot_falloff};

/// What emits, with what does not change from photon to photon.
#[derive(Clone, Debug)]
pub(super) struct Source {
    /// Index into the world's emitters.
    pub emitter: u32,
    pub kind: Kind,
    /// Around all points from which it emits; for light from afar around the whole scene.
    pub bound: Bound,
    /// The media in which photons start, where they are the same everywhere.
    pub media: Option<MediaSet>,
    /// Of its instance: that of glass which touches it.
    pub flush_error: f64,
}

#[derive(Clone, Debug)]
pub(super) enum Kind {
    /// Intensity in W/sr.
    Point {
        position: DVec3,
        intensity: DVec3,
        falloff: Option<[f64; 3]>,
    },
    Spot {
        position: DVec3,
        axis: DVec3,
        cos_inner: f64,
        cos_outer: f64,
        intensity: DVec3,
    },
    /// A placed sphere, outwards or inwards.
    Ball {
        instance: u32,
        outwards: bool,
        round: Option<Round>,
    },
    Quad {
        instance: u32,
        flat: Flat,
    },
    /// Any other placed shape.
    Shape {
        instance: u32,
    },
    /// The emitting triangles of a mesh, which the emitter lists.
    Mesh {
        instance: u32,
    },
    /// `frame.n` points to the light.
    Parallel {
        frame: Frame,
        irradiance: DVec3,
    },
    Sky,
}

/// A part of what a source emits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Domain {
    /// All its light in these directions.
    Directions(SphericalCell),
    /// Parallel light through a rectangle perpendicular to it.
    Rectangle { min: DVec2, max: DVec2 },
    /// Light from the sky that meets a target's ball, from a part of the square of the sky's own sampling.
    Sky { target: u32, corner: [f64; 2], side: f64 },
}

/// A photon about to leave.
pub(super) struct Start {
    pub ray: Ray,
    /// Watts, were this the only sample of its domain.
    pub power: DVec3,
    pub media: MediaSet,
    /// The emitter's instance, where it stops light that it sends inwards and rays do not meet it.
    pub within: Option<u32>,
    /// What it crosses where it starts, of glass that is flush with the emitter.
    pub entry: Option<Box<Entry>>,
    /// The classic attenuation, in place of the inverse square of the distance.
    pub falloff: Option<[f64; 3]>,
    /// Index of its emitter in the world.
    pub emitter: u32,
}

impl Source {
    /// The sources of all emitters, in order; `scene` bounds all that rays can meet.
    pub fn all(world: &World, scene: &Bound) -> Vec<Source> {
        let media: Vec<Bound> = world
            .media
            .iter()
            .filter_map(|m| casters::of_instance(world, &world.instances[m.instance as usize]))
            .collect();
        let outside = |bound: &Bound| (!media.iter().any(|m| m.overlaps(bound))).then(MediaSet::default);
        let mut sources = Vec::new();
        for (emitter, described) in (0u32..).zip(&world.emitters) {
            for kind in Kind::of(world, &described.kind) {
                let mut flush_error = 0.0;
                let (bound, media) = match &kind {
                    Kind::Point { position, .. } | Kind::Spot { position, .. } => {
                        (Bound::of_point(*position), Some(world.media_at(*position)))
                    }
                    Kind::Ball { instance, .. }
                    | Kind::Quad { instance, .. }
                    | Kind::Shape { instance }
                    | Kind::Mesh { instance } => {
                        let instance = &world.instances[*instance as usize];
                        flush_error = instance.flush_error;
                        let Some(bound) = casters::of_instance(world, instance) else { continue };
                        (bound, outside(&bound))
                    }
                    Kind::Parallel { .. } | Kind::Sky => (*scene, Some(MediaSet::default())),
                };
                sources.push(Source { emitter, kind, bound, media, flush_error });
            }
        }
        sources
    }

    /// A sample of a domain; `None` where nothing is emitted.
    #[inline]
    pub fn sample(&self, world: &World, targets: &[Bound], domain: &Domain, drawn: &Drawn) -> Option<Start> {
        let u = drawn.u;
        match domain {
            Domain::Directions(cell) => self.towards(world, drawn, cell.solid_angle()),
            Domain::Rectangle { min, max } => self.through(*min, *max, u[0]),
            Domain::Sky { target, corner, side } => {
                let square = [corner[0] + side * u[0][0], corner[1] + side * u[0][1]];
                self.sent_by_sky(world, targets, *target as usize, square, side * side, u[1])
            }
        }
    }

    fn towards(&self, world: &World, drawn: &Drawn, solid_angle: f64) -> Option<Start> {
        let (dir, u) = (drawn.dir, drawn.u[1]);
        match &self.kind {
            Kind::Point { position, intensity, falloff } => {
                let power = *intensity * solid_angle;
                Some(Start { falloff: *falloff, ..self.start(world, Ray { origin: *position, dir }, power) })
            }
            Kind::Spot { position, axis, cos_inner, cos_outer, intensity } => {
                let share = spot_falloff(dir.dot(*axis), *cos_inner, *cos_outer);
                let power = *intensity * (share * solid_angle);
                (share > 0.0).then(|| self.start(world, Ray { origin: *position, dir }, power))
            }
            Kind::Ball { .. } => self.sent_by_ball(world, drawn, solid_angle),
            Kind::Quad { flat, .. } => self.sent_by_quad(world, flat, drawn, solid_angle),
            Kind::Shape { instance } => self.sent_by_shape(world, *instance, dir, solid_angle, u),
            Kind::Mesh { instance } => self.sent_by_mesh(world, *instance, dir, solid_angle, u),
            Kind::Parallel { .. } | Kind::Sky => None,
        }
    }

    pub(super) fn start(&self, world: &World, ray: Ray, power: DVec3) -> Start {
        let media = self.media.unwrap_or_else(|| world.media_at(ray.origin));
        self.start_within(ray, power, media)
    }

    pub(super) fn start_within(&self, ray: Ray, power: DVec3, media: MediaSet) -> Start {
        Start { ray, power, media, within: None, entry: None, falloff: None, emitter: self.emitter }
    }
}

impl Kind {
    fn of(world: &World, emitter: &EmitterKind) -> Vec<Kind> {
        match emitter {
            EmitterKind::Point { position, intensity, falloff } => {
                vec![Kind::Point { position: *position, intensity: intensity.as_dvec3(), falloff: *falloff }]
            }
            EmitterKind::Spot { position, axis, cos_inner, cos_outer, intensity } => vec![Kind::Spot {
                position: *position,
                axis: *axis,
                cos_inner: *cos_inner,
                cos_outer: *cos_outer,
                intensity: intensity.as_dvec3(),
            }],
            EmitterKind::Directional { to_light, irradiance } => {
                vec![Kind::Parallel { frame: Frame::around(*to_light), irradiance: irradiance.as_dvec3() }]
            }
            EmitterKind::Shape { instance } => {
                let instance = *instance;
                if let Some(flat) = Flat::of(world, instance) {
                    return vec![Kind::Quad { instance, flat }];
                }
                let Geometry::Shape(Shape::Sphere(_)) = world.geometry(instance) else {
                    return vec![Kind::Shape { instance }];
                };
                let binding = &world.bindings[world.instances[instance as usize].binding as usize];
                let round = Round::of(world, instance);
                let mut kinds = vec![Kind::Ball { instance, outwards: true, round }];
                if world.materials[binding[0].0 as usize].emits_back {
                    kinds.push(Kind::Ball { instance, outwards: false, round });
                }
                kinds
            }
            EmitterKind::Mesh { instance, .. } => vec![Kind::Mesh { instance: *instance }],
            EmitterKind::Environment => vec![Kind::Sky],
        }
    }
}
