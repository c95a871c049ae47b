//! Probes: the pixels from which the error of the picture is estimated.
//!
//! One pixel in a square of `stride` × `stride`, chosen by its place alone, keeps what the others have no
//! memory for: its light by effect, that of its passes up to a half of them, what the density estimate's
//! blur does to it, and how two samples of one place differ.

use super::PixelValue;
use super::words::record;
use crate::math::random::{combine, mix};
use crate::math::{DVec3, Vec3};

/// Where an image's probes lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Probes {
    stride: u32,
}

/// Probes that an image of fewer than [`LARGE`] pixels has at least, should it have as many pixels.
const LEAST: u64 = 4096;

/// The largest square that one probe stands for, of such images.
const WIDE: u32 = 8;

/// The square of an image of so many pixels, which has 2000 probes then or more: 1.6 bytes a pixel.
const WIDEST: u32 = 16;
const LARGE: u64 = 512_000;

/// Rec. 709.
pub const LUMINANCE: DVec3 = DVec3::new(0.2126, 0.7152, 0.0722);

impl Probes {
    /// Of an image, or of the part of it that is rendered, of so many pixels: one in 256, and more of a small one.
    pub fn of(width: u32, height: u32) -> Probes {
        let pixels = u64::from(width) * u64::from(height);
        let wide = || (1..=WIDE).rev().find(|s| pixels / u64::from(s * s) >= LEAST).unwrap_or(1);
        Probes { stride: if pixels < LARGE { wide() } else { WIDEST } }
    }

    /// Whether a pixel is one.
    #[inline]
    pub fn is_probe(&self, x: u32, y: u32) -> bool {
        self.of_square(x / self.stride, y / self.stride) == [x, y]
    }

    /// The pixel that is the probe of a square.
    #[inline]
    fn of_square(&self, column: u32, row: u32) -> [u32; 2] {
        let place =
            (combine(mix(u64::from(column)), u64::from(row)) >> 32) as u32 % (self.stride * self.stride);
        [column * self.stride + place % self.stride, row * self.stride + place / self.stride]
    }

    /// For pixels that are asked for row by row.
    pub(super) fn scan(self) -> Scan {
        Scan { probes: self, square: 0..0, row: 0, at: None }
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

/// Whether pixels are probes, told with one look a square's row.
#[derive(Clone, Debug)]
pub(super) struct Scan {
    probes: Probes,
    /// The stretch of a row that was looked at, and the probe in it.
    square: std::ops::Range<u32>,
    row: u32,
    at: Option<u32>,
}

impl Scan {
    #[inline]
    pub fn is_probe(&mut self, x: u32, y: u32) -> bool {
        if y != self.row || !self.square.contains(&x) {
            let stride = self.probes.stride;
            let column = x / stride;
            let [px, py] = self.probes.of_square(column, y / stride);
            self.square = column * stride..(column + 1) * stride;
            self.row = y;
            self.at = (py == y).then_some(px);
        }
        self.at == Some(x)
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

/// How the blur of a density estimate is told: from a second estimate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// With √2 times the radius: an eighth of the other's noise in the squared bias.
    Wide,
    /// With the radius over √2: sees finer detail.
    Narrow,
}

fn added(a: [[Vec3; 2]; 2], b: [[Vec3; 2]; 2]) -> [[Vec3; 2]; 2] {
    std::array::from_fn(|i| std::array::from_fn(|k| a[i][k] + b[i][k]))
}

/// How passes are divided into the parts that are compared with each other: the first quarter or so of them, as
/// much again, and the later half. The first two together are the largest power of two below their number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Parts {
    /// Their number is not known: parts grow as passes come, one after the other.
    #[default]
    Growing,
    /// So many in all, from number `first` on, in any order.
    Of { first: u32, passes: u32 },
}

/// One of the three.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part(usize);

impl Parts {
    /// The part of a pass; `None` where it is the latest.
    pub fn of(self, pass: u32) -> Option<Part> {
        let Parts::Of { first, passes } = self else { return None };
        let half = if passes < 2 { 0 } else { passes.div_ceil(2).next_power_of_two() };
        let n = pass.saturating_sub(first);
        Some(Part(usize::from(n >= half / 2) + usize::from(n >= half)))
    }
}

/// One pixel's statistics. The first two parts of the passes are called its first half.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Probe {
    pub x: u32,
    pub y: u32,
    /// Passes by part.
    counts: [u32; 3],
    /// Sums by kind and part.
    sums: [[DVec3; 3]; 3],
    /// Σ (x − mean)² over passes by kind, by Welford's recurrence.
    squares: [Vec3; 3],
    /// Of all light: the luminance of the brightest pass.
    brightest: f32,
    /// Sums of the estimated bias by [`Look`] of caustic and indirect light, of passes that looked at it; of the
    /// first half, and of what came later.
    bias: [[[Vec3; 2]; 2]; 2],
    looked: [u32; 2],
    /// Σ ½ (a − b)² of the rest over pairs of samples at one place.
    pairs: Vec3,
    paired: u32,
}

record!(Probe, x, y, counts, sums, squares, brightest, bias, looked, pairs, paired);

impl Probe {
    pub(super) fn add(&mut self, x: u32, y: u32, value: &PixelValue, part: Option<Part>) {
        (self.x, self.y) = (x, y);
        // A power of two is full: what comes now is its second half.
        if part.is_none() && self.passes().is_power_of_two() {
            self.close();
        }
        let part = part.map_or(2, |Part(part)| part);
        self.brightest = self.brightest.max(value.radiance.dot(LUMINANCE) as f32);
        let rest = value.radiance - value.caustic - value.indirect;
        let n = f64::from(self.passes());
        for (kind, light) in Kind::ALL.into_iter().zip([rest, value.caustic, value.indirect]) {
            let off = if n == 0.0 { DVec3::ZERO } else { light - self.mean(kind) };
            self.squares[kind as usize] += (off * off * (n / (n + 1.0))).as_vec3();
            self.sums[kind as usize][part] += light;
        }
        self.counts[part] += 1;
        if let Some(bias) = value.bias {
            let half = part / 2;
            self.looked[half] += 1;
            for (sums, seen) in self.bias[half].iter_mut().zip(bias) {
                sums[0] += seen[0].as_vec3();
                sums[1] += seen[1].as_vec3();
            }
        }
        if let Some(pair) = value.pair {
            self.pairs += (0.5 * pair * pair).as_vec3();
            self.paired += 1;
        }
    }

