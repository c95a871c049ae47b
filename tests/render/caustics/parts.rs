//! Parts of a render and of its light add up to the whole, whoever computes them.

use crate::render::shot::{Picture, Shot, focused as shot};
use terrarium::render::Aov;

const AOVS: [Aov; 8] = [
    Aov::Direct,
    Aov::Reflection,
    Aov::Refraction,
    Aov::Caustic,
    Aov::Indirect,
    Aov::Photons,
    Aov::PhotonDensity,
    Aov::Samples,
];

pub(crate) fn scene(antialiasing: &str, photons: &str) -> Shot {
    shot(format!(
        r#"(camera: (eye: (1, 2, 4), target: (0, 0.3, 0)), image: (width: 40, height: 30), antialiasing: {antialiasing},
        photons: {photons}, indirect: true,
        materials: {{ "floor": (diffuse: (0.7, 0.6, 0.5), specular: 0.1), "glass": (transmission: 1), "coat": (diffuse: 0.5, reflection: 0.3), "lamp": (emission: 5) }},
        lights: {{ "lamp": sphere(center: (-1, 4, 1), radius: 0.3, radiance: 40), "bulb": point(position: (2, 3, 0), intensity: 4) }},
        objects: [(shape: quad(size: (9, 9)), material: "floor"), (shape: sphere(radius: 0.5, center: (0.8, 0.6, 0)), material: "glass"),
                  (shape: box(size: (0.5, 1, 0.5), center: (-1, 0.5, -0.4)), material: "coat"),
                  (shape: polyhedron(kind: dodecahedron, radius: 0.4), material: "glass", transform: [translate((-0.3, 0.5, 1))])])"#
    ))
    .aovs(&AOVS)
}

pub(crate) const SMALL: &str = "progressive(count: 20000), indirect_by: paths";
pub(crate) const BY_PHOTONS: &str = "progressive(count: 20000), indirect_by: photons";

/// The mean of two halves, in single precision each, is the whole to its last bits.
#[test]
fn passes_that_are_rendered_apart_average_to_those_rendered_together() {
    for photons in [SMALL, BY_PHOTONS] {
        let render = |range| scene("progressive", photons).pass_range(range).render();
        averages(&render(0..8), &render(0..4), &render(4..8));
    }
}

fn averages(whole: &Picture, first: &Picture, second: &Picture) {
    let layers = whole.rendered.image.layers.iter().zip(&first.rendered.image.layers);
    for ((layer, a), b) in layers.zip(&second.rendered.image.layers) {
        if layer.name == "photons" {
            assert!(layer.channels == a.channels, "the dots are those of the first pass");
            continue;
        }
        // Samples add up, the rest are means.
        let share = if layer.name == "samples" { 1.0 } else { 0.5 };
        for (((_, w), (_, a)), (channel, b)) in layer.channels.iter().zip(&a.channels).zip(&b.channels) {
            for ((&whole, &a), &b) in w.iter().zip(a).zip(b) {
                let mean = share * (f64::from(a) + f64::from(b));
                let allowed = 2e-7 * f64::from(whole).abs();
                assert!(
                    (mean - f64::from(whole)).abs() <= allowed,
                    "{}.{channel}: {mean}, {whole}",
                    layer.name
                );
            }
        }
    }
    assert!(first.bits() != second.bits());
}

/// The single map is that of the first pass, whichever passes are rendered.
#[test]
fn the_single_map_is_the_same_for_any_passes() {
    let caustic = |range| {
        let picture = scene("none", "classic(count: 20000, k: 50)").pass_range(range).render();
        picture.rendered.stats.photons.photons.expect("there are photons").stored
    };
    assert_eq!(caustic(0..1), caustic(5..6));
}

#[test]
fn the_layers_of_light_add_up_to_the_picture_and_caustics_are_part_of_it() {
    for photons in [SMALL, BY_PHOTONS] {
        add_up(&scene("progressive", photons).passes(6).render());
    }
}

fn add_up(picture: &Picture) {
    for channel in ["R", "G", "B"] {
        let whole = picture.channel("", channel);
        let layer = |name: &str| picture.channel(name, channel);
        for (i, &whole) in whole.iter().enumerate() {
            let sum: f32 = ["direct", "reflection", "refraction"].iter().map(|n| layer(n)[i]).sum();
            assert!((sum - whole).abs() <= 1e-5 * whole.max(0.1), "{sum} and {whole}");
            let part = layer("caustic")[i] + layer("indirect")[i];
            assert!(part >= 0.0 && part <= whole * (1.0 + 1e-5), "{part} of {whole}");
        }
        for name in ["direct", "reflection", "refraction", "caustic", "indirect", "photons"] {
            assert!(layer(name).iter().any(|&x| x > 0.0), "{name} is black");
        }
    }
}

/// Without photons the picture is the same picture without its caustics.
#[test]
fn a_picture_less_its_caustics_is_the_picture_without_photons() {
    let of = |photons: &str| {
        let mut shot = scene("progressive", &format!("{photons}, indirect_by: paths")).passes(4);
        shot = shot.aovs(&[Aov::Caustic, Aov::Indirect]);
        shot.render()
    };
    let (with, without) = (of("progressive(count: 20000)"), of("off"));
    let grey = |p: &Picture, layer: &str| p.channel(layer, "R").to_vec();
    let (whole, caustic, indirect) = (grey(&with, ""), grey(&with, "caustic"), grey(&with, "indirect"));
    let (plain, plain_indirect) = (grey(&without, ""), grey(&without, "indirect"));
    for i in 0..whole.len() {
        // Indirect light has its own caustics in it.
        let rest = whole[i] - caustic[i] - indirect[i];
        let expected = plain[i] - plain_indirect[i];
        assert!((rest - expected).abs() <= 2e-5 * whole[i].max(0.1), "{rest} and {expected}");
    }
}
