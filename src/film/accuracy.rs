//! How far the picture still is from the truth, from how its passes differ.
//!
//! The error is E = √ mean((I−R)² / (R² + 0.31·m²)) over pixels and channels, m the mean luminance: relative,
//! and the same for any exposure. It has two parts.
//!
//! *Noise.* Photons of different passes are independent: the squared error of their mean over n passes is
//! V(n) = s²/n, s² the variance from pass to pass. Samples in a pixel are well distributed over the passes and
//! better than that: V(n) = s²·n^−p. For p there is how much the mean changed when passes were doubled: the mean
//! of the first half of them and the mean of all differ by D with E[D²] = V(n/2) − V(n), whatever the passes
//! have in common, so long as each part of them is as good as any other of its size. Passes beyond a power of
//! two begin a part of their own, independent of the others until it is full.
//!
//! *Bias.* The blur of the density estimate goes as the square of its radius where light is smooth (Silverman
//! 1986, 4.3), so the estimates at r and r/√2 differ by half of it. Products of two halves of the passes, whose
//! noise is independent, estimate its square without the noise.
//!
//! What no pass can tell is not in it: the depth limit, three colours, facets of meshes, and paths so rare
//! that none was found.

use super::brightness::Brightness;
use crate::math::DVec3;
use crate::math::random::{combine, mix};
use crate::trace::{Kind, Measured, Probe};
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

/// Rates that are believed of samples that are well distributed: from a little worse than independent ones to
/// those of smooth things in one dimension.
const RATES: [f64; 2] = [0.8, 3.0];

/// What is assumed while there are too few passes to tell: between independent samples and the 1.3 to 1.5 that are
/// usual for edges and soft shadows.
const EARLY_RATE: f64 = 1.2;

/// The rate of photons' noise while their radius shrinks, α = 2/3 (Knaus & Zwicker 2011).
const PHOTON_RATE: f64 = 2.0 / 3.0;

/// The squared bias of progressive passes falls as n^−2(1−α), α = 2/3 (Knaus & Zwicker 2011).
pub const BIAS_RATE: f64 = 2.0 / 3.0;

impl Accuracy {
    /// Of all pixels and the probes of a picture, in any order. `None` where
    /// fewer than two passes are there, or everything is black.
    pub(super) fn of<'a>(
        pixels: impl Iterator<Item = Measured>,
        probes: impl Iterator<Item = &'a Probe>,
        picture: &Brightness,
    ) -> Option<Accuracy> {
        let floor = FLOOR * picture.mean() * picture.mean();
        if !(floor > 0.0 && floor.is_finite()) {
            return None;
        }
        let mut probes: Vec<&Probe> = probes.filter(|probe| probe.passes > 1).collect();
        // A fixed order, whatever the tiles, so that sums have the same bits.
        probes.sort_by_key(|probe| (probe.y, probe.x));
        // A last pass that was broken off left some with one more: as most have it.
        let [least, most] = [probes.iter().map(|p| p.passes).min()?, probes.iter().map(|p| p.passes).max()?];
        let fewer = probes.iter().filter(|probe| probe.passes == least).count();
        let passes = if 2 * fewer >= probes.len() { least } else { most };
        probes.retain(|probe| probe.passes == passes);
        let part = probes.first()?.part;

        let independent = Independent::of(pixels, picture, floor);
        let mut groups = vec![Sums::default(); GROUPS as usize];
        for probe in &probes {
            let group = combine(mix(u64::from(probe.x)), u64::from(probe.y)) % GROUPS;
            groups[group as usize].add(probe, picture, floor);
        }
        let all = groups.iter().fold(Sums::default(), |sum, group| sum.with(group, 1.0));
        let squared = |sums: &Sums| independent.mean * sums.gain(part, passes) + sums.bias(2);
        let e = squared(&all).sqrt();
        let mut accuracy = all.accuracy(part, passes, independent.mean);
        // Chance in the pixels' errors and in what is known of them; the jackknife over groups of probes, of ln E;
        // and how far the model may be off.
        let chance =
            0.5 * TWO_SIGMA * (2.0 * f64::from(passes) / f64::from(passes - 1)).sqrt() * independent.scatter;
        let logs: Vec<f64> = groups
            .iter()
            .filter(|group| group.count > 0.0)
            .map(|group| 0.5 * libm::log(squared(&all.with(group, -1.0)).max(1e-6 * e * e) / (e * e)))
            .filter(|log| log.is_finite())
            .collect();
        let n = (logs.len() as f64).max(1.0);
        let mean = logs.iter().sum::<f64>() / n;
        let jackknife = STUDENT
            * (logs.iter().map(|log| (log - mean) * (log - mean)).sum::<f64>() * (n - 1.0) / n).sqrt();
        let model = match passes {
            2..4 => 0.3,
            4..8 => 0.2,
            _ => 0.12,
        };
        let half = (chance * chance + jackknife * jackknife + model * model).sqrt();
        accuracy.interval = [e * libm::exp(-half), e * libm::exp(half)];
        Some(accuracy)
    }
}

