//! Lights.

use super::Checker;
use crate::description::tree::{Path, number};
use crate::description::{EnvironmentMap, Light, Rgb};
use crate::math::{DAffine3, DVec3, MAX_SQUEEZE, Placement, parallelogram};

pub(super) fn check(c: &mut Checker) {
    let mut environment: Option<&str> = None;
    for (name, light) in c.scene.lights.iter() {
        let path = Path::of("lights").key(name);
        check_light(c, &path, light);
        if matches!(light, Light::Environment { .. }) {
            match environment {
                Some(first) => {
                    c.error(&path, format!("only one environment light can shine, `{first}` is one already"))
                }
                None => environment = Some(name),
            }
        }
    }
}

fn check_light(c: &mut Checker, base: &Path, light: &Light) {
    match light {
        Light::Point { intensity, falloff, .. } => {
            let path = base.key("point");
            emission(c, &path.key("intensity"), intensity);
            if let Some(terms) = falloff {
                terms.iter().enumerate().for_each(|(i, x)| c.not_negative(&path.key("falloff").index(i), *x));
                if *terms == [0.0; 3] {
                    c.error(&path.key("falloff"), "at least one term must be above 0");
                }
            }
        }
        Light::Spot { position, target, intensity, inner_deg, outer_deg } => {
            let path = base.key("spot");
            emission(c, &path.key("intensity"), intensity);
            if position == target {
                c.error_about(
                    &[&path.key("target"), &path.key("position")],
                    "the spot's target is its position",
                );
            }
            let (inner, outer) = (path.key("inner_deg"), path.key("outer_deg"));
            c.within(&inner, *inner_deg, 0.0, 180.0);
            c.within(&outer, *outer_deg, 0.0, 180.0);
            if inner_deg > outer_deg {
                let message = format!("{} is above `outer_deg`, {}", number(*inner_deg), number(*outer_deg));
                c.error_about(&[&inner, &outer], message);
            }
        }
        Light::Directional { direction, irradiance } => {
            let path = base.key("directional");
            c.direction(&path.key("direction"), *direction);
            emission(c, &path.key("irradiance"), irradiance);
        }
        Light::Sphere { radius, radiance, samples, .. } => {
            let path = base.key("sphere");
            c.positive(&path.key("radius"), *radius);
            emission(c, &path.key("radiance"), radiance);
            shadow_rays(c, &path, *samples);
        }
        Light::Quad { edge_u, edge_v, radiance, samples, .. } => {
            let path = base.key("quad");
            check_edges(c, &path, *edge_u, *edge_v);
            emission(c, &path.key("radiance"), radiance);
            shadow_rays(c, &path, *samples);
        }
        Light::Disk { normal, radius, radiance, samples, .. } => {
            let path = base.key("disk");
            c.direction(&path.key("normal"), *normal);
            c.positive(&path.key("radius"), *radius);
            emission(c, &path.key("radiance"), radiance);
            shadow_rays(c, &path, *samples);
        }
        Light::Environment { map, scale, samples, .. } => {
            let path = base.key("environment");
            c.not_negative(&path.key("scale"), *scale);
            if *scale == 0.0 {
                c.idle(&[&path.key("scale")], "this light emits nothing");
            }
            shadow_rays(c, &path, *samples);
            environment(c, &path.key("map"), map);
        }
    }
}

fn environment(c: &mut Checker, path: &Path, map: &EnvironmentMap) {
    match map {
        EnvironmentMap::Constant(rgb) => emission(c, &path.key("constant"), rgb),
        EnvironmentMap::Gradient { zenith, horizon, nadir } => {
            for (key, rgb) in [("zenith", zenith), ("horizon", horizon), ("nadir", nadir)] {
                c.colour(&path.key("gradient").key(key), rgb);
            }
            if zenith.is_zero() && horizon.is_zero() && nadir.is_zero() {
                c.idle(&[&path.key("gradient")], "this light emits nothing");
            }
        }
        EnvironmentMap::Image { .. } => {}
    }
}

/// Not negative; all zero is a warning.
fn emission(c: &mut Checker, path: &Path, rgb: &Rgb) {
    c.colour(path, rgb);
    if rgb.is_zero() {
        c.idle(&[path], "this light emits nothing");
    }
}

fn shadow_rays(c: &mut Checker, path: &Path, samples: Option<u32>) {
    if let Some(samples) = samples {
        c.within(&path.key("samples"), samples.into(), 1.0, 65536.0);
    }
}

fn check_edges(c: &mut Checker, path: &Path, edge_u: [f64; 3], edge_v: [f64; 3]) {
    let (u, v) = (path.key("edge_u"), path.key("edge_v"));
    c.direction(&u, edge_u);
    c.direction(&v, edge_v);
    if let (Some(a), Some(b)) = (DVec3::from(edge_u).try_normalize(), DVec3::from(edge_v).try_normalize())
        // the sine of the angle, which rounding makes meaningless below
        && a.cross(b).length() < 1e-12
    {
        c.error_about(&[&v, &u], "`edge_v` is parallel to `edge_u`: the quad has no area");
    } else if Placement::new(DAffine3::from_mat3(parallelogram(edge_u.into(), edge_v.into()))).is_none() {
        let message = format!(
            "a quad more than {MAX_SQUEEZE:e} times as long as wide, or whose area leaves the range of numbers, \
             cannot be placed"
        );
        c.error_about(&[&v, &u], message);
    }
}
