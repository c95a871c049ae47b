//! The camera: from a place on the film to a ray.

use crate::math::{DVec2, DVec3, Ray};

/// A perspective camera with a round thin lens; a lens of radius 0 is a pinhole.
#[derive(Clone, Debug)]
pub struct Camera {
    pub eye: DVec3,
    pub right: DVec3,
    pub up: DVec3,
    pub forward: DVec3,
    /// tan(fov / 2), vertical.
    pub tan_half: f64,
    pub lens_radius: f64,
    /// Distance of the sharp plane along `forward`.
    pub focus: f64,
    pub width: u32,
    pub height: u32,
}

impl Camera {
    /// `film` in pixels from the top left corner; `lens` on the unit disk.
    #[inline]
    pub fn ray(&self, film: DVec2, lens: DVec2) -> Ray {
        let half = f64::from(self.height) / 2.0;
        let scale = self.tan_half / half;
        let x = (film.x - f64::from(self.width) / 2.0) * scale;
        let y = (half - film.y) * scale;
        let dir = self.forward + self.right * x + self.up * y;
        if self.lens_radius == 0.0 {
            return Ray { origin: self.eye, dir: dir.normalize() };
        }
        let origin = self.eye + (self.right * lens.x + self.up * lens.y) * self.lens_radius;
        Ray { origin, dir: (self.eye + dir * self.focus - origin).normalize() }
    }

    /// Half the angle that a pixel at the centre of the film covers, radians: the spread of a ray cone.
    #[inline]
    pub fn pixel_spread(&self) -> f64 {
        self.tan_half / f64::from(self.height)
    }
}
