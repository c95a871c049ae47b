//! One setting changed in a scene, and how the same is said on the command line.

use super::sphere_mesh;
use crate::description::{Antialiasing, Light, Photons, Scene};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// What a rung changes beside the number of passes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Change {
    Antialiasing(Antialiasing),
    /// Photons sent out a pass.
    Photons(u32),
    /// Photons that the first radius holds, or of each classic estimate.
    K(u32),
    /// On every light with an extent.
    ShadowRays(u32),
    /// Spheres as meshes of so many segments around.
    Mesh(u32),
}

impl Change {
    /// Changes the scene; meshes are looked for in `meshes`.
    pub fn apply(self, scene: &mut Scene, meshes: &Path) {
        match self {
            Change::Antialiasing(kind) => scene.antialiasing = kind,
            Change::Photons(wanted) => match &mut scene.photons {
                Photons::Progressive { count, .. } => *count = Some(wanted),
                Photons::Classic { count, .. } => *count = wanted,
                Photons::Off => {}
            },
            Change::K(wanted) => match &mut scene.photons {
                Photons::Progressive { k, .. } => *k = Some(wanted),
                Photons::Classic { k, .. } => *k = wanted,
                Photons::Off => {}
            },
            Change::ShadowRays(wanted) => {
                for (_, light) in scene.lights.iter_mut() {
                    if let Some(samples) = samples(light) {
                        *samples = Some(wanted);
                    }
                }
            }
            Change::Mesh(segments) => sphere_mesh::replace(scene, segments, meshes),
        }
    }

    /// The `--set` options that say the same of this scene. Of meshes there are none: their files are the
    /// study's own.
    pub fn set(self, scene: &Scene) -> Vec<String> {
        let engine = match scene.photons {
            Photons::Classic { .. } => "classic",
            _ => "progressive",
        };
        match self {
            Change::Antialiasing(kind) => vec![format!("antialiasing={}", spelt(kind))],
            Change::Photons(count) => vec![format!("photons.{engine}.count={count}")],
            Change::K(k) => vec![format!("photons.{engine}.k={k}")],
            Change::ShadowRays(n) => scene
                .lights
                .iter()
                .filter(|(_, light)| has_samples(light))
                .map(|(name, _)| format!("lights.{name}.samples={n}"))
                .collect(),
            Change::Mesh(_) => Vec::new(),
        }
    }
}

/// As a scene in RON has it.
pub fn spelt(kind: Antialiasing) -> String {
    match kind {
        Antialiasing::None => "none".to_owned(),
        Antialiasing::Grid(n) => format!("grid({n})"),
        Antialiasing::Adaptive { threshold, depth } => {
            format!("adaptive(threshold: {threshold}, depth: {depth})")
        }
        Antialiasing::Progressive => "progressive".to_owned(),
    }
}

/// Whether the number of shadow rays on it can be set.
pub fn has_samples(light: &Light) -> bool {
    matches!(
        light,
        Light::Sphere { .. } | Light::Quad { .. } | Light::Disk { .. } | Light::Environment { .. }
    )
}

fn samples(light: &mut Light) -> Option<&mut Option<u32>> {
    match light {
        Light::Sphere { samples, .. }
        | Light::Quad { samples, .. }
        | Light::Disk { samples, .. }
        | Light::Environment { samples, .. } => Some(samples),
        Light::Point { .. } | Light::Spot { .. } | Light::Directional { .. } => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::{Format, load_str};

    const SCENE: &str = r#"(camera: (eye: (0, 1, 5), target: (0, 0, 0)), MORE
        lights: { "lamp": sphere(center: (0, 4, 0), radius: 0.5, radiance: 9), "bulb": point(position: (2, 3, 0), intensity: 1) })"#;

    /// The options that are told give the scene that was rendered.
    #[test]
    fn what_is_told_for_the_command_line_says_the_same() {
        let read = |text: &str, set: &[String]| {
            load_str(text, Format::Ron, Path::new(""), set).unwrap_or_else(|e| panic!("{set:?}: {e}")).scene
        };
        for more in ["", "photons: progressive(k: 7),", "photons: classic(count: 5000, k: 40),"] {
            let text = SCENE.replace("MORE", more);
            let scene = read(&text, &[]);
            for change in [
                Change::Antialiasing(Antialiasing::None),
                Change::Antialiasing(Antialiasing::Grid(4)),
                Change::Antialiasing(Antialiasing::Adaptive { threshold: 0.025, depth: 5 }),
                Change::Photons(12_345),
                Change::K(60),
                Change::ShadowRays(8),
            ] {
                let mut edited = scene.clone();
                change.apply(&mut edited, Path::new(""));
                assert_eq!(read(&text, &change.set(&scene)), edited, "{change:?} of `{more}`");
                assert_ne!(edited, scene);
            }
        }
    }
}
