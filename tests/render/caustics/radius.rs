//! The gather radius shrinks from pass to pass as Knaus and Zwicker's formula has it.

use super::lab::mean_of;
use crate::render::shot::focused as shot;
use std::ops::Range;
use terrarium::render::Aov;

/// √ of the product of (i + α)/(i + 1), meaned over the passes.
fn shrink(passes: Range<u32>) -> f64 {
    let of = |pass: u32| {
        (1..=pass).map(|i| (f64::from(i) + 2.0 / 3.0) / (f64::from(i) + 1.0)).product::<f64>().sqrt()
    };
    passes.clone().map(of).sum::<f64>() / passes.len() as f64
}

/// Light through a pane ends at its edge, x = 0. What the gather blurs over that goes with the radius.
#[test]
fn the_blur_of_late_passes_is_that_of_their_smaller_radius() {
    let spilled = |passes: Range<u32>| {
        let picture = shot(
            r#"(camera: (eye: (0.061, 0.45, 0), target: (0.061, 0, 0), up: (0, 0, -1), fov_deg: 15.1), image: (width: 48, height: 48),
            photons: progressive(count: 20000),
            materials: { "white": (diffuse: 1), "glass": (transmission: 1) },
            lights: { "sun": directional(direction: (0, -1, 0), irradiance: 1) },
            objects: [(shape: quad(size: (9, 9)), material: "white"), (shape: box(size: (2, 0.02, 2), center: (-1, 0.51, 0)), material: "glass")])"#,
        )
        .pass_range(passes)
        .aovs(&[Aov::Caustic])
        .render();
        // The picture begins where the pane ends.
        mean_of(&picture, "caustic")
    };
    let (early, late) = (spilled(0..32), spilled(1000..1032));
    let expected = shrink(1000..1032) / shrink(0..32);
    println!("{early} {late}: {} for {expected}", late / early);
    assert!(early > 0.0 && (late / early / expected - 1.0).abs() < 0.15, "{} for {expected}", late / early);
}
