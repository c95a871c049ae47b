//! Checkers in the surface's (u, v) and in space, box-filtered in closed form.
//!
//! A checker is a product of square waves; its mean over a box is the product of their means. The box
//! is the bounding box of the footprint.

use super::filter::{level, square_wave};
use super::{Colors, TexturePoint};
use crate::math::Color;
use glam::{DVec2, DVec3};

/// Squares in (u, v): that at (0, 0) to (1, 1)/`squares` is `a`.
#[derive(Clone, Debug)]
pub struct Checker {
    pub(super) colors: Colors,
    squares: DVec2,
}

impl Checker {
    /// `squares` along u and along v within [0, 1], finite.
    pub fn new(colors: Colors, squares: DVec2) -> Checker {
        Checker { colors, squares }
    }

    #[inline]
    pub(super) fn weight(&self, at: &TexturePoint) -> f64 {
        let x = at.uv * self.squares;
        let half = at.half_extent() * self.squares.abs();
        0.5 - 0.5 * square_wave(x.x, half.x) * square_wave(x.y, half.y)
    }

    /// That of a square, if the roots of `reach2` end within it.
    #[inline]
    pub(super) fn color_within(&self, uv: DVec2, reach2: DVec2) -> Option<Color> {
        let (x, half2) = (uv * self.squares, reach2 * (self.squares * self.squares));
        let (u, v) = (level(x.x, half2.x)?, level(x.y, half2.y)?);
        Some(if u == v { self.colors.a } else { self.colors.b })
    }

    pub(super) fn step(&self) -> DVec2 {
        0.01 / self.squares.abs().max(DVec2::splat(1e-9))
    }
}

/// Cubes in object space. The lattice is shifted along each axis by this share of a cube, so that
/// faces and planes at round coordinates run through cubes and not along their boundary, where
/// rounding would decide the colour.
const SHIFT: f64 = 0.381_966_011_250_105;

/// Cubes of one size in object space.
#[derive(Clone, Debug)]
pub struct Checker3d {
    pub(super) colors: Colors,
    size_m: f64,
}

impl Checker3d {
    /// `size_m` above 0.
    pub fn new(colors: Colors, size_m: f64) -> Checker3d {
        Checker3d { colors, size_m }
    }

    pub(super) fn weight(&self, at: &TexturePoint) -> f64 {
        let x = at.p / self.size_m + DVec3::splat(SHIFT);
        let half = at.radius() / self.size_m;
        0.5 - 0.5 * square_wave(x.x, half) * square_wave(x.y, half) * square_wave(x.z, half)
    }

    pub(super) fn step(&self) -> f64 {
        0.01 * self.size_m
    }
}
