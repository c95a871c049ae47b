//! The triangle tree against brute force, and what it does with degenerate meshes.

use super::*;
use crate::build::bvh::TriangleBvh;
use crate::math::DVec3;

fn soup(rng: &mut Rng, n: usize, place: Vec3, scale: f32, size: f32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut vertices = Vec::new();
    for _ in 0..n {
        let p = rng.cube();
        vertices.extend([0; 3].map(|_| place + (p + rng.cube() * size) * scale));
    }
    (vertices, (0..n as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
}

/// Möller & Trumbore 1997 in double precision: distances of all triangles that are hit well inside,
/// so that rounding in the vertices' projection cannot matter.
fn surely_hit(v: [DVec3; 3], o: DVec3, d: DVec3) -> Option<f64> {
    let (e1, e2) = (v[1] - v[0], v[2] - v[0]);
    let p = d.cross(e2);
    let det = e1.dot(p);
    let s = o - v[0];
    let (b1, q) = (s.dot(p) / det, s.cross(e1));
    let (b2, t) = (d.dot(q) / det, e2.dot(q) / det);
    let inside = b1 > 1e-3 && b2 > 1e-3 && b1 + b2 < 1.0 - 1e-3;
    (inside && t > 1e-3 && det.abs() > 1e-3 * e1.length() * e2.length() * d.length()).then_some(t)
}

#[test]
fn the_tree_finds_what_brute_force_finds_at_every_scale_and_place() {
    let mut rng = Rng(1);
    let far = Vec3::new(148_376.0, 1234.0, -223_423.0);
    for (scale, place) in [(1e-4, Vec3::ZERO), (1.0, Vec3::ZERO), (1e4, Vec3::ZERO), (10.0, far)] {
        for (n, size) in [(1, 0.5), (7, 0.5), (60, 0.3), (700, 0.1), (700, 1.0)] {
            let (vertices, triangles) = soup(&mut rng, n, place, scale, size);
            let tree = TriangleBvh::build(&vertices, &triangles);
            tree.validate(&vertices, &triangles).unwrap();
            let portable = tree.clone().portable();
            for i in 0..150 {
                let origin = place + rng.cube() * scale * 1.5;
                let dir = rng.cube() * [1.0, 1e-3, 1e3][i % 3];
                let t_max = if i % 4 == 0 { rng.unit() * scale / dir.length() } else { f32::INFINITY };
                let r = ray(origin, dir);
                let hit = tree.nearest(&r, t_max);
                assert_eq!(hit, brute_force(&vertices, &triangles, &tree.bounds(), &r, t_max));
                assert_eq!(hit, portable.nearest(&r, t_max));
                assert_eq!(hit.is_some(), tree.any(&r, t_max));
                assert_eq!(hit.is_some(), portable.any(&r, t_max));
            }
        }
    }
}

#[test]
fn nearest_hits_agree_with_double_precision() {
    let mut rng = Rng(2);
    let (vertices, triangles) = soup(&mut rng, 500, Vec3::ZERO, 1.0, 0.3);
    let tree = TriangleBvh::build(&vertices, &triangles);
    let mut hits = 0;
    for _ in 0..2000 {
        let (origin, dir) = (rng.cube() * 1.5, rng.cube());
        let corners = |t: &[u32; 3]| t.map(|v| vertices[v as usize].as_dvec3());
        let (o, d) = (origin.as_dvec3(), dir.as_dvec3());
        let sure =
            triangles.iter().filter_map(|t| surely_hit(corners(t), o, d)).fold(f64::INFINITY, f64::min);
        let found = tree.nearest(&ray(origin, dir), f32::INFINITY).map_or(f64::INFINITY, |h| f64::from(h.t));
        assert!(found <= sure * (1.0 + 1e-4), "{found} behind {sure}");
        hits += usize::from((found - sure).abs() <= 1e-4 * sure);
    }
    assert!(hits > 600, "{hits} agree");
}

#[test]
fn triangles_without_area_are_never_hit() {
    let mut rng = Rng(3);
    let (mut vertices, mut triangles) = soup(&mut rng, 50, Vec3::ZERO, 1.0, 0.5);
    let alone = TriangleBvh::build(&vertices, &triangles);
    for i in 0..1000u32 {
        let first = vertices.len() as u32;
        let (p, d) = ((rng.cube() * 8.0).round(), (rng.cube() * 4.0).round());
        vertices.extend([p, p + d, p + d * (i % 3) as f32, Vec3::NAN, Vec3::INFINITY]);
        triangles
            .push([[first, first + 1, first + 2], [first, first + 1, first + 3 + i % 2]][i as usize % 2]);
    }
    triangles.push([0, 1, u32::MAX]);
    let tree = TriangleBvh::build(&vertices, &triangles);
    tree.validate(&vertices, &triangles).unwrap();
    assert_eq!((tree.triangles(), tree.bounds()), (50, alone.bounds()));
    for _ in 0..2000 {
        let r = ray(rng.cube() * 2.0, rng.cube());
        assert_eq!(tree.nearest(&r, f32::INFINITY), alone.nearest(&r, f32::INFINITY));
    }
}

#[test]
fn a_mesh_of_nothing_is_missed() {
    let tree = TriangleBvh::build(&[], &[]);
    tree.validate(&[], &[]).unwrap();
    let r = ray(Vec3::ZERO, Vec3::Z);
    assert!(tree.bounds().is_empty() && tree.nearest(&r, f32::INFINITY).is_none() && !tree.any(&r, 1.0));
}

#[test]
fn a_hundred_thousand_copies_of_one_triangle_are_hit_once_each() {
    let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let triangles = vec![[0, 1, 2]; 100_000];
    let tree = TriangleBvh::build(&vertices, &triangles);
    tree.validate(&vertices, &triangles).unwrap();
    let hit = tree.nearest(&ray(Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z), f32::INFINITY).unwrap();
    assert_eq!((hit.t, hit.triangle), (1.0, 0));
}

#[test]
fn rays_that_are_no_rays_hit_nothing() {
    let tree = TriangleBvh::build(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2]]);
    let (o, d) = (Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z);
    assert!(tree.nearest(&ray(o, d), f32::INFINITY).is_some());
    for bad in [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY, Vec3::new(0.0, f32::NAN, -1.0)] {
        assert!(tree.nearest(&ray(o, bad), f32::INFINITY).is_none() && !tree.any(&ray(o, bad), 1e9));
    }
    assert!(tree.nearest(&ray(Vec3::NAN, d), f32::INFINITY).is_none());
    for t_max in [0.0, -1.0, f32::NAN, 1.0] {
        assert!(tree.nearest(&ray(o, d), t_max).is_none(), "t_max {t_max}");
    }
}

#[test]
fn any_number_of_threads_builds_the_same_tree() {
    let (vertices, triangles) = soup(&mut Rng(4), 120_000, Vec3::ZERO, 1.0, 0.02);
    let build = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let tree = pool.install(|| TriangleBvh::build(&vertices, &triangles));
        tree.validate(&vertices, &triangles).unwrap();
        tree.fingerprint()
    };
    let one = build(1);
    assert_eq!(one, build(2));
    assert_eq!(one, build(5));
}
