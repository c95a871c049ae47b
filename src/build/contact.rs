//! Glass that stands exactly on something opaque.
//!
//! Where a transmissive and an opaque surface coincide, rounding would decide which of the two a ray
//! meets. Here the rule decides: a ray that leaves the glass meets its interface first and then, across
//! a gap of no width, what is opaque; a ray that would enter the glass there meets what is opaque.

use super::media::{MediaSet, Medium};
use super::precision::Precision;
use super::surface::Surface;
use super::world::{Geometry, Hit, Instance, World};
use crate::math::{Aabb, DVec3, Ray, robust, round_up};

/// Opaque instances whose bounds meet those of a transmissive one, and do not lie deep in it.
#[derive(Clone, Debug)]
pub struct Contacts {
    met: Opaque,
    /// Bound of the `p_error` of their surfaces, metres.
    error: f64,
}

#[derive(Clone, Debug)]
enum Opaque {
    /// Each with its bounds.
    Few(Vec<(Aabb, u32)>),
    /// Too many to be listed.
    Many,
}

const FEW: usize = 8;

impl Contacts {
    /// The contacts of every transmissive instance, in the order of `ranked`; empty bounds are never met.
    pub(super) fn find(
        ranked: &[u32],
        instances: &[Instance],
        bounds: &[Aabb],
        precision: &mut Precision,
    ) -> Vec<Contacts> {
        let opaque: Vec<u32> = (0u32..)
            .zip(instances)
            .filter(|(i, instance)| instance.rank == 0 && bounds[*i as usize] != Aabb::EMPTY)
            .map(|(i, _)| i)
            .collect();
        // A look at every pair would be felt.
        if ranked.len().saturating_mul(opaque.len()) > 4_000_000 {
            let error = opaque.iter().map(|&i| precision.of(&instances[i as usize])).fold(0.0, f64::max);
            return vec![Contacts { met: Opaque::Many, error }; ranked.len()];
        }
        let of = |&glass: &u32| {
            let near = bounds[glass as usize];
            let meets = |&i: &u32| {
                let other = &bounds[i as usize];
                near.overlaps(other) && !precision.holds(&instances[glass as usize], other)
            };
            let met: Vec<u32> = opaque.iter().copied().filter(meets).collect();
            let error = met.iter().map(|&i| precision.of(&instances[i as usize])).fold(0.0, f64::max);
            let few = || met.iter().map(|&i| (bounds[i as usize], i)).collect();
            Contacts { met: if met.len() > FEW { Opaque::Many } else { Opaque::Few(few()) }, error }
        };
        ranked.iter().map(of).collect()
    }

    /// Whether something opaque may lie within `reach` metres of the point.
    #[inline]
    fn may_touch(&self, p: DVec3, reach: f64) -> bool {
        match &self.met {
            Opaque::Many => true,
            Opaque::Few(few) => few.iter().any(|(bounds, _)| within(bounds, p, reach)),
        }
    }
}

/// Whether a point is no farther than `reach` metres from a box along any axis.
#[inline]
fn within(bounds: &Aabb, p: DVec3, reach: f64) -> bool {
    let (min, max) = (bounds.min.as_dvec3() - reach, bounds.max.as_dvec3() + reach);
    (min.cmple(p) & p.cmple(max)).all()
}

/// What a ray meets where surfaces coincide, with their rounding decided.
pub struct Met {
    pub surface: Surface,
    /// What is opaque right behind a surface by which the ray leaves glass.
    pub behind: Option<Hit>,
}

/// How light leaves a lamp that is flush with glass.
pub struct Departure {
    pub ray: Ray,
    pub media: MediaSet,
    pub entry: Option<Box<Entry>>,
}

/// A surface that light crosses where it starts.
pub struct Entry {
    pub surface: Surface,
    /// The media on its far side.
    pub after: MediaSet,
}

