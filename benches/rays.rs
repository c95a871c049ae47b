//! Rays a second on the heightfield of the yardstick's scene Y4 (2,093,058 triangles), and the time
//! to build its tree, beside Embree's on the same rays where Embree 3 and g++ are installed.
//!
//! Primary: 1024² jittered camera rays. Bounce: one cosine-distributed direction from each primary
//! hit. Shadow: from each primary hit to the point light. Figures are the best of several runs;
//! other work on the machine moves them, so trust the ratios more than the figures.
//! `cargo bench --bench rays [-- alone]`; `alone` leaves the peer out.

use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::{fs, io::Write, path::Path, process::Command, time::Instant};
use terrarium::build::bvh::{BoxRay, TriangleBvh};

const GRID: usize = 1024;
const SIZE: usize = 1024;
const BLOCK: usize = 4096;
const REPEATS: usize = 8;

struct Ray {
    o: Vec3,
    d: Vec3,
    t_max: f32,
}

struct Row {
    name: String,
    threads: usize,
    value: f64,
    hits: u64,
}

fn main() {
    let (vertices, triangles) = heightfield();
    let pool = |n| rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads can be started");
    let pools = [pool(1), pool(2)];
    let mut rows = Vec::new();

    let mut best = f64::INFINITY;
    let mut tree = None;
    for _ in 0..3 {
        drop(tree.take());
        let start = Instant::now();
        tree = Some(pools[1].install(|| TriangleBvh::build(&vertices, &triangles)));
        best = best.min(start.elapsed().as_secs_f64());
    }
    let tree = tree.expect("it was built above");
    rows.push(Row { name: "build".into(), threads: 2, value: best * 1e3, hits: 0 });
    println!("tree: {:.1} MiB, {} triangles", tree.memory_bytes() as f64 / 1048576.0, tree.triangles());

    let primary = primary_rays();
    let (bounce, shadow) = secondary_rays(&tree, &primary, &vertices, &triangles);
    let nearest = |r: &Ray| tree.nearest(&BoxRay::new(r.o, Vec3::ZERO, r.d), r.t_max).is_some();
    let any = |r: &Ray| tree.any(&BoxRay::new(r.o, Vec3::ZERO, r.d), r.t_max);
    for (i, pool) in pools.iter().enumerate() {
        rows.push(measure("primary", i + 1, pool, &primary, nearest));
        rows.push(measure("bounce", i + 1, pool, &bounce, nearest));
        rows.push(measure("shadow", i + 1, pool, &shadow, any));
    }

    if std::env::args().any(|a| a == "alone") {
        return print(&rows, &[], &[]);
    }
    let dir = tempfile::tempdir().expect("a temporary folder can be made");
    write(dir.path(), "vertices", vertices.iter().flat_map(|v| v.to_array()).flat_map(f32::to_le_bytes));
    write(dir.path(), "triangles", triangles.iter().flatten().flat_map(|i| i.to_le_bytes()));
    for (name, rays) in [("primary", &primary), ("bounce", &bounce), ("shadow", &shadow)] {
        let values = rays.iter().flat_map(|r| [r.o.x, r.o.y, r.o.z, r.d.x, r.d.y, r.d.z, r.t_max]);
        write(dir.path(), name, values.flat_map(f32::to_le_bytes));
    }
    let medium = embree(dir.path(), None);
    let robust = embree(dir.path(), Some("robust"));
    print(&rows, &medium, &robust);
}

/// y = Σ 0.8·2^-o·sin(1.3·2^o·x + 0.7·o)·cos(1.1·2^o·z + 1.3·o) over x, z in [-5, 5].
fn heightfield() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let place = |i: usize| -5.0 + 10.0 * i as f64 / (GRID - 1) as f64;
    let height = |x: f64, z: f64| -> f64 {
        let octave = |o: i32| {
            let (o, f) = (f64::from(o), f64::from(1 << o));
            0.8 / f * (1.3 * f * x + 0.7 * o).sin() * (1.1 * f * z + 1.3 * o).cos()
        };
        (0..6).map(octave).sum()
    };
    let vertex = |j: usize, i: usize| DVec3::new(place(i), height(place(i), place(j)), place(j)).as_vec3();
    let vertices = (0..GRID).flat_map(|j| (0..GRID).map(move |i| vertex(j, i))).collect();
    let cell = |j: usize, i: usize| {
        let [a, b] = [j * GRID + i, (j + 1) * GRID + i].map(|v| v as u32);
        [[a, b, b + 1], [a, b + 1, a + 1]]
    };
    let triangles = (0..GRID - 1).flat_map(|j| (0..GRID - 1).flat_map(move |i| cell(j, i))).collect();
    (vertices, triangles)
}

