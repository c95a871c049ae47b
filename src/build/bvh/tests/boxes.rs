//! The tree over boxes: every box that the exact ray meets is visited, and few others.

use super::*;
use crate::build::bvh::Bvh;
use crate::build::bvh::node::{Child, Node};

/// Whether the exact ray meets the box, grown by `pad`, at a t in [0, t_max]: double precision is
/// exact enough for the small integers and halves that the tests use.
fn meets(b: &Aabb, origin: Vec3, dir: Vec3, t_max: f64, pad: f64) -> bool {
    let (mut first, mut last) = (0.0f64, t_max);
    for k in 0..3 {
        let (lo, hi) = (f64::from(b.min[k]) - pad, f64::from(b.max[k]) + pad);
        let (o, d) = (f64::from(origin[k]), f64::from(dir[k]));
        if d == 0.0 {
            if o < lo || o > hi {
                return false;
            }
            continue;
        }
        let (a, b) = ((lo - o) / d, (hi - o) / d);
        first = first.max(a.min(b));
        last = last.min(a.max(b));
    }
    first <= last
}

fn visited(tree: &Bvh, r: &BoxRay, t_max: f32) -> Vec<u32> {
    let mut all = Vec::new();
    tree.nearest(r, t_max, |i, _| {
        all.push(i);
        None
    });
    let mut unordered = Vec::new();
    tree.any(r, t_max, |i| {
        unordered.push(i);
        false
    });
    all.sort_unstable();
    unordered.sort_unstable();
    assert_eq!(all, unordered);
    all
}

/// All 26 directions along axes and diagonals, with +0 and −0, from below, on the minimum, inside,
/// on the maximum and above on each axis: the machine's lanes and the portable ones visit the same.
#[test]
fn rays_in_the_planes_of_faces_are_the_same_by_all_lanes() {
    let boxes: Vec<Aabb> = [(0.0, 1.0), (2.0, 3.0), (1.0, 1.0), (-4.0, -2.0)]
        .map(|(a, b)| Aabb { min: Vec3::splat(a), max: Vec3::splat(b) })
        .to_vec();
    let tree = Bvh::build(&boxes);
    let portable = tree.clone().portable();
    let places = [-5.0, -4.0, -3.0, -2.0, -1.0, 0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0];
    let pick = |n: usize, base: usize, digit: u32| n / base.pow(digit) % base;
    for direction in (0..27).filter(|&n| n != 13) {
        let dir = Vec3::from_array([0, 1, 2].map(|k| pick(direction, 3, k) as f32 - 1.0));
        let minus = Vec3::select(dir.cmpeq(Vec3::ZERO), Vec3::splat(-0.0), dir);
        for n in 0..places.len().pow(3) {
            let origin = Vec3::from_array([0, 1, 2].map(|k| places[pick(n, places.len(), k)]));
            for dir in [dir, minus] {
                let r = ray(origin, dir);
                let (a, b) = (visited(&tree, &r, f32::INFINITY), visited(&portable, &r, f32::INFINITY));
                assert_eq!(a, b, "{origin} {dir}");
            }
        }
    }
}

#[test]
fn every_box_in_reach_is_visited_and_few_others() {
    let mut rng = Rng(11);
    for (scale, place) in [(1e-4, Vec3::ZERO), (1.0, Vec3::ZERO), (1e4, Vec3::ZERO), (1.0, Vec3::splat(1e5))]
    {
        let boxes: Vec<Aabb> = (0..1000)
            .map(|_| {
                let p = place + rng.cube() * scale;
                Aabb::from_points([p, p + rng.cube() * (0.1 * scale)])
            })
            .collect();
        let tree = Bvh::build(&boxes);
        tree.validate(&boxes).unwrap();
        let portable = tree.clone().portable();
        for i in 0..500 {
            let (origin, dir) = (place + rng.cube() * scale * 1.5, rng.cube());
            let t_max = if i % 2 == 0 { f32::INFINITY } else { rng.unit() * scale };
            let all = visited(&tree, &ray(origin, dir), t_max);
            assert_eq!(all, visited(&portable, &ray(origin, dir), t_max));
            let size = f64::from(scale + place.length());
            for (i, b) in (0u32..).zip(&boxes) {
                let was = all.binary_search(&i).is_ok();
                assert!(was || !meets(b, origin, dir, f64::from(t_max), 0.0), "box {i} is missed");
                assert!(!was || meets(b, origin, dir, f64::from(t_max) * 1.00001, 1e-5 * size));
            }
        }
    }
}

/// An origin that is only known to an error meets whatever the exact one may meet.
#[test]
fn an_origins_error_widens_the_boxes() {
    let boxes = [Aabb { min: Vec3::ZERO, max: Vec3::ONE }];
    let tree = Bvh::build(&boxes);
    for (origin, dir) in [
        (Vec3::new(-0.01, 0.5, -1.0), Vec3::Z),
        (Vec3::new(0.5, 1.01, 2.0), Vec3::NEG_Z),
        (Vec3::new(0.5, 0.5, 1.01), Vec3::Z),
    ] {
        assert!(visited(&tree, &ray(origin, dir), 10.0).is_empty());
        assert_eq!(visited(&tree, &BoxRay::new(origin, Vec3::splat(0.02), dir), 10.0), [0]);
    }
}

