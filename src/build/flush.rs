//! Light that leaves what is opaque in the plane of a glass's face: a lamp, a mirror, a matt surface.
//!
//! As for light that arrives there (see `contact`), a gap of no width lies between the two: what leaves crosses the
//! face before it is in the glass, and what lies in the glass and what is opaque see each other by a refraction only.

use super::contact::{BAND, Beside, MOST_SLANT, slant};
use super::media::{MediaSet, Medium};
use super::surface::Surface;
use super::world::{Geometry, Hit, World};
use crate::math::{Aabb, DVec3, Ray, robust};

/// How light leaves what is flush with glass.
pub struct Departure {
    pub ray: Ray,
    pub media: MediaSet,
    pub entry: Option<Box<Entry>>,
}

/// A surface that light crosses where it starts.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// On it, at a t of about 0.
    hit: Hit,
    /// Offset along the normal that clears all that is flush there, metres.
    p_error: f64,
    /// The media on its far side.
    after: MediaSet,
}

impl Entry {
    pub fn hit(&self) -> Hit {
        self.hit
    }

    /// Of the surface at its hit: what is known of it, and what the path comes from.
    #[inline]
    pub fn at(&self, surface: &mut Surface) -> Beside {
        surface.p_error = self.p_error;
        Beside::Before(self.after)
    }
}

/// Faces before a lamp, at most, that may be flush with it.
const MOST_FLUSH: u32 = 8;

/// A face of glass in one plane with another.
struct Flush {
    hit: Hit,
    /// Of the two planes together, metres.
    error: f64,
    inwards: bool,
}

impl World {
    /// How light that a surface sends on leaves it, where glass is flush with it there: see [`World::departure`].
    #[inline]
    pub fn onward(&self, surface: &Surface, dir: DVec3, media: &MediaSet) -> Option<Departure> {
        if self.instances[surface.instance as usize].flush_error == 0.0 {
            return None;
        }
        let error = self.instances[surface.instance as usize].flush_error;
        self.departure(&Ray { origin: surface.p, dir }, [surface.p_error, error], surface.ng, media)
    }

    /// Whether light between a point of a surface and a lamp in this direction crosses glass that is flush with the
    /// surface. The glass's own light, if it is the lamp, crosses nothing.
    #[inline(never)]
    pub fn enters(&self, surface: &Surface, dir: DVec3, media: &MediaSet, lamp: Option<u32>) -> bool {
        let entry = self.onward(surface, dir, media).and_then(|departure| departure.entry);
        entry.is_some_and(|entry| lamp != Some(entry.hit.instance))
    }

    /// Whether all that lies on a ray before `t_end` is glass that is flush with the lamp in which the ray ends at
    /// t = 1, at a point known to within `p_error` metres or as its shape has it: rounding has put it before the lamp.
    #[inline]
    pub fn hidden_by_flush_only(&self, ray: &Ray, t_end: f64, p_error: Option<f64>, lamp: u32) -> bool {
        let error = self.instances[lamp as usize].flush_error;
        error > 0.0 && self.flush_alone(ray, t_end, p_error, error, lamp)
    }

    #[inline(never)]
    fn flush_alone(&self, ray: &Ray, t_end: f64, p_error: Option<f64>, error: f64, lamp: u32) -> bool {
        let p_error = p_error.unwrap_or_else(|| self.error_at(ray.at(1.0), lamp));
        let length = ray.dir.length();
        let unit = Ray { origin: ray.origin, dir: ray.dir / length };
        let band = (BAND * (p_error + error) * MOST_SLANT).min(length);
        if self.occluded(&unit, length - band, Some(lamp)) {
            return false;
        }
        let mut start = length - band;
        for _ in 0..MOST_FLUSH {
            let probe = Ray { origin: unit.at(start), dir: unit.dir };
            let Some(hit) = self.nearest(&probe, t_end * length - start) else { return true };
            let surface = self.surface(&probe, &hit);
            let apart = BAND * (p_error + surface.p_error) * slant(&unit, surface.ng);
            let flush = start + surface.t + apart >= length;
            if hit.instance != lamp && !(flush && self.instances[hit.instance as usize].rank != 0) {
                return false;
            }
            start += surface.t + surface.p_error * slant(&unit, surface.ng);
        }
        false
    }

