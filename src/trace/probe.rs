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

/// Rec. 709.
pub const LUMINANCE: DVec3 = DVec3::new(0.2126, 0.7152, 0.0722);

/// The largest square that one probe stands for.
const WIDEST: u32 = 8;

impl Probes {
    /// Of an image of so many pixels: one in 64, and more of a small one.
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
    /// What is neither of the others: lamps, the sky, and all that is seen.
    Rest,
    Caustic,
    Indirect,
}

impl Kind {
    pub const ALL: [Kind; 3] = [Kind::Rest, Kind::Caustic, Kind::Indirect];
}

/// One pixel's statistics.
#[derive(Clone, Copy, Debug, Default)]
pub struct Probe {
    pub x: u32,
    pub y: u32,
    /// Passes so far, and those of them that the first part holds: a power of two.
    pub passes: u32,
    pub part: u32,
    /// Sums by kind.
    sums: [DVec3; 3],
    /// Σ (x − mean)² over passes by kind, by Welford's recurrence.
    squares: [Vec3; 3],
    /// Of the rest: its mean over the first part; and (mean of the part before − mean of the part)² from when
    /// the part was closed.
    first: Vec3,
    closed: Vec3,
    /// Of all light: the luminance of the brightest pass.
    brightest: f32,
    /// Sums of the estimated bias of caustic and indirect light, of passes that looked at it; of the first
    /// part, and of what came later.
    bias: [[Vec3; 2]; 2],
    looked: [u32; 2],
    /// Σ ½ (a − b)² of the rest over pairs of samples at one place.
    pairs: Vec3,
    paired: u32,
}

impl Probe {
    pub(super) fn add(&mut self, x: u32, y: u32, value: &PixelValue) {
        (self.x, self.y) = (x, y);
        // A power of two is full: what comes now is its second half.
        if self.passes.is_power_of_two() {
            self.close();
        }
        self.brightest = self.brightest.max(value.radiance.dot(LUMINANCE) as f32);
        let rest = value.radiance - value.caustic - value.indirect;
        let n = f64::from(self.passes);
        for (i, light) in [rest, value.caustic, value.indirect].into_iter().enumerate() {
            let old = if self.passes == 0 { DVec3::ZERO } else { self.sums[i] / n };
            self.sums[i] += light;
            self.squares[i] += ((light - old) * (light - self.sums[i] / (n + 1.0))).as_vec3();
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
            self.closed = self.change().as_vec3();
        }
        self.part = self.passes;
        self.first = self.mean(Kind::Rest).as_vec3();
        let both = |i: usize| self.bias[0][i] + self.bias[1][i];
        self.bias = [[both(0), both(1)], [Vec3::ZERO; 2]];
        self.looked = [self.looked[0] + self.looked[1], 0];
    }

    /// The mean of a kind of light over all passes.
    pub fn mean(&self, kind: Kind) -> DVec3 {
        self.sums[kind as usize] / f64::from(self.passes.max(1))
    }

    /// Of all light.
    pub fn mean_of_all(&self) -> DVec3 {
        Kind::ALL.into_iter().map(|kind| self.mean(kind)).sum()
    }

    /// Mean luminance without the brightest pass.
    pub fn others(&self) -> f64 {
        let sum = self.mean_of_all().dot(LUMINANCE) * f64::from(self.passes);
        (sum - f64::from(self.brightest)) / f64::from(self.passes.max(2) - 1)
    }

    /// The variance of a kind of light from pass to pass; 0 of one pass.
    pub fn variance(&self, kind: Kind) -> DVec3 {
        self.squares[kind as usize].as_dvec3() / f64::from(self.passes.max(2) - 1)
    }

    /// Of the rest: (mean of the first part − mean of all)².
    pub fn change(&self) -> DVec3 {
        let change = self.mean(Kind::Rest) - self.first.as_dvec3();
        change * change
    }

    /// The same when half of the first part was compared with the whole of it.
    pub fn change_before(&self) -> DVec3 {
        self.closed.as_dvec3()
    }

    /// Estimates of the bias of caustic and of indirect light, from the first part of the passes and from the
    /// later ones, whose errors are independent. `None` where either looked at none.
    pub fn biases(&self) -> Option<[[DVec3; 2]; 2]> {
        let of = |half: usize| {
            let mean = |sum: Vec3| sum.as_dvec3() / f64::from(self.looked[half]);
            (self.looked[half] > 0).then(|| self.bias[half].map(mean))
        };
        Some([of(0)?, of(1)?])
    }

    /// The variance of the rest that is left at one place of the pixel. `None` where that is not known.
    pub fn variance_at_one_place(&self) -> Option<DVec3> {
        (self.paired > 0).then(|| self.pairs.as_dvec3() / f64::from(self.paired))
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
        assert_eq!(four.change().x, 1.5 * 1.5);
        assert_eq!(four.change_before().x, 1.0);
        assert_eq!(four.biases().map(|b| b.map(|[caustic, _]| caustic.x)), Some([2.0, 5.0]));
        assert!((four.variance(Kind::Rest).x - 13.0 / 3.0).abs() < 1e-6);
        let six = probe([1.0, 3.0, 4.0, 6.0, 0.0, 1.0]);
        assert_eq!((six.passes, six.part), (6, 4));
        assert!((six.change().x - 1.0).abs() < 1e-12);
        assert_eq!(six.change_before().x, 1.5 * 1.5);
    }
}
