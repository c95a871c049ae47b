//! Materials and textures.

use super::{Checker, energy};
use crate::description::suggest::{listed, question};
use crate::description::tree::{Path, number};
use crate::description::{Dispersion, Ior, Material, NAMED_IOR, Source, Texture, TextureRef};

pub(super) fn check(c: &mut Checker) {
    for (name, material) in c.scene.materials.iter() {
        check_material(c, &Path::of("materials").key(name), material);
    }
}

fn check_material(c: &mut Checker, path: &Path, material: &Material) {
    let weights = [
        ("diffuse", &material.diffuse),
        ("specular", &material.specular),
        ("reflection", &material.reflection),
        ("transmission", &material.transmission),
    ];
    for (key, source) in weights {
        weight(c, &path.key(key), source);
    }
    match &material.emission {
        Source::Constant(rgb) => c.colour(&path.key("emission"), rgb),
        Source::Texture(texture) => {
            c.colour(&path.key("emission").key("texture").key("scale"), &texture.scale)
        }
    }
    if let Some(shininess) = material.shininess {
        c.within(&path.key("shininess"), shininess, 1.0, 1e6);
    }
    match &material.ior {
        Some(Ior::Number(ior)) if !(*ior > 0.05 && *ior < 10.0) => {
            c.error(&path.key("ior"), format!("{} is outside (0.05, 10)", number(*ior)));
        }
        Some(Ior::Name(name)) if !NAMED_IOR.iter().any(|(known, _)| known == name) => {
            let names = || NAMED_IOR.iter().map(|(known, _)| *known);
            let message = format!("no index of refraction is named `{name}`{}", question(name, names()));
            let help = Some(format!("known: {}", listed(names())));
            c.report(super::Severity::Error, super::Kind::Invalid, &[&path.key("ior")], message, help);
        }
        _ => {}
    }
    match material.dispersion {
        Some(Dispersion::Abbe(v)) => c.within(&path.key("dispersion").key("abbe"), v, 5.0, 200.0),
        Some(Dispersion::Cauchy(b)) => {
            let place = path.key("dispersion").key("cauchy");
            c.within(&place, b, 0.0, 0.1);
        }
        None => {}
    }
    c.colour(&path.key("absorption"), &material.absorption);
    if let Some(map) = &material.normal_map {
        let place = path.key("normal_map").key("strength");
        c.within(&place, map.strength, 0.0, 10.0);
    }
    energy::check(c, path, material);
}

/// A share of light: constants in [0, 1]; a pattern whose colours are known must keep to it too.
fn weight(c: &mut Checker, path: &Path, source: &Source) {
    match source {
        Source::Constant(rgb) => {
            if let Some(x) = rgb.0.iter().find(|x| !(0.0..=1.0).contains(*x)) {
                c.error(path, format!("{} is outside [0, 1]", number(*x)));
            }
        }
        Source::Texture(texture) => {
            let scale = path.key("texture").key("scale");
            c.colour(&scale, &texture.scale);
            let brightest = brightest(c, texture);
            if brightest > 1.0 && texture.scale.0.iter().all(|s| *s >= 0.0) {
                let message =
                    format!("the texture `{}` reaches {} here, above 1", texture.name, number(brightest));
                c.error_about(&[path, &Path::of("textures").key(&texture.name)], message);
            }
        }
    }
}

/// The largest value of a pattern, 0 for images.
fn brightest(c: &Checker, reference: &TextureRef) -> f64 {
    match c.scene.textures.get(&reference.name).and_then(Texture::colours) {
        Some((a, b)) => (0..3).map(|i| a.0[i].max(b.0[i]) * reference.scale.0[i]).fold(0.0, f64::max),
        None => 0.0,
    }
}

pub(super) fn textures(c: &mut Checker) {
    for (name, texture) in c.scene.textures.iter() {
        let base = Path::of("textures").key(name);
        let at = |tag: &str, key: &str| base.key(tag).key(key);
        let tag = match texture {
            Texture::Image { uv, .. } => {
                if uv.scale.contains(&0.0) {
                    c.error(&at("image", "uv").key("scale"), "a scale of 0 leaves nothing of the image");
                }
                "image"
            }
            Texture::Checker { squares, .. } => {
                squares
                    .iter()
                    .enumerate()
                    .for_each(|(i, n)| c.positive(&at("checker", "squares").index(i), *n));
                "checker"
            }
            Texture::Checker3d { size_m, .. } => {
                c.positive(&at("checker3d", "size_m"), *size_m);
                "checker3d"
            }
            Texture::Noise { size_m, octaves, .. } => {
                c.positive(&at("noise", "size_m"), *size_m);
                c.within(&at("noise", "octaves"), (*octaves).into(), 1.0, 16.0);
                "noise"
            }
            Texture::Marble { size_m, octaves, .. } => {
                c.positive(&at("marble", "size_m"), *size_m);
                c.within(&at("marble", "octaves"), (*octaves).into(), 1.0, 16.0);
                "marble"
            }
            Texture::Wood { ring_m, .. } => {
                c.positive(&at("wood", "ring_m"), *ring_m);
                "wood"
            }
            Texture::Brick { bricks, mortar, .. } => {
                bricks.iter().enumerate().for_each(|(i, n)| c.positive(&at("brick", "bricks").index(i), *n));
                c.within(&at("brick", "mortar"), *mortar, 0.0, 0.5);
                "brick"
            }
        };
        if let Some((a, b)) = texture.colours() {
            c.colour(&at(tag, "a"), &a);
            c.colour(&at(tag, "b"), &b);
        }
    }
}