    /// The error of a point of a shape, metres.
    fn error_at(&self, p: DVec3, instance: u32) -> f64 {
        let Geometry::Shape(shape) = self.geometry(instance) else { return 0.0 };
        let placement = &self.instances[instance as usize].placement;
        robust::placed_error(placement, placement.local_point(p), shape.p_error())
    }

    /// How light leaves something opaque that may be flush with glass: it is across a gap of no width, so that light
    /// which goes into the glass meets its surface first, and light which goes the other way is outside. `ray` starts
    /// at a point on a face of normal `ng`; beyond it are `media`. The point is known to within the first of the errors,
    /// glass that touches the object to within the second, metres. `None` where no glass is flush with the face there.
    #[inline(never)]
    pub fn departure(
        &self,
        ray: &Ray,
        [p_error, error]: [f64; 2],
        ng: DVec3,
        media: &MediaSet,
    ) -> Option<Departure> {
        let slant = slant(ray, ng);
        let flush_with = |medium: &Medium| {
            if !medium.bounds.near(ray.origin, BAND * (p_error + medium.error)) {
                return None;
            }
            let band = BAND * (p_error + medium.error) * slant;
            let probe = Ray { origin: ray.at(-band), dir: ray.dir };
            let hit = self.nearest_of(medium.instance, &probe, 2.0 * band)?;
            let surface = self.surface(&probe, &hit);
            let error = p_error + surface.p_error;
            let hit = Hit { t: hit.t - band, ..hit };
            ((surface.t - band).abs() <= BAND * error * slant).then_some(Flush {
                hit,
                error,
                inwards: surface.ng.dot(ray.dir) < 0.0,
            })
        };
        let reach = DVec3::splat(BAND * (p_error + error));
        if !self.may_have_medium_near(ray.origin, reach.x) {
            return None;
        }
        let mut all: Vec<(u32, Flush)> = Vec::new();
        self.tree.any_in(&Aabb::from_f64(ray.origin - reach, ray.origin + reach), |i| {
            let rank = self.instances[i as usize].rank;
            if rank != 0
                && let Some(flush) = flush_with(&self.media[rank as usize - 1])
            {
                all.push((rank, flush));
            }
            false
        });
        let error = all.iter().map(|(_, flush)| flush.error).reduce(f64::max)?;
        let mut before = *media;
        for (rank, _) in &all {
            before = before.crossed(*rank, false).unwrap_or(before);
        }
        all.retain(|(_, flush)| flush.inwards);
        all.sort_by_key(|(rank, _)| *rank);
        let after = all.iter().fold(before, |set, (rank, _)| set.crossed(*rank, true).unwrap_or(set));
        let entered = all.last().filter(|(rank, _)| *rank == after.top());
        // Beneath a medium that counts more, a surface is none.
        let Some(&(_, Flush { hit, .. })) = entered else {
            // Beyond all of them, so that what goes on meets none again.
            let ray = Ray { origin: ray.at(BAND * error * slant), dir: ray.dir };
            return Some(Departure { ray, media: after, entry: None });
        };
        let entry = Entry { hit, p_error: (2.0 * BAND + 1.0) * error, after };
        Some(Departure { ray: *ray, media: before, entry: Some(Box::new(entry)) })
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
        let p_error = p_error.unwrap_or_else(|| self.error_at(ray.at(1.0), lamp));
        let medium = &self.media[rank as usize - 1];
        let length = ray.dir.length();
        let unit = Ray { origin: ray.origin, dir: ray.dir / length };
        let band = (BAND * (p_error + medium.error) * MOST_SLANT).min(length);
        let probe = Ray { origin: unit.at(length - band), dir: unit.dir };
        let Some(hit) = self.nearest_of(medium.instance, &probe, 2.0 * band) else { return false };
        let surface = self.surface(&probe, &hit);
        (surface.t - band).abs() <= BAND * (p_error + surface.p_error) * slant(&unit, surface.ng)
    }
}
