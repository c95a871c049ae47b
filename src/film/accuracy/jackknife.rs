//! How much an estimate hangs on a part of what it was made of.

/// The standard error of an estimate, from what it is without each of its groups (Efron & Stein 1981); 0 of
/// fewer than two.
pub(super) fn jackknife(without: &[f64]) -> f64 {
    let n = (without.len() as f64).max(1.0);
    let mean = without.iter().sum::<f64>() / n;
    let squares: f64 = without.iter().map(|one| (one - mean) * (one - mean)).sum();
    (squares * (n - 1.0) / n).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a mean it is s/√n: 1, 2, 3, 6 have s² = 14/3, and without each of them the mean is 11/3, 10/3, 3, 2.
    #[test]
    fn of_a_mean_it_is_its_standard_error() {
        let found = jackknife(&[11.0 / 3.0, 10.0 / 3.0, 3.0, 2.0]);
        assert!((found - f64::sqrt(14.0 / 3.0 / 4.0)).abs() < 1e-12, "{found}");
        assert_eq!((jackknife(&[]), jackknife(&[5.0])), (0.0, 0.0));
    }
}
