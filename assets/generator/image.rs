//! Square 8-bit RGB images and height fields, in image order: x to the right, y down, both in
//! [0, 1) at pixel centres.

use glam::{DVec2, DVec3};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

/// A square image.
pub struct Image {
    pub size: usize,
    pub pixels: Vec<[u8; 3]>,
}

impl Image {
    /// One colour throughout.
    pub fn filled(size: usize, colour: [u8; 3]) -> Self {
        Self { size, pixels: vec![colour; size * size] }
    }

    /// Colours from 0 to 1, already in the encoding of the file.
    pub fn paint(size: usize, colour: impl Fn(f64, f64) -> DVec3) -> Self {
        let pixels = places(size).map(|p| encode(colour(p.x, p.y))).collect();
        Self { size, pixels }
    }

    /// The colour of an unmapped normal.
    pub fn with_flat_normal(mut self) -> Self {
        self.pixels.fill(encode_normal(DVec3::Z));
        self
    }

    /// The PNG file.
    pub fn png(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        let size = self.size as u32;
        PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::Adaptive)
            .write_image(self.pixels.as_flattened(), size, size, ExtendedColorType::Rgb8)
            .expect("writing to memory cannot fail");
        bytes
    }
}

/// A square field of heights that wraps round.
pub struct Relief {
    pub size: usize,
    pub heights: Vec<f64>,
}

impl Relief {
    pub fn new(size: usize, height: impl Fn(f64, f64) -> f64) -> Self {
        Self { size, heights: places(size).map(|p| height(p.x, p.y)).collect() }
    }

    /// The height of a pixel; indices wrap.
    pub fn at(&self, x: usize, y: usize) -> f64 {
        self.heights[(y % self.size) * self.size + x % self.size]
    }

    /// The tangent-space normals, OpenGL's way (green up the image), for heights in units of the
    /// image's width.
    pub fn normals(&self) -> Image {
        let n = self.size;
        let steps = 0.5 * n as f64;
        let pixels = (0..n * n).map(|i| {
            let (x, y) = (i % n, i / n);
            let right = (self.at(x + 1, y) - self.at(x + n - 1, y)) * steps;
            let up = (self.at(x, y + n - 1) - self.at(x, y + 1)) * steps;
            encode_normal(DVec3::new(-right, -up, 1.0).normalize())
        });
        Image { size: n, pixels: pixels.collect() }
    }
}

fn places(size: usize) -> impl Iterator<Item = DVec2> {
    let place = move |i: usize| (i as f64 + 0.5) / size as f64;
    (0..size * size).map(move |i| DVec2::new(place(i % size), place(i / size)))
}

fn encode(colour: DVec3) -> [u8; 3] {
    colour.to_array().map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8)
}

/// A unit normal as a colour: component c at 127.5 + 127.5 c, so that +z is (128, 128, 255).
fn encode_normal(normal: DVec3) -> [u8; 3] {
    normal.to_array().map(|c| (127.5 + 127.5 * c).round() as u8)
}

/// A colour written as in a paint program.
pub fn hex(rgb: u32) -> DVec3 {
    let part = |shift: u32| f64::from((rgb >> shift) & 0xff) / 255.0;
    DVec3::new(part(16), part(8), part(0))
}

/// The colour at `t` in 0 … 1 of a ramp of evenly spaced colours.
pub fn ramp(colours: &[u32], t: f64) -> DVec3 {
    let last = colours.len() - 1;
    let place = t.clamp(0.0, 1.0) * last as f64;
    let i = (place as usize).min(last - 1);
    hex(colours[i]).lerp(hex(colours[i + 1]), place - i as f64)
}
