//! Patterns against supersampling and their own symmetries.

use super::*;
use noise::{fbm, gradient_noise};

/// Mean of point lookups on a regular grid over the bounding box of the footprint.
fn supersampled(texture: &Texture, at: &TexturePoint, n: i32) -> f64 {
    let half = at.half_extent();
    let offset = |i: i32| (f64::from(2 * i + 1) / f64::from(n)) - 1.0;
    let mut sum = 0.0;
    for i in 0..n {
        for j in 0..n {
            let uv = at.uv + DVec2::new(offset(i), offset(j)) * half;
            sum += f64::from(texture.color(&TexturePoint::at(uv, at.p)).x);
        }
    }
    sum / f64::from(n * n)
}

#[test]
fn filtered_checkers_and_bricks_are_the_mean_over_the_footprint() {
    let mut values = values(7);
    let textures = [
        Texture::Checker(Checker::new(black_white(), DVec2::new(8.0, 3.0))),
        Texture::Checker(Checker::new(black_white(), DVec2::new(0.7, 40.0))),
        Texture::Brick(Brick::new(black_white(), DVec2::new(4.0, 8.0), 0.1)),
        Texture::Brick(Brick::new(black_white(), DVec2::new(3.0, 5.0), 0.4)),
    ];
    for texture in &textures {
        for _ in 0..40 {
            let size = libm::exp2(-6.0 * values.value());
            let duv = [vector(&mut values), vector(&mut values)].map(|d| d.truncate() * 0.3 * size);
            let at =
                TexturePoint { duv, ..TexturePoint::at(vector(&mut values).truncate() * 3.0, DVec3::ZERO) };
            let (filtered, brute) = (f64::from(texture.color(&at).x), supersampled(texture, &at, 400));
            // Each edge through the box is off by up to one of the 400 samples across it.
            assert!((filtered - brute).abs() < 0.012, "{texture:?} at {at:?}: {filtered}, not {brute}");
        }
    }
}

/// What is told at once of a reach is what every footprint within it sees.
#[test]
fn a_colour_that_is_told_at_once_is_that_of_every_footprint() {
    let (mut values, mut told) = (values(11), 0);
    let texture = Texture::Checker(Checker::new(black_white(), DVec2::new(8.0, 3.0)));
    for _ in 0..4_000 {
        let size = 0.3 * libm::exp2(-6.0 * values.value());
        let duv = [vector(&mut values), vector(&mut values)].map(|d| d.truncate() * size);
        let at = TexturePoint { duv, ..TexturePoint::at(vector(&mut values).truncate() * 3.0, DVec3::ZERO) };
        let half = at.half_extent();
        if let Some(color) = texture.color_within(at.uv, half * half * (1.0 + 1e-9)) {
            assert_eq!(texture.color(&at), color, "{at:?}");
            told += 1;
        }
    }
    assert!((1_000..3_900).contains(&told), "{told}");
}

#[test]
fn far_patterns_are_their_mean() {
    for texture in [
        Texture::Checker(Checker::new(black_white(), DVec2::new(100.0, 77.0))),
        Texture::Checker3d(Checker3d::new(black_white(), 0.01)),
    ] {
        for size in [0.5, 3.7, 1e6, 1e12] {
            let duv = [DVec2::new(size, 0.0), DVec2::new(0.0, size)];
            let at =
                TexturePoint { duv, dp: size, ..TexturePoint::at(DVec2::splat(0.3), DVec3::splat(0.123)) };
            assert!((texture.color(&at).x - 0.5).abs() < 1e-3, "{texture:?} {size}");
        }
    }
    // Running bond: the bricks' share is that of one brick in its cell.
    let brick = Texture::Brick(Brick::new(black_white(), DVec2::new(4.0, 4.0), 0.2));
    let at = TexturePoint {
        duv: [DVec2::new(50.0, 0.0), DVec2::new(0.0, 50.0)],
        ..TexturePoint::at(DVec2::ZERO, DVec3::ZERO)
    };
    assert!((brick.color(&at).x - 0.8 * 0.8).abs() < 1e-3);
}

/// The wood and marble profiles fade to the means that their formulas state.
#[test]
fn fading_keeps_the_mean_of_marble_and_wood() {
    for texture in
        [Texture::Marble(Marble::new(black_white(), 1.0, 4)), Texture::Wood(Wood::new(black_white(), 1.0))]
    {
        let (mut near, mut far) = (0.0, 0.0);
        let mut values = values(8);
        for _ in 0..20_000 {
            let at = TexturePoint::at(DVec2::ZERO, vector(&mut values) * 30.0);
            near += f64::from(texture.color(&at).x) / 20_000.0;
            far += f64::from(texture.color(&TexturePoint { dp: 100.0, ..at }).x) / 20_000.0;
        }
        assert!((near - far).abs() < 0.02, "{texture:?}: {near} near, {far} far");
    }
}

