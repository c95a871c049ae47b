//! What may be left out and added, what is refused, and what the plan says of it.

use super::lab::{BALL, LAMP, decision, only, own_plan, plan, render, scene, with, without};
use terrarium::plan::{Cause, Effect, Overrides};

fn glassy() -> String {
    scene("", "", LAMP, BALL)
}

#[track_caller]
fn refused(overrides: &Overrides, expected: &str) {
    let message = plan(&glassy(), overrides).expect_err("a refusal").0;
    assert!(message.contains(expected), "{message}");
}

#[test]
fn contradictions_and_the_impossible_are_refused_with_the_reason() {
    refused(&without(&[Effect::NestedMedia]), "nested_media can't be left out");
    refused(&only(&[Effect::Textures]), "leave it out by --without textures");
    refused(&only(&[Effect::NestedMedia]), "nested_media shapes it: it is always there");
    refused(
        &Overrides { with: vec![Effect::Indirect], ..without(&[Effect::Indirect]) },
        "indirect is in --with and in --without",
    );
    refused(
        &Overrides { without: vec![Effect::Direct], ..only(&[Effect::Direct]) },
        "--only and in --without",
    );
    refused(
        &Overrides { with: vec![Effect::Indirect], ..only(&[Effect::Direct]) },
        "name indirect in --only too",
    );
    refused(&with(&[Effect::DepthOfField]), "depth_of_field needs `camera.aperture_m`");
    refused(&with(&[Effect::Dispersion]), "dispersion needs an object whose material has `dispersion`");
    let message = plan(&scene("", "", LAMP, ""), &with(&[Effect::Caustics])).expect_err("a refusal").0;
    assert!(message.contains("caustics needs a light, a mirror or glass"), "{message}");
}

#[test]
fn what_is_on_already_is_not_added_and_what_is_off_already_is_noted() {
    let scene = glassy();
    let added = plan(&scene, &with(&[Effect::Caustics, Effect::Direct])).expect("both are on");
    assert_eq!(added.decisions, own_plan(&scene).decisions);
    let left = plan(&scene, &without(&[Effect::Textures])).expect("that is no mistake");
    assert_eq!(left.notes, ["--without textures leaves out nothing: no reachable material names a texture"]);
}

/// What the scene lacks is off for its own reason, whatever the overrides take away beside it.
#[test]
fn the_reason_for_what_is_off_is_the_scenes_own() {
    let sky = r#""sky": environment(map: constant(1))"#;
    let alone = plan(&scene("", "", sky, BALL), &only(&[Effect::Direct])).expect("it carries light");
    assert_eq!(decision(&alone, Effect::Direct).reason, "the sky is the only light");
    let lamp = plan(&glassy(), &without(&[Effect::Direct])).expect("it may be left out");
    assert_eq!(
        decision(&lamp, Effect::Shadows).reason,
        "with `without direct` no surface looks for a lamp or a sky"
    );
    let grey = r#""dim": (transmission: 1, ior: 1, absorption: 3)"#;
    let ball = r#"(name: "fog", shape: sphere(radius: 0.5), material: "dim")"#;
    let clear =
        plan(&scene("", grey, LAMP, ball), &without(&[Effect::Absorption])).expect("it may be left out");
    let refraction = decision(&clear, Effect::Refraction);
    assert_eq!(refraction.cause, Cause::Overridden);
    assert!(refraction.reason.starts_with("nothing is left of it with `without absorption`"), "{refraction}");
    let error = "nothing".parse::<Effect>().expect_err("no such effect");
    assert!(!error.contains("nested_media") && !error.contains("did you mean"), "{error}");
}

#[test]
fn the_plan_says_what_was_overridden() {
    let plan = plan(&glassy(), &without(&[Effect::Caustics, Effect::Shadows])).expect("it may be left out");
    let caustics = decision(&plan, Effect::Caustics);
    assert_eq!(caustics.to_string(), "caustics: off: left out (--without); else on: `lamp` shines on `ball`");
    assert_eq!(caustics.cause, Cause::Overridden);
    assert!(plan.text().ends_with("overrides: without caustics, shadows\n"), "{}", plan.text());
    assert!(plan.photons.is_none());
}

#[test]
fn photons_and_bounces_that_the_scene_turns_off_can_be_added() {
    let asked = scene("", "", LAMP, BALL);
    let off = scene("photons: off,", "", LAMP, BALL);
    let added = with(&[Effect::Caustics]);
    assert_eq!(decision(&plan(&off, &added).expect("it can be"), Effect::Caustics).cause, Cause::Overridden);
    assert!(render(&off, &added).bits() == render(&asked, &Overrides::default()).bits());
    let bounced = scene("indirect: true,", "", LAMP, BALL);
    assert!(
        render(&asked, &with(&[Effect::Indirect])).bits() == render(&bounced, &Overrides::default()).bits()
    );
}

