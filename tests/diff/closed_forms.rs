//! Each metric where a formula gives its value.

use super::{compared, first, near, picture};
use terrarium::measure::flip::{exposures, hdr, ldr, pool};
use terrarium::measure::{Settings, relative};
use terrarium::output::srgb;

#[test]
fn an_even_image_ten_percent_too_bright() {
    let found = first(16, &[[1.1; 3]; 256], &[[1.0; 3]; 256]);
    let colour = found.colour.expect("a colour layer");
    let error = f64::from(1.1f32) - 1.0;
    near(found.values.mse, error * error, 1e-12);
    near(found.values.rmse, error, 1e-12);
    near(found.values.max_error, error, 1e-12);
    near(colour.relative.rel_mse, error * error / 1.01, 1e-12);
    near(colour.relative.relative_rms, error / 1.31f64.sqrt(), 1e-12);
    near(colour.relative.mape, error / 1.01, 1e-12);
    near(colour.relative.mean_ratio, 1.0 + error, 1e-12);
    assert!(!found.values.same && found.values.differing == 1.0);
}

/// relMSE's ε is absolute, that of E is not: brightness changes the one and not the other.
#[test]
fn only_e_does_not_depend_on_brightness() {
    let scaled = |scale: f32| first(4, &[[1.2 * scale; 3]; 16], &[[scale; 3]; 16]).colour.expect("colours");
    let (dark, bright) = (scaled(1.0 / 64.0), scaled(64.0));
    near(dark.relative.relative_rms, bright.relative.relative_rms, 1e-6);
    near(dark.relative.rel_mse, 0.04 / 64.0f64.powi(2) / (1.0 / 64.0f64.powi(2) + 0.01), 1e-5);
    near(bright.relative.rel_mse, 0.04, 1e-5);
}

/// Of 2000 pixels the two worst go, and only from the trimmed figure.
#[test]
fn the_trimmed_figure_leaves_out_one_pixel_in_a_thousand() {
    let reference = vec![1.0f32; 2000];
    let mut image = reference.clone();
    image[7] = 101.0;
    image[1500] = 51.0;
    image[99] = 11.0;
    let found = relative([&image; 3], [&reference; 3]);
    near(found.rel_mse, (1e4 + 2500.0 + 100.0) / 1.01 / 2000.0, 1e-12);
    near(found.rel_mse_trimmed, 100.0 / 1.01 / 1998.0, 1e-12);
    // one that is worst in the mean over channels, not in one of them
    let mut red = vec![1.0f32; 1000];
    let mut grey = red.clone();
    (red[3], grey[4]) = (11.0, 10.0);
    let flat = vec![1.0f32; 1000];
    let green: Vec<f32> = (0..1000).map(|i| if i == 4 { 10.0 } else { 1.0 }).collect();
    let mixed: Vec<f32> = red.iter().zip(&grey).map(|(a, b)| a.max(*b)).collect();
    let found = relative([&mixed, &green, &green], [&flat; 3]);
    near(found.rel_mse_trimmed, 100.0 / 1.01 / 3.0 / 999.0, 1e-12);
}

#[test]
fn the_worst_pixel_is_found_with_both_values() {
    let reference: Vec<[f32; 3]> = (0..40_000).map(|i| [i as f32, 1.0, 2.0]).collect();
    let mut image = reference.clone();
    image[12_345][1] = 4.0;
    image[39_999][2] = 4.5;
    let found = first(200, &image, &reference).values;
    let worst = found.worst.expect("pixels differ");
    assert_eq!((worst.x, worst.y, found.max_error), (145, 61, 3.0));
    assert_eq!((worst.image, worst.reference), (vec![12345.0, 4.0, 2.0], vec![12345.0, 1.0, 2.0]));
    near(found.differing, 2.0 / 40_000.0, 1e-12);
    near(found.mse, (9.0 + 6.25) / 120_000.0, 1e-12);
    // the first of several, in the same part of the image or another
    (image[30_000][0], image[12_346][0]) = (30_003.0, 12_349.0);
    let worst = first(200, &image, &reference).values.worst.expect("pixels differ");
    assert_eq!((worst.x, worst.y), (145, 61));
    assert_eq!(first(200, &reference, &reference).values.worst, None);
}

#[test]
fn values_that_are_not_finite_are_counted_and_left_out_of_means() {
    let reference = [[1.0; 3], [f32::NAN, 1.0, 1.0], [f32::INFINITY; 3], [2.0; 3]];
    let image = [[f32::NAN, 1.0, 1.0], [f32::NAN, 5.0, 1.0], [f32::INFINITY; 3], [3.0; 3]];
    let found = first(2, &image, &reference);
    let counts = &found.values.non_finite;
    assert_eq!((counts.image, counts.reference, counts.unmatched), (5, 4, 1));
    assert_eq!(counts.first, Some([0, 0]));
    // Beside a value that is none, the pixel's others count: 4², and thrice 1, of seven.
    near(found.values.mse, 19.0 / 7.0, 1e-12);
    assert_eq!(found.values.max_error, 4.0);
    assert_eq!(found.values.worst.as_ref().map(|worst| (worst.x, worst.y)), Some((1, 0)));
    near(found.colour.expect("colours").relative.rel_mse, 1.0 / 4.01, 1e-12);
    near(found.values.differing, 0.75, 1e-12);
    let settings = Settings::default();
    let (same, opposite) = (picture(1, &[[f32::NAN; 3]]), picture(1, &[[f32::NEG_INFINITY; 3]]));
    assert!(compared(&same, &same, &settings).same);
    let found = compared(&opposite, &picture(1, &[[f32::INFINITY; 3]]), &settings);
    assert_eq!(found.layers[0].values.non_finite.unmatched, 3);
}

