//! The same mesh in all its forms, parts, far-away meshes, and the two readings against each other.

use super::*;

#[test]
fn a_cube_is_the_same_in_every_form_of_index() {
    type Form = (&'static str, bool, bool, Box<dyn Fn(i32, i32, i32) -> String>);
    let forms: [Form; 7] = [
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
                let [a, b, c] = p.map(glam::Vec3::from);
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
