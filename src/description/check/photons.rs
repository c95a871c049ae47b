//! Photons and indirect light.

use super::Checker;
use crate::description::tree::{Path, number};
use crate::description::{Indirect, Photons};

pub(super) fn check(c: &mut Checker) {
    let (key, count, k, radius) = match c.scene.photons {
        Photons::Progressive { count, k, alpha, max_radius_m, .. } => {
            if !(alpha > 0.0 && alpha < 1.0) {
                let message = format!("{} is outside (0, 1)", number(alpha));
                c.error(&Path::of("photons.progressive.alpha"), message);
            }
            ("photons.progressive", count, k, max_radius_m)
        }
        Photons::Classic { count, k, max_radius_m, .. } => {
            ("photons.classic", Some(count), Some(k), max_radius_m)
        }
        Photons::Off => return indirect(c),
    };
    let path = Path::of(key);
    if let Some(count) = count {
        c.within(&path.key("count"), count.into(), 1.0, 1e8);
    }
    if let Some(k) = k {
        c.within(&path.key("k"), k.into(), 2.0, 10_000.0);
    }
    if let Some(radius) = radius {
        c.positive(&path.key("max_radius_m"), radius);
    }
    indirect(c);
}

fn indirect(c: &mut Checker) {
    if let Indirect::Bounces(n) = c.scene.indirect {
        c.within(&Path::of("indirect"), n.into(), 1.0, 10_000.0);
    }
}
