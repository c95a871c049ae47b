//! What lies around a surface point, for photons that are gathered across the surface there: what may cut some of
//! its places off from the point, and which surface it is that lies at such a place.
//!
//! What is clear (see [`Instance::clear`]) counts as absent: photons lie beneath it and around it alike.

use super::bvh::BoxRay;
use super::surface::Surface;
use super::world::{Geometry, Hit, Instance, World};
use crate::math::{Aabb, DVec3, Ray, Vec3, round_down, round_up};

/// Faces one over the other, at most, of which one may be a place.
const MOST_FACES: u32 = 8;

/// Instances that may cut places off from a point.
#[derive(Clone, Copy, Debug, Default)]
pub struct Obstacles {
    listed: [u32; LISTED],
    /// All of them, more than are listed too.
    count: usize,
}

const LISTED: usize = 6;

/// Objects around a point from which on no more are looked at: among so many, walls hardly matter.
const MOST_LOOKS: u32 = 24;

impl Obstacles {
    pub fn are_none(&self) -> bool {
        self.count == 0
    }

    /// Whether no more need be looked for.
    fn add(&mut self, instance: u32) -> bool {
        if let Some(place) = self.listed.get_mut(self.count) {
            *place = instance;
        }
        self.count += 1;
        self.count > LISTED
    }
}

impl World {
    /// What is not clear and may come up through the disc of a radius around a point of a surface, or lie over it
    /// no higher than `height`, metres: other objects that are no smaller than the disc, and its own mesh where such
    /// triangles lie across its normal. `n` is the unit geometric normal on the side that is meant. Some may be
    /// listed in vain.
    pub fn obstacles(&self, surface: &Surface, n: DVec3, radius: f64, height: f64) -> Obstacles {
        let half = (DVec3::ONE - n * n).max(DVec3::ZERO);
        let half = DVec3::new(half.x.sqrt(), half.y.sqrt(), half.z.sqrt()) * radius + n.abs() * height;
        let disc = [surface.p - half, surface.p + half];
        // From outside, nothing of a shape lies above its own face: all of them are convex.
        let within_own = surface.ng.dot(n) < 0.0;
        let mut looks = 0;
        let within = |i: u32| {
            let instance = &self.instances[i as usize];
            let own = i == surface.instance;
            if instance.clear || (!own && self.is_roughness(i, radius)) {
                return false;
            }
            let Geometry::Mesh(mesh) = &self.geometries[instance.geometry as usize] else {
                return !own || (within_own && self.clearance(surface) < radius);
            };
            let across = |corners: [Vec3; 3]| {
                let [a, b, c] = corners.map(|v| instance.placement.vector(v.as_dvec3()));
                let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
                let normal = (b - a).cross(c - a);
                longest >= radius * radius && normal.dot(n).abs() < 0.5 * normal.length()
            };
            // In object space no edge that is long enough is shorter than this.
            let least = if own { round_down(radius / instance.placement.stretch()) } else { 0.0 };
            mesh.tree.any_in(&local_bounds(instance, disc), least, |corners| !own || across(corners))
        };
        let mut obstacles = Obstacles::default();
        self.tree.any_in(&Aabb::from_f64(disc[0], disc[1]), |i| {
            looks += 1;
            looks > MOST_LOOKS || (within(i) && obstacles.add(i))
        });
        obstacles
    }

    /// Whether an instance is so small beside a disc of this radius that it is roughness of the surface on which it
    /// stands, rather than something that the surface ends at.
    #[inline]
    pub fn is_roughness(&self, instance: u32, radius: f64) -> bool {
        f64::from(self.instances[instance as usize].breadth) < 2.0 * radius
    }

