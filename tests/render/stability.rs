//! A scene of everything, to be scaled, moved and mirrored; no acne, no leaks.

use super::meshes::{folder, icosphere};
use super::shot::{Picture, shot};
use std::path::Path;
use terrarium::math::DVec3;

/// A scene of all shapes and lights with lengths times `s`, moved by `m`, mirrored in x where `flip` is −1.
pub(crate) fn everything(s: f64, m: f64, flip: f64) -> String {
    let at = |x: f64, y: f64, z: f64| format!("({:?}, {:?}, {:?})", flip * x * s + m, y * s + m, z * s + m);
    let along = |x: f64, y: f64, z: f64| format!("({:?}, {:?}, {:?})", flip * x, y, z);
    let edge = |x: f64, y: f64, z: f64| format!("({:?}, {:?}, {:?})", flip * x * s, y * s, z * s);
    let place = |x: f64, y: f64, z: f64| {
        format!(
            "transform: [rotate(axis: (0, 1, 0), deg: 20), scale({:?}), scale(({flip}, 1, 1)), translate({})]",
            s,
            at(x, y, z)
        )
    };
    // A quad light's front is edge_u × edge_v: mirrored, the edges change places.
    let (u, v) = (edge(1.0, 0.0, 0.0), edge(0.0, 0.2, 1.0));
    let (u, v) = if flip < 0.0 { (v, u) } else { (u, v) };
    format!(
        r#"(
    camera: (eye: {eye}, target: {target}, fov_deg: 42),
    image: (width: 40, height: 30),
    antialiasing: none,
    textures: {{
        "tiles": checker(a: 0.8, b: 0.3, squares: (9, 7)),
        "stone": marble(a: 0.8, b: 0.2, size_m: 0.4),
        "bricks": brick(a: 0, b: 1, bricks: (6, 9)),
        "normals": image(path: "normals.exr"),
    }},
    materials: {{
        "floor": (diffuse: texture("tiles")),
        "stone": (diffuse: texture("stone"), specular: 0.2, shininess: 30),
        "bumpy": (diffuse: 0.7, normal_map: (texture: "normals")),
        "mirror": (reflection: 0.9),
        "glass": (transmission: 1, ior: 1.5),
        "layered": (diffuse: 0.5, reflection: 0.2, transmission: 0.5),
    }},
    lights: {{
        "ball": sphere(center: {ball}, radius: {radius}, radiance: 20),
        "panel": quad(corner: {panel}, edge_u: {u}, edge_v: {v}, radiance: 4, samples: 4),
        "sun": directional(direction: {sun}, irradiance: 0.5),
        "sky": environment(map: gradient(zenith: 0.4, horizon: 0.2, nadir: 0.05), samples: 4),
    }},
    objects: [
        (shape: quad(size: (12, 12)), material: "floor", {p0}),
        (shape: sphere(radius: 0.5), material: "bumpy", {p1}),
        (shape: box(), material: "stone", {p2}),
        (shape: cone(radius: 0.5), material: "stone", {p3}),
        (shape: cylinder(radius: 0.4), material: "mirror", {p4}),
        (shape: polyhedron(kind: icosahedron, radius: 0.5), material: "glass", {p5}),
        (shape: mesh(path: "ball.obj"), material: "layered", {p6}),
        (shape: mesh(path: "ball.obj", smooth: false), material: "bumpy", {p7}),
        (shape: box(), material: "glass", {p8}),
    ],
)"#,
        eye = at(1.5, 3.0, 7.0),
        target = at(0.1, 0.4, 0.0),
        ball = at(-3.0, 5.0, 2.0),
        radius = 0.5 * s,
        panel = at(2.0, 4.0, -1.0),
        sun = along(1.0, -2.0, -0.5),
        p0 = place(0.0, 0.0, 0.0),
        p1 = place(-2.0, 0.5, 1.0),
        p2 = place(-0.8, 0.5, -1.0),
        p3 = place(0.7, 0.0, 1.2),
        p4 = place(1.9, 0.0, -0.7),
        p5 = place(0.2, 0.6, 2.2),
        p6 = place(-1.2, 1.0, 2.2),
        p7 = place(1.8, 1.0, 1.4),
        p8 = place(-3.0, 0.5, -1.5),
    )
}

pub(crate) fn assets() -> tempfile::TempDir {
    let dir = folder();
    icosphere(2).scaled(0.5).write(&dir.path().join("ball.obj"));
    super::meshes::write_exr(&dir.path().join("normals.exr"), 8, 8, |x, y| {
        [[0.35, 0.5, 0.7][(x + 2 * y) % 3], [0.6, 0.4][y % 2], 0.95]
    });
    dir
}

