//! A photon's path: from its emitter through mirrors and interfaces to what is not specular.
//!
//! At a surface of reflection km and transmission kt the power Φ that arrives goes on as km·Φ,
//! (1−km)·kt·F·Φ and (1−km)·kt·(1−F)·Φ, mirrored, reflected and refracted. One of the three is
//! followed, drawn in proportion to its power; it carries its power over its probability, so that
//! nothing is lost or gained in the mean and colourless surfaces leave the power of each photon alone.
//! Power is not changed by the compression of solid angle at an interface, as radiance is.
//!
//! Where the shading normal Ns differs from the geometric Ng, the operator that acts on photons is not
//! the one that acts on eye paths but its adjoint: their power is multiplied by
//! |in·Ns|·|out·Ng| / (|in·Ng|·|out·Ns|) (Veach, Robust Monte Carlo Methods for Light Transport
//! Simulation, 1997, 5.3.4), here before the draw, so that the factor decides about the probabilities as well.

use super::Store;
use super::ledger::Ledger;
use super::photon::Photon;
use super::source::Start;
use crate::build::{Cone, Crossing, MediaSet, Shading, Surface, World};
use crate::math::random::Sequence;
use crate::math::{DVec3, Health, Ray, Vec3};
use crate::optics::Interface;

/// What paths are followed through.
pub(super) struct Walk<'a> {
    pub world: &'a World,
    pub store: Store,
    pub max_depth: u32,
    /// By instance: whether an opaque surface may coincide with it.
    pub touched: &'a [bool],
}

/// What paths leave behind.
#[derive(Default)]
pub(super) struct Sink {
    pub photons: Vec<Photon>,
    pub ledger: Ledger,
    pub health: Health,
}

struct Path {
    ray: Ray,
    power: DVec3,
    media: MediaSet,
    /// Metres from the emitter.
    length: f64,
    /// Surfaces passed, which the depth limit counts.
    depth: u32,
    /// Specular events.
    events: u32,
    falloff: Option<[f64; 3]>,
}

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
const REFRACTED: usize = 2;

/// The dimension of the first surface's draw; the next ones follow.
const ROULETTE: u64 = 2;

