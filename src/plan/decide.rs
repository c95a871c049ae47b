//! What the scene's content calls for, effect by effect.

use super::decision::{Cause, Decision, few};
use super::{Effect, lighting};
use crate::description::{Antialiasing, Material, Scene, Use, uses};

/// One decision an effect, in their order, of a scene without what changes nothing; `written` is that with it.
pub(super) fn decide(scene: &Scene, written: &Scene) -> Vec<Decision> {
    let (uses, all) = (uses(scene), uses(written));
    // what is named and changes nothing is told
    let named = |effect: Effect, name: fn(&Material) -> Option<String>, otherwise: &str| {
        if let Some(reason) = who(&uses, ["names", "name"], name) {
            return Decision::on(effect, reason);
        }
        let idle = who(&all, ["names", "name"], name).map(|told| format!("{told}, which changes nothing"));
        Decision::off(effect, idle.unwrap_or_else(|| otherwise.to_owned()))
    };
    let lights = lighting::Lights::of(scene, &uses);
    Effect::ALL
        .into_iter()
        .map(|effect| match effect {
            Effect::Direct => lights.direct(),
            Effect::Shadows => lights.shadows(&uses),
            Effect::SoftShadows => lights.soft_shadows(&uses),
            Effect::Environment => lights.environment(),
            Effect::Highlights => lights.highlights(&uses),
            Effect::Caustics => lights.caustics(scene, &uses),
            Effect::Reflection => Decision::of(
                effect,
                who(&uses, ["reflects", "reflect"], |m| match (m.reflection.is_zero(), m.is_interface()) {
                    (false, _) => Some(String::new()),
                    (true, true) if m.bends() => Some(" by Fresnel".to_owned()),
                    _ => None,
                }),
                "no reachable material reflects, and none bends light",
            ),
            Effect::Refraction => refraction(&uses),
            Effect::NestedMedia => nested_media(&uses),
            Effect::Absorption => Decision::of(
                effect,
                who(&uses, ["absorbs", "absorb"], |m| {
                    let absorbs = !m.absorption.is_zero() && !m.transmission.is_zero();
                    absorbs.then(|| " inside".to_owned())
                }),
                "no reachable material that transmits absorbs",
            ),
            Effect::Dispersion => dispersion(&uses),
            Effect::Textures => named(effect, texture_names, "no reachable material names a texture"),
            Effect::NormalMaps => named(
                effect,
                |m| m.normal_map.as_ref().map(|map| format!(" `{}`", map.texture)),
                "no reachable material names one",
            ),
            Effect::BumpMaps => named(
                effect,
                |m| m.bump_map.as_ref().map(|map| format!(" `{}`", map.texture)),
                "no reachable material names one",
            ),
            Effect::Indirect => lights.indirect(scene, &uses),
            Effect::DepthOfField => Decision::of(
                effect,
                scene
                    .camera
                    .as_ref()
                    .filter(|c| c.aperture_m > 0.0)
                    .map(|c| format!("the camera's aperture is {} m", c.aperture_m)),
                "the camera is a pinhole",
            ),
            Effect::Antialiasing => antialiasing(scene),
        })
        .collect()
}

/// The objects whose materials are found, what they do (of one and of several), and what more is said of
/// them; two materials are told, the rest counted.
pub(super) fn who(
    uses: &[Use],
    does: [&str; 2],
    found: impl Fn(&Material) -> Option<String>,
) -> Option<String> {
    let found: Vec<(&Use, String)> = uses.iter().filter_map(|u| Some((u, found(u.material)?))).collect();
    let told: Vec<String> = found
        .iter()
        .take(2)
        .map(|(u, said)| {
            let does = does[usize::from(u.objects.len() > 1)];
            format!("{} (material `{}`) {does}{said}", few(&u.objects), u.name)
        })
        .collect();
    let rest = match found.len().saturating_sub(2) {
        0 => String::new(),
        1 => "; and 1 more material".to_owned(),
        more => format!("; and {more} more materials"),
    };
    (!told.is_empty()).then(|| told.join("; ") + &rest)
}

fn dispersion(uses: &[Use]) -> Decision {
    let disperses = |m: &Material| (m.disperses() && m.is_interface()).then(String::new);
    if let Some(reason) = who(uses, ["disperses", "disperse"], disperses) {
        return Decision::on(Effect::Dispersion, reason);
    }
    let spreads_nothing = |m: &Material| {
        let said = m.dispersion.is_some() && m.index() == 1.0 && !m.transmission.is_zero();
        said.then(|| " ior 1, of which an Abbe number spreads nothing".to_owned())
    };
    let reason = who(uses, ["has", "have"], spreads_nothing);
    Decision::off(
        Effect::Dispersion,
        reason.unwrap_or_else(|| "no reachable material that transmits disperses".to_owned()),
    )
}

fn refraction(uses: &[Use]) -> Decision {
    let real =
        who(uses, ["transmits", "transmit"], |m| m.is_interface().then(|| format!(", ior {}", m.index())));
    if let Some(reason) = real {
        return Decision::on(Effect::Refraction, reason);
    }
    let nothing = who(uses, ["has", "have"], |m| {
        let transmits = !m.transmission.is_zero() && !m.reflection.is_one();
        transmits.then(|| " the index of what is around, 1: light does not notice".to_owned())
    });
    Decision::off(Effect::Refraction, nothing.unwrap_or_else(|| "no reachable material transmits".to_owned()))
}

/// Whether their bounds overlap is not known before they are placed.
fn nested_media(uses: &[Use]) -> Decision {
    let mut objects: Vec<&str> = uses
        .iter()
        .filter(|u| !u.material.transmission.is_zero() && !u.material.reflection.is_one())
        .flat_map(|u| u.objects.iter().map(String::as_str))
        .collect();
    objects.sort_unstable();
    objects.dedup();
    match objects.as_slice() {
        [] => Decision::off(Effect::NestedMedia, "no reachable material transmits"),
        many => {
            let verb = if many.len() == 1 { "transmits" } else { "transmit" };
            let on = uses.iter().any(|u| u.material.is_interface());
            let what = if on {
                ": overlaps are looked for when they are placed"
            } else {
                ", all as the vacuum does"
            };
            let reason = format!("{} {verb}{what}", few(many));
            Decision { effect: Effect::NestedMedia, on, reason, cause: Cause::Scene }
        }
    }
}

fn texture_names(m: &Material) -> Option<String> {
    let mut names: Vec<&str> = Vec::new();
    for weight in [&m.diffuse, &m.specular, &m.reflection, &m.transmission, &m.emission] {
        if let Some(texture) = weight.texture()
            && !names.contains(&texture.name.as_str())
        {
            names.push(&texture.name);
        }
    }
    (!names.is_empty()).then(|| format!(" {}", few(&names)))
}

fn antialiasing(scene: &Scene) -> Decision {
    let (on, kind) = match scene.antialiasing {
        Antialiasing::None => (false, "none: one sample at the centre of each pixel".to_owned()),
        Antialiasing::Grid(n) => (true, format!("grid: {n} × {n} samples a pixel and pass")),
        Antialiasing::Adaptive { threshold, depth } => (
            true,
            format!(
                "adaptive: corners, divided up to {depth} times where contrast times share of the pixel is above {threshold}"
            ),
        ),
        Antialiasing::Progressive => {
            (true, "progressive: one sample a pixel and pass, well distributed".to_owned())
        }
    };
    let asked = scene.antialiasing != Antialiasing::default();
    let cause = if asked { Cause::Asked } else { Cause::Scene };
    Decision { effect: Effect::Antialiasing, on, reason: kind, cause }
}
