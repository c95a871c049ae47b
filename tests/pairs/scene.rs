//! The levels of every factor, and the scene of a row.

use crate::render::meshes::{icosphere, write_exr};
use tempfile::TempDir;

/// Factors with their numbers of levels.
pub const FACTORS: [(&str, usize); 6] = [
    ("light", LIGHTS.len()),
    ("material", MATERIALS.len()),
    ("shape", SHAPES.len()),
    ("antialiasing", ANTIALIASING.len()),
    ("effect", EFFECTS.len()),
    ("photons", PHOTONS.len()),
];

/// Those with an extent shine with a radiance of 1.
const LIGHTS: [&str; 11] = [
    "point(position: (1.5, 3, 2), intensity: 9)",
    "point(position: (1.5, 3, 2), intensity: 9, falloff: (1, 0.2, 0.5))",
    "spot(position: (1.5, 3, 2), target: (0, 0.5, 0), intensity: 9)",
    "directional(direction: (-0.4, -1, -0.3), irradiance: 2)",
    "sphere(center: (1.5, 3, 2), radius: 0.6, radiance: 1)",
    "quad(corner: (-1, 3, -1), edge_u: (2, 0, 0), edge_v: (0, 0, 2), radiance: 1)",
    "disk(center: (1, 3, 1), normal: (-0.2, -1, -0.2), radius: 1, radiance: 1, two_sided: true)",
    "environment(map: gradient(zenith: 1, horizon: 0.5, nadir: 0.1))",
    r#"environment(map: image(path: "sky.exr"))"#,
    // An object that emits, and a mesh that does.
    "",
    "mesh",
];

/// Of these many lights from the start, no radiance is a bound of the picture's.
const WITHOUT_EXTENT: usize = 4;

const MATERIALS: [&str; 10] = [
    "diffuse: 0.7",
    r#"diffuse: texture("tiles")"#,
    "diffuse: 0.5, specular: 0.3, shininess: 30",
    "reflection: 0.9",
    "transmission: 1",
    "transmission: 1, ior: 1.33, absorption: (0.5, 0.2, 0.1)",
    "transmission: 1, ior: 1.62, dispersion: abbe(36)",
    r#"diffuse: 0.6, normal_map: (texture: "waves", strength: 0.3)"#,
    r#"transmission: 0.7, diffuse: 0.5, reflection: 0.2, specular: 0.05, bump_map: (texture: "waves", height_m: 0.01)"#,
    // As if there were nothing.
    "transmission: 1, ior: 1",
];

const SHAPES: [&str; 11] = [
    "sphere(radius: 0.7, center: (0, 0.75, 0))",
    "box(size: (1, 1.2, 0.9), center: (0, 0.65, 0))",
    "cone(radius: 0.7, height: 1.3)",
    "cone(radius: 0.7, top_radius: 0.3, height: 1, caps: false)",
    "cylinder(radius: 0.5, height: 1.2)",
    "disk(radius: 0.8)",
    "quad(size: (1.5, 1))",
    "polyhedron(kind: icosahedron, radius: 0.8)",
    r#"mesh(path: "ball.obj", smooth: true)"#,
    "group(objects: [(shape: sphere(radius: 0.5), material: \"m\", transform: [translate((-0.5, 0.6, 0))]), (shape: box(size: (0.5, 0.5, 0.5)), material: \"m\", transform: [translate((0.5, 0.5, 0.3))])])",
    // Half under water.
    r#"group(objects: [(shape: box(size: (1.2, 0.8, 1.2)), material: "water", transform: [translate((0, 0.4, 0))]), (shape: sphere(radius: 0.4, center: (0.2, 0.7, 0)), material: "m")])"#,
];

const ANTIALIASING: [&str; 4] = ["none", "grid(2)", "adaptive(threshold: 0.1, depth: 2)", "progressive"];

const EFFECTS: [&str; 6] = [
    "",
    "indirect: 2, indirect_by: paths,",
    "indirect: true, indirect_by: photons,",
    "ambient: 0.1, background: (0.2, 0.3, 0.4),",
    "render: (max_depth: 4),",
    // A lens, by the camera below.
    "background: 0.1,",
];
const LENS: usize = 5;

const PHOTONS: [&str; 3] = ["off", "progressive(count: 1000, k: 30)", "classic(count: 1000, k: 30)"];

/// Whether the thing is of the material that light does not notice.
pub fn is_unnoticed([_, material, ..]: [usize; 6]) -> bool {
    material == MATERIALS.len() - 1
}

/// Whether photons are sent where something focuses them.
pub fn has_photons([.., photons]: [usize; 6]) -> bool {
    PHOTONS[photons] != "off"
}

pub fn text([light, material, shape, antialiasing, effect, photons]: [usize; 6]) -> String {
    let lens = if effect == LENS { ", aperture_m: 0.1" } else { "" };
    let lamp = match LIGHTS[light] {
        "" | "mesh" => String::new(),
        lamp => format!(r#""lamp": {lamp}"#),
    };
    let lamp_object = match LIGHTS[light] {
        "mesh" => {
            r#", (name: "lamp", shape: mesh(path: "ball.obj", smooth: false), material: "glow", transform: [translate((1.5, 3, 2))])"#
        }
        "" => r#", (name: "lamp", shape: sphere(radius: 0.6, center: (1.5, 3, 2)), material: "glow")"#,
        _ => "",
    };
    let material_of = if SHAPES[shape].starts_with("group") { "" } else { r#", material: "m""# };
    // Flat ones and those centred on the origin stand up.
    let stands = matches!(shape, 5..=8);
    let place = if stands {
        "rotate(axis: (1, 0, 0.3), deg: 70), translate((0, 1, 0))"
    } else {
        "translate((0, 0.05, 0))"
    };
    format!(
        r#"(camera: (eye: (0.5, 1.8, 4.5), target: (0, 0.6, 0), fov_deg: 35{lens}), image: (width: 16, height: 12),
        antialiasing: {}, {} photons: {},
        textures: {{ "tiles": checker(a: 0.2, b: 0.8, squares: (4, 4)), "waves": noise(a: 0.4, b: 0.6, size_m: 0.3) }},
        materials: {{ "floor": (diffuse: 0.6), "glow": (emission: 1), "water": (transmission: 1, ior: 1.333), "m": ({}) }},
        lights: {{ {lamp} }},
        objects: [(name: "floor", shape: quad(size: (8, 8)), material: "floor"),
            (name: "thing", shape: {}{material_of}, transform: [{place}]){lamp_object}])"#,
        ANTIALIASING[antialiasing], EFFECTS[effect], PHOTONS[photons], MATERIALS[material], SHAPES[shape]
    )
}

/// The most that a picture's mean can be. Under lights with an extent nothing is brighter than the brightest of
/// them, with ambient light and its echoes on top; under points it is what they send to the nearest surface.
pub fn bound([light, _, _, _, effect, _]: [usize; 6]) -> f64 {
    let ambient = if EFFECTS[effect].contains("ambient") { 0.4 } else { 0.1 };
    if light < WITHOUT_EXTENT { 2.0 + ambient } else { 1.0 + ambient }
}

/// A folder with the files that scenes name.
pub fn folder() -> TempDir {
    let folder = crate::render::meshes::folder();
    icosphere(2).scaled(0.7).write(&folder.path().join("ball.obj"));
    write_exr(&folder.path().join("sky.exr"), 8, 4, |x, y| [if (x + y) % 3 == 0 { 1.0 } else { 0.2 }; 3]);
    folder
}
