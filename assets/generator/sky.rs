//! An evening sky on a sphere: warm at the horizon, dusk above, a small bright sun, dark ground.
//!
//! Latitude and longitude, 256 × 128: the top row looks up (+y); the middle column looks toward
//! −z, and columns grow from there toward +x. Linear RGB radiance; values keep 12 bits so that the
//! file packs well.

use std::io::Cursor;

use exr::prelude::{Encoding, Image as ExrImage, Layer, LayerAttributes, SpecificChannels, WritableImage};
use glam::DVec3;

use super::noise::{mix, smoothstep};

/// The sky's size in pixels.
pub const SIZE: (usize, usize) = (256, 128);
/// The sun: degrees from −z toward +x, degrees above the horizon.
pub const SUN: (f64, f64) = (-62.0, 19.0);
/// Radiance at its centre, and the angle in degrees at which it has fallen to 1/e.
const SUN_RADIANCE: [f64; 3] = [620.0, 400.0, 190.0];
const SUN_WIDTH: f64 = 1.9;

/// The sky as an EXR file of 32-bit channels B, G, R.
pub fn evening() -> Vec<u8> {
    let pixel = |at: exr::math::Vec2<usize>| {
        let [r, g, b] = radiance(direction(at.x(), at.y())).to_array().map(short);
        (r, g, b)
    };
    let layer =
        Layer::new(SIZE, LayerAttributes::default(), Encoding::SMALL_LOSSLESS, SpecificChannels::rgb(pixel));
    let mut bytes = Cursor::new(Vec::new());
    ExrImage::from_layer(layer)
        .write()
        .non_parallel()
        .to_buffered(&mut bytes)
        .expect("writing to memory cannot fail");
    bytes.into_inner()
}

fn direction(x: usize, y: usize) -> DVec3 {
    let longitude = ((x as f64 + 0.5) / SIZE.0 as f64 - 0.5) * std::f64::consts::TAU;
    let latitude = (0.5 - (y as f64 + 0.5) / SIZE.1 as f64) * std::f64::consts::PI;
    toward(longitude, latitude)
}

fn toward(longitude: f64, latitude: f64) -> DVec3 {
    let (sin, cos) = libm::sincos(longitude);
    let (up, flat) = libm::sincos(latitude);
    DVec3::new(sin * flat, up, -cos * flat)
}

fn radiance(d: DVec3) -> DVec3 {
    let sun = toward(SUN.0.to_radians(), SUN.1.to_radians());
    let near = d.dot(sun);
    let height = d.y.max(0.0);
    let glow = libm::exp(6.0 * (near - 1.0));
    let zenith = DVec3::new(0.10, 0.17, 0.36);
    let horizon =
        DVec3::new(0.95, 0.52, 0.30).lerp(DVec3::new(0.55, 0.45, 0.55), smoothstep(0.6, -0.8, near));
    let sky = zenith.lerp(horizon, libm::exp(-5.0 * height)) + DVec3::new(1.9, 1.0, 0.42) * glow;
    let band = smoothstep(0.05, 0.12, height) * smoothstep(0.34, 0.16, height);
    let streak = 0.5 + 0.5 * libm::sin(40.0 * d.y + 3.0 * libm::sin(2.0 * d.x + 1.3 * d.z));
    let cloud = sky * mix(1.0, 1.0 + 0.35 * streak, band);
    let ground = DVec3::new(0.055, 0.045, 0.04);
    let land = ground.lerp(cloud, smoothstep(-0.02, 0.02, d.y));
    let angle = libm::acos(near.clamp(-1.0, 1.0)).to_degrees() / SUN_WIDTH;
    land + DVec3::from_array(SUN_RADIANCE) * libm::exp(-angle * angle)
}

/// The value with 12 bits of fraction.
fn short(value: f64) -> f32 {
    let bits = (value as f32).to_bits();
    f32::from_bits((bits + 0x400) & !0x7ff)
}
