//! How noise falls with passes whose samples are well distributed over them, V(n), from differences that can be seen.
//!
//! What n passes show is always a difference, whatever they have in common: their scatter about their mean tells
//! V(1) − V(n), and how much the mean changed when passes were doubled V(n/4) − V(n/2) and V(n/2) − V(n). What has
//! not changed yet they cannot tell; so the last change is taken to go on at a rate, V(n/2) − V(n) = (2^p − 1)·V(n).
//! There are up to three rates to take:
//!
//! - the *local* one, of the last two changes. Where a doubling happens to be a good one it tells too little.
//! - the *overall* one, of the changes and the scatter. Rates fall with the passes where samples have many
//!   dimensions, and rise where few of them are worse than the others would have it, as in soft shadows.
//! - the *typical* one of scenes, which no chance is in.
//!
//! The middle of the least and of the most is stated, and how far they are apart is a part of the interval.

/// No noise falls at a higher rate than this.
const STEEPEST: f64 = 3.0;

/// Rates that the last two changes are believed to show, and those of all.
const LOCAL: [f64; 2] = [1.0, 2.0];
const OVERALL: [f64; 2] = [0.8, 2.5];

/// The rate of scenes at so many passes: between the 1.5 of edges alone and the 1 of independent samples, and nearer
/// to that the more there are.
fn typical(passes: u32) -> f64 {
    match passes {
        ..8 => 1.4,
        8..16 => 1.3,
        _ => 1.2,
    }
}

/// How far the logarithm of the root may be off beside what the rates differ by, with 95 %: see the test of curves
/// that were measured.
pub(super) fn beyond(passes: u32) -> f64 {
    match passes {
        ..8 => 0.3,
        8..16 => 0.25,
        _ => 0.15,
    }
}

/// V(n) by all rates that fit, over the variance from pass to pass.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fits {
    least: f64,
    most: f64,
    /// At which it will fall; of photons, were their radius to stay.
    pub rate: f64,
}

impl Fits {
    /// To the last change of the mean, over the variance from pass to pass, and to the one before; the first `part`
    /// of the passes are full.
    pub fn of([last, before]: [f64; 2], part: u32, passes: u32) -> Fits {
        let seen = Seen { last, before, part: part.max(1), passes };
        let rates: Vec<f64> =
            [Some(typical(passes)), seen.local(), seen.overall()].into_iter().flatten().collect();
        // Where the first part has not changed, no rate tells what the later passes have found: if one has, it is its
        // own squared error.
        let noise =
            |rate: &f64| if seen.before <= 0.0 && !seen.full() { seen.last } else { seen.noise(*rate) };
        let values = rates.iter().map(|rate| noise(rate).max(seen.least()));
        Fits {
            least: values.clone().fold(f64::INFINITY, f64::min),
            most: values.fold(0.0, f64::max),
            rate: rates.iter().sum::<f64>() / rates.len() as f64,
        }
    }

    /// The same of light whose passes are independent but for where in a pixel they look, in which they are well
    /// distributed: photons' noise falls at the rate 1; where the other part is most of it, at the local one.
    pub fn of_photons([last, before]: [f64; 2], part: u32, passes: u32) -> Fits {
        let seen = Seen { last, before, part: part.max(1), passes };
        let most = seen.noise_of_independent().max(seen.least());
        let local = seen.local();
        let least = local.map_or(most, |rate| seen.noise(rate).clamp(seen.least(), most));
        Fits { least, most, rate: local.unwrap_or(1.0) }
    }

    pub fn middle(self) -> f64 {
        (self.least * self.most).sqrt()
    }

    /// The logarithm of the factor between the root of the middle and those of the ends.
    pub fn doubt(self) -> f64 {
        if self.least > 0.0 { 0.25 * libm::log(self.most / self.least) } else { 0.0 }
    }
}