    /// All passes so far become the first half.
    fn close(&mut self) {
        self.sums = self.sums.map(|[first, second, later]| [first + second, later, DVec3::ZERO]);
        let [first, second, later] = self.counts;
        self.counts = [first + second, later, 0];
        let [first, later] = self.bias;
        self.bias = [added(first, later), Default::default()];
        self.looked = [self.looked[0] + self.looked[1], 0];
    }

    /// With the passes of the same probe that were added elsewhere, divided into the same parts.
    pub(super) fn join(&mut self, other: &Probe) {
        if other.passes() == 0 {
            return;
        }
        let (mine, theirs) = (f64::from(self.passes()), f64::from(other.passes()));
        for kind in Kind::ALL {
            // Chan, Golub & LeVeque 1979, eq. 2.1.
            let off = if mine == 0.0 { DVec3::ZERO } else { other.mean(kind) - self.mean(kind) };
            let between = off * off * (mine * theirs / (mine + theirs));
            self.squares[kind as usize] += other.squares[kind as usize] + between.as_vec3();
        }
        (self.x, self.y) = (other.x, other.y);
        for part in 0..3 {
            (0..3).for_each(|kind| self.sums[kind][part] += other.sums[kind][part]);
            self.counts[part] += other.counts[part];
        }
        for i in 0..2 {
            self.looked[i] += other.looked[i];
            self.bias[i] = added(self.bias[i], other.bias[i]);
        }
        self.brightest = self.brightest.max(other.brightest);
        self.pairs += other.pairs;
        self.paired += other.paired;
    }

    /// Passes so far.
    pub fn passes(&self) -> u32 {
        self.counts.iter().sum()
    }

    /// Passes of the first half: a power of two.
    pub fn first_half(&self) -> u32 {
        self.counts[0] + self.counts[1]
    }

    /// The mean of a kind of light over all passes.
    pub fn mean(&self, kind: Kind) -> DVec3 {
        self.sums[kind as usize].iter().sum::<DVec3>() / f64::from(self.passes().max(1))
    }

    /// Of all light.
    pub fn mean_of_all(&self) -> DVec3 {
        Kind::ALL.into_iter().map(|kind| self.mean(kind)).sum()
    }

    /// Mean luminance without the brightest pass.
    pub fn others(&self) -> f64 {
        let passes = self.passes();
        let sum = self.mean_of_all().dot(LUMINANCE) * f64::from(passes);
        (sum - f64::from(self.brightest)) / f64::from(passes.max(2) - 1)
    }

    /// The variance of a kind of light from pass to pass; 0 of one pass.
    pub fn variance(&self, kind: Kind) -> DVec3 {
        self.squares[kind as usize].as_dvec3() / f64::from(self.passes().max(2) - 1)
    }

    /// The mean of a kind of light over the first half.
    fn half(&self, kind: Kind) -> DVec3 {
        let [first, second, _] = self.sums[kind as usize];
        (first + second) / f64::from(self.first_half().max(1))
    }

