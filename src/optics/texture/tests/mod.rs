//! Claims about textures, checked against closed forms and brute force.

mod images;
mod normals;
mod patterns;

use super::*;
use crate::math::random::{Counter, Stage};
use std::sync::Arc;

fn values(item: u64) -> Counter {
    Counter::new(11, Stage::Test, item)
}

/// Uniform in [−size, size].
fn within(values: &mut Counter, size: f64) -> f64 {
    (2.0 * values.value() - 1.0) * size
}

fn vector(values: &mut Counter) -> DVec3 {
    DVec3::new(within(values, 1.0), within(values, 1.0), within(values, 1.0))
}

fn black_white() -> Colors {
    Colors::new(Color::ZERO, Color::ONE)
}

fn image(width: usize, height: usize, texels: Texels, encoding: Encoding, wrap: ImageWrap) -> ImageTexture {
    let placement = ImagePlacement { wrap, scale: DVec2::ONE, offset: DVec2::ZERO };
    ImageTexture::new(Arc::new(Pyramid::new(width, height, texels, encoding)), placement)
}

/// A random image of floats.
fn random_image(width: usize, height: usize, wrap: ImageWrap) -> ImageTexture {
    let mut values = values(width as u64 * 1000 + height as u64);
    let texels = (0..width * height).map(|_| std::array::from_fn(|_| values.value() as f32)).collect();
    image(width, height, Texels::F32(texels), Encoding::Linear, wrap)
}

/// One texture of each kind.
fn all_kinds() -> Vec<Texture> {
    let colors = Colors::new(Color::new(0.1, 0.2, 0.3), Color::new(0.9, 0.5, 0.05));
    vec![
        Texture::Image(random_image(5, 3, ImageWrap::Repeat)),
        Texture::Image(random_image(1, 1, ImageWrap::Clamp)),
        Texture::Image(random_image(4, 7, ImageWrap::Mirror)),
        Texture::Checker(Checker::new(colors, DVec2::new(8.0, 3.0))),
        Texture::Checker3d(Checker3d::new(colors, 0.3)),
        Texture::Noise(Noise::new(colors, 0.5, 5)),
        Texture::Marble(Marble::new(colors, 0.5, 5)),
        Texture::Wood(Wood::new(colors, 0.1)),
        Texture::Brick(Brick::new(colors, DVec2::new(4.0, 8.0), 0.1)),
    ]
}

#[test]
fn every_lookup_is_finite_and_within_its_bound() {
    let odd =
        [0.0, -0.0, 1.0, -1.0, 0.5, 1e-300, 1e9, -1e9, 1e300, f64::INFINITY, f64::NEG_INFINITY, f64::NAN];
    for texture in all_kinds() {
        let max = texture.max();
        let check = |at: &TexturePoint| {
            let color = texture.color(at);
            assert!(color.is_finite() && color.min_element() >= 0.0, "{texture:?} at {at:?}: {color}");
            assert!(color.cmple(max).all(), "{texture:?} at {at:?}: {color} above {max}");
            assert!(texture.slope(at, DVec3::X, DVec3::new(0.0, 0.3, 1.0)).is_finite());
            assert!(texture.slope(at, DVec3::ZERO, DVec3::NAN).is_finite());
        };
        for a in odd {
            for b in odd {
                for size in odd {
                    let (uv, p) = (DVec2::new(a, b), DVec3::new(a, b, -a));
                    check(&TexturePoint {
                        uv,
                        duv: [DVec2::new(size, 0.0), DVec2::new(b, size)],
                        p,
                        dp: size,
                    });
                }
            }
        }
        let mut values = values(1);
        for _ in 0..2000 {
            let (uv, p) =
                (DVec2::new(within(&mut values, 3.0), within(&mut values, 3.0)), vector(&mut values));
            let d = DVec2::new(within(&mut values, 0.3), within(&mut values, 0.3));
            check(&TexturePoint { uv, duv: [d, d.perp() * values.value()], p, dp: values.value() });
        }
    }
}
