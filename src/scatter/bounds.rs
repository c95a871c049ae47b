//! Convex bounds of what photons are aimed at and of what they start from, and the question that the
//! projection map asks of them: can a ray go from one to the other?
//!
//! Every answer "no" is a plane that separates them, so that rounding aside no such ray exists; "yes"
//! may be wrong, which costs wasted photons and no light.

use crate::math::sampling::SphericalCell;
use crate::math::{Aabb, DVec3, Ray};

/// A box and a ball around the same thing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bound {
    pub min: DVec3,
    pub max: DVec3,
    pub center: DVec3,
    pub radius: f64,
}

/// By how much of their size bounds are widened, against the rounding of whoever asks.
const SLACK: f64 = 1e-9;

impl Bound {
    /// Around an axis-aligned box.
    pub fn of_box(min: DVec3, max: DVec3) -> Bound {
        let center = 0.5 * min + 0.5 * max;
        Bound { min, max, center, radius: 0.5 * (max - min).length() }.widened()
    }

    pub fn of_aabb(aabb: &Aabb) -> Bound {
        Bound::of_box(aabb.min.as_dvec3(), aabb.max.as_dvec3())
    }

    pub fn of_point(p: DVec3) -> Bound {
        Bound { min: p, max: p, center: p, radius: 0.0 }
    }

    /// The same box with a ball that is known to hold the thing, if it is smaller.
    pub fn with_ball(self, center: DVec3, radius: f64) -> Bound {
        if radius < self.radius { Bound { center, radius, ..self }.widened() } else { self }
    }

    pub fn union(&self, other: &Bound) -> Bound {
        let both = Bound::of_box(self.min.min(other.min), self.max.max(other.max));
        // The ball around both balls.
        let between = other.center - self.center;
        let distance = between.length();
        let radius = (0.5 * (distance + self.radius + other.radius)).max(self.radius).max(other.radius);
        let along = if distance > 0.0 { (radius - self.radius) / distance } else { 0.0 };
        both.with_ball(self.center + between * along.clamp(0.0, 1.0), radius)
    }

    fn widened(self) -> Bound {
        let by = SLACK * (self.radius + (self.max - self.min).length());
        Bound { min: self.min - by, max: self.max + by, radius: self.radius + by, ..self }
    }

    /// An upper bound on n·x.
    pub fn most(&self, n: DVec3) -> f64 {
        let middle = 0.5 * self.min + 0.5 * self.max;
        let half = 0.5 * (self.max - self.min);
        (n.dot(middle) + n.abs().dot(half)).min(n.dot(self.center) + n.length() * self.radius)
    }

    /// A lower bound on n·x.
    pub fn least(&self, n: DVec3) -> f64 {
        -self.most(-n)
    }

    /// Whether a ray, its direction of unit length, may meet the thing.
    #[inline]
    pub fn may_meet(&self, ray: &Ray) -> bool {
        let to = self.center - ray.origin;
        let along = to.dot(ray.dir);
        // The line's distance from the centre by a vector, which loses nothing however far the ray begins.
        let apart = (to - ray.dir * along).length_squared();
        let room = self.radius + 16.0 * f64::EPSILON * to.abs().element_sum();
        if apart > room * room || along < -room {
            return false;
        }
        // From outside of the ball, the box around it leaves out next to nothing of what meets the ball ahead.
        let ahead = along >= 0.0 || to.length_squared() <= room * room;
        if ahead && (self.max - self.min).min_element() >= (2.0 - SLACK) * self.radius {
            return true;
        }
        // Beside the box along some axis; where the ray is parallel to its faces both are infinite or one is NaN.
        let (a, b) = ((self.min - ray.origin) / ray.dir, (self.max - ray.origin) / ray.dir);
        let (mut near, mut far) = (0.0f64, f64::INFINITY);
        for axis in 0..3 {
            near = near.max(a[axis].min(b[axis]));
            far = far.min(a[axis].max(b[axis]));
        }
        near <= far * (1.0 + 1e-9)
    }

    pub fn overlaps(&self, other: &Bound) -> bool {
        let apart = self.center.distance(other.center) > self.radius + other.radius;
        !apart && self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }
}

/// A cell of directions with what the tests need of it.
pub(super) struct Beam {
    pub cell: SphericalCell,
    planes: [DVec3; 3],
    axis: DVec3,
    cos: f64,
    sin: f64,
}

/// How a target lies in the beams that leave a source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reach {
    Missed,
    /// Some of the beam may miss it, and smaller beams would tell.
    Partly,
    /// Some may miss it, but the beam is small beside it.
    Met,
    /// All of it is aimed at it.
    Whole,
}

/// A beam is not divided any more when its radius is less than this share of its target's.
const FINEST: f64 = 1.0 / 6.0;

impl Beam {
    pub fn new(cell: SphericalCell) -> Beam {
        let (axis, cos) = cell.cone();
        Beam { cell, planes: cell.planes(), axis, cos, sin: (1.0 - cos * cos).max(0.0).sqrt() }
    }

    /// Whether rays from `source` with directions in the beam can meet `target`.
    pub fn reach(&self, source: &Bound, target: &Bound) -> Reach {
        // All x = s + t·d of the beam have n·x ≥ n·s where n·d ≥ 0 for all its directions d.
        let separates = |n: DVec3| target.most(n) < source.least(n);
        if self.planes.iter().any(|&n| separates(n)) {
            return Reach::Missed;
        }
        let corners = self.cell.corners();
        let ahead = |n: DVec3| corners.iter().all(|c| n.dot(*c) >= 0.0);
        if DVec3::AXES.iter().any(|&n| (ahead(n) && separates(n)) || (ahead(-n) && separates(-n))) {
            return Reach::Missed;
        }
        let between = target.center - source.center;
        let distance = between.length();
        let sin = (target.radius + source.radius) / distance;
        if sin.is_nan() || sin >= 1.0 {
            return Reach::Whole;
        }
        self.overlap(between / distance, ((1.0 - sin) * (1.0 + sin)).sqrt())
    }

