//! How noise falls with passes whose samples are well distributed over them.

/// V(n)/V(1) of samples that are well distributed over parts of a power of two, at a rate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Law(pub f64);

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
    pub fn of(self, part: u32, passes: u32) -> f64 {
        if passes == 2 * part { self.full(passes) } else { self.any(passes) }
    }

    /// The squared change of the mean since half of the first part, in its two steps together.
    pub fn change(self, part: u32, passes: u32) -> f64 {
        let before = self.full(part / 2) - self.full(part);
        let late = passes - part;
        if late == part {
            return before + self.full(part) - self.full(passes);
        }
        let share = f64::from(late) / f64::from(passes);
        before + share * share * (self.full(part) + if late > 0 { self.any(late) } else { 0.0 })
    }
}
