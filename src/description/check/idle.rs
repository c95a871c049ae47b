//! Settings of a material that change nothing: warnings.

use super::Checker;
use crate::description::tree::Path;
use crate::description::{Dispersion, Material};

pub(super) fn check(c: &mut Checker) {
    for (name, material) in c.scene.materials.iter() {
        of_material(c, &Path::of("materials").key(name), material);
    }
}

fn of_material(c: &mut Checker, path: &Path, m: &Material) {
    // Each does nothing where another is 0.
    let without_transmission = c.scene.is_zero(&m.transmission);
    for (key, given) in [
        ("ior", m.ior.is_some()),
        ("dispersion", m.dispersion.is_some()),
        ("absorption", !m.absorption.is_zero()),
        ("priority", m.priority != 0),
    ] {
        if given && without_transmission {
            needs(c, path, key, "transmission");
        }
    }
    if m.shininess.is_some() && c.scene.is_zero(&m.specular) {
        needs(c, path, "shininess", "specular");
    }
    if !without_transmission {
        dispersion(c, path, m);
    }
    maps(c, path, m);
}

/// An animation may give the other one a value at another frame: nothing is said then.
fn needs(c: &mut Checker, path: &Path, key: &str, other: &str) {
    let other_path = path.key(other);
    if c.moves(&other_path) {
        return;
    }
    let message = format!("`{key}` does nothing where `{other}` is 0");
    c.warn_about(&[&path.key(key), &other_path], message);
}

fn dispersion(c: &mut Checker, path: &Path, m: &Material) {
    let place = path.key("dispersion");
    match m.dispersion {
        Some(Dispersion::Cauchy(0.0)) => c.warn(&place.key("cauchy"), "a dispersion of 0 does nothing"),
        Some(Dispersion::Abbe(_)) if m.index() == 1.0 => c.warn_about(
            &[&place.key("abbe"), &path.key("ior")],
            "an Abbe number does nothing where `ior` is 1: it spreads `ior` − 1; `cauchy` gives the spread itself",
        ),
        _ => {}
    }
}

fn maps(c: &mut Checker, path: &Path, m: &Material) {
    if let Some(map) = m.normal_map.as_ref().filter(|map| c.scene.is_flat(map)) {
        let place = path.key("normal_map");
        match map.strength == 0.0 {
            true => c.warn(&place.key("strength"), "a normal map of strength 0 does nothing"),
            false => {
                c.warn(&place.key("texture"), "this normal map does nothing: its texture is flat everywhere");
            }
        }
    }
    if let Some(map) = m.bump_map.as_ref().filter(|map| c.scene.is_level(map)) {
        let place = path.key("bump_map");
        match map.height_m == 0.0 {
            true => c.warn(&place.key("height_m"), "a bump map of height 0 does nothing"),
            false => {
                c.warn(&place.key("texture"), "this bump map does nothing: its texture is of one colour");
            }
        }
    }
}
