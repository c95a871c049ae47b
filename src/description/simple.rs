//! The same scene without settings that change nothing, so that nothing is loaded or traced for them.

use super::{BumpMap, EnvironmentMap, Light, Material, NormalMap, Rgb, Scene, Source, Texture};
use std::borrow::Cow;

/// A sky that shines nowhere.
const NIGHT: EnvironmentMap = EnvironmentMap::Constant(Rgb::grey(0.0));

impl Scene {
    /// The scene with textures of one colour as that colour, without maps that leave the surface as it is,
    /// without what only the inside of glass has where nothing transmits, and without the image of a black sky.
    pub fn simplified(&self) -> Cow<'_, Scene> {
        let dark =
            |light: &Light| matches!(light, Light::Environment { scale: 0.0, map, .. } if *map != NIGHT);
        let simple = |m: &Material| self.simple(m);
        let plain = self.materials.iter().all(|(_, m)| simple(m) == *m)
            && !self.lights.iter().any(|(_, light)| dark(light));
        if plain {
            return Cow::Borrowed(self);
        }
        let mut scene = self.clone();
        for (_, material) in scene.materials.iter_mut() {
            *material = simple(material);
        }
        for (_, light) in scene.lights.iter_mut() {
            if let Light::Environment { scale: 0.0, map, .. } = light {
                *map = NIGHT;
            }
        }
        Cow::Owned(scene)
    }

    fn simple(&self, material: &Material) -> Material {
        let mut m = material.clone();
        for source in
            [&mut m.diffuse, &mut m.specular, &mut m.reflection, &mut m.transmission, &mut m.emission]
        {
            if let Some(colour) = self.only_colour(source) {
                *source = Source::Constant(colour);
            }
        }
        if m.transmission.is_zero() {
            (m.absorption, m.dispersion) = (Rgb::default(), None);
        }
        m.bump_map = m.bump_map.filter(|map| !self.is_level(map));
        m.normal_map = m.normal_map.filter(|map| !self.is_flat(map));
        m
    }

    /// Whether a weight is 0 everywhere, as far as the scene says.
    pub(super) fn is_zero(&self, source: &Source) -> bool {
        source.is_zero() || self.only_colour(source).is_some_and(|colour| colour.is_zero())
    }

    /// The one colour of a weight's texture, if it has one and the scene says it.
    fn only_colour(&self, source: &Source) -> Option<Rgb> {
        let texture = source.texture()?;
        if texture.scale.is_zero() {
            return Some(Rgb::default());
        }
        let colour = self.textures.get(&texture.name)?.only_colour()?;
        Some(Rgb(std::array::from_fn(|i| colour.0[i] * texture.scale.0[i])))
    }

    /// Whether a bump map has no slope.
    pub(super) fn is_level(&self, map: &BumpMap) -> bool {
        map.height_m == 0.0 || self.textures.get(&map.texture).is_some_and(|t| t.only_colour().is_some())
    }

    /// Whether a normal map turns no normal.
    pub(super) fn is_flat(&self, map: &NormalMap) -> bool {
        let upright = |c: Rgb| c.0[0] == 0.5 && c.0[1] == 0.5 && c.0[2] > 0.5;
        map.strength == 0.0
            || self.textures.get(&map.texture).and_then(Texture::only_colour).is_some_and(upright)
    }
}

impl Texture {
    /// The two colours of a pattern.
    pub(super) fn colours(&self) -> Option<(Rgb, Rgb)> {
        match self {
            Texture::Image { .. } => None,
            Texture::Checker { a, b, .. }
            | Texture::Checker3d { a, b, .. }
            | Texture::Noise { a, b, .. }
            | Texture::Marble { a, b, .. }
            | Texture::Wood { a, b, .. }
            | Texture::Brick { a, b, .. } => Some((*a, *b)),
        }
    }

    /// That of a pattern whose two are the same.
    fn only_colour(&self) -> Option<Rgb> {
        self.colours().filter(|(a, b)| a == b).map(|(a, _)| a)
    }
}

#[cfg(test)]
mod tests {
    use crate::description::{Format, Scene, Source, load_str};
    use std::path::Path;

    fn scene(materials: &str) -> Scene {
        let text = format!(
            "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), materials: {{ {materials} }}, textures: {{ \
             \"grey\": checker(a: 0.5, b: 0.5, squares: (2, 2)), \"up\": noise(a: (0.5, 0.5, 1), \
             b: (0.5, 0.5, 1), size_m: 1), \"hills\": noise(a: 0, b: 1, size_m: 1) }})"
        );
        load_str(&text, Format::Ron, Path::new(""), &[]).expect("valid").scene
    }

    #[test]
    fn what_changes_nothing_is_left_out_and_the_rest_stays() {
        let one = |material: &str| {
            let scene = scene(&format!("\"m\": ({material})"));
            scene.simplified().materials.get("m").expect("it is there").clone()
        };
        let zero = one(
            "diffuse: texture(name: \"hills\", scale: 0), transmission: texture(name: \"grey\", scale: 0), absorption: 3",
        );
        assert!(zero.diffuse.is_zero() && zero.transmission.is_zero() && zero.absorption.is_zero());
        let grey = one("reflection: texture(name: \"grey\", scale: 0.5)");
        assert_eq!(grey.reflection, Source::Constant(super::Rgb::grey(0.25)));
        let flat = one(
            "diffuse: 0.5, bump_map: (texture: \"grey\", height_m: 1), normal_map: (texture: \"up\", strength: 2)",
        );
        assert!(flat.bump_map.is_none() && flat.normal_map.is_none());
        let kept = one("diffuse: texture(\"hills\"), bump_map: (texture: \"hills\", height_m: 1), \
             normal_map: (texture: \"hills\")");
        assert!(kept.diffuse.texture().is_some() && kept.bump_map.is_some() && kept.normal_map.is_some());
        assert!(matches!(scene("\"m\": (diffuse: 0.5)").simplified(), std::borrow::Cow::Borrowed(_)));
    }
}
