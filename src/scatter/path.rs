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

mod turn;

use super::Store;
use super::ledger::Ledger;
use super::photon::Photon;
use super::source::Start;
use crate::build::{Beside, Entry, Hit, MediaSet, Shading, Start as Origin, Surface, World};
use crate::math::random::Sequence;
use crate::math::{Color, DVec3, Health, Rare, Ray};

/// What paths are followed through.
pub(super) struct Walk<'a> {
    pub world: &'a World,
    pub store: Store,
    pub max_depth: u32,
    /// Diffuse surfaces that a path may be sent on by, at most.
    pub bounces: u32,
}

/// What paths leave behind.
#[derive(Default)]
pub(super) struct Sink {
    pub photons: Vec<Photon>,
    pub ledger: Ledger,
    pub health: Health,
    /// The paths' rays in their order, where they are asked for.
    pub rays: Option<Vec<Ray>>,
}

struct Path {
    ray: Ray,
    power: DVec3,
    media: MediaSet,
    /// Metres from the emitter.
    length: f64,
    /// Surfaces passed, which the depth limit counts.
    depth: u32,
    /// Specular events, and passed surfaces that do not exist: what shadow rays end at.
    events: u32,
    /// Diffuse surfaces that sent it on.
    bounces: u32,
    /// Surfaces met, all of them: what its random values are counted by.
    vertex: u64,
    /// µm, once something has dispersed.
    wavelength: Option<f64>,
    falloff: Option<[f64; 3]>,
    /// The surface on which the ray starts, once it has met one.
    from: Option<Origin>,
    /// What it crosses first where it starts.
    entry: Option<Box<Entry>>,
}

/// The dimension of the first diffuse surface's direction.
const BOUNCE: u64 = 1 << 33;

