//! A caustic and ways to look at it, block by block.

use crate::render::caustics::lab::{Estimate, estimate, parts};
use crate::render::shot::{Picture, focused as shot};
use terrarium::render::Aov;

/// A glass ball under a slanting spot light, and its caustic beside it on the floor, seen from above. What is
/// in `objects` lies above the spot light.
pub fn scene(camera: &str, objects: &str, of: u32) -> Vec<Picture> {
    let shot = shot(format!(
        r#"(camera: ({camera}, fov_deg: 10), image: (width: 32, height: 32),
        photons: progressive(count: 20000),
        materials: {{ "white": (diffuse: 0.8), "glass": (transmission: 1), "mirror": (reflection: 1) }},
        lights: {{ "lamp": spot(position: (-1.5, 1.5, 0), target: (-0.5, 0.5, 0), intensity: 9, inner_deg: 14, outer_deg: 16) }},
        objects: [(shape: quad(size: (9, 9)), material: "white"),
                  (shape: sphere(radius: 0.25, center: (-0.5, 0.5, 0)), material: "glass") {objects}])"#
    ))
    .aovs(&[Aov::Caustic]);
    parts(&shot, of)
}

/// Means of the caustic over blocks of 4 × 4 pixels.
pub fn blocks(pictures: &[Picture], mirrored: bool) -> Vec<Estimate> {
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

/// How many blocks are beyond 3σ of `factor` times the expected ones, their sum over that of these, and how
/// many are lit.
pub fn compare(found: &[Estimate], expected: &[Estimate], factor: f64) -> (usize, f64, usize) {
    let far = |(a, b): &(&Estimate, &Estimate)| {
        (a.mean - factor * b.mean).abs() > 3.0 * a.error.hypot(factor * b.error) + 1e-3 * a.mean
    };
    let beyond = found.iter().zip(expected).filter(far).count();
    let sum = |of: &[Estimate]| of.iter().map(|e| e.mean).sum::<f64>();
    let lit = expected.iter().filter(|e| e.mean > 0.0).count();
    (beyond, sum(found) / (factor * sum(expected)), lit)
}

pub const FROM_ABOVE: &str = "eye: (0, 5, 0), target: (0, 0, 0), up: (0, 0, 1)";
