//! The program as its caller sees it: exit codes, streams and files.

use assert_cmd::Command;
use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};
use tempfile::TempDir;

const SCENE: &str = r#"(
    camera: (eye: (0, 1, 5), target: (0, 0, 0)),
    image: (width: 24, height: 16),
    render: (passes: 2),
    materials: { "white": (diffuse: (0.8, 0.8, 0.8)) },
    lights: { "lamp": point(position: (0, 4, 3), intensity: (20, 20, 20)) },
    objects: [ (shape: sphere(radius: 1), material: "white") ],
)"#;

/// A folder with `scene.ron` in it.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("scene.ron"), SCENE).expect("written");
    folder
}

/// The program in `folder`, with nothing of the environment that changes messages.
fn terrarium(folder: &TempDir) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_terrarium"));
    command.current_dir(folder.path()).timeout(Duration::from_secs(60));
    for name in ["NO_COLOR", "CLICOLOR_FORCE", "SOURCE_DATE_EPOCH"] {
        command.env_remove(name);
    }
    command
}

struct Outcome {
    code: Option<i32>,
    stdout: Vec<u8>,
    stderr: String,
}

fn run(folder: &TempDir, arguments: &str) -> Outcome {
    run_with(folder, arguments, "")
}

fn run_with(folder: &TempDir, arguments: &str, input: &str) -> Outcome {
    let output =
        terrarium(folder).args(arguments.split(' ')).write_stdin(input).output().expect("the program runs");
    let stderr = String::from_utf8(output.stderr).expect("messages are UTF-8");
    assert!(!stderr.contains("panicked"), "{stderr}");
    Outcome { code: output.status.code(), stdout: output.stdout, stderr }
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .expect("the folder")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

fn is_exr(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01])
        && exr::prelude::read_all_flat_layers_from_file(temporary(bytes).path()).is_ok()
}

fn is_png(bytes: &[u8]) -> bool {
    image::load_from_memory_with_format(bytes, image::ImageFormat::Png).is_ok()
}

fn temporary(bytes: &[u8]) -> tempfile::NamedTempFile {
    let file = tempfile::NamedTempFile::new().expect("a temporary file");
    fs::write(file.path(), bytes).expect("written");
    file
}

#[test]
fn one_render_writes_several_images_and_says_so() {
    let folder = folder();
    let done = run(&folder, "render scene.ron -o a.exr -o b.png -o c.PNG --threads 2");
    assert_eq!(done.code, Some(0), "{}", done.stderr);
    assert_eq!(names(folder.path()), ["a.exr", "b.png", "c.PNG", "scene.ron"]);
    let read = |name: &str| fs::read(folder.path().join(name)).expect("an image");
    assert!(is_exr(&read("a.exr")) && is_png(&read("b.png")));
    assert_eq!(read("b.png"), read("c.PNG"));
    assert!(done.stdout.is_empty());
    assert!(done.stderr.starts_with("scene.ron: 24 × 16 pixels, 2 passes, 2 threads\n"), "{}", done.stderr);
    assert!(done.stderr.contains("wrote a.exr, b.png, c.PNG"));
    assert!(!done.stderr.contains(['\r', '\x1b']), "drawn over or coloured off a terminal");
}

#[test]
fn quiet_renders_say_nothing_and_the_arguments_reach_the_image() {
    let folder = folder();
    let done = run(&folder, "render scene.ron -o a.exr -q --passes 3 --seed 9 --tile 8 --aov depth,normal");
    assert_eq!((done.code, done.stderr.as_str()), (Some(0), ""));
    let (json, channels) = provenance(&folder.path().join("a.exr"));
    assert_eq!((&json["passes"], &json["seed"]), (&3.into(), &9.into()));
    assert!(channels > 3 && json["objects"].is_null());
}

/// What an EXR says of its making, and its number of channels.
fn provenance(path: &Path) -> (serde_json::Value, usize) {
    let file = exr::prelude::read_first_flat_layer_from_file(path).expect("an EXR");
    let key = exr::prelude::Text::from(terrarium::output::exr::ATTRIBUTE);
    let json = file.layer_data.attributes.other.get(&key).and_then(|value| value.to_text().ok());
    let json = json.expect("the provenance").to_string();
    (serde_json::from_str(&json).expect("JSON"), file.layer_data.channel_data.list.len())
}

#[test]
fn the_numbers_of_objects_have_names_in_the_image() {
    let folder = folder();
    let call = "render scene.ron -o a.exr -q --aov object_id --set objects.0.name=ball";
    let done = run(&folder, call);
    assert_eq!((done.code, done.stderr.as_str()), (Some(0), ""));
    let (json, _) = provenance(&folder.path().join("a.exr"));
    assert_eq!(json["objects"], serde_json::json!({ "1": "ball" }));
}

