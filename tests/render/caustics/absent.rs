//! Where nothing is focused there are no photons, and no light goes through what is opaque.

use crate::render::shot::{Picture, Shot, focused as shot};
use terrarium::render::Aov;

pub(crate) fn scene(photons: &str, materials: &str, lights: &str, objects: &str) -> Shot {
    shot(format!(
        r#"(camera: (eye: (1, 2, 4), target: (0, 0.3, 0)), image: (width: 24, height: 16), indirect: true, indirect_by: paths, photons: {photons},
        materials: {{ "white": (diffuse: 0.7, specular: 0.1), {materials} }}, lights: {{ {lights} }},
        objects: [(shape: quad(size: (9, 9)), material: "white"), {objects}])"#
    ))
    .aovs(&[Aov::Caustic, Aov::Photons, Aov::PhotonDensity])
    .passes(2)
}

pub(crate) const LAMPS: &str = r#""a": point(position: (0, 3, 0), intensity: 5), "b": sphere(center: (1, 3, 0), radius: 0.3, radiance: 5),
    "sun": directional(direction: (1, -2, 0), irradiance: 1), "sky": environment(map: constant(0.5))"#;

/// How many values of the layers that photons fill are not +0, and how many there are.
pub(crate) fn photon_layers(picture: &Picture) -> (u64, u64) {
    let colours = ["caustic", "photons"].into_iter().flat_map(|layer| ["R", "G", "B"].map(|c| (layer, c)));
    let (mut lit, mut values) = (0, 0);
    for (layer, channel) in colours.chain([("photon_density", "Y")]) {
        let found = picture.channel(layer, channel);
        lit += found.iter().filter(|x| x.to_bits() != 0).count() as u64;
        values += found.len() as u64;
    }
    (lit, values)
}

#[track_caller]
fn assert_no_photons(picture: &Picture) {
    assert!(picture.rendered.stats.photons.photons.is_none());
    assert_eq!(picture.rendered.stats.memory.photons_bytes, 0);
    assert_eq!(photon_layers(picture).0, 0);
    assert!(picture.mean() > 0.0);
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
