//! Gradient noise (Perlin 2002), its fractal sums (Musgrave 1994) and cell noise (Worley 1996) in
//! the plane, each optionally periodic, so that textures tile. The gradients come from integer
//! hashes.

use super::random::{lattice, unit};

/// A noise field. `period` is in lattice cells in x and y; 0 does not repeat.
#[derive(Clone, Copy)]
pub struct Noise {
    pub seed: u64,
    pub period: [i64; 2],
}

/// The nearest and second-nearest feature points' distances, and the nearest one's hash.
pub struct Cell {
    pub first: f64,
    pub second: f64,
    pub id: u64,
}

/// Eight directions of equal length; √½ is written out so that no function of the platform enters.
const GRADIENTS: [[f64; 2]; 8] = {
    const D: f64 = std::f64::consts::FRAC_1_SQRT_2;
    [[1.0, 0.0], [D, D], [0.0, 1.0], [-D, D], [-1.0, 0.0], [-D, -D], [0.0, -1.0], [D, -D]]
};

impl Noise {
    /// A field that does not repeat.
    pub fn new(seed: u64) -> Self {
        Self { seed, period: [0, 0] }
    }

    /// A field that repeats after `x` and `y` cells.
    pub fn tiling(seed: u64, x: i64, y: i64) -> Self {
        Self { seed, period: [x, y] }
    }

    fn hash(&self, x: i64, y: i64) -> u64 {
        lattice(self.seed, wrap(x, self.period[0]), wrap(y, self.period[1]))
    }

    /// One octave, about −1 to 1, zero on average.
    pub fn at(&self, x: f64, y: f64) -> f64 {
        let (fx, fy) = (x.floor(), y.floor());
        let (ix, iy) = (fx as i64, fy as i64);
        let (dx, dy) = (x - fx, y - fy);
        let columns = [wrap(ix, self.period[0]), wrap(ix + 1, self.period[0])];
        let rows = [wrap(iy, self.period[1]), wrap(iy + 1, self.period[1])];
        let corner = |cx: i64, cy: i64| {
            let hash = lattice(self.seed, columns[cx as usize], rows[cy as usize]);
            let g = GRADIENTS[(hash >> 61) as usize];
            g[0] * (dx - cx as f64) + g[1] * (dy - cy as f64)
        };
        let (u, v) = (fade(dx), fade(dy));
        1.5 * mix(mix(corner(0, 0), corner(1, 0), u), mix(corner(0, 1), corner(1, 1), u), v)
    }

    fn octave(&self, i: u32) -> Self {
        Self { seed: self.seed.wrapping_add(u64::from(i) * 1013), period: self.period.map(|p| p << i) }
    }

    /// Fractal sum: each octave at twice the frequency and half the weight; about −1 to 1.
    pub fn fbm(&self, x: f64, y: f64, octaves: u32) -> f64 {
        let (mut sum, mut total, mut weight, mut scale) = (0.0, 0.0, 1.0, 1.0);
        for i in 0..octaves {
            sum += weight * self.octave(i).at(x * scale, y * scale);
            total += weight;
            weight *= 0.5;
            scale *= 2.0;
        }
        sum / total * 1.3
    }

    /// Ridged multifractal: sharp crests at 1, each octave weighed by the one before; 0 to 1.
    pub fn ridged(&self, x: f64, y: f64, octaves: u32) -> f64 {
        let (mut sum, mut total, mut weight, mut scale, mut amplitude) = (0.0, 0.0, 1.0, 1.0, 1.0);
        for i in 0..octaves {
            let crest = 1.0 - self.octave(i).at(x * scale, y * scale).abs().min(1.0);
            let signal = crest * crest * weight;
            sum += amplitude * signal;
            total += amplitude;
            weight = (signal * 1.8).clamp(0.0, 1.0);
            amplitude *= 0.5;
            scale *= 2.03_f64.min(if self.period[0] > 0 { 2.0 } else { 2.03 });
        }
        sum / total
    }

    /// Cell noise: distances in cells.
    pub fn cell(&self, x: f64, y: f64) -> Cell {
        let (ix, iy) = (x.floor() as i64, y.floor() as i64);
        let mut found = Cell { first: f64::MAX, second: f64::MAX, id: 0 };
        for cy in iy - 1..=iy + 1 {
            for cx in ix - 1..=ix + 1 {
                let id = self.hash(cx, cy);
                let px = cx as f64 + unit(id) - x;
                let py = cy as f64 + unit(super::random::mix(id)) - y;
                let square = px * px + py * py;
                if square < found.first {
                    found = Cell { first: square, second: found.first, id };
                } else if square < found.second {
                    found.second = square;
                }
            }
        }
        Cell { first: found.first.sqrt(), second: found.second.sqrt(), id: found.id }
    }
}

fn wrap(i: i64, period: i64) -> i64 {
    if period > 0 { i64::from((i as i32).rem_euclid(period as i32)) } else { i }
}

fn fade(t: f64) -> f64 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

/// Linear blend: `a` at t = 0, `b` at t = 1.
pub fn mix(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}

/// 0 below `low`, 1 above `high`, a cubic between.
pub fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
