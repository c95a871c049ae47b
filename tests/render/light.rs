//! Irradiance under each kind of light, in closed form. A Lambert floor of albedo 1 shows E/π.

use super::meshes::{cube, folder, write_exr};
use super::shot::{assert_close, shot};
use std::f64::consts::PI;
use std::path::Path;

/// A white floor at y = 0 and an eye just above its origin, lower than all lights.
pub(crate) fn floor(lights: &str, more: &str) -> String {
    format!(
        r#"(
    camera: (eye: (0.002, 0.005, 0.003), target: (0, 0, 0), fov_deg: 0.01),
    image: (width: 2, height: 2),
    materials: {{ "white": (diffuse: 1), {} }},
    lights: {{ {lights} }},
    objects: [(shape: quad(size: (0.01, 0.01)), material: "white"), {}],
)"#,
        more.split('|').next().unwrap_or(""),
        more.split('|').nth(1).unwrap_or("")
    )
}

/// E at the origin over `passes` passes.
pub(crate) fn irradiance(lights: &str, passes: u32) -> f64 {
    shot(floor(lights, "")).passes(passes).render().mean() * PI
}

/// E under objects: `materials|objects`.
fn irradiance_of_objects(more: &str, folder: &Path, passes: u32) -> f64 {
    shot(floor("", more)).folder(folder).passes(passes).render().mean() * PI
}

