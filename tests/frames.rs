//! `render --frames`: one file a frame, finished ones left alone, one failure not the others', and no
//! flicker.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use std::time::{Duration, SystemTime};
use tempfile::TempDir;

/// A ball on its way below the floor, where no light and no eye gets, and a lamp that can be moved.
const SCENE: &str = r#"(
    camera: (eye: (0, 2, 5), target: (0, 0.5, 0)),
    image: (width: 24, height: 16),
    render: (passes: 4),
    animation: (
        frames: 6,
        keys: { "objects.mole.transform.0.translate": linear([(frame: 1, value: (0, -3, 0)), (frame: 6, value: (1, -3.5, 0))]) },
    ),
    materials: {
        "white": (diffuse: 0.8),
        "glass": (transmission: 1, ior: 1.5),
    },
    lights: { "lamp": sphere(center: (1, 4, 2), radius: 0.3, radiance: 40) },
    objects: [
        (shape: quad(size: (20, 20)), material: "white"),
        (shape: sphere(radius: 0.7), material: "glass", transform: [translate((0, 1, 0))]),
        (name: "mole", shape: sphere(radius: 0.4), material: "white", transform: [translate((0, 0, 0))]),
    ],
)"#;

fn folder(scene: &str) -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("scene.ron"), scene).expect("written");
    folder
}

struct Outcome {
    code: Option<i32>,
    stdout: String,
    stderr: String,
}

fn run(folder: &TempDir, arguments: &str) -> Outcome {
    let mut command = Command::new(env!("CARGO_BIN_EXE_terrarium"));
    command.current_dir(folder.path()).args(arguments.split(' ')).env_remove("NO_COLOR");
    let Output { status, stdout, stderr } = command.output().expect("the program runs");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("messages are UTF-8");
    let (stdout, stderr) = (text(stdout), text(stderr));
    assert!(!stderr.contains("panicked"), "{stderr}");
    Outcome { code: status.code(), stdout, stderr }
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// The picture's values, bit for bit.
fn bits(folder: &TempDir, name: &str) -> Vec<u32> {
    let image = terrarium::measure::read::load(&folder.path().join(name)).expect("an image");
    let colour = image.layers[0].colour().expect("a picture");
    colour.into_iter().flatten().map(|x| x.to_bits()).collect()
}

fn hash(folder: &TempDir, name: &str) -> String {
    let file = exr::prelude::read_first_flat_layer_from_file(folder.path().join(name)).expect("an EXR");
    let key = exr::prelude::Text::from(terrarium::output::exr::ATTRIBUTE);
    let json = file.layer_data.attributes.other.get(&key).and_then(|value| value.to_text().ok());
    let json: serde_json::Value =
        serde_json::from_str(&json.expect("the provenance").to_string()).expect("JSON");
    json["sceneHash"].as_str().expect("a hash").to_owned()
}

#[test]
fn what_stands_still_does_not_flicker() {
    let folder = folder(SCENE);
    let done = run(&folder, "render scene.ron -o ####.exr -o %02d.png --frames 1-6:2");
    assert_eq!(done.code, Some(0), "{}", done.stderr);
    let expected = ["0001.exr", "0003.exr", "0005.exr", "01.png", "03.png", "05.png", "scene.ron"];
    assert_eq!(names(folder.path()), expected);
    let first = bits(&folder, "0001.exr");
    assert!(first.iter().any(|x| *x != 0));
    for other in ["0003.exr", "0005.exr"] {
        assert_ne!(hash(&folder, "0001.exr"), hash(&folder, other));
        assert!(first == bits(&folder, other), "{other} differs from the first frame");
    }
    // without --frames it is the first one
    assert_eq!(run(&folder, "render scene.ron -q -o still.exr").code, Some(0));
    assert_eq!(fs::read(folder.path().join("still.exr")).ok(), fs::read(folder.path().join("0001.exr")).ok());
}

/// The showpiece turns from frame to frame; its picture is that of a scene without frames.
#[test]
fn the_first_frame_of_the_showpiece_is_the_still() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/terrarium.ron").display().to_string();
    let small = format!(
        "render {scene} -q --passes 1 --set image.width=48 --set image.height=27 --set photons=progressive(count:10000)"
    );
    let still = "--set animation.keys={} --set objects.terrarium.transform=[scale(0.2),rotate(axis:(0,1,0),deg:-15),translate((0,0.1594308,0))]";
    for call in ["-o first.exr", &format!("{still} -o still.exr"), "--frame 2 -o second.exr"] {
        let done = run(&folder, &format!("{small} {call}"));
        assert_eq!((done.code, done.stderr.as_str()), (Some(0), ""));
    }
    let [first, still, second] = ["first.exr", "still.exr", "second.exr"].map(|name| bits(&folder, name));
    assert!(first == still && first != second);
}