#[test]
fn cut_paths_are_told_once() {
    let folder = folder();
    let call = "render scene.ron -o a.exr --set materials.white=(reflection:1) \
                --set objects.0.shape=sphere(radius:9) --set render.max_depth=3";
    let done = terrarium(&folder).args(call.split_whitespace()).output().expect("the program runs");
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert_eq!(done.status.code(), Some(0), "{said}");
    assert_eq!(said.matches("were cut").count(), 1, "{said}");
}

#[test]
fn the_image_goes_to_standard_output_alone() {
    let folder = folder();
    let exr = run(&folder, "render scene.ron -o -");
    assert!(exr.code == Some(0) && is_exr(&exr.stdout));
    let png = run(&folder, "render scene.ron -o - --format png --progress json");
    assert!(png.code == Some(0) && is_png(&png.stdout));
    let both = run(&folder, "render scene.ron -o - --stats -");
    assert_eq!((both.code, both.stdout.len()), (Some(2), 0));
    assert_eq!(names(folder.path()), ["scene.ron"]);
}

#[test]
fn a_scene_comes_from_standard_input_if_its_format_is_named() {
    let folder = folder();
    let done = run_with(&folder, "render - --scene-format ron -o a.png", SCENE);
    assert_eq!(done.code, Some(0), "{}", done.stderr);
    let unnamed = run_with(&folder, "render - -o b.png", SCENE);
    assert_eq!(unnamed.code, Some(2));
    assert!(unnamed.stderr.contains("--scene-format"));
}

#[test]
fn wrong_calls_are_code_2_and_named() {
    let folder = folder();
    for (arguments, named) in [
        ("render scene.ron", "--output"),
        ("render scene.ron -o a.jpg", ".exr or .png"),
        ("render scene.ron -o a.exr -o ./a.exr", "twice"),
        ("render scene.ron -o - -o -", "twice"),
        ("render scene.ron -o a.exr --aov normals", "`normal`"),
        ("render scene.ron -o a.exr --threads 0", "1..=1024"),
        ("render scene.ron -o a.exr --passes 0", "--passes"),
        ("render scene.ron -o a.exr -q -v", "--verbose"),
        ("render scene.ron -o a.exr --stats a.exr", "two purposes"),
        ("render scene.ron -o a.exr --depfile scene.ron", "two purposes"),
        ("render scene.ron -o - --depfile d", "file"),
        ("rendr scene.ron", "'render'"),
        ("convert scene.ron scene.yaml", ".ron or .toml"),
        ("convert scene.ron -", "--to"),
    ] {
        let done = run(&folder, arguments);
        assert_eq!(done.code, Some(2), "{arguments}: {}", done.stderr);
        assert!(done.stderr.contains(named), "{arguments}: {}", done.stderr);
        assert!(done.stdout.is_empty(), "{arguments}");
    }
    assert_eq!(names(folder.path()), ["scene.ron"]);
}

#[test]
fn an_invalid_scene_is_code_2_and_a_missing_one_code_3() {
    let folder = folder();
    fs::write(folder.path().join("wrong.ron"), "(camera: (eye: 3))").expect("written");
    fs::write(folder.path().join("a.exr"), "old").expect("written");
    for command in ["render wrong.ron -o a.exr", "check wrong.ron", "convert wrong.ron b.toml"] {
        let done = run(&folder, command);
        assert_eq!(done.code, Some(2), "{command}: {}", done.stderr);
        assert!(done.stderr.contains("wrong.ron"), "{}", done.stderr);
    }
    for command in ["render missing.ron -o a.exr", "check missing.ron", "convert missing.ron b.toml"] {
        let done = run(&folder, command);
        assert_eq!(done.code, Some(3), "{command}: {}", done.stderr);
        assert!(done.stderr.contains("missing.ron"), "{}", done.stderr);
    }
    assert_eq!(run(&folder, "render scene.ron -o a.exr --set image.widht=3").code, Some(2));
    assert_eq!(fs::read_to_string(folder.path().join("a.exr")).ok().as_deref(), Some("old"));
    assert_eq!(names(folder.path()), ["a.exr", "scene.ron", "wrong.ron"]);
}

