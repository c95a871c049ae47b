//! What points of time and error tell: medians, slopes on logarithmic axes, the Pareto front.

/// The median and the range, smallest first: `[median, least, most]`. `None` of nothing.
pub fn spread(values: impl IntoIterator<Item = f64>) -> Option<[f64; 3]> {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    let (first, last) = (*values.first()?, *values.last()?);
    let half = values.len() / 2;
    let median = if values.len() % 2 == 1 { values[half] } else { 0.5 * (values[half - 1] + values[half]) };
    Some([median, first, last])
}

fn has_logarithms(point: &[f64; 2]) -> bool {
    point.iter().all(|v| v.is_finite() && *v > 0.0)
}

/// The slope of ln y over ln x by least squares: p where y = c·x^p. Points with a value that is not above 0 are left
/// out. `None` of fewer than two different x.
pub fn slope(points: &[[f64; 2]]) -> Option<f64> {
    let logs: Vec<[f64; 2]> = points.iter().filter(|p| has_logarithms(p)).map(|p| p.map(libm::log)).collect();
    let n = logs.len() as f64;
    let mean = |i: usize| logs.iter().map(|p| p[i]).sum::<f64>() / n;
    let (mx, my) = (mean(0), mean(1));
    let xx: f64 = logs.iter().map(|p| (p[0] - mx) * (p[0] - mx)).sum();
    let xy: f64 = logs.iter().map(|p| (p[0] - mx) * (p[1] - my)).sum();
    let distinct = logs.iter().any(|p| Some(p[0]) != logs.first().map(|first| first[0]));
    (distinct && xx > 0.0).then(|| xy / xx)
}

/// For each point of time and error, whether no other is at least as good in both and better in one.
pub fn pareto(points: &[[f64; 2]]) -> Vec<bool> {
    let beats = |a: &[f64; 2], b: &[f64; 2]| a[0] <= b[0] && a[1] <= b[1] && a != b;
    points.iter().map(|point| !points.iter().any(|other| beats(other, point))).collect()
}

/// The x at which a line through points, straight between neighbours on logarithmic axes, has this y; `None`
/// where it never has.
pub fn reaches(points: &[[f64; 2]], y: f64) -> Option<f64> {
    let mut points: Vec<[f64; 2]> = points.iter().filter(|p| has_logarithms(p)).copied().collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let within = |pair: &&[[f64; 2]]| (pair[0][1] - y) * (pair[1][1] - y) <= 0.0;
    let pair = points.windows(2).find(within)?;
    let [a, b] = [pair[0].map(libm::log), pair[1].map(libm::log)];
    if a[1] == b[1] {
        return Some(pair[0][0]);
    }
    Some(libm::exp(a[0] + (libm::log(y) - a[1]) / (b[1] - a[1]) * (b[0] - a[0])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slope_of_a_power_law_is_its_exponent() {
        for p in [-0.5, -1.0 / 3.0, 2.0, 0.0] {
            let points: Vec<[f64; 2]> =
                (0..8).map(f64::from).map(libm::exp2).map(|n| [n, 3.0 * libm::pow(n, p)]).collect();
            let found = slope(&points).expect("a slope");
            assert!((found - p).abs() < 1e-12, "{found} instead of {p}");
        }
        assert_eq!(slope(&[[1.0, 2.0]]), None);
        assert_eq!(slope(&[[1.0, 2.0], [1.0, 3.0]]), None);
        assert_eq!(slope(&[[1.0, 2.0], [2.0, 0.0]]), None);
        assert_eq!(slope(&[]), None);
        assert_eq!(slope(&[[1.0, 4.0], [4.0, 2.0], [8.0, 0.0]]), Some(-0.5));
    }

    #[test]
    fn the_front_holds_what_nothing_beats() {
        let points = [[1.0, 9.0], [2.0, 5.0], [2.0, 6.0], [3.0, 5.0], [4.0, 1.0], [5.0, 2.0], [1.0, 9.0]];
        assert_eq!(pareto(&points), [true, true, false, false, true, false, true]);
    }

    #[test]
    fn a_line_is_read_off_between_its_points() {
        let line = [[4.0, 0.5], [1.0, 1.0], [16.0, 0.25]];
        assert!((reaches(&line, 0.5).expect("there") - 4.0).abs() < 1e-12);
        let between = reaches(&line, 0.5 / 2f64.sqrt()).expect("between");
        assert!((between - 8.0).abs() < 1e-12, "{between}");
        assert_eq!(reaches(&line, 0.1), None);
    }

    #[test]
    fn medians_of_even_numbers_lie_between() {
        assert_eq!(spread([3.0, 1.0, 2.0]), Some([2.0, 1.0, 3.0]));
        assert_eq!(spread([4.0, 1.0, 2.0, 3.0]), Some([2.5, 1.0, 4.0]));
        assert_eq!(spread([]), None);
    }
}
