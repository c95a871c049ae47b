//! Metrics against NumPy, scikit-image and the authors' `flip-evaluator`, on images that both sides make.
//!
//! `reference.py` in this folder prints these numbers. FLIP is computed in single precision on both sides.

use super::{compared, near, picture};
use terrarium::measure::{Settings, compare_files};

const WIDTH: usize = 40;
const HEIGHT: usize = 32;

/// 24 bits of a multiplicative hash, in [0, 1).
fn uniform(n: u64) -> f64 {
    let x = (n * 2_654_435_761 + 12_345) & 0xFFFF_FFFF;
    let x = ((x ^ (x >> 15)) * 2_246_822_519) & 0xFFFF_FFFF;
    (x >> 8) as f64 / (1 << 24) as f64
}

/// Bars and a bright square under noise; and the same with other noise and a shifted bar.
fn images() -> [Vec<[f32; 3]>; 2] {
    let square = |x: usize, y: usize| {
        if (20..28).contains(&x) && (8..16).contains(&y) { 6.0 } else { 0.0 }
    };
    let bar = |x: usize, c: usize| if x / 4 % 3 == c { 0.5625 } else { 0.0625 };
    let image = |value: &dyn Fn(usize, usize, usize, u64) -> f64| -> Vec<[f32; 3]> {
        let pixel = |i: usize| [0, 1, 2].map(|c| value(i % WIDTH, i / WIDTH, c, (3 * i + c) as u64) as f32);
        (0..WIDTH * HEIGHT).map(pixel).collect()
    };
    [
        image(&|x, y, c, n| bar(x + y / 16, c) + square(x, y) * 1.25 + uniform(n + 100_000) * 0.25),
        image(&|x, y, c, n| bar(x, c) + square(x, y) + uniform(n) * 0.125),
    ]
}

#[test]
fn both_sides_make_the_same_images() {
    let [image, reference] = images();
    assert_eq!((image[0][0], reference[WIDTH * HEIGHT - 1][2]), (0.737_282_5, 0.066_890_21));
}

#[test]
fn the_metrics_of_light_are_those_of_numpy() {
    let [image, reference] = images().map(|pixels| picture(WIDTH, &pixels));
    let found = compared(&image, &reference, &Settings { fast: true, ..Settings::default() });
    let layer = &found.layers[0];
    let relative = layer.colour.as_ref().expect("colours").relative;
    near(layer.values.mse, 0.152_241_957_4, 1e-9);
    near(relative.rel_mse, 0.897_317_672_4, 1e-9);
    near(relative.rel_mse_trimmed, 0.888_829_453_2, 1e-9);
    near(relative.relative_rms, 0.433_632_165_3, 1e-9);
    near(relative.mape, 0.694_104_433_2, 1e-9);
    near(relative.mean_ratio, 1.239_415_387, 1e-9);
}

#[test]
fn psnr_and_ssim_are_those_of_scikit_image() {
    let [image, reference] = images().map(|pixels| picture(WIDTH, &pixels));
    let found = compared(&image, &reference, &Settings::default());
    let colour = found.layers[0].colour.as_ref().expect("colours");
    near(colour.exposure_ev, -1.703_087_374, 1e-7);
    near(colour.psnr_db, 20.173_487_22, 1e-6);
    near(colour.ssim.expect("large enough"), 0.684_584_943_4, 1e-6);
}

#[test]
fn flip_is_that_of_its_authors() {
    let [image, reference] = images().map(|pixels| picture(WIDTH, &pixels));
    let found = compare_files(&image, &reference, &Settings::default()).expect("comparable");
    let colour = found.layers[0].colour.as_ref().expect("colours");
    let flip = colour.flip.expect("not left out");
    near(flip.mean, 0.242_073_22, 1e-5);
    near(flip.max, 0.714_04, 2e-5);
    for (found, expected) in flip.weighted_quartiles.into_iter().zip([0.199_793, 0.273_772, 0.366_892]) {
        near(found, expected, 2e-5);
    }
    let hdr = colour.flip_hdr.as_ref().expect("not left out");
    near(hdr.exposures.start_ev, -1.567_416_549, 1e-6);
    near(hdr.exposures.stop_ev, 3.141_122_103, 1e-6);
    assert_eq!(hdr.exposures.count, 5);
    near(hdr.pooled.mean, 0.436_699_77, 1e-5);
    near(hdr.pooled.max, 0.969_217, 2e-5);
    for (found, expected) in hdr.pooled.weighted_quartiles.into_iter().zip([0.383_708, 0.478_269, 0.581_206])
    {
        near(found, expected, 2e-5);
    }
}
