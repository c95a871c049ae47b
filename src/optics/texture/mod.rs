//! Textures: colour as a function of the surface point and of the ray's footprint on it.
//!
//! A lookup is filtered over the footprint, so that a pattern that is too fine for the ray gives its
//! mean and not an alias. Patterns of two colours are a weight in [0, 1] between them, computed in
//! double precision; images are pyramids of box-filtered levels. Every lookup is finite and not
//! negative, whatever the coordinates are.

mod brick;
mod bump;
mod checker;
mod filter;
mod image;
mod noise;
mod pyramid;
mod solid;
mod srgb;

pub use brick::Brick;
pub use bump::{bumped_normal, perturbed_normal_from_map};
pub use checker::{Checker, Checker3d};
pub use image::{ImagePlacement, ImageTexture, ImageWrap};
pub use noise::Noise;
pub use pyramid::{Encoding, Pyramid, Texels};
pub use solid::{Marble, Wood};
pub use srgb::{srgb_to_linear, srgb8_to_linear};

use crate::math::Color;
use glam::{DVec2, DVec3};

/// Where a texture is looked up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexturePoint {
    pub uv: DVec2,
    /// Half axes of the ray's footprint in (u, v); zero looks up a point.
    pub duv: [DVec2; 2],
    /// Object space.
    pub p: DVec3,
    /// Radius of the footprint in object space.
    pub dp: f64,
}

impl TexturePoint {
    /// A lookup without a footprint.
    pub fn at(uv: DVec2, p: DVec3) -> TexturePoint {
        TexturePoint { uv, duv: [DVec2::ZERO; 2], p, dp: 0.0 }
    }

    /// Half extents of the footprint's bounding box along u and v; never NaN.
    #[inline]
    fn half_extent(&self) -> DVec2 {
        let [a, b] = self.duv;
        let extent = |x: f64, y: f64| {
            let e = (x * x + y * y).sqrt();
            if e.is_nan() { 0.0 } else { e }
        };
        DVec2::new(extent(a.x, b.x), extent(a.y, b.y))
    }

    /// The footprint's radius in object space; never negative, never NaN.
    fn radius(&self) -> f64 {
        self.dp.max(0.0)
    }
}

/// Luminance of linear Rec. 709 colours.
pub const LUMINANCE: DVec3 = DVec3::new(0.2126, 0.7152, 0.0722);

/// A colour pattern.
#[derive(Clone, Debug)]
pub enum Texture {
    Image(ImageTexture),
    Checker(Checker),
    Checker3d(Checker3d),
    Noise(Noise),
    Marble(Marble),
    Wood(Wood),
    Brick(Brick),
}

impl Texture {
    /// Linear Rec. 709, each channel finite and at least 0.
    pub fn color(&self, at: &TexturePoint) -> Color {
        match self {
            Texture::Image(t) => t.color(at),
            Texture::Checker(t) => t.colors.blend(t.weight(at)),
            Texture::Checker3d(t) => t.colors.blend(t.weight(at)),
            Texture::Noise(t) => t.colors.blend(t.weight(at)),
            Texture::Marble(t) => t.colors.blend(t.weight(at)),
            Texture::Wood(t) => t.colors.blend(t.weight(at)),
            Texture::Brick(t) => t.colors.blend(t.weight(at)),
        }
    }

    /// The colour at `uv`, if it is the same everywhere within the roots of `reach2` along u and v and that can be
    /// told at once: what [`Texture::color`] finds of every footprint in there.
    #[inline]
    pub fn color_within(&self, uv: DVec2, reach2: DVec2) -> Option<Color> {
        match self {
            Texture::Checker(checker) => checker.color_within(uv, reach2),
            _ => None,
        }
    }

    /// The mean colour: what a footprint that covers all of it sees.
    pub fn mean(&self) -> Color {
        // Wide enough for every filter, and its square still finite.
        let wide = 1e30;
        let duv = [DVec2::new(wide, 0.0), DVec2::new(0.0, wide)];
        self.color(&TexturePoint { uv: DVec2::ZERO, duv, p: DVec3::ZERO, dp: wide })
    }

