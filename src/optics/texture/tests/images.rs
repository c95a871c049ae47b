//! Image lookups: wrapping, filtering and what they must keep.

use super::*;

#[test]
fn srgb_table_is_the_standard_curve() {
    let table = srgb8_to_linear();
    for (code, &linear) in table.iter().enumerate() {
        let v = code as f64 / 255.0;
        let exact = if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) };
        // Nothing but the rounding to single precision.
        assert!((f64::from(linear) - exact).abs() <= exact * 0.5001 * f64::from(f32::EPSILON), "{code}");
    }
    assert_eq!((table[0], table[255]), (0.0, 1.0));
}

/// Interpolation, all levels, and the taps along a footprint have weights that add up to one exactly.
#[test]
fn constant_image_is_the_same_bits_under_every_footprint() {
    let mut values = values(2);
    for (width, height) in [(1, 1), (2, 2), (7, 5), (64, 48), (1, 100), (33, 1)] {
        for (texels, encoding) in [
            (Texels::U8(vec![[128, 128, 255]; width * height]), Encoding::Linear),
            (Texels::U8(vec![[3, 77, 201]; width * height]), Encoding::Srgb),
            (Texels::U16(vec![[1, 30000, 65535]; width * height]), Encoding::Srgb),
            (Texels::F32(vec![[0.1, 0.3, 123.7]; width * height]), Encoding::Linear),
        ] {
            let texture = image(width, height, texels, encoding, ImageWrap::Repeat);
            let expected = texture.pyramid().texel(0, 0, 0);
            for _ in 0..200 {
                let size = libm::exp2(within(&mut values, 8.0) - 4.0);
                let duv = [vector(&mut values), vector(&mut values)].map(|d| d.truncate() * size);
                let at =
                    TexturePoint { duv, ..TexturePoint::at(vector(&mut values).truncate(), DVec3::ZERO) };
                assert_eq!(texture.color(&at), expected, "{width} × {height}, {duv:?}");
            }
        }
    }
}

#[test]
fn every_level_has_the_mean_of_the_image() {
    for (width, height) in [(64, 64), (37, 53), (3, 1000), (2, 3), (255, 1)] {
        let texture = random_image(width, height, ImageWrap::Repeat);
        let pyramid = texture.pyramid();
        let mean = |level| {
            let (w, h) = pyramid.size(level);
            let texels = (0..h).flat_map(|y| (0..w).map(move |x| (x, y)));
            texels.map(|(x, y)| pyramid.texel(level, x, y).as_dvec3()).sum::<DVec3>() / (w * h) as f64
        };
        let exact = mean(0);
        for level in 1..=pyramid.last() {
            assert!((mean(level) - exact).abs().max_element() < 1e-6, "{width} × {height}, level {level}");
        }
        assert_eq!(pyramid.size(pyramid.last()), (1, 1));
    }
}

/// A black and white checkerboard of bytes, seen from afar, is half of the light, not half of the codes.
#[test]
fn far_checkerboard_image_is_grey_in_linear_light() {
    let texels = (0..256 * 256).map(|i| [if (i + i / 256) % 2 == 0 { 0 } else { 255 }; 3]).collect();
    let texture = image(256, 256, Texels::U8(texels), Encoding::Srgb, ImageWrap::Repeat);
    for size in [0.02, 0.1, 0.5, 3.0, 1e6] {
        let duv = [DVec2::new(size, 0.0), DVec2::new(0.0, size)];
        let at = TexturePoint { duv, ..TexturePoint::at(DVec2::new(0.3, 0.7), DVec3::ZERO) };
        assert!((texture.color(&at).x - 0.5).abs() < 1e-6, "{size}: {}", texture.color(&at));
    }
}

/// At a texel's centre the lookup is that texel, the first row being the upper one; v grows upwards.
#[test]
fn texel_centres_give_their_texels_and_v_grows_upwards() {
    for wrap in [ImageWrap::Repeat, ImageWrap::Clamp, ImageWrap::Mirror] {
        let texture = random_image(4, 8, wrap);
        for y in 0..8 {
            for x in 0..4 {
                let uv = DVec2::new((x as f64 + 0.5) / 4.0, 1.0 - (y as f64 + 0.5) / 8.0);
                let color = texture.color(&TexturePoint::at(uv, DVec3::ZERO));
                assert_eq!(color, texture.pyramid().texel(0, x, y), "{wrap:?} {x} {y}");
            }
        }
    }
}

