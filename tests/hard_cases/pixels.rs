//! Within and below a pixel: antialiasing, sums over passes, and their variance.

use super::proofs::prove;
use super::record::{Record, row, sized};
use crate::render::shot::{Picture, shot};
use terrarium::film::Film;
use terrarium::math::DVec3;
use terrarium::render::Aov;
use terrarium::trace::{Layer, Layers, PixelValue};

#[test]
fn s08_adaptive_antialiasing_ends() {
    row("S8", |row| {
        let half = f64::to_radians(15.0).tan();
        // 31 × 31: the centre of pixel (15, 15) is the middle of the image.
        let pixel = 2.0 * half * 5.0 / 31.0;
        let picture = shot(format!(
            r#"(camera: (eye: (0, 0, 5), target: (0, 0, 0), fov_deg: 30), image: (width: 31, height: 31), antialiasing: adaptive(threshold: 0.05, depth: 5),
            materials: {{ "glow": (emission: 1) }}, objects: [(shape: sphere(radius: {}), material: "glow")])"#,
            0.15 * pixel
        ))
        .render();
        let expected = std::f64::consts::PI * 0.15f64.powi(2);
        row.is_close(
            "a ball 0.3 pixels wide in a pixel's centre: its coverage of it",
            picture.at(15, 15),
            expected,
            0.1,
        );
        row.is_close("of the picture", picture.mean() * 961.0, expected, 0.1);
        let depth = sized(4, 6);
        let bright = edge(1e6, depth);
        let dim = edge(1e-6, depth);
        let most = |p: &Picture| p.channel("samples", "Y").iter().fold(0.0f32, |a, b| a.max(*b));
        let what = format!("cells of a pixel at an edge from 0 to 1e6, threshold 0, depth {depth}: 4^depth");
        row.at_most(&what, f64::from(most(&bright)), f64::from(4u32.pow(depth)));
        row.is(
            "samples taken, less those of the same edge at 1e-6",
            bright.rendered.stats.samples as f64 - dim.rendered.stats.samples as f64,
            0.0,
            0.0,
        );
        let off = bright.grey().into_iter().zip(dim.grey()).filter(|(_, b)| *b > 0.0);
        let off = off.map(|(a, b)| (a * 1e-12 / b - 1.0).abs()).fold(0.0, f64::max);
        row.at_most("pixels' difference, each by its exposure", off, 1e-6);
    });
}

/// A glowing sphere on black, every contrast followed down to the depth.
fn edge(radiance: f64, depth: u32) -> Picture {
    shot(format!(
        r#"(camera: (eye: (0, 0, 5), target: (0, 0, 0), fov_deg: 30), image: (width: 32, height: 32), antialiasing: adaptive(threshold: 0, depth: {depth}),
        materials: {{ "glow": (emission: {radiance:e}) }}, objects: [(shape: sphere(), material: "glow")])"#
    ))
    .aovs(&[Aov::Samples])
    .render()
}

#[test]
fn h45_features_below_a_pixel() {
    row("H45", |row| {
        prove(row, "wire");
        let picture = edge(1e6, 4);
        // The disk of the sphere's outline, in pixels.
        let radius = (1.0f64 / 24.0).sqrt() / f64::to_radians(15.0).tan() * 16.0;
        let area = std::f64::consts::PI * radius * radius;
        row.is_close(
            "a ball of radiance 1e6 on black: pixels that it covers",
            picture.mean() * 1024.0 / 1e6,
            area,
            2e-3,
        );
        let cells = picture.channel("samples", "Y").iter().fold(0.0f32, |a, b| a.max(*b));
        row.at_most("cells of its most divided pixel", f64::from(cells), 256.0);
    });
}

fn one_pixel(values: impl IntoIterator<Item = f64>) -> Film {
    let mut film = Film::new(1, 1, 1, Layers { variance: true, ..Layers::default() });
    for v in values {
        let value = PixelValue { radiance: DVec3::splat(v), samples: 1, ..PixelValue::default() };
        film.tiles[0].add(0, 0, &value);
    }
    film
}

#[test]
fn h40_a_million_passes() {
    row("H40", |row| {
        let film = one_pixel(std::iter::repeat_n(0.1, 1_000_000));
        let mean = film.tiles[0].mean(0).x;
        row.is("a million passes of 0.1, their mean times a million", mean * 1e6, 1e5, 1e-4);
        let naive = (0..1_000_000).fold(0.0f32, |sum, _| sum + 0.1);
        row.is("what a sum in single precision makes of it", f64::from(naive), 100_958.34, 0.01);
        tile_order(row);
    });
}

/// Tiles are worked on in another order when they are of another size.
fn tile_order(row: &mut Record) {
    let render = |tile| {
        let mut shot = shot(
            r#"(camera: (eye: (0, 1, 4), target: (0, 0.3, 0)), image: (width: 64, height: 48),
            materials: { "white": (diffuse: 0.8), "glass": (transmission: 1) },
            lights: { "lamp": sphere(center: (1, 4, 1), radius: 0.5, radiance: 9) },
            objects: [(shape: quad(size: (9, 9)), material: "white"), (shape: sphere(radius: 0.5, center: (0, 0.5, 0)), material: "glass")])"#,
        )
        .passes(8);
        shot.options.tile = tile;
        shot.render().bits()
    };
    let one = render(32);
    let sizes = [1, 5, 64];
    let differ = sizes.map(|tile| render(tile).iter().zip(&one).filter(|(a, b)| a != b).count() as u64);
    row.none(
        "values that differ with tiles of 1, 5 and 64 pixels from those of 32",
        differ.iter().sum(),
        3 * one.len() as u64,
    );
}

#[test]
fn h41_variance_of_few_samples() {
    row("H41", |row| {
        let n = 1000.0;
        let film = one_pixel((0..1000).map(|i| 1e8 + f64::from(i % 2)));
        let variance = f64::from(film.channels(Layer::Variance)[0][0]);
        // s² = n/(n−1)/4, of the mean the n-th part.
        row.is_close(
            "variance of the mean of 1e8 and 1e8 + 1 in turn, against two passes",
            variance,
            0.25 / (n - 1.0),
            1e-6,
        );
        let scene = r#"(camera: (eye: (0, 0, 5), target: (0, 0, 0)), image: (width: 4, height: 4))"#;
        let error = shot(scene).passes(1).aovs(&[Aov::Variance]).try_render().err();
        row.is(
            "exit code when the variance of one pass is asked for",
            error.map_or(0.0, |e| f64::from(e.exit_code())),
            2.0,
            0.0,
        );
        let one = shot(scene).passes(1).render();
        row.holds("the stated error of one pass is unknown, not 0", one.rendered.stats.accuracy.is_none());
    });
}
