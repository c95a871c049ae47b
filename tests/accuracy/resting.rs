//! Pixels that come to rest when an error is to be reached.

use super::super::render::shot::focused;
use terrarium::measure::compare;
use terrarium::output::Image;
use terrarium::plan::Until;
use terrarium::render::{self, Aov, Options, Rendered, Silent};

/// A lamp's soft shadow below, and a wall that shines evenly above.
const HALF: &str = r#"(
    camera: (eye: (0, 1.2, 5), target: (0, 0.8, 0), fov_deg: 40),
    image: (width: 96, height: 64),
    background: 0.4,
    materials: { "floor": (diffuse: 0.6), "ball": (diffuse: (0.6, 0.2, 0.1)) },
    lights: { "lamp": sphere(center: (-2, 3, 1), radius: 0.9, radiance: 6) },
    objects: [
        (shape: quad(size: (30, 3)), material: "floor"),
        (shape: sphere(radius: 0.5, center: (0, 0.5, 0)), material: "ball"),
    ],
)"#;

fn until(error: f64, seed: u64, more: Options) -> Rendered {
    let until = Until { error: Some(error), seconds: None };
    let options = Options { seed: Some(seed), until, ..more };
    render::render(&focused(HALF).load(), &options, &Silent).expect("a render")
}

fn truth() -> &'static Image {
    static TRUTH: std::sync::OnceLock<Image> = std::sync::OnceLock::new();
    TRUTH.get_or_init(|| {
        let options = Options { passes: Some(0..2048), seed: Some(1000), ..Options::default() };
        render::render(&focused(HALF).load(), &options, &Silent).expect("a render").image
    })
}

/// The even wall is done after 16 passes, the shadow's edge is not; and the error is what it was to be.
#[test]
fn samples_go_where_the_error_is() {
    let mut held = 0;
    for seed in 0..6 {
        let found = until(0.004, seed, Options { aovs: vec![Aov::Samples], ..Options::default() });
        let accuracy = found.stats.accuracy.expect("several passes");
        assert!(accuracy.mean_passes < 0.8 * f64::from(accuracy.passes), "{accuracy:?}");
        let samples = found.image.layer("samples").expect("asked for").channels[0].1.clone();
        let at = |x: usize, y: usize| samples[y * 96 + x];
        assert_eq!(at(92, 2), 16.0);
        assert_eq!(samples.iter().copied().fold(0.0, f32::max), accuracy.passes as f32);
        let real = compare(&found.image, truth()).expect("one size").relative_rms;
        held += u32::from((0.002..0.0046).contains(&real));
    }
    assert!(held >= 5, "{held}");
}

/// That a pixel rests when it seems done is no reason for it to be darker or brighter: the mean of many such
/// renders is the truth within three standard deviations, and within a tenth of the error asked for.
#[test]
fn resting_does_not_shift_the_picture() {
    let mean = |image: &Image| {
        let rgb: Vec<f64> = image
            .layer("")
            .expect("the picture")
            .channels
            .iter()
            .flat_map(|c| c.1.iter().map(|v| f64::from(*v)))
            .collect();
        rgb.iter().sum::<f64>() / rgb.len() as f64
    };
    let real = mean(truth());
    let off: Vec<f64> =
        (0..24).map(|seed| mean(&until(0.02, seed, Options::default()).image) / real - 1.0).collect();
    let n = off.len() as f64;
    let average = off.iter().sum::<f64>() / n;
    let sigma = (off.iter().map(|x| (x - average) * (x - average)).sum::<f64>() / (n * (n - 1.0))).sqrt();
    assert!(average.abs() < 3.0 * sigma && average.abs() < 0.002, "{average:.2e} ± {sigma:.2e}");
}

/// Which pixels rest depends on the picture, not on tiles or threads.
#[test]
fn rest_is_the_same_for_all_tiles_and_threads() {
    let one = until(0.015, 3, Options { threads: Some(1), ..Options::default() });
    let other = until(0.015, 3, Options { threads: Some(3), tile: 7, ..Options::default() });
    let bits = |found: &Rendered| -> Vec<u32> {
        let layer = found.image.layer("").expect("the picture");
        layer.channels.iter().flat_map(|c| c.1.iter().map(|v| v.to_bits())).collect()
    };
    assert_eq!(one.stats.samples, other.stats.samples);
    assert!(bits(&one) == bits(&other));
}
