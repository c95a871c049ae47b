//! Shading normals that are not the surface's own: photons see them by the adjoint of what eye
//! paths do, so that both find the same irradiance.

use super::lab::{lab_in, on_patch, power};
use crate::render::meshes::{folder, icosphere};
use std::f64::consts::PI;
use std::path::Path;
use terrarium::description::{Format, load_str};
use terrarium::math::DVec3;
use terrarium::render::{Aov, Options, Silent, render};
use terrarium::scatter::{Aim, Store};

const SKY: &str = r#""sky": environment(map: gradient(zenith: 4, horizon: 1, nadir: 0.1))"#;
const HALF: f64 = 0.3;
const PASSES: u32 = 24;

/// It hides what is below it, for light as for eyes.
fn patch(material: &str) -> String {
    format!(r#"(shape: quad(size: ({}, {})), material: "{material}")"#, 2.0 * HALF, 2.0 * HALF)
}

/// The irradiance of the patch at the origin that photons find behind casters.
pub(crate) fn by_photons(
    folder: &Path,
    more: &str,
    materials: &str,
    caster: &str,
    passes: u32,
) -> (f64, f64) {
    let scene = lab_in(folder, more, materials, SKY, &format!("{}, {caster}", patch("white")));
    let passes = scene.passes(Store::Caustics, Aim::Casters, passes, 100_000);
    let found = power(&passes, |p| on_patch(&scene, p, [0.0, 0.0], HALF));
    let area = 4.0 * HALF * HALF;
    (found.mean / area, found.error / area)
}

/// What eye paths find from points of the patch, upwards within a frustum of 120°: mirrored or refracted.
pub(crate) fn by_paths(folder: &Path, more: &str, materials: &str, caster: &str) -> f64 {
    let n = 96;
    let mut sum = 0.0;
    // Three points of Gauss along each edge.
    let nodes = [(-(0.6f64.sqrt()), 5.0 / 18.0), (0.0, 8.0 / 18.0), (0.6f64.sqrt(), 5.0 / 18.0)];
    for i in 0..9 {
        let ((x, wx), (z, wz)) = (nodes[i / 3], nodes[i % 3]);
        let (x, z) = (x * HALF, z * HALF);
        let text = format!(
            r#"(camera: (eye: ({x:?}, 1e-4, {z:?}), target: ({x:?}, 1, {z:?}), up: (0, 0, 1), fov_deg: 120),
            image: (width: {n}, height: {n}), photons: off, {more}
            materials: {{ "white": (diffuse: 1), "glass": (transmission: 1, ior: 1.5), "mirror": (reflection: 1), "black": (diffuse: 0), {materials} }},
            lights: {{ {SKY} }}, objects: [{}, {caster}])"#,
            patch("black")
        );
        let loaded = load_str(&text, Format::Ron, folder, &[]).unwrap_or_else(|r| panic!("{r}\n{text}"));
        let options = Options {
            passes: Some(0..4),
            aovs: vec![Aov::Reflection, Aov::Refraction],
            ..Options::default()
        };
        let image = render(&loaded, &options, &Silent).expect("renders").image;
        let tan = f64::to_radians(60.0).tan();
        let pixel = 2.0 * tan / n as f64;
        for layer in ["reflection", "refraction"] {
            let values = image.layer(layer).and_then(|l| l.channel("R")).expect("asked for");
            for (i, value) in values.iter().enumerate() {
                let at = |k: usize| (k as f64 + 0.5) * pixel - tan;
                let solid = (pixel / (1.0 + at(i % n).powi(2) + at(i / n).powi(2))).powi(2);
                sum += wx * wz * f64::from(*value) * solid;
            }
        }
    }
    sum
}

fn assert_same(name: &str, folder: &Path, more: &str, materials: &str, caster: &str) {
    let (photons, error) = by_photons(folder, more, materials, caster, PASSES);
    let paths = by_paths(folder, more, materials, caster);
    println!("{name}: photons {photons} ± {error}, paths {paths}, {:.2} σ", (photons - paths) / error);
    assert!((photons - paths).abs() < 3.0 * error + 2e-3 * paths, "{name}: {photons} ± {error}, {paths}");
    assert!(error < 0.03 * paths, "{name}: {photons} ± {error}");
}

