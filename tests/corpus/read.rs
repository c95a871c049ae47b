//! The readers of everything that comes from outside, each fed bytes: none may panic, whatever the bytes are.
//!
//! Fuzzing calls these, and the test that replays what fuzzing has found.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use terrarium::build::{images, obj};
use terrarium::description::{Format, Scene, load_str, load_str_as_written, to_string};
use terrarium::output::depfile;

pub type Reader = fn(&[u8]);

/// The readers by the name of their folder.
pub const READERS: [(&str, Reader); 8] = [
    ("scene_ron", scene_ron),
    ("scene_toml", scene_toml),
    ("set", set),
    ("obj", mesh),
    ("png", png),
    ("jpeg", jpeg),
    ("exr", open_exr),
    ("depfile", dependencies),
];

/// A folder that is not there, so that a scene's files are not either.
const NOWHERE: &str = "/nonexistent";

pub fn scene_ron(bytes: &[u8]) {
    scene(bytes, Format::Ron);
}

pub fn scene_toml(bytes: &[u8]) {
    scene(bytes, Format::Toml);
}

/// Reads a scene with all of its checks; one that can be read can be written in both languages, and is then the
/// same.
fn scene(bytes: &[u8], format: Format) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let _ = load_str(text, format, Path::new(NOWHERE), &[]).map_err(|report| report.to_string());
    let Ok(scene) = load_str_as_written(text, format, &[]) else { return };
    let value = |scene: &Scene| serde_json::to_value(scene).expect("a scene is plain data");
    for format in [Format::Ron, Format::Toml] {
        let Ok(written) = to_string(&scene, format) else { continue };
        match load_str_as_written(&written, format, &[]) {
            Ok(again) => assert_eq!(value(&scene), value(&again), "{written}"),
            Err(report) => panic!("{report}\n{written}"),
        }
    }
}

/// A scene in which `--set` finds something of every kind.
const SCENE: &str = r#"(
    camera: (eye: (0, 1, 5), target: (0, 0, 0)),
    textures: { "t": checker(a: 0.2, b: 0.8, squares: (4, 4)) },
    materials: { "m": (diffuse: texture("t")), "glass": (transmission: 1, ior: 1.5) },
    lights: { "lamp": sphere(center: (0, 4, 3), radius: 1, radiance: 20) },
    objects: [(name: "ball", shape: sphere(radius: 1), material: "m", transform: [scale(2), translate((0, 1, 0))])],
)"#;

/// An argument of `--set`.
pub fn set(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let _ = load_str(SCENE, Format::Ron, Path::new(NOWHERE), &[text.to_owned()])
        .map_err(|report| report.to_string());
}

pub fn mesh(bytes: &[u8]) {
    if let Ok(mesh) = obj::load_from(std::io::Cursor::new(bytes), Path::new("mesh.obj")) {
        let n = mesh.positions.len() as u32;
        assert!(mesh.triangles.iter().flatten().all(|corner| *corner < n));
        assert!(mesh.positions.iter().all(|p| p.is_finite()));
    }
}

/// Small, so that none of them takes long.
const LIMITS: images::Limits = images::Limits { max_bytes: 1 << 24, max_side: 1 << 12 };

fn image(name: &str, bytes: &[u8]) {
    let _ = images::decode(Path::new(name), bytes, &LIMITS).map_err(|error| error.to_string());
}

pub fn png(bytes: &[u8]) {
    image("image.png", bytes);
}

pub fn jpeg(bytes: &[u8]) {
    image("image.jpg", bytes);
}

pub fn open_exr(bytes: &[u8]) {
    image("image.exr", bytes);
}

/// Paths with NUL between them, the first of them the image's: one rule for it, and one for each other.
pub fn dependencies(bytes: &[u8]) {
    let paths: Vec<PathBuf> = bytes.split(|b| *b == 0).map(path).collect();
    let paths: Vec<&Path> = paths.iter().map(PathBuf::as_path).collect();
    let Ok(rules) = depfile::rules(&paths[..1], &paths[1..]) else { return };
    // As names: `a` and `a/` are one path, and two names.
    let files: BTreeSet<&OsStr> = paths[1..].iter().map(|file| file.as_os_str()).collect();
    // The first rule goes over as many lines as there are files; the others are a line each, apart.
    assert_eq!(rules.lines().count(), 1 + 3 * files.len(), "{rules}");
}

#[cfg(unix)]
fn path(bytes: &[u8]) -> PathBuf {
    use std::os::unix::ffi::OsStrExt;
    OsStr::from_bytes(bytes).into()
}

#[cfg(not(unix))]
fn path(bytes: &[u8]) -> PathBuf {
    OsStr::new(String::from_utf8_lossy(bytes).as_ref()).into()
}
