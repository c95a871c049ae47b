//! Closed meshes have no cracks, and hits lie where they say.

use super::*;
use crate::build::bvh::TriangleBvh;
use crate::math::DVec3;

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
fn no_ray_leaves_a_closed_sphere_of_any_size() {
    for scale in [1e-4, 1e-2, 1.0, 1e2, 1e4] {
        assert_eq!(misses(DVec3::ZERO, scale, 10_000), 0, "radius {scale}");
        assert_eq!(misses(DVec3::new(-10.0, 3.0, 20.0) * scale, scale, 10_000), 0, "radius {scale}");
    }
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