/// A mirror over the patch, looking down, its normals tilted by up to 27° in squares.
pub(crate) fn mirror(material: &str) -> String {
    format!(
        r#"(shape: quad(size: (2, 2)), material: "{material}", transform: [rotate(axis: (1, 0, 0), deg: 180), translate((0, 1, 0))])"#
    )
}

pub(crate) const TILTS: &str =
    r#"textures: { "tilts": checker(a: (0.7, 0.45, 0.95), b: (0.4, 0.65, 0.95), squares: (2, 2)) },"#;

/// The same in closed form: by midpoints of the mirror, with the sky in the mirrored directions.
#[test]
fn a_mapped_mirror_throws_onto_a_floor_what_the_floor_sees_in_it() {
    let none = Path::new("");
    let mapped = r#""mapped": (reflection: 1, normal_map: (texture: "tilts"))"#;
    let (photons, error) = by_photons(none, TILTS, mapped, &mirror("mapped"), PASSES);
    let sky = lab_in(none, "", "", SKY, &patch("white")).world.environment.expect("a sky");
    let (n, m) = (80, 6);
    let mut expected = 0.0;
    for i in 0..n * n {
        let middle = |i: usize| (i as f64 + 0.5) / n as f64 * 2.0 - 1.0;
        let q = DVec3::new(middle(i / n), 1.0, middle(i % n));
        // Turned upside down: u along +x, v along +z, the normal along −y.
        let [tx, ty, tz] = if (q.x < 0.0) == (q.z < 0.0) { [0.4, -0.1, 0.9] } else { [-0.2, 0.3, 0.9] };
        let normal = DVec3::new(tx, -tz, ty).normalize();
        for j in 0..m * m {
            let at = |j: usize| ((j as f64 + 0.5) / m as f64 * 2.0 - 1.0) * HALF;
            let to = q - DVec3::new(at(j / m), 0.0, at(j % m));
            let d = to.normalize();
            let mirrored = d - normal * (2.0 * d.dot(normal));
            let down = q - mirrored / mirrored.y;
            if mirrored.y < 0.0 && down.x.abs().max(down.z.abs()) < HALF {
                continue;
            }
            let weight = d.y * d.y / to.length_squared() * 4.0 / (n * n * m * m) as f64;
            expected += weight * f64::from(sky.radiance(mirrored).x);
        }
    }
    println!("photons {photons} ± {error}, expected {expected}");
    assert!((photons - expected).abs() < 3.0 * error, "{photons} ± {error}, {expected}");
    assert!(error < 0.04 * expected);
    // The map matters: a flat mirror differs by much more.
    let (flat, _) = by_photons(none, "", "", &mirror("mirror"), PASSES);
    assert!((flat - expected).abs() > 6.0 * error, "{flat} instead of {expected} ± {error}");
    assert_same("mirror", none, TILTS, mapped, &mirror("mapped"));
}

#[test]
fn a_mapped_pane_of_glass_throws_onto_a_floor_what_the_floor_sees_through_it() {
    let mapped = r#""mapped": (transmission: 1, ior: 1.5, normal_map: (texture: "tilts", strength: 0.5))"#;
    let pane = r#"(shape: box(size: (2, 0.05, 2), center: (0, 1, 0)), material: "mapped")"#;
    assert_same("pane", Path::new(""), TILTS, mapped, pane);
}

#[test]
fn coarse_smooth_meshes_throw_onto_a_floor_what_the_floor_sees_in_them() {
    let dir = folder();
    for (fineness, material) in [(3, "glass"), (2, "mirror")] {
        icosphere(fineness).write(&dir.path().join("ball.obj"));
        let ball = format!(
            r#"(shape: mesh(path: "ball.obj"), material: "{material}", transform: [scale(0.6), translate((0, 1.1, 0))])"#
        );
        assert_same(&format!("{material} {fineness}"), dir.path(), "", "", &ball);
    }
}

/// Nothing is bent where the normals are the surface's own.
#[test]
fn true_spheres_throw_what_is_seen_in_them() {
    let ball = r#"(shape: sphere(radius: 0.6, center: (0, 1.1, 0)), material: "glass")"#;
    assert_same("sphere", Path::new(""), "", "", ball);
    let (photons, error) = by_photons(Path::new(""), "", "", &ball.replace("glass", "mirror"), PASSES);
    assert!(photons > 0.0 && photons < 4.0 * PI && error > 0.0);
}
