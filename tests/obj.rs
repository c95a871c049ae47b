//! OBJ files as a scene's author meets them: every way to write the same mesh, polygons of every
//! kind, parts, far-away meshes, and files that are broken in every way we could think of.

use std::fs;
use std::io::{Cursor, Write};
use std::path::Path;
use std::time::{Duration, Instant};
use terrarium::build::obj::{self, ObjError, ObjMesh};

fn load(text: impl AsRef<[u8]>) -> Result<ObjMesh, ObjError> {
    obj::load_from(Cursor::new(text.as_ref()), Path::new("mesh.obj"))
}

fn reference(text: impl AsRef<[u8]>) -> Result<ObjMesh, ObjError> {
    obj::load_by_reference(Cursor::new(text.as_ref()), Path::new("mesh.obj"))
}

fn message(text: impl AsRef<[u8]>) -> String {
    load(text).expect_err("the file is broken").to_string()
}

/// Deterministic values for the fuzzing.
struct Dice(u64);

impl Dice {
    fn roll(&mut self, sides: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) % sides as u64) as usize
    }

    fn number(&mut self) -> f64 {
        (self.roll(20001) as f64 - 10000.0) / 1000.0
    }
}

type Soup = Vec<([[f32; 3]; 3], [[f32; 3]; 3], [[f32; 2]; 3], String, String)>;

/// The triangles with all that stands at their corners, free of how the vertices are numbered.
fn soup(mesh: &ObjMesh) -> Soup {
    let normal = |i: u32| mesh.normals.get(i as usize).copied().unwrap_or_default().to_array();
    let uv = |i: u32| mesh.uvs.get(i as usize).copied().unwrap_or_default().to_array();
    let part = |k: usize| &mesh.part_names[mesh.parts.get(k).copied().unwrap_or(0) as usize];
    let triangles = mesh.triangles.iter().enumerate();
    triangles
        .map(|(k, t)| {
            let positions = t.map(|i| mesh.positions[i as usize].to_array());
            (positions, t.map(normal), t.map(uv), part(k).group.clone(), part(k).material.clone())
        })
        .collect()
}

fn points(mesh: &ObjMesh) -> usize {
    let first = |i: usize| mesh.welded.is_empty() || mesh.welded[i] == i as u32;
    (0..mesh.positions.len()).filter(|&i| first(i)).count()
}

fn assert_same(a: &ObjMesh, b: &ObjMesh, text: &[u8]) {
    let text = String::from_utf8_lossy(text);
    assert_eq!(a.center, b.center, "{text}");
    assert_eq!(soup(a), soup(b), "{text}");
    assert_eq!(points(a), points(b), "{text}");
    assert_eq!((a.degenerate, a.part_names.clone()), (b.degenerate, b.part_names.clone()), "{text}");
}

fn area(mesh: &ObjMesh) -> f64 {
    let triangle = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize].as_dvec3());
        (b - a).cross(c - a).length() / 2.0
    };
    mesh.triangles.iter().map(triangle).sum()
}

/// Each way to write an index, of v, vt, vn, as corners of a cube's faces.
fn cube(corner: impl Fn(i32, i32, i32) -> String) -> String {
    let mut text = String::new();
    for k in 0..8 {
        text += &format!("v {} {} {}\n", k & 1, k >> 1 & 1, k >> 2 & 1);
    }
    text += "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
    text += "vn -1 0 0\nvn 1 0 0\nvn 0 -1 0\nvn 0 1 0\nvn 0 0 -1\nvn 0 0 1\n";
    let sides = [[1, 5, 7, 3], [2, 4, 8, 6], [1, 2, 6, 5], [3, 7, 8, 4], [1, 3, 4, 2], [5, 6, 8, 7]];
    for (n, side) in sides.iter().enumerate() {
        let words: Vec<String> =
            side.iter().enumerate().map(|(t, &v)| corner(v, t as i32 + 1, n as i32 + 1)).collect();
        text += &format!("f {}\n", words.join(" "));
    }
    text
}

