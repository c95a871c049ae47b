//! Polygons into triangles.
//!
//! A fan from the first corner where all its triangles lie on the polygon's side (every convex
//! polygon without flat corners, and many others); else ear clipping (Meisters 1975) in the plane of
//! Newell's normal, which holds for concave polygons and those with a bridge to a hole. The area is
//! kept, and no corner is left on another triangle's edge as long as that can be avoided.

use crate::math::DVec3;

/// Most corners of a polygon that needs ear clipping, whose work grows with their square.
pub(super) const MAX_EARS: usize = 1024;

/// What became of a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cut {
    Whole,
    /// The outline crosses itself, so that no triangulation is right.
    Crossing,
    /// More than `MAX_EARS` corners, and concave.
    TooLarge,
}

/// Appends the triangles of a polygon, as indices into `points`.
pub(super) fn triangulate(points: &[DVec3], triangles: &mut Vec<[u32; 3]>) -> Cut {
    let fan = |i: usize| (points[i] - points[0]).cross(points[i + 1] - points[0]);
    let newell: DVec3 = (1..points.len() - 1).map(fan).sum();
    let all_front = (1..points.len() - 1).all(|i| fan(i).dot(newell) > 0.0);
    if all_front || points.len() == 3 {
        triangles.extend((1..points.len() as u32 - 1).map(|i| [0, i, i + 1]));
        return Cut::Whole;
    }
    if points.len() > MAX_EARS {
        return Cut::TooLarge;
    }
    let outline: Vec<[f64; 2]> = points.iter().map(|&p| flat(p, newell)).collect();
    clip_ears(&outline, triangles)
}

/// Drops the coordinate along which the normal is longest; counter-clockwise stays so.
fn flat(p: DVec3, normal: DVec3) -> [f64; 2] {
    let n = normal.abs();
    let (a, b, along) = if n.x >= n.y && n.x >= n.z {
        (p.y, p.z, normal.x)
    } else if n.y >= n.z {
        (p.z, p.x, normal.y)
    } else {
        (p.x, p.y, normal.z)
    };
    if along < 0.0 { [b, a] } else { [a, b] }
}

/// Twice the signed area of the triangle.
fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn clip_ears(outline: &[[f64; 2]], triangles: &mut Vec<[u32; 3]>) -> Cut {
    let mut ring: Vec<u32> = (0..outline.len() as u32).collect();
    let mut cut = Cut::Whole;
    let mut at = 0;
    while ring.len() > 3 {
        let n = ring.len();
        let candidates = || (at..at + n).map(|i| i % n);
        let ear = candidates().find(|&i| is_ear(outline, &ring, i, |area| area > 0.0));
        // Then flat corners; then whatever there is, because the outline crosses itself.
        let ear = ear.or_else(|| candidates().find(|&i| is_ear(outline, &ring, i, |area| area == 0.0)));
        if ear.is_none() {
            cut = Cut::Crossing;
        }
        let i = ear.unwrap_or(at % n);
        triangles.push([ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]]);
        ring.remove(i);
        at = i % (n - 1);
    }
    if turn(outline[ring[0] as usize], outline[ring[1] as usize], outline[ring[2] as usize]) < 0.0 {
        cut = Cut::Crossing;
    }
    triangles.push([ring[0], ring[1], ring[2]]);
    cut
}

fn is_ear(outline: &[[f64; 2]], ring: &[u32], i: usize, wanted: impl Fn(f64) -> bool) -> bool {
    let n = ring.len();
    let at = |k: usize| outline[ring[k % n] as usize];
    let (a, b, c) = (at(i + n - 1), at(i), at(i + 1));
    if !wanted(turn(a, b, c)) {
        return false;
    }
    // A corner at the same place as one of the ear's is a bridge's end, and does no harm.
    let inside = |p| turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
    !ring.iter().map(|&k| outline[k as usize]).any(|p| p != a && p != b && p != c && inside(p))
}
