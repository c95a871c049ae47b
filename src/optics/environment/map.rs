//! An equirectangular image and its sampling table.
//!
//! Radiance is interpolated bilinearly between texel centres, so the image is sampled by the cells
//! between four centres (at the poles: between two centres and the pole, where the outermost row goes
//! on). A cell is chosen in proportion to the integral of its luminance over solid angle, in closed
//! form, and a direction uniformly within it. So the density is constant in a cell, integrates to 1,
//! is 0 only where the radiance is 0, and radiance/density within a cell varies no more than its four
//! corners do.

use super::{direction, luminance};
use crate::math::Color;
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

#[derive(Clone, Debug)]
pub struct Map {
    width: usize,
    height: usize,
    texels: Vec<Vec3>,
    rows: Vec<CellRow>,
    /// By rows of cells, running sums of the cells' weights along the row.
    cells: Vec<f64>,
    /// Running sums of the rows' weights.
    row_sums: Vec<f64>,
    mean: Color,
}

/// The cells between two rows of texel centres.
#[derive(Clone, Copy, Debug)]
struct CellRow {
    cos_top: f64,
    /// cos(top) − cos(bottom), without cancellation.
    height: f64,
    /// Solid angle of one of its cells.
    solid_angle: f64,
    /// The rows of texels above and below.
    texels: [usize; 2],
    /// Integral over the row's cosines of each texel row's share: together `height`.
    shares: [f64; 2],
}

impl CellRow {
    fn new(i: usize, width: usize, height: usize) -> CellRow {
        let step = PI / height as f64;
        let angle = |edge: f64| (edge * step).clamp(0.0, PI);
        // Texel row r has its centre at (r + ½)·step; cell row i lies between rows i − 1 and i.
        let (top, bottom) = (angle(i as f64 - 0.5), angle(i as f64 + 0.5));
        let extent = 2.0 * libm::sin(0.5 * (top + bottom)) * libm::sin(0.5 * (bottom - top));
        let texels = [i.saturating_sub(1), i.min(height - 1)];
        // ∫ (θ − top)/(bottom − top)·sin θ dθ, the share of the lower row; at the poles both are one.
        let lower = (libm::sin(bottom) - libm::sin(top)) / (bottom - top) - libm::cos(bottom);
        let lower = lower.clamp(0.0, extent);
        CellRow {
            cos_top: libm::cos(top),
            height: extent,
            solid_angle: extent * 2.0 * PI / width as f64,
            texels,
            shares: [extent - lower, lower],
        }
    }
}

impl Map {
    /// `width`, `height` at least 1; channels finite and not negative.
    pub fn new(width: usize, height: usize, mut texels: Vec<Vec3>) -> Map {
        texels.resize(width * height, Vec3::ZERO);
        let rows: Vec<_> = (0..=height).map(|i| CellRow::new(i, width, height)).collect();
        let mut cells = Vec::with_capacity(width * rows.len());
        let mut row_sums = Vec::with_capacity(rows.len());
        let (mut total, mut mean) = (0.0, DVec3::ZERO);
        for row in &rows {
            // Column j of cells lies between columns j − 1 and j of texels.
            let [above, below] = row.texels.map(|r| &texels[r * width..][..width]);
            let mut sum = 0.0;
            for j in 0..width {
                let left = (j + width - 1) % width;
                let (a, b) = (
                    luminance(above[left].into()) + luminance(above[j].into()),
                    luminance(below[left].into()) + luminance(below[j].into()),
                );
                sum += 0.5 * (a * row.shares[0] + b * row.shares[1]);
                cells.push(sum);
                mean += above[j].as_dvec3() * row.shares[0] + below[j].as_dvec3() * row.shares[1];
            }
            total += sum;
            row_sums.push(total);
        }
        let mean = (mean / (2.0 * width as f64)).as_vec3a();
        Map { width, height, texels, rows, cells, row_sums, mean }
    }

    pub fn mean(&self) -> Color {
        self.mean
    }

    pub fn memory_bytes(&self) -> usize {
        size_of_val(self.texels.as_slice())
            + size_of_val(self.cells.as_slice())
            + size_of_val(self.rows.as_slice())
            + size_of_val(self.row_sums.as_slice())
    }

    pub fn radiance(&self, dir: DVec3) -> Color {
        let ([i, j], [ty, tx]) = self.cell(dir);
        let left = (j + self.width - 1) % self.width;
        let row = |r: usize| {
            let [a, b] = [left, j].map(|column| Color::from(self.texels[r * self.width + column]));
            a * (1.0 - tx) + b * tx
        };
        let [above, below] = self.rows[i].texels;
        (row(above) * (1.0 - ty) + row(below) * ty).min(Color::MAX)
    }

    pub fn pdf(&self, dir: DVec3) -> f64 {
        let ([i, j], _) = self.cell(dir);
        self.density(i, j)
    }

    /// A direction and its density; None if all is black.
    pub fn sample(&self, u: [f64; 2]) -> Option<(DVec3, f64)> {
        let (i, y) = choose(&self.row_sums, u[1])?;
        let (j, x) = choose(self.row_cells(i), u[0])?;
        let row = &self.rows[i];
        // Column j of cells begins half a texel left of column j of texels; column 0 is at phi = −π.
        let phi = ((j as f64 - 0.5 + x) / self.width as f64 - 0.5) * 2.0 * PI;
        Some((direction(row.cos_top - row.height * y, phi), self.density(i, j)))
    }

    fn row_cells(&self, i: usize) -> &[f64] {
        &self.cells[i * self.width..][..self.width]
    }

    fn density(&self, i: usize, j: usize) -> f64 {
        let total = self.row_sums.last().copied().unwrap_or(0.0);
        if total <= 0.0 {
            return 0.0;
        }
        let cells = self.row_cells(i);
        let weight = cells[j] - if j > 0 { cells[j - 1] } else { 0.0 };
        weight / total / self.rows[i].solid_angle
    }

    /// The cell (row, column) of a direction, and the position in it (down, right) in [0, 1].
    fn cell(&self, dir: DVec3) -> ([usize; 2], [f32; 2]) {
        let theta = libm::atan2((dir.x * dir.x + dir.z * dir.z).sqrt(), dir.y);
        let phi = libm::atan2(dir.x, -dir.z);
        // Both in cells: half a texel from texel coordinates. NaN gives cell 0.
        let y = theta / PI * self.height as f64 + 0.5;
        let x = (phi / (2.0 * PI) + 0.5) * self.width as f64 + 0.5;
        let (i, j) = ((y as usize).min(self.height), x as usize);
        let fraction = |t: f64, whole: usize| (t - whole as f64).clamp(0.0, 1.0) as f32;
        ([i, j % self.width], [fraction(y, i), fraction(x, j)])
    }
}

/// The entry of a running sum in which `u`·total falls, and how far into it, in [0, 1). Entries without
/// weight are never chosen. None if there is no weight.
fn choose(sums: &[f64], u: f64) -> Option<(usize, f64)> {
    let total = *sums.last()?;
    if total <= 0.0 {
        return None;
    }
    let x = u * total;
    // Rounding may give x = total: then the first entry that reaches it is the last of any weight.
    let i = sums.partition_point(|&end| end <= x).min(sums.partition_point(|&end| end < total));
    let start = if i > 0 { sums[i - 1] } else { 0.0 };
    Some((i, ((x - start) / (sums[i] - start)).clamp(0.0, 1.0)))
}
