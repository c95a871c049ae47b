//! Warps against their densities.

use super::*;
use crate::math::random::{Counter, Stage};

/// χ² of points that should be uniform on [0, 1)², in 16 × 16 cells. With 255 degrees of freedom it
/// stays below 347 with probability 1 − 1e-4.
fn chi_square(points: impl Iterator<Item = [f64; 2]>) -> f64 {
    let mut counts = [0.0; 256];
    let mut n = 0.0;
    for [x, y] in points {
        assert!((0.0..=1.0).contains(&x) && (0.0..=1.0).contains(&y), "({x}, {y})");
        let cell = |v: f64| ((v * 16.0) as usize).min(15);
        counts[cell(x) * 16 + cell(y)] += 1.0;
        n += 1.0;
    }
    counts.iter().map(|c| (c - n / 256.0) * (c - n / 256.0) / (n / 256.0)).sum()
}

fn values(item: u64) -> impl Iterator<Item = [f64; 2]> {
    let mut counter = Counter::new(11, Stage::Test, item);
    (0..100_000).map(move |_| counter.pair())
}

fn turn(x: f64, y: f64) -> f64 {
    libm::atan2(y, x) / TAU + 0.5
}

/// Sends the warped points through their own distribution functions, written down independently.
#[test]
fn warped_points_are_distributed_as_their_densities_say() {
    let uniform: [(&str, f64); 7] = [
        ("disk", chi_square(values(0).map(disk).map(|d| [d.length_squared(), turn(d.x, d.y)]))),
        ("cosine", chi_square(values(1).map(cosine_hemisphere).map(|d| [1.0 - d.z * d.z, turn(d.x, d.y)]))),
        ("sphere", chi_square(values(2).map(sphere).map(|d| [0.5 - 0.5 * d.z, turn(d.x, d.y)]))),
        (
            "wide cone",
            chi_square(values(3).map(|u| cone(0.75, u)).map(|d| [(1.0 - d.z) / 0.5, turn(d.x, d.y)])),
        ),
        (
            // 1e-4 rad: 1 − cosθ is known from sinθ only.
            "narrow cone",
            chi_square(
                values(4).map(|u| cone(1e-8, u)).map(|d| [(d.x * d.x + d.y * d.y) / 1e-8, turn(d.x, d.y)]),
            ),
        ),
        (
            "triangle",
            chi_square(values(5).map(triangle).map(|[b0, b1, _]| [(1.0 - b0) * (1.0 - b0), b1 / (1.0 - b0)])),
        ),
        (
            "lobe",
            chi_square(
                values(6).map(|u| phong_lobe(30.0, u)).map(|d| [libm::pow(d.z, 31.0), turn(d.x, d.y)]),
            ),
        ),
    ];
    for (name, chi2) in uniform {
        assert!(chi2 < 347.0, "{name}: χ² = {chi2}");
    }
}

/// |∂x/∂u₀ × ∂x/∂u₁| by central differences.
fn jacobian(warp: impl Fn([f64; 2]) -> DVec3, u: [f64; 2]) -> f64 {
    let h = 1e-6;
    let across = (warp([u[0] + h, u[1]]) - warp([u[0] - h, u[1]])) / (2.0 * h);
    let along = (warp([u[0], u[1] + h]) - warp([u[0], u[1] - h])) / (2.0 * h);
    across.cross(along).length()
}

