//! Curves that are known, and those of scenes, against what is told of them.

use super::*;

/// What is seen of a curve, over the variance from pass to pass.
fn seen(v: impl Fn(u32) -> f64, n: u32) -> Fits {
    let variance = (v(1) - v(n)) * f64::from(n) / f64::from(n - 1);
    let before = if n > 2 { v(n / 4) - v(n / 2) } else { 0.0 };
    Fits::of([(v(n / 2) - v(n)) / variance, before / variance], n / 2, n)
}

/// A curve of one rate is found by the local and by the overall rate.
#[test]
fn rates_are_found() {
    for rate in [1.1, 1.4, 1.9] {
        for n in [16u32, 64] {
            let v = |n: u32| f64::from(n).powf(-rate);
            let scatter = (v(1) - v(n)) * f64::from(n) / f64::from(n - 1);
            let [last, before] = [v(n / 2) - v(n), v(n / 4) - v(n / 2)].map(|change| change / scatter);
            let seen = Seen { last, before, part: n / 2, passes: n };
            let found = [seen.local(), seen.overall()].map(|rate| rate.expect("enough passes"));
            assert!(found.iter().all(|found| (found - rate).abs() < 1e-6), "{rate} {n}: {found:?}");
            assert!((seen.noise(rate) * scatter / v(n) - 1.0).abs() < 1e-9);
        }
    }
}

/// Of passes that are no power of two: the rates are found, and the noise lies between that of the next power
/// of two and that of parts that are independent.
#[test]
fn rates_are_found_between_powers_of_two() {
    for (part, passes) in [(4, 6), (16, 24), (64, 100)] {
        for rate in [1.1, 1.4, 1.9] {
            let v = |n: u32| f64::from(n).powf(-rate);
            let late = passes - part;
            let share = f64::from(late) / f64::from(passes);
            let last = share * share * (v(part) + v(late));
            // 1 instead of the scatter of parts whose dependence is not known.
            let seen = Seen { last, before: v(part / 2) - v(part), part, passes };
            let found = seen.local().expect("enough passes");
            assert!((found - rate).abs() < 1e-6, "{part} of {passes}, {rate}: {found}");
            let noise = seen.noise(rate);
            assert!(v(2 * part) < noise && noise < v(part) * independent(passes, part, rate));
        }
    }
}

/// V(1) to V(64) at powers of two, over V(1), without caustics and indirect light; means of 4 to 16 seeds.
const MEASURED: [(&str, [f64; 7]); 7] = [
    ("primitives, 256 × 192", [1.0, 0.2884, 0.08974, 0.02762, 0.009311, 0.003231, 0.001143]),
    ("antialiasing, 192 × 108", [1.0, 0.2881, 0.09486, 0.03486, 0.01325, 0.005112, 0.001834]),
    ("soft_shadows, 160 × 90", [1.0, 0.4676, 0.1702, 0.05093, 0.01635, 0.005722, 0.002309]),
    ("reflection, 128 × 72", [1.0, 0.4186, 0.1719, 0.06131, 0.0264, 0.0107, 0.00393]),
    ("depth_of_field, 96 × 64", [1.0, 0.3661, 0.1469, 0.06533, 0.02952, 0.01453, 0.007007]),
    ("textures, 96 × 54", [1.0, 0.3674, 0.1361, 0.04299, 0.01594, 0.006352, 0.002727]),
    ("shadows, 128 × 72", [1.0, 0.3552, 0.1181, 0.04106, 0.01795, 0.008104, 0.00391]),
];

/// Curves that were measured lie within the interval of what they show of themselves, all but one in twenty.
#[test]
fn measured_curves_lie_within_the_interval() {
    let mut outside = Vec::new();
    for (scene, curve) in MEASURED {
        for power in 1..curve.len() {
            let n = 1 << power;
            let fits = seen(|n| curve[n.ilog2() as usize], n);
            let variance = (1.0 - curve[power]) * f64::from(n) / f64::from(n - 1);
            let off = 0.5 * (fits.middle() * variance / curve[power]).ln();
            let half = (super::super::BESIDE * fits.doubt()).hypot(beyond(n));
            if off.abs() > half {
                outside.push(format!("{scene}, {n} passes: e^{off:.2} of e^{half:.2}"));
            }
        }
    }
    assert!(outside.len() * 20 <= MEASURED.len() * 6, "{outside:#?}");
}

/// Photons that are independent, in pixels whose places are well distributed: within a tenth of it, for any
/// number of passes.
#[test]
fn noise_of_photons_is_found() {
    for (part, passes) in [(2, 3), (4, 6), (4, 8), (16, 17), (16, 32), (64, 100)] {
        for share in [1.0, 0.8, 0.6] {
            let v = |n: u32| {
                let n = f64::from(n);
                share / n + (1.0 - share) / (n * n)
            };
            let late = passes - part;
            let apart = f64::from(late) / f64::from(passes);
            let last =
                if passes == 2 * part { v(part) - v(passes) } else { apart * apart * (v(part) + v(late)) };
            // 1 instead of the scatter.
            let found = Fits::of_photons([last, v(part / 2) - v(part)], part, passes);
            let off = 0.5 * (found.middle() / v(passes)).ln();
            assert!(off.abs() < 0.1 + 0.6 * (1.0 - share) / f64::from(part), "{passes}, {share}: e^{off:.3}");
            assert!(share < 1.0 || off.abs() < 1e-9);
        }
    }
}

/// Light that was first found after the first part, in one pass: its square is stated; of photons less, as the first
/// part counts too, which had none.
#[test]
fn late_light_is_told_of() {
    for (part, passes) in [(4, 5), (4, 6), (16, 20)] {
        // 1 in one pass, 0 in all others: the squared change and V are 1/n², the scatter is 1/n.
        let n = f64::from(passes);
        for fits in [Fits::of([1.0 / n, 0.0], part, passes), Fits::of_photons([1.0 / n, 0.0], part, passes)] {
            let off = 0.5 * (fits.middle() * n).ln();
            assert!((-0.21..0.01).contains(&off), "{passes}: e^{off:.2} {fits:?}");
        }
    }
}

/// Changes that are 0 tell of little noise, not of none.
#[test]
fn no_change_is_no_proof() {
    for n in [2, 3, 8, 100] {
        let fits = Fits::of([0.0, 0.0], if n == 2 { 1 } else { 2 }, n);
        assert!(fits.middle() > 0.0 && fits.doubt().is_finite(), "{n}: {fits:?}");
    }
}
