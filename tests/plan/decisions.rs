//! A table of small scenes, one an effect: what the plan says, and that it says no without the one thing
//! that calls for it.

use super::lab::{BALL, LAMP, decision, own_plan, scene};
use terrarium::plan::Effect;

const SKY: &str = r#""sky": environment(map: constant(1))"#;

/// An effect, a scene that calls for it, what is said, the scene without what calls for it, and what is said then.
struct Row {
    effect: Effect,
    with: [&'static str; 4],
    on: &'static str,
    without: [&'static str; 4],
    off: &'static str,
}

#[rustfmt::skip]
const TABLE: &[Row] = &[
    Row { effect: Effect::Direct,
        with: ["", "", LAMP, ""], on: "direct: on: `lamp` shines",
        without: ["", "", "", ""], off: "direct: off: the scene has no light" },
    Row { effect: Effect::Direct,
        with: ["", r#""hot": (emission: 3)"#, "", r#"(name: "bulb", shape: sphere(), material: "hot")"#], on: "direct: on: `bulb` emits",
        without: ["", r#""hot": (emission: 3)"#, SKY, ""], off: "direct: off: the sky is the only light" },
    Row { effect: Effect::Shadows,
        with: ["", "", r#""sun": directional(direction: (0, -1, 0), irradiance: 1), "lamp": sphere(center: (0, 4, 0), radius: 0.3, radiance: 5), "sky": environment(map: constant(1))"#, ""],
        on: "shadows: on: hard: `sun`; soft: `lamp`, `sky`",
        without: ["", "", "", ""], off: "shadows: off: the scene has no light" },
    Row { effect: Effect::SoftShadows,
        with: ["", "", r#""lamp": disk(center: (0, 3, 0), normal: (0, -1, 0), radius: 0.5, radiance: 5)"#, ""], on: "soft shadows: on: `lamp` has an extent",
        without: ["", "", LAMP, ""], off: "soft shadows: off: no light has an extent" },
    Row { effect: Effect::Reflection,
        with: ["", "", LAMP, r#"(name: "ball", shape: sphere(), material: "mirror")"#], on: "reflection: on: `ball` (material `mirror`) reflects",
        without: ["", "", LAMP, ""], off: "reflection: off: no reachable material reflects, and none bends light" },
    Row { effect: Effect::Reflection,
        with: ["", "", LAMP, BALL], on: "reflection: on: `ball` (material `glass`) reflects by Fresnel",
        without: ["", r#""air": (transmission: 1, ior: 1)"#, LAMP, r#"(shape: sphere(), material: "air")"#], off: "reflection: off: no reachable material reflects, and none bends light" },
    Row { effect: Effect::Refraction,
        with: ["", "", LAMP, BALL], on: "refraction: on: `ball` (material `glass`) transmits, ior 1.5",
        without: ["", r#""air": (transmission: 1, ior: 1)"#, LAMP, r#"(name: "ball", shape: sphere(), material: "air")"#],
        off: "refraction: off: `ball` (material `air`) has the index of what is around, 1: light does not notice" },
    Row { effect: Effect::NestedMedia,
        with: ["", "", LAMP, r#"(name: "a", shape: sphere(), material: "glass"), (name: "b", shape: box(), material: "glass")"#],
        on: "nested media: on: `a` and `b` transmit: overlaps are looked for when they are placed",
        without: ["", "", LAMP, ""], off: "nested media: off: no reachable material transmits" },
    Row { effect: Effect::Absorption,
        with: ["", r#""tea": (transmission: 1, absorption: (1, 2, 3))"#, LAMP, r#"(name: "cup", shape: sphere(), material: "tea")"#], on: "absorption: on: `cup` (material `tea`) absorbs inside",
        without: ["", r#""tea": (transmission: 1)"#, LAMP, r#"(name: "cup", shape: sphere(), material: "tea")"#], off: "absorption: off: no reachable material that transmits absorbs" },
    Row { effect: Effect::Dispersion,
        with: ["", r#""flint": (transmission: 1, ior: 1.6, dispersion: abbe(36))"#, LAMP, r#"(name: "prism", shape: box(), material: "flint")"#], on: "dispersion: on: `prism` (material `flint`) disperses",
        without: ["", r#""flint": (transmission: 1, ior: 1.6)"#, LAMP, r#"(name: "prism", shape: box(), material: "flint")"#], off: "dispersion: off: no reachable material that transmits disperses" },
    Row { effect: Effect::Highlights,
        with: ["", r#""wax": (diffuse: 0.5, specular: 0.2)"#, LAMP, r#"(name: "a", shape: box(), material: "wax"), (name: "b", shape: box(), material: "wax"), (name: "c", shape: box(), material: "wax")"#],
        on: "highlights: on: `a`, `b` and 1 more (material `wax`) are specular",
        without: ["", r#""wax": (diffuse: 0.5)"#, LAMP, r#"(shape: box(), material: "wax")"#], off: "highlights: off: no reachable material has a `specular` layer" },
    Row { effect: Effect::Textures,
        with: ["", r#""tiled": (diffuse: texture("tiles"))"#, LAMP, r#"(name: "a", shape: box(), material: "tiled")"#], on: "textures: on: `a` (material `tiled`) names `tiles`",
        without: ["", r#""tiled": (diffuse: texture("tiles"))"#, LAMP, r#"(name: "a", shape: box(), material: "matt")"#], off: "textures: off: no reachable material names a texture" },
    Row { effect: Effect::NormalMaps,
        with: ["", r#""brick": (diffuse: 0.5, normal_map: (texture: "waves"))"#, LAMP, r#"(name: "wall", shape: box(), material: "brick")"#], on: "normal maps: on: `wall` (material `brick`) names `waves`",
        without: ["", r#""brick": (diffuse: 0.5, normal_map: (texture: "waves"))"#, LAMP, ""], off: "normal maps: off: no reachable material names one" },
    Row { effect: Effect::BumpMaps,
        with: ["", r#""sand": (diffuse: 0.5, bump_map: (texture: "waves", height_m: 0.01))"#, LAMP, r#"(name: "dune", shape: box(), material: "sand")"#], on: "bump maps: on: `dune` (material `sand`) names `waves`",
        without: ["", r#""sand": (diffuse: 0.5, normal_map: (texture: "waves"))"#, LAMP, r#"(shape: box(), material: "sand")"#], off: "bump maps: off: no reachable material names one" },
    Row { effect: Effect::Caustics,
        with: ["", "", LAMP, BALL], on: "caustics: on: `lamp` shines on `ball`",
        without: ["", "", LAMP, ""], off: "caustics: off: no reachable material reflects or transmits" },
    Row { effect: Effect::Caustics,
        with: ["", "", LAMP, r#"(name: "pane", shape: box(), material: "mirror")"#], on: "caustics: on: `lamp` shines on `pane`",
        without: ["", "", "", BALL], off: "caustics: off: the scene has no light" },
    Row { effect: Effect::Caustics,
        with: ["photons: progressive(count: 1000),", "", LAMP, BALL], on: "caustics: on: `lamp` shines on `ball`",
        without: ["photons: off,", "", LAMP, BALL], off: "caustics: off: the scene says `photons: off`" },
    Row { effect: Effect::Indirect,
        with: ["indirect: 3,", "", LAMP, ""], on: "indirect: on: the scene asks for 3 bounces",
        without: ["", "", LAMP, ""], off: "indirect: off: the scene does not ask for it" },
    Row { effect: Effect::Environment,
        with: ["", "", SKY, ""], on: "environment: on: `sky` shines from all around",
        without: ["", "", LAMP, ""], off: "environment: off: no light is an environment" },
    Row { effect: Effect::Antialiasing,
        with: ["antialiasing: grid(3),", "", LAMP, ""], on: "antialiasing: on: grid: 3 × 3 samples a pixel and pass",
        without: ["antialiasing: none,", "", LAMP, ""], off: "antialiasing: off: none: one sample at the centre of each pixel" },
];

#[test]
fn the_one_thing_that_calls_for_an_effect_turns_it_on() {
    for row in TABLE {
        for (parts, expected) in [(row.with, row.on), (row.without, row.off)] {
            let [more, materials, lights, objects] = parts;
            let plan = own_plan(&scene(more, materials, lights, objects));
            assert_eq!(decision(&plan, row.effect).to_string(), expected);
        }
    }
}

#[test]
fn a_lens_calls_for_depth_of_field() {
    let text = scene("", "", LAMP, "");
    let lens = text.replace("target: (0, 0.4, 0)", "target: (0, 0.4, 0), aperture_m: 0.02");
    let said = |text: &str| decision(&own_plan(text), Effect::DepthOfField).to_string();
    assert_eq!(said(&lens), "depth of field: on: the camera's aperture is 0.02 m");
    assert_eq!(said(&text), "depth of field: off: the camera is a pinhole");
}

#[test]
fn caustics_need_something_that_can_show_them() {
    let text = scene("", "", LAMP, BALL);
    let black = text.replace(r#""matt": (diffuse: 0.6)"#, r#""matt": (diffuse: 0.6, reflection: 1)"#);
    let said = decision(&own_plan(&black), Effect::Caustics).to_string();
    assert_eq!(
        said,
        "caustics: off: nothing can show them: every reachable material only reflects, transmits or is black"
    );
    // Nor shadows, nor light from wall to wall.
    let indirect = black.replace("image:", "indirect: true, image:");
    for (effect, off) in [
        (Effect::Shadows, "shadows: off: nothing can show them: every"),
        (
            Effect::Indirect,
            "indirect: off: the scene asks for it (`indirect: true`), but nothing can show it: every",
        ),
    ] {
        let said = decision(&own_plan(&indirect), effect).to_string();
        assert!(said.starts_with(off), "{said}");
    }
    assert_eq!(own_plan(&indirect).bounces, 0);
    let dark = scene("indirect: 2,", "", "", BALL);
    assert_eq!(
        decision(&own_plan(&dark), Effect::Indirect).to_string(),
        "indirect: off: the scene asks for 2 bounces, but it has no light"
    );
    // One that is partly matt can.
    let partly = text.replace(r#""matt": (diffuse: 0.6)"#, r#""matt": (diffuse: 0.6, reflection: 0.9)"#);
    assert!(own_plan(&partly).is_on(Effect::Caustics));
}

/// What is placed by groups, definitions and scatter counts; what only carries others or is placed nowhere
/// does not.
#[test]
fn only_materials_of_placed_objects_count() {
    let placed = |objects: &str, definitions: &str| {
        let text = scene(&format!("definitions: {{ {definitions} }},"), "", LAMP, objects);
        decision(&own_plan(&text), Effect::Refraction).to_string()
    };
    let off = "refraction: off: no reachable material transmits";
    let glass = r#""drop": (shape: sphere(), material: "glass")"#;
    assert_eq!(placed("", glass), off);
    let on = |who: &str| format!("refraction: on: {who} (material `glass`) transmits, ior 1.5");
    assert_eq!(placed(r#"(shape: instance(of: "drop"))"#, glass), on("`drop`"));
    assert_eq!(placed(r#"(name: "dew", shape: instance(of: "drop"))"#, glass), on("`dew`"));
    assert_eq!(placed(r#"(shape: scatter(of: ["drop"], over: "floor", count: 3))"#, glass), on("`drop`"));
    // The group's material is taken by none of its objects.
    let group = |inner: &str| {
        format!(r#"(name: "things", shape: group(objects: [(shape: box(){inner})]), material: "glass")"#)
    };
    assert_eq!(placed(&group(r#", material: "matt""#), ""), off);
    assert_eq!(placed(&group(""), ""), on("`things`"));
    // A definition that carries is not seen itself.
    let carried = r#""hill": (shape: sphere(radius: 3), material: "glass"), "drop": (shape: sphere(radius: 0.1), material: "matt")"#;
    assert_eq!(placed(r#"(shape: scatter(of: ["drop"], over: "hill", count: 3))"#, carried), off);
}

#[test]
fn of_many_materials_two_are_told_and_the_rest_counted() {
    let materials: String = (0..5).map(|i| format!(r#""m{i}": (diffuse: 0.5, specular: 0.1), "#)).collect();
    let objects: String = (0..5).map(|i| format!(r#"(shape: box(), material: "m{i}"), "#)).collect();
    let plan = own_plan(&scene("", &materials, LAMP, &objects));
    assert_eq!(
        decision(&plan, Effect::Highlights).reason,
        "`objects.1` (material `m0`) is specular; `objects.2` (material `m1`) is specular; and 3 more materials"
    );
}

#[test]
fn there_is_one_decision_an_effect_in_order() {
    let plan = own_plan(&scene("", "", LAMP, BALL));
    assert_eq!(plan.decisions.iter().map(|d| d.effect).collect::<Vec<_>>(), Effect::ALL);
    assert_eq!(plan.text().lines().count(), Effect::ALL.len());
}
