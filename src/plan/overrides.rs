//! Effects that a caller leaves out, or adds, against what the scene calls for.
//!
//! Most overrides are the same as an edited scene, and are made by editing it: [`edited`] gives the scene
//! that is rendered. What no scene can say (no shadow rays, no reflections) is the plan's.

use super::decision::{Cause, Decision};
use super::{Carried, Effect};
use crate::description::{Antialiasing, Indirect, Light, Photons, Rgb, Scene, Source, Unread};
use std::borrow::Cow;
use std::fmt;

/// Overrides of a scene's effects.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Overrides {
    /// Left out wherever they would be.
    pub without: Vec<Effect>,
    /// The image is the light of these alone.
    pub only: Option<Vec<Effect>>,
    /// Added where the scene has what they need.
    pub with: Vec<Effect>,
    /// For tests: whatever can run does, called for or not.
    #[doc(hidden)]
    pub forced: bool,
}

/// Overrides that contradict each other or the scene.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Refused(pub String);

impl Overrides {
    pub fn is_empty(&self) -> bool {
        self.without.is_empty() && self.only.is_none() && self.with.is_empty()
    }

    /// What of the scene is not needed.
    pub fn unread(&self) -> Unread {
        Unread {
            normal_maps: self.leaves_out(Effect::NormalMaps),
            bump_maps: self.leaves_out(Effect::BumpMaps),
            highlights: self.leaves_out(Effect::Highlights),
            // whether there is indirect light, the scene has to tell
            environment: !Carried::new(self.only.as_deref(), &self.without, true)
                .anywhere(Effect::Environment)
                || self.leaves_out(Effect::Environment),
        }
    }

    pub(super) fn leaves_out(&self, effect: Effect) -> bool {
        self.without.contains(&effect)
    }

    pub(super) fn carried(&self, scene: &Scene) -> Carried {
        let indirect = !scene.indirect.is_off() || self.with.contains(&Effect::Indirect);
        Carried::new(self.only.as_deref(), &self.without, indirect)
    }

    /// Refuses contradictions; gives back what has no effect. `decisions` are the scene's own.
    pub(super) fn check(&self, decisions: &[Decision]) -> Result<Vec<String>, Refused> {
        let refuse = |message: String| Err(Refused(message));
        if self.leaves_out(Effect::NestedMedia) {
            return refuse(
                "nested_media can't be left out: where glass and water overlap, one of them has to count"
                    .to_owned(),
            );
        }
        if let Some(shaping) = self.only.iter().flatten().find(|e| !e.carries_light()) {
            let carriers: Vec<&str> =
                Effect::ALL.into_iter().filter(|e| e.carries_light()).map(Effect::key).collect();
            let (key, list) = (shaping.key(), carriers.join(", "));
            let instead = match shaping {
                Effect::NestedMedia => "it is always there".to_owned(),
                _ => format!("leave it out by --without {key}"),
            };
            return refuse(format!(
                "--only takes effects that carry light ({list}); {key} shapes it: {instead}"
            ));
        }
        if let Some(both) = self.with.iter().find(|e| self.leaves_out(**e)) {
            return refuse(format!("{} is in --with and in --without", both.key()));
        }
        if let Some(only) = &self.only {
            if let Some(both) = only.iter().find(|e| self.leaves_out(**e)) {
                return refuse(format!("{} is in --only and in --without", both.key()));
            }
            if let Some(unnamed) = self.with.iter().find(|e| e.carries_light() && !only.contains(e)) {
                let key = unnamed.key();
                return refuse(format!("--with {key} adds what --only leaves out; name {key} in --only too"));
            }
        }
        for &effect in &self.with {
            let decision = decisions.iter().find(|d| d.effect == effect && !d.on);
            // Photons that the scene turns off can be turned on; all else needs content.
            let can = effect == Effect::Indirect
                || effect == Effect::Caustics && decision.is_some_and(|d| d.cause == Cause::Asked);
            if let Some(decision) = decision.filter(|_| !can) {
                let (key, needs) = (effect.key(), effect.needs());
                return refuse(format!("{key} needs {needs}; in this scene: {}", decision.reason));
            }
        }
        let idle = |e: &&Effect| decisions.iter().any(|d| d.effect == **e && !d.on);
        let reason = |e: &Effect| decisions.iter().find(|d| d.effect == *e).map_or("", |d| &d.reason);
        let left = self.without.iter().filter(idle);
        let left = left.map(|e| format!("--without {} leaves out nothing: {}", e.key(), reason(e)));
        let named = self.only.iter().flatten().filter(idle).filter(|e| !self.with.contains(e));
        let named = named.map(|e| format!("--only {} shows nothing of it: {}", e.key(), reason(e)));
        Ok(left.chain(named).collect())
    }

