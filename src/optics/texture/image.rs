//! Images on surfaces: wrapping, interpolation, and filtering over an elliptic footprint.
//!
//! v grows upwards: v = 0 is the lower edge of the image. Magnified images are interpolated
//! bilinearly. Minified ones are averaged by up to eight trilinear lookups along the footprint's major
//! axis, from the pyramid level that fits its minor one (after McCormack, Perry, Farkas, Jouppi: Feline,
//! SIGGRAPH 1999). Interpolation is a + (b − a)·t throughout, so that equal texels give exactly themselves.

use super::{Pyramid, TexturePoint};
use crate::math::Color;
use glam::DVec2;
use std::sync::Arc;

/// What lies outside of [0, 1].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageWrap {
    Repeat,
    Clamp,
    Mirror,
}

/// Where an image lies in (u, v): its own coordinates are uv·scale + offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImagePlacement {
    pub wrap: ImageWrap,
    pub scale: DVec2,
    pub offset: DVec2,
}

/// An image placed on a surface. Several may share the image.
#[derive(Clone, Debug)]
pub struct ImageTexture {
    pyramid: Arc<Pyramid>,
    placement: ImagePlacement,
}

/// Lookups along a footprint's major axis, at most.
const MAX_TAPS: f64 = 8.0;

impl ImageTexture {
    pub fn new(pyramid: Arc<Pyramid>, placement: ImagePlacement) -> ImageTexture {
        ImageTexture { pyramid, placement }
    }

    pub fn pyramid(&self) -> &Pyramid {
        &self.pyramid
    }

    /// Finite for any coordinates; those that are not finite count as 0.
    pub fn color(&self, at: &TexturePoint) -> Color {
        let place = &self.placement;
        let uv = at.uv * place.scale + place.offset;
        let size = DVec2::new(self.pyramid.width() as f64, self.pyramid.height() as f64);
        let to_texels = place.scale * size;
        let footprint = Footprint::new(at.duv[0] * to_texels, at.duv[1] * to_texels);
        if footprint.taps == 1 {
            return self.trilinear(uv, footprint.level).min(self.max());
        }
        // In double precision the sum of up to eight equal floats, and its division, are exact.
        let mut sum = glam::DVec3::ZERO;
        for i in 0..footprint.taps {
            let along = f64::from(2 * i + 1) / f64::from(footprint.taps) - 1.0;
            sum += self.trilinear(uv + footprint.major * along / size, footprint.level).as_dvec3();
        }
        (sum / f64::from(footprint.taps)).as_vec3a().min(self.max())
    }

    pub fn max(&self) -> Color {
        self.pyramid.max()
    }

    /// Half a texel.
    pub(super) fn step(&self) -> DVec2 {
        let size = DVec2::new(self.pyramid.width() as f64, self.pyramid.height() as f64);
        0.5 / (size * self.placement.scale.abs()).max(DVec2::splat(f64::MIN_POSITIVE))
    }

    /// `level` is fractional, at least 0.
    fn trilinear(&self, uv: DVec2, level: f64) -> Color {
        let last = self.pyramid.last();
        // The cast saturates, so that the level may be infinite.
        let fine = (level as usize).min(last);
        let color = self.bilinear(fine, uv);
        let t = (level - fine as f64) as f32;
        if fine == last || t <= 0.0 {
            return color;
        }
        color + (self.bilinear(fine + 1, uv) - color) * t
    }

    fn bilinear(&self, level: usize, uv: DVec2) -> Color {
        let (width, height) = self.pyramid.size(level);
        let wrap = self.placement.wrap;
        let ([x0, x1], tx) = neighbours(wrapped(uv.x, wrap), width, wrap);
        let ([y0, y1], ty) = neighbours(1.0 - wrapped(uv.y, wrap), height, wrap);
        let row = |y: usize| {
            let (a, b) = (self.pyramid.texel(level, x0, y), self.pyramid.texel(level, x1, y));
            a + (b - a) * tx
        };
        let (a, b) = (row(y0), row(y1));
        // Rounding may undershoot 0 by an ulp.
        (a + (b - a) * ty).max(Color::ZERO)
    }
}

/// A coordinate brought into [0, 1].
fn wrapped(x: f64, wrap: ImageWrap) -> f64 {
    if !x.is_finite() {
        return 0.0;
    }
    match wrap {
        ImageWrap::Repeat => x - x.floor(),
        ImageWrap::Clamp => x.clamp(0.0, 1.0),
        ImageWrap::Mirror => 1.0 - (x - 2.0 * (0.5 * x).floor() - 1.0).abs(),
    }
}

/// The two texels around a coordinate in [0, 1] along a side of `size` texels, and the weight of the
/// second.
fn neighbours(x: f64, size: usize, wrap: ImageWrap) -> ([usize; 2], f32) {
    let t = x * size as f64 - 0.5;
    let lower = t.floor();
    let last = size as i64 - 1;
    let index = |i: i64| match wrap {
        ImageWrap::Repeat => i.rem_euclid(size as i64) as usize,
        // The mirror image of the outermost texel is that texel.
        ImageWrap::Clamp | ImageWrap::Mirror => i.clamp(0, last) as usize,
    };
    ([index(lower as i64), index(lower as i64 + 1)], (t - lower) as f32)
}

/// The ellipse over which an image is averaged, in texels of level 0.
struct Footprint {
    /// Half of the major axis.
    major: DVec2,
    taps: u32,
    level: f64,
}

impl Footprint {
    /// From half axes that need not be orthogonal: the ellipse's own axes are the eigenvectors of
    /// the sum of their outer products.
    fn new(a: DVec2, b: DVec2) -> Footprint {
        let point = Footprint { major: DVec2::ZERO, taps: 1, level: 0.0 };
        let (xx, yy, xy) = (a.x * a.x + b.x * b.x, a.y * a.y + b.y * b.y, a.x * a.y + b.x * b.y);
        if xx + yy <= 0.25 {
            return point;
        }
        if !(xx + yy).is_finite() {
            return Footprint { level: f64::INFINITY, ..point };
        }
        let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
        let spread = (half * half + xy * xy).sqrt();
        let long = (mean + spread).sqrt();
        // Half a texel is as fine as the image goes.
        let short = (mean - spread).max(0.0).sqrt().max(long / MAX_TAPS).max(0.5);
        // Of two expressions of the eigenvector that without cancellation.
        let axis = if half >= 0.0 { DVec2::new(half + spread, xy) } else { DVec2::new(xy, spread - half) };
        Footprint {
            major: axis.normalize_or(DVec2::X) * long,
            taps: (long / short).ceil().clamp(1.0, MAX_TAPS) as u32,
            level: libm::log2(2.0 * short).max(0.0),
        }
    }
}
