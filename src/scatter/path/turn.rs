//! Which way a path goes on from a mirror, an interface or a matt surface that sends it on, and what it carries there.

use super::{Path, Sink, Walk};
use crate::build::{Beside, Colour, Crossing, Shading, Start as Origin, Surface};
use crate::math::random::Sequence;
use crate::math::{Color, DVec3, Ray};
use crate::optics::Interface;

/// A way on from a specular surface.
#[derive(Clone, Copy, Default)]
struct Way {
    /// Share of the power that it takes, and of that times its factor for bent normals.
    weight: DVec3,
    factor: f64,
    /// Where it leads, if that is known yet.
    dir: Option<DVec3>,
}

/// The ways on, in the order in which they are drawn.
const MIRRORED: usize = 0;
const REFLECTED: usize = 1;
const REFRACTED: usize = 2;
const SCATTERED: usize = 3;

/// From this bounce on every path may end.
const LONG: u32 = 16;
const LONG_SURVIVAL: f64 = 0.95;

/// The dimension of the first surface's draw; the next ones follow.
const ROULETTE: u64 = 2;

/// The dimension of the wavelength, far from those of any surface.
const WAVELENGTH: u64 = 1 << 32;

impl Walk<'_> {
    /// Follows one of the ways on by Russian roulette; `km` and `through` are the shares of mirror and
    /// interface, which may have something opaque `beside` it. Whether the path goes on.
    #[expect(clippy::too_many_arguments, reason = "one step of one loop, apart for its length")]
    pub(super) fn turn(
        &self,
        path: &mut Path,
        surface: &Surface,
        shading: &Shading,
        crossing: Option<&Crossing>,
        beside: &Beside,
        [km, through]: [DVec3; 2],
        scattered: Option<(DVec3, DVec3)>,
        sequence: Sequence,
        sink: &mut Sink,
    ) -> bool {
        let (out, diffuse) = scattered.unwrap_or_default();
        let on = km + through + diffuse;
        let before = path.power;
        let u = || sequence.dimension(WAVELENGTH).value();
        let (eta, colour) = crossing.map_or((1.0, Colour { um: path.wavelength, weight: Color::ONE }), |c| {
            self.world.relative_ior(&path.media, &c.after, path.wavelength, u)
        });
        path.wavelength = colour.um;
        path.power *= colour.weight.as_dvec3();
        sink.ledger.roulette += (before - path.power) * on;
        let before = path.power;
        let interface = shading.interface(eta);
        let f = interface.reflectance;
        let draw = || sequence.dimension(ROULETTE + path.vertex).value();
        // Clear glass: Fresnel alone decides, and the power stays as it is.
        let clear = through == DVec3::ONE && diffuse == DVec3::ZERO && shading.ns == shading.ng;
        if clear && path.bounces <= LONG {
            let way = if draw() < f { REFLECTED } else { REFRACTED };
            let dir = self.direction(way, shading, eta, &interface, sink);
            return self.go_on(path, surface, crossing, beside, way, dir, sink);
        }
        let way = |weight| Way { weight, factor: 1.0, dir: None };
        let onward = Way { dir: scattered.map(|_| out), ..way(diffuse) };
        let mut ways = [way(km), way(through * f), way(through * (1.0 - f)), onward];
        if shading.ns != shading.ng {
            self.bend(&mut ways, shading, eta, &interface, sink);
            let bent = ways.iter().map(|w| w.weight * w.factor).sum::<DVec3>() - on;
            sink.ledger.bent += before * bent;
        }
        let total = before.element_sum();
        let chance = ways.map(|w| (before * w.weight).element_sum() * w.factor / total);
        let sum: f64 = chance.iter().sum();
        // However white the scene, a long path may end.
        let scale = sum.max(1.0) / if path.bounces > LONG { LONG_SURVIVAL } else { 1.0 };
        let expected = before * ways.iter().map(|w| w.weight * w.factor).sum::<DVec3>();
        let mut u = draw() * scale;
        let drawn = chance.iter().position(|&c| {
            let here = u < c;
            u -= c;
            here
        });
        let Some(i) = drawn else {
            sink.ledger.roulette += expected;
            return false;
        };
        let probability = chance[i] / scale;
        path.power = before * ways[i].weight * (ways[i].factor / probability);
        sink.ledger.roulette += expected - path.power;
        let dir = ways[i].dir.or_else(|| self.direction(i, shading, eta, &interface, sink));
        self.go_on(path, surface, crossing, beside, i, dir, sink)
    }

    /// Sends the path on by one of the ways, in this direction. Whether there is one.
    #[expect(clippy::too_many_arguments, reason = "the end of one step of one loop")]
    #[inline(always)]
    fn go_on(
        &self,
        path: &mut Path,
        surface: &Surface,
        crossing: Option<&Crossing>,
        beside: &Beside,
        i: usize,
        dir: Option<DVec3>,
        sink: &mut Sink,
    ) -> bool {
        let Some(dir) = dir else {
            sink.ledger.absorbed += path.power;
            return false;
        };
        let tolerance = if i == MIRRORED || i == SCATTERED {
            surface.p_error
        } else {
            crossing.map_or(surface.p_error, |c| c.tolerance)
        };
        // From before an interface that touches something, so that what touches is met.
        let from = surface.start(dir);
        let touches = match beside {
            Beside::Nothing => false,
            Beside::Behind(_) => i == REFRACTED,
            Beside::Before(_) => i != REFRACTED,
        };
        (path.from, path.ray) = if touches {
            let from = Origin { outside: false, ..from };
            (Some(from), Ray::reaching(surface.p, tolerance, surface.ng, dir))
        } else {
            (Some(from), self.world.leaving(surface, tolerance, dir))
        };
        if i == REFRACTED
            && let Some(crossing) = crossing
        {
            path.media = crossing.after;
        } else if let Some(departure) = self.world.onward(surface, dir, &path.media) {
            path.from = Some(Origin { outside: false, ..from });
            (path.ray, path.media, path.entry) = (departure.ray, departure.media, departure.entry);
        }
        if i == SCATTERED {
            path.bounces += 1;
            path.depth = 0;
        } else {
            path.events += 1;
        }
        true
    }

    fn direction(
        &self,
        way: usize,
        shading: &Shading,
        eta: f64,
        interface: &Interface,
        sink: &mut Sink,
    ) -> Option<DVec3> {
        if way == REFRACTED {
            shading.refracted(eta, interface, &mut sink.health)
        } else {
            Some(shading.mirrored(&mut sink.health))
        }
    }

    /// The factors of the ways on where the shading normal is bent; 0 for one that leads nowhere.
    fn bend(&self, ways: &mut [Way; 4], shading: &Shading, eta: f64, interface: &Interface, sink: &mut Sink) {
        let (ng, ns) = (shading.ng, shading.ns);
        for (i, way) in ways.iter_mut().enumerate().filter(|(_, w)| w.weight != DVec3::ZERO) {
            way.dir = way.dir.or_else(|| self.direction(i, shading, eta, interface, sink));
            way.factor = way.dir.map_or(0.0, |out| {
                let factor = (shading.wo.dot(ns) * out.dot(ng)) / (shading.wo.dot(ng) * out.dot(ns));
                if factor.is_finite() { factor.abs() } else { 0.0 }
            });
        }
    }
}
