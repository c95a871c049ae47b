//! Which photons count at a point: those near it, on its side, on its surface.
//!
//! A photon at x with normal n' counts at p with normal n if n·n' > ½ and its distance e from p is
//! within the radius, where
//!
//! ```text
//! e² = d² + (8² − 1)·h²     d = |x − p|     h = (x − p)·(n + n')/2
//! ```
//!
//! On one plane e = d. Off it, the ball is pressed into a disc an eighth as thick (Jensen 2001,
//! 7.2.1 does so with n alone), so that a step does not leak onto the next. Between two points of a
//! sphere the chord is perpendicular to the sum of their normals: h = 0, and surfaces that curve
//! evenly lose nothing. The other side of a wall, however thin, has n·n' = −1.

use super::boxes::Visitor;
use super::map::{HALVES, LEAF, PhotonMap, Positions};
use super::photon::{NO_DIRECTION, unpack_direction};
use crate::math::lanes::{Array, Lanes};
use crate::math::{Color, Vec3};
use crate::optics::Face;

const LEAST_COSINE: f32 = 0.5;
const PRESS: f32 = 8.0 * 8.0 - 1.0;
/// Boxes are larger than the photons in them; of factors from 0.4 to 1.2 this is among the fastest.
const GENEROUS: f32 = 0.7;

/// A photon that counts.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// Unit, towards where it came from.
    pub wi: Vec3,
    /// Watts a channel.
    pub power: Color,
    /// From the point to the photon, metres.
    pub offset: Vec3,
    /// e², metres².
    pub distance_squared: f32,
    pub face: Face,
}

impl PhotonMap {
    /// Calls `visit` with each photon that counts at `p` within `radius` metres; `n` is the unit
    /// geometric normal on the side that is seen.
    #[inline]
    pub fn within(&self, p: Vec3, n: Vec3, radius: f32, mut visit: impl FnMut(Hit)) {
        self.each(
            p,
            n,
            radius,
            #[inline(always)]
            |place, distance_squared| visit(self.hit(p, place, distance_squared)),
        );
    }

    /// The distance to the k-th of the photons that count at `p`, metres; none where fewer than `k`
    /// (at least 1) are within `max` metres.
    #[inline]
    pub fn nearest_radius(&self, p: Vec3, n: Vec3, k: usize, max: f32) -> Option<f32> {
        self.with_nearest(p, n, k.max(1), max, |nearest| {
            (nearest.len() >= k.max(1)).then(|| nearest.last().map_or(0.0, |c| c.distance_squared().sqrt()))
        })
    }

    /// Calls `visit` with the place and e² of each photon that counts.
    #[inline(always)]
    pub(super) fn each(&self, p: Vec3, n: Vec3, radius: f32, visit: impl FnMut(usize, f32)) {
        let bound = square(radius);
        self.boxes.visit(p, &mut Within { map: self, surface: Surface::new(p, n), bound, visit });
    }

    /// The place of the photon nearest to `p` that counts within `max`, and its distance.
    #[inline]
    pub(super) fn nearest(&self, p: Vec3, n: Vec3, max: f32) -> Option<(usize, f32)> {
        self.with_nearest(p, n, 1, max, |nearest| {
            nearest.last().map(|candidate| (candidate.place(), candidate.distance_squared().sqrt()))
        })
    }

    /// What `of` says of each photon's position and normal, in the map's order; 0 for places without one.
    pub(super) fn at_each(&self, of: impl Fn(Vec3, Vec3) -> f32 + Sync) -> Vec<f32> {
        use rayon::prelude::*;
        (0..self.packed.len())
            .into_par_iter()
            .with_min_len(256)
            .map(|place| {
                let p = self.positions[place / LEAF].at(place % LEAF);
                if p.is_nan() { 0.0 } else { of(p, unpack_direction(self.packed[place].normal)) }
            })
            .collect()
    }

    /// The photon at a place.
    #[inline(always)]
    pub(super) fn hit(&self, p: Vec3, place: usize, distance_squared: f32) -> Hit {
        let packed = &self.packed[place];
        let offset = self.positions[place / LEAF].at(place % LEAF) - p;
        Hit { wi: packed.wi(), power: packed.power(), offset, distance_squared, face: packed.face }
    }

