//! Scenes in which a floor is seen from under a pane, and numbers with their errors.

use crate::render::shot::{Picture, Shot, focused as shot};
use std::path::Path;
use terrarium::render::Aov;

/// A mean and its standard error, from parts of a render's passes.
#[derive(Clone, Copy, Debug)]
pub struct Estimate {
    pub mean: f64,
    pub error: f64,
}

pub fn estimate(values: &[f64]) -> Estimate {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
    Estimate { mean, error: (variance / n).sqrt() }
}

impl Estimate {
    /// Within three standard errors (and `model`, a share, that the expectation leaves out), and within 1 %.
    #[track_caller]
    pub fn assert_is(self, expected: f64, model: f64, what: &str) {
        let off = (self.mean - expected).abs();
        assert!(
            off < 3.0 * self.error + model * expected && off < 0.01 * expected,
            "{what}: {self:?} is not {expected} (off by {:.2} %)",
            100.0 * (self.mean / expected - 1.0)
        );
    }
}

/// Passes of each of the parts from which errors are told.
pub const PART: u32 = 2;

/// The parts of a render: `parts` pictures of `PART` passes each.
pub fn parts(shot: &Shot, parts: u32) -> Vec<Picture> {
    (0..parts).map(|i| shot.clone().pass_range(i * PART..(i + 1) * PART).render()).collect()
}

/// The mean of a layer's red channel.
pub fn mean_of(picture: &Picture, layer: &str) -> f64 {
    let values = picture.channel(layer, "R");
    values.iter().map(|&x| f64::from(x)).sum::<f64>() / values.len() as f64
}

/// A white floor with a pane of glass above it, seen from between them.
pub struct Beneath {
    /// Of the pane: metres above the floor, thickness, side.
    pub height: f64,
    pub thickness: f64,
    pub side: f64,
    /// Half the side of the square of floor that is seen.
    pub seen: f64,
    pub photons: &'static str,
}

impl Default for Beneath {
    fn default() -> Beneath {
        Beneath { height: 0.5, thickness: 1e-3, side: 4.0, seen: 0.5, photons: "progressive(count: 60000)" }
    }
}

impl Beneath {
    /// The shot, with `lights` and further `materials` and `objects`.
    pub fn shot(&self, lights: &str, materials: &str, objects: &str) -> Shot {
        let Beneath { height, thickness, side, seen, photons } = self;
        let eye = 0.9 * height;
        let fov = 2.0 * (seen / eye).atan().to_degrees();
        let middle = height + thickness / 2.0;
        shot(format!(
            r#"(camera: (eye: (0, {eye}, 0), target: (0, 0, 0), up: (0, 0, -1), fov_deg: {fov}), image: (width: 24, height: 24),
            photons: {photons},
            materials: {{ "white": (diffuse: 1), "glass": (transmission: 1, ior: 1.5), {materials} }},
            lights: {{ {lights} }},
            objects: [(shape: quad(size: (40, 40)), material: "white"),
                      (shape: box(size: ({side}, {thickness}, {side}), center: (0, {middle}, 0)), material: "glass") {objects}])"#
        ))
        .aovs(&[Aov::Caustic])
    }

    /// The mean irradiance of the floor that is seen, by caustics.
    pub fn irradiance(&self, shot: &Shot, folder: &Path) -> Estimate {
        let pictures = parts(&shot.clone().folder(folder), 8);
        let means: Vec<f64> = pictures.iter().map(|p| mean_of(p, "caustic") * std::f64::consts::PI).collect();
        estimate(&means)
    }

    /// The mean over the floor that is seen of a function of (x, z).
    pub fn mean(&self, f: impl Fn(f64, f64) -> f64) -> f64 {
        let n = 12;
        let at = |i: usize| self.seen * ((2 * i + 1) as f64 / n as f64 - 1.0);
        (0..n * n).map(|i| f(at(i / n), at(i % n))).sum::<f64>() / (n * n) as f64
    }
}

/// Share of unpolarised light that a pane of index 1.5 transmits at this cosine, with all reflections inside
/// of it: (1 − R)/(1 + R).
pub fn pane(cos: f64) -> f64 {
    let n = 1.5;
    let inside = (1.0 - (1.0 - cos * cos) / (n * n)).sqrt();
    let s = (cos - n * inside) / (cos + n * inside);
    let p = (n * cos - inside) / (n * cos + inside);
    let r = (s * s + p * p) / 2.0;
    (1.0 - r) / (1.0 + r)
}
