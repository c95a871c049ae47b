//! Every path of light belongs to one effect, so that the image is the sum of its effects.

use super::lab::{only, render, scene, without};
use crate::render::shot::Picture;
use terrarium::plan::{Effect, Overrides};

const PARTS: [Effect; 7] = [
    Effect::Direct,
    Effect::Reflection,
    Effect::Refraction,
    Effect::Highlights,
    Effect::Caustics,
    Effect::Indirect,
    Effect::Environment,
];

/// A scene with something of everything; a single sample a pixel, so that no branch ends by chance.
fn everything(more: &str) -> String {
    let materials = r#""shiny": (diffuse: 0.5, specular: 0.3, shininess: 20), "half": (diffuse: 0.5, reflection: 0.5),
        "hot": (emission: 2), "tea": (transmission: 0.7, ior: 1.4, diffuse: 0.5, absorption: (0.1, 0.5, 1))"#;
    let objects = r#"(shape: sphere(radius: 0.5, center: (-0.6, 0.6, 0.4)), material: "glass"),
        (shape: sphere(radius: 0.5, center: (0.6, 0.6, 0)), material: "half"),
        (shape: box(size: (0.4, 0.4, 0.4)), material: "tea", transform: [translate((0, 0.3, 1))]),
        (shape: box(size: (3, 3, 0.1)), material: "shiny", transform: [translate((0, 1, -1.5))]),
        (shape: sphere(radius: 0.2, center: (0, 1.2, -0.5)), material: "hot")"#;
    let lights = r#""lamp": sphere(center: (1, 4, 2), radius: 0.3, radiance: 90), "sun": directional(direction: (1, -2, -1), irradiance: 1),
        "sky": environment(map: gradient(zenith: 1, horizon: 0.5, nadir: 0.1))"#;
    scene(&format!("background: 0.2, ambient: 0.05, {more}"), materials, lights, objects)
}

/// Whether `parts` add up to `whole`: the largest error as a share of the brightest pixel.
fn error(whole: &Picture, parts: &[Picture]) -> f64 {
    let greys: Vec<Vec<f64>> = parts.iter().map(Picture::grey).collect();
    let whole = whole.grey();
    let brightest = whole.iter().copied().fold(0.0, f64::max);
    let off = |(i, x): (usize, &f64)| (greys.iter().map(|g| g[i]).sum::<f64>() - x).abs();
    whole.iter().enumerate().map(off).fold(0.0, f64::max) / brightest
}

#[test]
fn the_image_is_the_sum_of_its_effects() {
    for more in [
        "antialiasing: grid(2), indirect: 2, indirect_by: paths,",
        "antialiasing: none, indirect: true, indirect_by: photons,",
    ] {
        let text = everything(more);
        let whole = render(&text, &Overrides::default());
        let parts: Vec<Picture> = PARTS.iter().map(|&e| render(&text, &only(&[e]))).collect();
        for (part, effect) in parts.iter().zip(PARTS) {
            assert!(part.mean() > 0.0, "{effect} brings light");
        }
        let error = error(&whole, &parts);
        assert!(error < 1e-6, "{error:e} with {more}");
        // Of several at once: the sum of theirs.
        let some = render(&text, &only(&PARTS[..3]));
        assert!(self::error(&some, &parts[..3]) < 1e-6);
    }
}

/// Nothing else changes: what is left and what was left out are the whole, where paths use it once.
#[test]
fn leaving_out_takes_away_that_light_alone() {
    let floor = scene(
        "antialiasing: none, indirect: 1, indirect_by: paths,",
        r#""wax": (diffuse: 0.4, specular: 0.3)"#,
        r#""lamp": point(position: (1, 4, 2), intensity: 40), "sky": environment(map: constant(0.5))"#,
        r#"(shape: box(size: (3, 3, 0.1)), material: "wax", transform: [translate((0, 1, -1.5))])"#,
    );
    let whole = render(&floor, &Overrides::default());
    for effect in [Effect::Direct, Effect::Indirect] {
        let parts = [render(&floor, &without(&[effect])), render(&floor, &only(&[effect]))];
        // What shines by itself is seen in both; here nothing does.
        assert!(error(&whole, &parts) < 1e-6, "{effect}");
    }
}

/// The layers of the same names are the same light.
#[test]
fn reflection_and_refraction_alone_are_their_layers() {
    use terrarium::render::Aov;
    let text = everything("antialiasing: none,");
    let mut shot = super::lab::shot(&text, &Overrides::default());
    shot.options.aovs = vec![Aov::Reflection, Aov::Refraction];
    let layers = shot.render();
    for (effect, layer) in [(Effect::Reflection, "reflection"), (Effect::Refraction, "refraction")] {
        let alone = render(&text, &only(&[effect]));
        assert!(alone.channel("", "R") == layers.channel(layer, "R"), "{effect}");
    }
}

/// What an override makes needless does not run.
#[test]
fn what_is_not_named_is_not_traced() {
    let text = everything("antialiasing: none,");
    let direct = render(&text, &only(&[Effect::Direct])).rendered;
    let rays = direct.stats.rays;
    assert_eq!((rays.reflection, rays.refraction, rays.diffuse), (0, 0, 0));
    assert!(direct.stats.photons.photons.is_none());
    assert!(rays.shadow > 0);
    let seen = render(&text, &without(&[Effect::Reflection])).rendered.stats.rays;
    assert_eq!(seen.reflection, 0);
    assert!(seen.refraction > 0);
    let caustics = render(&text, &only(&[Effect::Caustics])).rendered;
    assert_eq!(caustics.stats.rays.shadow, 0);
    assert!(caustics.stats.photons.photons.is_some_and(|p| p.stored > 0));
}