#[test]
fn a_cube_is_the_same_in_every_form_of_index() {
    let forms: [(&str, bool, bool, Box<dyn Fn(i32, i32, i32) -> String>); 7] = [
        ("v", false, false, Box::new(|v, _, _| format!("{v}"))),
        ("v/vt", true, false, Box::new(|v, t, _| format!("{v}/{t}"))),
        ("v//vn", false, true, Box::new(|v, _, n| format!("{v}//{n}"))),
        ("v/vt/vn", true, true, Box::new(|v, t, n| format!("{v}/{t}/{n}"))),
        ("-v", false, false, Box::new(|v, _, _| format!("{}", v - 9))),
        ("-v//-vn", false, true, Box::new(|v, _, n| format!("{}//{}", v - 9, n - 7))),
        ("-v/-vt/-vn", true, true, Box::new(|v, t, n| format!("{}/{}/{}", v - 9, t - 5, n - 7))),
    ];
    let want = soup(&load(cube(&*forms[0].3)).unwrap());
    assert_eq!(want.len(), 12);
    for (name, has_uvs, has_normals, form) in &forms {
        for mesh in [load(cube(form)).unwrap(), reference(cube(form)).unwrap()] {
            let got = soup(&mesh);
            assert!(got.iter().zip(&want).all(|(a, b)| a.0 == b.0), "{name}");
            assert_eq!((mesh.uvs.is_empty(), mesh.normals.is_empty()), (!has_uvs, !has_normals), "{name}");
            assert_eq!(points(&mesh), 8, "{name}");
            assert!((area(&mesh) - 6.0).abs() < 1e-12);
            for (p, n, ..) in got.iter().filter(|_| *has_normals) {
                let [a, b, c] = p.map(|p| glam::Vec3::from(p));
                assert!(n.iter().all(|&n| (b - a).cross(c - a).normalize() == glam::Vec3::from(n)), "{name}");
            }
        }
    }
}

#[test]
fn a_corner_without_normal_or_uv_has_zero_there_and_keeps_the_others() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt .5 .25\nvn 0 0 9\nf 1/1/1 2//1 3\nf 2 4 3/1\n";
    for mesh in [load(text).unwrap(), reference(text).unwrap()] {
        let got = soup(&mesh);
        assert_eq!(got[0].1, [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0; 3]]);
        assert_eq!(got[0].2, [[0.5, 0.25], [0.0; 2], [0.0; 2]]);
        assert_eq!(got[1].1, [[0.0; 3]; 3]);
        assert_eq!(got[1].2, [[0.0; 2], [0.0; 2], [0.5, 0.25]]);
        assert!(
            mesh.warnings.iter().any(|w| w.starts_with("4 corners without a normal")),
            "{:?}",
            mesh.warnings
        );
    }
}

#[test]
fn normals_are_unit_whatever_their_length_and_those_without_direction_are_counted() {
    let text =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1e-300 0 0\nvn 0 1e300 0\nvn 0 0 0\nvn nan 0 1\nf 1//1 2//2 3//3\n";
    for mesh in [load(text).unwrap(), reference(text).unwrap()] {
        assert_eq!(soup(&mesh)[0].1, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0; 3]]);
        assert!(mesh.warnings[0].starts_with("2 normals are zero or not finite"), "{:?}", mesh.warnings);
    }
}

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

#[test]
fn parts_are_groups_and_materials_in_the_order_of_their_first_face() {
    let text = "mtllib nowhere.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\no empty\ng leaf  of tree\nusemtl green\nf 1 2 3\n\
        usemtl dark green\nf 1 2 4\nf 2 3 4\ng\nusemtl green\nf 1 3 4\ng leaf  of tree\nf 4 2 1\n";
    for mesh in [load(text).unwrap(), reference(text).unwrap()] {
        let names: Vec<_> = mesh.part_names.iter().map(|p| (p.group.as_str(), p.material.as_str())).collect();
        assert_eq!(names, [("leaf  of tree", "green"), ("leaf  of tree", "dark green"), ("", "green")]);
        assert_eq!(points(&mesh), 4, "parts share their vertices");
    }
    assert_eq!(load(text).unwrap().parts, [0, 1, 1, 2, 0]);
    let one = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    assert_eq!((one.parts.len(), one.part_names.len()), (0, 1));
}

