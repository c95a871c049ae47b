//! The image pyramid (Williams, Pyramidal Parametrics, SIGGRAPH 1983).
//!
//! Level 0 keeps the file's own numbers, bytes as bytes; every further level halves both sides
//! (rounded down) by an exact area-weighted box filter in linear light and is stored as floats, so that
//! the mean is kept on every level and a constant image is the same constant on all of them. Memory a
//! texel, all levels: 7 bytes for 8-bit images, 10 for 16-bit, 16 for float.

use super::srgb::{linear8, linear16, srgb_to_linear, srgb8_to_linear, srgb16_to_linear};
use crate::math::Color;

/// An image's numbers as its file gives them: red, green, blue by rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub enum Texels {
    U8(Vec<[u8; 3]>),
    U16(Vec<[u16; 3]>),
    F32(Vec<[f32; 3]>),
}

/// What an image's numbers mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Encoding {
    Srgb,
    Linear,
}

/// Level 0, with the table that decodes it.
#[derive(Debug)]
enum Base {
    U8(Vec<[u8; 3]>, &'static [f32; 256]),
    U16(Vec<[u16; 3]>, &'static [f32]),
    F32(Vec<[f32; 3]>),
}

#[derive(Debug)]
struct Level {
    width: usize,
    height: usize,
    texels: Vec<[f32; 3]>,
}

/// An image with all its levels. The last level is one texel, the mean of the image.
#[derive(Debug)]
pub struct Pyramid {
    width: usize,
    height: usize,
    base: Base,
    levels: Vec<Level>,
    max: Color,
}

impl Pyramid {
    /// Missing texels are black and surplus ones are ignored; a side of 0 counts as 1. NaN and
    /// negative numbers become 0 and infinities the largest float.
    pub fn new(width: usize, height: usize, texels: Texels, encoding: Encoding) -> Pyramid {
        let (width, height) = (width.max(1), height.max(1));
        let count = width * height;
        let srgb = encoding == Encoding::Srgb;
        let base = match texels {
            Texels::U8(mut t) => {
                t.resize(count, [0; 3]);
                Base::U8(t, if srgb { srgb8_to_linear() } else { linear8() })
            }
            Texels::U16(mut t) => {
                t.resize(count, [0; 3]);
                Base::U16(t, if srgb { srgb16_to_linear() } else { linear16() })
            }
            Texels::F32(mut t) => {
                t.resize(count, [0.0; 3]);
                for v in t.iter_mut().flatten() {
                    let linear = if srgb { srgb_to_linear(f64::from(*v)) as f32 } else { *v };
                    *v = if linear > 0.0 { linear.min(f32::MAX) } else { 0.0 };
                }
                Base::F32(t)
            }
        };
        let mut pyramid = Pyramid { width, height, base, levels: Vec::new(), max: Color::ZERO };
        for y in 0..height {
            for x in 0..width {
                pyramid.max = pyramid.max.max(pyramid.texel(0, x, y));
            }
        }
        while pyramid.size(pyramid.levels.len()) != (1, 1) {
            let next = pyramid.halved(pyramid.levels.len());
            pyramid.levels.push(next);
        }
        pyramid
    }

    /// Width and height of level 0.
    pub fn width(&self) -> usize {
        self.width
    }

    pub fn height(&self) -> usize {
        self.height
    }

    /// Number of the last level.
    pub fn last(&self) -> usize {
        self.levels.len()
    }

    /// Width and height of a level.
    pub fn size(&self, level: usize) -> (usize, usize) {
        match level.checked_sub(1) {
            None => (self.width, self.height),
            Some(i) => (self.levels[i].width, self.levels[i].height),
        }
    }

    /// The linear colour of a texel; `x`, `y` from the top left, below the level's size.
    pub fn texel(&self, level: usize, x: usize, y: usize) -> Color {
        if let Some(i) = level.checked_sub(1) {
            let level = &self.levels[i];
            return level.texels[y * level.width + x].into();
        }
        let i = y * self.width + x;
        match &self.base {
            Base::U8(t, table) => Color::from(t[i].map(|v| table[usize::from(v)])),
            Base::U16(t, table) => Color::from(t[i].map(|v| table[usize::from(v)])),
            Base::F32(t) => t[i].into(),
        }
    }

    /// The largest value of each channel.
    pub fn max(&self) -> Color {
        self.max
    }

    pub fn memory_bytes(&self) -> usize {
        let base = match &self.base {
            Base::U8(t, _) => size_of_val(t.as_slice()),
            Base::U16(t, _) => size_of_val(t.as_slice()),
            Base::F32(t) => size_of_val(t.as_slice()),
        };
        base + self.levels.iter().map(|l| size_of_val(l.texels.as_slice())).sum::<usize>()
    }

    /// The level after `level`: each texel is the mean over its share of the finer one's area.
    fn halved(&self, level: usize) -> Level {
        let (w, h) = self.size(level);
        let (width, height) = ((w / 2).max(1), (h / 2).max(1));
        let (columns, rows) = (shares(w, width), shares(h, height));
        let mut texels = Vec::with_capacity(width * height);
        for row in &rows {
            for column in &columns {
                let mut sum = glam::DVec3::ZERO;
                for &(y, wy) in row {
                    for &(x, wx) in column {
                        sum += self.texel(level, x, y).as_dvec3() * (wx * wy);
                    }
                }
                // Both weights add up to the lengths w and h, in units of 1/width and 1/height.
                texels.push((sum / (w as f64 * h as f64)).as_vec3a().min(Color::MAX).to_array());
            }
        }
        Level { width, height, texels }
    }
}

/// The fine texels under each of `coarse` texels with the length covered, in units of 1/`coarse` of a
/// fine texel: whole numbers, so that they add up to `fine` exactly.
fn shares(fine: usize, coarse: usize) -> Vec<Vec<(usize, f64)>> {
    (0..coarse)
        .map(|i| {
            let (from, to) = (i * fine, (i + 1) * fine);
            (from / coarse..to.div_ceil(coarse))
                .map(|j| (j, (((j + 1) * coarse).min(to) - (j * coarse).max(from)) as f64))
                .collect()
        })
        .collect()
}
