//! What probes tell of the noise and the bias, and of which effects bring them.

use super::law::Fits;
use super::{Rates, weight};
use crate::film::brightness::Brightness;
use crate::math::DVec3;
use crate::trace::{Kind, Look, Probe};

/// What the local rate of independent passes may be off by.
const BY_CHANCE: f64 = 0.15;

/// Sums over probes of squares, relative and averaged over channels.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    pub count: f64,
    /// Variances from pass to pass, by kind.
    variance: [f64; 3],
    /// By kind: the last change of the mean, and the one before.
    changes: [[f64; 2]; 3],
    /// Products of two halves' biases by [`Look`], of caustic, indirect and both; and how many.
    bias: [[f64; 3]; 2],
    biased: [f64; 2],
    /// Of probes that know what is left at one place: that, and all of the variance of the rest.
    place: [f64; 2],
}

impl Sums {
    pub fn add(&mut self, probe: &Probe, picture: &Brightness, floor: f64) {
        let trusted = picture.trusted(probe.x, probe.y, probe.others(), probe.passes());
        let weight = weight(probe.mean_of_all() * trusted, floor);
        let relative = |square: DVec3| (square * weight).element_sum() / 3.0;
        self.count += 1.0;
        for kind in Kind::ALL {
            self.variance[kind as usize] += relative(probe.variance(kind));
            let [last, before] = &mut self.changes[kind as usize];
            *last += relative(probe.change(kind));
            *before += relative(probe.change_before(kind));
        }
        for look in [Look::Wide, Look::Narrow] {
            if let Some([[caustic, indirect], [caustic_later, indirect_later]]) = probe.biases(look) {
                self.biased[look as usize] += 1.0;
                let bias = &mut self.bias[look as usize];
                bias[0] += relative(caustic * caustic_later);
                bias[1] += relative(indirect * indirect_later);
                bias[2] += relative((caustic + indirect) * (caustic_later + indirect_later));
            }
        }
        if let Some(at_one_place) = probe.variance_at_one_place() {
            self.place[0] += relative(at_one_place);
            self.place[1] += relative(probe.variance(Kind::Rest));
        }
    }

    /// Together with `times` another.
    pub fn with(&self, other: &Sums, times: f64) -> Sums {
        let mut sum = *self;
        let add =
            |mine: &mut [f64], theirs: &[f64]| mine.iter_mut().zip(theirs).for_each(|(a, b)| *a += times * b);
        add(&mut sum.variance, &other.variance);
        (0..3).for_each(|kind| add(&mut sum.changes[kind], &other.changes[kind]));
        add(&mut sum.bias[0], &other.bias[0]);
        add(&mut sum.bias[1], &other.bias[1]);
        add(&mut sum.biased, &other.biased);
        add(&mut sum.place, &other.place);
        sum.count += times * other.count;
        sum
    }

    /// The noise of a kind of light in the mean of all passes.
    fn noise(&self, kind: Kind, part: u32, passes: u32) -> Noise {
        let s2 = self.variance[kind as usize] / self.count.max(1.0);
        if s2 <= 0.0 {
            return Noise { squared: 0.0, rate: 1.0, doubt: 0.0 };
        }
        let changes = self.changes[kind as usize].map(|change| change / (s2 * self.count.max(1.0)));
        let fits = match kind {
            Kind::Rest => Fits::of(changes, part, passes),
            Kind::Caustic | Kind::Indirect => Fits::of_photons(changes, part, passes),
        };
        Noise { squared: s2 * fits.middle(), rate: fits.rate, doubt: fits.doubt() }
    }

    /// By what factor the noise may be off, as far as rates that fit what was seen differ: its logarithm.
    pub fn doubt(&self, part: u32, passes: u32) -> f64 {
        let kinds = Kind::ALL.map(|kind| self.noise(kind, part, passes));
        let all: f64 = kinds.iter().map(|noise| noise.squared).sum();
        if all > 0.0 { kinds.iter().map(|noise| noise.doubt * noise.squared).sum::<f64>() / all } else { 0.0 }
    }

    /// The squared bias: 0 caustic, 1 indirect, 2 both. Below 0 by chance where it is small.
    pub fn bias(&self, look: Look, which: usize) -> f64 {
        self.bias[look as usize][which] / self.biased[look as usize].max(1.0)
    }

    /// The squared noise over what it would be of independent passes.
    pub fn gain(&self, part: u32, passes: u32) -> f64 {
        let independent = self.variance.iter().sum::<f64>() / (self.count.max(1.0) * f64::from(passes));
        let noise: f64 = Kind::ALL.into_iter().map(|kind| self.noise(kind, part, passes).squared).sum();
        if independent > 0.0 { noise / independent } else { 1.0 }
    }

    /// The squared noise of the probes by effect; that of photons falls at these rates. `independent`: as that of
    /// independent passes, whatever the probes tell.
    pub fn rows(&self, part: u32, passes: u32, rates: Rates, independent: bool) -> [Row; 4] {
        // Of what differs from pass to pass, what does not differ at one place is the pixel's extent.
        let [place, all] = self.place;
        let edges = if all > 0.0 { (1.0 - place / all).max(0.0) } else { 0.0 };
        let row = |effect, kind, share: f64| {
            let noise = if independent {
                let squared = self.variance[kind as usize] / (self.count.max(1.0) * f64::from(passes));
                Noise { squared, rate: 1.0, doubt: 0.0 }
            } else {
                self.noise(kind, part, passes)
            };
            Row { effect, noise: noise.squared * share, rate: noise.rate }
        };
        // A radius that shrinks takes from the rate that passes of one radius have: 1, where no more than chance is seen.
        let photons = |rate: f64, row: Row| Row { rate: (row.rate - BY_CHANCE).max(1.0) - 1.0 + rate, ..row };
        [
            row("edges", Kind::Rest, edges),
            row("direct", Kind::Rest, 1.0 - edges),
            photons(rates.caustics, row("caustics", Kind::Caustic, 1.0)),
            photons(rates.indirect, row("indirect", Kind::Indirect, 1.0)),
        ]
    }
}

/// The noise of one kind of light.
struct Noise {
    squared: f64,
    /// At which it will fall; of photons [`Rates`] say it.
    rate: f64,
    /// The logarithm of the factor by which its root may be off.
    doubt: f64,
}

/// What one effect adds to the squared noise, and the rate at which that falls.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub effect: &'static str,
    pub noise: f64,
    pub rate: f64,
}
