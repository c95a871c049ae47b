//! The described camera becomes an orthonormal one.

use crate::description;
use crate::math::{DVec3, Frame};
use crate::optics::Camera;

/// `origin` is subtracted. An `up` along the view is replaced by any direction across it; the check
/// of the scene has said so.
pub(super) fn translate(camera: &description::Camera, image: &description::Image, origin: DVec3) -> Camera {
    let eye = DVec3::from(camera.eye);
    let view = DVec3::from(camera.target) - eye;
    let forward = view.normalize();
    let up = DVec3::from(camera.up).normalize_or_zero();
    let across = forward.cross(up);
    // Sines below this leave too few digits of the direction.
    let right = if across.length() > 1e-9 { across.normalize() } else { Frame::around(forward).s };
    Camera {
        eye: eye - origin,
        right,
        up: right.cross(forward),
        forward,
        pixel: 2.0 * libm::tan(camera.fov_deg.to_radians() / 2.0) / f64::from(image.height),
        lens_radius: camera.aperture_m / 2.0,
        focus: camera.focus_m.unwrap_or(view.length()),
        width: image.width,
        height: image.height,
    }
}
