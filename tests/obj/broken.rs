//! Broken files give an error with its line, in no time, and never a panic.

use super::*;
use std::fs;
use std::io::Write;
use std::time::{Duration, Instant};

#[test]
fn fifty_thousand_normals_at_one_position_are_no_matter() {
    let mut text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n".to_owned();
    for i in 0..50_000 {
        text += &format!("vn 1 {i} 0\nf 1//{0} 2//{0} 3//{0}\nf 3//{0} 2//{0} 1//{0}\n", i + 1);
    }
    // The best of three, as below.
    let quick = (0..3).any(|_| {
        let start = Instant::now();
        let mesh = load(&text).unwrap();
        assert_eq!((mesh.positions.len(), points(&mesh)), (150_000, 3));
        start.elapsed() < Duration::from_secs(2)
    });
    assert!(quick);
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
    let late = "v 0 0 0\nv 1 0 0\nf 1 \\\n 2 \\\n -9\n";
    assert_eq!(message(late), "mesh.obj:3: index -9 is out of range: there are 2 `v` before it");
}

#[test]
fn broken_files_give_an_error_or_a_sound_mesh_and_never_a_panic() {
    let sound =
        cube(|v, t, n| format!("{v}/{t}/{n}")) + "g a\nusemtl b\nf -1//-1 -2//-1 -3//-1 \\\n -4//-1\ns 1\n";
    let check = |text: &[u8]| {
        // The best of three: a busy machine may stop any one of them for longer.
        let mut both = [load(text), reference(text)];
        let quick = (0..3).any(|_| {
            let start = Instant::now();
            both = [load(text), reference(text)];
            start.elapsed() < Duration::from_secs(1)
        });
        assert!(quick, "{}", String::from_utf8_lossy(text));
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
    assert!(obj::load(folder.path()).unwrap_err().to_string().ends_with("it is a folder"));
    if cfg!(unix) {
        let endless = obj::load(Path::new("/dev/zero")).unwrap_err().to_string();
        assert_eq!(endless, "/dev/zero: it is not a regular file");
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
