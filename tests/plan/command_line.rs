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

fn program(folder: &TempDir, arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_terrarium"))
        .current_dir(folder.path())
        .args(arguments)
        .output()
        .expect("the program runs");
    let text = |bytes| String::from_utf8(bytes).expect("messages are UTF-8");
    (output.status.code(), text(output.stdout), text(output.stderr))
}

fn folder(scenes: &[(&str, String)]) -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    scenes.iter().for_each(|(name, text)| fs::write(folder.path().join(name), text).expect("written"));
    folder
}

/// A normal map's file is not needed where normal maps are left out; nor is the sky's.
#[test]
fn files_of_what_is_left_out_may_be_missing() {
    let text = SCENE
        .replace("(diffuse: 0.8)", r#"(diffuse: 0.8, normal_map: (texture: "bricks"))"#)
        .replace("materials:", r#"textures: { "bricks": image(path: "none.png") }, materials:"#)
        .replace("lights: {", r#"lights: { "sky": environment(map: image(path: "none.exr")),"#);
    let folder = folder(&[("scene.ron", text)]);
    let (code, _, said) =
        program(&folder, &["render", "scene.ron", "-o", "a.exr", "--without", "normal_maps"]);
    assert!(code == Some(3) && said.contains("error: lights.sky"), "{said}");
    let left_out = ["--without", "normal_maps,environment"];
    for command in [&["render", "scene.ron", "-o", "a.exr"][..], &["plan", "scene.ron"]] {
        let (code, _, said) = program(&folder, &[command, &left_out].concat());
        assert!(code == Some(0), "{said}");
        assert!(said.contains("warning: textures.bricks.image.path"), "{said}");
        assert!(said.contains("warning: lights.sky.environment.map.image.path"), "{said}");
    }
    // the sky is not what is shown
    let only = ["plan", "scene.ron", "--without", "normal_maps", "--only", "direct"];
    let (code, _, said) = program(&folder, &only);
    assert!(code == Some(0) && said.contains("warning: lights.sky.environment.map.image.path"), "{said}");
    let (code, ..) =
        program(&folder, &["plan", "scene.ron", "--without", "normal_maps", "--only", "reflection"]);
    assert_eq!(code, Some(3));
}

/// What only the placed objects tell of an override is told too.
#[test]
fn overrides_that_find_nothing_are_told() {
    let away = SCENE
        .replace(
            "point(position: (0, 4, 3), intensity: 20)",
            "spot(position: (0, 4, 3), target: (0, 9, 3), intensity: 9, inner_deg: 5, outer_deg: 6)",
        )
        .replace("image:", "photons: off, image:");
    let folder = folder(&[("scene.ron", away)]);
    let (_, plan, said) = program(&folder, &["plan", "scene.ron", "--with", "caustics"]);
    assert!(
        plan.contains("note: --with caustics adds nothing: `lamp`: its cone meets no specular object"),
        "{plan}{said}"
    );
    let on = ["--set", "photons=progressive()"];
    let (_, plan, said) =
        program(&folder, &[&["plan", "scene.ron", "--without", "caustics"][..], &on].concat());
    assert!(plan.contains("note: --without caustics leaves out nothing"), "{plan}{said}");
}

#[test]
fn a_bad_scene_stops_no_other_plan() {
    let folder = folder(&[("a.ron", "(camera: 1)".to_owned()), ("b.ron", SCENE.to_owned())]);
    let (code, json, said) = program(&folder, &["plan", "a.ron", "b.ron", "none.ron", "--json"]);
    assert_eq!(code, Some(3), "{said}");
    let found: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!((found[0]["exit_code"].as_u64(), found[2]["exit_code"].as_u64()), (Some(2), Some(3)));
    assert!(found[1]["decisions"].is_array());
    let (code, _, said) = program(&folder, &["plan", "-", "-", "--scene-format", "ron"]);
    assert!(code == Some(2) && said.contains("once"), "{said}");
}

/// Names that would move the cursor are told, not obeyed.
#[test]
fn names_cannot_write_to_the_terminal() {
    let text = SCENE.replace("\"lamp\"", "\"la\\u{1b}[2Jmp\"");
    let folder = folder(&[("scene.ron", text)]);
    let (code, plan, said) = program(&folder, &["plan", "scene.ron"]);
    assert_eq!(code, Some(0), "{said}");
    assert!(!plan.contains('\u{1b}') && plan.contains("la\\u{1b}[2Jmp"), "{plan}");
}

/// The error that a plan foretells is the one that the render has, within a third.
#[test]
fn plans_foretell_the_error() {
    let folder = folder(&[("scene.ron", SCENE.replace("width: 12, height: 8", "width: 60, height: 40"))]);
    let plan = ["plan", "scene.ron", "--passes", "48", "--accuracy"];
    let (_, json, said) = program(&folder, &[&plan[..], &["--json"]].concat());
    let found: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let foretold = found["accuracy"]["error"].as_f64().expect("an error");
    let render = ["render", "scene.ron", "-o", "a.exr", "--passes", "48", "--stats", "-"];
    let (_, stats, _) = program(&folder, &render);
    let stats: serde_json::Value = serde_json::from_str(&stats).expect("JSON");
    let found = stats["accuracy"]["error"].as_f64().expect("an error");
    assert!((0.67..1.5).contains(&(foretold / found)), "{foretold} {found} {said}");
    let (_, text, _) = program(&folder, &plan);
    assert!(text.contains("after 48 passes") && text.contains("  next: "), "{text}");
    let (_, text, _) = program(&folder, &["plan", "scene.ron", "--passes", "1", "--accuracy"]);
    assert!(text.contains("tells nothing of it"), "{text}");
}