/// An override that a scene can say is the same as that scene, bit for bit.
#[test]
fn leaving_out_is_the_same_as_the_edited_scene() {
    let materials = r#""tea": (transmission: 1, ior: 1.33, absorption: (1, 2, 3), dispersion: abbe(30)),
        "wall": (diffuse: 0.5, specular: 0.3, normal_map: (texture: "waves"), bump_map: (texture: "waves", height_m: 0.02))"#;
    let objects = r#"(shape: sphere(radius: 0.6, center: (0, 0.7, 0)), material: "tea"),
        (shape: box(size: (2, 2, 0.2)), material: "wall", transform: [translate((0, 1, -1))])"#;
    let lights = r#""lamp": sphere(center: (1, 4, 2), radius: 0.3, radiance: 90), "sky": environment(map: constant(0.3), visible: false)"#;
    let text = scene("indirect: 2, indirect_by: paths,", materials, lights, objects)
        .replace("target: (0, 0.4, 0)", "target: (0, 0.4, 0), aperture_m: 0.1");
    let edits = [
        (Effect::Absorption, ", absorption: (1, 2, 3)", ""),
        (Effect::Dispersion, ", dispersion: abbe(30)", ""),
        (Effect::Highlights, ", specular: 0.3", ""),
        (Effect::NormalMaps, r#", normal_map: (texture: "waves")"#, ""),
        (Effect::BumpMaps, r#", bump_map: (texture: "waves", height_m: 0.02)"#, ""),
        (Effect::DepthOfField, ", aperture_m: 0.1", ""),
        (Effect::Indirect, "indirect: 2, indirect_by: paths,", ""),
        (Effect::Environment, r#", "sky": environment(map: constant(0.3), visible: false)"#, ""),
        (Effect::Caustics, "indirect: 2,", "indirect: 2, photons: off,"),
        (Effect::Antialiasing, "indirect: 2,", "indirect: 2, antialiasing: none,"),
    ];
    let whole = render(&text, &Overrides::default()).bits();
    for (effect, from, to) in edits {
        assert!(text.contains(from), "{from}");
        let left = render(&text, &without(&[effect])).bits();
        assert!(left == render(&text.replacen(from, to, 1), &Overrides::default()).bits(), "{effect}");
        assert!(left != whole, "{effect} changes something");
    }
}

/// A texture's mean: a checker of equally many squares is half way between its colours.
#[test]
fn textures_that_are_left_out_are_their_mean_colour() {
    let tiled = scene(
        "",
        r#""tiled": (diffuse: texture(name: "tiles", scale: 0.5))"#,
        LAMP,
        r#"(shape: box(), material: "tiled")"#,
    );
    let plain = tiled.replace(r#"texture(name: "tiles", scale: 0.5)"#, "0.25");
    let left = render(&tiled, &without(&[Effect::Textures]));
    let (left, plain) = (left.grey(), render(&plain, &Overrides::default()).grey());
    for (a, b) in left.iter().zip(&plain) {
        assert!((a - b).abs() <= 1e-6 * b, "{a} and {b}");
    }
}

/// The middle of a sphere light seen from afar: the light of a point of the same intensity, and one ray.
#[test]
fn without_soft_shadows_a_lamp_is_lit_from_its_middle() {
    let wide = scene(
        "antialiasing: none,",
        "",
        r#""lamp": sphere(center: (0, 30, 0), radius: 1, radiance: 300)"#,
        r#"(shape: disk(radius: 0.5), material: "matt", transform: [translate((0, 1, 0))])"#,
    );
    let point = wide.replace(
        "sphere(center: (0, 30, 0), radius: 1, radiance: 300)",
        "point(position: (0, 30, 0), intensity: 942.4778)",
    );
    let hard = render(&wide, &without(&[Effect::SoftShadows]));
    let (a, b) = (hard.grey(), render(&point, &Overrides::default()).grey());
    let close = a.iter().zip(&b).filter(|(a, b)| (*a - *b).abs() <= 0.01 * b.abs()).count();
    assert!(close as f64 > 0.97 * a.len() as f64, "{close} of {}", a.len());
    let soft = render(&wide, &Overrides::default());
    assert!(soft.rendered.stats.rays.shadow > 8 * hard.rendered.stats.rays.shadow);
}

/// Without shadows the floor under a roof is as bright as in the open, and no shadow ray is traced.
#[test]
fn without_shadows_nothing_hides_a_lamp() {
    let roof =
        r#"(name: "roof", shape: disk(radius: 9), material: "matt", transform: [translate((0, 9, 0))])"#;
    let lamp = r#""lamp": point(position: (0, 10, 0), intensity: 40)"#;
    let covered = scene("antialiasing: none,", "", lamp, roof);
    let lit = render(&covered, &without(&[Effect::Shadows]));
    assert!(lit.bits() == render(&scene("antialiasing: none,", "", lamp, ""), &Overrides::default()).bits());
    assert_eq!(lit.rendered.stats.rays.shadow, 0);
    assert!(lit.mean() > 0.0);
    assert_eq!(render(&covered, &Overrides::default()).mean(), 0.0);
}