#[test]
fn density_is_the_reciprocal_of_the_jacobian() {
    let mut counter = Counter::new(12, Stage::Test, 0);
    for _ in 0..2000 {
        let u = counter.pair().map(|v| 0.02 + 0.96 * v);
        // Where the concentric map and the triangle's have a crease, differences mean nothing.
        if (u[0] - u[1]).abs() < 1e-4 || (u[0] + u[1] - 1.0).abs() < 1e-4 {
            continue;
        }
        let cosine = cosine_hemisphere_pdf(cosine_hemisphere(u).z);
        let b = |u| DVec3::from(triangle(u));
        let area = 0.5 * 3f64.sqrt();
        let products = [
            ("disk", DISK_PDF * jacobian(|u| disk(u).extend(0.0), u)),
            ("cosine", cosine * jacobian(cosine_hemisphere, u)),
            ("sphere", SPHERE_PDF * jacobian(sphere, u)),
            ("wide cone", cone_pdf(0.9) * jacobian(|u| cone(0.9, u), u)),
            ("narrow cone", cone_pdf(1e-8) * jacobian(|u| cone(1e-8, u), u)),
            ("triangle", jacobian(b, u) / area),
            ("lobe", phong_lobe_pdf(30.0, phong_lobe(30.0, u).z) * jacobian(|u| phong_lobe(30.0, u), u)),
            ("flat lobe", phong_lobe_pdf(0.0, phong_lobe(0.0, u).z) * jacobian(|u| phong_lobe(0.0, u), u)),
        ];
        for (name, product) in products {
            assert!((product - 1.0).abs() < 1e-5, "{name} at {u:?}: {product}");
        }
    }
}

#[test]
fn directions_are_of_unit_length_to_the_corners_of_the_square() {
    let ends = [0.0, 1e-300, 1e-9, 0.5, 1.0f64.next_down()];
    for u in ends.into_iter().flat_map(|a| ends.map(|b| [a, b])) {
        let narrow = [0.0, 1e-300, 1e-16, 1e-8, 1.0].map(|sin2| cone(sin2, u));
        let lobes = [0.0, 1.0, 1e3, 1e9].map(|n| phong_lobe(n, u));
        for d in [cosine_hemisphere(u), sphere(u)].into_iter().chain(narrow).chain(lobes) {
            assert!((d.length() - 1.0).abs() < 1e-12, "{u:?}: {d}");
        }
        assert!(disk(u).length() <= 1.0 + 1e-15);
    }
}

/// 1 − cosθ against its series, from 1 rad down to 1e-8.
#[test]
fn solid_angle_of_a_cone_keeps_full_accuracy_when_narrow() {
    for exponent in 0..=8 {
        let theta = libm::pow(10.0, -f64::from(exponent));
        let sin = libm::sin(theta);
        let half = libm::sin(0.5 * theta);
        let exact = 2.0 * half * half;
        assert!((one_minus_cos(sin * sin) / exact - 1.0).abs() < 4e-16 * 4.0, "θ = {theta}");
    }
    assert_eq!(one_minus_cos(0.0), 0.0);
    assert_eq!(one_minus_cos(1.0), 1.0);
}

/// Narrow lobes: the mean of 1 − cosθ is 1/(n+2).
#[test]
fn sharp_lobes_do_not_lose_their_width_to_rounding() {
    for exponent in [1e2, 1e6, 1e12] {
        let mean_sin2: f64 =
            values(7).map(|u| phong_lobe(exponent, u)).map(|d| d.x * d.x + d.y * d.y).sum::<f64>() / 1e5;
        // ⟨sin²θ⟩ = 2/(n+3); its standard deviation is about as large.
        assert!((mean_sin2 * (exponent + 3.0) / 2.0 - 1.0).abs() < 5.0 / 1e5f64.sqrt(), "n = {exponent}");
    }
}

#[test]
fn discrete_choices_have_their_weights_and_never_weight_zero() {
    let weights = [0.0, 3.0, 0.0, 0.0, 1e-3, 5.0, f64::NAN, -2.0, 1.5, 0.0];
    let sum: f64 = 3.0 + 1e-3 + 5.0 + 1.5;
    let cdf = Cdf::new(&weights).expect("positive weights");
    let alias = AliasTable::new(&weights).expect("positive weights");
    let choosers: [&dyn Fn(f64) -> Choice; 3] =
        [&|u| cdf.choose(u), &|u| alias.choose(u), &|u| pick(&weights, u).expect("positive weights")];
    for choose in choosers {
        let mut counts = [0.0; 10];
        let ends = [0.0, 1e-300, 0.5, 1.0f64.next_down()];
        for u in ends.into_iter().chain(values(8).map(|u| u[0])) {
            let choice = choose(u);
            assert!(weights[choice.index] > 0.0, "{choice:?}");
            assert!((choice.pmf - weights[choice.index] / sum).abs() < 1e-15);
            assert!((0.0..1.0).contains(&choice.u));
            counts[choice.index] += 1.0;
        }
        for (count, w) in counts.iter().zip(weights).filter(|(_, w)| *w > 0.0) {
            let expected = 1e5 * w / sum;
            assert!((count - expected).abs() < 5.0 * expected.sqrt() + 4.0, "{count} for {expected}");
        }
        // What is left of u is uniform again.
        let chi2 = chi_square(values(9).map(|u| [choose(u[0]).u, u[1]]));
        assert!(chi2 < 347.0, "χ² = {chi2}");
    }
    assert!((0..10).all(|i| (cdf.pmf(i) - alias.pmf(i)).abs() < 1e-15));
}

