//! H50: a caustic seen in a mirror or through glass is the caustic. Path tracers do not find it.

use super::lab::{Estimate, estimate, parts};
use crate::render::shot::{Picture, focused as shot};
use terrarium::render::Aov;

/// A glass ball under a slanting spot light, and its caustic beside it on the floor, seen from above. What is
/// in `objects` lies above the spot light.
fn scene(camera: &str, objects: &str) -> Vec<Picture> {
    let shot = shot(format!(
        r#"(camera: ({camera}, fov_deg: 10), image: (width: 32, height: 32),
        photons: progressive(count: 20000),
        materials: {{ "white": (diffuse: 0.8), "glass": (transmission: 1), "mirror": (reflection: 1) }},
        lights: {{ "lamp": spot(position: (-1.5, 1.5, 0), target: (-0.5, 0.5, 0), intensity: 9, inner_deg: 14, outer_deg: 16) }},
        objects: [(shape: quad(size: (9, 9)), material: "white"),
                  (shape: sphere(radius: 0.25, center: (-0.5, 0.5, 0)), material: "glass") {objects}])"#
    ))
    .aovs(&[Aov::Caustic]);
    parts(&shot, 10)
}

/// Means of the caustic over blocks of 4 × 4 pixels.
fn blocks(pictures: &[Picture], mirrored: bool) -> Vec<Estimate> {
    let of = |picture: &Picture, block: usize| {
        let values = picture.channel("caustic", "R");
        let pixel = |i: usize| {
            let (x, y) = (4 * (block % 8) + i % 4, 4 * (block / 8) + i / 4);
            f64::from(values[y * 32 + if mirrored { 31 - x } else { x }])
        };
        (0..16).map(pixel).sum::<f64>() / 16.0
    };
    (0..64).map(|block| estimate(&pictures.iter().map(|p| of(p, block)).collect::<Vec<_>>())).collect()
}

/// All blocks agree within their errors (the part beyond 3σ that ten parts leave to chance is 1 %), and
/// their sum within three of its own and 1 %.
#[track_caller]
fn assert_same(found: &[Estimate], expected: &[Estimate], factor: f64) {
    let far = |(a, b): &(&Estimate, &Estimate)| {
        (a.mean - factor * b.mean).abs() > 3.0 * a.error.hypot(factor * b.error) + 1e-3 * a.mean
    };
    let beyond = found.iter().zip(expected).filter(far).count();
    let sum = |of: &[Estimate]| of.iter().map(|e| e.mean).sum::<f64>();
    let (a, b) = (sum(found), factor * sum(expected));
    let lit = expected.iter().filter(|e| e.mean > 0.0).count();
    println!("{beyond} of 64 beyond 3σ, {lit} lit, {a} and {b}: ratio {}", a / b);
    assert!(lit > 40 && beyond <= 2, "{beyond} blocks of 64 are elsewhere");
    assert!((a / b - 1.0).abs() < 0.01, "{a} and {b}");
}

const FROM_ABOVE: &str = "eye: (0, 5, 0), target: (0, 0, 0), up: (0, 0, 1)";

#[test]
fn in_a_perfect_mirror() {
    let direct = scene(FROM_ABOVE, "");
    // The mirror folds the view at a height of 3 m, by 90°.
    let mirror = r#", (shape: quad(size: (0.8, 0.8)), material: "mirror", transform: [rotate(axis: (1, 0, 0), deg: 135), translate((0, 3, 0))])"#;
    let folded = scene("eye: (0, 3, 2), target: (0, 3, 0)", mirror);
    assert_same(&blocks(&folded, true), &blocks(&direct, false), 1.0);
}

#[test]
fn through_a_pane_of_glass() {
    let direct = scene(FROM_ABOVE, "");
    let pane = r#", (shape: box(size: (2, 0.001, 2), center: (0, 4, 0)), material: "glass")"#;
    // Within 7° of the normal the pane transmits 0.923077 to 1e-4.
    assert_same(&blocks(&scene(FROM_ABOVE, pane), false), &blocks(&direct, false), 0.923_077);
}

/// The terrarium's case: eye, lamp and floor within one body of glass's walls.
#[test]
fn from_within_the_glass_that_makes_it() {
    // A hollow glass cube around the floor; the sun comes through its lid. The eye is inside, where the lid
    // has transmitted 0.923077 of it.
    let scene = |eye: f64| {
        let shot = shot(format!(
            r#"(camera: (eye: (0, {eye}, 0), target: (0, 0, 0), up: (0, 0, 1), fov_deg: 8), image: (width: 16, height: 16),
            photons: progressive(count: 50000),
            materials: {{ "white": (diffuse: 0.8), "glass": (transmission: 1), "air": (transmission: 1, ior: 1, priority: 1) }},
            lights: {{ "sun": directional(direction: (0, -1, 0), irradiance: 1) }},
            objects: [(shape: quad(size: (1.8, 1.8)), material: "white", transform: [translate((0, 0.01, 0))]),
                      (shape: box(size: (2.1, 2.1, 2.1), center: (0, 1, 0)), material: "glass"),
                      (shape: box(size: (2, 2, 2), center: (0, 1, 0)), material: "air")])"#
        ))
        .aovs(&[Aov::Caustic]);
        let means: Vec<f64> = parts(&shot, 8).iter().map(Picture::mean).collect();
        estimate(&means)
    };
    let irradiance = 0.923_077 * 0.8 / std::f64::consts::PI;
    scene(1.9).assert_is(irradiance, 1e-4, "from inside");
    scene(4.0).assert_is(0.923_077 * irradiance, 1e-4, "from outside");
}
