//! HDR-FLIP: the largest FLIP of a pixel over exposures from where the reference's brightest pixel just fits
//! to where its median pixel shines.

use super::super::relative::LUMINANCE;
use super::{Planes, ldr};
use rayon::prelude::*;
use serde::Serialize;

/// The filmic curve (k₀x²+k₁x+k₂)/(k₃x²+k₄x+k₅) that stands for ACES, exposure of 0.6 included.
const CURVE: [f32; 6] = [0.6 * 0.6 * 2.51, 0.6 * 0.03, 0.0, 0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14];

/// The tone-mapped value that the brightest and the median pixel are brought to.
const BROUGHT_TO: f64 = 0.85;

/// A median of 0 counts as this: the smallest step of a single float at 1.
const LEAST_MEDIAN: f64 = f32::EPSILON as f64;

/// Exposures that a reference is seen at, in stops.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Exposures {
    pub start_ev: f64,
    pub stop_ev: f64,
    pub count: u32,
}

/// The exposures that the paper's rule gives; none where the reference is black or its brightest pixel is
/// below the least median. Values below 0 and not finite ones count as 0.
pub fn exposures(reference: &Planes) -> Option<Exposures> {
    let [r, g, b] = reference;
    let luminance = |i: usize| {
        let parts = [r[i], g[i], b[i]].into_iter().zip(LUMINANCE);
        parts.map(|(c, weight)| f64::from(light(c)) * weight).sum::<f64>()
    };
    let mut all: Vec<f64> = (0..r.len()).into_par_iter().map(luminance).collect();
    if all.is_empty() {
        return None;
    }
    let middle = all.len() / 2;
    let (_, median, above) = all.select_nth_unstable_by(middle, f64::total_cmp);
    let median = *median;
    let brightest = above.iter().copied().fold(median, f64::max);
    let median = median.max(LEAST_MEDIAN);
    if brightest < median {
        return None;
    }
    let [a, b, c] = [0, 1, 2].map(|k| f64::from(CURVE[k]) - BROUGHT_TO * f64::from(CURVE[k + 3]));
    let white = (-b + (b * b - 4.0 * a * c).sqrt()) / (2.0 * a);
    let (start_ev, stop_ev) = (libm::log2(white / brightest), libm::log2(white / median));
    Some(Exposures { start_ev, stop_ev, count: ((stop_ev - start_ev).ceil() as u32).max(2) })
}

/// The map of the largest differences over the exposures.
pub fn hdr(image: &Planes, reference: &Planes, width: usize, exposures: Exposures) -> Vec<f32> {
    let mut most = vec![0.0f32; image[0].len()];
    let step = (exposures.stop_ev - exposures.start_ev) / f64::from(exposures.count - 1);
    for i in 0..exposures.count {
        let gain = libm::exp2(exposures.start_ev + f64::from(i) * step) as f32;
        let map = ldr(&toned(image, gain), &toned(reference, gain), width);
        most.par_iter_mut().zip(&map).for_each(|(most, value)| *most = most.max(*value));
    }
    most
}

/// Tone-mapped light in [0, 1].
fn toned(planes: &Planes, gain: f32) -> Planes {
    let [k0, k1, k2, k3, k4, k5] = CURVE;
    let curve = |value: &f32| {
        // beyond this the curve is flat to the last bit, and its squares do not overflow
        let x = (light(*value) * gain).min(1e9);
        let (above, below) = ((k0 * x + k1) * x + k2, (k3 * x + k4) * x + k5);
        (above / below).clamp(0.0, 1.0)
    };
    planes.each_ref().map(|plane| plane.par_iter().map(curve).collect())
}

fn light(value: f32) -> f32 {
    if value.is_finite() { value.max(0.0) } else { 0.0 }
}
