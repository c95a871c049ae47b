//! The planes that bound a convex solid around the origin, four at a time.

use super::ShapeHit;
use super::span::Span;
use crate::math::doubles::{Doubles, Four, Wide, Wide3};
use crate::math::lanes::{Lanes, Machine, Work};
use crate::math::{DVec3, Ray};

const WIDTH: usize = 4;
/// Four times this many planes: those of the icosahedron.
const MOST: usize = 5;
/// The bits of all lanes.
const ALL: u32 = (1 << WIDTH) - 1;

/// Four planes: normals by axis, and distances. Places without a plane hold one that is infinitely far.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(32))]
struct Group {
    normals: [Four; 3],
    distances: Four,
}

impl Group {
    fn new(normals: &[DVec3], distance: f64) -> Group {
        let mut group = Group { normals: [[0.0; WIDTH]; 3], distances: [f64::INFINITY; WIDTH] };
        for (i, normal) in normals.iter().enumerate() {
            (0..3).for_each(|axis| group.normals[axis][i] = normal[axis]);
            group.distances[i] = distance;
        }
        group
    }

    #[inline(always)]
    fn dot<L: Doubles>(&self, l: L, v: Wide3<L>) -> Wide<L> {
        let [x, y, z] = &self.normals;
        v.dot(Wide3 { x: Wide::of(l, x), y: Wide::of(l, y), z: Wide::of(l, z) })
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Planes(Vec<Group>);

impl Planes {
    /// At most twenty.
    pub fn new(normals: &[DVec3], distance: f64) -> Planes {
        assert!(normals.len() <= MOST * WIDTH, "the solids have twenty faces at most");
        Planes(normals.chunks(WIDTH).map(|normals| Group::new(normals, distance)).collect())
    }

    /// The ray's part on the inner side of all planes, faces numbered as the normals were: to the bit that of
    /// [`Span::clip`] plane by plane, whose branches would be guessed wrong every other time.
    #[inline]
    pub fn span(&self, ray: &Ray) -> Option<Span> {
        Machine::detect().run(Clip { groups: &self.0, ray })
    }

    /// From a point of one of the planes, on the inner side of all, to the nearest of the others.
    #[inline]
    pub fn clearance(&self, p: DVec3) -> f64 {
        Machine::detect().run(Second { groups: &self.0, p })
    }
}

struct Clip<'a> {
    groups: &'a [Group],
    ray: &'a Ray,
}

impl Work for Clip<'_> {
    type Output = Option<Span>;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Option<Span> {
        let Clip { groups, ray } = self;
        let l = l.doubles();
        let (origin, dir) = (Wide3::splat(l, ray.origin), Wide3::splat(l, ray.dir));
        let zero = Wide::splat(l, 0.0);
        let (never, always) = (Wide::splat(l, f64::NEG_INFINITY), Wide::splat(l, f64::INFINITY));
        let (mut enter, mut exit) = (never, always);
        let (mut enters, mut exits) = ([never; MOST], [always; MOST]);
        let mut outside = 0;
        for ((group, enters), exits) in groups.iter().zip(&mut enters).zip(&mut exits) {
            let (height, slope) = (group.dot(l, origin) - Wide::of(l, &group.distances), group.dot(l, dir));
            let t = -height / slope;
            let (inwards, outwards) = (slope.lt(zero), zero.lt(slope));
            *enters = inwards.select(t, never);
            *exits = outwards.select(t, always);
            enter = enters.max(enter);
            exit = exits.min(exit);
            // Parallel to the plane, and not on its inner side.
            outside |= ALL & !(inwards.bits() | outwards.bits() | height.le(zero).bits());
        }
        let (enter, exit) = (greatest(enter.to_array()), -greatest((-exit).to_array()));
        if outside != 0 || enter >= exit {
            return None;
        }
        let (first, last) = (Wide::splat(l, enter), Wide::splat(l, exit));
        let (mut entered, mut left) = (0, 0);
        for i in (0..groups.len().min(MOST)).rev() {
            entered = entered << WIDTH | first.le(enters[i]).bits();
            left = left << WIDTH | exits[i].le(last).bits();
        }
        let face = |found: u32| if found == 0 { 0 } else { found.trailing_zeros() };
        Some(Span {
            enter: ShapeHit { t: enter, face: face(entered) },
            exit: ShapeHit { t: exit, face: face(left) },
        })
    }
}

struct Second<'a> {
    groups: &'a [Group],
    p: DVec3,
}

impl Work for Second<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> f64 {
        let l = l.doubles();
        let p = Wide3::splat(l, self.p);
        let far = Wide::splat(l, f64::INFINITY);
        let (mut least, mut second) = (far, far);
        for group in self.groups {
            let depth = Wide::of(l, &group.distances) - group.dot(l, p);
            second = depth.max(least).min(second);
            least = depth.min(least);
        }
        let (mut first, mut next) = (f64::INFINITY, f64::INFINITY);
        for depth in least.to_array().into_iter().chain(second.to_array()) {
            next = next.min(depth.max(first));
            first = first.min(depth);
        }
        next
    }
}

#[inline(always)]
fn greatest([a, b, c, d]: Four) -> f64 {
    // Neither is NaN.
    let (a, c) = (if a > b { a } else { b }, if c > d { c } else { d });
    if a > c { a } else { c }
}
