//! The camera: from a place on the film to a ray.

use crate::math::{DVec2, DVec3, Ray};

/// A perspective camera with a round thin lens; a lens of radius 0 is a pinhole.
#[derive(Clone, Debug)]
pub struct Camera {
    pub eye: DVec3,
    pub right: DVec3,
    pub up: DVec3,
    pub forward: DVec3,
    /// Side of a pixel on a film at distance 1: 2·tan(fov / 2) over the height, the angle being the vertical one.
    pub pixel: f64,
    pub lens_radius: f64,
    /// Distance of the sharp plane along `forward`.
    pub focus: f64,
    pub width: u32,
    pub height: u32,
}

impl Camera {
    /// From the middle of the lens to the place `film`, in pixels from the top left corner, on the film before it.
    #[inline]
    fn towards(&self, film: DVec2) -> DVec3 {
        let x = (film.x - 0.5 * f64::from(self.width)) * self.pixel;
        let y = (0.5 * f64::from(self.height) - film.y) * self.pixel;
        self.forward + self.right * x + self.up * y
    }

    /// From the middle of the lens through `film`, in pixels from the top left corner.
    #[inline]
    pub fn ray(&self, film: DVec2) -> Ray {
        Ray { origin: self.eye, dir: self.towards(film).normalize() }
    }

    /// The same from a place `lens` of the unit disk.
    #[inline(never)]
    pub fn ray_through_lens(&self, film: DVec2, lens: DVec2) -> Ray {
        let dir = self.towards(film);
        let origin = self.eye + (self.right * lens.x + self.up * lens.y) * self.lens_radius;
        Ray { origin, dir: (self.eye + dir * self.focus - origin).normalize() }
    }

    /// Half the angle, radians, that a pixel covers where it is seen in the unit direction `dir`: the spread of a
    /// ray cone. Off the axis a pixel is cosθ as wide, and cos²θ as wide along the radius; the former is taken.
    #[inline]
    pub fn pixel_spread(&self, dir: DVec3) -> f64 {
        0.5 * self.pixel * self.forward.dot(dir)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Beside each other across the radius, rays of neighbouring pixels are two spreads apart.
    #[test]
    fn pixels_off_the_axis_cover_less() {
        let camera = Camera {
            eye: DVec3::ZERO,
            right: DVec3::X,
            up: DVec3::Y,
            forward: DVec3::NEG_Z,
            pixel: 0.01,
            lens_radius: 0.0,
            focus: 1.0,
            width: 400,
            height: 400,
        };
        for x in [200.0, 300.0, 400.0] {
            let [above, here, below] = [-0.5, 0.0, 0.5].map(|dy| camera.ray(DVec2::new(x, 200.0 + dy)).dir);
            let apart = above.angle_between(below);
            let spread = camera.pixel_spread(here);
            assert!((2.0 * spread / apart - 1.0).abs() < 1e-4, "{x}: {spread} and {apart}");
        }
    }
}
