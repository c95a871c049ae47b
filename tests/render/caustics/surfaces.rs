//! Photons stay on the side and within the edges of the surface that they fell on.

use super::lab::mean_of;
use crate::render::meshes::{cube, folder, icosphere};
use crate::render::shot::{Shot, focused as shot};
use std::path::Path;
use terrarium::render::Aov;

/// A wall at x = 0, lit from +x through a pane, seen from `eye_x`.
fn wall(eye_x: f64, wall: &str) -> Shot {
    shot(format!(
        r#"(camera: (eye: ({eye_x}, 0.1, 0), target: (0, 0, 0), fov_deg: 40), image: (width: 24, height: 24),
        photons: progressive(count: 20000),
        materials: {{ "white": (diffuse: 1, specular: 0), "glass": (transmission: 1) }},
        lights: {{ "sun": directional(direction: (-1, 0, 0), irradiance: 1), "lamp": point(position: (3, 0, 0), intensity: 9) }},
        objects: [{wall}, (shape: box(size: (0.1, 1, 1), center: (0.6, 0, 0)), material: "glass")])"#
    ))
    .aovs(&[Aov::Caustic])
    .passes(4)
}

/// The brightest pixel of the side that the sun does not reach, behind a wall whose other side is lit.
pub(crate) fn dark_side(shape: &str) -> f64 {
    let lit = wall(0.4, shape).render();
    assert!(mean_of(&lit, "caustic") > 0.1, "{shape}");
    wall(-3.0, shape).render().rgb().into_iter().flatten().map(f64::from).fold(0.0, f64::max)
}

#[test]
fn light_on_one_side_of_a_wall_leaves_the_other_side_black() {
    for shape in [
        r#"(shape: quad(size: (6, 6)), material: "white", transform: [rotate(axis: (0, 0, 1), deg: 90)])"#,
        r#"(shape: quad(size: (6, 6)), material: "white", transform: [rotate(axis: (0, 0, 1), deg: -90)])"#,
        r#"(shape: box(size: (1e-3, 6, 6)), material: "white")"#,
    ] {
        assert_eq!(dark_side(shape), 0.0, "{shape}");
    }
}

/// A small plate beneath a wide pane, seen from between them; it fills the picture.
fn plate(folder: &Path, object: &str, photons: &str) -> Vec<f64> {
    let picture = shot(format!(
        r#"(camera: (eye: (0, 0.45, 0), target: (0, 0, 0), up: (0, 0, -1), fov_deg: 47.9249), image: (width: 40, height: 40),
        photons: {photons},
        materials: {{ "white": (diffuse: 1), "glass": (transmission: 1) }},
        lights: {{ "sun": directional(direction: (0, -1, 0), irradiance: 1) }},
        objects: [{object}, (shape: box(size: (3, 0.1, 3), center: (0, 0.55, 0)), material: "glass")])"#
    ))
    .folder(folder)
    .aovs(&[Aov::Caustic])
    .passes(32)
    .render();
    picture.channel("caustic", "R").iter().map(|&x| f64::from(x)).collect()
}

/// Means over the pixels that `of` picks, in metres from the plate's middle.
fn mean(values: &[f64], of: impl Fn(f64, f64) -> bool) -> f64 {
    let at = |i: usize| 0.2 * ((i as f64 + 0.5) / 20.0 - 1.0);
    let picked: Vec<f64> =
        values.iter().enumerate().filter(|(i, _)| of(at(i % 40), at(i / 40))).map(|(_, &v)| v).collect();
    picked.iter().sum::<f64>() / picked.len() as f64
}

/// Plates of the same size: a name, and the object.
pub(crate) fn plates(folder: &Path) -> [(&'static str, String); 3] {
    cube().scaled(0.2).write(&folder.join("cube.obj"));
    [
        ("a quad", r#"(shape: quad(size: (0.4, 0.4)), material: "white")"#),
        ("a box", r#"(shape: box(size: (0.4, 0.1, 0.4), center: (0, -0.05, 0)), material: "white")"#),
        (
            "a mesh",
            r#"(shape: mesh(path: "cube.obj", smooth: false), material: "white", transform: [translate((0, -0.2, 0))])"#,
        ),
    ]
    .map(|(name, object)| (name, object.to_owned()))
}

/// Of a plate in even light: edges over its middle, corners over it, and the middle over the closed form.
pub(crate) fn evenness(folder: &Path, object: &str, photons: &str) -> [f64; 3] {
    let values = plate(folder, object, photons);
    let middle = mean(&values, |x, y| x.abs().max(y.abs()) < 0.1);
    let edges = mean(&values, |x, y| x.abs().max(y.abs()) > 0.18);
    let corners = mean(&values, |x, y| x.abs().min(y.abs()) > 0.17);
    [edges / middle, corners / middle, middle / (0.923_077 / std::f64::consts::PI)]
}

#[test]
fn one_map_for_all_passes_is_even_up_to_edges_and_corners_too() {
    let dir = folder();
    for (name, object) in plates(dir.path()) {
        let [edges, corners, middle] = evenness(dir.path(), &object, "classic(count: 100000, k: 100)");
        assert!((middle - 1.0).abs() < 0.03, "{name}: {middle}");
        assert!((edges - 1.0).abs() < 0.05, "{name}: edges {edges}");
        assert!((corners - 1.0).abs() < 0.08, "{name}: corners {corners}");
    }
}

#[test]
fn a_disk_in_even_light_is_even_up_to_its_rim() {
    let values =
        plate(Path::new(""), r#"(shape: disk(radius: 0.2), material: "white")"#, "progressive(count: 20000)");
    let middle = mean(&values, |x, y| x.hypot(y) < 0.1);
    let rim = mean(&values, |x, y| (0.175..0.19).contains(&x.hypot(y)));
    assert!((rim / middle - 1.0).abs() < 0.05, "{}", rim / middle);
}

/// Photons are counted by area of the facets, shadow rays by the bent normals; both show the same, but for
/// what the estimate loses across the edges between facets, which goes with the size of a pixel.
#[test]
fn a_smooth_mesh_is_lit_by_photons_as_by_shadow_rays() {
    let dir = folder();
    icosphere(2).write(&dir.path().join("ball.obj"));
    let render = |pane: &str, smooth: bool| {
        let picture = shot(format!(
            r#"(camera: (eye: (0, 1.9, 0), target: (0, 0, 0), up: (0, 0, -1), fov_deg: 50), image: (width: 80, height: 80),
            photons: progressive(count: 200000),
            materials: {{ "white": (diffuse: 1), "glass": (transmission: 1) }},
            lights: {{ "sun": directional(direction: (0, -1, 0), irradiance: 1) }},
            objects: [(shape: mesh(path: "ball.obj", smooth: {smooth}), material: "white") {pane}])"#
        ))
        .folder(dir.path())
        .passes(6)
        .render();
        picture.grey()
    };
    let pane = r#", (shape: box(size: (1.4, 0.1, 1.4), center: (0, 2, 0)), material: "glass")"#;
    for smooth in [true, false] {
        let (direct, photons) = (render("", smooth), render(pane, smooth));
        let ratio = photons.iter().sum::<f64>() / direct.iter().sum::<f64>();
        println!("smooth: {smooth}: {ratio}");
        assert!((ratio / 0.923_077 - 1.0).abs() < 0.01, "smooth: {smooth}: {ratio}");
    }
}
