//! Windows: the part of a lamp from which, in one direction, the targets can be met. A direction's
//! photons start within it and weigh as much less as it is smaller.

use super::balls::Round;
use super::bounds::Bound;
use super::quads::Flat;
use crate::math::doubles::{Doubles, Wide, Wide3};

/// Targets up to which their windows are worth their time.
const FEW: usize = 8;

/// Rectangles of a lamp's own parameters, for four directions.
#[derive(Clone, Copy)]
pub(super) struct Windows<L: Doubles> {
    min: [Wide<L>; 2],
    size: [Wide<L>; 2],
}

impl<L: Doubles> Windows<L> {
    /// In the square around the disk of a ball seen along `s` × `t`, its radius the unit.
    #[inline(always)]
    pub fn of_ball(l: L, targets: &[Bound], ball: &Round, s: Wide3<L>, t: Wide3<L>) -> Windows<L> {
        let whole = [-1.0, 1.0];
        let mut around = Windows::nowhere(l);
        for target in few(targets) {
            let to = (target.center - ball.center) * ball.inverse_radius;
            let half = target.radius * ball.inverse_radius;
            if !(to.is_finite() && half.is_finite()) {
                return Windows::everywhere(l, whole);
            }
            let (to, half) = (Wide3::splat(l, to), Wide::splat(l, half));
            around = around.with([to.dot(s), to.dot(t)], [half, half]);
        }
        around.within(l, targets, whole)
    }

    /// In the parameters [0, 1]² of a parallelogram seen along `dir`.
    #[inline(always)]
    pub fn of_parallelogram(l: L, targets: &[Bound], flat: &Flat, dir: Wide3<L>) -> Windows<L> {
        let whole = [0.0, 1.0];
        let mut around = Windows::nowhere(l);
        // Vectors whose products with a point of the plane are its parameters, sheared along `dir` so
        // that they give those of the point of the plane on the same line.
        let n = Wide3::splat(l, flat.across);
        let (u, v) = (Wide3::splat(l, flat.duals[0]), Wide3::splat(l, flat.duals[1]));
        let slope = n.dot(dir);
        let (u, v) = (u - n * (u.dot(dir) / slope), v - n * (v.dot(dir) / slope));
        let extents = [u.length_squared().sqrt(), v.length_squared().sqrt()];
        for target in few(targets) {
            let to = target.center - flat.corner;
            if !(to.is_finite() && target.radius.is_finite()) {
                return Windows::everywhere(l, whole);
            }
            let (to, radius) = (Wide3::splat(l, to), Wide::splat(l, target.radius));
            around = around.with([u.dot(to), v.dot(to)], [extents[0] * radius, extents[1] * radius]);
        }
        around.within(l, targets, whole)
    }

    #[inline(always)]
    fn nowhere(l: L) -> Windows<L> {
        let (least, most) = (Wide::splat(l, f64::NEG_INFINITY), Wide::splat(l, f64::INFINITY));
        Windows { min: [most; 2], size: [least; 2] }
    }

    #[inline(always)]
    fn everywhere(l: L, whole: [f64; 2]) -> Windows<L> {
        Windows { min: [Wide::splat(l, whole[0]); 2], size: [Wide::splat(l, whole[1] - whole[0]); 2] }
    }

    /// Around a shadow as well, its centre and half extents; `size` is the far corner until it is all.
    #[inline(always)]
    fn with(self, center: [Wide<L>; 2], half: [Wide<L>; 2]) -> Windows<L> {
        let [x, y] = center;
        // What is not a number comes of directions in the lamp's own plane, in which it sends nothing.
        Windows {
            min: [(x - half[0]).min(self.min[0]), (y - half[1]).min(self.min[1])],
            size: [(x + half[0]).max(self.size[0]), (y + half[1]).max(self.size[1])],
        }
    }

    /// All of it that is within `whole`, and `whole` where there are too many targets.
    #[inline(always)]
    fn within(self, l: L, targets: &[Bound], whole: [f64; 2]) -> Windows<L> {
        if targets.len() > FEW {
            return Windows::everywhere(l, whole);
        }
        let (lo, hi) = (Wide::splat(l, whole[0]), Wide::splat(l, whole[1]));
        let min = [self.min[0].max(lo), self.min[1].max(lo)];
        Windows { min, size: [self.size[0].min(hi) - min[0], self.size[1].min(hi) - min[1]] }
    }

    /// Which of them there are, one bit each.
    #[inline(always)]
    pub fn bits(&self, l: L) -> u32 {
        let zero = Wide::splat(l, 0.0);
        zero.lt(self.size[0]).bits() & zero.lt(self.size[1]).bits()
    }

    #[inline(always)]
    pub fn at(&self, u: [Wide<L>; 2]) -> [Wide<L>; 2] {
        [self.min[0] + self.size[0] * u[0], self.min[1] + self.size[1] * u[1]]
    }

    #[inline(always)]
    pub fn area(&self) -> Wide<L> {
        self.size[0] * self.size[1]
    }
}

fn few(targets: &[Bound]) -> &[Bound] {
    if targets.len() > FEW { &[] } else { targets }
}
