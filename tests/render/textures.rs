//! Textures on surfaces: flat maps change nothing, patterns follow the object, far ones do not alias.

use super::meshes::{folder, icosphere, write_exr};
use super::shot::{Shot, agreement, assert_close, shot};
use std::path::Path;

/// All shapes in rows, of one material.
pub(crate) fn shelf(material: &str, textures: &str, folder: &Path) -> Shot {
    let shapes = [
        "sphere(radius: 0.4)",
        "box(size: (0.6, 0.6, 0.6))",
        "cone(radius: 0.4)",
        "cone(radius: 0.4, top_radius: 0.2)",
        "cylinder(radius: 0.4, height: 0.7)",
        "disk(radius: 0.4)",
        "disk(radius: 0.4, inner_radius: 0.2)",
        "quad(size: (0.7, 0.7))",
        "polyhedron(kind: tetrahedron, radius: 0.5)",
        "polyhedron(kind: cube, radius: 0.5)",
        "polyhedron(kind: octahedron, radius: 0.5)",
        "polyhedron(kind: dodecahedron, radius: 0.5)",
        "polyhedron(kind: icosahedron, radius: 0.5)",
        r#"mesh(path: "ball.obj")"#,
        r#"mesh(path: "ball.obj", smooth: false)"#,
        r#"mesh(path: "mapped.obj")"#,
    ];
    let objects: String = shapes
        .iter()
        .enumerate()
        .map(|(i, shape)| {
            let (x, z) = ((i % 4) as f64 - 1.5, (i / 4) as f64 - 1.5);
            let mirror = if i % 3 == 0 { "scale((-1, 1, 1)), " } else { "" };
            format!(r#"(shape: {shape}, material: "m", transform: [{mirror}translate(({x}, 0, {z}))]), "#)
        })
        .collect();
    shot(format!(
        r#"(camera: (eye: (0, 6, 4), target: (0, 0, 0), fov_deg: 40), image: (width: 64, height: 64), antialiasing: none,
        textures: {{ {textures} }}, materials: {{ "m": ({material}) }}, ambient: 0.01,
        lights: {{ "sun": directional(direction: (-1, -2, -0.3), irradiance: 2), "sky": environment(map: gradient(zenith: 1, horizon: 0.3, nadir: 0.1), samples: 2) }},
        objects: [{objects}])"#
    ))
    .folder(folder)
}

pub(crate) fn shelf_folder() -> tempfile::TempDir {
    let dir = folder();
    icosphere(2).scaled(0.4).write(&dir.path().join("ball.obj"));
    // A tent whose texture coordinates fold back, and collapse on one triangle.
    std::fs::write(
        dir.path().join("mapped.obj"),
        "v -0.4 0 -0.4\nv 0.4 0 -0.4\nv 0.4 0 0.4\nv -0.4 0 0.4\nv 0 0.4 0\n\
         vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
         f 1/1 5/3 2/2\nf 2/2 5/3 3/1\nf 3/1 5/1 4/1\nf 4/3 5/2 1/1\n",
    )
    .expect("the folder is writable");
    dir
}

/// A normal map tilts the way it says: red along ∂p/∂u.
#[test]
fn a_normal_map_tilts_the_normal_as_painted() {
    let dir = folder();
    // tan = 0.5 towards +u.
    let n = (1.25f64).sqrt();
    let texel = [0.5 / n / 2.0 + 0.5, 0.5, 1.0 / n / 2.0 + 0.5].map(|x| x as f32);
    write_exr(&dir.path().join("tilt.exr"), 2, 2, |_, _| texel);
    let e = |direction: &str| {
        shot(format!(
            r#"(camera: (eye: (0, 3, 0.1), target: (0, 0, 0), fov_deg: 0.1), image: (width: 1, height: 1), antialiasing: none,
            textures: {{ "tilt": image(path: "tilt.exr") }}, materials: {{ "m": (diffuse: 1, normal_map: (texture: "tilt")) }},
            lights: {{ "sun": directional(direction: {direction}, irradiance: 3.141592653589793) }}, objects: [(shape: quad(), material: "m")])"#
        ))
        .folder(dir.path())
        .render()
        .mean()
    };
    assert_close(e("(0, -1, 0)"), 1.0 / n, 1e-3);
    // The quad's u is x (or −x, or z): lit along the tilt it gains, against it it loses.
    let [px, nx, pz, nz] = ["(-1, -1, 0)", "(1, -1, 0)", "(0, -1, -1)", "(0, -1, 1)"].map(e);
    let along = px.max(nx).max(pz).max(nz);
    assert_close(along, (0.5 + 1.0) / n / 2f64.sqrt(), 1e-3);
    assert_close(px + nx + pz + nz, 4.0 / n / 2f64.sqrt(), 1e-3);
}