/// The squared error of all pixels, were their passes independent.
struct Independent {
    mean: f64,
    /// √Σt²/Σt of the pixels' parts t: how much it hangs on few of them.
    scatter: f64,
}

impl Independent {
    fn of(pixels: impl Iterator<Item = Measured>, picture: &Brightness, floor: f64) -> Independent {
        // Whole numbers: their sum is the same in any order.
        let (mut count, mut sum, mut squares) = (0u64, 0u128, 0u128);
        for pixel in pixels {
            let weight = weight(pixel.mean * picture.trusted(pixel.x, pixel.y, pixel.halves), floor);
            let t = (pixel.variance * weight).element_sum() / (3.0 * f64::from(pixel.passes));
            count += 1;
            sum += (t.min(MOST) * UNIT) as u128;
            squares += (t.min(MOST) * t.min(MOST) * UNIT) as u128;
        }
        let [sum, squares] = [sum, squares].map(|whole| whole as f64 / UNIT);
        let scatter = if sum > 0.0 { squares.sqrt() / sum } else { 0.0 };
        Independent { mean: sum / (count as f64).max(1.0), scatter }
    }
}

/// Steps of the sums in a squared error of 1, and the most that one pixel can have.
const UNIT: f64 = (1u64 << 62) as f64;
const MOST: f64 = 1e6;

/// 1/(R² + floor) by channel.
fn weight(r: DVec3, floor: f64) -> DVec3 {
    1.0 / (r * r + floor)
}

/// Of a normal distribution, for 95 %.
const TWO_SIGMA: f64 = 1.96;

/// Sums over probes of squares, relative and averaged over channels.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    count: f64,
    /// Variances from pass to pass, by kind.
    variance: [f64; 3],
    /// Of the rest: the last change of the mean, and the one before.
    changes: [f64; 2],
    /// Products of two halves' biases, of caustic, indirect and both; and how many.
    bias: [f64; 3],
    biased: f64,
    /// Of probes that know what is left at one place: that, and all of the variance of the rest.
    place: [f64; 2],
}

impl Sums {
    fn add(&mut self, probe: &Probe, picture: &Brightness, floor: f64) {
        let trusted = picture.trusted(probe.x, probe.y, probe.halves());
        let weight = weight(probe.mean_of_all() * trusted, floor);
        let relative = |square: DVec3| (square * weight).element_sum() / 3.0;
        self.count += 1.0;
        for kind in Kind::ALL {
            self.variance[kind as usize] += relative(probe.variance(kind));
        }
        self.changes[0] += relative(probe.change());
        self.changes[1] += relative(probe.change_before());
        if let Some([[caustic, indirect], [caustic_later, indirect_later]]) = probe.biases() {
            self.biased += 1.0;
            self.bias[0] += relative(caustic * caustic_later);
            self.bias[1] += relative(indirect * indirect_later);
            self.bias[2] += relative((caustic + indirect) * (caustic_later + indirect_later));
        }
        if let Some(at_one_place) = probe.variance_at_one_place() {
            self.place[0] += relative(at_one_place);
            self.place[1] += relative(probe.variance(Kind::Rest));
        }
    }

    /// Together with `times` another.
    fn with(&self, other: &Sums, times: f64) -> Sums {
        let mut sum = *self;
        let add =
            |mine: &mut [f64], theirs: &[f64]| mine.iter_mut().zip(theirs).for_each(|(a, b)| *a += times * b);
        add(&mut sum.variance, &other.variance);
        add(&mut sum.changes, &other.changes);
        add(&mut sum.bias, &other.bias);
        add(&mut sum.place, &other.place);
        sum.count += times * other.count;
        sum.biased += times * other.biased;
        sum
    }

