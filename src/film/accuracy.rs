//! How far the picture still is from the truth, from how its passes differ.
//!
//! The error is E = √ mean((I−R)² / (R² + 0.31·m²)) over pixels and channels, m the mean luminance: relative,
//! and the same for any exposure. It has two parts.
//!
//! *Noise.* Let V(n) be the squared error of the mean of n passes. The mean of the first a of them and of all
//! n differ by D(a, n), and E[D²] = V(a) − V(n) whatever the correlation between passes, so long as each
//! part of them is as good as any other of its size: samples that are well distributed over the passes are
//! not taken for independent ones. With V(n) = c·n^−p the last two such differences give c and p.
//!
//! *Bias.* The blur of the density estimate goes as the square of its radius (Silverman 1986, 4.3), so the
//! estimates at r and r/√2 differ by half of it. Products of two halves of the passes, whose noise is
//! independent, estimate its square without the noise.
//!
//! What no pass can tell is not in it: the depth limit, three colours, facets of meshes, and paths so rare
//! that none was found.

use crate::math::DVec3;
use crate::math::random::{combine, mix};
use crate::trace::{Kind, Probe};
use serde::Serialize;

/// The relative RMS error of a picture, 1 for 100 %.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Accuracy {
    pub passes: u32,
    /// Noise and bias together: their squares add up to its square.
    pub error: f64,
    /// Within this with 95 % confidence.
    pub interval: [f64; 2],
    pub noise: f64,
    pub bias: f64,
    pub by_effect: Vec<Part>,
}

/// What one effect adds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Part {
    /// `edges`: what differs across a pixel; `direct`: lamps with an extent, the lens, and whatever else
    /// chance decides at one place of it; `caustics`; `indirect`.
    pub effect: &'static str,
    /// Of the squared error.
    pub share: f64,
    /// p: the squared noise falls as passes^−p.
    pub rate: f64,
    pub noise: f64,
    pub bias: f64,
}

/// 0.01/0.18²: see the module's text.
const FLOOR: f64 = 0.31;

/// Groups of probes, to see how much the estimate hangs on some of them; Student's t for 95 % and one less.
const GROUPS: u64 = 16;
const STUDENT: f64 = 2.131;

/// Rates that are believed: noise of independent passes has 1, that of shrinking radii 2/3, that of samples
/// well distributed over smooth things up to 3.
const RATES: [f64; 2] = [0.4, 2.0];

/// The squared bias of progressive passes falls as n^−2(1−α), α = 2/3 (Knaus & Zwicker 2011).
pub const BIAS_RATE: f64 = 2.0 / 3.0;

impl Accuracy {
    /// Of a picture of mean luminance `luminance` with these probes, in any order. `None` where fewer than two
    /// passes are there, or everything is black.
    pub fn of<'a>(probes: impl Iterator<Item = &'a Probe>, luminance: f64) -> Option<Accuracy> {
        let mut probes: Vec<&Probe> = probes.filter(|probe| probe.passes > 1).collect();
        // A fixed order, whatever the tiles, so that sums have the same bits.
        probes.sort_by_key(|probe| (probe.y, probe.x));
        // A last pass that was broken off left some with one more: as most have it.
        let [least, most] = [probes.iter().map(|p| p.passes).min()?, probes.iter().map(|p| p.passes).max()?];
        let fewer = probes.iter().filter(|probe| probe.passes == least).count();
        let passes = if 2 * fewer >= probes.len() { least } else { most };
        probes.retain(|probe| probe.passes == passes);
        let floor = FLOOR * luminance * luminance;
        if !(floor > 0.0 && floor.is_finite()) {
            return None;
        }
        let mut groups = vec![Sums::default(); GROUPS as usize];
        for probe in &probes {
            let group = combine(mix(u64::from(probe.x)), u64::from(probe.y)) % GROUPS;
            groups[group as usize].add(probe, floor);
        }
        let all = groups.iter().fold(Sums::default(), |sum, group| sum.with(group, 1.0));
        let part = probes.first()?.part;
        let error = |sums: &Sums| sums.total(part, passes).sqrt();
        let e = error(&all);
        let mut accuracy = all.accuracy(part, passes, e);
        // The jackknife over groups, of ln E; and how far the model of n^−p may be off.
        let logs: Vec<f64> = groups
            .iter()
            .filter(|group| group.count > 0.0)
            .map(|group| libm::log(error(&all.with(group, -1.0)).max(1e-3 * e) / e))
            .filter(|log| log.is_finite())
            .collect();
        let n = logs.len() as f64;
        let mean = logs.iter().sum::<f64>() / n.max(1.0);
        let variance =
            logs.iter().map(|log| (log - mean) * (log - mean)).sum::<f64>() * (n - 1.0).max(0.0) / n.max(1.0);
        let model = match passes {
            2..4 => 0.35,
            4..8 => 0.2,
            _ => 0.1,
        };
        let half = (STUDENT * STUDENT * variance + model * model).sqrt();
        accuracy.interval = [e * libm::exp(-half), e * libm::exp(half)];
        Some(accuracy)
    }
}

/// Sums over probes of squares, relative and averaged over channels.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    count: f64,
    /// By kind: of the last change, and of the one before.
    late: [f64; 4],
    before: [f64; 4],
    /// Products of two halves' biases, of caustic, indirect and both; and how many.
    bias: [f64; 3],
    biased: f64,
    /// Variances from pass to pass, and at one place; and how many.
    rest: [f64; 2],
    paired: f64,
}

