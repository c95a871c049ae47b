//! The estimate alone, on films whose passes are made up.

use super::Dice;
use terrarium::film::{Accuracy, Film, Rates};
use terrarium::math::DVec3;
use terrarium::trace::{Layers, PixelValue, Probes, Tile};

const SIDE: u32 = 48;

/// A film of `passes` passes of the values that `value` gives for a pixel's number and a pass.
fn film(passes: u32, mut value: impl FnMut(u32, u32) -> PixelValue) -> Film {
    let layers = Layers { probes: Some(Probes::of(SIDE, SIDE)), ..Layers::default() };
    let mut film = Film::new(SIDE, SIDE, 16, layers);
    for pass in 0..passes {
        for tile in &mut film.tiles {
            for (x, y) in tile.pixels() {
                tile.add(x, y, &value(y * SIDE + x, pass));
            }
        }
    }
    film
}

fn grey(v: f64) -> PixelValue {
    PixelValue { radiance: DVec3::splat(v), samples: 1, ..PixelValue::default() }
}

fn accuracy(film: &Film) -> Accuracy {
    film.accuracy().expect("two passes or more")
}

/// The true error of a film whose pixels should all be 1.
fn true_error(film: &Film) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for tile in &film.tiles {
        for i in 0..tile.pixels().count() {
            let off = tile.mean(i).x - 1.0;
            sum += off * off / 1.31;
            count += 1.0;
        }
    }
    f64::sqrt(sum / count)
}

/// What is kept for the error is at most 16 bytes a pixel, from half a megapixel on; of smaller pictures 10.4 MB.
#[test]
fn sixteen_bytes_a_pixel_are_kept() {
    for (width, height) in [(64, 64), (640, 480), (800, 639), (960, 540), (1920, 1080)] {
        let kept = Layers { probes: Some(Probes::of(width, height)), ..Layers::default() };
        let bytes = Tile::bytes_per_pixel(kept) - Tile::bytes_per_pixel(Layers::default());
        let pixels = f64::from(width * height);
        assert!(
            bytes <= 16.0 || pixels < 512_000.0 && bytes * pixels < 10.4e6,
            "{width} × {height}: {bytes}"
        );
    }
}

/// Independent passes of standard deviation σ: E = σ/√n/√1.31, for any number of passes.
#[test]
fn independent_noise_is_told_after_any_number_of_passes() {
    for passes in [2, 3, 4, 6, 8, 17, 32, 50] {
        let mut dice = Dice(7);
        let film = film(passes, |_, _| grey(1.0 + 0.3 * dice.normal()));
        let found = accuracy(&film);
        let expected = 0.3 / f64::from(passes).sqrt() / 1.31_f64.sqrt();
        // Two passes tell no rate: that of scenes, 1.4 in the middle, is assumed, where independent noise has 1
        // (√(2^1.4 − 1) = 1.28). More of them tell it, and the rate of scenes has less weight.
        let off = match passes {
            2 => 0.22,
            3..8 => 0.16,
            _ => 0.12,
        };
        assert!((found.error / expected - 1.0).abs() < off, "{passes}: {found:?}, expected {expected}");
        assert!(found.interval[0] < expected && expected < found.interval[1], "{passes}: {found:?}");
        assert_eq!(found.bias, 0.0);
    }
}

/// The interval holds the error of the very film in 90 of 100 or more.
#[test]
fn the_interval_holds_the_error_of_the_render_at_hand() {
    let held = (0..40).filter(|&seed| {
        let mut dice = Dice(seed);
        // A tenth of the pixels is ten times as noisy.
        let film = film(12, |pixel, _| {
            let sigma = if pixel % 10 == 0 { 1.0 } else { 0.1 };
            grey(1.0 + sigma * dice.normal())
        });
        let [low, high] = accuracy(&film).interval;
        (low..high).contains(&true_error(&film))
    });
    assert!(held.count() >= 36);
}

/// Passes that are well distributed together are better than independent ones, and are found to be.
#[test]
fn well_distributed_passes_are_not_taken_for_independent_ones() {
    // x + radical inverse of the pass in base 2, a line: its mean's variance falls as n^−2.
    let inverse = |i: u32| f64::from(i.reverse_bits()) / f64::from(u32::MAX);
    let mut dice = Dice(3);
    let shifts: Vec<f64> = (0..SIDE * SIDE).map(|_| dice.unit()).collect();
    for passes in [8, 16, 32, 64] {
        let film = film(passes, |pixel, pass| {
            let u = (shifts[pixel as usize] + inverse(pass)).fract();
            grey(1.0 + (u - 0.5))
        });
        let (found, truth) = (accuracy(&film), true_error(&film));
        assert!((0.6..1.6).contains(&(found.error / truth)), "{passes}: {found:?}, true {truth}");
        let independent = (1.0 / 12.0_f64).sqrt() / f64::from(passes).sqrt() / 1.31_f64.sqrt();
        assert!(found.error < 0.7 * independent);
    }
}

