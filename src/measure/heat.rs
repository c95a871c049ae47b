//! Errors as pictures: a heat map, and both images beside it.
//!
//! The map shows each pixel's relative error √ mean((I−R)²/(R²+0.31·m²)) over channels, m the reference's mean
//! luminance, logarithmically from 0.1 % to 100 %, so that maps of different renders compare. Its colours are
//! Green's cubehelix (2011), whose lightness grows evenly; pixels that are not finite are magenta.

use super::relative::{FLOOR, LUMINANCE};
use crate::output::srgb;
use rayon::prelude::*;
use std::f64::consts::PI;
use std::io::Write;

/// The relative errors at the dark and the bright end of the map.
pub const SCALE: (f64, f64) = (1e-3, 1.0);

/// Of pixels that have no error because they are not finite.
const NOT_FINITE: [u8; 3] = [255, 0, 255];

/// A picture for the screen: 8-bit sRGB, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct ScreenPicture {
    pub width: usize,
    pub pixels: Vec<[u8; 3]>,
}

/// The map of the relative error.
pub fn heat_map(image: [&[f32]; 3], reference: [&[f32]; 3], width: usize) -> ScreenPicture {
    let at = |planes: &[&[f32]; 3], i: usize| planes.map(|plane| f64::from(plane[i]));
    let finite = |values: &[f64; 3]| values.iter().all(|value| value.is_finite());
    let luminance = |i: usize| {
        let values = at(&reference, i);
        let sum = values.iter().zip(LUMINANCE).map(|(c, weight)| c * weight).sum::<f64>();
        if finite(&values) { sum } else { 0.0 }
    };
    let pixels = reference[0].len();
    let mean = (0..pixels).map(luminance).sum::<f64>() / pixels.max(1) as f64;
    let floor = FLOOR * mean * mean;
    let table = cubehelix();
    let colour = |p: usize| {
        let (i, r) = (at(&image, p), at(&reference, p));
        if !finite(&i) || !finite(&r) {
            return NOT_FINITE;
        }
        let square = |(i, r): (f64, f64)| if i == r { 0.0 } else { (i - r) * (i - r) / (r * r + floor) };
        let error = (i.into_iter().zip(r).map(square).sum::<f64>() / 3.0).sqrt();
        table[shade(error)]
    };
    ScreenPicture { width, pixels: (0..pixels).into_par_iter().map(colour).collect() }
}

/// An image as shown on a screen, exposed by so many stops.
pub fn shown(image: [&[f32]; 3], width: usize, exposure_ev: f64) -> ScreenPicture {
    let gain = libm::exp2(exposure_ev);
    let byte = |value: f32| {
        let light = f64::from(value) * gain;
        srgb::quantise(srgb::encode(if light.is_nan() { 0.0 } else { light.clamp(0.0, 1.0) }), 255) as u8
    };
    let pixel = |i: usize| match image.map(|plane| plane[i]) {
        values if values.iter().all(|value| value.is_finite()) => values.map(byte),
        _ => NOT_FINITE,
    };
    ScreenPicture { width, pixels: (0..image[0].len()).into_par_iter().map(pixel).collect() }
}

/// Pictures of one height from left to right.
pub fn beside(pictures: &[ScreenPicture]) -> ScreenPicture {
    let width = pictures.iter().map(|picture| picture.width).sum();
    let rows = pictures.iter().map(|picture| picture.pixels.len() / picture.width.max(1)).min().unwrap_or(0);
    let row = |y: usize| pictures.iter().flat_map(move |p| p.pixels[y * p.width..(y + 1) * p.width].iter());
    ScreenPicture { width, pixels: (0..rows).flat_map(row).copied().collect() }
}

impl ScreenPicture {
    /// Writes the picture as PNG.
    ///
    /// # Errors
    /// Those of the sink, and sizes that PNG does not have.
    pub fn write_png(&self, sink: impl Write) -> Result<(), png::EncodingError> {
        let side = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        let height = self.pixels.len() / self.width.max(1);
        let mut encoder = png::Encoder::new(sink, side(self.width), side(height));
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(self.pixels.as_flattened())?;
        writer.finish()
    }
}

/// The entry of the table for a relative error.
fn shade(error: f64) -> usize {
    if error <= SCALE.0 {
        return 0;
    }
    let share = libm::log(error / SCALE.0) / libm::log(SCALE.1 / SCALE.0);
    (share.min(1.0) * 255.0).round_ties_even() as usize
}

/// Green 2011: start 0.5, −1.5 turns, hue 1, γ 1.
fn cubehelix() -> Vec<[u8; 3]> {
    let colour = |i: u32| {
        let level = f64::from(i) / 255.0;
        let angle = 2.0 * PI * (0.5 / 3.0 + 1.0 - 1.5 * level);
        let (cos, sin) = (libm::cos(angle), libm::sin(angle));
        let amplitude = level * (1.0 - level) / 2.0;
        [[-0.14861, 1.78277], [-0.29227, -0.90649], [1.97294, 0.0]].map(|[of_cos, of_sin]: [f64; 2]| {
            let value = level + amplitude * (of_cos * cos + of_sin * sin);
            srgb::quantise(value.clamp(0.0, 1.0), 255) as u8
        })
    };
    (0..256).map(colour).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_map_grows_lighter_with_the_error() {
        let luma = |c: [u8; 3]| 0.299 * f64::from(c[0]) + 0.587 * f64::from(c[1]) + 0.114 * f64::from(c[2]);
        let table = cubehelix();
        assert_eq!((table[0], table[255]), ([0; 3], [255; 3]));
        for pair in table.windows(2) {
            assert!(luma(pair[1]) > luma(pair[0]) - 1.0, "{pair:?}");
        }
        for (i, colour) in table.iter().enumerate() {
            assert!((luma(*colour) - i as f64).abs() < 4.0, "{i}: {colour:?}");
        }
        assert_eq!([0.0, 1e-3, 0.1f64.powi(3) * 10.0, 1.0, 7.0].map(shade), [0, 0, 85, 255, 255]);
    }

    #[test]
    fn pixels_that_are_not_finite_stand_out() {
        let (image, reference) = ([f32::NAN, 1.0, 1.1], [1.0, 1.0, 1.0]);
        let map = heat_map([&image; 3], [&reference; 3], 3);
        assert_eq!(map.pixels[..2], [NOT_FINITE, [0; 3]]);
        // 0.1/√1.31 lies two thirds up three decades, less a little
        let expected = (255.0 * (libm::log10(0.1 / 1.31f64.sqrt()) + 3.0) / 3.0).round() as usize;
        assert_eq!(map.pixels[2], cubehelix()[expected]);
        assert_eq!(shown([&image; 3], 3, 0.0).pixels, [NOT_FINITE, [255; 3], [255; 3]]);
    }

    #[test]
    fn pictures_stand_side_by_side_row_by_row() {
        let picture = |value: u8| ScreenPicture { width: 1, pixels: vec![[value; 3], [value + 1; 3]] };
        let both = beside(&[picture(10), picture(20)]);
        assert_eq!((both.width, both.pixels), (2, vec![[10; 3], [20; 3], [11; 3], [21; 3]]));
    }
}