#[test]
fn finished_frames_are_left_and_others_are_not() {
    let folder = folder(SCENE);
    let lamp = "render scene.ron -o ####.exr --frames 1-3 --passes 2";
    assert_eq!(run(&folder, lamp).code, Some(0));
    let rendered = |call: &str| {
        let done = run(&folder, call);
        assert_eq!(done.code, Some(0), "{}", done.stderr);
        (done.stderr.matches("wrote ").count(), done.stderr.matches("there already").count())
    };
    assert_eq!(rendered(lamp), (0, 3));
    assert_eq!(rendered(&format!("{lamp} --again")), (3, 0));
    fs::remove_file(folder.path().join("0002.exr")).expect("removed");
    fs::write(folder.path().join("0003.exr"), "half a file").expect("written");
    assert_eq!(rendered(lamp), (2, 1));
    // whatever would change the picture makes another one
    for change in [
        "--passes 3",
        "--seed 7",
        "--set lights.lamp.radiance=30",
        "--without caustics",
        "--without shadows",
        "--aov depth",
        "--passes 0..3",
    ] {
        let call = format!("render scene.ron -o ####.exr --frames 1 {change}");
        assert_eq!(rendered(&call), (1, 0), "{change}");
        assert_eq!(rendered(&call), (0, 1), "{change} again");
    }
    // every output counts, PNG too
    let both = "render scene.ron -o ####.exr -o ####.png --frames 2-3 --passes 2";
    assert_eq!((rendered(both), rendered(both)), ((2, 0), (0, 2)));
    let png = "render scene.ron -o ####.png --frames 2-3 --passes 2";
    assert_eq!(rendered(png), (0, 2));
    // a part of the passes says only how many they were
    assert_eq!(rendered("render scene.ron -o ####.exr --frames 2 --passes 1..3"), (1, 0));
    // a render without --frames never asks what is there
    assert_eq!(rendered("render scene.ron -o 0001.exr --passes 2"), (1, 0));
}

#[test]
fn a_newer_mesh_makes_its_frames_anew() {
    let scene = r#"(camera: (eye: (0, 0, 5), target: (0, 0, 0)), image: (width: 8, height: 8), ambient: 1,
        materials: { "white": (diffuse: 0.5) }, objects: [(shape: mesh(path: "a.obj"), material: "white")])"#;
    let folder = folder(scene);
    let mesh = folder.path().join("a.obj");
    fs::write(&mesh, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("written");
    let call = "render scene.ron -o ##.exr --frames 1-2 --passes 1";
    let wrote = || run(&folder, call).stderr.matches("wrote ").count();
    assert_eq!((wrote(), wrote()), (2, 0));
    let file = fs::File::options().write(true).open(&mesh).expect("opened");
    file.set_modified(SystemTime::now() + Duration::from_secs(5)).expect("set");
    assert_eq!(wrote(), 2);
}

#[test]
fn a_failing_frame_does_not_stop_the_others_and_is_named() {
    let scene = SCENE.replace(
        "keys: {",
        "keys: { \"camera.fov_deg\": step([(frame: 1, value: 40), (frame: 2, value: -1), (frame: 3, value: 30), (frame: 5, value: 190)]),",
    );
    let folder = folder(&scene);
    let done = run(&folder, "render scene.ron -o ##.exr --frames 1-6 --passes 1");
    assert_eq!(done.code, Some(2), "{}", done.stderr);
    assert_eq!(names(folder.path()), ["01.exr", "03.exr", "04.exr", "scene.ron"]);
    assert!(done.stderr.contains("3 of 6 frames failed: 2, 5, 6"), "{}", done.stderr);
    // check finds both at once
    let check = run(&folder, "check scene.ron");
    assert_eq!(check.code, Some(2), "{}", check.stderr);
    assert!(
        check.stderr.contains("-1 is outside") && check.stderr.contains("190 is outside"),
        "{}",
        check.stderr
    );
    assert_eq!(run(&folder, "check scene.ron --frame 3").code, Some(0));
    assert_eq!(run(&folder, "plan scene.ron --frame 4 --passes 1").code, Some(0));
    assert_eq!(run(&folder, "plan scene.ron --frame 5 --passes 1").code, Some(2));
    // a scene is converted with all of its frames
    assert_eq!(run(&folder, "convert scene.ron a.toml").code, Some(0));
    assert!(
        fs::read_to_string(folder.path().join("a.toml")).is_ok_and(|text| text.contains("camera.fov_deg"))
    );
    assert_eq!(run(&folder, "convert scene.ron a.toml --frame 3").code, Some(2));
    // a file that cannot be written, and one that can
    fs::create_dir(folder.path().join("03.png")).expect("made");
    let done = run(&folder, "render scene.ron -o ##.png --frames 3-4 --passes 1");
    assert_eq!(done.code, Some(4), "{}", done.stderr);
    assert!(folder.path().join("04.png").exists() && done.stderr.contains("1 of 2 frames failed: 3"));
}

