//! Seeds, layers, passes and languages: what changes the bits of a picture, and what does not.

use super::meshes::folder;
use super::shot::{Picture, Shot, assert_close, shot};
use std::path::Path;
use terrarium::description::{Format, load_str, to_string};
use terrarium::render::{Aov, Silent, render};

pub(crate) fn scene(antialiasing: &str) -> Shot {
    shot(format!(
        r#"(camera: (eye: (1, 2, 4), target: (0, 0.3, 0), aperture_m: 0.05), image: (width: 40, height: 20), antialiasing: {antialiasing},
        textures: {{ "tiles": checker(a: 0.8, b: 0.3, squares: (9, 9)), "stone": noise(a: 0.1, b: 0.8, size_m: 0.3) }},
        materials: {{ "floor": (diffuse: texture("tiles"), specular: 0.1), "stone": (diffuse: texture("stone"), reflection: 0.2), "glass": (transmission: 1) }},
        lights: {{ "lamp": sphere(center: (-1, 4, 1), radius: 0.5, radiance: 9), "sky": environment(map: gradient(zenith: 0.4, horizon: 0.2, nadir: 0)) }},
        objects: [(shape: quad(size: (9, 9)), material: "floor"), (shape: sphere(radius: 0.4, center: (1, 0.4, 0)), material: "glass"),
                  (shape: cone(), material: "stone"), (shape: polyhedron(kind: dodecahedron, radius: 0.4), material: "glass", transform: [translate((0.4, 0.5, 1.2))])])"#
    ))
}

pub(crate) fn exr(picture: &Picture, folder: &Path) -> Vec<u8> {
    let path = folder.join("picture.exr");
    let mut file = std::io::Cursor::new(Vec::new());
    terrarium::output::exr::write(&mut file, &picture.rendered.image, &picture.rendered.provenance)
        .unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    file.into_inner()
}

#[test]
fn another_seed_is_another_picture_of_the_same_mean() {
    let render = |seed| scene("progressive").passes(32).seed(seed).render();
    let (a, b) = (render(1), render(2));
    assert!(a.bits() != b.bits());
    assert!(a.bits() == render(1).bits());
    assert_close(a.mean(), b.mean(), 0.01);
}

/// Layers on request do not change the picture.
#[test]
fn asking_for_layers_changes_no_pixel() {
    let plain = scene("progressive").passes(2).render();
    let rich = scene("progressive").passes(2).aovs(&[Aov::Direct, Aov::Normal, Aov::Variance]).render();
    assert!(plain.rgb() == rich.rgb());
}

/// The mean of n passes is made of the same passes as that of fewer.
#[test]
fn the_mean_of_two_passes_is_that_of_the_first_and_the_second() {
    let one = scene("progressive").passes(1).render();
    let two = scene("progressive").passes(2).render();
    let three = scene("progressive").passes(3).render();
    // From means of 1 and 2 passes the second pass; all of them are not negative.
    for ((a, b), c) in one.grey().into_iter().zip(two.grey()).zip(three.grey()) {
        assert!(2.0 * b - a >= -1e-5 * a.max(b), "the second pass would be {}", 2.0 * b - a);
        assert!(3.0 * c - 2.0 * b >= -1e-5 * b.max(c));
    }
}

#[test]
fn ron_and_toml_and_their_conversions_render_the_same_bytes() {
    let dir = folder();
    let ron = r#"(camera: (eye: (1, 2, 4), target: (0, 0.3, 0)), image: (width: 24, height: 16),
        materials: { "floor": (diffuse: (0.7, 0.6, 0.5)), "glass": (transmission: 1, ior: "water") },
        lights: { "lamp": sphere(center: (-1, 4, 1), radius: 0.5, radiance: 9) },
        objects: [(shape: quad(size: (9, 9)), material: "floor"), (shape: sphere(), material: "glass", transform: [scale(0.4), translate((0, 0.5, 0))])])"#;
    let toml = r#"
        camera = { eye = [1, 2, 4], target = [0, 0.3, 0] }
        image = { width = 24, height = 16 }
        [materials]
        floor = { diffuse = [0.7, 0.6, 0.5] }
        glass = { transmission = 1, ior = "water" }
        [lights.lamp.sphere]
        center = [-1, 4, 1]
        radius = 0.5
        radiance = 9
        [[objects]]
        shape.quad = { size = [9, 9] }
        material = "floor"
        [[objects]]
        shape.sphere = {}
        material = "glass"
        transform = [{ scale = 0.4 }, { translate = [0, 0.5, 0] }]
    "#;
    let bytes = |text: &str, format| {
        let loaded = load_str(text, format, Path::new(""), &[]).unwrap_or_else(|e| panic!("{e:?}\n{text}"));
        let options = terrarium::render::Options { passes: Some(0..2), ..Default::default() };
        let rendered = render(&loaded, &options, &Silent).expect("it renders");
        (exr(&Picture { rendered }, dir.path()), loaded.scene)
    };
    let (first, scene) = bytes(ron, Format::Ron);
    let (second, other) = bytes(toml, Format::Toml);
    assert!(scene == other);
    assert!(first == second);
    for format in [Format::Ron, Format::Toml] {
        let text = to_string(&scene, format).expect("it can be written");
        assert!(bytes(&text, format).0 == first, "{text}");
    }
}
