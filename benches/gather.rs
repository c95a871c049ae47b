//! Photon gathers a second on a floor of a million photons, beside plain `kiddo` on the same photons
//! turned by a rotation (its immutable tree with flat leaves, visited where it can be, which only counts
//! what it finds), and the time to build either.
//!
//! 50 nearest photons without a bound on the radius, 50 nearest with a bound of twice the expected
//! distance, and within the radius that holds 50 on average; points in random order and in the order
//! of tiles of 32². A gather of ours tests sides and surfaces and sums power times a BRDF. Both take
//! turns, block by block, and each block's best time counts, so that other work on the machine moves
//! the ratio little. `cargo bench --bench gather [-- QUERIES]`

use kiddo::{Eytzinger, FlatVec, KdTree, SquaredEuclidean};
use std::hint::black_box;
use std::num::NonZeroUsize;
use std::time::Instant;
use terrarium::index::{Kernel, PhotonMap, Query, Radius};
use terrarium::math::random::{Counter, Stage};
use terrarium::math::{Color, Vec3};
use terrarium::optics::Face;
use terrarium::scatter::Photon;

const PHOTONS: usize = 1_000_000;
const K: usize = 50;
const BLOCK: usize = 2048;
const REPEATS: usize = 5;
const TILE: usize = 32;

type Plain = KdTree<f32, u32, Eytzinger, FlatVec<f32, u32, 3, 32>, 3, 32>;

