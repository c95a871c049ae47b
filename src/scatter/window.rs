//! Windows: the part of a lamp from which, in one direction, the targets can be met. A direction's
//! photons start within it and weigh as much less as it is smaller.

use super::bounds::Bound;
use super::source::Round;
use crate::math::{DVec2, DVec3, Frame};

/// Targets up to which their windows are worth their time.
const FEW: usize = 8;

/// A rectangle of a lamp's own parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Window {
    pub min: DVec2,
    pub size: DVec2,
}

impl Window {
    /// Around the shadows of the targets, each a centre and half extents, and within `whole`. `None`
    /// where they do not overlap it.
    fn around(whole: [DVec2; 2], shadows: impl Iterator<Item = (DVec2, DVec2)>) -> Option<Window> {
        let (mut min, mut max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for (center, half) in shadows {
            if !(center.is_finite() && half.is_finite()) {
                (min, max) = (whole[0], whole[1]);
                break;
            }
            (min, max) = (min.min(center - half), max.max(center + half));
        }
        let (min, max) = (min.max(whole[0]), max.min(whole[1]));
        min.cmplt(max).all().then(|| Window { min, size: max - min })
    }

    /// In the square around the disk of a ball seen along `frame.n`, its radius the unit.
    pub fn of_ball(targets: &[Bound], ball: &Round, frame: &Frame) -> Option<Window> {
        let whole = [DVec2::NEG_ONE, DVec2::ONE];
        if targets.len() > FEW {
            return Some(Window { min: whole[0], size: whole[1] - whole[0] });
        }
        let shadow = |target: &Bound| {
            let to = (target.center - ball.center) * ball.inverse_radius;
            (DVec2::new(to.dot(frame.s), to.dot(frame.t)), DVec2::splat(target.radius * ball.inverse_radius))
        };
        Window::around(whole, targets.iter().map(shadow))
    }

    /// In the parameters [0, 1]² of the parallelogram from `corner` along `edges`, seen along `dir`.
    pub fn of_parallelogram(
        targets: &[Bound],
        corner: DVec3,
        edges: [DVec3; 2],
        dir: DVec3,
    ) -> Option<Window> {
        let whole = [DVec2::ZERO, DVec2::ONE];
        if targets.len() > FEW {
            return Some(Window { min: whole[0], size: whole[1] });
        }
        let n = edges[0].cross(edges[1]);
        // Vectors whose products with a point of the plane are its parameters, sheared along `dir` so
        // that they give those of the point of the plane on the same line.
        let duals = [edges[1].cross(n), n.cross(edges[0])].map(|dual| {
            let dual = dual / n.length_squared();
            dual - n * (dual.dot(dir) / n.dot(dir))
        });
        let extents = DVec2::new(duals[0].length(), duals[1].length());
        let shadow = |target: &Bound| {
            let to = target.center - corner;
            (DVec2::new(duals[0].dot(to), duals[1].dot(to)), extents * target.radius)
        };
        Window::around(whole, targets.iter().map(shadow))
    }

    pub fn at(&self, u: [f64; 2]) -> DVec2 {
        self.min + self.size * DVec2::from(u)
    }

    pub fn area(&self) -> f64 {
        self.size.x * self.size.y
    }
}
