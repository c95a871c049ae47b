//! Effects, each decided with its reason in the scene's own names.

use crate::description::{Light, Material, Photons, Scene, Source};
use std::fmt;

#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub enum Effect {
    Direct,
    SoftShadows,
    Reflection,
    Refraction,
    Absorption,
    Dispersion,
    Caustics,
    Indirect,
    Textures,
    NormalMaps,
    DepthOfField,
    Environment,
}

impl Effect {
    pub fn name(self) -> &'static str {
        match self {
            Effect::Direct => "direct",
            Effect::SoftShadows => "soft shadows",
            Effect::Reflection => "reflection",
            Effect::Refraction => "refraction",
            Effect::Absorption => "absorption",
            Effect::Dispersion => "dispersion",
            Effect::Caustics => "caustics",
            Effect::Indirect => "indirect",
            Effect::Textures => "textures",
            Effect::NormalMaps => "normal maps",
            Effect::DepthOfField => "depth of field",
            Effect::Environment => "environment",
        }
    }
}

/// Whether an effect runs, and why.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Decision {
    pub effect: Effect,
    pub on: bool,
    pub reason: String,
}

impl fmt::Display for Decision {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}: {}: {}", self.effect.name(), if self.on { "on" } else { "off" }, self.reason)
    }
}

pub(super) fn decide(scene: &Scene) -> Vec<Decision> {
    let named = |predicate: &dyn Fn(&Material) -> bool| {
        scene.materials.iter().find(|(_, m)| predicate(m)).map(|(name, _)| format!("material `{name}`"))
    };
    let light = |predicate: &dyn Fn(&Light) -> bool| {
        scene.lights.iter().find(|(_, l)| predicate(l)).map(|(name, _)| format!("light `{name}`"))
    };
    let emitting = || named(&|m| !m.emission.is_zero());
    let area = |l: &Light| matches!(l, Light::Sphere { .. } | Light::Quad { .. } | Light::Disk { .. });
    let sources = |m: &Material| {
        [&m.diffuse, &m.specular, &m.reflection, &m.transmission, &m.emission]
            .into_iter()
            .any(|s| matches!(s, Source::Texture(_)))
    };
    let lens = scene
        .camera
        .as_ref()
        .filter(|c| c.aperture_m > 0.0)
        .map(|c| format!("aperture of {} m", c.aperture_m));
    vec![
        decision(Effect::Direct, light(&|_| true).or_else(emitting), "the scene has no light"),
        decision(
            Effect::SoftShadows,
            light(&|l| area(l) || matches!(l, Light::Environment { .. })).or_else(emitting),
            "no light has an extent",
        ),
        decision(Effect::Reflection, named(&|m| !m.reflection.is_zero()), "no material reflects"),
        decision(Effect::Refraction, named(&|m| !m.transmission.is_zero()), "no material transmits"),
        decision(
            Effect::Dispersion,
            named(&|m| m.dispersion.is_some() && !m.transmission.is_zero()),
            "no material disperses",
        ),
        decision(Effect::Absorption, named(&|m| !m.absorption.is_zero()), "no material absorbs inside"),
        caustics(
            scene,
            light(&|_| true).or_else(emitting),
            named(&|m| !m.reflection.is_zero() || !m.transmission.is_zero()),
        ),
        decision(
            Effect::Indirect,
            (!scene.indirect.is_off()).then(|| "the scene asks for it".to_owned()),
            "the scene does not ask for it",
        ),
        decision(Effect::Textures, named(&sources), "no material names a texture"),
        decision(
            Effect::NormalMaps,
            named(&|m| m.normal_map.is_some() || m.bump_map.is_some()),
            "no material names a normal or bump map",
        ),
        decision(Effect::DepthOfField, lens, "the camera is a pinhole"),
        decision(
            Effect::Environment,
            light(&|l| matches!(l, Light::Environment { .. })),
            "no light is an environment",
        ),
    ]
}

/// Light can be focused where there is light, and something that bends or mirrors it.
fn caustics(scene: &Scene, light: Option<String>, specular: Option<String>) -> Decision {
    let (on, reason) = match (scene.photons, light, specular) {
        (Photons::Off, _, _) => (false, "the scene turns photons off".to_owned()),
        (_, None, _) => (false, "the scene has no light".to_owned()),
        (_, _, None) => (false, "no material reflects or transmits".to_owned()),
        (_, Some(light), Some(specular)) => (true, format!("{light} and {specular}")),
    };
    Decision { effect: Effect::Caustics, on, reason }
}

fn decision(effect: Effect, found: Option<String>, otherwise: &str) -> Decision {
    Decision { effect, on: found.is_some(), reason: found.unwrap_or_else(|| otherwise.to_owned()) }
}
