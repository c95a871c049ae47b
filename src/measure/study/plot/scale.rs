//! A logarithmic axis: values to places, and round values to label it with.

/// From values to places along one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// Logarithms (base 10) of the values at both ends.
    pub logs: [f64; 2],
    /// Places of the ends.
    pub places: [f64; 2],
}

impl Scale {
    /// An axis that holds these values, all above 0, with some room, and at least half a decade long.
    pub fn of(values: impl IntoIterator<Item = f64>, places: [f64; 2]) -> Scale {
        let logs = values.into_iter().filter(|v| *v > 0.0 && v.is_finite()).map(libm::log10);
        let [low, high] = logs.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)]);
        let [low, high] = if low <= high { [low, high] } else { [-0.5, 0.5] };
        let room = (0.06 * (high - low)).max(0.25 - 0.5 * (high - low)).max(0.04);
        Scale { logs: [low - room, high + room], places }
    }

    /// The place of a value above 0.
    pub fn place(&self, value: f64) -> f64 {
        let share = (libm::log10(value) - self.logs[0]) / (self.logs[1] - self.logs[0]);
        self.places[0] + share * (self.places[1] - self.places[0])
    }

    /// Round values within the axis: 1, 2 and 5 times powers of 10, or powers alone where those are many.
    pub fn ticks(&self) -> Vec<f64> {
        let [low, high] = self.logs;
        let steps: &[f64] = match high - low {
            decades if decades > 5.0 => &[1.0],
            decades if decades > 3.5 => &[1.0, 3.0],
            _ => &[1.0, 2.0, 5.0],
        };
        let powers = libm::floor(low) as i32..=libm::ceil(high) as i32;
        let values = powers.flat_map(|power| {
            // a decimal literal's value: 2e-3 and not 2·10^-3 with its rounding
            steps.iter().filter_map(move |step| format!("{step}e{power}").parse::<f64>().ok())
        });
        values.filter(|value| (low..=high).contains(&libm::log10(*value))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decades_are_equally_long() {
        let scale = Scale { logs: [-2.0, 2.0], places: [100.0, 500.0] };
        assert_eq!(
            [0.01, 0.1, 1.0, 10.0, 100.0].map(|v| scale.place(v).round()),
            [100.0, 200.0, 300.0, 400.0, 500.0]
        );
        assert_eq!(scale.ticks(), [0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0]);
    }

    #[test]
    fn an_axis_holds_its_values_and_has_labels() {
        for values in [vec![3.0], vec![0.5, 0.5], vec![1e-4, 1e4], vec![], vec![0.0, 2.0]] {
            let scale = Scale::of(values.clone(), [0.0, 100.0]);
            for value in values.into_iter().filter(|v| *v > 0.0) {
                assert!((0.0..=100.0).contains(&scale.place(value)), "{value} in {scale:?}");
            }
            assert!(!scale.ticks().is_empty(), "{scale:?}");
        }
    }
}