#[test]
fn there_is_no_choice_among_nothing() {
    for weights in [&[][..], &[0.0, 0.0], &[f64::NAN], &[-1.0, f64::INFINITY]] {
        assert_eq!(Cdf::new(weights), None);
        assert_eq!(AliasTable::new(weights), None);
        assert_eq!(pick(weights, 0.5), None);
    }
}

#[test]
fn weights_near_the_ends_of_the_range_neither_overflow_nor_vanish() {
    for w in [f64::MIN_POSITIVE, 1e-320, 1e308] {
        let weights = [w, 0.0, w, w];
        assert!((Cdf::new(&weights).expect("positive").pmf(2) - 1.0 / 3.0).abs() < 1e-3, "{w}");
        assert!((AliasTable::new(&weights).expect("positive").pmf(2) - 1.0 / 3.0).abs() < 1e-3, "{w}");
    }
}

#[test]
fn large_alias_tables_agree_with_their_weights() {
    let mut counter = Counter::new(13, Stage::Test, 0);
    let weights: Vec<f64> =
        (0..1000).map(|i| if i % 7 == 0 { 0.0 } else { counter.value().powi(4) }).collect();
    let table = AliasTable::new(&weights).expect("positive");
    // The probabilities that the columns really give, summed.
    let mut given = vec![0.0; weights.len()];
    for (i, column) in table.columns.iter().enumerate() {
        given[i] += column.own / 1000.0;
        given[column.alias as usize] += (1.0 - column.own) / 1000.0;
    }
    for (i, g) in given.iter().enumerate() {
        assert!((g - table.pmf(i)).abs() < 1e-14);
        assert!(weights[i] > 0.0 || *g == 0.0);
    }
}

#[test]
fn four_points_of_the_disk_are_those_that_one_by_one_would_be() {
    use crate::math::lanes::{Lanes, Machine, Work};

    struct Disks<'a>(&'a [[f64; 2]; 4]);

    impl Work for Disks<'_> {
        type Output = [[f64; 4]; 2];

        #[inline(always)]
        fn run<L: Lanes>(self, l: L) -> [[f64; 4]; 2] {
            let l = l.doubles();
            let [a, b, c, d] = self.0;
            let [x, y] = disk_four(
                l,
                [Wide::of(l, &[a[0], b[0], c[0], d[0]]), Wide::of(l, &[a[1], b[1], c[1], d[1]])],
            );
            [x.to_array(), y.to_array()]
        }
    }

    let edges = [0.0, 0.25, 0.5, 0.75, 1.0 - f64::EPSILON];
    let mut points: Vec<[f64; 2]> = edges.iter().flat_map(|&x| edges.map(|y| [x, y])).collect();
    points.extend(values(9).take(10_000));
    for four in points.chunks_exact(4) {
        let four = [four[0], four[1], four[2], four[3]];
        let [best, plain] = [Machine::detect(), Machine::portable()].map(|m| m.run(Disks(&four)));
        assert_eq!(best, plain);
        for (i, u) in four.into_iter().enumerate() {
            let apart = disk(u).distance(DVec2::new(best[0][i], best[1][i]));
            assert!(apart < 4e-16, "{u:?}: {apart}");
        }
    }
}