#[test]
fn nearer_boxes_come_first_and_a_hit_hides_those_behind() {
    let boxes: Vec<Aabb> = (0..1000)
        .map(|i| Vec3::new(0.0, 0.0, ((i * 389) % 1000) as f32))
        .map(|p| Aabb { min: p - 0.25, max: p + 0.25 })
        .collect();
    let tree = Bvh::build(&boxes);
    let mut seen = Vec::new();
    tree.nearest(&ray(Vec3::new(0.0, 0.0, -10.0), Vec3::Z), f32::INFINITY, |i, _| {
        seen.push((i * 389) % 1000);
        (seen.len() == 20).then_some(0.5 + 10.0 + 18.5)
    });
    assert_eq!(seen, (0..20).collect::<Vec<_>>());
}

#[test]
fn any_stops_at_the_first_yes() {
    let boxes = vec![Aabb { min: Vec3::ZERO, max: Vec3::ONE }; 100];
    let tree = Bvh::build(&boxes);
    let mut visits = 0;
    let yes = tree.any(&ray(Vec3::splat(0.5), Vec3::Z), 1.0, |_| {
        visits += 1;
        visits == 3
    });
    assert!(yes && visits == 3);
}

#[test]
fn nothing_empty_boxes_and_a_hundred_thousand_copies_build() {
    let r = ray(Vec3::new(0.5, 0.5, -1.0), Vec3::Z);
    let none = Bvh::build(&[]);
    none.validate(&[]).unwrap();
    assert!(visited(&none, &r, 1e9).is_empty());
    let hollow =
        [Aabb::EMPTY, Aabb { min: Vec3::NAN, max: Vec3::ONE }, Aabb { min: Vec3::ZERO, max: Vec3::ONE }];
    let tree = Bvh::build(&hollow);
    tree.validate(&hollow).unwrap();
    assert_eq!(visited(&tree, &r, 1e9), [2]);
    let copies = vec![hollow[2]; 100_000];
    let tree = Bvh::build(&copies);
    tree.validate(&copies).unwrap();
    assert_eq!(visited(&tree, &r, 1e9), (0..100_000).collect::<Vec<_>>());
}

/// Boxes in one another, each a little smaller than the last: splits peel them off one at a time, which is as deep
/// as a tree gets, and walks there outgrow the fixed stack.
#[test]
fn the_deepest_trees_are_walked_to_the_end() {
    let boxes: Vec<Aabb> = (0..2000)
        .map(|i| 0.96f32.powi(i))
        .map(|s| Aabb { min: Vec3::splat(-s), max: Vec3::splat(s * 2.0) })
        .collect();
    let tree = Bvh::build(&boxes);
    tree.validate(&boxes).unwrap();
    assert_eq!(visited(&tree, &ray(Vec3::ZERO, Vec3::ONE), 1e9), (0..2000).collect::<Vec<_>>());
}

/// The walls of a bowl are in the root, however many blades grow in it: else all nodes down to theirs would be as
/// large as the bowl, and entered by every ray.
#[test]
fn what_is_as_large_as_everything_is_near_the_root() {
    let mut rng = Rng(12);
    let cube = |half: f32| Aabb { min: Vec3::splat(-half), max: Vec3::splat(half) };
    // On a table.
    let mut boxes = vec![Aabb { min: Vec3::new(-9.0, -1.1, -9.0), max: Vec3::new(9.0, -1.0, 9.0) }];
    for _ in 0..5000 {
        let p = rng.cube() * rng.cube() * Vec3::new(0.9, 0.3, 0.9);
        boxes.push(Aabb { min: p - Vec3::new(0.01, 0.06, 0.01), max: p + Vec3::new(0.01, 0.06, 0.01) });
    }
    boxes.insert(1234, cube(1.0));
    boxes.push(cube(0.98));
    let tree = Bvh::build(&boxes);
    tree.validate(&boxes).expect("a sound tree");
    let in_root: Vec<_> = Node(&tree.nodes[0]).filled().map(|(_, _, child)| child).collect();
    assert!(in_root.contains(&Child::Leaf(1234)) && in_root.contains(&Child::Leaf(5002)), "{in_root:?}");
    let wide = |(_, bounds, child): (usize, Aabb, Child)| {
        matches!(child, Child::Node(_)) && (bounds.max - bounds.min).max_element() > 1.9
    };
    let nodes = tree.nodes.iter().flat_map(|rows| Node(rows).filled()).filter(|&c| wide(c)).count();
    assert_eq!(nodes, 0, "nodes as wide as the bowl");
}

/// Plates of two thirds of the height that is left above them: one at a time is large in what is left, and setting
/// each apart from all above it would make a tree as deep as the tower.
#[test]
fn a_tower_of_plates_makes_no_tower_of_nodes() {
    let n = 60_000;
    let plate = |k: u32| {
        let left = (n - k) as f32 / n as f32 * 4.0;
        let half = Vec3::new(left / 3.0, 0.0, left / 3.0);
        let at = Vec3::new(0.0, 4.0 - left, 0.0);
        Aabb { min: at - half, max: at + half }
    };
    let boxes: Vec<Aabb> = (0..n).map(plate).collect();
    Bvh::build(&boxes).validate(&boxes).expect("a sound tree");
}
