//! The map holds every photon, finds what a look at each finds (where normals differ), and is the same for any number of
//! threads.

use super::*;
use crate::math::Color;
use crate::scatter::Photon;

fn random_vec(random: &mut Counter) -> Vec3 {
    Vec3::from_array([(); 3].map(|()| random.value() as f32))
}

/// Photons of every arrangement that has broken trees: in space, on a floor, on a line, on a few
/// points, on one point, in clusters of very different density, and far from the origin.
fn arrangements(count: usize) -> Vec<(&'static str, Vec<Photon>)> {
    let mut random = counter(count as u64);
    let mut make = |at: &dyn Fn(Vec3) -> Vec3| -> Vec<Photon> {
        (0..count).map(|_| photon(at(random_vec(&mut random)), Vec3::Y)).collect()
    };
    vec![
        ("in space", make(&|u| u)),
        ("coplanar", make(&|u| Vec3::new(u.x, 0.3, u.z))),
        ("collinear", make(&|u| Vec3::new(0.2, 0.3, u.z))),
        ("collinear and oblique", make(&|u| Vec3::splat(u.x))),
        ("on few points", make(&|u| (u * 3.0).floor())),
        ("identical", make(&|_| Vec3::splat(0.7))),
        ("clustered", make(&|u| u * u.x.powi(12))),
        ("far away", make(&|u| u + Vec3::splat(4096.0))),
    ]
}

/// e² by its definition.
fn distance_squared(photon: &Photon, p: Vec3, n: Vec3) -> Option<f32> {
    if photon.normal.dot(n) <= 0.5 {
        return None;
    }
    let d = photon.position - p;
    let h = d.dot((photon.normal + n) * 0.5);
    Some(d.x * d.x + d.y * d.y + d.z * d.z + 63.0 * (h * h))
}

fn brute_force(photons: &[Photon], p: Vec3, n: Vec3) -> Vec<f32> {
    let mut all: Vec<f32> = photons.iter().filter_map(|photon| distance_squared(photon, p, n)).collect();
    all.sort_by(f32::total_cmp);
    all
}

#[test]
fn a_bound_on_k_nearest_only_forgets_what_is_beyond_it() {
    let photons = floor(2000, 0);
    let map = PhotonMap::new(photons.clone());
    let p = Vec3::new(0.4, 0.0, 0.6);
    let all = brute_force(&photons, p, Vec3::Y);
    let twentieth = all[19].sqrt();
    assert_eq!(map.nearest_radius(p, Vec3::Y, 20, twentieth * 1.001), Some(twentieth));
    assert_eq!(map.nearest_radius(p, Vec3::Y, 20, twentieth * 0.999), None);
}

/// A smooth sphere: no two photons have one normal, and those beyond 60° do not count.
#[test]
fn k_nearest_with_many_normals_is_what_a_look_at_every_photon_finds() {
    let mut random = counter(3);
    let mut direction = || loop {
        let v = random_vec(&mut random) * 2.0 - 1.0;
        if v.length() < 1.0 && v.length() > 0.1 {
            return v.normalize();
        }
    };
    let photons: Vec<Photon> = (0..5000).map(|_| direction()).map(|n| photon(n, n)).collect();
    let map = PhotonMap::new(photons.clone());
    for _ in 0..50 {
        let n = direction();
        let all = brute_force(&photons, n, n);
        for k in [1, 10, 100] {
            // the map's normals are off by up to 7e-5
            let (found, expected) = (map.nearest_radius(n, n, k, 2.0), all[k - 1].sqrt());
            let off = found.map_or(f32::INFINITY, |found| found / expected - 1.0);
            assert!(off.abs() < 1e-4, "k = {k}: off by {off}");
        }
    }
}

#[test]
fn photons_that_are_not_finite_are_refused_and_counted() {
    let good = photon(Vec3::ZERO, Vec3::Y);
    let mut photons = vec![good; 3];
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let bad = Vec3::new(0.0, bad, 0.0);
        photons.push(Photon { position: bad, ..good });
        photons.push(Photon { wi: bad, ..good });
        photons.push(Photon { normal: bad, ..good });
        photons.push(Photon { power: bad, ..good });
    }
    photons.push(Photon { power: Vec3::new(1.0, -1.0, 1.0), ..good });
    let map = PhotonMap::new(photons);
    assert_eq!((map.len(), map.refused()), (3, 13));
    let query = Query { p: Vec3::ZERO, n: Vec3::Y, radius: Radius::Fixed(1.0) };
    let gathered = map.gather(&query, Kernel::Disc, |_| Color::ONE);
    assert!((gathered.radiance - Color::splat(3.0 / std::f32::consts::PI)).length() < 1e-4);
    for p in [Vec3::NAN, Vec3::INFINITY] {
        let gathered = map.gather(&Query { p, ..query }, Kernel::Disc, |_| Color::ONE);
        assert_eq!(gathered.radiance, Color::ZERO);
    }
}

#[test]
fn any_number_of_threads_builds_the_same_map() {
    let photons = floor(60_000, 4);
    let build = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| PhotonMap::new(photons.clone()))
    };
    let one = build(1);
    for threads in [2, 5] {
        let other = build(threads);
        let bits = |map: &PhotonMap| -> Vec<u32> {
            map.positions.iter().flat_map(|p| [p.x, p.z]).flatten().flatten().map(f32::to_bits).collect()
        };
        assert!(bits(&one) == bits(&other), "positions, {threads} threads");
        assert!(one.packed == other.packed, "the rest, {threads} threads");
    }
}

#[test]
fn a_photon_takes_32_bytes_at_most() {
    for count in [1000, 30_000, 33_000, 50_000] {
        for (name, photons) in arrangements(count) {
            let bytes = PhotonMap::new(photons).memory_bytes();
            assert!(bytes <= 32 * count, "{count} photons {name}: {bytes} bytes");
        }
    }
}