impl Sums {
    fn add(&mut self, probe: &Probe, floor: f64) {
        let r = probe.mean(Kind::Total);
        let relative = |square: DVec3| (square / (r * r + floor)).element_sum() / 3.0;
        self.count += 1.0;
        for kind in Kind::ALL {
            self.late[kind as usize] += relative(probe.change(kind));
            self.before[kind as usize] += relative(probe.change_before(kind));
        }
        let product = |kind| probe.biases(kind).map(|[a, b]| relative(a * b));
        if let (Some(caustic), Some(indirect), Some(both)) =
            (product(Kind::Caustic), product(Kind::Indirect), product(Kind::Total))
        {
            self.biased += 1.0;
            for (sum, value) in self.bias.iter_mut().zip([caustic, indirect, both]) {
                *sum += value;
            }
        }
        if let Some(variances) = probe.rest_variance() {
            self.paired += 1.0;
            for (sum, variance) in self.rest.iter_mut().zip(variances) {
                *sum += relative(variance);
            }
        }
    }

    /// Together with `times` another.
    fn with(&self, other: &Sums, times: f64) -> Sums {
        let add = |a: f64, b: f64| a + times * b;
        let mut sum = *self;
        sum.count = add(sum.count, other.count);
        sum.biased = add(sum.biased, other.biased);
        sum.paired = add(sum.paired, other.paired);
        let pairs = [(&mut sum.late, &other.late), (&mut sum.before, &other.before)];
        for (mine, theirs) in pairs {
            mine.iter_mut().zip(theirs).for_each(|(a, b)| *a = add(*a, *b));
        }
        sum.bias.iter_mut().zip(&other.bias).for_each(|(a, b)| *a = add(*a, *b));
        sum.rest.iter_mut().zip(&other.rest).for_each(|(a, b)| *a = add(*a, *b));
        sum
    }

    /// The squared noise of the mean of all passes, and the rate at which it falls.
    fn noise(&self, kind: Kind, part: u32, passes: u32) -> [f64; 2] {
        let late = (self.late[kind as usize] / self.count.max(1.0)).max(0.0);
        let before = (self.before[kind as usize] / self.count.max(1.0)).max(0.0);
        let (a, n) = (f64::from(part), f64::from(passes));
        if part < 2 {
            return [late / (1.0 / a - 1.0 / n) / n, 1.0];
        }
        if late + before <= 0.0 {
            return [0.0, 1.0];
        }
        // The rate at which D(a, n) / D(a/2, a) is as found: it rises as p falls.
        let drop = |from: f64, to: f64, p: f64| libm::pow(from, -p) - libm::pow(to, -p);
        let ratio = |p: f64| drop(a, n, p) / drop(a / 2.0, a, p);
        let [mut low, mut high] = RATES;
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if ratio(middle) * before > late { low = middle } else { high = middle }
        }
        let p = 0.5 * (low + high);
        [(late + before) / drop(a / 2.0, n, p) * libm::pow(n, -p), p]
    }

    /// The squared bias: 0 caustic, 1 indirect, 2 both.
    fn bias(&self, which: usize) -> f64 {
        (self.bias[which] / self.biased.max(1.0)).max(0.0)
    }

    /// The squared error.
    fn total(&self, part: u32, passes: u32) -> f64 {
        self.noise(Kind::Total, part, passes)[0] + self.bias(2)
    }

    fn accuracy(&self, part: u32, passes: u32, error: f64) -> Accuracy {
        let [noise, _] = self.noise(Kind::Total, part, passes);
        let bias = self.bias(2);
        // Of what differs from pass to pass, what does not differ at one place is the pixel's extent.
        let [between, within] = self.rest;
        let edges = if self.paired > 0.0 && between > 0.0 { (1.0 - within / between).max(0.0) } else { 0.0 };
        let [rest, rest_rate] = self.noise(Kind::Rest, part, passes);
        let [caustic, caustic_rate] = self.noise(Kind::Caustic, part, passes);
        let [indirect, indirect_rate] = self.noise(Kind::Indirect, part, passes);
        let rows = [
            ("edges", rest * edges, 0.0, rest_rate),
            ("direct", rest * (1.0 - edges), 0.0, rest_rate),
            ("caustics", caustic, self.bias(0), caustic_rate),
            ("indirect", indirect, self.bias(1), indirect_rate),
        ];
        let sum: f64 = rows.iter().map(|(_, noise, bias, _)| noise + bias).sum();
        let rows = rows.into_iter().filter(|(_, noise, bias, _)| noise + bias > 0.0);
        let part = |(effect, noise, bias, rate): (&'static str, f64, f64, f64)| Part {
            effect,
            share: (noise + bias) / sum,
            rate,
            noise: noise.sqrt(),
            bias: bias.sqrt(),
        };
        Accuracy {
            passes,
            error,
            interval: [error; 2],
            noise: noise.sqrt(),
            bias: bias.sqrt(),
            by_effect: rows.map(part).collect(),
        }
    }
}

impl Accuracy {
    /// The passes in all after which the error will be `target`, at the rates found so far.
    pub fn passes_for(&self, target: f64) -> f64 {
        let n = f64::from(self.passes);
        let sum: f64 = self.by_effect.iter().map(|part| part.noise * part.noise).sum();
        let scale = if sum > 0.0 { self.noise * self.noise / sum } else { 0.0 };
        let squared = |times: f64| -> f64 {
            let noise = |part: &Part| scale * part.noise * part.noise * libm::pow(times, -part.rate);
            self.by_effect.iter().map(noise).sum::<f64>()
                + self.bias * self.bias * libm::pow(times, -BIAS_RATE)
        };
        let (mut low, mut high) = (-20.0, 40.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if squared(libm::exp2(middle)) > target * target { low = middle } else { high = middle }
        }
        n * libm::exp2(high)
    }
}