#[test]
fn an_output_that_cannot_be_written_is_code_4_before_the_first_ray() {
    let folder = folder();
    fs::create_dir(folder.path().join("folder.exr")).expect("made");
    let locked = folder.path().join("locked.png");
    fs::write(&locked, "old").expect("written");
    let mut permissions = fs::metadata(&locked).expect("there").permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&locked, permissions).expect("set");
    for arguments in [
        "-o missing/a.exr",
        "-o folder.exr",
        "-o good.exr -o locked.png",
        "-o scene.ron/a.exr",
        "-o good.exr --stats missing/s.json",
        "-o good.exr --depfile missing/d",
    ] {
        let began = Instant::now();
        let call = format!("render scene.ron --passes 4000000000 {arguments}");
        let done = run(&folder, &call);
        assert_eq!(done.code, Some(4), "{arguments}: {}", done.stderr);
        assert!(done.stderr.contains("can't write"), "{}", done.stderr);
        assert!(began.elapsed() < Duration::from_secs(5), "{arguments} took {:?}", began.elapsed());
    }
    assert_eq!(names(folder.path()), ["folder.exr", "locked.png", "scene.ron"]);
    assert_eq!(fs::read_to_string(&locked).ok().as_deref(), Some("old"));
}

#[test]
fn json_progress_is_one_object_a_line_and_ends_when_the_image_has_its_name() {
    let folder = folder();
    let done = run(&folder, "render scene.ron -o a.exr --progress json -q");
    let lines: Vec<serde_json::Value> =
        done.stderr.lines().map(|line| serde_json::from_str(line).expect("an object")).collect();
    let (last, others) = lines.split_last().expect("lines");
    assert_eq!((&last["v"], &last["stage"], last["done"].as_f64()), (&1.into(), &"done".into(), Some(1.0)));
    for line in others.iter().filter(|line| line["note"].is_null()) {
        assert!(line["done"].as_f64().is_some_and(|done| (0.0..1.0).contains(&done)), "{line}");
    }
    assert!(others.iter().any(|line| line["stage"] == "write"));
}

#[test]
fn statistics_and_dependencies_are_written() {
    let folder = folder();
    let done = run(&folder, "render scene.ron -o a.exr -o b.png --stats s.json --depfile a.d");
    assert_eq!(done.code, Some(0), "{}", done.stderr);
    let stats = fs::read_to_string(folder.path().join("s.json")).expect("statistics");
    let stats: serde_json::Value = serde_json::from_str(&stats).expect("JSON");
    assert_eq!((&stats["width"], &stats["outputs"][1]), (&24.into(), &"b.png".into()));
    for key in ["seconds", "stages", "rays", "memory", "rare_events", "truncated_paths", "clamped_pixels"] {
        assert!(!stats[key].is_null(), "{key} is missing");
    }
    let rules = fs::read_to_string(folder.path().join("a.d")).expect("dependencies");
    assert!(rules.starts_with("a.exr b.png:") && rules.contains("\nscene.ron:\n"), "{rules}");
    let printed = run(&folder, "render scene.ron -o a.exr -q --stats -");
    assert!(serde_json::from_slice::<serde_json::Value>(&printed.stdout).is_ok());
}

#[test]
fn the_same_render_is_the_same_file_and_a_stamp_follows_the_given_date() {
    let folder = folder();
    for name in ["a", "b"] {
        assert_eq!(run(&folder, &format!("render scene.ron -q -o {name}.exr -o {name}.png")).code, Some(0));
    }
    let read = |name: &str| fs::read(folder.path().join(name)).expect("an image");
    assert!(read("a.exr") == read("b.exr") && read("a.png") == read("b.png"));
    let stamped = |epoch: &str, name: &str| {
        let call = ["render", "scene.ron", "-q", "--stamp", "-o", name];
        terrarium(&folder).args(call).env("SOURCE_DATE_EPOCH", epoch).output().expect("the program runs")
    };
    assert!(
        stamped("1700000000", "c.exr").status.success() && stamped("1700000000", "d.exr").status.success()
    );
    assert_eq!(read("c.exr"), read("d.exr"));
    assert!(read("c.exr").windows(19).any(|text| text == b"2023:11:14 22:13:20"));
    assert_eq!(stamped("yesterday", "e.exr").status.code(), Some(2));
}

#[test]
fn converting_there_and_back_keeps_the_scene() {
    let folder = folder();
    assert_eq!(run(&folder, "convert scene.ron scene2.toml").code, Some(0));
    let toml = run(&folder, "convert scene.ron - --to toml");
    assert_eq!(fs::read(folder.path().join("scene2.toml")).ok(), Some(toml.stdout));
    assert_eq!(run(&folder, "convert scene2.toml back.ron").code, Some(0));
    let first = run(&folder, "convert scene.ron - --to ron");
    assert_eq!(fs::read(folder.path().join("back.ron")).ok(), Some(first.stdout));
}