    /// Calls `then` with the `k` nearest photons that count within `max`, the k-th last, the others
    /// in no order; or with all of them where they are fewer.
    #[inline(always)]
    pub(super) fn with_nearest<T>(
        &self,
        p: Vec3,
        n: Vec3,
        k: usize,
        max: f32,
        then: impl FnOnce(&[Candidate]) -> T,
    ) -> T {
        let k = k.min(self.len().max(1)).max(1);
        // Room for as many again lets the k-th be found once in k candidates.
        let room = (2 * k).max(k + LEAF);
        match room {
            0..=128 => self.nearest_into(p, n, k, max, &mut [Candidate::default(); 128][..room], then),
            129..=512 => self.nearest_into(p, n, k, max, &mut [Candidate::default(); 512][..room], then),
            _ => self.nearest_into(p, n, k, max, &mut vec![Candidate::default(); room], then),
        }
    }

    #[inline(always)]
    fn nearest_into<T>(
        &self,
        p: Vec3,
        n: Vec3,
        k: usize,
        max: f32,
        room: &mut [Candidate],
        then: impl FnOnce(&[Candidate]) -> T,
    ) -> T {
        let farthest = square(max);
        // A first look within what should hold k saves looking at far ones; if it does not, further ones
        // grow faster and faster, since there may be none to find.
        let photons = k as f32 + 2.0 * (k as f32).sqrt();
        let mut bound =
            GENEROUS * photons * self.boxes.area_of_a_leaf(p) / LEAF as f32 / std::f32::consts::PI;
        let mut growth = 4.0f32;
        loop {
            let last = !(bound > 0.0 && bound < farthest);
            bound = if last { farthest } else { bound };
            let mut nearest =
                Nearest { map: self, surface: Surface::new(p, n), bound, k, room: &mut *room, count: 0 };
            self.boxes.visit(p, &mut nearest);
            if nearest.count >= k {
                nearest.keep_k();
            }
            let count = nearest.count;
            if last || count >= k {
                return then(&room[..count]);
            }
            bound *= growth;
            growth *= growth;
        }
    }
}

/// e² between a point with its normal and another with its own, metres²; none where photons of the one do not
/// count at the other, however near.
pub fn apart_squared(p: Vec3, n: Vec3, x: Vec3, normal: Vec3) -> Option<f32> {
    (normal.dot(n) > LEAST_COSINE).then(|| {
        let h = (x - p).dot((normal + n) * 0.5);
        (x - p).length_squared() + PRESS * (h * h)
    })
}

/// A square that is finite, since every distance to an absent box is infinite.
fn square(radius: f32) -> f32 {
    (radius * radius).min(f32::MAX)
}

/// A photon's place below its e², so that ties are broken by the place.
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Candidate(u64);

impl Candidate {
    #[inline(always)]
    fn new(place: usize, distance_squared: f32) -> Candidate {
        // floats that are not negative are ordered as their bits
        Candidate(u64::from(distance_squared.to_bits()) << 32 | place as u64)
    }

    #[inline(always)]
    pub fn place(self) -> usize {
        self.0 as u32 as usize
    }

    #[inline(always)]
    pub fn distance_squared(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32)
    }
}

/// The surface at the point of a query, and what it has in common with the last normal met.
struct Surface {
    p: Vec3,
    n: Vec3,
    code: u32,
    /// Half the sum of the normals, where they are compatible.
    middle: Option<Vec3>,
}

impl Surface {
    fn new(p: Vec3, n: Vec3) -> Surface {
        Surface { p, n, code: NO_DIRECTION, middle: None }
    }

    #[inline(always)]
    fn middle(&mut self, code: u32) -> Option<Vec3> {
        if code != self.code {
            let normal = unpack_direction(code);
            self.code = code;
            self.middle = (normal.dot(self.n) > LEAST_COSINE).then(|| (normal + self.n) * 0.5);
        }
        self.middle
    }

