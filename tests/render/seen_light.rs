//! What is seen is what shines: the irradiance that next-event estimation finds under an emitter is
//! that of the emitter's picture, taken from the same point and integrated over its solid angle.

use super::meshes::{cube, folder, icosphere};
use super::shot::{assert_close, shot};
use std::f64::consts::PI;
use std::path::Path;

/// Objects and lights in view of the origin, above it within 70° of +y.
fn compare(name: &str, scene: &str, folder: &Path) {
    let fov_deg = 150.0;
    let n = 250;
    let seen = format!(
        "(camera: (eye: (0, 0, 0), target: (0, 1, 0), up: (0, 0, 1), fov_deg: {fov_deg}), \
         image: (width: {n}, height: {n}), antialiasing: grid(2), {scene}])"
    );
    let picture = shot(seen).folder(folder).render();
    // On the plane at distance 1: dω cosθ = dA / (1 + ρ²)².
    let half = f64::to_radians(fov_deg / 2.0).tan();
    let pixel = 2.0 * half / n as f64;
    let expected: f64 = picture
        .grey()
        .iter()
        .enumerate()
        .map(|(i, radiance)| {
            let at = |k: usize| (k as f64 + 0.5) * pixel - half;
            radiance * (pixel / (1.0 + at(i % n).powi(2) + at(i / n).powi(2))).powi(2)
        })
        .sum();
    let lit = format!(
        r#"(camera: (eye: (0.0002, 0.0005, 0.0003), target: (0, 0, 0), fov_deg: 0.01),
            image: (width: 2, height: 2), {scene}, (shape: quad(size: (0.001, 0.001)), material: "white")])"#
    );
    let found = shot(lit).folder(folder).passes(4096).render().mean() * PI;
    assert!(expected > 0.0, "{name} is out of sight");
    println!("{name}: {found} lit, {expected} seen");
    assert_close(found, expected, 0.015);
}

fn objects(shapes: &str) -> String {
    format!(
        r#"materials: {{ "white": (diffuse: 1), "glow": (emission: 3), "pattern": (emission: texture("squares")), "black": () }},
           textures: {{ "squares": checker(a: 4, b: 0.5, squares: (4, 6)) }}, objects: [{shapes}"#
    )
}

macro_rules! shines_as_it_is_seen {
    ($($name:ident: $shapes:expr;)*) => {$(
        #[test]
        fn $name() {
            let dir = folder();
            icosphere(1).write(&dir.path().join("ball.obj"));
            cube().write(&dir.path().join("cube.obj"));
            compare(stringify!($name), &objects($shapes), dir.path());
        }
    )*};
}

shines_as_it_is_seen! {
    an_emitting_sphere_shines_as_it_is_seen:
        r#"(shape: sphere(radius: 0.5, center: (0.3, 1.4, 0.2)), material: "glow")"#;
    an_emitting_ellipsoid_shines_as_it_is_seen:
        r#"(shape: sphere(), material: "glow", transform: [scale((0.9, 0.2, 0.4)), rotate(axis: (1, 2, 0), deg: 40), translate((0.2, 1.6, -0.3))])"#;
    an_emitting_ellipsoid_with_a_pattern_shines_as_it_is_seen:
        r#"(shape: sphere(), material: "pattern", transform: [scale((0.9, 0.2, 0.4)), rotate(axis: (1, 2, 0), deg: 40), translate((0.2, 1.6, -0.3))])"#;
    an_emitting_box_shines_as_it_is_seen:
        r#"(shape: box(), material: "pattern", transform: [scale((0.4, 0.9, 0.3)), rotate(axis: (1, 1, 0.3), deg: 70), translate((0.2, 1.6, 0))])"#;
    an_emitting_mirrored_cylinder_shines_as_it_is_seen:
        r#"(shape: cylinder(radius: 0.4), material: "pattern", transform: [scale((1, -1, 0.6)), rotate(axis: (1, 0, 0), deg: 60), translate((0.2, 1.6, 0))])"#;
    an_emitting_open_cylinder_shines_as_it_is_seen:
        r#"(shape: cylinder(radius: 0.4, caps: false), material: "glow", transform: [rotate(axis: (1, 0, 0), deg: 20), translate((0.2, 1, 0))])"#;
    an_emitting_cone_shines_as_it_is_seen:
        r#"(shape: cone(radius: 0.5, top_radius: 0.2), material: "pattern", transform: [rotate(axis: (1, 0, 1), deg: 130), translate((0.2, 1.8, 0))])"#;
    an_emitting_ring_shines_as_it_is_seen:
        r#"(shape: disk(radius: 0.8, inner_radius: 0.5), material: "glow", transform: [rotate(axis: (1, 0, 1), deg: 30), translate((0.2, 1, 0))])"#;
    an_emitting_quad_with_a_pattern_shines_as_it_is_seen:
        r#"(shape: quad(size: (1, 0.7)), material: "pattern", transform: [rotate(axis: (1, 0, 1), deg: 30), translate((0.4, 1, 0))])"#;
    an_emitting_polyhedron_shines_as_it_is_seen:
        r#"(shape: polyhedron(kind: icosahedron, radius: 0.6), material: "glow", transform: [scale((1, 0.5, 1)), translate((0.4, 1.2, 0))])"#;
    an_emitting_mesh_shines_as_it_is_seen:
        r#"(shape: mesh(path: "ball.obj"), material: "glow", transform: [scale((0.5, 0.3, 0.7)), translate((0.4, 1.2, 0.2))])"#;
    an_emitting_mesh_with_a_pattern_shines_as_it_is_seen:
        r#"(shape: mesh(path: "cube.obj"), material: "pattern", transform: [scale((0.5, 0.3, -0.4)), rotate(axis: (1, 1, 0), deg: 30), translate((0.4, 1.2, 0.2))])"#;
    a_lamp_half_hidden_shines_as_it_is_seen:
        r#"(shape: sphere(radius: 0.5, center: (0.3, 1.4, 0.2)), material: "glow"), (shape: box(size: (0.6, 0.1, 0.6)), material: "black", transform: [translate((0.5, 0.7, 0.2))])"#;
    lamps_in_a_scaled_group_shine_as_they_are_seen:
        r#"(shape: group(objects: [(shape: sphere(radius: 0.2), material: "glow"), (shape: box(size: (0.2, 0.3, 0.1), center: (0.5, 0, 0)), material: "pattern")]), transform: [scale((1, 2, -0.7)), rotate(axis: (0, 0, 1), deg: 50), translate((-0.2, 1.3, 0))])"#;
}