    /// (Mean of the first half − mean of all)².
    pub fn change(&self, kind: Kind) -> DVec3 {
        let change = self.mean(kind) - self.half(kind);
        change * change
    }

    /// The same of the first half and its own first half.
    pub fn change_before(&self, kind: Kind) -> DVec3 {
        if self.counts[0] == 0 {
            return DVec3::ZERO;
        }
        let change = self.sums[kind as usize][0] / f64::from(self.counts[0]) - self.half(kind);
        change * change
    }

    /// Estimates of the bias of caustic and of indirect light, from the first part of the passes and from the
    /// later ones, whose errors are independent. `None` where either looked at none.
    pub fn biases(&self, look: Look) -> Option<[[DVec3; 2]; 2]> {
        let of = |half: usize| {
            let mean = |sum: Vec3| sum.as_dvec3() / f64::from(self.looked[half]);
            (self.looked[half] > 0).then(|| self.bias[half][look as usize].map(mean))
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
    use crate::math::random::unit;

    #[test]
    fn every_whole_square_has_one_probe() {
        for (width, height) in [(1000, 600), (800, 600), (300, 300), (40, 30)] {
            let probes = Probes::of(width, height);
            let s = probes.stride;
            for (cx, cy) in (0..width / s).flat_map(|cx| (0..height / s).map(move |cy| (cx, cy))) {
                let square = (0..s).flat_map(|dy| (0..s).map(move |dx| (cx * s + dx, cy * s + dy)));
                assert_eq!(square.filter(|&(x, y)| probes.is_probe(x, y)).count(), 1);
            }
            let mut scan = probes.scan();
            for (x, y) in (0..height).flat_map(|y| (3..width).map(move |x| (x, y))) {
                assert_eq!(scan.is_probe(x, y), probes.is_probe(x, y), "{x} {y}");
            }
        }
    }

    fn probe(values: impl IntoIterator<Item = f64>) -> Probe {
        let mut probe = Probe::default();
        for v in values {
            let bias = Some([[DVec3::splat(v), DVec3::ZERO]; 2]);
            let value = PixelValue { radiance: DVec3::splat(v), bias, ..PixelValue::default() };
            probe.add(3, 4, &value, None);
        }
        probe
    }

    /// Means of 1, 2 and 4 passes are 1, 2 and 3.5.
    #[test]
    fn parts_are_powers_of_two() {
        let four = probe([1.0, 3.0, 4.0, 6.0]);
        assert_eq!((four.passes(), four.first_half()), (4, 2));
        assert_eq!(four.change(Kind::Rest).x, 1.5 * 1.5);
        assert_eq!(four.change_before(Kind::Rest).x, 1.0);
        assert_eq!(four.biases(Look::Wide).map(|b| b.map(|[caustic, _]| caustic.x)), Some([2.0, 5.0]));
        assert!((four.variance(Kind::Rest).x - 13.0 / 3.0).abs() < 1e-6);
        let six = probe([1.0, 3.0, 4.0, 6.0, 0.0, 1.0]);
        assert_eq!((six.passes(), six.first_half()), (6, 4));
        assert!((six.change(Kind::Rest).x - 1.0).abs() < 1e-12);
        assert_eq!(six.change_before(Kind::Rest).x, 1.5 * 1.5);
    }

    #[test]
    fn parts_that_are_known_before_are_those_that_grow() {
        for n in 1..40u32 {
            let value = |i: u32| unit(mix(u64::from(i)));
            let grown = probe((0..n).map(value));
            let parts = Parts::Of { first: 5, passes: n };
            let mut joined = Probe::default();
            for share in 0..3 {
                let mut part = Probe::default();
                for i in (0..n).filter(|i| i % 3 == share) {
                    let bias = Some([[DVec3::splat(value(i)), DVec3::ZERO]; 2]);
                    let value =
                        PixelValue { radiance: DVec3::splat(value(i)), bias, ..PixelValue::default() };
                    part.add(3, 4, &value, parts.of(5 + i));
                }
                joined.join(&part);
            }
            assert_eq!((joined.counts, joined.looked), (grown.counts, grown.looked), "{n}");
            let same = |a: DVec3, b: DVec3| assert!((a - b).abs().max_element() < 1e-6, "{n}: {a} {b}");
            same(joined.change(Kind::Rest), grown.change(Kind::Rest));
            same(joined.change_before(Kind::Rest), grown.change_before(Kind::Rest));
            same(joined.variance(Kind::Rest), grown.variance(Kind::Rest));
            same(DVec3::splat(joined.others()), DVec3::splat(grown.others()));
        }
    }
}