    /// No lookup exceeds this, channel by channel.
    pub fn max(&self) -> Color {
        match self {
            Texture::Image(t) => t.max(),
            Texture::Checker(t) => t.colors.max(),
            Texture::Checker3d(t) => t.colors.max(),
            Texture::Noise(t) => t.colors.max(),
            Texture::Marble(t) => t.colors.max(),
            Texture::Wood(t) => t.colors.max(),
            Texture::Brick(t) => t.colors.max(),
        }
    }

    /// Heap and own size. Textures that share an image count it once each.
    pub fn memory_bytes(&self) -> usize {
        let shared = if let Texture::Image(t) = self { t.pyramid().memory_bytes() } else { 0 };
        size_of::<Texture>() + shared
    }

    /// (∂h/∂u, ∂h/∂v) of the texture's luminance as a height field, on a surface with these
    /// derivatives of its points. Central differences: over half a texel or a small part of the
    /// pattern's smallest feature, or over the footprint where that is larger.
    pub fn slope(&self, at: &TexturePoint, dpdu: DVec3, dpdv: DVec3) -> DVec2 {
        let slope = match self {
            Texture::Image(t) => across_uv(at, t.step(), |q| LUMINANCE.dot(t.color(q).as_dvec3())),
            Texture::Checker(t) => t.colors.contrast() * across_uv(at, t.step(), |q| t.weight(q)),
            Texture::Brick(t) => t.colors.contrast() * across_uv(at, t.step(), |q| t.height(q)),
            Texture::Checker3d(t) => {
                t.colors.contrast() * across_space(at, [dpdu, dpdv], t.step(), |q| t.weight(q))
            }
            Texture::Noise(t) => {
                t.colors.contrast() * across_space(at, [dpdu, dpdv], t.step(), |q| t.weight(q))
            }
            Texture::Marble(t) => {
                t.colors.contrast() * across_space(at, [dpdu, dpdv], t.step(), |q| t.weight(q))
            }
            Texture::Wood(t) => {
                t.colors.contrast() * across_space(at, [dpdu, dpdv], t.step(), |q| t.weight(q))
            }
        };
        if slope.is_finite() { slope } else { DVec2::ZERO }
    }
}

/// The two colours of a pattern: weight 0 is `a`, 1 is `b`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Colors {
    a: Color,
    b: Color,
}

impl Colors {
    /// Negative and non-finite channels become 0.
    pub fn new(a: Color, b: Color) -> Colors {
        let clean =
            |c: Color| Color::from(c.to_array().map(|x| if x.is_finite() { x.max(0.0) } else { 0.0 }));
        Colors { a: clean(a), b: clean(b) }
    }

    #[inline]
    fn blend(&self, weight: f64) -> Color {
        let w = weight.clamp(0.0, 1.0) as f32;
        self.a * (1.0 - w) + self.b * w
    }

    /// An upper bound of [`Colors::blend`], its rounding included.
    fn max(&self) -> Color {
        Color::from(self.a.max(self.b).to_array().map(|x| (x * (1.0 + 2.0 * f32::EPSILON)).min(f32::MAX)))
    }

    /// Luminance of `b` above that of `a`.
    fn contrast(&self) -> f64 {
        LUMINANCE.dot(self.b.as_dvec3() - self.a.as_dvec3())
    }
}

/// Central differences of `height` in (u, v); `step` is half their width.
fn across_uv(at: &TexturePoint, step: DVec2, height: impl Fn(&TexturePoint) -> f64) -> DVec2 {
    let step = step.max(at.half_extent());
    let along = |d: DVec2, h: f64| {
        let shifted = |s: f64| height(&TexturePoint { uv: at.uv + d * s, ..*at });
        (shifted(h) - shifted(-h)) / (2.0 * h)
    };
    DVec2::new(along(DVec2::X, step.x), along(DVec2::Y, step.y))
}

/// Central differences of `height` through space along ∂p/∂u and ∂p/∂v; `step` in metres.
fn across_space(
    at: &TexturePoint,
    tangents: [DVec3; 2],
    step: f64,
    height: impl Fn(&TexturePoint) -> f64,
) -> DVec2 {
    let step = step.max(at.radius());
    let [u, v] = tangents.map(|d| {
        let length = d.length();
        if length == 0.0 {
            return 0.0;
        }
        let shifted = |s: f64| height(&TexturePoint { p: at.p + d * (s / length), ..*at });
        (shifted(step) - shifted(-step)) / (2.0 * step) * length
    });
    DVec2::new(u, v)
}

#[cfg(test)]
mod tests;