    /// Whether any of the obstacles lies between two points.
    pub fn cut_off(&self, obstacles: &Obstacles, from: DVec3, to: DVec3) -> bool {
        let ray = Ray { origin: from, dir: to - from };
        if let Some(listed) = obstacles.listed.get(..obstacles.count) {
            return listed.iter().any(|&i| self.hides(i, &ray, 1.0));
        }
        self.tree.any(&BoxRay::rounded(&ray), 1.0, |i| {
            !self.instances[i as usize].clear && self.hides(i, &ray, 1.0)
        })
    }

    /// Whether light may pass one of the obstacles.
    pub fn any_transmits(&self, obstacles: &Obstacles) -> bool {
        match obstacles.listed.get(..obstacles.count) {
            Some(listed) => listed.iter().any(|&i| self.instances[i as usize].rank != 0),
            None => !self.media.is_empty(),
        }
    }

    /// Whether something opaque lies in one plane with the outer face of glass, on which photons stay instead.
    pub fn is_covered(&self, glass: &Surface) -> bool {
        let Some(error) = self.flush_band(glass.instance) else { return false };
        let band = 4.0 * glass.p_error + error;
        let ray = Ray { origin: glass.p + glass.ng * band, dir: -glass.ng };
        self.tree.any(&BoxRay::rounded(&ray), round_up(2.0 * band), |i| {
            self.instances[i as usize].rank == 0 && self.hides(i, &ray, 2.0 * band)
        })
    }

    /// The nearest hit with 0 < t < t_max on what is not clear.
    pub fn nearest_unclear(&self, ray: &Ray, t_max: f64) -> Option<Hit> {
        self.nearest_unclear_but(ray, t_max, None)
    }

    #[inline]
    fn nearest_unclear_but(&self, ray: &Ray, t_max: f64, but: Option<u32>) -> Option<Hit> {
        let mut best = Hit { t: t_max, instance: 0, primitive: 0, b: [0.0; 3] };
        let mut met = false;
        self.tree.nearest(&BoxRay::rounded(ray), round_up(t_max), |i, _| {
            let nearer =
                !self.instances[i as usize].clear && but != Some(i) && self.nearer(i, ray, &mut best);
            met |= nearer;
            nearer.then(|| round_up(best.t))
        });
        met.then_some(best)
    }

    /// Whether one of the surfaces on a ray up to t_max that are not clear, from either side, is such a one.
    pub fn any_face(&self, ray: &Ray, t_max: f64, mut is_such: impl FnMut(&Surface) -> bool) -> bool {
        let mut start = 0.0;
        for _ in 0..MOST_FACES {
            let rest = Ray { origin: ray.at(start), dir: ray.dir };
            let Some(hit) = self.nearest_unclear(&rest, t_max - start) else { return false };
            let surface = self.surface(&rest, &hit);
            if is_such(&surface) {
                return true;
            }
            let slant = 1.0 / ray.dir.dot(surface.ng).abs().max(1e-3);
            let clear_of_it = 4.0 * surface.p_error * slant;
            if let Some(error) = self.flush_band(hit.instance) {
                // What lies in one plane with it, whichever of the two rounding puts first.
                let band = clear_of_it + error * slant;
                let about = Ray { origin: rest.at(surface.t - band), dir: ray.dir };
                let other = self.nearest_unclear_but(&about, 2.0 * band, Some(hit.instance));
                if other.is_some_and(|other| is_such(&self.surface(&about, &other))) {
                    return true;
                }
            }
            start += surface.t + clear_of_it;
        }
        false
    }
}

/// The bounds in object space of a box in the world.
fn local_bounds(instance: &Instance, [min, max]: [DVec3; 2]) -> Aabb {
    let corners = (0..8).map(|i| {
        let pick = |bit: u32, lo: f64, hi: f64| if i & bit == 0 { lo } else { hi };
        instance.placement.local_point(DVec3::new(
            pick(1, min.x, max.x),
            pick(2, min.y, max.y),
            pick(4, min.z, max.z),
        ))
    });
    let (lo, hi) = corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), p| (lo.min(p), hi.max(p)));
    Aabb::from_f64(lo, hi)
}
