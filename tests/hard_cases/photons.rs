//! The photon map: few photons, photons on one point or line, edges, walls, bias; against closed forms and
//! brute force.

use super::record::{Record, row, sized};
use crate::render::caustics::{neighbours, surfaces};
use crate::render::meshes::folder;
use std::f64::consts::{PI, TAU};
use terrarium::index::{Kernel, PhotonMap, Query, Radius};
use terrarium::math::random::{Counter, Stage};
use terrarium::math::{Color, Vec3};
use terrarium::optics::Face;
use terrarium::scatter::Photon;

const KERNELS: [Kernel; 3] = [Kernel::Disc, Kernel::Cone { kappa: 1.1 }, Kernel::Epanechnikov];

/// A photon of one watt a channel from straight above a surface.
fn photon(position: Vec3, normal: Vec3) -> Photon {
    Photon { position, wi: normal, normal, power: Vec3::ONE, face: Face::Opaque }
}

fn counter(item: u64) -> Counter {
    Counter::new(20, Stage::Test, item)
}

/// Uniform photons on [0, 1]² of the plane y = 0, seen from above.
fn floor(count: usize, item: u64) -> Vec<Photon> {
    let mut random = counter(item);
    let mut at = || {
        let [x, z] = random.pair();
        photon(Vec3::new(x as f32, 0.0, z as f32), Vec3::Y)
    };
    (0..count).map(|_| at()).collect()
}

/// The red irradiance at a point of the plane.
fn irradiance(map: &PhotonMap, p: Vec3, radius: Radius, kernel: Kernel) -> f64 {
    f64::from(map.gather(&Query { p, n: Vec3::Y, radius }, kernel, |_| Color::ONE).radiance.x)
}

/// Mean and standard deviation of the k-nearest estimate over the truth, in an even field.
fn even_field(map: &PhotonMap, k: usize, lookups: u32) -> [f64; 2] {
    let mut random = counter(k as u64);
    let radius = Radius::Nearest { k, min: 0.0, max: f32::INFINITY };
    let [mut sum, mut squares] = [0.0; 2];
    for _ in 0..lookups {
        let [x, z] = random.pair().map(|u| (0.02 + 0.96 * u) as f32);
        let e = irradiance(map, Vec3::new(x, 0.0, z), radius, Kernel::Disc) / map.len() as f64;
        sum += e;
        squares += e * e;
    }
    let mean = sum / f64::from(lookups);
    [mean, (squares / f64::from(lookups) - mean * mean).sqrt()]
}

#[test]
fn s04_density_without_bias() {
    row("S4", |row| {
        let map = PhotonMap::new(floor(sized(300_000, 2_000_000), 0));
        for k in [3, 10] {
            let lookups = sized(30_000, 300_000);
            let [mean, sd] = even_field(&map, k, lookups);
            // The estimates of photons that are shared depend on each other: as though of N/k sets.
            let sets = f64::from(lookups).min(map.len() as f64 / k as f64);
            let with = k as f64 / (k as f64 - 1.0);
            let what =
                format!("estimate over truth in an even field, k = {k} (4σ; with the k-th photon {with:.2})");
            row.is(&what, mean, 1.0, 4.0 * sd / sets.sqrt());
        }
        let map = PhotonMap::new(vec![photon(Vec3::ZERO, Vec3::Y); 100]);
        let zero = Radius::Nearest { k: 50, min: 0.0, max: 1.0 };
        row.is(
            "estimate where r = 0 and no floor is given",
            irradiance(&map, Vec3::ZERO, zero, Kernel::Disc),
            0.0,
            0.0,
        );
    });
}

#[test]
fn h29_fewer_photons_than_k() {
    row("H29", |row| {
        let radius = Radius::Nearest { k: 50, min: 0.0, max: 0.5 };
        let brdf = 0.3;
        let query = Query { p: Vec3::ZERO, n: Vec3::Y, radius };
        for count in [0, 1, 49] {
            let near = floor(count, 5).into_iter().map(|p| Photon { position: p.position * 0.3, ..p });
            let map = PhotonMap::new(near.collect::<Vec<_>>());
            let gathered = map.gather(&query, Kernel::Disc, |_| Color::splat(brdf));
            let expected = f64::from(brdf) * count as f64 / (PI * 0.25);
            let what = format!("{count} photons where k is 50: Φ·f/(π r²max) each");
            row.is_close(&what, f64::from(gathered.radiance.x), expected, 1e-6);
        }
        let unbounded = Query { radius: Radius::Nearest { k: 50, min: 0.0, max: f32::INFINITY }, ..query };
        let gathered = PhotonMap::new(floor(10, 5)).gather(&unbounded, Kernel::Epanechnikov, |_| Color::ONE);
        row.is("without a largest radius", f64::from(gathered.radiance.x), 0.0, 0.0);
    });
}

