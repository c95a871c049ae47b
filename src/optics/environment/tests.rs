//! Directions and densities of environments against each other.

use super::*;
use crate::math::random::{Counter, Stage};

fn values(item: u64) -> Counter {
    Counter::new(23, Stage::Test, item)
}

fn random_map(width: usize, height: usize) -> Environment {
    let mut values = values(width as u64);
    // Mostly black, with a few very bright texels.
    let texels = (0..width * height).map(|_| {
        let v = values.value();
        if v < 0.6 { Vec3::ZERO } else { Vec3::new(0.3, 1.0, 0.1) * (v * v * v * 100.0 - 21.0) as f32 }
    });
    Environment::image(width, height, texels.collect())
}

fn environments() -> Vec<(&'static str, Environment)> {
    let (zenith, horizon, nadir) = (Color::new(0.1, 0.3, 2.0), Color::new(0.0, 0.2, 0.1), Color::ZERO);
    vec![
        ("constant", Environment::constant(Color::new(0.2, 0.5, 1.0))),
        ("gradient", Environment::gradient(zenith, horizon, nadir).with_scale(3.0)),
        ("dark horizon", Environment::gradient(zenith, Color::ZERO, horizon)),
        ("nadir only", Environment::gradient(Color::ZERO, Color::ZERO, Color::ONE)),
        ("map", random_map(16, 8)),
        ("turned map", random_map(12, 7).with_turn_deg(75.0).with_scale(0.1)),
        ("one texel", Environment::image(1, 1, vec![Vec3::ONE])),
        ("one row", random_map(9, 1)),
        ("one column", random_map(1, 9)),
    ]
}

/// Midpoint quadrature over the sphere in angles, in parts whose edges include those of all maps' cells.
fn integral(f: impl Fn(DVec3) -> f64) -> f64 {
    let (columns, rows) = (288, 1008);
    let mut sum = 0.0;
    for i in 0..rows {
        let theta = (f64::from(i) + 0.5) / f64::from(rows) * PI;
        let mut row = 0.0;
        for j in 0..columns {
            row += f(direction(libm::cos(theta), (f64::from(j) + 0.5) / f64::from(columns) * 2.0 * PI));
        }
        sum += row * libm::sin(theta);
    }
    sum * (PI / f64::from(rows)) * (2.0 * PI / f64::from(columns))
}

#[test]
fn density_integrates_to_one() {
    for (name, environment) in environments() {
        let total = integral(|dir| environment.pdf(dir));
        assert!((total - 1.0).abs() < 1e-3, "{name}: {total}");
    }
}

#[test]
fn mean_radiance_is_the_integral_over_the_sphere() {
    for (name, environment) in environments() {
        let exact = integral(|dir| luminance(environment.radiance(dir))) / (4.0 * PI);
        let mean = luminance(environment.mean_radiance());
        assert!((mean - exact).abs() < 1e-3 * exact, "{name}: {mean}, not {exact}");
    }
}

#[test]
fn light_comes_from_no_direction_that_is_never_sampled() {
    let mut values = values(1);
    for (name, environment) in environments() {
        for _ in 0..20_000 {
            let dir = direction(2.0 * values.value() - 1.0, 2.0 * PI * values.value());
            let dark = environment.radiance(dir) == Color::ZERO;
            assert!(dark || environment.pdf(dir) > 0.0, "{name}: {dir}");
        }
    }
}

/// Of luminance, and of a function that has nothing to do with it; the sample's own values agree with
/// those of its direction.
#[test]
fn estimates_agree_with_integrals_within_three_standard_errors() {
    let n = 40_000;
    for (name, environment) in environments() {
        let weight = |dir: DVec3| luminance(environment.radiance(dir)) * (1.2 + dir.x - 0.5 * dir.z * dir.y);
        let exact = integral(weight);
        let (mut sum, mut square) = (0.0, 0.0);
        let mut values = values(2);
        for _ in 0..n {
            let sample = environment.sample(values.pair()).expect("it is not black");
            assert!((sample.dir.length() - 1.0).abs() < 1e-12);
            assert_eq!(sample.radiance, environment.radiance(sample.dir));
            let pdf = environment.pdf(sample.dir);
            assert!((sample.pdf - pdf).abs() <= 1e-6 * pdf, "{name}: {} and {pdf}", sample.pdf);
            let v = weight(sample.dir) / sample.pdf;
            sum += v;
            square += v * v;
        }
        let mean = sum / f64::from(n);
        let error = ((square / f64::from(n) - mean * mean).max(0.0) / f64::from(n)).sqrt();
        assert!((mean - exact).abs() < 3.0 * error + 1e-4 * exact, "{name}: {mean} ± {error}, not {exact}");
    }
}

