//! Lamps in the plane of a glass's face.
//!
//! As with all that is opaque (see `contact`), a gap of no width lies between the two: light of the lamp crosses
//! the face before it is in the glass, and what lies in the glass sees the lamp by a refraction only.

use super::contact::{BAND, MOST_SLANT, slant};
use super::media::{MediaSet, Medium};
use super::surface::Surface;
use super::world::{Geometry, World};
use crate::math::{Aabb, DVec3, Ray, robust};

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
}