#[test]
fn a_mesh_a_thousand_kilometres_away_keeps_its_micrometres() {
    let (mut text, at) = (String::new(), 1e6);
    let offset = |i: usize| i as f64 * 1e-6;
    for i in 0..100 {
        text += &format!("v {:.7} {:.7} {:.7}\n", at + offset(i), -at + offset(i * i % 89), 3.0 * at);
    }
    text += &(1..=98).map(|i| format!("f {i} {} {}\n", i + 1, i + 2)).collect::<String>();
    for mesh in [load(&text).unwrap(), reference(&text).unwrap()] {
        for t in &mesh.triangles {
            for (a, b) in [(t[0], t[1]), (t[1], t[2])] {
                let got = (mesh.positions[b as usize] - mesh.positions[a as usize]).x as f64;
                let want = (b as f64 - a as f64) * 1e-6;
                assert!((got / want - 1.0).abs() < 1e-3, "{got} for {want}");
            }
        }
        let first = mesh.center + mesh.positions[0].as_dvec3();
        assert!((first.x - at).abs() < 1e-8 && (first.z - 3.0 * at).abs() < 1e-8, "{first}");
    }
}

#[test]
fn a_stray_vertex_does_not_move_the_centre() {
    let mesh = load("v 1e9 1e9 1e9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 4\n").unwrap();
    assert_eq!(mesh.center.to_array(), [0.5, 0.5, 0.0]);
    assert_eq!(mesh.positions.len(), 3);
}

#[test]
fn degenerate_triangles_are_dropped_and_counted() {
    let sound = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.125 0.25 0.375\nv 0.25 0.5 0.75\nv 0.5 1 1.5\nf 1 2 3\n";
    let mut text = sound.to_owned();
    for i in 0..1000 {
        text += ["f 1 1 2\n", "f 3 3 3\n", "f 4 5 6\n"][i % 3];
    }
    let (mesh, want) = (load(&text).unwrap(), load(sound).unwrap());
    assert_eq!(mesh.degenerate, 1000);
    assert_eq!(mesh.warnings, ["1000 degenerate triangles dropped"]);
    assert_eq!(mesh.triangles, want.triangles);
    assert!(message("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n").contains("has no area"));
}

#[test]
fn ends_of_line_and_marks_and_continuations_and_comments_change_nothing() {
    let plain = cube(|v, t, n| format!("{v}/{t}/{n}"));
    let want = soup(&load(&plain).unwrap());
    let continued = plain.replace("f ", "f \\\n  ").replace("v 0 ", "v 0\\\r\n ");
    let variants = [
        plain.replace('\n', "\r\n"),
        format!("\u{feff}{plain}"),
        plain.trim_end().to_owned(),
        continued,
        plain.replace('\n', " # a remark \\ \n"),
        plain.replace('\n', "\n# path C:\\\n\n \t\n"),
        plain.replace(' ', "\t  "),
        plain.replace("v 1 ", "v 1e0 ").replace("v 0 ", "v -0.0000 "),
        plain.replace("vt 1 1", "vt 1 1 0"),
        plain
            .lines()
            .map(|l| if l.starts_with("v ") { format!("{l} 1 0.5 0.25\n") } else { format!("{l}\n") })
            .collect(),
        plain
            .lines()
            .map(|l| if l.starts_with("v ") { format!("{l} 1\n") } else { format!("{l}\n") })
            .collect(),
    ];
    for text in variants {
        let mesh = load(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert_eq!(soup(&mesh), want, "{text}");
        assert_eq!(mesh.warnings, [""; 0]);
    }
}

#[test]
fn statements_that_are_not_read_are_told() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2 3\nvp 1\ncurv2 1 2\n";
    assert_eq!(load(text).unwrap().warnings, ["3 statements ignored, the first `l` in line 5"]);
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\ns 1\nf 1 2 3\ns 2\nf 3 2 1\n";
    assert_eq!(load(text).unwrap().warnings, ["smoothing groups are ignored"]);
}