    /// Calls `visit` with the place and e² of each photon of a leaf that counts, e² ≤ `bound`.
    #[inline(always)]
    fn scan<L: Lanes>(
        &mut self,
        l: L,
        map: &PhotonMap,
        leaf: usize,
        bound: f32,
        mut visit: impl FnMut(usize, f32),
    ) {
        let code = map.normals[leaf];
        let positions = &map.positions[leaf];
        let common = code != NO_DIRECTION;
        let middle = if common { self.middle(code) } else { Some(Vec3::ZERO) };
        let Some(middle) = middle else { return };
        for half in 0..HALVES {
            let (mut within, distances) = positions.within(l, half, self.p, middle, bound);
            while within != 0 {
                let i = within.trailing_zeros() as usize;
                within &= within - 1;
                let place = half * 8 + i;
                if common {
                    visit(leaf * LEAF + place, distances[i]);
                } else if let Some(middle) = self.middle(map.packed[leaf * LEAF + place].normal) {
                    let h = (positions.at(place) - self.p).dot(middle);
                    let distance_squared = distances[i] + PRESS * (h * h);
                    if distance_squared <= bound {
                        visit(leaf * LEAF + place, distance_squared);
                    }
                }
            }
        }
    }
}

impl Positions {
    /// Which of eight photons have e² ≤ `bound`, if all their normals give `middle`, and their e².
    #[inline(always)]
    fn within<L: Lanes>(&self, l: L, half: usize, p: Vec3, middle: Vec3, bound: f32) -> (u32, Array) {
        let x = l.sub(l.load(&self.x[half]), l.splat(p.x));
        let y = l.sub(l.load(&self.y[half]), l.splat(p.y));
        let z = l.sub(l.load(&self.z[half]), l.splat(p.z));
        let d2 = dot(l, [x, y, z], [x, y, z]);
        let h = dot(l, [x, y, z], [l.splat(middle.x), l.splat(middle.y), l.splat(middle.z)]);
        let e2 = l.add(d2, l.mul(l.splat(PRESS), l.mul(h, h)));
        (l.le(e2, l.splat(bound)), l.store(e2))
    }
}

#[inline(always)]
fn dot<L: Lanes>(l: L, a: [L::F; 3], b: [L::F; 3]) -> L::F {
    l.add(l.add(l.mul(a[0], b[0]), l.mul(a[1], b[1])), l.mul(a[2], b[2]))
}

struct Within<'a, F> {
    map: &'a PhotonMap,
    surface: Surface,
    bound: f32,
    visit: F,
}

// `visit` alone would be called through a reference, which is not inlined into the lanes.
#[allow(clippy::redundant_closure)]
impl<F: FnMut(usize, f32)> Visitor for Within<'_, F> {
    #[inline(always)]
    fn bound(&self) -> f32 {
        self.bound
    }

    #[inline(always)]
    fn leaf<L: Lanes>(&mut self, l: L, leaf: usize) {
        let Within { map, surface, bound, visit } = self;
        surface.scan(
            l,
            map,
            leaf,
            *bound,
            #[inline(always)]
            |place, distance_squared| visit(place, distance_squared),
        );
    }
}

struct Nearest<'a> {
    map: &'a PhotonMap,
    surface: Surface,
    bound: f32,
    k: usize,
    room: &'a mut [Candidate],
    count: usize,
}

impl Nearest<'_> {
    /// Forgets all but the k nearest; needs k at least.
    #[inline(always)]
    fn keep_k(&mut self) {
        let (_, kth, _) = self.room[..self.count].select_nth_unstable(self.k - 1);
        self.bound = kth.distance_squared();
        self.count = self.k;
    }
}

impl Visitor for Nearest<'_> {
    #[inline(always)]
    fn bound(&self) -> f32 {
        self.bound
    }

    #[inline(always)]
    fn leaf<L: Lanes>(&mut self, l: L, leaf: usize) {
        if self.count + LEAF > self.room.len() && self.count >= self.k {
            self.keep_k();
        }
        let Nearest { map, surface, bound, room, count, .. } = self;
        surface.scan(
            l,
            map,
            leaf,
            *bound,
            #[inline(always)]
            |place, distance_squared| {
                room[*count] = Candidate::new(place, distance_squared);
                *count += 1;
            },
        );
    }
}
