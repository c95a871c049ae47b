//! What theory says of the lines of a study: how fast the error should fall along them.

use super::Knob;
use super::table::signed;
use crate::plan::{Antialiasing, PhotonEngine, Plan};

/// Slopes of the RMS error over independent samples, on logarithmic axes.
const INDEPENDENT: f64 = -0.5;
/// The same over samples that fill the plane evenly, of edges in general position (Mitchell 1996, "Consequences of
/// stratified sampling in graphics": a variance of N^(−3/2)). Smooth pictures do better still.
const STRATIFIED: f64 = -0.75;

/// Slopes of error over the knob's number, of many: of edges in the picture, and the flattest part of its light where
/// that is smooth. Nothing where part of the error does not fall along this line.
pub(super) fn slopes(plan: &Plan, knob: Knob, line: &str) -> Option<[f64; 2]> {
    let progressive = plan.antialiasing == Antialiasing::Progressive;
    let mut slopes = match knob {
        Knob::Passes if progressive => by_passes(plan)?,
        Knob::Antialiasing if line == "progressive" => by_passes(plan)?,
        // Each picture is one pass, with the photons of one pass.
        Knob::Antialiasing if line == "grid" && plan.photon_budgets().next().is_none() => {
            vec![STRATIFIED, INDEPENDENT]
        }
        _ => return None,
    };
    slopes.sort_by(f64::total_cmp);
    let dimensions = f64::from(dimensions(knob));
    slopes.first().zip(slopes.last()).map(|(steep, flat)| [dimensions * steep, dimensions * flat])
}

/// Samples grow with this power of the knob's number.
pub fn dimensions(knob: Knob) -> u32 {
    if knob == Knob::Antialiasing { 2 } else { 1 }
}

/// In words: one slope, or two that it lies between.
pub fn said([steep, flat]: [f64; 2]) -> String {
    let [steep, flat] = [signed(steep), signed(flat)];
    if steep == flat { steep } else { format!("{steep} to {flat}") }
}

fn by_passes(plan: &Plan) -> Option<Vec<f64>> {
    // Whatever the light, pixels have edges in them.
    let mut slopes = vec![STRATIFIED, INDEPENDENT];
    for budget in plan.photon_budgets() {
        // The bias of one map stays as it is.
        let PhotonEngine::Progressive { alpha, .. } = budget.engine else { return None };
        // Noise and bias of radii that shrink (Knaus & Zwicker 2011): variance n^(−α), bias n^(α−1).
        slopes.extend([-0.5 * alpha, alpha - 1.0]);
    }
    Some(slopes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::{Format, load_str};
    use std::path::Path;

    fn plan(more: &str) -> Plan {
        let text = format!(
            "(camera: (eye: (0, 1, 5), target: (0, 0, 0)), {more},
              materials: {{ \"glass\": (transmission: 1, ior: 1.5), \"floor\": (diffuse: 0.5) }},
              lights: {{ \"lamp\": point(position: (0, 3, 0), intensity: 9) }},
              objects: [(shape: sphere(radius: 0.4, center: (0, 1, 0)), material: \"glass\"),
                        (shape: quad(size: (4, 4)), material: \"floor\")])"
        );
        let scene = load_str(&text, Format::Ron, Path::new(""), &[]).expect("valid").scene;
        Plan::new(&scene, &Default::default()).expect("nothing is overridden")
    }

    #[test]
    fn every_part_of_the_light_falls_by_its_own_law() {
        let of = |more: &str, knob, line| slopes(&plan(more), knob, line);
        assert_eq!(of("photons: off", Knob::Passes, "passes"), Some([-0.75, -0.5]));
        assert_eq!(of("photons: progressive(alpha: 0.75)", Knob::Passes, "passes"), Some([-0.75, -0.25]));
        let one_map = "photons: classic(count: 1000, k: 9)";
        assert_eq!(of(one_map, Knob::Passes, "passes"), None);
        let fixed = "photons: off, antialiasing: grid(2)";
        assert_eq!(of(fixed, Knob::Passes, "passes"), None);
        // Of n × n samples.
        for line in ["grid", "progressive"] {
            assert_eq!(of(fixed, Knob::Antialiasing, line), Some([-1.5, -1.0]));
        }
        assert_eq!(of("photons: off", Knob::Antialiasing, "adaptive"), None);
        assert_eq!(of("photons: progressive()", Knob::Antialiasing, "grid"), None);
        assert_eq!(of("photons: off", Knob::ShadowRays, "shadow_rays"), None);
    }
}