#[test]
fn checker_squares_start_at_the_origin_with_the_first_colour() {
    let checker = Texture::Checker(Checker::new(black_white(), DVec2::new(2.0, 4.0)));
    let at = |u, v| checker.color(&TexturePoint::at(DVec2::new(u, v), DVec3::ZERO)).x;
    assert_eq!(
        [at(0.1, 0.1), at(0.6, 0.1), at(0.1, 0.3), at(0.6, 0.3), at(-0.1, 0.1)],
        [0.0, 1.0, 1.0, 0.0, 1.0]
    );
}

#[test]
fn gradient_noise_is_zero_on_the_lattice_bounded_and_smooth() {
    let mut values = values(9);
    let (mut sum, mut square, mut largest) = (0.0, 0.0, 0.0f64);
    let n = 100_000;
    for _ in 0..n {
        let p = vector(&mut values) * 1000.0;
        let v = gradient_noise(p, 1);
        sum += v / f64::from(n);
        square += v * v / f64::from(n);
        largest = largest.max(v.abs());
        assert_eq!(gradient_noise(p.floor(), 1), 0.0);
    }
    assert!(sum.abs() < 0.005 && square > 0.04 && largest <= 1.0, "{sum} {square} {largest}");
    // The derivative does not jump at cell faces: differences on both sides of x = 5 agree.
    for _ in 0..200 {
        let p = DVec3::new(5.0, values.value() * 9.0, values.value() * 9.0);
        let h = 1e-4;
        let slope =
            |x: f64| (gradient_noise(p + DVec3::X * (x + h), 1) - gradient_noise(p + DVec3::X * x, 1)) / h;
        assert!((slope(-h) - slope(0.0)).abs() < 1e-2);
    }
}

#[test]
fn noise_loses_the_octaves_that_the_footprint_cannot_resolve() {
    let mut values = values(10);
    for _ in 0..500 {
        let p = vector(&mut values) * 5.0;
        assert_eq!(fbm(p, 0.0, 6, 3), fbm(p, 1.0 / 256.0, 6, 3));
        assert_eq!(fbm(p, 2.0, 6, 3), 0.0);
        // Footprint as large as octave 2's features: octaves 0 and 1 remain at most.
        let (coarse, two) = (fbm(p, 0.125, 6, 3), fbm(p, 0.0, 2, 3) * 1.5 / 1.96875);
        assert!((coarse - two).abs() < 1e-12);
    }
}

/// The slope of solid patterns through space is the directional derivative of the colour.
#[test]
fn slope_of_noise_is_its_directional_derivative() {
    let mut values = values(12);
    let texture = Noise::new(black_white(), 0.4, 3);
    for _ in 0..300 {
        let at = TexturePoint::at(DVec2::ZERO, vector(&mut values));
        let (dpdu, dpdv) = (vector(&mut values) * 7.0, vector(&mut values) * 0.01);
        let derivative = |d: DVec3| {
            let h = 1e-7;
            let shifted = |s: f64| texture.weight(&TexturePoint { p: at.p + d * s, ..at });
            (shifted(h) - shifted(-h)) / (2.0 * h)
        };
        let slope = Texture::Noise(texture.clone()).slope(&at, dpdu, dpdv);
        let exact = DVec2::new(derivative(dpdu), derivative(dpdv));
        assert!(
            (slope - exact).abs().cmple(DVec2::splat(1e-3) * exact.abs().max(DVec2::new(7.0, 0.01))).all()
        );
    }
}

#[test]
fn brick_edges_are_bevelled() {
    let brick = Texture::Brick(Brick::new(black_white(), DVec2::new(2.0, 4.0), 0.2));
    let slope = |u, v| brick.slope(&TexturePoint::at(DVec2::new(u, v), DVec3::ZERO), DVec3::X, DVec3::Y);
    // The middle of the first brick, its lower and upper edge, the joint.
    assert_eq!(slope(0.25, 0.125), DVec2::ZERO);
    assert!(slope(0.25, 0.25 * 0.15).y > 1.0 && slope(0.25, 0.25 * 0.85).y < -1.0);
    assert_eq!(slope(0.25, 0.25), DVec2::ZERO);
    // The second row is shifted by half a brick: its upright joint is at u = ¼.
    assert_eq!(brick.color(&TexturePoint::at(DVec2::new(0.25, 0.375), DVec3::ZERO)).x, 0.0);
}