    /// The squared noise of the mean of all passes, and the rate at which it will fall.
    fn noise(&self, kind: Kind, part: u32, passes: u32) -> [f64; 2] {
        let s2 = self.variance[kind as usize] / self.count.max(1.0);
        if kind != Kind::Rest {
            return [s2 / f64::from(passes), PHOTON_RATE];
        }
        let change = (self.changes[0] + self.changes[1]) / self.count.max(1.0);
        if s2 <= 0.0 {
            return [0.0, EARLY_RATE];
        }
        // Before that two rates could make the same change.
        if part < 4 {
            return [s2 * Law(EARLY_RATE).of(part.max(1), passes), EARLY_RATE];
        }
        // The change falls as the rate rises.
        let [mut low, mut high] = RATES;
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if s2 * Law(middle).change(part, passes) > change { low = middle } else { high = middle }
        }
        let law = Law(0.5 * (low + high));
        [s2 * law.of(part, passes), law.0]
    }

    /// The squared bias: 0 caustic, 1 indirect, 2 both.
    fn bias(&self, which: usize) -> f64 {
        (self.bias[which] / self.biased.max(1.0)).max(0.0)
    }

    /// The squared noise over what it would be of independent passes.
    fn gain(&self, part: u32, passes: u32) -> f64 {
        let independent = self.variance.iter().sum::<f64>() / (self.count.max(1.0) * f64::from(passes));
        let noise: f64 = Kind::ALL.into_iter().map(|kind| self.noise(kind, part, passes)[0]).sum();
        if independent > 0.0 { noise / independent } else { 1.0 }
    }

    /// `independent`: the squared error of all pixels, were their passes independent.
    fn accuracy(&self, part: u32, passes: u32, independent: f64) -> Accuracy {
        // Of what differs from pass to pass, what does not differ at one place is the pixel's extent.
        let [place, all] = self.place;
        let edges = if all > 0.0 { (1.0 - place / all).max(0.0) } else { 0.0 };
        let [rest, rate] = self.noise(Kind::Rest, part, passes);
        let [caustic, caustic_rate] = self.noise(Kind::Caustic, part, passes);
        let [indirect, indirect_rate] = self.noise(Kind::Indirect, part, passes);
        let rows = [
            ("edges", rest * edges, 0.0, rate),
            ("direct", rest * (1.0 - edges), 0.0, rate),
            ("caustics", caustic, self.bias(0), caustic_rate),
            ("indirect", indirect, self.bias(1), indirect_rate),
        ];
        // Probes tell how it is shared, all pixels how much it is.
        let noise = independent * self.gain(part, passes);
        let probed = rest + caustic + indirect;
        let scale = if probed > 0.0 { noise / probed } else { 0.0 };
        let rows = rows.map(|(effect, noise, bias, rate)| (effect, noise * scale, bias, rate));
        let error = (noise + self.bias(2)).sqrt();
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
            bias: self.bias(2).sqrt(),
            by_effect: rows.map(part).collect(),
        }
    }
}

/// V(n)/V(1) of samples that are well distributed over parts of a power of two, at a rate.
#[derive(Clone, Copy, Debug)]
struct Law(f64);

impl Law {
    /// Of a full part.
    fn full(self, n: u32) -> f64 {
        libm::pow(f64::from(n), -self.0)
    }

    /// Of any number of passes: full parts, the largest first, each independent of the others.
    fn any(self, mut n: u32) -> f64 {
        let all = f64::from(n);
        let mut sum = 0.0;
        while n > 0 {
            let part = 1 << n.ilog2();
            sum += f64::from(part) * f64::from(part) * self.full(part);
            n -= part;
        }
        sum / (all * all)
    }

    /// Of `passes` passes, the first `part` of which are full.
    fn of(self, part: u32, passes: u32) -> f64 {
        if passes == 2 * part { self.full(passes) } else { self.any(passes) }
    }

    /// The squared change of the mean since half of the first part, in its two steps together.
    fn change(self, part: u32, passes: u32) -> f64 {
        let before = self.full(part / 2) - self.full(part);
        let late = passes - part;
        if late == part {
            return before + self.full(part) - self.full(passes);
        }
        let share = f64::from(late) / f64::from(passes);
        before + share * share * (self.full(part) + if late > 0 { self.any(late) } else { 0.0 })
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