/// χ² over 24 × 12 bins of the two angles, at significance 1e-3 for each environment. The expected
/// counts are summed over 288 × 1008 parts, within each of which every map here has one density.
#[test]
fn sampled_directions_follow_the_density() {
    let (columns, rows, fine_x, fine_y) = (24usize, 12usize, 12usize, 84usize);
    let n = 100_000;
    for (name, environment) in environments() {
        let mut counts = vec![0.0; columns * rows];
        let mut values = values(3);
        let bin = |x: f64, y: f64| {
            let (i, j) = ((y * rows as f64) as usize, (x * columns as f64) as usize);
            i.min(rows - 1) * columns + j.min(columns - 1)
        };
        for _ in 0..n {
            let d = environment.sample(values.pair()).expect("it is not black").dir;
            counts[bin(libm::atan2(d.x, -d.z) / (2.0 * PI) + 0.5, libm::acos(d.y) / PI)] += 1.0;
        }
        let mut expected = vec![0.0; columns * rows];
        let (width, height) = (columns * fine_x, rows * fine_y);
        for i in 0..height {
            let y = (i as f64 + 0.5) / height as f64;
            let part = libm::sin(y * PI) * (PI / height as f64) * (2.0 * PI / width as f64) * f64::from(n);
            for j in 0..width {
                let x = (j as f64 + 0.5) / width as f64;
                let dir = direction(libm::cos(y * PI), (2.0 * x - 1.0) * PI);
                expected[bin(x, y)] += environment.pdf(dir) * part;
            }
        }
        // Bins of fewer than 10 expected are pooled.
        let (mut chi2, mut bins, mut pooled) = (0.0, 0, (0.0, 0.0));
        for (c, e) in counts.iter().zip(&expected) {
            if *e < 10.0 {
                pooled = (pooled.0 + c, pooled.1 + e);
            } else {
                chi2 += (c - e).powi(2) / e;
                bins += 1;
            }
        }
        if pooled.1 >= 10.0 {
            chi2 += (pooled.0 - pooled.1).powi(2) / pooled.1;
            bins += 1;
        } else {
            assert!(pooled.0 <= pooled.1 + 4.0 * f64::sqrt(pooled.1), "{name}: {pooled:?}");
        }
        // Wilson & Hilferty's quantile of χ² at 1 − 1e-3.
        let k = f64::from((bins - 1).max(1));
        let limit = k * (1.0 - 2.0 / (9.0 * k) + 3.09 * (2.0 / (9.0 * k)).sqrt()).powi(3);
        assert!(chi2 < limit, "{name}: χ² = {chi2} with {k} degrees of freedom, limit {limit}");
    }
}

/// A sun of one texel: every sample is near it, and the estimate of its flux has a small variance.
#[test]
fn sun_of_one_texel_is_found_by_every_sample() {
    let (width, height) = (256, 128);
    let mut texels = vec![Vec3::ZERO; width * height];
    texels[30 * width + 200] = Vec3::splat(1e6);
    let environment = Environment::image(width, height, texels);
    let sun = direction(libm::cos(30.5 / 128.0 * PI), (200.5 / 256.0 - 0.5) * 2.0 * PI);
    let mut values = values(4);
    let (mut sum, n) = (0.0, 10_000);
    for _ in 0..n {
        let sample = environment.sample(values.pair()).expect("there is a sun");
        assert!(sample.dir.dot(sun) > libm::cos(0.05), "{}", sample.dir);
        let v = luminance(sample.radiance) / sample.pdf;
        sum += v / f64::from(n);
        assert!(v <= 4.01 * 4.0 * PI * luminance(environment.mean_radiance()));
    }
    let exact = 4.0 * PI * luminance(environment.mean_radiance());
    assert!((sum - exact).abs() < 0.05 * exact, "{sum}, not {exact}");
}

#[test]
fn black_environments_have_no_samples() {
    let black = [
        Environment::constant(Color::ZERO),
        Environment::gradient(Color::ZERO, Color::ZERO, Color::ZERO),
        Environment::image(4, 2, vec![Vec3::ZERO; 8]),
        Environment::image(0, 0, Vec::new()),
        Environment::image(4, 2, vec![Vec3::splat(f32::NAN); 8]),
        Environment::constant(Color::ONE).with_scale(0.0),
        random_map(8, 4).with_scale(0.0),
        random_map(8, 4).with_scale(1e-60),
    ];
    for environment in black {
        assert_eq!(environment.sample([0.3, 0.7]), None);
        assert_eq!(environment.pdf(DVec3::Y), 0.0);
        assert_eq!(environment.radiance(DVec3::X), Color::ZERO);
    }
}

#[test]
fn extreme_random_values_and_directions_stay_finite() {
    let last = 1.0 - f64::EPSILON / 2.0;
    for (name, environment) in environments() {
        for u in [[0.0, 0.0], [last, last], [0.0, last], [last, 0.0]] {
            let s = environment.sample(u).expect("it is not black");
            assert!(
                s.dir.is_finite() && s.pdf.is_finite() && s.pdf >= 0.0 && s.radiance.is_finite(),
                "{name} {s:?}"
            );
        }
        for dir in [DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NAN, DVec3::ZERO] {
            assert!(environment.radiance(dir).is_finite() || dir.is_nan(), "{name} {dir}");
        }
    }
}

/// Centre column toward −z, columns to the right toward +x, rows down from the zenith; a turn of 90°
/// about +y brings what was at −z to −x.
#[test]
fn image_lies_as_documented() {
    let (width, height) = (8, 4);
    let texels = (0..width * height).map(|i| Vec3::new((i % width) as f32, (i / width) as f32, 1.0));
    let environment = Environment::image(width, height, texels.collect());
    let at = |d: DVec3| environment.radiance(d.normalize());
    // Between columns 3 and 4, 5 and 6, 1 and 2.
    assert!((at(DVec3::NEG_Z).x - 3.5).abs() < 1e-5);
    assert!((at(DVec3::X).x - 5.5).abs() < 1e-5);
    assert!((at(DVec3::NEG_X).x - 1.5).abs() < 1e-5);
    assert_eq!((at(DVec3::Y).y, at(DVec3::NEG_Y).y), (0.0, 3.0));
    assert!((at(DVec3::X).y - 1.5).abs() < 1e-5);
    let turned = environment.with_turn_deg(90.0);
    assert!((turned.radiance(DVec3::NEG_X).x - 3.5).abs() < 1e-5);
}
