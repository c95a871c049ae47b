//! Camera, image, antialiasing, render.

use super::Checker;
use crate::description::tree::Path;
use crate::description::{Antialiasing, Camera, Image};
use glam::DVec3;

pub(super) fn check(c: &mut Checker) {
    let scene = c.scene;
    match &scene.camera {
        Some(camera) => check_camera(c, camera),
        None => c.error(&Path::of("camera"), "a scene needs a camera: `eye` and `target`"),
    }
    let image = &scene.image;
    for (key, size) in [("image.width", image.width), ("image.height", image.height)] {
        c.within(&Path::of(key), size.into(), 1.0, Image::MAX_SIDE.into());
    }
    c.within(&Path::of("image.exposure_ev"), image.exposure_ev, -64.0, 64.0);
    if !matches!(image.png_bits, 8 | 16) {
        c.error(&Path::of("image.png_bits"), format!("{} is neither 8 nor 16", image.png_bits));
    }
    match scene.antialiasing {
        Antialiasing::Grid(n) => c.within(&Path::of("antialiasing.grid"), n.into(), 1.0, 64.0),
        Antialiasing::Adaptive { threshold, depth } => {
            c.within(&Path::of("antialiasing.adaptive.threshold"), threshold, 0.0, 1.0);
            c.within(&Path::of("antialiasing.adaptive.depth"), depth.into(), 1.0, 8.0);
        }
        Antialiasing::None | Antialiasing::Progressive => {}
    }
    if scene.render.passes == Some(0) {
        c.error(&Path::of("render.passes"), "0 passes make no image, at least 1 is needed");
    }
    for (key, value) in [("render.time_s", scene.render.time_s), ("render.error", scene.render.error)] {
        if let Some(value) = value {
            c.positive(&Path::of(key), value);
        }
    }
    c.within(&Path::of("render.max_depth"), scene.render.max_depth.into(), 1.0, 10_000.0);
    c.colour(&Path::of("background"), &scene.background);
    c.colour(&Path::of("ambient"), &scene.ambient);
}

fn check_camera(c: &mut Checker, camera: &Camera) {
    let (eye, target, up) = (Path::of("camera.eye"), Path::of("camera.target"), Path::of("camera.up"));
    let view = DVec3::from(camera.target) - DVec3::from(camera.eye);
    if camera.eye == camera.target {
        c.error_about(&[&target, &eye], "the camera's target is its eye: it looks nowhere");
    } else if camera.up == [0.0; 3] {
        c.direction(&up, camera.up);
    } else if let (Some(view), Some(turn)) = (view.try_normalize(), DVec3::from(camera.up).try_normalize()) {
        // nearer than that, rounding of eye and target decides which way is up
        if view.cross(turn).length() < 1e-9 && !c.root.find(&eye).hole && !c.root.find(&target).hole {
            c.warn(&up, "`up` is parallel to the view, another one is chosen");
        }
    }
    if !(camera.fov_deg > 0.0 && camera.fov_deg < 180.0) {
        let message = format!("{} is outside (0, 180)", crate::description::tree::number(camera.fov_deg));
        c.error(&Path::of("camera.fov_deg"), message);
    }
    c.not_negative(&Path::of("camera.aperture_m"), camera.aperture_m);
    if let Some(focus) = camera.focus_m {
        let place = Path::of("camera.focus_m");
        c.positive(&place, focus);
        if camera.aperture_m == 0.0 && focus > 0.0 {
            c.warn(
                &place,
                "`focus_m` does nothing where `aperture_m` is 0: a pinhole shows everything sharply",
            );
        }
    }
}