/// What passes have shown.
#[derive(Clone, Copy, Debug)]
struct Seen {
    /// The squared change of the mean from the first `part` passes to all.
    last: f64,
    /// That from half of the first part to all of it: V(part/2) − V(part).
    before: f64,
    part: u32,
    passes: u32,
}

impl Seen {
    /// Whether the passes are a power of two, well distributed all together.
    fn full(&self) -> bool {
        self.passes == 2 * self.part
    }

    /// V(1) − V(n), over the variance from pass to pass, which is n/(n − 1) times as large.
    fn scatter(&self) -> f64 {
        1.0 - 1.0 / f64::from(self.passes)
    }

    /// V of all passes, should it fall at a rate.
    fn noise(&self, rate: f64) -> f64 {
        if self.full() {
            return self.last / (libm::exp2(rate) - 1.0);
        }
        // Between those of full parts, and of parts that are independent of each other: what comes after the first
        // part fills its gaps, but not as well as all of the next will.
        let part = self.before / (libm::exp2(rate) - 1.0);
        let times = f64::from(self.passes) / f64::from(self.part);
        part * (libm::pow(times, -rate) * independent(self.passes, self.part, rate)).sqrt()
    }

    /// V of all passes, should it fall as that of independent ones.
    fn noise_of_independent(&self) -> f64 {
        if self.full() {
            return self.last;
        }
        // Both changes tell V of the first part; each counts as the passes that are in it alone.
        let [all, part, late] = [self.passes, self.part, self.passes - self.part].map(f64::from);
        let later = self.last * all * all / (late + part);
        (self.before * part + later) / all * part / all
    }

    /// The rate of the last two changes. `None` of fewer than three passes, or where the later ones are too few.
    fn local(&self) -> Option<f64> {
        if self.part < 2 || self.last <= 0.0 || self.before <= 0.0 {
            return None;
        }
        if self.full() {
            return Some(libm::log2(self.before / self.last).clamp(LOCAL[0], LOCAL[1]));
        }
        let late = self.passes - self.part;
        if 2 * late < self.part {
            return None;
        }
        // The means of the first part and of the later passes, as though independent, differ by V of both.
        let [all, part, late] = [self.passes, self.part, late].map(f64::from);
        let apart = self.last * (all / late) * (all / late) / self.before;
        Some(solve(LOCAL, apart, |rate| (1.0 + libm::pow(late / part, -rate)) / (libm::exp2(rate) - 1.0)))
    }

    /// The one rate of the changes and of the scatter. `None` of few passes, whose changes are most of the scatter:
    /// the first two may be far worse than what follows.
    fn overall(&self) -> Option<f64> {
        if self.part < 8 {
            return None;
        }
        let v = |n: u32, rate: f64| libm::pow(f64::from(n), -rate);
        let (change, end) =
            if self.full() { (self.last + self.before, self.passes) } else { (self.before, self.part) };
        Some(solve(OVERALL, change / self.scatter(), |rate| {
            (v(self.part / 2, rate) - v(end, rate)) / (1.0 - v(self.passes, rate))
        }))
    }

    /// The least that is believed: what the scatter has left at the steepest rate, lest changes that are 0 by chance
    /// tell of no noise.
    fn least(&self) -> f64 {
        self.scatter() * libm::pow(f64::from(self.passes), -STEEPEST)
    }
}

/// Where `falling` is `value`, or the end of the range that is nearest to it.
fn solve([mut low, mut high]: [f64; 2], value: f64, falling: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if falling(middle) > value { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// V(n)/V(part) of full parts, the largest first, each independent of the others.
fn independent(mut n: u32, part: u32, rate: f64) -> f64 {
    let all = f64::from(n);
    let mut sum = 0.0;
    while n > 0 {
        let full = f64::from(1 << n.ilog2());
        sum += full * full * libm::pow(full / f64::from(part), -rate);
        n -= 1 << n.ilog2();
    }
    sum / (all * all)
}

#[cfg(test)]
mod tests;
