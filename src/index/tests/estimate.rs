//! The density estimate where the answer is known.

use super::*;
use crate::math::Color;
use crate::scatter::Photon;
use std::f64::consts::PI;

const KERNELS: [Kernel; 3] = [Kernel::Disc, Kernel::Cone { kappa: 1.1 }, Kernel::Epanechnikov];

fn irradiance(map: &PhotonMap, p: Vec3, radius: Radius, kernel: Kernel) -> Gathered {
    map.gather(&Query { p, n: Vec3::Y, radius }, kernel, |_| Color::ONE)
}

/// A map in which the estimate at its centre is one lookup of a uniform field: Poisson many photons
/// on a disc with `mean` of them expected within the unit radius.
struct Field {
    random: Counter,
    mean: f64,
}

impl Field {
    /// Photons on the disc of this radius, by exponential steps of area.
    fn photons(&mut self, radius: f64) -> Vec<Photon> {
        let (mut area, mut photons) = (0.0, Vec::new());
        loop {
            area -= libm::log(1.0 - self.random.value()) / self.mean;
            if area > radius * radius {
                return photons;
            }
            let (r, phi) = (area.sqrt(), 2.0 * PI * self.random.value());
            let at = Vec3::new((r * libm::cos(phi)) as f32, 0.0, (r * libm::sin(phi)) as f32);
            photons.push(photon(at, Vec3::Y));
        }
    }
}

/// Mean and standard deviation of estimate over truth.
fn statistics(estimates: impl Iterator<Item = f64>) -> (f64, f64) {
    let (mut n, mut sum, mut square) = (0.0, 0.0, 0.0);
    for e in estimates {
        n += 1.0;
        sum += e;
        square += e * e;
    }
    let mean = sum / n;
    (mean, (square / n - mean * mean).sqrt())
}

/// Every kernel and every way to find the radius, few photons and many: the mean is within five
/// standard errors of the truth, and those are small enough to see the k-th photon's weight.
#[test]
fn no_kernel_radius_floor_or_ceiling_adds_bias_in_an_even_field() {
    let radii = [
        ("k-th", Radius::Nearest { k: 10, min: 0.0, max: 100.0 }),
        ("floor in force at times", Radius::Nearest { k: 10, min: 1.0, max: 100.0 }),
        ("ceiling in force at times", Radius::Nearest { k: 10, min: 0.0, max: 1.0 }),
        ("both", Radius::Nearest { k: 10, min: 0.9, max: 1.1 }),
        ("fixed", Radius::Fixed(1.0)),
        ("two", Radius::Nearest { k: 2, min: 0.3, max: 100.0 }),
    ];
    let mut field = Field { random: counter(9), mean: 10.0 };
    let maps: Vec<PhotonMap> = (0..12_000).map(|_| PhotonMap::new(field.photons(3.0))).collect();
    for (name, radius) in radii {
        for kernel in KERNELS {
            let estimates = maps
                .iter()
                .map(|map| f64::from(irradiance(map, Vec3::ZERO, radius, kernel).radiance.x) * PI / 10.0);
            let (mean, sd) = statistics(estimates);
            let error = sd / (maps.len() as f64).sqrt();
            assert!(error < 0.011, "{name}, {kernel:?}: standard error {error}");
            assert!((mean - 1.0).abs() < 5.0 * error, "{name}, {kernel:?}: {mean} ± {error}");
        }
    }
}

/// The radiance is the BRDF times the power of each direction, not of their mean.
#[test]
fn each_photon_is_weighed_by_the_brdf_of_its_direction() {
    let mut photons = vec![photon(Vec3::ZERO, Vec3::Y); 2];
    photons[0].wi = Vec3::new(0.6, 0.8, 0.0);
    photons[0].power = Vec3::new(1.0, 2.0, 4.0);
    photons[1].wi = Vec3::new(-0.8, 0.6, 0.0);
    let query = Query { p: Vec3::ZERO, n: Vec3::Y, radius: Radius::Fixed(2.0) };
    let gathered =
        PhotonMap::new(photons).gather(&query, Kernel::Disc, |wi| Color::splat(wi.y * wi.x.max(0.0)));
    let expected = Color::new(1.0, 2.0, 4.0) * (0.48 / (4.0 * std::f32::consts::PI));
    assert!((gathered.radiance - expected).length() < 1e-4 * expected.length());
}

/// The first radius of a pass, from a pilot of a tenth of its photons, is √(k/πλ) of its map.
#[test]
fn the_pilot_knows_the_k_th_distance_of_the_map() {
    let (count, k) = (20_000.0, 50.0);
    let expected = (k / (PI * count)).sqrt();
    // r² is Gamma-distributed; four standard errors of its mean, from twenty pilots. Of few pilot photons the
    // nearest one to a point is one that stands alone more often than not: up to a sixth more.
    for (pilot, bound) in [(20_000, 0.02), (2000, 0.04), (200, 0.13 + 1.0 / 6.0)] {
        let mut random = counter(7);
        let mut squares = Vec::new();
        for item in 0..20 {
            let bandwidth = Bandwidth::new(floor(pilot, 30 + item), count, k, 1e-4, 0.5);
            for _ in 0..50 {
                let [x, z] = random.pair().map(|u| (0.25 + 0.5 * u) as f32);
                squares.push(f64::from(bandwidth.radius(Vec3::new(x, 0.0, z), Vec3::Y)).powi(2));
            }
        }
        let (mean, _) = statistics(squares.into_iter());
        let off = mean / (expected * expected) - 1.0;
        assert!(off.abs() < bound, "pilot of {pilot}: {off}");
    }
    let (min, max) = (0.01, 0.02);
    let at = |pilot: Vec<Photon>| Bandwidth::new(pilot, 1e4, 50.0, min, max).radius(Vec3::ZERO, Vec3::Y);
    assert_eq!(at(vec![]), max);
    assert_eq!(at(floor(100, 8)), max);
    assert_eq!(at(vec![photon(Vec3::ZERO, Vec3::Y); 1000]), min);
}
