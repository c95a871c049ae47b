//! Glass that stands exactly on something opaque.
//!
//! Where a transmissive and an opaque surface coincide, rounding would decide which of the two a ray
//! meets. Here the rule decides: a ray that leaves the glass meets its interface first and then, across
//! a gap of no width, what is opaque; a ray that would enter the glass there meets what is opaque.

use super::media::MediaSet;
use super::surface::Surface;
use super::world::{Hit, Instance, World};
use crate::math::{Aabb, DVec3, Ray, round_up};

/// Opaque instances whose bounds meet those of a transmissive one.
#[derive(Clone, Debug)]
pub enum Contacts {
    /// Each with its bounds.
    Few(Vec<(Aabb, u32)>),
    /// Too many to be listed.
    Many,
}

const FEW: usize = 8;

impl Contacts {
    /// The contacts of every transmissive instance, in the order of `ranked`; empty bounds are never met.
    pub(super) fn find(ranked: &[u32], instances: &[Instance], bounds: &[Aabb]) -> Vec<Contacts> {
        let opaque: Vec<u32> = (0u32..)
            .zip(instances)
            .filter(|(i, instance)| instance.rank == 0 && bounds[*i as usize] != Aabb::EMPTY)
            .map(|(i, _)| i)
            .collect();
        // A look at every pair would be felt.
        if ranked.len().saturating_mul(opaque.len()) > 4_000_000 {
            return vec![Contacts::Many; ranked.len()];
        }
        let of = |&glass: &u32| {
            let near = bounds[glass as usize];
            let mut met = opaque.iter().filter(|&&i| near.overlaps(&bounds[i as usize]));
            let few = met.by_ref().take(FEW).map(|&i| (bounds[i as usize], i)).collect();
            if met.next().is_some() { Contacts::Many } else { Contacts::Few(few) }
        };
        ranked.iter().map(of).collect()
    }

    /// Whether something opaque may lie within `reach` metres of the point.
    #[inline]
    fn may_touch(&self, p: DVec3, reach: f64) -> bool {
        match self {
            Contacts::Many => true,
            Contacts::Few(few) => few.iter().any(|(bounds, _)| {
                let (min, max) = (bounds.min.as_dvec3() - reach, bounds.max.as_dvec3() + reach);
                (min.cmple(p) & p.cmple(max)).all()
            }),
        }
    }
}

/// What a ray meets where surfaces coincide, with their rounding decided.
pub struct Met {
    pub surface: Surface,
    /// What is opaque right behind a surface by which the ray leaves glass.
    pub behind: Option<Hit>,
}

impl World {
    /// What takes the place of the surface at a ray's nearest hit, reached through `media`, if something
    /// coincides with it there.
    #[inline(always)]
    pub fn coinciding(&self, ray: &Ray, media: &MediaSet, hit: &Hit, surface: &Surface) -> Option<Met> {
        let rank = self.instances[hit.instance as usize].rank;
        if rank != 0 {
            let band = band(ray, surface);
            let touches = self.contacts[rank as usize - 1].may_touch(surface.p, band);
            return if touches { self.touching(ray, media, surface, rank, band) } else { None };
        }
        if media.top() != 0 { self.leaving_within(ray, media.top(), hit, surface) } else { None }
    }

    /// The surface of a hit on glass, where something opaque lies in reach of rounding.
    #[inline(never)]
    fn touching(&self, ray: &Ray, media: &MediaSet, surface: &Surface, rank: u32, band: f64) -> Option<Met> {
        let opaque = self.opaque_within(ray, surface.t, band)?;
        Some(if media.contains(rank) && ray.dir.dot(surface.ng) > 0.0 {
            Met { surface: *surface, behind: Some(opaque) }
        } else {
            Met { surface: self.surface(ray, &opaque), behind: None }
        })
    }

    /// The first opaque surface within `band` of t along the ray.
    fn opaque_within(&self, ray: &Ray, t: f64, band: f64) -> Option<Hit> {
        let start = t - band;
        let probe = Ray { origin: ray.at(start), dir: ray.dir };
        let mut best: Option<Hit> = None;
        self.tree.nearest(&super::bvh::BoxRay::rounded(&probe), round_up(2.0 * band), |other, _| {
            if self.instances[other as usize].rank != 0 {
                return None;
            }
            let limit = best.map_or(2.0 * band, |h| h.t);
            let hit = self.nearest_of(other, &probe, limit)?;
            best = Some(hit);
            Some(round_up(hit.t))
        });
        best.map(|hit| Hit { t: start + hit.t, ..hit })
    }

    /// The surface by which a ray leaves the medium of this rank where it meets an opaque one.
    #[inline(never)]
    fn leaving_within(&self, ray: &Ray, rank: u32, hit: &Hit, opaque: &Surface) -> Option<Met> {
        let glass = self.left_within(ray, rank, opaque)?;
        Some(Met { surface: self.surface(ray, &glass), behind: Some(*hit) })
    }

    fn left_within(&self, ray: &Ray, rank: u32, opaque: &Surface) -> Option<Hit> {
        let band = band(ray, opaque);
        if !self.contacts[rank as usize - 1].may_touch(opaque.p, band) {
            return None;
        }
        let start = opaque.t - band;
        let probe = Ray { origin: ray.at(start), dir: ray.dir };
        let hit = self.nearest_of(self.media[rank as usize - 1].instance, &probe, 2.0 * band)?;
        Some(Hit { t: start + hit.t, ..hit })
    }
}

/// Half the length of ray on which surfaces count as one.
#[inline]
fn band(ray: &Ray, surface: &Surface) -> f64 {
    4.0 * surface.p_error / ray.dir.dot(surface.ng).abs().max(1e-3)
}
