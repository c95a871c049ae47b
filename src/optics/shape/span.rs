//! The part of a ray that is inside a convex solid.

use super::ShapeHit;

/// Entry and exit with the faces crossed there, `enter.t` < `exit.t`. Both are crossings of the line,
/// whose parameter may be negative.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    pub enter: ShapeHit,
    pub exit: ShapeHit,
}

impl Span {
    /// The whole line, to be clipped.
    pub const LINE: Span = Span {
        enter: ShapeHit { t: f64::NEG_INFINITY, face: 0 },
        exit: ShapeHit { t: f64::INFINITY, face: 0 },
    };

    #[inline]
    pub fn enter_at(&mut self, t: f64, face: u32) {
        if t > self.enter.t {
            self.enter = ShapeHit { t, face };
        }
    }

    #[inline]
    pub fn leave_at(&mut self, t: f64, face: u32) {
        if t < self.exit.t {
            self.exit = ShapeHit { t, face };
        }
    }

    /// Clips to the inner side of the plane n·x = h, given n·origin − h and n·dir. `None` outside.
    #[inline]
    pub fn clip(mut self, height: f64, slope: f64, face: u32) -> Option<Span> {
        if slope > 0.0 {
            self.leave_at(-height / slope, face);
        } else if slope < 0.0 {
            self.enter_at(-height / slope, face);
        } else if height > 0.0 || height.is_nan() {
            return None;
        }
        self.not_empty()
    }

    #[inline]
    pub fn not_empty(self) -> Option<Span> {
        (self.enter.t < self.exit.t).then_some(self)
    }

    #[inline]
    pub fn nearest(&self, t_min: f64, t_max: f64) -> Option<ShapeHit> {
        let ahead = |hit: &ShapeHit| t_min < hit.t && hit.t.is_finite();
        let hit = if ahead(&self.enter) { self.enter } else { self.exit };
        (ahead(&hit) && hit.t < t_max).then_some(hit)
    }
}