#[test]
fn psnr_is_that_of_what_a_screen_shows() {
    let found = |ev: f64| {
        let settings = Settings { exposure_ev: Some(ev), ..Settings::default() };
        let (a, b) = (picture(4, &[[0.5; 3]; 16]), picture(4, &[[0.25; 3]; 16]));
        compared(&a, &b, &settings).layers[0].colour.clone().expect("colours").psnr_db
    };
    let expected = |a: f64, b: f64| -20.0 * (srgb::encode(a) - srgb::encode(b)).log10();
    near(found(0.0), expected(0.5, 0.25), 1e-9);
    near(found(-2.0), expected(0.125, 0.0625), 1e-9);
    // clamped at white
    near(found(1.5), expected(1.0, 0.25 * 2.0f64.powf(1.5)), 1e-6);
    assert_eq!(found(2.0), f64::INFINITY);
}

#[test]
fn ssim_of_even_images_has_its_luminance_term_alone() {
    let found = first(13, &[[0.5; 3]; 13 * 12], &[[0.1; 3]; 13 * 12]).colour.expect("colours");
    let (a, b) = (srgb::encode(0.5), srgb::encode(f64::from(0.1f32)));
    near(found.ssim.expect("large enough"), (2.0 * a * b + 1e-4) / (a * a + b * b + 1e-4), 1e-6);
    let small = first(10, &[[0.5; 3]; 200], &[[0.1; 3]; 200]).colour.expect("colours");
    assert_eq!(small.ssim, None);
}

/// Without features, green beside blue is the largest difference of colour that there is, and lightness
/// alone counts by its own distance.
#[test]
fn flip_of_even_images_is_the_distance_of_their_colours() {
    let planes = |c: [f32; 3]| c.map(|value| vec![value; 30]);
    let flip = |a, b| pool(&ldr(&planes(a), &planes(b), 6)).mean;
    near(flip([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]), 1.0, 1e-5);
    assert_eq!(flip([0.3, 0.2, 0.1], [0.3, 0.2, 0.1]), 0.0);
    // L* of 18 % grey and of black, on the lower part of the scale's two
    let lightness = 116.0 * 0.18f64.cbrt() - 16.0;
    // L*a*b* of the primaries green and blue, as tables have them; a* and b* times 0.01·L*
    let hunt = |[l, a, b]: [f64; 3]| [l, 0.01 * l * a, 0.01 * l * b];
    let (green, blue) = (hunt([87.735, -86.183, 83.180]), hunt([32.297, 79.188, -107.860]));
    let most = (green[0] - blue[0]).abs() + (green[1] - blue[1]).hypot(green[2] - blue[2]);
    let rescaled = |d: f64| 0.95 / 0.4 * (d / most).powf(0.7);
    let found = flip([0.18; 3], [0.0; 3]);
    assert!(rescaled(lightness) < 0.95, "the test is of the lower part");
    near(found, rescaled(lightness), 2e-3);
}

#[test]
fn the_exposures_of_hdr_flip_bring_brightest_and_median_to_the_curves_knee() {
    let planes = |values: [f32; 3]| [0, 1, 2].map(|_| values.to_vec());
    let found = exposures(&planes([16.0, 1.0, 0.25])).expect("not black");
    near(found.stop_ev - found.start_ev, 4.0, 1e-9);
    assert_eq!(found.count, 4);
    let x = found.start_ev.exp2() * 16.0 * 0.6;
    near(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.85, 1e-6);
    assert_eq!(exposures(&planes([0.0; 3])), None);
    let (a, b) = (planes([16.0, 1.0, 0.5]), planes([16.0, 1.0, 0.25]));
    let most = hdr(&a, &b, 3, found);
    let step = (found.stop_ev - found.start_ev) / 3.0;
    for exposure in 0..4 {
        // one exposure is the first of two that are the same
        let ev = found.start_ev + f64::from(exposure) * step;
        let once = terrarium::measure::flip::Exposures { start_ev: ev, stop_ev: ev, count: 2 };
        assert!(hdr(&a, &b, 3, once).iter().zip(&most).all(|(one, most)| one <= most));
    }
}

#[test]
fn quartiles_are_weighted_by_the_values() {
    // of a total of 100, half lies in the value 50
    let pooled = pool(&[0.1, 0.1, 0.1, 0.2, 0.0, 0.5]);
    near(pooled.mean, 1.0 / 6.0, 1e-6);
    near(pooled.max, 0.5, 1e-6);
    near(pooled.weighted_quartiles[0], 0.1, 1e-6);
    near(pooled.weighted_quartiles[2], 0.5, 1e-6);
    assert_eq!(pool(&[0.0; 4]).weighted_quartiles, [0.0; 3]);
}
