//! Probes: the pixels from which the error of the picture is estimated.
//!
//! One pixel in a square of `stride` × `stride`, chosen by its place alone, keeps what the others have no
//! memory for: its light by effect, that of its passes up to a half of them, what the density estimate's
//! blur does to it, and how two samples of one place differ.

use super::PixelValue;
use crate::math::random::{combine, mix};
use crate::math::{DVec3, Vec3};

/// Where an image's probes lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Probes {
    stride: u32,
}

/// Probes that an image has at least, should it have as many pixels.
const LEAST: u64 = 4096;

/// The largest square that one probe stands for.
const WIDEST: u32 = 5;

impl Probes {
    /// Of an image of so many pixels: one in 25, and more of a small one.
    pub fn of(width: u32, height: u32) -> Probes {
        let pixels = u64::from(width) * u64::from(height);
        let stride = (1..=WIDEST).rev().find(|s| pixels / u64::from(s * s) >= LEAST).unwrap_or(1);
        Probes { stride }
    }

    /// Whether a pixel is one.
    #[inline]
    pub fn is_probe(&self, x: u32, y: u32) -> bool {
        let (cx, cy) = (x / self.stride, y / self.stride);
        let place = (combine(mix(u64::from(cx)), u64::from(cy)) >> 32) as u32 % (self.stride * self.stride);
        (x % self.stride, y % self.stride) == (place % self.stride, place / self.stride)
    }

    /// The slot of a pixel's square within a rectangle of pixels that begins at `(x0, y0)` and is `width`
    /// pixels wide.
    #[inline]
    pub(super) fn slot(&self, [x, y]: [u32; 2], [x0, y0]: [u32; 2], width: u32) -> usize {
        let row = self.squares(x0, width);
        ((y / self.stride - y0 / self.stride) * row + (x / self.stride - x0 / self.stride)) as usize
    }

    /// Squares that a stretch of pixels touches.
    pub(super) fn squares(&self, start: u32, length: u32) -> u32 {
        (start + length - 1) / self.stride - start / self.stride + 1
    }
}

/// Light that is estimated apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// All of it.
    Total,
    /// What is neither of the others: lamps, the sky, and all that is seen.
    Rest,
    Caustic,
    Indirect,
}

impl Kind {
    pub const ALL: [Kind; 4] = [Kind::Total, Kind::Rest, Kind::Caustic, Kind::Indirect];
}

/// One pixel's statistics.
#[derive(Clone, Copy, Debug, Default)]
pub struct Probe {
    pub x: u32,
    pub y: u32,
    /// Passes so far, and those of them that the first part holds: a power of two.
    pub passes: u32,
    pub part: u32,
    /// Sums of rest, caustic, indirect.
    sums: [DVec3; 3],
    /// Means over the first part.
    first: [Vec3; 3],
    /// (mean of the part before − mean of the part)², by kind, when the part was closed.
    closed: [Vec3; 4],
    /// Sums of the estimated bias of caustic and indirect light, of passes that looked at it; of the first
    /// part, and of what came later.
    bias: [[Vec3; 2]; 2],
    looked: [u32; 2],
    /// Σ (x − mean)² of the rest over passes, by Welford's recurrence.
    squares: Vec3,
    /// Σ ½ (a − b)² of the rest over pairs of samples at one place.
    pairs: Vec3,
    paired: u32,
}

impl Probe {
    pub(super) fn add(&mut self, x: u32, y: u32, value: &PixelValue) {
        (self.x, self.y) = (x, y);
        let rest = value.radiance - value.caustic - value.indirect;
        let n = f64::from(self.passes);
        let old = if self.passes == 0 { DVec3::ZERO } else { self.sums[0] / n };
        let new = (self.sums[0] + rest) / (n + 1.0);
        self.squares += ((rest - old) * (rest - new)).as_vec3();
        // A power of two is full: what comes now is its second half.
        if self.passes.is_power_of_two() {
            self.close();
        }
        for (sum, light) in self.sums.iter_mut().zip([rest, value.caustic, value.indirect]) {
            *sum += light;
        }
        self.passes += 1;
        if let Some(bias) = value.bias {
            let half = usize::from(self.part > 0 && self.passes > self.part);
            self.looked[half] += 1;
            self.bias[half][0] += bias[0].as_vec3();
            self.bias[half][1] += bias[1].as_vec3();
        }
        if let Some(pair) = value.pair {
            self.pairs += (0.5 * pair * pair).as_vec3();
            self.paired += 1;
        }
    }

