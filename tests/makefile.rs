//! `make` over folders of scenes: only what changed, every failure named, odd names refused.
#![cfg(unix)]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

const SCENE: &str = r#"(
    camera: (eye: (0, 1, 5), target: (0, 0, 0)),
    image: (width: 16, height: 16),
    render: (passes: 1),
    include: ["parts/white.ron"],
    lights: { "lamp": point(position: (0, 4, 3), intensity: (20, 20, 20)) },
    objects: [ (shape: sphere(radius: 1), material: "white") ],
)"#;

/// A folder with two scenes, `scenes/a.ron` and `scenes/b.toml`; the first includes a file.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::create_dir_all(folder.path().join("scenes/parts")).expect("made");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("written");
    write("scenes/parts/white.ron", r#"(materials: { "white": (diffuse: (0.8, 0.8, 0.8)) })"#);
    write("scenes/a.ron", SCENE);
    write("scenes/b.toml", "[camera]\neye = [0, 1, 5]\ntarget = [0, 0, 0]\n[image]\nwidth = 8\nheight = 8\n");
    folder
}

/// Runs make, or nothing where there is no make.
fn make(folder: &Path, arguments: &[&str]) -> Option<Output> {
    let makefile = Path::new(env!("CARGO_MANIFEST_DIR")).join("Makefile");
    let program = format!("TERRARIUM={}", env!("CARGO_BIN_EXE_terrarium"));
    let mut command = Command::new("make");
    for name in ["MAKEFLAGS", "MAKELEVEL", "MFLAGS"] {
        command.env_remove(name);
    }
    command.current_dir(folder).arg("-f").arg(makefile).arg(program).args(arguments).output().ok()
}

fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

fn written(folder: &Path, name: &str) -> std::time::SystemTime {
    fs::metadata(folder.join(name)).and_then(|found| found.modified()).expect("an image")
}

#[test]
fn only_what_changed_is_rendered_again() {
    let folder = folder();
    let Some(first) = make(folder.path(), &["renders"]) else {
        eprintln!("skipped: no make");
        return;
    };
    assert!(first.status.success(), "{}", text(&first));
    let images = ["renders/a.exr", "renders/a.png", "renders/b.exr", "renders/b.png"];
    let times = || images.map(|name| written(folder.path(), name));
    let before = times();

    let second = make(folder.path(), &["renders"]).expect("make");
    assert!(second.status.success() && times() == before, "{}", text(&second));
    assert!(!text(&second).contains("wrote"), "{}", text(&second));

    fs::write(folder.path().join("scenes/parts/white.ron"), "(materials: { \"white\": () })")
        .expect("written");
    let third = make(folder.path(), &["renders"]).expect("make");
    let after = times();
    assert!(third.status.success() && text(&third).matches("wrote").count() == 1, "{}", text(&third));
    assert!(after[0] > before[0] && after[1] > before[1] && after[2..] == before[2..]);

    fs::remove_file(folder.path().join("renders/b.png")).expect("removed");
    let fourth = make(folder.path(), &["-j2", "renders"]).expect("make");
    assert!(fourth.status.success() && written(folder.path(), "renders/b.exr") == before[2]);
    assert!(folder.path().join("renders/b.png").exists(), "{}", text(&fourth));
}