impl Walk<'_> {
    /// Follows one photon to its end.
    pub fn follow(&self, start: Start, sequence: Sequence, sink: &mut Sink) {
        sink.ledger.paths += 1;
        sink.ledger.emitted += start.power;
        let Start { ray, power, media, falloff, .. } = start;
        let mut path = Path { ray, power, media, length: 0.0, depth: 0, events: 0, falloff };
        let mut t_max = start.t_max;
        loop {
            sink.ledger.rays += 1;
            let Some(surface) = self.meets(&path, t_max) else {
                let lost =
                    if t_max.is_finite() { &mut sink.ledger.absorbed } else { &mut sink.ledger.escaped };
                *lost += path.power;
                return;
            };
            t_max = f64::INFINITY;
            self.absorb(&mut path, surface.t, sink);
            if !self.interact(&mut path, &surface, sequence, sink) {
                return;
            }
            path.depth += 1;
            if path.depth > self.max_depth {
                sink.ledger.cut += path.power;
                sink.ledger.cut_paths += 1;
                return;
            }
        }
    }

    fn meets(&self, path: &Path, t_max: f64) -> Option<Surface> {
        let world = self.world;
        let hit = world.nearest(&path.ray, t_max)?;
        let surface = world.surface(&path.ray, &hit);
        if world.instances[hit.instance as usize].rank != 0
            && self.touched[hit.instance as usize]
            && let Some(opaque) = world.opaque_at(&path.ray, &surface)
        {
            return Some(world.surface(&path.ray, &opaque));
        }
        Some(surface)
    }

    fn absorb(&self, path: &mut Path, t: f64, sink: &mut Sink) {
        path.length += t;
        let transmittance = self.world.transmittance(&path.media, t);
        if transmittance != Vec3::ONE {
            let left = path.power * transmittance.as_dvec3();
            sink.ledger.absorbed += path.power - left;
            path.power = left;
        }
    }

    /// Stores, ends or turns the path; whether it goes on.
    fn interact(&self, path: &mut Path, surface: &Surface, sequence: Sequence, sink: &mut Sink) -> bool {
        let world = self.world;
        let cone = Cone { width: 0.0, spread: 0.0 };
        let shading = Shading::new(world, surface, -path.ray.dir, &cone);
        let crossing = world.crossing(&path.media, path.ray.dir, surface, &shading, &mut sink.health);
        if let Some(crossing) = &crossing
            && crossing.after.top() == path.media.top()
        {
            // Within an object of higher priority this surface does not exist.
            path.ray = Ray::leaving(surface.p, crossing.tolerance, surface.ng, path.ray.dir);
            path.media = crossing.after;
            return true;
        }
        let km = shading.km.as_dvec3();
        let through = if crossing.is_some() { (1.0 - km) * shading.kt.as_dvec3() } else { DVec3::ZERO };
        let on = km + through;
        let specular = on != DVec3::ZERO && self.store == Store::Caustics;
        let stored = self.stored(path, surface, &shading, sink);
        let ended = if specular { path.power * (1.0 - on) } else { path.power };
        let account = if stored { &mut sink.ledger.stored } else { &mut sink.ledger.absorbed };
        *account += ended;
        specular && self.turn(path, surface, &shading, crossing.as_ref(), [km, through], sequence, sink)
    }

    /// Whether a photon was stored.
    fn stored(&self, path: &Path, surface: &Surface, shading: &Shading, sink: &mut Sink) -> bool {
        let due = match self.store {
            Store::Caustics => path.events > 0,
            Store::Direct => path.events == 0,
        };
        let rest = (Vec3::ONE - shading.km) * (Vec3::ONE - shading.kt);
        let receives = rest * shading.kd != Vec3::ZERO || shading.ks != Vec3::ZERO;
        if !due || !receives || shading.wo.dot(shading.ng) <= 0.0 {
            return false;
        }
        let attenuation = path.falloff.map_or(1.0, |[c0, c1, c2]| {
            let l = path.length;
            l * l / (c0 + c1 * l + c2 * l * l)
        });
        let power = (path.power * attenuation).as_vec3();
        if !power.is_finite() {
            return false;
        }
        sink.ledger.photons += 1;
        sink.ledger.arrived += path.power;
        sink.photons.push(Photon {
            position: surface.p.as_vec3(),
            wi: shading.wo.as_vec3(),
            normal: shading.ng.as_vec3(),
            power,
        });
        true
    }

    /// Follows one of the ways on by Russian roulette; `km` and `through` are the shares of mirror and
    /// interface. Whether the path goes on.
    #[expect(clippy::too_many_arguments, reason = "one step of one loop, apart for its length")]
    fn turn(
        &self,
        path: &mut Path,
        surface: &Surface,
        shading: &Shading,
        crossing: Option<&Crossing>,
        [km, through]: [DVec3; 2],
        sequence: Sequence,
        sink: &mut Sink,
    ) -> bool {
        let before = path.power;
        let on = km + through;
        let eta = crossing.map_or(1.0, |c| self.world.medium(&c.after).0 / self.world.medium(&path.media).0);
        let interface = shading.interface(eta);
        let f = interface.reflectance;
        let way = |weight| Way { weight, factor: 1.0, dir: None };
        let mut ways = [way(km), way(through * f), way(through * (1.0 - f))];
        if shading.ns != shading.ng {
            self.bend(&mut ways, shading, eta, &interface, sink);
            let bent = ways.iter().map(|w| w.weight * w.factor).sum::<DVec3>() - on;
            sink.ledger.bent += before * bent;
        }
        let total = before.element_sum();
        let chance = ways.map(|w| (before * w.weight).element_sum() * w.factor / total);
        let sum: f64 = chance.iter().sum();
        let expected = before * ways.iter().map(|w| w.weight * w.factor).sum::<DVec3>();
        let mut u = sequence.dimension(ROULETTE + u64::from(path.depth)).value() * sum.max(1.0);
        let drawn = chance.iter().position(|&c| {
            let here = u < c;
            u -= c;
            here
        });
        let Some(i) = drawn else {
            sink.ledger.roulette += expected;
            return false;
        };
        let probability = chance[i] / sum.max(1.0);
        path.power = before * ways[i].weight * (ways[i].factor / probability);
        sink.ledger.roulette += expected - path.power;
        let dir = ways[i].dir.or_else(|| self.direction(i, shading, eta, &interface, sink));
        let Some(dir) = dir else {
            sink.ledger.absorbed += path.power;
            return false;
        };
        let tolerance =
            if i == MIRRORED { surface.p_error } else { crossing.map_or(surface.p_error, |c| c.tolerance) };
        path.ray = Ray::leaving(surface.p, tolerance, surface.ng, dir);
        if i == REFRACTED
            && let Some(crossing) = crossing
        {
            path.media = crossing.after;
        }
        path.events += 1;
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
    fn bend(&self, ways: &mut [Way; 3], shading: &Shading, eta: f64, interface: &Interface, sink: &mut Sink) {
        let (ng, ns) = (shading.ng, shading.ns);
        for (i, way) in ways.iter_mut().enumerate().filter(|(_, w)| w.weight != DVec3::ZERO) {
            way.dir = self.direction(i, shading, eta, interface, sink);
            way.factor = way.dir.map_or(0.0, |out| {
                let factor = (shading.wo.dot(ns) * out.dot(ng)) / (shading.wo.dot(ng) * out.dot(ns));
                if factor.is_finite() { factor.abs() } else { 0.0 }
            });
        }
    }
}