#[test]
fn wrong_calls_are_refused_before_anything_is_rendered() {
    let folder = folder(SCENE);
    for (arguments, named) in [
        ("--frames 1-3 -o a.exr", "a_####.exr"),
        ("--frames 1-3 -o -", "####"),
        ("--frames 1-3 -o #.exr --stats s.json", "s_####.json"),
        ("--frames 0 -o #.exr", "frame"),
        ("--frames 3-1 -o #.exr", "behind"),
        ("--frames 1-7 -o #.exr", "no frame 7"),
        ("--frame 7 -o #.exr", "no frame 7"),
        ("--frame 0 -o #.exr", "--frame"),
        ("--frames 1-2 --frame 1 -o #.exr", "--frame"),
        ("--frame-step 2 -o #.exr", "--frames"),
    ] {
        let done = run(&folder, &format!("render scene.ron {arguments}"));
        assert_eq!(done.code, Some(2), "{arguments}: {}", done.stderr);
        assert!(done.stderr.contains(named), "{arguments}: {}", done.stderr);
    }
    assert_eq!(names(folder.path()), ["scene.ron"]);
    let done =
        run(&folder, "render scene.ron --frames 1-6 --frame-step 3 -o #.exr --stats #.json -q --passes 1");
    assert_eq!((done.code, done.stderr.as_str()), (Some(0), ""));
    assert_eq!(names(folder.path()), ["1.exr", "1.json", "4.exr", "4.json", "scene.ron"]);
    let stats = fs::read_to_string(folder.path().join("4.json")).expect("statistics");
    let stats: serde_json::Value = serde_json::from_str(&stats).expect("JSON");
    assert_eq!((&stats["v"], &stats["frame"]), (&1.into(), &4.into()));
}

#[test]
fn json_progress_names_the_frame_and_is_done_when_its_file_has_its_name() {
    let folder = folder(SCENE);
    let done = run(&folder, "render scene.ron --frames 2-3 -o #.exr -q --progress json --passes 8");
    assert_eq!(done.code, Some(0), "{}", done.stderr);
    let lines: Vec<serde_json::Value> =
        done.stderr.lines().map(|line| serde_json::from_str(line).expect("an object")).collect();
    assert!(lines.iter().all(|line| line["v"] == 1 && [2, 3].map(Into::into).contains(&line["frame"])));
    for frame in [2, 3] {
        let stages: Vec<&serde_json::Value> =
            lines.iter().filter(|line| line["frame"] == frame && !line["stage"].is_null()).collect();
        let (last, others) = stages.split_last().expect("lines");
        assert_eq!((&last["stage"], &last["done"]), (&"done".into(), &1.0.into()));
        assert!(last["err"].as_f64().is_some_and(|err| err > 0.0), "{last}");
        assert!(others.iter().all(|line| line["done"].as_f64().is_some_and(|done| done < 1.0)));
        assert!(others.iter().all(|line| line.get("eta_s").is_some() && line.get("err").is_some()));
    }
}

#[test]
fn openjd_reads_progress_and_failures_from_standard_output() {
    let folder = folder(SCENE);
    let done = run(&folder, "render scene.ron --frames 1-4 -o #.exr -q --progress openjd --passes 2");
    assert_eq!((done.code, done.stderr.as_str()), (Some(0), ""));
    let progress: Vec<f64> = done
        .stdout
        .lines()
        .filter_map(|line| line.strip_prefix("openjd_progress: "))
        .map(|percent| percent.parse().expect("a number"))
        .collect();
    assert!(progress.is_sorted() && progress.len() >= 8, "{progress:?}");
    assert_eq!(progress.iter().filter(|percent| **percent >= 100.0).count(), 1);
    assert_eq!(progress.last(), Some(&100.0));
    assert!(done.stdout.contains("openjd_status: frame 3: trace"), "{}", done.stdout);
    assert!(done.stdout.lines().all(|line| line.starts_with("openjd_")));
    let failed = run(&folder, "render scene.ron --frames 1-4 -o #/a#.exr -q --progress openjd");
    assert_eq!(failed.code, Some(4));
    let last = failed.stdout.lines().last().unwrap_or_default();
    assert!(
        last.starts_with("openjd_fail: 4 of 4 frames failed: 1, 2, 3, 4; the first of them: can't write"),
        "{last}"
    );
    // what is wrong with a scene is told to programs too
    for form in ["openjd", "json"] {
        let wrong =
            run(&folder, &format!("render scene.ron -o a.exr -q --set image.width=0 --progress {form}"));
        let said = if form == "json" { &wrong.stderr } else { &wrong.stdout };
        let last = said.lines().last().unwrap_or_default();
        assert!(wrong.code == Some(2) && last.contains("0 is outside [1, 1048576]"), "{said}");
        if form == "json" {
            let line: serde_json::Value = serde_json::from_str(last).expect("an object");
            assert_eq!((&line["note"], &line["code"]), (&"failed".into(), &2.into()));
        } else {
            assert!(last.starts_with("openjd_fail: --set image.width=0"), "{last}");
        }
    }
    for clash in ["-o - --progress openjd", "-o a.exr --stats - --progress openjd"] {
        let done = run(&folder, &format!("render scene.ron {clash}"));
        assert!(done.code == Some(2) && done.stderr.contains("standard output"), "{}", done.stderr);
    }
}
