//! Where nothing is focused there are no photons, and no light goes through what is opaque.

use crate::render::shot::{Picture, Shot, focused as shot};
use terrarium::render::Aov;

fn scene(photons: &str, materials: &str, lights: &str, objects: &str) -> Shot {
    shot(format!(
        r#"(camera: (eye: (1, 2, 4), target: (0, 0.3, 0)), image: (width: 24, height: 16), indirect: true, indirect_by: paths, photons: {photons},
        materials: {{ "white": (diffuse: 0.7, specular: 0.1), {materials} }}, lights: {{ {lights} }},
        objects: [(shape: quad(size: (9, 9)), material: "white"), {objects}])"#
    ))
    .aovs(&[Aov::Caustic, Aov::Photons, Aov::PhotonDensity])
    .passes(2)
}

const LAMPS: &str = r#""a": point(position: (0, 3, 0), intensity: 5), "b": sphere(center: (1, 3, 0), radius: 0.3, radiance: 5),
    "sun": directional(direction: (1, -2, 0), irradiance: 1), "sky": environment(map: constant(0.5))"#;

#[track_caller]
fn assert_no_photons(picture: &Picture) {
    assert!(picture.rendered.stats.photons.photons.is_none());
    assert_eq!(picture.rendered.stats.memory.photons_bytes, 0);
    for layer in ["caustic", "photons"] {
        for channel in ["R", "G", "B"] {
            assert!(picture.channel(layer, channel).iter().all(|x| x.to_bits() == 0), "{layer}");
        }
    }
    assert!(picture.channel("photon_density", "Y").iter().all(|x| x.to_bits() == 0));
    assert!(picture.mean() > 0.0);
}

/// S3.
#[test]
fn a_scene_without_mirrors_and_glass_has_no_caustic_and_no_photons() {
    let ball = r#"(shape: sphere(center: (0, 0.5, 0), radius: 0.5), material: "white")"#;
    assert_no_photons(&scene("progressive()", "", LAMPS, ball).render());
}

#[test]
fn photons_that_are_off_leave_plain_shadows() {
    let ball = r#"(shape: sphere(center: (0, 0.5, 0), radius: 0.5), material: "glass")"#;
    let picture = scene("off", r#""glass": (transmission: 1)"#, LAMPS, ball).render();
    assert_no_photons(&picture);
    let on = scene("progressive()", r#""glass": (transmission: 1)"#, LAMPS, ball).render();
    assert!(on.rendered.stats.photons.photons.as_ref().is_some_and(|p| p.stored > 1000));
    assert!(on.mean() > picture.mean());
}

/// H14.
#[test]
fn an_object_of_the_index_of_its_surroundings_emits_no_photons_and_is_not_there() {
    let ball = r#"(shape: sphere(center: (0, 0.5, 0), radius: 0.5), material: "air")"#;
    let with = scene("progressive()", r#""air": (transmission: 1, ior: 1)"#, LAMPS, ball).render();
    assert_no_photons(&with);
    assert!(with.bits() == scene("progressive()", "", LAMPS, "").render().bits());
}

#[test]
fn a_light_that_shines_away_from_all_glass_sends_no_photons() {
    let spot = r#""a": spot(position: (0, 3, 0), target: (0, 9, 0), intensity: 5, inner_deg: 20, outer_deg: 30),
        "b": point(position: (3, 3, 0), intensity: 1)"#;
    let ball = r#"(shape: sphere(center: (0, 0.5, 0), radius: 0.5), material: "glass")"#;
    let picture = scene("progressive()", r#""glass": (transmission: 1)"#, spot, ball).render();
    let lights = picture.rendered.stats.photons.photons.expect("one light reaches the ball").lights;
    let share = |name: &str| lights.iter().find(|l| l.name == name).map_or(f64::NAN, |l| l.share);
    assert!(share("a") == 0.0 && (share("b") - 1.0).abs() < 1e-9, "{lights:?}");
    let alone = spot.split("\"b\"").next().expect("it is there");
    let picture = scene("progressive()", r#""glass": (transmission: 1)"#, alone, ball).render();
    assert!(picture.rendered.stats.photons.photons.as_ref().is_none_or(|p| p.stored == 0));
    assert!(picture.channel("caustic", "R").iter().all(|&x| x == 0.0));
}
