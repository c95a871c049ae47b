//! The effects that a render is made of, in the order of the pipeline.
//!
//! Some *carry* light: left out, their light is missing and nothing else changes. The others *shape* the
//! light that those carry.

use crate::description::question;
use serde::{Serialize, Serializer};
use std::fmt;
use std::str::FromStr;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Effect {
    /// Lamps and emitting objects that light matt surfaces.
    Direct,
    Shadows,
    SoftShadows,
    /// Of mirrors and at interfaces.
    Reflection,
    Refraction,
    NestedMedia,
    Absorption,
    Dispersion,
    /// Phong lobes of lamps.
    Highlights,
    Textures,
    NormalMaps,
    BumpMaps,
    Caustics,
    Indirect,
    DepthOfField,
    /// The sky: its light, and the sight of it.
    Environment,
    Antialiasing,
}

impl Effect {
    pub const ALL: [Effect; 17] = [
        Effect::Direct,
        Effect::Shadows,
        Effect::SoftShadows,
        Effect::Reflection,
        Effect::Refraction,
        Effect::NestedMedia,
        Effect::Absorption,
        Effect::Dispersion,
        Effect::Highlights,
        Effect::Textures,
        Effect::NormalMaps,
        Effect::BumpMaps,
        Effect::Caustics,
        Effect::Indirect,
        Effect::DepthOfField,
        Effect::Environment,
        Effect::Antialiasing,
    ];

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Effect::Direct => "direct",
            Effect::Shadows => "shadows",
            Effect::SoftShadows => "soft shadows",
            Effect::Reflection => "reflection",
            Effect::Refraction => "refraction",
            Effect::NestedMedia => "nested media",
            Effect::Absorption => "absorption",
            Effect::Dispersion => "dispersion",
            Effect::Highlights => "highlights",
            Effect::Textures => "textures",
            Effect::NormalMaps => "normal maps",
            Effect::BumpMaps => "bump maps",
            Effect::Caustics => "caustics",
            Effect::Indirect => "indirect",
            Effect::DepthOfField => "depth of field",
            Effect::Environment => "environment",
            Effect::Antialiasing => "antialiasing",
        }
    }

    /// On the command line and in JSON: the name with `_` for spaces.
    pub fn key(self) -> &'static str {
        match self {
            Effect::SoftShadows => "soft_shadows",
            Effect::NestedMedia => "nested_media",
            Effect::NormalMaps => "normal_maps",
            Effect::BumpMaps => "bump_maps",
            Effect::DepthOfField => "depth_of_field",
            other => other.name(),
        }
    }

    /// Whether it brings light of its own into the image.
    pub fn carries_light(self) -> bool {
        matches!(
            self,
            Effect::Direct
                | Effect::Reflection
                | Effect::Refraction
                | Effect::Highlights
                | Effect::Caustics
                | Effect::Indirect
                | Effect::Environment
        )
    }

    /// What a scene has to have for it.
    pub(super) fn needs(self) -> &'static str {
        match self {
            Effect::Direct | Effect::Shadows => "a light, or an object whose material has `emission`",
            Effect::SoftShadows => "a light with an extent: sphere, quad, disk or environment",
            Effect::Reflection => "an object whose material has `reflection` or `transmission`",
            Effect::Refraction => "an object whose material has `transmission`",
            Effect::NestedMedia => "two objects whose materials have `transmission`",
            Effect::Absorption => "an object whose material has `absorption` and `transmission`",
            Effect::Dispersion => "an object whose material has `dispersion` and `transmission`",
            Effect::Highlights => "a light and an object whose material has `specular`",
            Effect::Textures => "an object whose material names a texture",
            Effect::NormalMaps => "an object whose material has `normal_map`",
            Effect::BumpMaps => "an object whose material has `bump_map`",
            Effect::Caustics => "a light, a mirror or glass, and a surface that is neither",
            Effect::Indirect => "`indirect`",
            Effect::DepthOfField => "`camera.aperture_m`",
            Effect::Environment => "an environment light",
            Effect::Antialiasing => "`antialiasing` other than `none`",
        }
    }
}

impl fmt::Display for Effect {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Effect {
    type Err = String;

    fn from_str(key: &str) -> Result<Effect, String> {
        let folded = key.trim().to_lowercase().replace(['-', ' '], "_");
        Effect::ALL.into_iter().find(|effect| effect.key() == folded).ok_or_else(|| {
            // no option takes it
            let all: Vec<&str> =
                Effect::ALL.into_iter().filter(|e| *e != Effect::NestedMedia).map(Effect::key).collect();
            let near = question(&folded, all.iter().copied());
            format!("no effect is named `{key}`{near}; all are: {}", all.join(", "))
        })
    }
}

impl Serialize for Effect {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.key())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_is_read_back_and_a_slip_is_answered_with_the_nearest() {
        for effect in Effect::ALL {
            assert_eq!(effect.key().parse(), Ok(effect));
            assert_eq!(effect.name().parse(), Ok(effect));
            assert_eq!(effect.key(), effect.name().replace(' ', "_"));
        }
        let message = "normal_map".parse::<Effect>().expect_err("a slip");
        assert!(message.contains("did you mean `normal_maps`?"), "{message}");
    }

    #[test]
    fn all_are_listed_once_in_order() {
        assert!(Effect::ALL.is_sorted());
        assert!(Effect::ALL.windows(2).all(|pair| pair[0] != pair[1]));
    }
}