    /// How the beam lies to the cone around the unit vector `axis` of the half-angle θ.
    pub fn overlap(&self, axis: DVec3, cos: f64) -> Reach {
        let sin = ((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt();
        let towards = self.axis.dot(axis);
        // θ + α reaches all around where cosθ < −cosα; else compared with its cosine, widened for rounding.
        if cos > -self.cos && towards < self.cos * cos - self.sin * sin - 1e-12 {
            return Reach::Missed;
        }
        // Within the cone even at the beam's edge: θ > α and towards ≥ cos(θ − α).
        if cos < self.cos && towards >= self.cos * cos + self.sin * sin {
            return Reach::Whole;
        }
        if cos < 0.0 || self.sin < FINEST * sin { Reach::Met } else { Reach::Partly }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::{Counter, Stage};
    use crate::math::robust;

    #[test]
    fn no_ray_reaches_a_target_that_its_beam_is_said_to_miss() {
        let mut random = Counter::new(1, Stage::Test, 0);
        let (mut missed, mut rays) = (0, 0);
        for _ in 0..3000 {
            let mut point = |size: f64| {
                DVec3::new(random.value() - 0.5, random.value() - 0.5, random.value() - 0.5) * size
            };
            let [a, b, c, d] = [point(8.0), point(2.0), point(8.0), point(3.0)];
            let source = Bound::of_box(a.min(a + b), a.max(a + b));
            let target = Bound::of_box(c.min(c + d), c.max(c + d));
            let ball = Bound::of_box(target.min, target.max).with_ball(target.center, 0.3);
            let mut cell = SphericalCell::icosahedron()[(random.value() * 20.0) as usize];
            for _ in 0..(random.value() * 8.0) as usize {
                cell = cell.halves()[usize::from(random.value() < 0.5)];
            }
            let beam = Beam::new(cell);
            for (target, round) in [(target, false), (ball, true)] {
                if beam.reach(&source, &target) != Reach::Missed {
                    continue;
                }
                missed += 1;
                for _ in 0..20 {
                    let share = DVec3::new(random.value(), random.value(), random.value());
                    let ray = Ray {
                        origin: source.min + (source.max - source.min) * share,
                        dir: cell.sample(random.pair()),
                    };
                    rays += 1;
                    let hit = if round {
                        robust::sphere_roots(ray.origin - target.center, ray.dir, 0.3)
                            .is_some_and(|r| r[1] > 0.0)
                    } else {
                        slabs(&ray, target.min, target.max)
                    };
                    assert!(!hit);
                }
            }
        }
        assert!(missed > 1000 && rays > 20_000, "{missed}");
    }

    /// Rays at points of box and ball, from near and far, along axes too: none of them is said to miss; and
    /// most of those that are aimed beside them are.
    #[test]
    fn rays_that_meet_a_bound_are_never_left_out() {
        let mut random = Counter::new(2, Stage::Test, 0);
        let mut culled = 0;
        for round in 0..40_000 {
            let mut vector = || DVec3::from([(); 3].map(|()| random.value() - 0.5));
            let (corner, size, from, aim) = (vector(), vector().abs(), vector(), vector());
            let bound = Bound::of_box(corner, corner + size).with_ball(corner + 0.5 * size, 0.35);
            let inside = corner + size * (aim + 0.5);
            let away = [1.0, 1e3, 1e7][round % 3] * from;
            let axis = DVec3::AXES[round % 3] * if round % 2 == 0 { 1.0 } else { -1.0 };
            let ray = if round % 5 == 0 {
                Ray { origin: inside - axis * (4.0 + away.x.abs()), dir: axis }
            } else {
                Ray { origin: inside + away, dir: -away.normalize() }
            };
            let in_ball = inside.distance(bound.center) < 0.35;
            assert!(!in_ball || bound.may_meet(&ray), "{bound:?} {ray:?}");
            let beside = Ray { origin: from * 3.0, dir: aim.normalize() };
            culled += u32::from(!bound.may_meet(&beside));
        }
        assert!(culled > 20_000, "{culled}");
    }

    /// As from a lamp that touches a ball of glass.
    #[test]
    fn what_goes_away_from_a_ball_is_left_out_from_the_first_step() {
        let mut random = Counter::new(3, Stage::Test, 0);
        let ball = Bound::of_box(DVec3::NEG_ONE, DVec3::ONE).with_ball(DVec3::ZERO, 1.0);
        for round in 0..10_000 {
            let mut vector = || DVec3::from([(); 3].map(|()| random.value() - 0.5));
            let axis = DVec3::AXES[round % 3] * if round % 2 == 0 { 1.0 } else { -1.0 };
            let (beside, dir) = (vector(), vector().normalize());
            let origin = axis * (1.0 + 1e-6 + beside.x.abs()) + (beside - axis * beside.dot(axis));
            let away = if dir.dot(axis) < 0.0 { -dir } else { dir };
            assert!(!ball.may_meet(&Ray { origin, dir: away }), "{origin} {away}");
            let at = beside - origin;
            assert!(ball.may_meet(&Ray { origin, dir: at.normalize() }), "{origin} {at}");
        }
    }

    fn slabs(ray: &Ray, min: DVec3, max: DVec3) -> bool {
        let (a, b) = ((min - ray.origin) / ray.dir, (max - ray.origin) / ray.dir);
        let (near, far) = (a.min(b).max_element(), a.max(b).min_element());
        near < far && far > 0.0
    }
}
