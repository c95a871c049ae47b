//! What lights the scene, and what that calls for.

use super::Effect;
use super::decide::who;
use super::decision::{Cause, Decision, few};
use crate::description::{Indirect, Light, Material, Photons, Scene, Use};

/// The scene's lights by kind, each by its name; black ones shine nowhere and are left out.
pub(super) struct Lights<'a> {
    /// Without an extent.
    small: Vec<&'a str>,
    large: Vec<&'a str>,
    sky: Option<&'a str>,
    /// A sky that is black.
    night: Option<&'a str>,
    /// Objects that emit.
    objects: Vec<&'a str>,
}

impl<'a> Lights<'a> {
    pub fn of(scene: &'a Scene, uses: &'a [Use]) -> Lights<'a> {
        let mut lights =
            Lights { small: Vec::new(), large: Vec::new(), sky: None, night: None, objects: Vec::new() };
        let black =
            |(_, light): &(&str, &Light)| light.is_black() && matches!(light, Light::Environment { .. });
        lights.night = scene.lights.iter().find(black).map(|(name, _)| name);
        for (name, light) in scene.lights.iter().filter(|(_, light)| !light.is_black()) {
            match light {
                Light::Point { .. } | Light::Spot { .. } | Light::Directional { .. } => {
                    lights.small.push(name)
                }
                Light::Sphere { .. } | Light::Quad { .. } | Light::Disk { .. } => lights.large.push(name),
                Light::Environment { .. } => lights.sky = Some(name),
            }
        }
        let emitting = uses.iter().filter(|u| u.material.emits());
        for object in emitting.flat_map(|u| u.objects.iter().map(String::as_str)) {
            if !lights.objects.contains(&object) {
                lights.objects.push(object);
            }
        }
        lights
    }

    /// Those with an extent.
    fn soft(&self) -> Vec<&'a str> {
        self.large.iter().chain(&self.objects).chain(&self.sky).copied().collect()
    }

    fn all(&self) -> Vec<&'a str> {
        self.small.iter().copied().chain(self.soft()).collect()
    }

    pub fn direct(&self) -> Decision {
        let lamps: Vec<&str> = self.small.iter().chain(&self.large).copied().collect();
        let mut said = Vec::new();
        if !lamps.is_empty() {
            said.push(format!("{} {}", few(&lamps), if lamps.len() == 1 { "shines" } else { "shine" }));
        }
        if !self.objects.is_empty() {
            let verb = if self.objects.len() == 1 { "emits" } else { "emit" };
            said.push(format!("{} {verb}", few(&self.objects)));
        }
        let otherwise =
            if self.sky.is_some() { "the sky is the only light" } else { "the scene has no light" };
        Decision::of(Effect::Direct, (!said.is_empty()).then(|| said.join("; ")), otherwise)
    }

    pub fn shadows(&self, uses: &[Use]) -> Decision {
        let soft = self.soft();
        let parts =
            [("hard", &self.small), ("soft", &soft)].into_iter().filter(|(_, names)| !names.is_empty());
        let said: Vec<String> = parts.map(|(kind, names)| format!("{kind}: {}", comma(names))).collect();
        let found = (!said.is_empty()).then(|| said.join("; "));
        seen_or_off(Decision::of(Effect::Shadows, found, "the scene has no light"), uses)
    }

    pub fn soft_shadows(&self, uses: &[Use]) -> Decision {
        let soft = self.soft();
        let verb = if soft.len() == 1 { "has" } else { "have" };
        let found = (!soft.is_empty()).then(|| format!("{} {verb} an extent", few(&soft)));
        seen_or_off(Decision::of(Effect::SoftShadows, found, "no light has an extent"), uses)
    }

    pub fn environment(&self) -> Decision {
        let found = self.sky.map(|name| format!("`{name}` shines from all around"));
        let night = self.night.map(|name| format!("`{name}` is black"));
        let otherwise = night.as_deref().unwrap_or("no light is an environment");
        Decision::of(Effect::Environment, found, otherwise)
    }

    pub fn highlights(&self, uses: &[Use]) -> Decision {
        let shiny = who(uses, ["is", "are"], |m| (!m.specular.is_zero()).then(|| " specular".to_owned()));
        match shiny {
            Some(_) if self.all().is_empty() => Decision::off(Effect::Highlights, "the scene has no light"),
            found => Decision::of(Effect::Highlights, found, "no reachable material has a `specular` layer"),
        }
    }

    /// Light goes from one matt surface to another where there is light, and anything matt.
    pub fn indirect(&self, scene: &Scene, uses: &[Use]) -> Decision {
        let asked = match scene.indirect {
            Indirect::Off => return Decision::off(Effect::Indirect, "the scene does not ask for it"),
            Indirect::On => "the scene asks for it (`indirect: true`)".to_owned(),
            Indirect::Bounces(n) => format!("the scene asks for {n} bounce{}", if n == 1 { "" } else { "s" }),
        };
        if self.all().is_empty() {
            return Decision::off(Effect::Indirect, format!("{asked}, but it has no light"));
        }
        if !seen(uses) {
            return Decision::off(Effect::Indirect, format!("{asked}, but {}", unseen("it")));
        }
        Decision::on(Effect::Indirect, asked).because(Cause::Asked)
    }

    /// Light is focused where there is light, something that bends or mirrors it, and something matt to see
    /// it on. Which of the lights reach which of the objects is not known before they are placed.
    pub fn caustics(&self, scene: &Scene, uses: &[Use]) -> Decision {
        let off = |reason: &str| Decision::off(Effect::Caustics, reason);
        let lights = self.all();
        let specular: Vec<&str> = objects(uses, Material::is_specular);
        if lights.is_empty() {
            return off("the scene has no light");
        }
        if specular.is_empty() {
            return off("no reachable material reflects or transmits");
        }
        if !seen(uses) {
            return off(&unseen("them"));
        }
        if scene.photons == Photons::Off {
            return off("the scene says `photons: off`").because(Cause::Asked);
        }
        let verb = if lights.len() == 1 { "shines" } else { "shine" };
        let reason = format!("{} {verb} on {}", few(&lights), few(&specular));
        let cause = if scene.photons.is_default() { Cause::Scene } else { Cause::Asked };
        Decision::on(Effect::Caustics, reason).because(cause)
    }
}

/// Whether anything placed can show light that reaches it.
fn seen(uses: &[Use]) -> bool {
    uses.iter().any(|u| u.material.receives())
}

fn unseen(what: &str) -> String {
    format!("nothing can show {what}: every reachable material only reflects, transmits or is black")
}

/// Light that nothing can show is not looked for.
fn seen_or_off(decision: Decision, uses: &[Use]) -> Decision {
    if decision.on && !seen(uses) { Decision::off(decision.effect, unseen("them")) } else { decision }
}

/// The objects of these materials, each once.
fn objects<'a>(uses: &'a [Use], of: impl Fn(&Material) -> bool) -> Vec<&'a str> {
    let mut objects: Vec<&str> = Vec::new();
    let mut seen = std::collections::HashSet::new();
    for object in uses.iter().filter(|u| of(u.material)).flat_map(|u| &u.objects) {
        if seen.insert(object.as_str()) {
            objects.push(object);
        }
    }
    objects
}

/// All of a few names; of many the first.
fn comma(names: &[&str]) -> String {
    let told: Vec<String> = names.iter().take(4).map(|name| format!("`{name}`")).collect();
    let more = if names.len() > 4 { format!(" and {} more", names.len() - 4) } else { String::new() };
    told.join(", ") + &more
}
