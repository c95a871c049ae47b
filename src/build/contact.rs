//! Glass that stands exactly on something opaque.
//!
//! Where a transmissive and an opaque surface coincide, rounding would decide which of the two a ray
//! meets. Here the rule decides: a ray that leaves the glass meets its interface first and then, across
//! a gap of no width, what is opaque; a ray that would enter the glass there meets what is opaque.

use super::media::MediaSet;
use super::precision::Precision;
use super::surface::Surface;
use super::world::{Hit, Instance, World};
use crate::math::{Aabb, DVec3, Ray, round_up};

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
    /// The contacts of every transmissive instance, in the order of `ranked`, with those of `bounds` that are not
    /// empty. And by instance, its [`Instance::flush_error`], for which all are where they are `placed`.
    pub(super) fn find(
        ranked: &[u32],
        instances: &[Instance],
        [bounds, placed]: [&[Aabb]; 2],
        precision: &mut Precision,
    ) -> (Vec<Contacts>, Vec<f64>) {
        let mut flush = vec![0.0f64; instances.len()];
        let opaque: Vec<u32> =
            (0u32..).zip(instances).filter(|(_, instance)| instance.rank == 0).map(|(i, _)| i).collect();
        let met = |i: &u32| bounds[*i as usize] != Aabb::EMPTY;
        // A look at every pair would be felt.
        if ranked.len().saturating_mul(opaque.len()) > 4_000_000 {
            let most = |precision: &mut Precision, of: &[u32]| {
                of.iter().map(|&i| precision.of(&instances[i as usize])).fold(0.0, f64::max)
            };
            let glass = most(precision, ranked);
            opaque.iter().for_each(|&i| flush[i as usize] = glass);
            let opaque: Vec<u32> = opaque.into_iter().filter(met).collect();
            let all = Contacts { met: Opaque::Many, error: most(precision, &opaque) };
            return (vec![all; ranked.len()], flush);
        }
        let of = |&glass: &u32| {
            let near = placed[glass as usize];
            let error = precision.of(&instances[glass as usize]);
            let touches = |&i: &u32| {
                let other = &placed[i as usize];
                near.overlaps(other) && !precision.holds(&instances[glass as usize], other)
            };
            let touching: Vec<u32> = opaque.iter().copied().filter(touches).collect();
            for &i in &touching {
                flush[i as usize] = flush[i as usize].max(error);
            }
            let met: Vec<u32> = touching.into_iter().filter(met).collect();
            let error = met.iter().map(|&i| precision.of(&instances[i as usize])).fold(0.0, f64::max);
            let few = || met.iter().map(|&i| (bounds[i as usize], i)).collect();
            Contacts { met: if met.len() > FEW { Opaque::Many } else { Opaque::Few(few()) }, error }
        };
        let contacts = ranked.iter().map(of).collect();
        (contacts, flush)
    }

    /// Whether something opaque may lie within `reach` metres of the point.
    #[inline]
    fn may_touch(&self, p: DVec3, reach: f64) -> bool {
        match &self.met {
            Opaque::Many => true,
            Opaque::Few(few) => few.iter().any(|(bounds, _)| bounds.near(p, reach)),
        }
    }
}

/// What is opaque right at an interface.
#[derive(Clone, Copy, Debug)]
pub enum Beside {
    Nothing,
    /// On the far side of one by which a path leaves glass.
    Behind(Hit),
    /// On the near side of one by which a path enters glass, beyond which it is in these media.
    Before(MediaSet),
}

/// What a ray meets where surfaces coincide, with their rounding decided.
pub struct Met {
    pub surface: Surface,
    pub beside: Beside,
}

impl Met {
    /// Glass is left by `surface`, with something `opaque` right behind it.
    fn leaving(surface: &Surface, opaque: &Surface, hit: Hit) -> Met {
        // What is reflected must not meet what is opaque from its wrong side.
        let mut surface = *surface;
        surface.p_error = (BAND + 1.0) * (surface.p_error + opaque.p_error);
        Met { surface, beside: Beside::Behind(hit) }
    }
}

impl World {
    /// How far off a face of the instance, metres, what lies in one plane with it may be met: glass if it is opaque, or
    /// the other way round. None where nothing of that kind touches it.
    #[inline]
    pub fn flush_band(&self, instance: u32) -> Option<f64> {
        let Instance { rank, flush_error, .. } = self.instances[instance as usize];
        let error = if rank == 0 { flush_error } else { self.contacts[rank as usize - 1].error };
        (error > 0.0).then_some(BAND * error)
    }

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
        if media.contains(rank) && ray.dir.dot(surface.ng) > 0.0 {
            return Some(Met::leaving(surface, &opaque, hit));
        }
        // It would enter this glass behind what is opaque; another may end before that.
        let left = if media.top() != 0 { self.leaving_within(ray, media.top(), &hit, &opaque) } else { None };
        left.or(Some(Met { surface: opaque, beside: Beside::Nothing }))
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
                for (_, other) in few.iter().filter(|(bounds, _)| bounds.near(p, band)) {
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
        coincide(ray, &surface, opaque).then(|| Met::leaving(&surface, opaque, *hit))
    }
}

/// So many times their errors are surfaces apart that count as one, or less.
pub(super) const BAND: f64 = 4.0;
/// At grazing angles no farther along the ray than so many times that.
pub(super) const MOST_SLANT: f64 = 1e3;

#[inline]
pub(super) fn slant(ray: &Ray, ng: DVec3) -> f64 {
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
