//! Closed meshes have no cracks, and hits lie where they say.

use super::*;
use crate::build::bvh::TriangleBvh;
use crate::math::DVec3;

const PLACE: DVec3 = DVec3::new(148_376.0, 1234.0, -223_423.0);

/// Points that rays are aimed at: every vertex, every edge's middle.
fn targets(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let edges = triangles.iter().flat_map(|t| (0..3).map(|k| (t[k], t[(k + 1) % 3])));
    let middles = edges.map(|(a, b)| 0.5 * vertices[a as usize] + 0.5 * vertices[b as usize]);
    vertices.iter().copied().chain(middles).collect()
}

/// How many of the rays from within miss the sphere around `place`.
fn misses(place: DVec3, radius: f64, random_rays: usize) -> usize {
    let (vertices, triangles) = sphere(radius, 40, 64);
    let vertices: Vec<Vec3> = vertices.iter().map(|v| (*v + place).as_vec3()).collect();
    let tree = TriangleBvh::build(&vertices, &triangles);
    tree.validate(&vertices, &triangles).unwrap();
    let portable = tree.clone().portable();
    let aims = targets(&vertices, &triangles);
    let mut rng = Rng(5);
    let mut missed = 0;
    for i in 0..aims.len() * 4 + random_rays {
        let origin = (place + rng.cube().as_dvec3() * (0.5 * radius)).as_vec3();
        let dir = match i {
            _ if i < aims.len() => aims[i] - place.as_vec3(),
            _ if i < aims.len() * 4 => aims[i % aims.len()] - origin,
            _ => rng.cube(),
        };
        let origin = if i < aims.len() { place.as_vec3() } else { origin };
        let r = ray(origin, dir);
        let hit = tree.nearest(&r, f32::INFINITY);
        assert_eq!(hit, portable.nearest(&r, f32::INFINITY), "lanes disagree");
        assert_eq!(hit.is_some(), tree.any(&r, f32::INFINITY));
        missed += usize::from(hit.is_none());
    }
    missed
}

#[test]
fn no_ray_leaves_a_closed_sphere_far_from_the_origin() {
    assert_eq!(misses(PLACE, 2.0, 100_000), 0);
}

#[test]
fn no_ray_leaves_a_closed_sphere_of_any_size() {
    for scale in [1e-4, 1e-2, 1.0, 1e2, 1e4] {
        assert_eq!(misses(DVec3::ZERO, scale, 10_000), 0, "radius {scale}");
        assert_eq!(misses(DVec3::new(-10.0, 3.0, 20.0) * scale, scale, 10_000), 0, "radius {scale}");
    }
}

/// ‖(o + t·d) − Σ bᵢ·vᵢ‖ ≤ 32 ε·(‖o‖ + ‖v‖max) with ε = 2⁻²³, in double precision, for needles
/// seen along and across, near and far; and the barycentrics are a partition.
#[test]
fn the_point_on_the_ray_and_the_point_on_the_triangle_agree() {
    let mut rng = Rng(6);
    let mut hits = 0;
    for case in 0..400 {
        let place = if case % 2 == 0 { Vec3::ZERO } else { rng.cube() * 1e5 };
        let size = [1e-3, 1.0, 100.0][case % 3];
        let mut vertices = Vec::new();
        for _ in 0..64 {
            let (a, along) = (rng.cube() * size, rng.cube() * size);
            let thin = rng.cube() * size * [1.0, 1e-3, 1e-6][rng.next() as usize % 3];
            vertices.extend([a, a + along, a + along * rng.unit() + thin].map(|v| v + place));
        }
        let triangles: Vec<[u32; 3]> = (0..64).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let tree = TriangleBvh::build(&vertices, &triangles);
        for i in 0..300 {
            let t = (i % 64) * 3;
            let origin = if i % 3 == 0 { vertices[t] } else { place + rng.cube() * size * 2.0 };
            let (u, v) = (rng.unit(), rng.unit());
            let aim = vertices[t] * (1.0 - u) + (vertices[t + 1] * (1.0 - v) + vertices[t + 2] * v) * u;
            let dir = if aim == origin { rng.cube() } else { aim - origin };
            let Some(hit) = tree.nearest(&ray(origin, dir), f32::INFINITY) else { continue };
            hits += 1;
            let corners = triangles[hit.triangle as usize].map(|v| vertices[v as usize].as_dvec3());
            let on_ray = origin.as_dvec3() + dir.as_dvec3() * f64::from(hit.t);
            let on_triangle: DVec3 = corners.iter().zip(hit.b).map(|(v, b)| *v * f64::from(b)).sum();
            let largest = corners.iter().fold(0.0f64, |m, v| m.max(v.length()));
            let bound = 32.0 * f64::from(f32::EPSILON) * (origin.as_dvec3().length() + largest);
            let gap = on_ray.distance(on_triangle);
            assert!(gap <= bound, "case {case}, ray {i}: {gap} above {bound}, {hit:?}");
            assert!(hit.b.iter().all(|b| *b >= 0.0) && (hit.b.iter().sum::<f32>() - 1.0).abs() < 1e-6);
        }
    }
    assert!(hits > 50_000, "only {hits} hits");
}

/// A fan whose triangles all share the vertex that the ray goes through: equal distances, and the
/// smallest index wins whatever the order in the list and so in the tree.
#[test]
fn at_one_distance_the_smallest_index_wins() {
    let mut rng = Rng(7);
    for n in [3u32, 8, 9, 40, 300] {
        let rim = (0..n).map(|i| (std::f32::consts::TAU * i as f32 / n as f32).sin_cos());
        let mut vertices = vec![Vec3::ZERO];
        vertices.extend(rim.map(|(s, c)| Vec3::new(c, s, 0.0)));
        let mut triangles: Vec<[u32; 3]> = (0..n).map(|i| [0, 1 + i, 1 + (i + 1) % n]).collect();
        for _ in 0..10 {
            for i in (1..triangles.len()).rev() {
                triangles.swap(i, rng.next() as usize % (i + 1));
            }
            let tree = TriangleBvh::build(&vertices, &triangles);
            for dir in [Vec3::NEG_Z, Vec3::new(0.5, 0.25, -1.0)] {
                let hit = tree.nearest(&ray(-dir, dir), f32::INFINITY).unwrap();
                assert_eq!((hit.t, hit.triangle), (1.0, 0));
            }
        }
    }
}