#[test]
fn wrap_modes_agree_at_the_edges_and_far_away() {
    let color = |t: &ImageTexture, u: f64, v: f64| t.color(&TexturePoint::at(DVec2::new(u, v), DVec3::ZERO));
    let [repeat, clamp, mirror] =
        [ImageWrap::Repeat, ImageWrap::Clamp, ImageWrap::Mirror].map(|wrap| random_image(4, 4, wrap));
    for i in 0..64 {
        // A multiple of 2⁻⁶, so that adding whole numbers is exact.
        let (u, v) = (f64::from(i) / 64.0, 0.40625);
        for shift in [1.0, -1.0, -7.0, 1e9] {
            assert_eq!(color(&repeat, u, v), color(&repeat, u + shift, v));
            assert_eq!(color(&repeat, v, u), color(&repeat, v, u + shift));
        }
        assert_eq!(color(&mirror, u, v), color(&mirror, -u, v));
        assert_eq!(color(&mirror, u, v), color(&mirror, 2.0 - u, v));
        assert_eq!(color(&mirror, u, v), color(&mirror, u + 1e9, v));
        assert_eq!(color(&clamp, -3.0, u), color(&clamp, 0.0, u));
        assert_eq!(color(&clamp, 1e9, u), color(&clamp, 1.0, u));
    }
    assert_eq!(color(&repeat, 1.0, 0.3), color(&repeat, 0.0, 0.3));
}

/// The filter is a soft one, so it is compared on an image that is smooth over texels: a sine of period
/// 16 texels, averaged over one period.
#[test]
fn elongated_footprints_average_along_themselves_only() {
    let n = 128;
    let wave = |x: f64| 0.5 + 0.5 * libm::sin(2.0 * std::f64::consts::PI * x * 8.0);
    let texels = (0..n * n).map(|i| [wave(((i % n) as f64 + 0.5) / n as f64) as f32; 3]).collect();
    let texture = image(n, n, Texels::F32(texels), Encoding::Linear, ImageWrap::Repeat);
    for uv in [DVec2::new(0.03, 0.5), DVec2::new(0.62, 0.1)] {
        // Along the crests: nothing is lost. Across them: the mean.
        let (long, short) = (8.0 / n as f64, 1.0 / n as f64);
        let along = TexturePoint {
            duv: [DVec2::new(0.0, long), DVec2::new(short, 0.0)],
            ..TexturePoint::at(uv, DVec3::ZERO)
        };
        let across = TexturePoint {
            duv: [DVec2::new(long, 0.0), DVec2::new(0.0, short)],
            ..TexturePoint::at(uv, DVec3::ZERO)
        };
        let (sharp, blurred) = (f64::from(texture.color(&along).x), f64::from(texture.color(&across).x));
        assert!((sharp - wave(uv.x)).abs() < 0.12, "{sharp} for {}", wave(uv.x));
        assert!((blurred - 0.5).abs() < 0.02, "{blurred}");
    }
}

/// h = sin on an image fine enough for it: the slope is the cosine.
#[test]
fn slope_of_a_height_image_is_its_derivative() {
    let n = 512;
    let tau = 2.0 * std::f64::consts::PI;
    let height = |u: f64, v: f64| 0.5 + 0.2 * libm::sin(tau * u) + 0.2 * libm::cos(2.0 * tau * v);
    let texels = (0..n * n)
        .map(|i| {
            [height(((i % n) as f64 + 0.5) / n as f64, 1.0 - ((i / n) as f64 + 0.5) / n as f64) as f32; 3]
        })
        .collect();
    let texture = Texture::Image(image(n, n, Texels::F32(texels), Encoding::Linear, ImageWrap::Repeat));
    let mut values = values(3);
    for _ in 0..500 {
        let [u, v] = values.pair();
        let slope = texture.slope(&TexturePoint::at(DVec2::new(u, v), DVec3::ZERO), DVec3::X, DVec3::Y);
        let exact = DVec2::new(0.2 * tau * libm::cos(tau * u), -0.4 * tau * libm::sin(2.0 * tau * v));
        assert!((slope - exact).length() < 0.02, "({u}, {v}): {slope}, not {exact}");
    }
}
