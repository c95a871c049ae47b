//! FLIP's colour difference: what the eye's contrast sensitivity leaves of both images, compared in
//! L*a*b* with Hunt's effect and the HyAB distance. Section 4.1 of the paper.

use super::super::separable::convolve;
use super::{PIXELS_PER_DEGREE, Planes, radius};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Linear Rec. 709 to XYZ, from the exact primaries and D65.
const XYZ: [[f64; 3]; 3] = [
    [10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0],
    [2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0],
    [1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0],
];

/// XYZ to linear Rec. 709.
const RGB: [[f64; 3]; 3] = [
    [3.241003275, -1.537398934, -0.498615861],
    [-0.969224334, 1.875930071, 0.041554224],
    [0.055639423, -0.204011202, 1.057148933],
];

/// One over the XYZ of white.
const PER_WHITE: [f64; 3] = [1.052156925, 1.0, 0.918357670];

/// Contrast sensitivity by channel, (a₁, b₁, a₂, b₂): achromatic, red–green, blue–yellow.
const SENSITIVITY: [[f64; 4]; 3] =
    [[1.0, 0.0047, 0.0, 1e-5], [1.0, 0.0053, 0.0, 1e-5], [34.1, 0.04, 13.5, 0.025]];

/// The exponent of the colour difference, and the bend of its scale: (share of the maximum, value there).
const Q_C: f32 = 0.7;
const BEND: (f64, f64) = (0.4, 0.95);

/// YyCxCz of each pixel.
pub fn opponent(planes: &Planes) -> Planes {
    map(planes, |rgb| {
        let [x, y, z] = scaled(times(&XYZ, rgb), PER_WHITE);
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    })
}

/// ΔE_c of two images in YyCxCz, rescaled to [0, 1].
pub fn differences(image: Planes, reference: Planes, width: usize) -> Vec<f32> {
    let most = most();
    let (image, reference) = (perceived(image, width), perceived(reference, width));
    (0..image[0].len())
        .into_par_iter()
        .map(|i| {
            let [l, a, b] = [0, 1, 2].map(|k| image[k][i] - reference[k][i]);
            rescaled(hyab(l, a, b), most)
        })
        .collect()
}

/// What is seen of an image, in L*a*b* with Hunt's effect.
fn perceived(opponent: Planes, width: usize) -> Planes {
    let filtered = filtered(opponent, width);
    map(&filtered, |[y, cx, cz]| {
        let yn = (y + 16.0) / 116.0;
        let xyz = [yn + cx / 500.0, yn, yn - cz / 200.0];
        let white = PER_WHITE.map(|w| 1.0 / w);
        hunt(times(&RGB, scaled(xyz, white)).map(|c| c.clamp(0.0, 1.0)))
    })
}

/// L*a*b* of a linear colour, with a* and b* scaled by lightness.
fn hunt(rgb: [f64; 3]) -> [f64; 3] {
    const KNEE: f32 = 6.0 / 29.0;
    let f = |t: f64| {
        let t = t as f32;
        let root = if t > KNEE * KNEE * KNEE { libm::cbrtf(t) } else { t / (3.0 * KNEE * KNEE) + 4.0 / 29.0 };
        f64::from(root)
    };
    let [x, y, z] = scaled(times(&XYZ, rgb), PER_WHITE).map(f);
    let lightness = 116.0 * y - 16.0;
    [lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z)]
}

fn hyab(l: f32, a: f32, b: f32) -> f32 {
    l.abs() + (a * a + b * b).sqrt()
}

/// The largest ΔE_HyAB^q_c, between the primaries green and blue.
fn most() -> f32 {
    let (green, blue) = (hunt([0.0, 1.0, 0.0]), hunt([0.0, 0.0, 1.0]));
    let [l, a, b] = [0, 1, 2].map(|k| (green[k] - blue[k]) as f32);
    libm::powf(hyab(l, a, b), Q_C)
}

fn rescaled(difference: f32, most: f32) -> f32 {
    let difference = libm::powf(difference, Q_C);
    let (at, value) = (BEND.0 as f32 * most, BEND.1 as f32);
    if difference < at {
        value / at * difference
    } else {
        value + (difference - at) / (most - at) * (1.0 - value)
    }
}

/// Each channel filtered by its contrast sensitivity. A sum of two Gaussians over a square is that of two
/// products of Gaussians over its sides.
fn filtered(planes: Planes, width: usize) -> Planes {
    // one radius for all, that of the widest
    let widest = SENSITIVITY.iter().flat_map(|s| [s[1], s[3]]).fold(0.0, f64::max);
    let radius = radius((widest / (2.0 * PI * PI)).sqrt() * PIXELS_PER_DEGREE);
    let mut channels = planes.into_iter().zip(SENSITIVITY).map(|(plane, [a1, b1, a2, b2])| {
        let side = |a: f64, b: f64| -> Vec<f64> {
            let height = (a * (PI / b).sqrt()).sqrt();
            let at = |tap: i32| f64::from(tap) / PIXELS_PER_DEGREE;
            (-radius..=radius).map(|tap| height * libm::exp(-PI * PI * at(tap) * at(tap) / b)).collect()
        };
        let (first, second) = (side(a1, b1), side(a2, b2));
        let square = |side: &[f64]| side.iter().sum::<f64>() * side.iter().sum::<f64>();
        let scale = 1.0 / (square(&first) + square(&second)).sqrt();
        let kernel = |side: &[f64]| -> Vec<f32> { side.iter().map(|w| (w * scale) as f32).collect() };
        let (first, second) = (kernel(&first), kernel(&second));
        let mut sum = convolve(&plane, width, &first, &first);
        if a2 != 0.0 {
            let more = convolve(&plane, width, &second, &second);
            sum.par_iter_mut().zip(&more).for_each(|(sum, more)| *sum += more);
        }
        sum
    });
    std::array::from_fn(|_| channels.next().expect("three channels"))
}

fn map(planes: &Planes, f: impl Fn([f64; 3]) -> [f64; 3] + Sync) -> Planes {
    let [a, b, c] = planes;
    let mut out = [vec![0.0; a.len()], vec![0.0; a.len()], vec![0.0; a.len()]];
    let [x, y, z] = &mut out;
    let outs = x.par_iter_mut().zip(y.par_iter_mut()).zip(z.par_iter_mut());
    outs.zip(a.par_iter().zip(b.par_iter()).zip(c.par_iter())).for_each(|(((x, y), z), ((a, b), c))| {
        let [p, q, r] = f([*a, *b, *c].map(f64::from));
        (*x, *y, *z) = (p as f32, q as f32, r as f32);
    });
    out
}

fn times(matrix: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

fn scaled(v: [f64; 3], by: [f64; 3]) -> [f64; 3] {
    [v[0] * by[0], v[1] * by[1], v[2] * by[2]]
}