#[test]
fn converting_keeps_includes_and_paths_as_written() {
    let folder = folder();
    let parts = r#"(definitions: { "tree": (shape: mesh(path: "tree.obj")) })"#;
    fs::write(folder.path().join("parts.ron"), parts).expect("written");
    assert_eq!(run(&folder, "convert parts.ron parts.toml").code, Some(0));
    let toml = fs::read_to_string(folder.path().join("parts.toml")).expect("written");
    assert!(toml.contains("path = \"tree.obj\""), "{toml}");
    fs::write(folder.path().join("whole.toml"), "include = [\"parts.toml\"]\n").expect("written");
    let whole = run(&folder, "convert whole.toml - --to ron");
    assert!(String::from_utf8_lossy(&whole.stdout).contains("include: [\"parts.toml\"]"));
}

#[test]
fn check_judges_every_scene_and_answers_machines_in_json() {
    let folder = folder();
    fs::write(folder.path().join("wrong.ron"), "(camera: (eye: 3))").expect("written");
    let text = run(&folder, "check scene.ron wrong.ron");
    assert_eq!((text.code, text.stdout.len()), (Some(2), 0));
    assert!(text.stderr.contains("scene.ron: valid") && text.stderr.contains("wrong.ron: invalid"));
    let json = run(&folder, "check scene.ron wrong.ron --format json");
    assert_eq!((json.code, json.stderr.as_str()), (Some(2), ""));
    let json: serde_json::Value = serde_json::from_slice(&json.stdout).expect("JSON");
    assert_eq!((&json[0]["valid"], &json[1]["valid"]), (&true.into(), &false.into()));
    assert!(json[1]["diagnostics"].as_array().is_some_and(|list| !list.is_empty()));
    assert_eq!(run(&folder, "check scene.ron").code, Some(0));
}

#[test]
fn help_version_schema_and_completions_are_printed_to_standard_output() {
    let folder = folder();
    for (arguments, expected) in [
        ("--help", "Exit codes:"),
        ("render --help", "Examples:"),
        ("--version", concat!("terrarium ", env!("CARGO_PKG_VERSION"))),
        ("schema", "\"properties\""),
        ("completions bash", "_terrarium"),
        ("completions zsh", "#compdef terrarium"),
        ("completions fish", "complete -c terrarium"),
    ] {
        let done = run(&folder, arguments);
        assert_eq!((done.code, done.stderr.as_str()), (Some(0), ""), "{arguments}");
        assert!(String::from_utf8_lossy(&done.stdout).contains(expected), "{arguments}");
    }
}

#[test]
fn colour_is_kept_for_terminals_unless_it_is_asked_for() {
    let folder = folder();
    let colored = |arguments: &str, name: &str, value: &str| {
        let done = terrarium(&folder).args(arguments.split(' ')).env(name, value).output().expect("runs");
        String::from_utf8_lossy(&done.stderr).contains('\x1b')
    };
    let call = "render scene.ron -o a.jpg";
    assert!(!colored(call, "TERM", "xterm"));
    assert!(colored(call, "CLICOLOR_FORCE", "1"));
    assert!(colored(&format!("{call} --color always"), "NO_COLOR", "1"));
    assert!(!colored(&format!("{call} --color never"), "CLICOLOR_FORCE", "1"));
}

#[cfg(unix)]
#[test]
fn a_reader_that_goes_away_is_no_panic() {
    let folder = folder();
    let pipes =
        [("schema | head -c 1", 0), ("completions bash | true", 0), ("render scene.ron -o - | true", 4)];
    for (call, code) in pipes {
        let script = format!("'{}' {call}; exit ${{PIPESTATUS[0]}}", env!("CARGO_BIN_EXE_terrarium"));
        let run =
            std::process::Command::new("bash").args(["-c", &script]).current_dir(folder.path()).output();
        let Ok(run) = run else { return };
        let stderr = String::from_utf8_lossy(&run.stderr);
        // what fits into the pipe before the reader leaves is written without an error
        assert!([Some(0), Some(code)].contains(&run.status.code()), "{call}: {stderr}");
        assert!(!stderr.contains("panic"), "{call}: {stderr}");
    }
}

#[test]
fn a_killed_render_leaves_the_old_file_or_the_whole_new_one() {
    let folder = folder();
    let target = folder.path().join("a.exr");
    for delay_ms in [0, 3, 10, 20, 40, 80] {
        fs::write(&target, "old").expect("written");
        let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_terrarium"))
            .args(["render", "scene.ron", "-o", "a.exr", "--set", "image.width=400"])
            .current_dir(folder.path())
            .stderr(Stdio::null())
            .spawn()
            .expect("the program starts");
        std::thread::sleep(Duration::from_millis(delay_ms));
        child.kill().expect("killed");
        child.wait().expect("gone");
        let found = fs::read(&target).expect("the target is there");
        assert!(found == b"old" || is_exr(&found), "half a file after {delay_ms} ms");
    }
}
