//! What the scene's content calls for, effect by effect.

use super::decision::{Cause, Decision, few};
use super::{Effect, lighting};
use crate::description::{
    Antialiasing, Dispersion, Indirect, Ior, Material, NAMED_IOR, Scene, Source, Use, uses,
};

/// One decision an effect, in their order.
pub(super) fn decide(scene: &Scene) -> Vec<Decision> {
    let uses = uses(scene);
    let lights = lighting::Lights::of(scene, &uses);
    Effect::ALL
        .into_iter()
        .map(|effect| match effect {
            Effect::Direct => lights.direct(),
            Effect::Shadows => lights.shadows(),
            Effect::SoftShadows => lights.soft_shadows(),
            Effect::Environment => lights.environment(),
            Effect::Highlights => lights.highlights(&uses),
            Effect::Caustics => lights.caustics(scene, &uses),
            Effect::Reflection => Decision::of(
                effect,
                who(&uses, ["reflects", "reflect"], |m| match (m.reflection.is_zero(), is_interface(m)) {
                    (false, _) => Some(String::new()),
                    (true, true) if bends(m) => Some(" by Fresnel".to_owned()),
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
            Effect::Dispersion => Decision::of(
                effect,
                who(&uses, ["disperses", "disperse"], |m| {
                    (disperses(m) && !m.transmission.is_zero()).then(String::new)
                }),
                "no reachable material that transmits disperses",
            ),
            Effect::Textures => Decision::of(
                effect,
                who(&uses, ["names", "name"], texture_names),
                "no reachable material names a texture",
            ),
            Effect::NormalMaps => Decision::of(
                effect,
                who(&uses, ["names", "name"], |m| {
                    let map = m.normal_map.as_ref().filter(|map| map.strength != 0.0)?;
                    Some(format!(" `{}`", map.texture))
                }),
                "no reachable material names one",
            ),
            Effect::BumpMaps => Decision::of(
                effect,
                who(&uses, ["names", "name"], |m| {
                    let map = m.bump_map.as_ref().filter(|map| map.height_m != 0.0)?;
                    Some(format!(" `{}`", map.texture))
                }),
                "no reachable material names one",
            ),
            Effect::Indirect => indirect(scene),
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

/// Its index of refraction at the D line.
pub(super) fn ior(m: &Material) -> f64 {
    match &m.ior {
        None => 1.5,
        Some(Ior::Number(n)) => *n,
        Some(Ior::Name(name)) => NAMED_IOR.iter().find(|(known, _)| known == name).map_or(1.5, |&(_, n)| n),
    }
}

/// Whether its index depends on the wavelength.
fn disperses(m: &Material) -> bool {
    match m.dispersion {
        None => false,
        Some(Dispersion::Cauchy(b)) => b != 0.0,
        // The spread is that of n − 1.
        Some(Dispersion::Abbe(_)) => ior(m) != 1.0,
    }
}

/// Whether its index is another than that of the vacuum.
fn bends(m: &Material) -> bool {
    ior(m) != 1.0 || disperses(m)
}

/// Whether light goes through it as through the vacuum, so that it is not there.
fn is_nothing(m: &Material) -> bool {
    let clear = Source::Constant(crate::description::Rgb::grey(1.0));
    !bends(m)
        && m.transmission == clear
        && m.reflection.is_zero()
        && m.specular.is_zero()
        && m.emission.is_zero()
        && m.absorption.is_zero()
}

/// Whether it transmits and is there at all.
pub(super) fn is_interface(m: &Material) -> bool {
    !m.transmission.is_zero() && !is_nothing(m)
}

/// Whether it bends or mirrors light.
pub(super) fn is_specular(m: &Material) -> bool {
    !m.reflection.is_zero() || is_interface(m)
}

fn refraction(uses: &[Use]) -> Decision {
    let real = who(uses, ["transmits", "transmit"], |m| is_interface(m).then(|| format!(", ior {}", ior(m))));
    if let Some(reason) = real {
        return Decision::on(Effect::Refraction, reason);
    }
    let nothing = who(uses, ["has", "have"], |m| {
        let transmits = !m.transmission.is_zero();
        transmits.then(|| " the index of what is around, 1: light does not notice".to_owned())
    });
    Decision::off(Effect::Refraction, nothing.unwrap_or_else(|| "no reachable material transmits".to_owned()))
}

/// Whether their bounds overlap is not known before they are placed.
fn nested_media(uses: &[Use]) -> Decision {
    let mut objects: Vec<&str> = uses
        .iter()
        .filter(|u| !u.material.transmission.is_zero())
        .flat_map(|u| u.objects.iter().map(String::as_str))
        .collect();
    objects.sort_unstable();
    objects.dedup();
    match objects.as_slice() {
        [] => Decision::off(Effect::NestedMedia, "no reachable material transmits"),
        many => {
            let verb = if many.len() == 1 { "transmits" } else { "transmit" };
            let what =
                if uses.iter().any(|u| is_interface(u.material)) { "" } else { ", all as the vacuum does" };
            let reason = format!("{} {verb}{what}: overlaps are looked for when they are placed", few(many));
            Decision { effect: Effect::NestedMedia, on: what.is_empty(), reason, cause: Cause::Scene }
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

fn indirect(scene: &Scene) -> Decision {
    match scene.indirect {
        Indirect::Off => Decision::off(Effect::Indirect, "the scene does not ask for it"),
        Indirect::On => {
            Decision::on(Effect::Indirect, "the scene asks for it (`indirect: true`)").because(Cause::Asked)
        }
        Indirect::Bounces(n) => {
            let reason = format!("the scene asks for {n} bounce{}", if n == 1 { "" } else { "s" });
            Decision::on(Effect::Indirect, reason).because(Cause::Asked)
        }
    }
}

fn antialiasing(scene: &Scene) -> Decision {
    let (on, kind) = match scene.antialiasing {
        Antialiasing::None => (false, "none: one sample at the centre of each pixel".to_owned()),
        Antialiasing::Grid(n) => (true, format!("grid: {n} × {n} samples a pixel and pass")),
        Antialiasing::Adaptive { threshold, depth } => (
            true,
            format!(
                "adaptive: corners, divided up to {depth} times where their contrast is above {threshold}"
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
