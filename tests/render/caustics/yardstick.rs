//! Two scenes of the field, against references that bidirectional path tracing and photon mapping of other
//! programs agree on.
//!
//! They are rendered at a quarter of the width and height: the pixels' filter is a box, so that the mean of
//! 4 × 4 pixels of the reference is the reference.

use crate::render::shot::{Picture, Shot, focused as shot};
use std::path::Path;
use terrarium::measure::{read::load, relative};

const SIDE: usize = 64;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn scene(name: &str, more: &str) -> Shot {
    let text = std::fs::read_to_string(root().join(format!("scenes/yardstick/{name}.ron")));
    let text = text.expect("the scene is in the repository");
    let small = text.replace("width: 256, height: 256", "width: 64, height: 64");
    assert!(small != text);
    shot(small.replace("    indirect: true,", &format!("    indirect: true, {more}")))
}

/// Means of 4 × 4 pixels of the reference.
fn reference(name: &str) -> Vec<[f64; 3]> {
    let path = root().join(format!("tests/references/{name}.exr"));
    let file = load(&path).expect("the reference is in the repository");
    let channels = file.layers[0].colour().expect("a picture");
    assert_eq!(channels[0].len(), 256 * 256);
    let mean = |channel: &[f32], pixel: usize| {
        let (x, y) = (4 * (pixel % SIDE), 4 * (pixel / SIDE));
        (0..16).map(|i| f64::from(channel[(y + i / 4) * 256 + x + i % 4])).sum::<f64>() / 16.0
    };
    (0..SIDE * SIDE).map(|pixel| [0, 1, 2].map(|c| mean(channels[c], pixel))).collect()
}

/// relMSE without the 0.1 % of the pixels that are worst.
fn trimmed(picture: &Picture, reference: &[[f64; 3]]) -> f64 {
    let reference = [0, 1, 2].map(|c| reference.iter().map(|pixel| pixel[c] as f32).collect::<Vec<f32>>());
    let image = ["R", "G", "B"].map(|name| picture.channel("", name));
    relative(image, reference.each_ref().map(Vec::as_slice)).rel_mse_trimmed
}

fn sum(pixels: &[[f64; 3]]) -> f64 {
    pixels.iter().flatten().sum()
}

/// `more`: further fields of the scene. `floor`: the error at which the curve may end: noise of the reference,
/// and what 64 × 64 pixels blur.
fn converges(name: &str, more: &str, ladder: &[u32], floor: f64) {
    let reference = reference(name);
    let mut curve = Vec::new();
    for &passes in ladder {
        let picture = scene(name, more).passes(passes).render();
        assert!(picture.is_sound());
        let error = trimmed(&picture, &reference);
        let rgb: Vec<[f64; 3]> = picture.rgb().iter().map(|p| p.map(f64::from)).collect();
        let ratio = sum(&rgb) / sum(&reference);
        println!("{name} {more}: {passes} passes: relMSE {error:.3e}, mean ratio {ratio:.5}");
        curve.push((passes, error, ratio));
    }
    let &(_, _, ratio) = curve.last().expect("the ladder has steps");
    assert!((ratio - 1.0).abs() < 0.005, "{name}: the mean is {ratio} of the reference's");
    for pair in curve.windows(2) {
        let [(n, before, _), (m, after, _)] = pair else { continue };
        let allowed = before * (f64::from(*n) / f64::from(*m)).powf(0.6);
        assert!(*after <= allowed.max(floor), "{name}: {before:e} at {n} passes, {after:e} at {m}");
    }
}

#[test]
fn the_caustic_of_a_sphere_converges_to_the_reference() {
    converges("caustic-sphere", "", &[4, 16, 64], 2e-4);
}

#[test]
fn a_box_with_glass_and_mirror_converges_to_the_reference_by_photons() {
    converges("cornell-glass", "indirect_by: photons,", &[2, 8, 32], 2e-4);
}

#[test]
fn a_box_with_glass_and_mirror_converges_to_the_reference_by_paths() {
    converges("cornell-glass", "indirect_by: paths,", &[4, 16], 2e-4);
}