/// A bias that is hidden in noise twenty times its size is found, and its noise is not taken for it.
#[test]
fn bias_is_told_apart_from_its_noise() {
    for bias in [0.05, 0.0] {
        let mut dice = Dice(11);
        let film = film(64, |_, _| {
            let (light, guess) = (1.0 + bias + 0.1 * dice.normal(), bias + dice.normal());
            let caustic = DVec3::splat(light);
            PixelValue { caustic, bias: Some([[DVec3::splat(guess), DVec3::ZERO]; 2]), ..grey(light) }
        });
        let found = accuracy(&film);
        let expected = bias / ((1.0 + bias) * 1.31_f64.sqrt());
        assert!((found.bias - expected).abs() < 0.015, "{found:?}, expected {expected}");
        let caustic = found.by_effect.iter().find(|part| part.effect == "caustics").expect("its part");
        assert!(caustic.share > 0.99, "{found:?}");
    }
}

/// What a smaller radius shows beyond a larger one is stated where it is more than chance; noise alone is not.
#[test]
fn the_narrow_look_counts_where_it_sees_more() {
    for (narrow, noise, expected) in [(0.2, 1.0, 0.2), (0.05, 5.0, 0.05), (0.0, 5.0, 0.05)] {
        let mut dice = Dice(29);
        let film = film(64, |_, _| {
            let light = 1.0 + 0.1 * dice.normal();
            let look = |bias: f64| [DVec3::splat(bias), DVec3::ZERO];
            let bias = [look(0.05 + 0.1 * dice.normal()), look(narrow + noise * dice.normal())];
            PixelValue { caustic: DVec3::splat(light), bias: Some(bias), ..grey(light) }
        });
        let found = accuracy(&film);
        let expected = expected / 1.31_f64.sqrt();
        assert!((found.bias / expected - 1.0).abs() < 0.15, "{found:?}, expected {expected}");
    }
}

/// Of what differs from pass to pass, what does not differ at one place is the edges' part.
#[test]
fn edges_and_lamps_are_told_apart() {
    let mut dice = Dice(5);
    let film = film(32, |_, _| {
        let pair = DVec3::splat(0.1 * (dice.normal() - dice.normal()));
        PixelValue { pair: Some(pair), ..grey(1.0 + 0.2 * dice.normal() + 0.1 * dice.normal()) }
    });
    let found = accuracy(&film);
    let share = |effect| found.by_effect.iter().find(|part| part.effect == effect).expect("a part").share;
    assert!((share("edges") - 0.8).abs() < 0.05, "{found:?}");
    assert!((share("direct") - 0.2).abs() < 0.05);
}

/// Half the error of independent passes needs four times as many.
#[test]
fn the_price_of_half_the_error_is_four_times_the_passes() {
    let mut dice = Dice(13);
    let film = film(64, |_, _| grey(1.0 + 0.3 * dice.normal()));
    let found = accuracy(&film);
    let passes = found.passes_for(0.5 * found.error);
    assert!((200.0..330.0).contains(&passes), "{passes}");
    assert!((found.passes_for(found.error) / 64.0 - 1.0).abs() < 1e-6);
}

#[test]
fn one_pass_and_black_films_are_unknown() {
    assert_eq!(film(1, |_, _| grey(1.0)).accuracy(), None);
    assert_eq!(film(4, |_, _| grey(0.0)).accuracy(), None);
}

/// Photons' noise and bias fall as the plan says, and what halves the error follows from that.
#[test]
fn the_price_of_half_the_error_follows_the_radius() {
    let mut dice = Dice(9);
    let mut film = film(32, |_, _| {
        let caustic = DVec3::splat(1.0 + 0.3 * dice.normal());
        PixelValue { caustic, ..grey(caustic.x) }
    });
    for (alpha, factor) in [(2.0 / 3.0, 8.0), (0.9, 2f64.powf(2.0 / 0.9))] {
        film.rates = Rates::progressive(alpha);
        let found = accuracy(&film);
        let part = found.by_effect.iter().find(|part| part.effect == "caustics").expect("caustics");
        assert!((part.rate - alpha).abs() < 1e-12 && part.share > 0.99, "{found:?}");
        let passes = found.passes_for(0.5 * found.error) / 32.0;
        assert!((passes / factor - 1.0).abs() < 0.02, "{alpha}: {passes}");
    }
}