/// Photons of every arrangement that has broken trees: in space, on a floor, on lines, on few points, on one
/// point, in clusters of very different density, and far from the origin.
fn arrangements(count: usize) -> Vec<Vec<Photon>> {
    let mut random = counter(count as u64);
    let mut make = |at: &dyn Fn(Vec3) -> Vec3| -> Vec<Photon> {
        let u = |random: &mut Counter| Vec3::from_array([(); 3].map(|()| random.value() as f32));
        (0..count).map(|_| photon(at(u(&mut random)), Vec3::Y)).collect()
    };
    vec![
        make(&|u| u),
        make(&|u| Vec3::new(u.x, 0.3, u.z)),
        make(&|u| Vec3::new(0.2, 0.3, u.z)),
        make(&|u| Vec3::splat(u.x)),
        make(&|u| (u * 3.0).floor()),
        make(&|_| Vec3::splat(0.7)),
        make(&|u| u * u.x.powi(12)),
        make(&|u| u + Vec3::splat(4096.0)),
    ]
}

/// Squared distances from p of all photons by a look at each, ascending. Along the surface's normal a distance
/// counts eightfold.
fn brute_force(photons: &[Photon], p: Vec3) -> Vec<f32> {
    let mut all: Vec<f32> = photons
        .iter()
        .map(|photon| {
            let d = photon.position - p;
            d.x * d.x + d.y * d.y + d.z * d.z + 63.0 * (d.y * d.y)
        })
        .collect();
    all.sort_by(f32::total_cmp);
    all
}

#[test]
fn h30_photons_on_a_line() {
    row("H30", |row| {
        let (mut wrong, mut lookups) = (0, 0);
        for count in [0, 1, 2, 33, 1000, 100_000] {
            for photons in arrangements(count) {
                let map = PhotonMap::new(photons.clone());
                wrong += u64::from((map.len(), map.refused()) != (count, 0));
                let mut random = counter(1);
                for query in 0..if count > 1000 { sized(4, 100) } else { sized(20, 500) } {
                    let offset = photons.first().map_or(Vec3::ZERO, |p| p.position.floor());
                    let p = match query % 2 {
                        1 if count > 0 => photons[query * 7919 % count].position,
                        _ => Vec3::from_array([(); 3].map(|()| random.value() as f32)) + offset,
                    };
                    let all = brute_force(&photons, p);
                    for k in [1, 2, 10, 50, 64, 300, count.max(1)] {
                        let found = map.nearest_radius(p, Vec3::Y, k, f32::INFINITY);
                        wrong += u64::from(found != all.get(k - 1).map(|e2| e2.sqrt()));
                    }
                    // Of 0 and 1: between photons on a lattice exactly the distance.
                    let radius = [random.value() as f32, 0.0, 1.0][query % 3];
                    let mut found = Vec::new();
                    map.within(p, Vec3::Y, radius, |hit| found.push(hit.distance_squared));
                    found.sort_by(f32::total_cmp);
                    let expected: Vec<f32> = all.into_iter().filter(|e2| *e2 <= radius * radius).collect();
                    wrong += u64::from(found != expected);
                    lookups += 8;
                }
            }
        }
        row.none("lookups, k nearest and within a radius, that differ from brute force; 0 to 1e5 photons in 8 arrangements", wrong, lookups);
    });
}

#[test]
fn h31_radius_zero() {
    row("H31", |row| {
        let map = PhotonMap::new(vec![photon(Vec3::ZERO, Vec3::Y); 100]);
        let n = sized(200, 1000);
        let cell = 3.0 / f64::from(n);
        let at = |i: i32| ((f64::from(i) + 0.5) * cell - 1.5) as f32;
        let (mut off, mut bad) = (0.0f64, 0);
        for kernel in KERNELS {
            for radius in [
                Radius::Fixed(0.6),
                Radius::Nearest { k: 101, min: 0.0, max: 0.6 },
                Radius::Nearest { k: 50, min: 0.6, max: 0.6 },
            ] {
                let e = |j: i32| irradiance(&map, Vec3::new(at(j % n), 0.0, at(j / n)), radius, kernel);
                let power = (0..n * n).map(e).sum::<f64>() * cell * cell;
                off = off.max((power / 100.0 - 1.0).abs());
            }
            for radius in [Radius::Fixed(0.0), Radius::Nearest { k: 50, min: 0.0, max: 1.0 }] {
                bad += u64::from(!irradiance(&map, Vec3::ZERO, radius, kernel).is_finite());
            }
        }
        row.at_most("100 photons on one point: their power over the floor, off as a share", off, 0.01);
        // The 50 nearest are all at a distance of 0; the floor is what they are spread over.
        let floor = Radius::Nearest { k: 50, min: 0.6, max: 1.0 };
        let there = irradiance(&map, Vec3::ZERO, floor, Kernel::Disc);
        row.is_close(
            "where the k-nearest distance is 0: all 100 over π·0.6²",
            there,
            100.0 / (PI * 0.36),
            1e-6,
        );
        row.none("estimates there with a radius of 0 that are no numbers", bad, 6);
    });
}