#[test]
fn renders_takes_the_gallery_too_unless_a_folder_is_named() {
    let folder = folder();
    fs::create_dir_all(folder.path().join("scenes/gallery")).expect("made");
    let toml = fs::read_to_string(folder.path().join("scenes/b.toml")).expect("written above");
    fs::write(folder.path().join("scenes/gallery/c.toml"), &toml).expect("written");
    fs::write(folder.path().join("scenes/gallery/d.ron"), "(camera: 3)").expect("written");
    let Some(run) = make(folder.path(), &["renders", "SCENES=scenes", "OUT=one"]) else { return };
    assert!(run.status.success() && folder.path().join("one/a.png").exists(), "{}", text(&run));
    assert!(!folder.path().join("one/c.png").exists());
    let run = make(folder.path(), &["renders", "OUT=both"]).expect("make");
    assert!(!run.status.success() && text(&run).contains("failed: scenes/gallery/d.ron"), "{}", text(&run));
    assert!(folder.path().join("both/a.png").exists() && folder.path().join("both/c.exr").exists());

    fs::remove_file(folder.path().join("scenes/gallery/d.ron")).expect("removed");
    fs::remove_file(folder.path().join("both/c.png")).expect("removed");
    let run = make(folder.path(), &["renders", "OUT=both"]).expect("make");
    assert!(run.status.success() && folder.path().join("both/c.png").exists(), "{}", text(&run));
    fs::write(folder.path().join("scenes/gallery/a.toml"), &toml).expect("written");
    let run = make(folder.path(), &["renders", "OUT=third"]).expect("make");
    assert!(!run.status.success() && text(&run).contains("would be the same image"), "{}", text(&run));
}

#[test]
fn a_failing_scene_fails_the_batch_after_the_others_and_is_named() {
    let folder = folder();
    for name in ["0_first", "c_last"] {
        fs::write(folder.path().join(format!("scenes/{name}.ron")), "(camera: 3)").expect("written");
    }
    let Some(run) = make(folder.path(), &["renders", "OUT=other"]) else { return };
    assert!(!run.status.success());
    let text = text(&run);
    assert!(
        text.contains("failed: scenes/0_first.ron") && text.contains("failed: scenes/c_last.ron"),
        "{text}"
    );
    assert!(
        folder.path().join("other/a.png").exists() && folder.path().join("other/b.exr").exists(),
        "{text}"
    );
    assert!(!folder.path().join("other/c_last.exr").exists());
}

#[test]
fn names_that_make_cannot_handle_are_refused_and_twins_too() {
    for (name, expected) in
        [("my scene.ron", "rename it"), ("a$b.toml", "rename it"), ("a.toml", "would be the same image")]
    {
        let folder = folder();
        fs::write(folder.path().join("scenes").join(name), SCENE).expect("written");
        let Some(run) = make(folder.path(), &["renders"]) else { return };
        assert!(!run.status.success() && text(&run).contains(expected), "{name}: {}", text(&run));
        assert!(!folder.path().join("renders/a.exr").exists(), "{name}: something was rendered");
    }
    let folder = folder();
    let Some(run) = make(folder.path(), &["renders", "SCENES=missing"]) else { return };
    assert!(!run.status.success() && text(&run).contains("there is no folder missing"), "{}", text(&run));
}

#[test]
fn help_lists_every_target() {
    let folder = folder();
    let Some(run) = make(folder.path(), &["help"]) else { return };
    let makefile = include_str!("../Makefile");
    let all = makefile.lines().find_map(|line| line.strip_prefix(".PHONY: ")).expect("its targets");
    for target in all.split(' ').filter(|target| !["names", "FORCE"].contains(target)) {
        assert!(text(&run).lines().any(|line| line.starts_with(&format!("{target}: "))), "{target}");
    }
}

#[test]
fn a_turntable_renders_its_frames_once() {
    let folder = folder();
    let moving = SCENE.replace(
        "render:",
        "animation: (frames: 3, keys: { \"objects.0.shape.radius\": linear([(frame: 1, value: 1), (frame: 3, value: 2)]) }), render:",
    );
    fs::write(folder.path().join("scenes/terrarium.ron"), moving).expect("written");
    let call = ["turntable", "FRAMES=1-3:2", "TURN=--passes 1"];
    let Some(first) = make(folder.path(), &call) else { return };
    assert!(first.status.success(), "{}", text(&first));
    let times =
        || ["0001", "0003"].map(|frame| written(folder.path(), &format!("renders/turntable/{frame}.png")));
    let before = times();
    // where there is a program that makes films there is one
    let film = folder.path().join("renders/turntable.gif").exists();
    assert!(film || text(&first).contains("needs ffmpeg"), "{}", text(&first));
    let second = make(folder.path(), &call).expect("make");
    assert!(second.status.success() && times() == before, "{}", text(&second));
    assert_eq!(text(&second).matches("there already").count(), 2);
}