#[test]
fn a_point_light_gives_intensity_times_cosine_over_squared_distance() {
    for (x, y, z) in [(0.0, 2.0, 0.0), (1.0, 2.0, -2.0), (30.0, 0.4, 0.0)] {
        let d2: f64 = x * x + y * y + z * z;
        let found = irradiance(&format!(r#""a": point(position: ({x}, {y}, {z}), intensity: 7)"#), 1);
        assert_close(found, 7.0 * y / d2.sqrt() / d2, 2e-3 * (1.0 / y).clamp(1e-3, 1.0));
    }
}

#[test]
fn classic_falloff_replaces_the_inverse_square() {
    // d = 3, cosθ = 2/3
    let found =
        irradiance(r#""a": point(position: (1, 2, -2), intensity: 7, falloff: (0.5, 0.25, 0.125))"#, 1);
    assert_close(found, 7.0 * (2.0 / 3.0) / (0.5 + 0.25 * 3.0 + 0.125 * 9.0), 3e-3);
}

#[test]
fn a_spot_light_is_full_inside_and_dark_outside_and_half_where_its_cubic_is() {
    // The floor is seen from the light at `off` degrees from its axis.
    let at = |off: f64| {
        let target = (off.to_radians().tan() * 2.0, 0.0);
        irradiance(
            &format!(
                r#""a": spot(position: (0, 2, 0), target: ({}, 0, {}), intensity: 8, inner_deg: 20, outer_deg: 40)"#,
                target.0, target.1
            ),
            1,
        )
    };
    assert_close(at(0.0), 2.0, 1e-4);
    assert_close(at(19.0), 2.0, 1e-4);
    assert_eq!(at(41.0), 0.0);
    // Half of the way from cos 40° to cos 20°.
    let middle = ((20f64.to_radians().cos() + 40f64.to_radians().cos()) / 2.0).acos().to_degrees();
    assert_close(at(middle), 1.0, 1e-3);
}

#[test]
fn directional_light_gives_its_irradiance_times_the_cosine() {
    let found = irradiance(r#""a": directional(direction: (3, -4, 0), irradiance: (5, 5, 5))"#, 1);
    assert_close(found, 5.0 * 0.8, 1e-6);
    assert_eq!(irradiance(r#""a": directional(direction: (3, 4, 0), irradiance: 5)"#, 1), 0.0);
}

#[test]
fn a_disk_light_overhead_gives_pi_l_r2_over_r2_plus_h2() {
    let disk = |normal: &str| {
        irradiance(
            &format!(r#""a": disk(center: (0, 2, 0), normal: {normal}, radius: 1.5, radiance: 4)"#),
            4096,
        )
    };
    assert_close(disk("(0, -3, 0)"), PI * 4.0 * 2.25 / (2.25 + 4.0), 4e-3);
    assert_eq!(disk("(0, 1, 0)"), 0.0);
}

#[test]
fn an_even_sky_gives_pi_l() {
    let sky = r#""sky": environment(map: constant((0.5, 0.5, 0.5)))"#;
    assert_close(irradiance(sky, 1024), PI * 0.5, 3e-3);
    let unseen = r#""sky": environment(map: constant(0.5), scale: 3, visible: false)"#;
    assert_close(irradiance(unseen, 1024), PI * 1.5, 3e-3);
}

/// E = 2π ∫ (H(1−y) + Z y) y dy = 2π (H/6 + Z/3).
#[test]
fn a_gradient_sky_gives_its_integral() {
    let sky = r#""sky": environment(map: gradient(zenith: 3, horizon: 1, nadir: 50))"#;
    assert_close(irradiance(sky, 4096), 2.0 * PI * (1.0 / 6.0 + 1.0), 3e-3);
}

/// One bright texel of a map, interpolated bilinearly, integrated numerically here.
#[test]
fn one_bright_texel_gives_its_integral() {
    let dir = folder();
    let (width, height, column, row, value) = (32, 16, 20, 4, 100.0);
    write_exr(&dir.path().join("sky.exr"), width, height, |x, y| {
        [if (x, y) == (column, row) { value as f32 } else { 0.0 }; 3]
    });
    let light = r#""sky": environment(map: image(path: "sky.exr"))"#;
    let found = shot(floor(light, "")).folder(dir.path()).passes(4096).render().mean() * PI;
    // ∫ tent(x) dφ = one column; the rows by quadrature of tent(θ)·cosθ·sinθ, θ from the zenith.
    let step = PI / height as f64;
    let n = 1000;
    let rows: f64 = (0..2 * n)
        .map(|i| {
            let t = (f64::from(i) + 0.5) / f64::from(n) - 1.0;
            let theta = (row as f64 + 0.5 + t) * step;
            (1.0 - t.abs()) * theta.cos() * theta.sin() * step / f64::from(n)
        })
        .sum();
    assert_close(found, value * (2.0 * PI / width as f64) * rows, 5e-3);
}

/// From below, a box and its mesh show one face: a square's form factor again.
#[test]
fn an_emitting_box_and_its_mesh_give_the_form_factor_of_the_lower_face() {
    let dir = folder();
    cube().write(&dir.path().join("cube.obj"));
    for (shape, place) in [
        ("box()", "translate((0, 1.5, 0))"),
        (r#"mesh(path: "cube.obj", smooth: false)"#, "scale(0.5), translate((0, 1.5, 0))"),
        (r#"mesh(path: "cube.obj")"#, "scale(-0.5), translate((0, 1.5, 0))"),
        (r#"mesh(path: "cube.obj")"#, "scale((0.5, 0.01, 0.5)), translate((0, 1.01, 0))"),
    ] {
        let more =
            format!(r#""glow": (emission: 2)|(shape: {shape}, material: "glow", transform: [{place}])"#);
        assert_close(irradiance_of_objects(&more, dir.path(), 8192), 2.0 * 0.752_274_7, 1e-2);
    }
}

/// The lamp's own surface hides its far side, and a convex one never sees itself.
#[test]
fn a_convex_lamp_does_not_light_itself() {
    let dir = folder();
    cube().write(&dir.path().join("cube.obj"));
    for shape in [
        "sphere()",
        "box()",
        "cylinder()",
        "cone()",
        "cone(top_radius: 0.5)",
        "quad()",
        "disk()",
        "polyhedron(kind: dodecahedron)",
        "polyhedron(kind: tetrahedron)",
        r#"mesh(path: "cube.obj", smooth: false)"#,
    ] {
        for scale in [1.0, 1e-3, 1e3] {
            let scene = format!(
                r#"(
                camera: (eye: ({e}, {e}, {f}), target: (0, 0, 0), fov_deg: 40),
                image: (width: 24, height: 24),
                materials: {{ "glow": (emission: 2, diffuse: 0.8) }},
                objects: [(shape: {shape}, material: "glow", transform: [scale({scale}), rotate(axis: (1, 2, 3), deg: 33)])],
            )"#,
                e = 2.0 * scale,
                f = 3.0 * scale
            );
            let picture = shot(scene).folder(dir.path()).passes(4).render();
            let worst = picture.grey().into_iter().fold(0.0, f64::max);
            assert!(worst <= 2.0 * (1.0 + 1e-6), "{shape} at scale {scale}: {worst} where 2 is emitted");
        }
    }
}
