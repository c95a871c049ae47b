//! Mistakes that only the files of a scene can tell: all of them in one run of `check` or `render`.

use super::{CAMERA, write};
use assert_cmd::Command;
use std::fs;
use std::path::Path;
use tempfile::TempDir;
use terrarium::build::{build, examine};
use terrarium::description::{Report, load};
use terrarium::plan::{Plan, Request};

const TRIANGLES: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\ng bark\nf 1 2 3\ng leaves\nf 3 2 1\n";

/// A folder with two good meshes, a white image, and files of every kind that are not what they should be.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder can be made");
    write(folder.path(), "tree.obj", TRIANGLES);
    write(folder.path(), "plain.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write(folder.path(), "broken.obj", "v 0 0 0\nv 1 0\nf 1 2 3\n");
    image::GrayImage::from_pixel(1, 1, image::Luma([255]))
        .save(folder.path().join("white.png"))
        .expect("an image can be written");
    for (name, bytes) in [
        ("broken.png", &b"\x89PNG\r\n\x1a\n and then nothing"[..]),
        ("broken.exr", &[0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0, 1]),
        ("not.png", b"GIF89a"),
    ] {
        fs::write(folder.path().join(name), bytes).expect("a file can be written");
    }
    folder
}

fn scene(folder: &TempDir, more: &str) -> std::path::PathBuf {
    write(folder.path(), "scene.ron", &format!("({CAMERA}, image: (width: 4, height: 4),\n{more}\n)"))
}

fn examined(path: &Path) -> Report {
    let loaded = load(path, &[]).unwrap_or_else(|report| panic!("{report}"));
    loaded.report(examine(&loaded.scene))
}

/// Headlines without the folder.
fn headlines(report: &Report, folder: &TempDir) -> Vec<String> {
    let here = format!("{}/", folder.path().display());
    report.diagnostics.iter().map(|d| d.headline().replace(&here, "")).collect()
}

const FULL_OF_MISTAKES: &str = r#"textures: { "a": image(path: "broken.png"), "b": image(path: "not.png"), "white": image(path: "white.png") },
materials: { "m": (diffuse: texture("a"), specular: texture("b")), "bright": (diffuse: texture("white"), specular: 0.5) },
lights: { "sky": environment(map: image(path: "broken.exr")) },
definitions: { "tree": (shape: mesh(path: "tree.obj", parts: { "leafs": "m", "bark": "m" })) },
objects: [(shape: mesh(path: "broken.obj"), material: "bright"),
(shape: mesh(path: "broken.obj"), material: "m"),
(shape: group(objects: [(shape: instance(of: "tree"))])),
]"#;

#[test]
fn everything_that_is_wrong_with_files_is_found_at_its_place() {
    let folder = folder();
    let report = examined(&scene(&folder, FULL_OF_MISTAKES));
    let found = headlines(&report, &folder);
    let expected = [
        "scene.ron:2:30: error: textures.a.image.path: broken.png: ",
        "scene.ron:2:62: error: textures.b.image.path: not.png: not supported: ",
        "scene.ron:3:78: error: materials.bright: material `bright` can send back 1.500 of the light",
        "scene.ron:4:47: error: lights.sky.environment.map.image.path: broken.exr: ",
        "scene.ron:5:24: error: definitions.tree: no `material` is given, here or by a group, and `parts` leaves out some of tree.obj: `leaves`",
        "scene.ron:5:73: error: definitions.tree.shape.mesh.parts.leafs: tree.obj has no part named `leafs`; did you mean `leaves`?; it has `bark`, `leaves`",
        "scene.ron:6:30: error: objects.0.shape.mesh.path: broken.obj:2: ",
    ];
    assert_eq!(found.len(), expected.len(), "{found:#?}");
    for (found, expected) in found.iter().zip(expected) {
        assert!(found.starts_with(expected), "{found}\n{expected}");
    }
    assert_eq!(report.exit_code(), 2);
}

#[test]
fn check_and_render_say_the_same_about_files() {
    let folder = folder();
    let run = |arguments: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_terrarium"));
        let done = command.current_dir(folder.path()).args(arguments.split(' ')).output().expect("it runs");
        (done.status.code(), String::from_utf8_lossy(&done.stderr).into_owned())
    };
    let unreadable = r#"materials: { "m": (diffuse: texture("a")) }, textures: { "a": image(path: "broken.png") },
        objects: [(shape: mesh(path: "broken.obj"), material: "m")]"#;
    for (text, code, errors) in [(FULL_OF_MISTAKES, 2, 7), (unreadable, 3, 2)] {
        scene(&folder, text);
        let (checked, said) = run("check scene.ron");
        let (rendered, repeated) = run("render scene.ron -o a.exr -q");
        assert_eq!((checked, rendered), (Some(code), Some(code)), "{said}\n{repeated}");
        let lines = |text: &str| {
            text.lines().filter(|l| l.contains(": error: ")).map(str::to_owned).collect::<Vec<_>>()
        };
        assert_eq!(lines(&said).len(), errors, "{said}");
        assert_eq!(lines(&said), lines(&repeated));
        assert!(!folder.path().join("a.exr").exists());
    }
    let (code, json) = run("check scene.ron --format json");
    assert_eq!((code, json.as_str()), (Some(3), ""));
}

#[test]
fn what_no_object_uses_is_not_read() {
    let folder = folder();
    let path = scene(
        &folder,
        r#"textures: { "a": image(path: "broken.png") }, materials: { "n": (diffuse: texture("a")), "m": () },
        definitions: { "d": (shape: mesh(path: "broken.obj"), material: "m") }, objects: [(shape: sphere(), material: "m")]"#,
    );
    assert_eq!(headlines(&examined(&path), &folder), Vec::<String>::new());
}

#[test]
fn a_mesh_whose_parts_are_all_named_needs_no_material() {
    let folder = folder();
    let mesh = |parts: &str| {
        format!(
            r#"materials: {{ "m": (diffuse: 0.5) }}, objects: [(shape: mesh(path: "tree.obj", parts: {parts}))]"#
        )
    };
    let path = scene(&folder, &mesh(r#"{ "leaves": "m", "bark": "m" }"#));
    assert_eq!(headlines(&examined(&path), &folder), Vec::<String>::new());
    let loaded = load(&path, &[]).unwrap_or_else(|report| panic!("{report}"));
    let built =
        build(&loaded.scene, &Plan::new(&loaded.scene, &Request::default()).expect("nothing is overridden"));
    assert_eq!(built.unwrap_or_else(|e| panic!("{e}")).world.bindings[0].len(), 2);

    let path = scene(&folder, &mesh(r#"{ "bark": "m" }"#));
    let expected = "scene.ron:2:47: error: objects.0: no `material` is given, here or by a group, and `parts` leaves out some of tree.obj: `leaves`";
    assert_eq!(headlines(&examined(&path), &folder), [expected]);
    let loaded = load(&path, &[]).unwrap_or_else(|report| panic!("{report}"));
    assert!(
        build(&loaded.scene, &Plan::new(&loaded.scene, &Request::default()).expect("nothing is overridden"))
            .is_err()
    );
}
