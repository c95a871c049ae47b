//! Scenes as text to plans, and to renders under overrides.

use crate::render::shot::{Picture, Shot, focused};
use terrarium::plan::{Decision, Effect, Overrides, Plan, Refused, Request};

/// A matt floor; further materials, lights and objects are the insides of their lists, `more` further fields.
pub fn scene(more: &str, materials: &str, lights: &str, objects: &str) -> String {
    format!(
        r#"(camera: (eye: (1, 2, 4), target: (0, 0.4, 0)), image: (width: 24, height: 18), {more}
    textures: {{ "tiles": checker(a: 0.2, b: 0.8, squares: (9, 9)), "waves": noise(a: 0, b: 1, size_m: 0.3) }},
    materials: {{ "matt": (diffuse: 0.6), "glass": (transmission: 1, ior: 1.5), "mirror": (reflection: 1), {materials} }},
    lights: {{ {lights} }},
    objects: [(name: "floor", shape: quad(size: (9, 9)), material: "matt"), {objects}])"#
    )
}

pub const LAMP: &str = r#""lamp": point(position: (1, 4, 2), intensity: 40)"#;
pub const BALL: &str =
    r#"(name: "ball", shape: sphere(radius: 0.5, center: (0, 0.6, 0)), material: "glass")"#;

pub fn plan(text: &str, overrides: &Overrides) -> Result<Plan, Refused> {
    let loaded = focused(text).load();
    Plan::new(&loaded.scene, &Request { overrides: overrides.clone(), ..Request::default() })
}

pub fn own_plan(text: &str) -> Plan {
    plan(text, &Overrides::default()).expect("nothing is overridden")
}

pub fn decision(plan: &Plan, effect: Effect) -> &Decision {
    plan.decisions.iter().find(|d| d.effect == effect).expect("one an effect")
}

pub fn without(effects: &[Effect]) -> Overrides {
    Overrides { without: effects.to_vec(), ..Overrides::default() }
}

pub fn only(effects: &[Effect]) -> Overrides {
    Overrides { only: Some(effects.to_vec()), ..Overrides::default() }
}

pub fn with(effects: &[Effect]) -> Overrides {
    Overrides { with: effects.to_vec(), ..Overrides::default() }
}

/// A shot that is deterministic but for its lamps: one pass, every branch followed.
pub fn shot(text: &str, overrides: &Overrides) -> Shot {
    let mut shot = focused(text).passes(1);
    shot.options.overrides = overrides.clone();
    shot
}

pub fn render(text: &str, overrides: &Overrides) -> Picture {
    shot(text, overrides).render()
}