#[test]
fn the_parallel_reading_gives_what_the_reference_gives() {
    let mut dice = Dice(1);
    for round in 0..400 {
        let (n, unique) = (3 + dice.roll(40), dice.roll(2) == 0);
        let (forms, polygons, named) = (dice.roll(5), dice.roll(2) == 0, dice.roll(2) == 0);
        let mut text = String::new();
        for _ in 0..n {
            text += &format!("v {} {} {:e}\n", dice.number(), dice.number(), dice.number());
            text += &format!(
                "vt {} {}\nvn {} {} {}\n",
                dice.number(),
                dice.roll(2),
                dice.number(),
                dice.roll(2),
                dice.roll(2)
            );
        }
        for _ in 0..dice.roll(60) + 1 {
            if named && dice.roll(4) == 0 {
                text += &format!("{} {}\n", ["g", "o", "usemtl", "s"][dice.roll(4)], dice.roll(3));
            }
            text += "f";
            let corners = if polygons { 3 + dice.roll(5) } else { 3 };
            for _ in 0..corners {
                let v = dice.roll(n) + 1;
                let (t, k) = if unique { (v, v) } else { (dice.roll(n) + 1, dice.roll(n) + 1) };
                let form = if forms == 4 { dice.roll(4) } else { forms };
                text +=
                    &[format!(" {v}"), format!(" {v}/{t}"), format!(" {v}//{k}"), format!(" {v}/{t}/{k}")]
                        [form];
            }
            text += "\n";
        }
        match (load(&text), reference(&text)) {
            (Ok(a), Ok(b)) => {
                assert_same(&a, &b, text.as_bytes());
                assert_eq!(a.warnings, b.warnings, "round {round}\n{text}");
            }
            (a, b) => {
                assert_eq!(a.map(|_| ()).map_err(|e| e.to_string()), b.map(|_| ()).map_err(|e| e.to_string()))
            }
        }
    }
}

#[test]
fn a_file_of_many_blocks_gives_what_the_reference_gives() {
    let mut dice = Dice(2);
    let mut text = String::new();
    let n = 170_000;
    for _ in 0..n {
        text += &format!("v {} {} {}\n", dice.number(), dice.number(), dice.number());
        text += &format!("vt {} {}\nvn {} 1 0\n", dice.number(), dice.number(), dice.number());
    }
    for i in 0..n - 2 {
        if i % 1000 == 0 {
            text += &format!("g {}\nusemtl {}\n", dice.roll(20), dice.roll(2));
        }
        // Normals appear late, uvs in some parts only, quads here and there.
        let (a, b, c) = (i + 1, i + 2, i + 3);
        text += &match (i > 150_000, i / 5000 % 2, i % 997) {
            (true, _, _) => format!("f {a}/{b}/{c} {b}/{a}/{c} {c}/{b}/{a}\n"),
            (_, 1, _) => format!("f {a}/{a} {b}/{b} {c}/{c}\n"),
            (_, _, 0) => format!("f {a} {b} {c} {}\n", dice.roll(n) + 1),
            _ => format!("f {a} {b} {c}\n"),
        };
    }
    assert!(text.len() > 9 << 20, "more than two blocks");
    assert_same(&load(&text).unwrap(), &reference(&text).unwrap(), b"(a large file)");
}

#[test]
fn fifty_thousand_normals_at_one_position_are_no_matter() {
    let mut text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n".to_owned();
    for i in 0..50_000 {
        text += &format!("vn 1 {i} 0\nf 1//{0} 2//{0} 3//{0}\nf 3//{0} 2//{0} 1//{0}\n", i + 1);
    }
    let start = Instant::now();
    let mesh = load(&text).unwrap();
    assert!(start.elapsed() < Duration::from_secs(2), "{:?}", start.elapsed());
    assert_eq!((mesh.positions.len(), points(&mesh)), (150_000, 3));
}