pub(crate) fn render_everything(folder: &Path, s: f64, m: f64, flip: f64) -> Picture {
    let picture = shot(everything(s, m, flip)).folder(folder).render();
    assert!(picture.is_sound());
    assert!(picture.mean() > 0.05);
    picture
}

/// The lit side of convex objects, down to grazing light, pixel by pixel in closed form: no acne.
#[test]
fn lit_sides_have_no_black_speckle() {
    for s in [1e-4, 1.0, 1e4] {
        for (dx, dy, dz) in [(1.0, 0.0, 0.0), (0.9, 0.1, -0.4), (0.0, 1.0, 0.02)] {
            let sun = DVec3::new(dx, dy, dz).normalize();
            let picture = shot(format!(
                r#"(camera: (eye: (0, 0, {}), target: (0, 0, 0), fov_deg: 24), image: (width: 64, height: 64), antialiasing: none,
                materials: {{ "white": (diffuse: 1) }}, lights: {{ "sun": directional(direction: ({}, {}, {}), irradiance: 1) }},
                objects: [(shape: sphere(radius: {s}), material: "white")])"#,
                5.0 * s, -sun.x, -sun.y, -sun.z
            ))
            .render();
            let half = f64::to_radians(12.0).tan();
            for y in 0..64 {
                for x in 0..64 {
                    let at = |k: usize| ((k as f64 + 0.5) / 32.0 - 1.0) * half;
                    let (o, d) = (DVec3::new(0.0, 0.0, 5.0), DVec3::new(at(x), -at(y), -1.0));
                    let (a, b, c) = (d.dot(d), o.dot(d), 24.0);
                    let expected = if b * b < a * c {
                        0.0
                    } else {
                        (o + d * ((-b - (b * b - a * c).sqrt()) / a)).dot(sun).max(0.0) / std::f64::consts::PI
                    };
                    assert!(
                        (picture.at(x, y) - expected).abs() < 1e-5,
                        "({x}, {y}) at {s}: {} for {expected}",
                        picture.at(x, y)
                    );
                }
            }
        }
    }
}

/// Convex shapes of every kind under a sky and nothing else: E = π L everywhere on their upper parts
/// whose horizon is free. A single missed or doubled hit shows as a speckle.
#[test]
fn faces_lit_at_a_grazing_angle_have_no_speckle() {
    let dir = folder();
    super::meshes::cube().scaled(0.5).write(&dir.path().join("cube.obj"));
    for shape in [
        "box()",
        r#"mesh(path: "cube.obj", smooth: false)"#,
        "polyhedron(kind: cube, radius: 0.8660254037844386)",
    ] {
        for s in [1e-4, 1.0, 1e4] {
            // Seen from above: the top face, and the sun a tenth of a degree above its plane.
            let scene = format!(
                r#"(camera: (eye: (0, {e}, 0), target: (0, 0, 0), up: (0, 0, 1), fov_deg: 10), image: (width: 40, height: 40), antialiasing: none,
                materials: {{ "white": (diffuse: 1) }}, lights: {{ "sun": directional(direction: (3, {slope}, 2), irradiance: 1) }},
                objects: [(shape: {shape}, material: "white", transform: [rotate(axis: (0, 1, 0), deg: 17), scale({s})])])"#,
                e = 4.0 * s,
                slope = -(13f64.sqrt()) * f64::to_radians(0.1).tan(),
            );
            let picture = shot(scene).folder(dir.path()).render();
            let expected = f64::to_radians(0.1).sin() / std::f64::consts::PI;
            for value in picture.grey() {
                assert!((value / expected - 1.0).abs() < 1e-3, "{shape} at {s}: {value} for {expected}");
            }
        }
    }
}

/// Spheres resting on a plane: no light below them, at any scale.
#[test]
fn no_light_leaks_below_a_resting_sphere() {
    for s in [1e-4, 1.0, 1e4] {
        // Looking from below through nothing: the eye just above the floor near the contact point.
        let picture = shot(format!(
            r#"(camera: (eye: ({}, {}, 0), target: (0, 0, 0), fov_deg: 8), image: (width: 32, height: 32), antialiasing: none,
            materials: {{ "white": (diffuse: 1), "black": () }}, lights: {{ "sun": directional(direction: (0, -1, 0), irradiance: 1) }},
            objects: [(shape: quad(size: ({}, {})), material: "white"), (shape: sphere(radius: {s}), material: "black", transform: [translate((0, {s}, 0))])])"#,
            0.3 * s, 0.01 * s, 9.0 * s, 9.0 * s
        ))
        .render();
        assert!(picture.grey().iter().all(|&x| x == 0.0), "light at scale {s}");
    }
}
