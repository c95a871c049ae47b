//! How noise falls with passes whose samples are well distributed over them: V(n)/V(1).
//!
//! How much the mean has changed tells V(n/4) − V(n), and what has not changed yet it cannot tell: a part of the
//! noise that falls slowly looks like nothing. So several laws are fitted:
//!
//! - one rate, V = n^−p. Where samples are many-dimensional and rates fall with the passes it tells too little.
//! - a part that falls as if passes were independent, and one that falls as that of smooth things in two dimensions
//!   does, V = a/n + (1 − a)/n². Where edges alone make the noise (p about 1.5) it tells too much.
//!
//! - one rate again, but from the last two changes alone: what V(1) is does not matter. Where two passes in a pixel
//!   are worse than the others would have it, as in soft shadows, both of the former tell too much.
//!
//! The truth lies between, as far as it was looked at; how far apart they are is a part of the interval.

/// What is assumed while there are too few passes to tell: between independent samples and the 1.3 to 1.5 that are
/// usual for edges and soft shadows.
const EARLY: Law = Law(1.2);

/// V(n)/V(1) by all laws that fit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fits {
    least: f64,
    most: f64,
    /// At which it will fall.
    pub rate: f64,
}

impl Fits {
    /// To the last change of the mean over V(1), and to the one before; the first `part` of the passes are full.
    pub fn of([last, before]: [f64; 2], part: u32, passes: u32) -> Fits {
        if part < 2 {
            let early = EARLY.of(1, passes);
            return Fits { least: early, most: early, rate: EARLY.0 };
        }
        let change = last + before;
        let mixed = Mixed::of_change(change, part, passes);
        let (mut values, mut rates) = (vec![mixed.of(part, passes)], vec![mixed.rate(passes)]);
        let mut add = |law: Law, value: f64| {
            values.push(value);
            rates.push(law.0);
        };
        // Of fewer than eight passes the change hardly tells one rate from another.
        let power = if part < 4 { Some(EARLY) } else { Law::of_change(change, part, passes) };
        if let Some(power) = power {
            add(power, power.of(part, passes));
        }
        if part >= 4 && passes == 2 * part && last > 0.0 {
            let local = Law(libm::log2(before / last).clamp(LOCAL[0], LOCAL[1]));
            add(local, last / (libm::exp2(local.0) - 1.0));
        }
        Fits {
            least: values.iter().copied().fold(f64::INFINITY, f64::min),
            most: values.iter().copied().fold(0.0, f64::max),
            rate: rates.iter().sum::<f64>() / rates.len() as f64,
        }
    }

    pub fn middle(self) -> f64 {
        (self.least * self.most).sqrt()
    }

    /// The logarithm of the factor between the root of the middle and those of the ends.
    pub fn doubt(self) -> f64 {
        if self.least > 0.0 { 0.25 * libm::log(self.most / self.least) } else { 0.0 }
    }
}

/// Rates that the last two changes are believed to show.
const LOCAL: [f64; 2] = [1.0, 2.0];

/// Of samples that are well distributed over parts of a power of two, at a rate.
#[derive(Clone, Copy, Debug)]
struct Law(f64);

/// Rates that are believed of samples that are well distributed: from a little worse than independent ones to
/// those of smooth things in one dimension.
const RATES: [f64; 2] = [0.8, 3.0];

impl Law {
    /// The rate that makes this change, which falls as the rate rises. `None` where none does.
    fn of_change(change: f64, part: u32, passes: u32) -> Option<Law> {
        let [mut low, mut high] = RATES;
        if change > Law(low).change(part, passes) {
            return None;
        }
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if Law(middle).change(part, passes) > change { low = middle } else { high = middle }
        }
        Some(Law(0.5 * (low + high)))
    }

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

/// The share that falls as if passes were independent; the rest falls as n⁻².
#[derive(Clone, Copy, Debug)]
struct Mixed(f64);

const SLOW: Law = Law(1.0);
const FAST: Law = Law(2.0);

impl Mixed {
    /// The share that makes this change.
    fn of_change(change: f64, part: u32, passes: u32) -> Mixed {
        let [slow, fast] = [SLOW, FAST].map(|law| law.change(part, passes));
        let share = (change - fast) / (slow - fast);
        Mixed(if share.is_nan() { 1.0 } else { share.clamp(0.0, 1.0) })
    }

    /// As [`Law::of`].
    fn of(self, part: u32, passes: u32) -> f64 {
        self.0 * SLOW.of(part, passes) + (1.0 - self.0) * FAST.of(part, passes)
    }

    /// At which it falls beyond so many passes.
    fn rate(self, passes: u32) -> f64 {
        let [slow, fast] = [self.0 * SLOW.full(passes), (1.0 - self.0) * FAST.full(passes)];
        (SLOW.0 * slow + FAST.0 * fast) / (slow + fast)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both laws find themselves from their own change, for full parts and those that are not.
    #[test]
    fn laws_are_found_from_their_change() {
        for (part, passes) in [(4, 8), (4, 6), (16, 32), (64, 100)] {
            for rate in [0.9, 1.3, 2.0] {
                let found = Law::of_change(Law(rate).change(part, passes), part, passes);
                let found = found.expect("a rate within the range");
                assert!((found.0 - rate).abs() < 1e-6, "{part} of {passes}: {found:?}");
            }
            for share in [0.0, 0.3, 1.0] {
                let [slow, fast] = [SLOW, FAST].map(|law| law.change(part, passes));
                let found = Mixed::of_change(share * slow + (1.0 - share) * fast, part, passes);
                assert!((found.0 - share).abs() < 1e-9, "{part} of {passes}: {found:?}");
                let expected = share / f64::from(passes) + (1.0 - share) / f64::from(passes).powi(2);
                assert!(!passes.is_power_of_two() || (found.of(part, passes) - expected).abs() < 1e-12);
            }
        }
    }

    /// Edges whose first passes are worse than the rate that they come to: the last two changes tell.
    #[test]
    fn a_bad_start_is_not_held_against_what_follows() {
        // V(2), V(4), V(8) and V(16) at the rate 1.43 from V(2) = 0.57 on.
        let v = |n: f64| 0.57 * (n / 2.0).powf(-1.43);
        let fits = Fits::of([v(4.0) - v(8.0), v(2.0) - v(4.0)], 4, 8);
        assert!((fits.least / v(8.0) - 1.0).abs() < 1e-9 && fits.most < 2.0 * v(8.0), "{fits:?} {}", v(8.0));
    }

    /// A lens with depth of field, measured: V(1), V(4), V(16) and V(64) are as 1306, 207, 41 and 9.7; and edges alone,
    /// at the rate 1.37. Each lies between the two laws that are fitted to its change.
    #[test]
    fn the_truth_lies_between_the_laws() {
        let edges = |n: f64| n.powf(-1.37);
        let measured = [
            (16, [1306.0, 207.0, 41.0]),
            (64, [1306.0, 41.0, 9.73]),
            (16, [1.0, edges(4.0), edges(16.0)]),
            (64, [1.0, edges(16.0), edges(64.0)]),
        ];
        for (n, [first, before, now]) in measured {
            let change = (before - now) / first;
            let a = Law::of_change(change, n / 2, n).expect("a rate").of(n / 2, n);
            let b = Mixed::of_change(change, n / 2, n).of(n / 2, n);
            assert!(a * 0.999 < now / first && now / first < b * 1.001, "{n}: {a} {} {b}", now / first);
        }
    }
}
