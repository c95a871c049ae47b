//! How wide a ray has become: a cone around it, and the ellipse in which it meets a surface.
//!
//! Akenine-Möller, Crassin, Boksansky, Belcour, Panteleev, Wright: Improved Shader and Texture Level
//! of Detail Using Ray Cones, JCGT 10(1), 2021.

use super::Surface;
use crate::math::{DVec2, DVec3};
use crate::optics::{Coordinates, TexturePoint};

/// A cone around a ray: radius in metres where it starts, and growth in metres a metre.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    pub width: f64,
    pub spread: f64,
}

impl Cone {
    /// The cone that goes on after `t` metres, from a flat mirror.
    #[inline]
    pub fn after(self, t: f64) -> Cone {
        Cone { width: self.width + self.spread * t, ..self }
    }

    /// Behind an interface angles shrink by `eta`, for small ones.
    #[inline]
    pub fn refracted(self, eta: f64) -> Cone {
        Cone { spread: self.spread / eta, ..self }
    }
}

/// What is seen under a flatter angle counts as seen under this one.
const LEAST_COS: f64 = 1e-4;

/// Bounds on the squares of how far the cone reaches along u and v: its longest way on the surface, were it the
/// steepest one of either. Without roots, and with a single division. May be NaN.
#[inline]
pub fn squared_reach(surface: &Surface, coordinates: &Coordinates, wo: DVec3, cone: &Cone) -> DVec2 {
    let (radius, cos) = (cone.width + cone.spread * surface.t, wo.dot(surface.ng).abs().max(LEAST_COS));
    let (u, v) = (coordinates.dpdu, coordinates.dpdv);
    let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
    // The longest way is radius/cos; |∇u|² = vv/det, |∇v|² = uu/det.
    let det = uu * vv - uv * uv;
    DVec2::new(vv, uu) * (radius * radius * (1.0 + 1e-9) / (det * (cos * cos)))
}

/// The point of a surface for texture lookups, with the ellipse in which the cone meets it; `scale` is
/// that of the surface's placement.
#[inline]
pub fn texture_point(
    surface: &Surface,
    coordinates: &Coordinates,
    scale: f64,
    wo: DVec3,
    cone: &Cone,
) -> TexturePoint {
    let radius = cone.width + cone.spread * surface.t;
    let n = surface.ng;
    let height = wo.dot(n);
    let along = wo - n * height;
    let sin2 = along.length_squared();
    let axes = if sin2 > 1e-12 {
        // The roots and divisions wait for nothing but their own arguments.
        let (sin, longer) = (sin2.sqrt(), radius / height.abs().max(LEAST_COS));
        let inverse = 1.0 / sin;
        [along * (longer * inverse), n.cross(along) * (radius * inverse)]
    } else {
        let minor = coordinates.dpdu.try_normalize().unwrap_or(DVec3::ZERO) * radius;
        [n.cross(minor), minor]
    };
    TexturePoint { uv: coordinates.uv, duv: in_uv(coordinates, axes), p: surface.local, dp: radius / scale }
}

/// The (u, v) steps of steps on the surface: least squares in the plane of ∂p/∂u and ∂p/∂v.
#[inline]
fn in_uv(coordinates: &Coordinates, steps: [DVec3; 2]) -> [DVec2; 2] {
    let (u, v) = (coordinates.dpdu, coordinates.dpdv);
    let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
    let det = uu * vv - uv * uv;
    if det.is_nan() || det <= 1e-12 * uu * vv {
        return [DVec2::ZERO; 2];
    }
    let inverse = 1.0 / det;
    let in_uv = |step: DVec3| {
        let (su, sv) = (step.dot(u), step.dot(v));
        DVec2::new(vv * su - uv * sv, uu * sv - uv * su) * inverse
    };
    [in_uv(steps[0]), in_uv(steps[1])]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::sights::tests::few_objects;
    use crate::math::Ray;
    use crate::math::random::{Counter, Stage};

    /// No footprint reaches farther along u or v than its bound, on every shape and under every angle.
    #[test]
    fn footprints_end_within_their_reach() {
        let (world, mut random) = (few_objects(), Counter::new(3, Stage::Test, 0));
        let mut known = 0;
        for _ in 0..5_000 {
            let aim = DVec3::from([(); 3].map(|()| 4.0 * random.value() - 2.0));
            let ray = Ray { origin: world.camera.eye, dir: (aim - world.camera.eye).normalize() };
            let Some(hit) = world.nearest(&ray, f64::INFINITY) else { continue };
            let (surface, cone) = (world.surface(&ray, &hit), Cone { width: 0.01, spread: random.value() });
            let coordinates = world.coordinates(&surface);
            let reach2 = squared_reach(&surface, &coordinates, -ray.dir, &cone);
            let [a, b] = texture_point(&surface, &coordinates, 1.0, -ray.dir, &cone).duv;
            let extent2 = a * a + b * b;
            assert!(!extent2.cmpgt(reach2).any(), "{extent2} beyond {reach2}: {surface:?}");
            known += u32::from(reach2.is_finite());
        }
        assert!(known > 1_000, "{known}");
    }
}