fn main() {
    let queries = std::env::args().skip(1).find_map(|a| a.parse().ok()).unwrap_or(1usize << 17);
    let photons = floor_photons();
    let points: Vec<[f32; 3]> = photons.iter().map(|photon| turned(photon.position)).collect();
    let pools = [1, 2]
        .map(|n| rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads can be started"));
    println!("                                       terrarium     kiddo   ratio");
    for (pool, threads) in pools.iter().zip(1..) {
        let (mut ours, mut plain) = (f64::INFINITY, f64::INFINITY);
        for _ in 0..REPEATS {
            let copy = photons.clone();
            ours = ours.min(pool.install(|| seconds(|| PhotonMap::new(copy))));
            plain = plain.min(pool.install(|| {
                seconds(|| {
                    Plain::builder()
                        .with_parallel_construction_threshold(1 << 14)
                        .build_from_slice(&points)
                        .expect("the points are finite")
                })
            }));
        }
        println!(
            "{:34} {threads} thr {:7.1} ms {:6.1} ms {:6.2}",
            "build",
            ours * 1e3,
            plain * 1e3,
            plain / ours
        );
    }
    let map = PhotonMap::new(photons);
    let plain = Plain::new_from_slice(&points).expect("the points are finite");
    println!("memory: {:.1} bytes a photon", map.memory_bytes() as f64 / PHOTONS as f64);

    let expected = (K as f64 / (std::f64::consts::PI * PHOTONS as f64)).sqrt() as f32;
    let count = NonZeroUsize::new(K).expect("K is not 0");
    for (order, at) in [("random", random_points(queries)), ("tiles", tiled_points(queries))] {
        for (name, radius) in [
            ("50 nearest", Radius::Nearest { k: K, min: 0.0, max: f32::INFINITY }),
            ("50 nearest, bounded", Radius::Nearest { k: K, min: 0.0, max: 2.0 * expected }),
            ("within", Radius::Fixed(expected)),
        ] {
            let gather = |p: Vec3| {
                let gathered =
                    map.gather(&Query { p, n: Vec3::Y, radius }, Kernel::Disc, |_| Color::splat(0.3));
                black_box(gathered.radiance);
                gathered.photons as usize
            };
            let visit = |p: Vec3| {
                let (p, mut found) = (turned(p), 0);
                match radius {
                    Radius::Nearest { max, .. } if max.is_finite() => {
                        let nearest = plain.query(&p).nearest_n::<SquaredEuclidean<f32>>(count);
                        found = black_box(nearest.within(max * max).unsorted().execute()).len();
                    }
                    Radius::Nearest { .. } => {
                        let nearest = plain.query(&p).nearest_n::<SquaredEuclidean<f32>>(count);
                        found = black_box(nearest.unsorted().execute()).len();
                    }
                    Radius::Fixed(r) => {
                        plain
                            .query(&p)
                            .within::<SquaredEuclidean<f32>>(r * r)
                            .unsorted()
                            .visit(|photon| found += usize::from(black_box(photon).distance >= 0.0));
                    }
                }
                found
            };
            compare(&format!("{name}, {order}"), &at, &pools, gather, visit);
        }
    }
}

/// Rates of both on one thread and on two.
fn compare(
    name: &str,
    at: &[Vec3],
    pools: &[rayon::ThreadPool; 2],
    ours: impl Fn(Vec3) -> usize + Sync,
    plain: impl Fn(Vec3) -> usize + Sync,
) {
    let count = |f: &(dyn Fn(&[Vec3]) -> usize + Sync), part: &[Vec3]| f(part);
    let ours = |part: &[Vec3]| part.iter().map(|p| ours(*p)).sum::<usize>();
    let plain = |part: &[Vec3]| part.iter().map(|p| plain(*p)).sum::<usize>();
    for (threads, pool) in (1..).zip(pools) {
        let block = BLOCK * threads;
        let mut best = [0.0f64; 2];
        let mut found = [0; 2];
        for part in at.chunks(block) {
            let mut fastest = [f64::INFINITY; 2];
            for _ in 0..REPEATS {
                for (which, f) in
                    [&ours as &(dyn Fn(&[Vec3]) -> usize + Sync), &plain].into_iter().enumerate()
                {
                    let (left, right) = part.split_at(part.len() / threads);
                    let start = Instant::now();
                    let n = if threads == 1 {
                        count(f, part)
                    } else {
                        let (a, b) = pool.install(|| rayon::join(|| count(f, left), || count(f, right)));
                        a + b
                    };
                    fastest[which] = fastest[which].min(start.elapsed().as_secs_f64());
                    found[which] = n;
                }
            }
            best[0] += fastest[0];
            best[1] += fastest[1];
        }
        let rate = best.map(|seconds| at.len() as f64 / seconds * 1e-3);
        println!(
            "{name:34} {threads} thr {:8.0} k/s {:6.0} k/s {:6.2}   {:?}",
            rate[0],
            rate[1],
            rate[0] / rate[1],
            found
        );
    }
}

fn seconds<T>(f: impl FnOnce() -> T) -> f64 {
    let start = Instant::now();
    let made = f();
    let seconds = start.elapsed().as_secs_f64();
    drop(made);
    seconds
}

fn turned(p: Vec3) -> [f32; 3] {
    let p = p / 3.0;
    [2.0 * p.x - p.y + 2.0 * p.z, 2.0 * p.x + 2.0 * p.y - p.z, 2.0 * p.y + 2.0 * p.z - p.x]
}

fn floor_photons() -> Vec<Photon> {
    let mut random = Counter::new(1, Stage::Test, 0);
    let photon = |_| {
        let [x, z] = random.pair();
        Photon {
            position: Vec3::new(x as f32, 0.0, z as f32),
            wi: Vec3::new(0.6, 0.8, 0.0),
            normal: Vec3::Y,
            power: Vec3::splat(1e-6),
            face: Face::Opaque,
        }
    };
    (0..PHOTONS).map(photon).collect()
}

fn random_points(count: usize) -> Vec<Vec3> {
    let mut random = Counter::new(2, Stage::Test, 0);
    (0..count)
        .map(|_| {
            let [x, z] = random.pair();
            Vec3::new(x as f32, 0.0, z as f32)
        })
        .collect()
}

/// One point in each pixel of a square image of the floor, tile by tile.
fn tiled_points(count: usize) -> Vec<Vec3> {
    let tiles = count.isqrt().div_ceil(TILE);
    let size = (tiles * TILE) as f64;
    let mut random = Counter::new(3, Stage::Test, 0);
    (0..tiles * tiles)
        .flat_map(|tile| (0..TILE * TILE).map(move |pixel| (tile, pixel)))
        .map(|(tile, pixel)| {
            let [x, z] = random.pair();
            let at = |t: usize, p: usize, u: f64| (((t * TILE + p) as f64 + u) / size) as f32;
            Vec3::new(at(tile % tiles, pixel % TILE, x), 0.0, at(tile / tiles, pixel / TILE, z))
        })
        .collect()
}