/// Solid textures live in the object's own space: a small object scaled up is a large one of larger pattern.
#[test]
fn solid_textures_scale_with_their_object() {
    for pattern in ["noise", "marble", "wood", "checker3d"] {
        let scene = |size: f64, scale: f64, radius: f64| {
            let size_name = if pattern == "wood" { "ring_m" } else { "size_m" };
            shot(format!(
                r#"(camera: (eye: (0, 1, 4), target: (0, 0, 0), fov_deg: 40), image: (width: 32, height: 32), antialiasing: none,
                textures: {{ "t": {pattern}(a: 0, b: 1, {size_name}: {size:e}) }}, materials: {{ "m": (emission: texture("t")) }},
                objects: [(shape: sphere(radius: {radius:e}), material: "m", transform: [scale({scale:e})])])"#
            ))
            .render()
        };
        let one = scene(0.12, 1.0, 1.0);
        for k in [1e-3, 1e3] {
            let share = agreement(&one, &scene(0.12 * k, 1.0 / k, k), 1e-3);
            assert!(share > 0.98, "{pattern}: {share} agree at {k:e}");
        }
    }
}

/// A checker too fine to be seen is its mean, however far away: no alias.
#[test]
fn far_patterns_become_their_mean() {
    let dir = folder();
    write_exr(&dir.path().join("tiles.exr"), 64, 64, |x, y| [((x / 4 + y / 4) % 2) as f32; 3]);
    for texture in [
        "checker(a: 0, b: 1, squares: (20000, 20000))",
        "checker3d(a: 0, b: 1, size_m: 0.01)",
        r#"image(path: "tiles.exr", uv: (scale: (2000, 2000)))"#,
        "noise(a: 0, b: 1, size_m: 0.002)",
    ] {
        let picture = shot(format!(
            r#"(camera: (eye: (0.01, 2, 30), target: (0, 0, 0), fov_deg: 20), image: (width: 64, height: 48), antialiasing: none,
            textures: {{ "t": {texture} }}, materials: {{ "m": (emission: texture("t")) }},
            objects: [(shape: quad(size: (200, 200)), material: "m")])"#
        ))
        .folder(dir.path())
        .render();
        // The lower part of the image is floor.
        let rows = &picture.grey()[30 * 64..];
        let worst = rows.iter().map(|x| (x - 0.5).abs()).fold(0.0, f64::max);
        println!("{texture}: {worst}");
        assert!(worst < 0.2, "{texture}: {worst} off its mean");
    }
}

/// The footprint grows on its way through a mirror as it does in the open.
#[test]
fn a_pattern_in_a_mirror_is_filtered_as_seen_directly() {
    let scene = |eye_z: f64, mirror: &str| {
        shot(format!(
            r#"(camera: (eye: (0, 1, {eye_z}), target: (0, 0.5, 0), fov_deg: 30), image: (width: 32, height: 32), antialiasing: none,
            textures: {{ "t": checker(a: 0, b: 1, squares: (200, 200)) }}, materials: {{ "m": (emission: texture("t")), "mirror": (reflection: 1) }},
            objects: [(shape: box(size: (20, 0.1, 20), center: (0, -0.05, 11)), material: "m") {mirror}])"#
        ))
        .render()
    };
    let mirror = r#", (shape: quad(size: (40, 40)), material: "mirror", transform: [rotate(axis: (1, 0, 0), deg: 90)])"#;
    let (through, direct) = (scene(0.9, mirror), scene(-0.9, ""));
    let mut same = 0;
    for y in 0..32 {
        for x in 0..32 {
            same += usize::from((through.at(x, y) - direct.at(31 - x, y)).abs() < 2e-3);
        }
    }
    assert!(same > 1014, "{same} of 1024");
}
