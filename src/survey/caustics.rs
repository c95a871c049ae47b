//! Light by light, whether and by which objects it makes caustics.

use super::objects;
use crate::build::World;
use crate::optics::EmitterKind;
use crate::plan::{Decision, few};
use crate::scatter::{self, Aimed, Emission};
use serde::Serialize;
use std::fmt;

/// What of one light reaches mirrors and interfaces.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LightReach {
    pub name: String,
    pub on: bool,
    pub reason: String,
    /// The share of all directions in which photons are sent; none for light from afar and for light that
    /// sends none.
    pub aimed: Option<f64>,
    /// Of parallel light: the area across it from which photons start, m².
    pub aimed_m2: Option<f64>,
    /// The objects that bend or mirror its light, in the order of the scene.
    pub objects: Vec<String>,
    /// What they are: dielectric or mirror.
    #[serde(skip)]
    kinds: String,
}

impl fmt::Display for LightReach {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "caustics from `{}`: {}: {}", self.name, if self.on { "on" } else { "off" }, self.reason)
    }
}

pub(super) fn lights(world: &World, emission: Option<&Emission>) -> Vec<LightReach> {
    let reached = scatter::reached(world);
    let aimed = emission.map_or_else(|| vec![Aimed::default(); world.emitters.len()], Emission::aimed);
    let lights = world.emitters.iter().zip(reached).zip(aimed);
    lights
        .map(|((emitter, instances), aimed)| {
            let name = emitter.name.clone();
            let on = aimed.cells > 0 && !instances.is_empty();
            let kinds = kinds(world, &instances);
            let objects = objects::names(world, instances);
            let positive = |x: f64| (on && x > 0.0).then_some(x);
            let (share, area) = (positive(aimed.share_of_sphere), positive(aimed.area_m2));
            let reason = if on {
                let sent = sent(&name, share, area);
                format!("it reaches {} ({kinds}){sent}", few(&objects))
            } else {
                missed(&emitter.kind, &objects)
            };
            LightReach { name, on, reason, aimed: share, aimed_m2: area, objects, kinds }
        })
        .collect()
}

/// Why a light makes no caustics.
fn missed(kind: &EmitterKind, objects: &[String]) -> String {
    if !objects.is_empty() {
        return format!("none of its light is sent towards {}", few(objects));
    }
    match kind {
        EmitterKind::Spot { .. } => "its cone meets no specular object".to_owned(),
        EmitterKind::Shape { .. } => "no specular object lies before it".to_owned(),
        _ => "nothing that is placed bends or mirrors light".to_owned(),
    }
}

fn sent(name: &str, share: Option<f64>, area: Option<f64>) -> String {
    match (share, area) {
        (Some(share), _) => format!("; {} of `{name}`'s sphere is aimed at", percent(share)),
        (_, Some(area)) => format!("; {} m² of its light is aimed at", significant(area)),
        _ => String::new(),
    }
}

/// `3.1 %`.
fn percent(share: f64) -> String {
    significant(100.0 * share) + " %"
}

/// Two digits that count.
fn significant(x: f64) -> String {
    let decimals = if x >= 10.0 { 0 } else { (1.0 - libm::floor(libm::log10(x.max(1e-12)))) as usize };
    format!("{x:.decimals$}")
}

/// `dielectric, ior 1.5`, `mirror`, or several.
fn kinds(world: &World, instances: &[u32]) -> String {
    let mut iors: Vec<f64> = Vec::new();
    let mut mirrors = false;
    for &instance in instances {
        let rank = world.instances[instance as usize].rank;
        if rank != 0 {
            let ior = world.media[rank as usize - 1].ior.ior(None);
            if !iors.contains(&ior) {
                iors.push(ior);
            }
        }
        mirrors |= objects::materials(world, instance).any(|m| !m.reflection.is_zero());
    }
    let told: Vec<String> = iors.iter().take(3).map(f64::to_string).collect();
    let more = if iors.len() > 3 { format!(" and {} more", iors.len() - 3) } else { String::new() };
    let dielectric = (!iors.is_empty()).then(|| format!("dielectric, ior {}{more}", told.join(", ")));
    let kinds: Vec<String> = dielectric.into_iter().chain(mirrors.then(|| "mirror".to_owned())).collect();
    kinds.join("; ")
}

/// The decision on caustics with what has been seen of lights and objects.
pub(super) fn refined(world: &World, decision: &Decision, lights: &[LightReach]) -> Decision {
    let on: Vec<&LightReach> = lights.iter().filter(|light| light.on).collect();
    let Some(first) = on.first() else {
        let names: Vec<&str> = lights.iter().map(|light| light.name.as_str()).collect();
        let reason = match lights {
            [] => "nothing that shines is placed".to_owned(),
            [one] => format!("`{}`: {}", one.name, one.reason),
            _ => format!("no light reaches what bends or mirrors it ({})", few(&names)),
        };
        return Decision { on: false, reason, ..decision.clone() };
    };
    let way = if first.kinds == "mirror" { "by" } else { "through" };
    let (objects, kinds) = (few(&first.objects), &first.kinds);
    let mut reason = format!("`{}` reaches {} {way} {objects} ({kinds})", first.name, few(&receivers(world)));
    reason += &sent(&first.name, first.aimed, first.aimed_m2);
    match on.len() - 1 {
        0 => {}
        1 => reason += "; and so does 1 more light",
        more => reason += &format!("; and so do {more} more lights"),
    }
    Decision { reason, ..decision.clone() }
}

/// The objects on which caustics can be seen, the one with the largest part first.
fn receivers(world: &World) -> Vec<&str> {
    let by_binding: Vec<bool> = world
        .bindings
        .iter()
        .map(|ids| ids.iter().any(|id| objects::receives(&world.materials[id.0 as usize])))
        .collect();
    // The square of the largest part's extent, by object.
    let mut sizes = vec![0.0f32; world.object_names.len()];
    for instance in world.instances.iter().filter(|i| i.visible && by_binding[i.binding as usize]) {
        let geometry = &world.geometries[instance.geometry as usize];
        let size = &mut sizes[instance.object as usize];
        *size = size.max(World::placed_bounds(geometry, &instance.placement).extent().length_squared());
    }
    let mut found: Vec<usize> = (0..sizes.len()).filter(|&object| sizes[object] > 0.0).collect();
    found.sort_by(|&a, &b| sizes[b].total_cmp(&sizes[a]).then(a.cmp(&b)));
    found.into_iter().map(|object| world.object_names[object].as_str()).collect()
}

#[cfg(test)]
mod tests {
    use super::{percent, significant};

    #[test]
    fn two_digits_are_told_whatever_the_size() {
        assert_eq!(percent(0.0314159), "3.1 %");
        assert_eq!(percent(0.5), "50 %");
        assert_eq!(percent(0.000123), "0.012 %");
        assert_eq!(percent(1.0), "100 %");
        assert_eq!(significant(12.6), "13");
    }
}
