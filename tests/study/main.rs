//! `terrarium study` as its caller sees it: what it writes, what it says, and that nothing is rendered twice.

mod files;
mod resume;

use assert_cmd::Command;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::time::Duration;
use tempfile::TempDir;

/// Without photons, so that a reference takes a blink.
pub const MATT: &str = r#"(
    camera: (eye: (0, 2, 5), target: (0, 0.5, 0), fov_deg: 40),
    image: (width: 32, height: 24),
    materials: { "white": (diffuse: 0.7), "red": (diffuse: (0.7, 0.1, 0.1)) },
    lights: { "lamp": sphere(center: (-2, 4, 2), radius: 0.8, radiance: 8) },
    objects: [
        (shape: quad(size: (8, 8)), material: "white"),
        (name: "ball", shape: sphere(radius: 0.7, center: (0, 0.7, 0)), material: "red"),
    ],
)"#;

pub struct Outcome {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

/// A folder with `scene.ron`.
pub fn folder(scene: &str) -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("scene.ron"), scene).expect("written");
    folder
}

/// The program in a folder.
pub fn terrarium(folder: &Path, arguments: &[&str]) -> Outcome {
    let output = Command::new(env!("CARGO_BIN_EXE_terrarium"))
        .current_dir(folder)
        .timeout(Duration::from_secs(60))
        .args(arguments)
        .output()
        .expect("the program runs");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8");
    Outcome { code: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr) }
}

/// A short study of `scene.ron` into `out`.
pub fn study(folder: &Path, more: &[&str]) -> Outcome {
    let mut arguments = vec!["study", "scene.ron", "-o", "out"];
    arguments.extend(more);
    for [option, value] in [["--ladder", "3"], ["--seeds", "2"], ["--time", "20s"]] {
        if !more.contains(&option) {
            arguments.extend([option, value]);
        }
    }
    terrarium(folder, &arguments)
}

pub fn json(folder: &Path) -> Value {
    let text = fs::read_to_string(folder.join("out/study.json")).expect("study.json");
    serde_json::from_str(&text).expect("JSON")
}

/// The rungs of a knob, in order.
pub fn rungs<'a>(study: &'a Value, knob: &str) -> Vec<&'a Value> {
    study["rungs"].as_array().expect("a list").iter().filter(|rung| rung["knob"] == knob).collect()
}