impl World {
    /// What takes the place of the surface at a ray's nearest hit, reached through `media`, if something
    /// coincides with it there.
    #[inline(always)]
    pub fn coinciding(&self, ray: &Ray, media: &MediaSet, hit: &Hit, surface: &Surface) -> Option<Met> {
        let rank = self.instances[hit.instance as usize].rank;
        if rank != 0 {
            let contacts = &self.contacts[rank as usize - 1];
            let band = band(ray, surface, contacts.error);
            let touches = contacts.may_touch(surface.p, band);
            return if touches { self.touching(ray, media, surface, rank, band) } else { None };
        }
        if media.top() != 0 { self.leaving_within(ray, media.top(), hit, surface) } else { None }
    }

    /// The surface of a hit on glass, where something opaque lies in reach of rounding.
    #[inline(never)]
    fn touching(&self, ray: &Ray, media: &MediaSet, surface: &Surface, rank: u32, band: f64) -> Option<Met> {
        let hit = self.opaque_within(&self.contacts[rank as usize - 1], ray, surface.t, band)?;
        let opaque = self.surface(ray, &hit);
        if !coincide(ray, surface, &opaque) {
            return None;
        }
        Some(if media.contains(rank) && ray.dir.dot(surface.ng) > 0.0 {
            Met { surface: *surface, behind: Some(hit) }
        } else {
            Met { surface: opaque, behind: None }
        })
    }

    /// How light leaves a lamp that may be flush with glass: the lamp is across a gap of no width, so that light which
    /// goes into the glass meets its surface first, and light which goes the other way is outside. `ray` starts on
    /// the lamp, at a point known to within `p_error` metres on a face of normal `ng`; beyond it are `media`. `None`
    /// where no glass is flush with the lamp there.
    pub fn departure(&self, ray: &Ray, p_error: f64, ng: DVec3, media: &MediaSet) -> Option<Departure> {
        let slant = slant(ray, ng);
        let flush_with = |medium: &Medium| {
            let band = BAND * (p_error + medium.error) * slant;
            let probe = Ray { origin: ray.at(-band), dir: ray.dir };
            let hit = self.nearest_of(medium.instance, &probe, 2.0 * band)?;
            let surface = self.surface(&probe, &hit);
            let apart = BAND * (p_error + surface.p_error) * slant;
            // Beyond both, so that what goes on meets neither the lamp nor the glass again.
            ((surface.t - band).abs() <= apart).then(|| surface.started_at(ray.at(apart)))
        };
        let reach = DVec3::splat(BAND * (p_error + self.media_error) * slant);
        let mut all: Vec<(u32, Surface)> = Vec::new();
        self.tree.any_in(&Aabb::from_f64(ray.origin - reach, ray.origin + reach), |i| {
            let rank = self.instances[i as usize].rank;
            if rank != 0
                && let Some(surface) = flush_with(&self.media[rank as usize - 1])
            {
                all.push((rank, surface));
            }
            false
        });
        let mut before = *media;
        for (rank, _) in &all {
            before = before.crossed(*rank, false).unwrap_or(before);
        }
        let distance = |surface: &Surface| surface.p.distance_squared(ray.origin);
        let farthest = all.iter().map(|(_, s)| s).max_by(|a, b| distance(a).total_cmp(&distance(b)))?.p;
        let mut flush: Vec<_> = all.into_iter().filter(|(_, s)| s.ng.dot(ray.dir) < 0.0).collect();
        flush.sort_by_key(|(rank, _)| *rank);
        let after = flush.iter().fold(before, |set, (rank, _)| set.crossed(*rank, true).unwrap_or(set));
        let ray = Ray { origin: farthest, ..*ray };
        let entered = flush.last().filter(|(rank, _)| *rank == after.top());
        // Beneath a medium that counts more, a surface is none.
        let Some(&(_, surface)) = entered else { return Some(Departure { ray, media: after, entry: None }) };
        let entry = Entry { surface: surface.started_at(farthest), after };
        Some(Departure { ray, media: before, entry: Some(Box::new(entry)) })
    }