impl Walk<'_> {
    /// Follows one photon to its end.
    pub fn follow(&self, start: &mut Start, sequence: Sequence, sink: &mut Sink) {
        sink.ledger.paths += 1;
        sink.health.photons += 1;
        sink.ledger.emitted += start.power;
        let Start { ray, power, media, falloff, emitter, within, .. } = *start;
        let mut path = Path {
            ray,
            power,
            media,
            length: 0.0,
            depth: 0,
            events: 0,
            bounces: 0,
            vertex: 0,
            wavelength: None,
            falloff,
            from: None,
            entry: start.entry.take(),
        };
        loop {
            if !self.step(&mut path, emitter, within, sequence, sink) {
                return;
            }
            path.depth += 1;
            path.vertex += 1;
            if path.depth > self.max_depth {
                sink.ledger.cut += path.power;
                sink.ledger.cut_paths += 1;
                return;
            }
        }
    }

    /// Goes on to the next surface. Whether the path leaves it.
    #[inline(always)]
    fn step(
        &self,
        path: &mut Path,
        emitter: u32,
        within: Option<u32>,
        sequence: Sequence,
        sink: &mut Sink,
    ) -> bool {
        let entry = path.entry.take();
        let hit = match &entry {
            None => self.nearest(path, emitter, within, sink),
            Some(entry) => Some(entry.hit()),
        };
        let Some(hit) = hit else { return false };
        let scatters = self.store == Store::Indirect;
        let mut surface = self.world.surface_of_photon(&path.ray, &hit, scatters);
        let mut beside = Beside::Nothing;
        if let Some(entry) = entry {
            beside = entry.at(&mut surface);
        } else if let Some(met) = self.world.coinciding(&path.ray, &path.media, &hit, &surface) {
            (surface, beside) = (met.surface, met.beside);
        }
        self.absorb(path, surface.t.max(0.0), sink);
        self.interact(path, &mut surface, &beside, sequence, sink)
    }

    /// What the path's ray meets; where that is nothing, the path has ended.
    #[inline(always)]
    fn nearest(&self, path: &Path, emitter: u32, within: Option<u32>, sink: &mut Sink) -> Option<Hit> {
        sink.ledger.rays += 1;
        if let Some(rays) = &mut sink.rays {
            rays.push(path.ray);
        }
        // A lamp that it has been sent into stops it wherever it gets to, by straight ways or bent ones.
        let t_max = within.map_or(f64::INFINITY, |lamp| {
            self.world.nearest_of(lamp, &path.ray, f64::INFINITY).map_or(0.0, |hit| hit.t)
        });
        let hit = match path.from {
            Some(from) => self.world.nearest_from(from, &path.ray, t_max),
            None => self.world.nearest_from_emitter(emitter, &path.ray, t_max),
        };
        if hit.is_none() {
            let lost = if t_max.is_finite() { &mut sink.ledger.absorbed } else { &mut sink.ledger.escaped };
            *lost += path.power;
        }
        hit
    }

    fn absorb(&self, path: &mut Path, t: f64, sink: &mut Sink) {
        path.length += t;
        let transmittance = self.world.transmittance(&path.media, t);
        if transmittance != Color::ONE {
            let left = path.power * transmittance.as_dvec3();
            sink.ledger.absorbed += path.power - left;
            path.power = left;
        }
    }

    /// Stores, ends or turns the path; whether it goes on.
    #[inline]
    fn interact(
        &self,
        path: &mut Path,
        surface: &mut Surface,
        beside: &Beside,
        sequence: Sequence,
        sink: &mut Sink,
    ) -> bool {
        let world = self.world;
        let scatters = self.store == Store::Indirect;
        let mut shading = Shading::bare(world, surface, -path.ray.dir);
        shading.look_up_for_photon(world, surface, scatters);
        let mut crossing =
            world.crossing(&path.media, path.ray.dir, surface, beside, &shading, &mut sink.health);
        let unnoticed = crossing.as_ref().is_some_and(|c| c.after.top() == path.media.top());
        if unnoticed && let Beside::Behind(opaque) = beside {
            // Nothing is left here, so that what is opaque shows.
            *surface = world.surface(&path.ray, opaque);
            shading = Shading::of_photon(world, surface, -path.ray.dir, scatters);
            crossing = None;
        } else if unnoticed && let Some(crossing) = &crossing {
            // Within an object of higher priority this surface does not exist. Shadow rays end at it all the same, so
            // that what has passed it is for photons to bring.
            path.events += 1;
            path.from = Some(surface.start(path.ray.dir));
            path.ray = world.leaving(surface, crossing.tolerance, path.ray.dir);
            path.media = crossing.after;
            return true;
        }
        let km = shading.km.as_dvec3();
        let through = if crossing.is_some() { (1.0 - km) * shading.kt.as_dvec3() } else { DVec3::ZERO };
        let scattered = self.scattered(path, &shading, km, through, sequence);
        let on = km + through + scattered.map_or(DVec3::ZERO, |(_, weight)| weight);
        let specular = on != DVec3::ZERO && self.store != Store::Direct;
        let stored = self.stored(path, surface, &shading, sink);
        let ended = if specular { path.power * (1.0 - on) } else { path.power };
        let account = if stored { &mut sink.ledger.stored } else { &mut sink.ledger.absorbed };
        *account += ended;
        specular
            && self.turn(
                path,
                surface,
                &shading,
                crossing.as_ref(),
                beside,
                [km, through],
                scattered,
                sequence,
                sink,
            )
    }

    /// The direction in which a diffuse surface sends the path on, with its weight, where such paths are asked for.
    fn scattered(
        &self,
        path: &Path,
        shading: &Shading,
        km: DVec3,
        through: DVec3,
        sequence: Sequence,
    ) -> Option<(DVec3, DVec3)> {
        if self.store != Store::Indirect || path.bounces >= self.bounces || shading.wo.dot(shading.ng) <= 0.0
        {
            return None;
        }
        let rest = (DVec3::ONE - km - through).max(DVec3::ZERO);
        let base = rest.as_vec3a() * shading.kd;
        if base == Color::ZERO && shading.ks == Color::ZERO {
            return None;
        }
        let sequence = sequence.dimension(BOUNCE + path.vertex);
        let (dir, weight) = shading.scattered(base, sequence.pair(), || sequence.dimension(0).value())?;
        Some((dir, weight.as_dvec3()))
    }

    /// Whether a photon was stored.
    fn stored(&self, path: &Path, surface: &Surface, shading: &Shading, sink: &mut Sink) -> bool {
        let due = match self.store {
            Store::Caustics => path.events > 0,
            Store::Direct => path.events == 0,
            Store::Indirect => path.bounces > 0,
        };
        if !due || !shading.keeps_photons() {
            return false;
        }
        let attenuation = path.falloff.map_or(1.0, |[c0, c1, c2]| {
            let l = path.length;
            l * l / (c0 + c1 * l + c2 * l * l)
        });
        let power = (path.power * attenuation).as_vec3();
        if !power.is_finite() {
            sink.health.count(Rare::NonFinitePhoton);
            return false;
        }
        sink.ledger.photons += 1;
        sink.ledger.arrived += path.power;
        sink.photons.push(Photon {
            position: surface.p.as_vec3(),
            wi: shading.wo.as_vec3(),
            normal: shading.ng.as_vec3(),
            power,
            face: self.world.face(surface, shading.ng),
        });
        true
    }
}