    /// All passes so far become the first part.
    fn close(&mut self) {
        if self.part > 0 {
            self.closed = Kind::ALL.map(|kind| self.change(kind).as_vec3());
        }
        self.part = self.passes;
        self.first = self.sums.map(|sum| (sum / f64::from(self.passes)).as_vec3());
        let both = |i: usize| self.bias[0][i] + self.bias[1][i];
        self.bias = [[both(0), both(1)], [Vec3::ZERO; 2]];
        self.looked = [self.looked[0] + self.looked[1], 0];
    }

    /// The mean of a kind of light over all passes.
    pub fn mean(&self, kind: Kind) -> DVec3 {
        let mean = |i: usize| self.sums[i] / f64::from(self.passes.max(1));
        match kind {
            Kind::Total => mean(0) + mean(1) + mean(2),
            Kind::Rest => mean(0),
            Kind::Caustic => mean(1),
            Kind::Indirect => mean(2),
        }
    }

    /// (mean of the first part − mean of all)².
    pub fn change(&self, kind: Kind) -> DVec3 {
        let first = |i: usize| self.first[i].as_dvec3();
        let first = match kind {
            Kind::Total => first(0) + first(1) + first(2),
            Kind::Rest => first(0),
            Kind::Caustic => first(1),
            Kind::Indirect => first(2),
        };
        let change = self.mean(kind) - first;
        change * change
    }

    /// The same when half of the first part was compared with the whole of it.
    pub fn change_before(&self, kind: Kind) -> DVec3 {
        self.closed[kind as usize].as_dvec3()
    }

    /// Estimates of the bias of caustic or indirect light from the first part of the passes and from the
    /// later ones, whose errors are independent. `None` where either looked at none.
    pub fn biases(&self, kind: Kind) -> Option<[DVec3; 2]> {
        let of = |half: usize| -> Option<DVec3> {
            let sum = match kind {
                Kind::Caustic => self.bias[half][0],
                Kind::Indirect => self.bias[half][1],
                Kind::Total => self.bias[half][0] + self.bias[half][1],
                Kind::Rest => Vec3::ZERO,
            };
            (self.looked[half] > 0).then(|| sum.as_dvec3() / f64::from(self.looked[half]))
        };
        Some([of(0)?, of(1)?])
    }

    /// Of the rest: its variance from pass to pass, and what of it is left at one place of the pixel.
    /// `None` where that is not known.
    pub fn rest_variance(&self) -> Option<[DVec3; 2]> {
        (self.passes > 1 && self.paired > 0).then(|| {
            [
                self.squares.as_dvec3() / f64::from(self.passes - 1),
                self.pairs.as_dvec3() / f64::from(self.paired),
            ]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_whole_square_has_one_probe() {
        for (width, height) in [(800, 600), (300, 300), (40, 30)] {
            let probes = Probes::of(width, height);
            let s = probes.stride;
            for (cx, cy) in (0..width / s).flat_map(|cx| (0..height / s).map(move |cy| (cx, cy))) {
                let square = (0..s).flat_map(|dy| (0..s).map(move |dx| (cx * s + dx, cy * s + dy)));
                assert_eq!(square.filter(|&(x, y)| probes.is_probe(x, y)).count(), 1);
            }
        }
    }

    fn probe(values: impl IntoIterator<Item = f64>) -> Probe {
        let mut probe = Probe::default();
        for v in values {
            let bias = Some([DVec3::splat(v), DVec3::ZERO]);
            let value = PixelValue { radiance: DVec3::splat(v), bias, ..PixelValue::default() };
            probe.add(3, 4, &value);
        }
        probe
    }

    /// Means of 1, 2 and 4 passes are 1, 2 and 3.5.
    #[test]
    fn parts_are_powers_of_two() {
        let four = probe([1.0, 3.0, 4.0, 6.0]);
        assert_eq!((four.passes, four.part), (4, 2));
        assert_eq!(four.change(Kind::Total).x, 1.5 * 1.5);
        assert_eq!(four.change_before(Kind::Rest).x, 1.0);
        assert_eq!(four.biases(Kind::Caustic).map(|b| b.map(|b| b.x)), Some([2.0, 5.0]));
        let six = probe([1.0, 3.0, 4.0, 6.0, 0.0, 1.0]);
        assert_eq!((six.passes, six.part), (6, 4));
        assert!((six.change(Kind::Total).x - 1.0).abs() < 1e-12);
        assert_eq!(six.change_before(Kind::Total).x, 1.5 * 1.5);
    }
}
