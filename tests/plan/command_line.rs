//! `--without`, `--only` and `--with` as a user gives them.

use assert_cmd::Command;
use std::fs;
use tempfile::TempDir;

const SCENE: &str = r#"(
    camera: (eye: (0, 1, 5), target: (0, 0, 0)), image: (width: 12, height: 8), render: (passes: 1),
    materials: { "white": (diffuse: 0.8), "glass": (transmission: 1) },
    lights: { "lamp": point(position: (0, 4, 3), intensity: 20) },
    objects: [(shape: sphere(radius: 1), material: "glass"), (shape: quad(size: (9, 9)), material: "white")],
)"#;

struct Outcome {
    code: Option<i32>,
    stderr: String,
    folder: TempDir,
}

fn render(arguments: &[&str]) -> Outcome {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("scene.ron"), SCENE).expect("written");
    let output = Command::new(env!("CARGO_BIN_EXE_terrarium"))
        .current_dir(folder.path())
        .args(["render", "scene.ron", "-o", "a.exr", "-v"])
        .args(arguments)
        .output()
        .expect("the program runs");
    let stderr = String::from_utf8(output.stderr).expect("messages are UTF-8");
    Outcome { code: output.status.code(), stderr, folder }
}

#[test]
fn overrides_are_in_the_first_line_and_in_the_image() {
    let outcome = render(&["--without", "caustics,highlights", "--without", "shadows"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let first = outcome.stderr.lines().next().expect("a line");
    assert!(first.contains(", without caustics, highlights, shadows"), "{first}");
    assert!(outcome.stderr.contains("--without highlights leaves out nothing"), "{}", outcome.stderr);
    let image = fs::read(outcome.folder.path().join("a.exr")).expect("the image");
    let text = String::from_utf8_lossy(&image);
    assert!(text.contains("overrides: without caustics, highlights, shadows"));
    assert!(text.contains("caustics: off: left out (--without)"));
}

#[test]
fn an_unknown_effect_is_answered_with_the_nearest() {
    let outcome = render(&["--only", "caustic"]);
    assert_eq!(outcome.code, Some(2));
    assert!(outcome.stderr.contains("did you mean `caustics`?"), "{}", outcome.stderr);
}

#[test]
fn contradictions_are_refused_before_anything_is_rendered() {
    for arguments in [
        ["--without", "indirect", "--with", "indirect"],
        ["--only", "direct", "--with", "indirect"],
        ["--only", "shadows", "--seed", "1"],
        ["--without", "nested_media", "--seed", "1"],
        ["--with", "depth_of_field", "--seed", "1"],
    ] {
        let outcome = render(&arguments);
        assert_eq!(outcome.code, Some(2), "{arguments:?}: {}", outcome.stderr);
        assert!(!outcome.folder.path().join("a.exr").exists());
    }
}