    /// Whether glass that the ray starts in is flush with the lamp in which it ends at t = 1, at a point known to
    /// within `p_error` metres or as its shape has it: the lamp is then across a gap, and not seen without a
    /// refraction.
    #[inline]
    pub fn left_at(&self, ray: &Ray, p_error: Option<f64>, media: &MediaSet, lamp: u32) -> bool {
        let rank = media.top();
        rank != 0 && rank != self.instances[lamp as usize].rank && self.left_about(ray, p_error, rank, lamp)
    }

    #[inline(never)]
    fn left_about(&self, ray: &Ray, p_error: Option<f64>, rank: u32, lamp: u32) -> bool {
        let p_error = p_error.unwrap_or_else(|| {
            let Geometry::Shape(shape) = self.geometry(lamp) else { return 0.0 };
            let placement = &self.instances[lamp as usize].placement;
            robust::placed_error(placement, placement.local_point(ray.at(1.0)), shape.p_error())
        });
        let medium = &self.media[rank as usize - 1];
        let length = ray.dir.length();
        let unit = Ray { origin: ray.origin, dir: ray.dir / length };
        let band = (BAND * (p_error + medium.error) * MOST_SLANT).min(length);
        let probe = Ray { origin: unit.at(length - band), dir: unit.dir };
        let Some(hit) = self.nearest_of(medium.instance, &probe, 2.0 * band) else { return false };
        let surface = self.surface(&probe, &hit);
        (surface.t - band).abs() <= BAND * (p_error + surface.p_error) * slant(&unit, surface.ng)
    }

    /// The first opaque surface within `band` of t along the ray.
    fn opaque_within(&self, contacts: &Contacts, ray: &Ray, t: f64, band: f64) -> Option<Hit> {
        let start = t - band;
        let probe = Ray { origin: ray.at(start), dir: ray.dir };
        let mut best: Option<Hit> = None;
        let mut look = |other: u32| {
            let limit = best.map_or(2.0 * band, |h| h.t);
            let hit = self.nearest_of(other, &probe, limit)?;
            best = Some(hit);
            Some(round_up(hit.t))
        };
        match &contacts.met {
            Opaque::Few(few) => {
                let p = ray.at(t);
                for (_, other) in few.iter().filter(|(bounds, _)| within(bounds, p, band)) {
                    look(*other);
                }
            }
            Opaque::Many => {
                self.tree.nearest(&super::bvh::BoxRay::rounded(&probe), round_up(2.0 * band), |other, _| {
                    if self.instances[other as usize].rank == 0 { look(other) } else { None }
                });
            }
        }
        best.map(|hit| Hit { t: start + hit.t, ..hit })
    }

    /// The surface by which a ray leaves the medium of this rank where it meets an opaque one.
    #[inline(never)]
    fn leaving_within(&self, ray: &Ray, rank: u32, hit: &Hit, opaque: &Surface) -> Option<Met> {
        let medium = &self.media[rank as usize - 1];
        let band = band(ray, opaque, medium.error);
        if !self.contacts[rank as usize - 1].may_touch(opaque.p, band) {
            return None;
        }
        let start = opaque.t - band;
        let probe = Ray { origin: ray.at(start), dir: ray.dir };
        let glass = self.nearest_of(medium.instance, &probe, 2.0 * band)?;
        let surface = self.surface(ray, &Hit { t: start + glass.t, ..glass });
        coincide(ray, &surface, opaque).then_some(Met { surface, behind: Some(*hit) })
    }
}

/// So many times their errors are surfaces apart that count as one, or less.
const BAND: f64 = 4.0;
/// At grazing angles no farther along the ray than so many times that.
const MOST_SLANT: f64 = 1e3;

#[inline]
fn slant(ray: &Ray, ng: DVec3) -> f64 {
    (1.0 / ray.dir.dot(ng).abs()).min(MOST_SLANT)
}

/// Half the length of ray on which a surface may coincide with one of an error up to `other`.
#[inline]
fn band(ray: &Ray, surface: &Surface, other: f64) -> f64 {
    BAND * (surface.p_error + other) * slant(ray, surface.ng)
}

/// Whether two surfaces on a ray count as one.
fn coincide(ray: &Ray, a: &Surface, b: &Surface) -> bool {
    (a.t - b.t).abs() <= band(ray, a, b.p_error)
}
