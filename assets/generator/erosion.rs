//! Erosion of a height grid: water drops that carry soil downhill (after the droplet scheme of
//! Beyer 2015), then slopes steeper than the talus angle crumble (Musgrave, Kolb & Mace 1989).

use super::noise::smoothstep;
use super::random::Random;

/// Square grid of heights over [−1, 1]² in x (columns) and z (rows).
#[derive(Clone)]
pub struct Grid {
    pub size: usize,
    pub cells: Vec<f64>,
}

impl Grid {
    pub fn new(size: usize, mut value: impl FnMut(f64, f64) -> f64) -> Self {
        let place = |i: usize| 2.0 * i as f64 / (size - 1) as f64 - 1.0;
        let cells = (0..size * size).map(|i| value(place(i % size), place(i / size))).collect();
        Self { size, cells }
    }

    /// The smooth value at (x, z): a uniform cubic B-spline over the cells.
    pub fn at(&self, x: f64, z: f64) -> f64 {
        let last = (self.size - 1) as f64;
        let (gx, gz) = ((x + 1.0) * 0.5 * last, (z + 1.0) * 0.5 * last);
        let (fx, fz) = (gx.floor(), gz.floor());
        let (wx, wz) = (spline(gx - fx), spline(gz - fz));
        let clamp = |i: i64| i.clamp(0, self.size as i64 - 1) as usize;
        let mut sum = 0.0;
        for (j, wz) in wz.iter().enumerate() {
            let row = clamp(fz as i64 + j as i64 - 1) * self.size;
            for (i, wx) in wx.iter().enumerate() {
                sum += wz * wx * self.cells[row + clamp(fx as i64 + i as i64 - 1)];
            }
        }
        sum
    }
}

fn spline(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    let near = |d: f64| (4.0 - 6.0 * d * d + 3.0 * d * d * d) / 6.0;
    [s * s * s / 6.0, near(t), near(s), t * t * t / 6.0]
}

/// Lets `drops` drops run over `heights`; returns how much water passed each cell.
/// `still` is the water level, where a drop ends.
pub fn rain(heights: &mut Grid, drops: usize, still: f64, random: &mut Random) -> Grid {
    let n = heights.size;
    let mut passed = Grid::new(n, |_, _| 0.0);
    for _ in 0..drops {
        let mut p = [random.within(2.0, n as f64 - 3.0), random.within(2.0, n as f64 - 3.0)];
        let (mut direction, mut water, mut soil, mut speed) = ([0.0, 0.0], 1.0, 0.0, 1.0_f64);
        for _ in 0..70 {
            let (here, slope) = sample(heights, p);
            if here < still {
                break;
            }
            direction = [0, 1].map(|i| direction[i] * 0.1 - slope[i] * 0.9);
            let length = (direction[0] * direction[0] + direction[1] * direction[1]).sqrt();
            if length < 1e-9 {
                break;
            }
            direction = direction.map(|d| d / length);
            let next = [p[0] + direction[0], p[1] + direction[1]];
            if next.iter().any(|&c| c < 2.0 || c > n as f64 - 3.0) {
                break;
            }
            let drop = here - sample(heights, next).0;
            // Heights are small beside the plan: a cell is 0.005 wide.
            let capacity = (drop.max(0.0002) * speed * water * 5.0).min(0.01);
            if soil > capacity || drop < 0.0 {
                let laid = if drop < 0.0 { soil.min(-drop) } else { (soil - capacity) * 0.3 };
                soil -= laid;
                spread(heights, p, laid, 1.0);
            } else {
                let taken = ((capacity - soil) * 0.25).min(drop);
                soil += taken;
                spread(heights, p, -taken, 2.5);
            }
            passed.cells[p[1] as usize * n + p[0] as usize] += water;
            speed = (speed * speed + drop * 60.0).max(0.05).sqrt().min(3.0);
            water *= 0.985;
            p = next;
        }
    }
    passed
}

fn sample(grid: &Grid, p: [f64; 2]) -> (f64, [f64; 2]) {
    let (ix, iz) = (p[0] as usize, p[1] as usize);
    let (u, v) = (p[0] - ix as f64, p[1] - iz as f64);
    let at = |dx: usize, dz: usize| grid.cells[(iz + dz) * grid.size + ix + dx];
    let (a, b, c, d) = (at(0, 0), at(1, 0), at(0, 1), at(1, 1));
    let height = (a * (1.0 - u) + b * u) * (1.0 - v) + (c * (1.0 - u) + d * u) * v;
    (height, [(b - a) * (1.0 - v) + (d - c) * v, (c - a) * (1.0 - u) + (d - b) * u])
}

/// Adds `amount` around `p`, weighed by a cone of that radius in cells.
fn spread(grid: &mut Grid, p: [f64; 2], amount: f64, radius: f64) {
    let reach = radius as i64 + 1;
    let (cx, cz) = (p[0] as i64, p[1] as i64);
    let weight = |x: i64, z: i64| {
        let (dx, dz) = (x as f64 - p[0], z as f64 - p[1]);
        (1.0 - (dx * dx + dz * dz).sqrt() / (radius + 0.5)).max(0.0)
    };
    let last = grid.size as i64 - 1;
    let near = |c: i64| (c - reach).max(0)..=(c + reach).min(last);
    let total: f64 = near(cz).flat_map(|z| near(cx).map(move |x| weight(x, z))).sum();
    for z in near(cz) {
        for x in near(cx) {
            grid.cells[(z * (last + 1) + x) as usize] += amount * weight(x, z) / total;
        }
    }
}

/// Moves soil from cells that stand more than `talus` (a slope, dy/dx) over a neighbour.
pub fn crumble(heights: &mut Grid, rounds: usize, talus: f64) {
    let n = heights.size;
    let limit = talus * 2.0 / (n - 1) as f64;
    for _ in 0..rounds {
        let before = heights.cells.clone();
        for z in 1..n - 1 {
            for x in 1..n - 1 {
                let i = z * n + x;
                for next in [i - 1, i + 1, i - n, i + n] {
                    let moved = (before[i] - before[next] - limit).max(0.0) * 0.12;
                    heights.cells[i] -= moved;
                    heights.cells[next] += moved;
                }
            }
        }
    }
}

/// Brings `passed` to 0 … 1: where brooks ran.
pub fn brooks(mut passed: Grid) -> Grid {
    passed.cells.iter_mut().for_each(|c| *c = smoothstep(2.0, 26.0, *c));
    passed
}