#[test]
fn every_mistake_is_told_with_its_line() {
    let head = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n";
    let cases = [
        ("f 0 1 2", "mesh.obj:6: index 0 of `v`: indices count from 1"),
        ("f 1 2 -99", "mesh.obj:6: index -99 is out of range: there are 3 `v` before it"),
        ("f 1 2 2147483648", "mesh.obj:6: index 2147483648 is out of range: the file has 3 `v`"),
        (
            "f 1 2 18446744073709551617",
            "mesh.obj:6: index 18446744073709551617 is out of range: there are 3 `v` before it",
        ),
        ("f 1 2 4", "mesh.obj:6: index 4 is out of range: the file has 3 `v`"),
        ("f 1/1 2/2 3/1", "mesh.obj:6: index 2 is out of range: the file has 1 `vt`"),
        (
            "f 1//1 2//1 3//6148914691236517206",
            "mesh.obj:6: index 6148914691236517206 is out of range: there are 1 `vn` before it",
        ),
        ("f 1/0 2 3", "mesh.obj:6: index 0 of `vt`: indices count from 1"),
        ("f 1 1", "mesh.obj:6: a face needs 3 corners or more, and this one has 2"),
        ("f", "mesh.obj:6: a face needs 3 corners or more, and this one has 0"),
        ("f 1 2 x", "mesh.obj:6: `x` is not a corner: expected v, v/vt, v//vn or v/vt/vn"),
        ("f 1/1/1/1 2 3", "mesh.obj:6: `1/1/1/1` is not a corner: expected v, v/vt, v//vn or v/vt/vn"),
        ("f /1 2 3", "mesh.obj:6: corner `/1` has no position"),
        ("v 1 2", "mesh.obj:6: a position needs 3 numbers, and this one has 2"),
        ("v 1 2 3 4 5 6 7 8", "mesh.obj:6: a position has at most 7 numbers"),
        ("v 1 2 nan", "mesh.obj:6: a position is not finite"),
        ("v 1 1e999 0", "mesh.obj:6: a position is not finite"),
        ("v 1 2 3 0", "mesh.obj:6: a position is not finite"),
        ("v 1 2 3,5", "mesh.obj:6: `3,5` is not a number"),
        ("vn 1 2", "mesh.obj:6: a normal needs 3 numbers, and this one has 2"),
        ("vt", "mesh.obj:6: a texture coordinate needs 1 number, and this one has 0"),
        ("\0", "mesh.obj:6: is not text"),
        ("v 1e300 0 0\nf 1 2 4", "mesh.obj: the mesh spans 1e300, more than can be rendered"),
    ];
    for (line, want) in cases {
        let text = format!("{head}{line}\nf 1 2 3\n");
        assert_eq!(message(&text), want);
        let long = format!("# {}\n", "-".repeat(200)).repeat(40_000);
        let far = message(format!("{long}{text}"));
        assert_eq!(far.replace(":40006:", ":6:"), want, "the same in the third block");
    }
    assert_eq!(message("v 0 0 0\n"), "mesh.obj: has no faces");
    assert_eq!(message(""), "mesh.obj: has no faces");
    assert_eq!(message("ply\nformat ascii 1.0\n"), "mesh.obj: has no faces: is it an OBJ file?");
    assert_eq!(message(b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"), "mesh.obj:3: is not text");
    let late = format!("v 0 0 0\nv 1 0 0\nf 1 \\\n 2 \\\n -9\n");
    assert_eq!(message(late), "mesh.obj:3: index -9 is out of range: there are 2 `v` before it");
}

#[test]
fn broken_files_give_an_error_or_a_sound_mesh_and_never_a_panic() {
    let sound =
        cube(|v, t, n| format!("{v}/{t}/{n}")) + "g a\nusemtl b\nf -1//-1 -2//-1 -3//-1 \\\n -4//-1\ns 1\n";
    let check = |text: &[u8]| {
        let start = Instant::now();
        let both = [load(text), reference(text)];
        assert!(start.elapsed() < Duration::from_secs(1), "{}", String::from_utf8_lossy(text));
        if let [Ok(a), Ok(b)] = &both {
            assert_same(a, b, text);
        }
        assert_eq!(both[0].is_ok(), both[1].is_ok(), "{}", String::from_utf8_lossy(text));
        for mesh in both.into_iter().flatten() {
            let n = mesh.positions.len();
            assert!(!mesh.triangles.is_empty() && mesh.positions.iter().all(|p| p.is_finite()));
            assert!(mesh.triangles.as_flattened().iter().all(|&i| (i as usize) < n));
            assert!([0, n].contains(&mesh.normals.len()) && [0, n].contains(&mesh.uvs.len()));
            assert!([0, n].contains(&mesh.welded.len()) && mesh.welded.iter().all(|&i| (i as usize) < n));
            assert!([0, mesh.triangles.len()].contains(&mesh.parts.len()));
            assert!(mesh.parts.iter().all(|&part| (part as usize) < mesh.part_names.len()));
            assert!(mesh.normals.iter().all(|v| *v == glam::Vec3::ZERO || (v.length() - 1.0).abs() < 1e-5));
            assert!(mesh.uvs.iter().all(|uv| uv.is_finite()));
        }
    };
    for end in 0..sound.len() {
        check(&sound.as_bytes()[..end]);
    }
    let mut dice = Dice(3);
    let pieces = [
        "0",
        "-",
        "-99",
        "2147483648",
        "99999999999999999999",
        "nan",
        "inf",
        "1e999",
        "-1e308",
        "1e-320",
        "/",
        "//",
        "\\\n",
        "\r",
        "\0",
        "\u{feff}",
        "f 1 1\n",
        "v 1\n",
        "g\n",
        "usemtl\n",
        "#",
        "f 1 2 3 4 5 6 7 8 2 4 1\n",
        "v 3e38 -3e38 0\n",
        "call other.obj\n",
        "\u{661}",
        "f -9223372036854775808 1 2\n",
    ];
    for _ in 0..6000 {
        let mut text = sound.clone().into_bytes();
        for _ in 0..1 + dice.roll(4) {
            let at = dice.roll(text.len());
            match dice.roll(4) {
                0 => text[at] = dice.roll(256) as u8,
                1 => drop(text.remove(at)),
                2 => drop(text.splice(at..at, pieces[dice.roll(pieces.len())].bytes())),
                _ => {
                    let line =
                        text.split_inclusive(|&b| b == b'\n').nth(dice.roll(24)).unwrap_or_default().to_vec();
                    text.extend(line);
                }
            }
        }
        check(&text);
    }
    for _ in 0..300 {
        let garbage: Vec<u8> = (0..dice.roll(3000)).map(|_| dice.roll(256) as u8).collect();
        check(&garbage);
    }
}

#[test]
fn names_in_no_known_encoding_are_kept_readable() {
    let text = b"v 0 0 0\nv 1 0 0\nv 0 1 0\ng B\xe4um#1\nf 1 2 3\n";
    for mesh in [load(text).unwrap(), reference(text).unwrap()] {
        assert_eq!(mesh.part_names[0].group, "B\u{fffd}um#1");
    }
}

#[test]
fn a_path_that_is_no_regular_file_is_refused_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let missing = obj::load(&folder.path().join("none.obj")).unwrap_err();
    assert!(matches!(missing, ObjError::Io { .. }) && missing.to_string().contains("none.obj"), "{missing}");
    assert!(obj::load(folder.path()).unwrap_err().to_string().ends_with("is a folder, not an OBJ file"));
    if cfg!(unix) {
        let endless = obj::load(Path::new("/dev/zero")).unwrap_err().to_string();
        assert_eq!(endless, "/dev/zero: is not a regular file");
        let fifo = folder.path().join("fifo.obj");
        if std::process::Command::new("mkfifo").arg(&fifo).status().is_ok_and(|status| status.success()) {
            assert!(obj::load(&fifo).unwrap_err().to_string().ends_with("is not a regular file"));
        }
    }
    let huge = folder.path().join("huge.obj");
    fs::File::create(&huge).unwrap().set_len(5 << 30).unwrap();
    let error = obj::load(&huge).unwrap_err();
    assert!(matches!(error, ObjError::NotSupported { .. }), "{error}");
    let sound = folder.path().join("sound.obj");
    fs::File::create(&sound).unwrap().write_all(cube(|v, _, _| v.to_string()).as_bytes()).unwrap();
    assert_eq!(obj::load(&sound).unwrap().triangles.len(), 12);
}
