//! Polygons become triangles of the same area.

use super::*;

fn shoelace(outline: &[[f64; 2]]) -> f64 {
    let n = outline.len();
    let term = |i: usize| {
        let ([x, y], [u, v]) = (outline[i], outline[(i + 1) % n]);
        x * v - u * y
    };
    (0..n).map(term).sum::<f64>() / 2.0
}

/// The outline as one polygon, turned into some plane by a rotation about (1, 2, 3).
fn polygon(outline: &[[f64; 2]], turn: f64) -> String {
    let rotation = glam::DQuat::from_axis_angle(glam::DVec3::new(1.0, 2.0, 3.0).normalize(), turn);
    let mut text = String::new();
    for &[x, y] in outline {
        let p = rotation * glam::DVec3::new(x, y, 0.0);
        text += &format!("v {} {} {}\n", p.x, p.y, p.z);
    }
    text + "f" + &(1..=outline.len()).map(|i| format!(" {i}")).collect::<String>() + "\n"
}

#[test]
fn a_polygon_keeps_its_area_convex_or_not_in_any_plane() {
    let circle = |n: usize, r: fn(usize) -> f64| -> Vec<[f64; 2]> {
        let angle = |i: usize| i as f64 / n as f64 * std::f64::consts::TAU;
        (0..n).map(|i| [r(i) * angle(i).cos(), r(i) * angle(i).sin()]).collect()
    };
    // A comb whose first corner sees almost nothing of it.
    let mut comb = vec![[20.0, -1.0], [20.0, 0.0]];
    comb.extend((0..20).rev().map(|i| [i as f64, if i % 2 == 1 { 5.0 } else { 0.1 }]));
    comb.push([0.0, -1.0]);
    let outlines = [
        vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
        // Dents at each corner of a quad in turn.
        vec![[0.0, 0.0], [2.0, 0.0], [0.5, 0.5], [0.0, 2.0]],
        vec![[2.0, 0.0], [0.5, 0.5], [0.0, 2.0], [0.0, 0.0]],
        // An L, a U, and a square with corners on its edges.
        vec![[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]],
        vec![[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [2.0, 3.0], [2.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]],
        vec![[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [2.0, 2.0], [0.0, 2.0], [0.0, 1.0]],
        // A square with a square hole, joined by a bridge.
        vec![
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 4.0],
            [0.0, 4.0],
            [0.0, 0.0],
            [1.0, 1.0],
            [1.0, 3.0],
            [3.0, 3.0],
            [3.0, 1.0],
            [1.0, 1.0],
        ],
        circle(100, |_| 1.0),
        circle(60, |i| if i % 2 == 0 { 1.0 } else { 0.3 }),
        comb,
    ];
    for (k, outline) in outlines.iter().enumerate() {
        for turn in 0..12 {
            let mesh = load(polygon(outline, turn as f64 * 0.5)).unwrap();
            let want = shoelace(outline);
            assert!((area(&mesh) / want - 1.0).abs() < 1e-5, "outline {k}: {} for {want}", area(&mesh));
            assert_eq!(mesh.warnings, [""; 0], "outline {k}");
            assert_eq!(mesh.triangles.len(), outline.len() - 2, "outline {k}");
        }
    }
}

#[test]
fn a_polygon_that_crosses_itself_is_told() {
    let pentagram: Vec<[f64; 2]> =
        (0..5).map(|i| i as f64 * 0.4 * std::f64::consts::TAU).map(|a| [a.cos(), a.sin()]).collect();
    assert_eq!(load(polygon(&pentagram, 0.3)).unwrap().warnings, ["1 polygon crosses itself"]);
}

#[test]
fn a_concave_polygon_of_many_corners_is_refused_and_a_convex_one_is_not() {
    let ring = |n: usize, dent: f64| -> Vec<[f64; 2]> {
        let angle = |i: usize| i as f64 / n as f64 * std::f64::consts::TAU;
        (0..n)
            .map(|i| (angle(i), if i == n / 2 { dent } else { 1.0 }))
            .map(|(a, r)| [r * a.cos(), r * a.sin()])
            .collect()
    };
    assert_eq!(load(polygon(&ring(5000, 1.0), 0.0)).unwrap().triangles.len(), 4998);
    // The dent lies beyond what the first corner sees.
    let error = load(polygon(&ring(5000, -2.0), 0.0)).unwrap_err();
    assert!(matches!(error, ObjError::NotSupported { .. }), "{error}");
}