    /// The decisions of the edited scene, with the overrides' own in their places; `own` are those of the
    /// scene as it stands.
    pub(super) fn decide(&self, own: &[Decision], edited: &[Decision], carried: &Carried) -> Vec<Decision> {
        let lit = |e: Effect| carried.anywhere(e) && edited.iter().any(|d| d.effect == e && d.on);
        let unlit = ![Effect::Direct, Effect::Highlights, Effect::Environment].into_iter().any(lit);
        let over = |effect, on, reason| Decision { effect, on, reason, cause: Cause::Overridden };
        own.iter()
            .zip(edited)
            .map(|(own, edited)| {
                let effect = own.effect;
                if self.leaves_out(effect) {
                    return match own.on {
                        true => over(effect, false, format!("left out (--without); else on: {}", own.reason)),
                        false => own.clone(),
                    };
                }
                if self.with.contains(&effect) && !own.on && edited.on {
                    return over(effect, true, format!("added (--with); else off: {}", own.reason));
                }
                let shadow = matches!(effect, Effect::Shadows | Effect::SoftShadows);
                if shadow && edited.on && unlit {
                    return over(
                        effect,
                        false,
                        format!("with `{self}` no surface looks for a lamp or a sky"),
                    );
                }
                if effect == Effect::SoftShadows && edited.on && self.leaves_out(Effect::Shadows) {
                    return over(effect, false, "shadows are left out (--without)".to_owned());
                }
                self.only(own, edited, carried)
            })
            .collect()
    }

    /// The decision of the edited scene; where that has lost what the effect needs, by the overrides.
    fn lost(&self, own: &Decision, edited: &Decision) -> Decision {
        if !own.on || edited.on || edited.cause == Cause::Asked {
            return edited.clone();
        }
        let reason = format!("nothing is left of it with `{self}`; else on: {}", own.reason);
        Decision { effect: own.effect, on: false, reason, cause: Cause::Overridden }
    }

    /// What `--only` makes of a decision.
    fn only(&self, own: &Decision, edited: &Decision, carried: &Carried) -> Decision {
        let effect = own.effect;
        let Some(only) = self.only.as_ref().filter(|_| effect.carries_light() && own.on) else {
            // what the scene lacks is off for its own reason, not for what an edit took away
            return if own.on { self.lost(own, edited) } else { own.clone() };
        };
        let set = super::Carriers::of(effect);
        if carried.first.any(set) {
            return self.lost(own, edited);
        }
        let list: Vec<&str> = only.iter().map(|e| e.key()).collect();
        let list = list.join(", ");
        let over = |on, reason| Decision { effect, on, reason, cause: Cause::Overridden };
        if carried.behind.any(set) {
            over(true, format!("{}; seen by way of {list} only (--only)", edited.reason))
        } else if carried.anywhere(effect) {
            over(true, format!("{}; for the light of {list} only (--only)", edited.reason))
        } else {
            over(false, format!("left out (--only {list}); else on: {}", own.reason))
        }
    }
}

impl fmt::Display for Overrides {
    /// `only direct, caustics, without textures, with indirect`; nothing where there are none.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let list = |word: &str, effects: &[Effect]| {
            let keys: Vec<&str> = effects.iter().map(|e| e.key()).collect();
            (!keys.is_empty()).then(|| format!("{word} {}", keys.join(", ")))
        };
        let parts = [
            list("only", self.only.as_deref().unwrap_or_default()),
            list("without", &self.without),
            list("with", &self.with),
        ];
        f.write_str(&parts.into_iter().flatten().collect::<Vec<_>>().join(", "))
    }
}

/// The scene that is rendered: that of the file, as far as overrides can be said in one.
pub(super) fn edited<'a>(scene: &'a Scene, overrides: &Overrides, carried: &Carried) -> Cow<'a, Scene> {
    if overrides.is_empty() {
        return Cow::Borrowed(scene);
    }
    let mut edited = scene.clone();
    let without = |effect| overrides.leaves_out(effect);
    for (_, material) in edited.materials.iter_mut() {
        if without(Effect::Absorption) {
            material.absorption = Rgb::default();
        }
        if without(Effect::Dispersion) {
            material.dispersion = None;
        }
        if without(Effect::Highlights) {
            material.specular = Source::default();
        }
        if without(Effect::NormalMaps) {
            material.normal_map = None;
        }
        if without(Effect::BumpMaps) {
            material.bump_map = None;
        }
    }
    if without(Effect::DepthOfField)
        && let Some(camera) = &mut edited.camera
    {
        camera.aperture_m = 0.0;
    }
    if without(Effect::Antialiasing) {
        edited.antialiasing = Antialiasing::None;
    }
    if !carried.anywhere(Effect::Environment) || without(Effect::Environment) {
        darken(&mut edited);
    }
    if !carried.first.with(carried.behind).any(super::Carriers::INDIRECT) {
        edited.indirect = Indirect::Off;
    } else if overrides.with.contains(&Effect::Indirect) && edited.indirect.is_off() {
        edited.indirect = Indirect::On;
    }
    if overrides.with.contains(&Effect::Caustics) && edited.photons == Photons::Off {
        edited.photons = Photons::default();
    }
    Cow::Owned(edited)
}

/// Takes the sky away; where it was seen there is nothing.
fn darken(scene: &mut Scene) {
    let seen = |light: &Light| matches!(light, Light::Environment { visible: true, .. });
    if scene.lights.iter().any(|(_, light)| seen(light)) {
        scene.background = Rgb::default();
    }
    scene.lights.retain(|light| !matches!(light, Light::Environment { .. }));
}