/// A value in [0, 1) that is a function of two numbers.
fn random(item: usize, dimension: u64) -> f64 {
    let mut z =
        (item as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ dimension.wrapping_mul(0xd1b5_4a32_d192_ed03);
    for factor in [0xbf58_476d_1ce4_e5b9, 0x94d0_49bb_1331_11eb] {
        z = (z ^ (z >> 31)).wrapping_mul(factor);
    }
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

fn primary_rays() -> Vec<Ray> {
    let (eye, target) = (DVec3::new(0.0, 6.0, 9.0), DVec3::ZERO);
    let forward = (target - eye).normalize();
    let right = forward.cross(DVec3::Y).normalize();
    let up = right.cross(forward);
    let half = (22.5f64).to_radians().tan();
    let ray = |p: usize| {
        let at = |c: usize, dim| (2.0 * (c as f64 + random(p, dim)) / SIZE as f64 - 1.0) * half;
        let d = forward + right * at(p % SIZE, 0) - up * at(p / SIZE, 1);
        Ray { o: eye.as_vec3(), d: d.normalize().as_vec3(), t_max: f32::INFINITY }
    };
    (0..SIZE * SIZE).map(ray).collect()
}

fn secondary_rays(
    tree: &TriangleBvh,
    primary: &[Ray],
    vertices: &[Vec3],
    triangles: &[[u32; 3]],
) -> (Vec<Ray>, Vec<Ray>) {
    let from_hit = |(i, r): (usize, &Ray)| {
        let hit = tree.nearest(&BoxRay::new(r.o, Vec3::ZERO, r.d), r.t_max)?;
        let [a, b, c] = triangles[hit.triangle as usize].map(|v| vertices[v as usize].as_dvec3());
        let p = a * f64::from(hit.b[0]) + b * f64::from(hit.b[1]) + c * f64::from(hit.b[2]);
        let n = (b - a).cross(c - a).normalize();
        let n = if n.dot(r.d.as_dvec3()) > 0.0 { -n } else { n };
        let o = p + n * 1e-4;
        let (phi, z) = (std::f64::consts::TAU * random(i, 2), 2.0 * random(i, 3) - 1.0);
        let s = (1.0 - z * z).sqrt();
        let d = (n + DVec3::new(s * phi.cos(), s * phi.sin(), z)).normalize();
        let bounce = Ray { o: o.as_vec3(), d: d.as_vec3(), t_max: f32::INFINITY };
        let shadow = Ray { o: o.as_vec3(), d: (DVec3::new(4.0, 8.0, 3.0) - o).as_vec3(), t_max: 1.0 };
        Some((bounce, shadow))
    };
    primary.iter().enumerate().filter_map(from_hit).unzip()
}

/// One thread: the sum over blocks of rays of each block's best time, which other work on the
/// machine moves least. Two threads: the best time of the whole.
fn measure(
    name: &str,
    threads: usize,
    pool: &rayon::ThreadPool,
    rays: &[Ray],
    hit: impl Fn(&Ray) -> bool + Sync,
) -> Row {
    let count = |part: &[Ray]| part.iter().filter(|r| hit(r)).count() as u64;
    let mut hits = 0;
    let seconds = if threads == 1 {
        let mut best = vec![f64::INFINITY; rays.len().div_ceil(BLOCK)];
        for _ in 0..REPEATS {
            hits = 0;
            for (best, block) in best.iter_mut().zip(rays.chunks(BLOCK)) {
                let start = Instant::now();
                hits += count(block);
                *best = best.min(start.elapsed().as_secs_f64());
            }
        }
        best.iter().sum()
    } else {
        let run = || {
            let start = Instant::now();
            hits = pool.install(|| rays.par_chunks(BLOCK).map(count).sum());
            start.elapsed().as_secs_f64()
        };
        std::iter::repeat_with(run).take(REPEATS).fold(f64::INFINITY, f64::min)
    };
    Row { name: name.into(), threads, value: rays.len() as f64 / seconds * 1e-6, hits }
}

fn write(dir: &Path, name: &str, bytes: impl Iterator<Item = u8>) {
    let data: Vec<u8> = bytes.collect();
    let mut file = fs::File::create(dir.join(name)).expect("a temporary file can be made");
    file.write_all(&data).expect("the temporary file takes the mesh and its rays");
}

/// Runs the peer, or says why it could not be run.
fn embree(dir: &Path, mode: Option<&str>) -> Vec<Row> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/peers/embree.sh");
    let output = match Command::new(script).arg(dir).args(mode).output() {
        Ok(output) if output.status.success() => output,
        Ok(output) => {
            println!("Embree left out: {}", String::from_utf8_lossy(&output.stderr).trim());
            return Vec::new();
        }
        Err(e) => {
            println!("Embree left out: {e}");
            return Vec::new();
        }
    };
    let row = |line: &str| {
        let mut words = line.split(' ');
        Some(Row {
            name: words.next()?.into(),
            threads: words.next()?.parse().ok()?,
            value: words.next()?.parse().ok()?,
            hits: words.next()?.parse().ok()?,
        })
    };
    String::from_utf8_lossy(&output.stdout).lines().filter_map(row).collect()
}

fn print(ours: &[Row], medium: &[Row], robust: &[Row]) {
    println!("                   terrarium   Embree  ratio  robust  ratio   hits (and Embree's)");
    for row in ours {
        let same = |rows: &'_ [Row]| -> Option<(f64, u64)> {
            let found = rows.iter().find(|r| r.name == row.name && r.threads == row.threads);
            found.map(|r| (r.value, r.hits))
        };
        let unit = if row.name == "build" { "ms" } else { "Mray/s" };
        print!("{:8} {} thr {:>6} {:9.2}", row.name, row.threads, unit, row.value);
        for (value, _) in [same(medium), same(robust)].into_iter().flatten() {
            // Above 1 is faster than the peer, in either unit.
            let ratio = if row.name == "build" { value / row.value } else { row.value / value };
            print!(" {value:8.2} {ratio:6.2}");
        }
        println!("   {} {}", row.hits, same(medium).map_or(String::new(), |(_, hits)| format!("({hits})")));
    }
}
