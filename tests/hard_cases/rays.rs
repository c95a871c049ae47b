//! Rays along axes, in the planes of boxes' faces, with zeros of both signs.

use super::record::{Record, row};
use terrarium::build::bvh::{BoxRay, Bvh};
use terrarium::math::{Aabb, DVec3, Ray, Vec3};
use terrarium::optics::{Cuboid, Shape};

/// Whether the exact ray meets the box at t ≥ 0: small integers and halves, in which nothing is rounded.
fn meets(b: &Aabb, origin: Vec3, dir: Vec3) -> bool {
    let (mut first, mut last) = (0.0f64, f64::INFINITY);
    for k in 0..3 {
        let (lo, hi) = (f64::from(b.min[k]), f64::from(b.max[k]));
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

/// The boxes that the tree visits, by both of its walks.
fn visited(tree: &Bvh, origin: Vec3, dir: Vec3) -> [Vec<u32>; 2] {
    let ray = BoxRay::new(origin, Vec3::ZERO, dir);
    let [mut nearest, mut any] = [Vec::new(), Vec::new()];
    tree.nearest(&ray, f32::INFINITY, |i, _| {
        nearest.push(i);
        None
    });
    tree.any(&ray, f32::INFINITY, |i| {
        any.push(i);
        false
    });
    [nearest, any].map(|mut list| {
        list.sort_unstable();
        list
    })
}

const PLACES: [f32; 12] = [-5.0, -4.0, -3.0, -2.0, -1.0, 0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0];

/// Every direction along axes and diagonals with every origin below, on, inside and above the boxes' faces on
/// each axis. Calls `each` with origin and direction.
fn every_ray(mut each: impl FnMut(Vec3, Vec3)) {
    let pick = |n: usize, base: usize, digit: u32| n / base.pow(digit) % base;
    for direction in (0..27).filter(|&n| n != 13) {
        let dir = Vec3::from_array([0, 1, 2].map(|k| pick(direction, 3, k) as f32 - 1.0));
        for n in 0..PLACES.len().pow(3) {
            each(Vec3::from_array([0, 1, 2].map(|k| PLACES[pick(n, PLACES.len(), k)])), dir);
        }
    }
}

fn boxes() -> Vec<Aabb> {
    [(0.0, 1.0), (2.0, 3.0), (1.0, 1.0), (-4.0, -2.0)]
        .map(|(a, b)| Aabb { min: Vec3::splat(a), max: Vec3::splat(b) })
        .to_vec()
}

fn negative_zeros(dir: Vec3) -> Vec3 {
    Vec3::select(dir.cmpeq(Vec3::ZERO), Vec3::splat(-0.0), dir)
}

#[test]
fn h08_rays_in_faces() {
    row("H8", |row| {
        let boxes = boxes();
        let tree = Bvh::build(&boxes);
        let (mut wrong, mut rays) = (0, 0);
        every_ray(|origin, dir| {
            let expected: Vec<u32> =
                (0..).zip(&boxes).filter(|(_, b)| meets(b, origin, dir)).map(|(i, _)| i).collect();
            wrong += u64::from(visited(&tree, origin, dir) != [expected.clone(), expected]);
            rays += 1;
        });
        row.none("rays for which the tree's boxes are not those of brute force", wrong, rays);
        far_away(row);
        let (mut wrong, mut rays) = (0, 0);
        every_box_ray(|found, expected, _| {
            wrong += u64::from(found != expected);
            rays += 1;
        });
        row.none("rays that meet the shape `box` elsewhere than comparisons say", wrong, rays);
    });
}

/// Metres from the origin, where single precision resolves an eighth: halves are exact, and what pads a face by
/// the roundings of a distance of a few metres moves nothing, so that rays lie in the faces to the last bit.
const FAR: f32 = 1_048_576.0;

/// Where a slab is left out for its 0·∞ a box may be entered in vain, but none that is met may be missed.
fn far_away(row: &mut Record) {
    let boxes: Vec<Aabb> = boxes()
        .iter()
        .map(|b| Aabb { min: b.min + Vec3::splat(FAR), max: b.max + Vec3::splat(FAR) })
        .collect();
    let tree = Bvh::build(&boxes);
    let (mut missed, mut met, mut entered) = (0, 0, 0);
    every_ray(|origin, dir| {
        let origin = origin + Vec3::splat(FAR);
        for dir in [dir, negative_zeros(dir)] {
            let found = visited(&tree, origin, dir);
            for (i, _) in (0..).zip(&boxes).filter(|(_, b)| meets(b, origin, dir)) {
                missed += found.iter().filter(|list| !list.contains(&i)).count() as u64;
                met += 2;
            }
            entered += found.iter().map(Vec::len).sum::<usize>() as u64;
        }
    });
    row.none("boxes 2^20 m from the origin that a ray meets and the tree does not enter", missed, met);
    row.at_most("boxes that it enters there, over those that are met", entered as f64 / met as f64, 1.4);
}

#[test]
fn h09_negative_zero() {
    row("H9", |row| {
        let tree = Bvh::build(&boxes());
        let (mut wrong, mut rays) = (0, 0);
        every_ray(|origin, dir| {
            let minus = negative_zeros(dir);
            rays += u64::from(dir.to_array() != [1.0; 3]);
            wrong += u64::from(visited(&tree, origin, minus) != visited(&tree, origin, dir));
        });
        row.none("rays for which −0 visits other boxes than +0", wrong, rays);
        let (mut wrong, mut rays) = (0, 0);
        every_box_ray(|found, _, positive| {
            wrong += u64::from(found != positive);
            rays += 1;
        });
        row.none("rays that meet the shape `box` elsewhere with −0 than with +0", wrong, rays);
    });
}

/// The shape `box` of side 2 under rays of all signs of directions, zeros of both signs included, from below to
/// above on each axis: t as found, as stepping finds it, and as found with the zeros positive.
fn every_box_ray(mut each: impl FnMut(Option<f64>, Option<f64>, Option<f64>)) {
    let cuboid = Shape::Cuboid(Cuboid::new(DVec3::splat(2.0), DVec3::ZERO));
    let product = |list: &[f64]| -> Vec<DVec3> {
        let pairs = |a: f64| list.iter().flat_map(move |&b| list.iter().map(move |&c| DVec3::new(a, b, c)));
        list.iter().flat_map(|&a| pairs(a)).collect()
    };
    let t = |origin: DVec3, dir: DVec3| cuboid.nearest(&Ray { origin, dir }, 0.0, f64::INFINITY).map(|h| h.t);
    for dir in product(&[-1.0, -0.0, 0.0, 1.0]).into_iter().filter(|d| *d != DVec3::ZERO) {
        for origin in product(&[-2.0, -1.0, 0.25, 1.0, 2.0]) {
            // All coordinates are quarters, so that stepping by eighths is exact.
            let inside = |i: i32| (origin + dir * (f64::from(i) / 8.0)).abs().max_element() <= 1.0;
            let steps: Vec<i32> = (-64..=64).filter(|&i| inside(i)).collect();
            // The line's part in the closed box, if it is longer than a point.
            let span = steps.first().zip(steps.last()).filter(|(a, b)| a < b);
            let expected = span.and_then(|(&a, &b)| [a, b].into_iter().find(|&i| i > 0));
            each(t(origin, dir), expected.map(|i| f64::from(i) / 8.0), t(origin, dir + DVec3::ZERO));
        }
    }
}