#[test]
fn h32_edges_and_thin_walls() {
    row("H32", |row| {
        raw_estimate(row);
        let dir = folder();
        let photons = "progressive(count: 20000)";
        for (what, object) in surfaces::plates(dir.path()) {
            let [edges, corners, _] = surfaces::evenness(dir.path(), &object, photons);
            row.is(&format!("{what} in even light: its edges over its middle"), edges, 1.0, 0.05);
            row.is(&format!("{what}: its corners"), corners, 1.0, 0.05);
        }
        let every = sized(4, 1);
        let columns: Vec<f64> = neighbours::neighbourhoods(dir.path())
            .iter()
            .step_by(every)
            .map(|(_, objects)| neighbours::last_column(dir.path(), objects))
            .collect();
        let what = format!(
            "a floor in even light before {} kinds of wall, box, tile and mat: its last column over the closed form",
            columns.len()
        );
        row.is(
            &format!("{what}, the darkest"),
            columns.iter().copied().fold(f64::INFINITY, f64::min),
            1.0,
            0.05,
        );
        row.is("the brightest", columns.iter().copied().fold(0.0, f64::max), 1.0, 0.05);
        let dark = surfaces::dark_side(r#"(shape: box(size: (1e-6, 6, 6)), material: "white")"#);
        row.is("brightest pixel behind a lit wall 1e-6 m thick", dark, 0.0, 0.0);
    });
}

fn raw_estimate(row: &mut Record) {
    let count = sized(400_000, 4_000_000);
    let map = PhotonMap::new(floor(count, 0));
    for (what, p, part) in
        [("a straight edge", Vec3::new(0.0, 0.0, 0.5), 0.5), ("a corner", Vec3::ZERO, 0.25)]
    {
        let query = Query { p, n: Vec3::Y, radius: Radius::Fixed(0.2) };
        let found = map.gather(&query, Kernel::Disc, |_| Color::ONE);
        let estimate = f64::from(found.radiance.x) / count as f64;
        row.is(
            &format!("raw estimate at {what} over the truth (4σ)"),
            estimate,
            part,
            part * 4.0 / f64::from(found.photons).sqrt(),
        );
    }
    let behind = Query { p: Vec3::new(0.5, -1e-6, 0.5), n: Vec3::NEG_Y, radius: Radius::Fixed(0.1) };
    let found = map.gather(&behind, Kernel::Disc, |_| Color::ONE);
    row.is("photons that the other side of a wall of 1e-6 m sees", f64::from(found.photons), 0.0, 0.0);
}

#[test]
fn h33_nearest_photon_bias() {
    row("H33", |row| {
        let map = PhotonMap::new(floor(sized(300_000, 1_000_000), 0));
        let lookups = sized(30_000, 100_000);
        for (k, deviation) in [(50, 0.144), (200, 0.071)] {
            let [mean, sd] = even_field(&map, k, lookups);
            row.is(
                &format!("estimate over truth in an even field, k = {k}, {lookups} lookups"),
                mean,
                1.0,
                sized(6e-3, 3e-3),
            );
            row.is("its relative standard deviation: 1/√(k − 2)", sd, deviation, 3e-3);
        }
        // ∫ w 2πd dd by the midpoint rule, whose error is of order 1/n².
        let mut off = 0.0f64;
        let cones = [1.0, 1.1, 3.0].map(|kappa| Kernel::Cone { kappa });
        for kernel in [Kernel::Disc, Kernel::Epanechnikov].into_iter().chain(cones) {
            for radius in [1e-3f32, 0.7, 250.0] {
                let n = 20_000;
                let ring = |i: i32| {
                    let t = (f64::from(i) + 0.5) / f64::from(n);
                    let weight = f64::from(kernel.weight((t * t) as f32, radius));
                    weight * TAU * t * f64::from(radius).powi(2) / f64::from(n)
                };
                off = off.max(((0..n).map(ring).sum::<f64>() - 1.0).abs());
            }
        }
        row.at_most(
            "integral of disc, cone and Epanechnikov kernels off 1 (there is no Gaussian one)",
            off,
            1e-6,
        );
    });
}
