//! A scene reads the files of its own folder and of those that its user allows, and no others;
//! nothing that it names makes the program wait or fill the memory.
#![cfg(unix)]

use std::fs;
use std::io::Read;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use tempfile::TempDir;
use terrarium::build;
use terrarium::description::{Format, PROJECT_MARK, Reach, Terms, load_str_on};

const MESH: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const LIBRARY: &str = "(materials: { \"spare\": (diffuse: 0.5) })";
const CAMERA: &str = "camera: (eye: (0, 0, 5), target: (0, 0, 0)), ambient: 1, image: (width: 4, height: 4)";

/// `home/scenes` is the scene's folder; `home/secret.*` lie outside, `home/allowed` may be allowed.
fn home() -> TempDir {
    let home = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| home.path().join(name);
    for folder in ["scenes/sub/deep", "scenes2", "allowed/sub", "closed"] {
        fs::create_dir_all(at(folder)).expect("made");
    }
    for name in ["secret", "scenes/own", "scenes/sub/own", "scenes2/twin", "allowed/a", "closed/c"] {
        image::RgbImage::new(2, 1).save(at(&format!("{name}.png"))).expect("written");
        fs::write(at(&format!("{name}.obj")), MESH).expect("written");
        fs::write(at(&format!("{name}.ron")), LIBRARY).expect("written");
    }
    for (link, target) in [
        ("scenes/out", "../secret".to_owned()),
        ("scenes/own_link", "own".to_owned()),
        ("scenes/first", "second".to_owned()),
        ("scenes/second", "sub/../../secret".to_owned()),
        ("scenes/circle", "circle".to_owned()),
        ("scenes/absolute", at("secret").display().to_string()),
        ("scenes/to_allowed", "../allowed/a".to_owned()),
        ("scenes/zero", "/dev/zero".to_owned()),
    ] {
        for ending in ["png", "obj", "ron"] {
            let target =
                if target.starts_with("/dev") { target.clone() } else { format!("{target}.{ending}") };
            symlink(target, at(&format!("{link}.{ending}"))).expect("linked");
        }
    }
    symlink("..", at("scenes/up")).expect("linked");
    symlink("sub", at("scenes/down")).expect("linked");
    for ending in ["png", "obj", "ron"] {
        let made = Command::new("mkfifo").arg(at(&format!("scenes/pipe.{ending}"))).status();
        assert!(made.is_ok_and(|status| status.success()), "mkfifo");
    }
    home
}

/// Scenes that read `path`: as a mesh, an image, a sky and an include, each with the ending of such a file.
fn scenes(path: &str) -> [String; 4] {
    let white = "materials: { \"white\": (diffuse: 0.5) }";
    [
        format!("({CAMERA}, {white}, objects: [(shape: mesh(path: \"{path}.obj\"), material: \"white\")])"),
        format!(
            "({CAMERA}, textures: {{ \"t\": image(path: \"{path}.png\") }},
              materials: {{ \"m\": (diffuse: texture(\"t\")) }}, objects: [(shape: sphere(), material: \"m\")])"
        ),
        format!(
            "({CAMERA}, lights: {{ \"sky\": environment(map: image(path: \"{path}.png\")) }}, {white},
              objects: [(shape: sphere(), material: \"white\")])"
        ),
        format!("({CAMERA}, include: [\"{path}.ron\"])"),
    ]
}

/// What is wrong with a scene in `folder` and the files that it names.
fn verdict(text: &str, folder: &Path, allowed: &[PathBuf]) -> Result<(), String> {
    let reach = Reach::within(folder, allowed).expect("the folders are there");
    let terms = Terms { reach, ..Terms::default() };
    let loaded = load_str_on(&terms, text, Format::Ron, folder, &[]).map_err(|report| report.to_string())?;
    let report = loaded.report(build::examine(&loaded.scene));
    if report.errors().next().is_some() { Err(report.to_string()) } else { Ok(()) }
}

#[test]
fn a_scene_reads_its_own_folder_and_nothing_around_it() {
    let home = home();
    let folder = home.path().join("scenes");
    let absolute = |name: &str| home.path().join(name).display().to_string();
    let (inside, outside) = ("", "lies outside");
    let cases: Vec<(String, &str)> = [
        ("own", inside),
        ("./own", inside),
        ("sub/own", inside),
        ("sub/../own", inside),
        ("sub/deep/../../own", inside),
        ("../scenes/own", inside),
        ("own_link", inside),
        ("down/own", inside),
        ("up/scenes/own", inside),
        ("../secret", outside),
        ("../../secret", outside),
        ("sub/../../secret", outside),
        ("sub/deep/../../../secret", outside),
        ("./.././secret", outside),
        ("up/secret", outside),
        ("down/../../secret", outside),
        ("down/../up/secret", outside),
        ("out", outside),
        ("first", outside),
        ("absolute", outside),
        ("to_allowed", outside),
        ("../scenes2/twin", outside),
        ("../allowed/a", outside),
        ("../not_there", outside),
        ("../not_there/../secret", outside),
        ("not_there/../../secret", outside),
        ("/etc/passwd", outside),
        ("/dev/zero", outside),
        ("/proc/self/environ", outside),
        ("zero", outside),
        ("pipe", "not a regular file"),
        ("circle", "cannot be read"),
        ("not_there", "there is no such file"),
        ("sub", "there is no such file"),
    ]
    .map(|(path, verdict)| (path.to_owned(), verdict))
    .into_iter()
    .chain([
        (absolute("scenes/own"), inside),
        (absolute("secret"), outside),
        (absolute("scenes/../secret"), outside),
        (absolute("scenes2/twin"), outside),
    ])
    .collect();
    let began = Instant::now();
    for (path, expected) in &cases {
        for scene in scenes(path) {
            match verdict(&scene, &folder, &[]) {
                Ok(()) => assert!(expected.is_empty(), "{path} was read: {scene}"),
                Err(said) => {
                    assert!(!expected.is_empty() && said.contains(expected), "{path}: {said}\n{scene}")
                }
            }
        }
    }
    assert!(cases.len() >= 30 && began.elapsed() < Duration::from_secs(20), "{:?}", began.elapsed());
}

#[test]
fn allowed_folders_are_read_too_and_only_they() {
    let home = home();
    let folder = home.path().join("scenes");
    let allowed = [home.path().join("allowed"), home.path().join("scenes2")];
    for (path, fine) in [
        ("own", true),
        ("../allowed/a", true),
        ("../scenes2/twin", true),
        ("to_allowed", true),
        ("up/allowed/a", true),
        ("../allowed/sub/../a", true),
        ("../closed/c", false),
        ("../allowed/../secret", false),
        ("out", false),
    ] {
        for scene in scenes(path) {
            let found = verdict(&scene, &folder, &allowed);
            assert_eq!(found.is_ok(), fine, "{path}: {found:?}");
        }
    }
}

/// Whether a file is there must not show.
#[test]
fn a_file_out_of_reach_is_refused_in_the_same_words_whether_it_is_there_or_not() {
    let home = home();
    let folder = home.path().join("scenes");
    let said = |path: &str| {
        scenes(path).map(|scene| verdict(&scene, &folder, &[]).expect_err("outside").replace(path, "…"))
    };
    assert_eq!(said("../secret"), said("../nothin"));
}

#[test]
fn a_link_that_is_moved_about_never_leads_outside() {
    let home = home();
    let folder = home.path().join("scenes");
    fs::write(folder.join("mine"), "mine").expect("written");
    fs::write(home.path().join("theirs"), "theirs").expect("written");
    let reach = Reach::within(&folder, &[]).expect("no folders");
    let over = AtomicBool::new(false);
    let path = folder.join("link");
    let mut reads = 0;
    std::thread::scope(|scope| {
        scope.spawn(|| {
            let next = folder.join("next");
            for target in ["mine", "../theirs"].into_iter().cycle() {
                symlink(target, &next).and_then(|()| fs::rename(&next, &path)).expect("moved");
                if over.load(Ordering::Relaxed) {
                    break;
                }
            }
        });
        let began = Instant::now();
        while began.elapsed() < Duration::from_millis(500) {
            let Ok(mut file) = reach.open(&path) else { continue };
            let mut text = String::new();
            file.read_to_string(&mut text).expect("it reads");
            assert_eq!(text, "mine");
            reads += 1;
        }
        over.store(true, Ordering::Relaxed);
    });
    assert!(reads > 100, "{reads} reads");
}

fn terrarium(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_terrarium"));
    command.current_dir(folder).args(arguments).output().expect("the program runs")
}

#[test]
fn every_command_keeps_scenes_within_reach_and_allow_widens_it() {
    let home = home();
    let scene = home.path().join("scenes/scene.ron");
    fs::write(&scene, &scenes("../allowed/a")[0]).expect("written");
    let run = |arguments: &[&str]| {
        let output = terrarium(home.path(), arguments);
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    for command in [
        &["check", "scenes/scene.ron"][..],
        &["render", "scenes/scene.ron", "-o", "a.png"],
        &["plan", "scenes/scene.ron"],
        &["study", "scenes/scene.ron", "-o", "study"],
    ] {
        let (code, said) = run(command);
        assert!(code == Some(3) && said.contains("lies outside"), "{command:?}: {code:?} {said}");
    }
    assert!(!home.path().join("a.png").exists());
    for allow in ["allowed", ".", "scenes/../allowed"] {
        let (code, said) = run(&["render", "scenes/scene.ron", "-o", "a.png", "-q", "--allow", allow]);
        assert_eq!((code, said.as_str()), (Some(0), ""), "--allow {allow}");
    }
    let (code, said) = run(&["check", "scenes/scene.ron", "--allow", "missing"]);
    assert!(code == Some(2) && said.contains("--allow missing"), "{said}");
    // a mark in the scene's own folder adds nothing, one around it adds the project
    fs::write(home.path().join("scenes").join(PROJECT_MARK), "").expect("written");
    assert_eq!(run(&["check", "scenes/scene.ron"]).0, Some(3));
    fs::remove_file(home.path().join("scenes").join(PROJECT_MARK)).expect("removed");
    fs::write(home.path().join(PROJECT_MARK), "").expect("written");
    assert_eq!(run(&["check", "scenes/scene.ron"]).0, Some(0));
}

/// What a file says of its size is held against the limits before room is made for it.
#[test]
fn sizes_and_nesting_are_bounded_before_anything_is_allocated() {
    let home = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| home.path().join(name);
    // 65 bytes that declare an image of 3 TB, a mesh and an include with holes of 5 GiB
    let mut png = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\x0f\xff\xff\0\x0f\xff\xff\x08\x02\0\0\0".to_vec();
    png.extend(0x6a_13_7b_9du32.to_be_bytes());
    png.extend(b"\0\0\0\0IEND\xae\x42\x60\x82");
    fs::write(at("huge.png"), png).expect("written");
    for name in ["huge.obj", "huge.ron"] {
        fs::File::create(at(name)).and_then(|file| file.set_len(5 << 30)).expect("made");
    }
    let began = Instant::now();
    for scene in scenes("huge") {
        let said = verdict(&scene, home.path(), &[]).expect_err("it is huge");
        assert!(!said.is_empty(), "{scene}");
    }
    // includes that include: 40 levels, 300 files, and more bytes together than one file may have
    for level in 0..40 {
        fs::write(at(&format!("level{level}.ron")), format!("(include: [\"level{}.ron\"])", level + 1))
            .expect("written");
    }
    fs::write(at("level40.ron"), "()").expect("written");
    let wide: Vec<String> = (0..300).map(|file| format!("\"wide{file}.ron\"")).collect();
    (0..300).for_each(|file| fs::write(at(&format!("wide{file}.ron")), "()").expect("written"));
    let filler = format!("(){}", " ".repeat((100 << 20) - 2));
    (0..3).for_each(|file| fs::write(at(&format!("large{file}.ron")), &filler).expect("written"));
    let nested = format!("({CAMERA}, objects: {}{})", "[".repeat(100_000), "]".repeat(100_000));
    for (scene, expected) in [
        (format!("({CAMERA}, include: [\"level0.ron\"])"), "more than 16 levels"),
        (format!("({CAMERA}, include: [{}])", wide.join(", ")), "or 256 files"),
        (
            format!("({CAMERA}, include: [\"large0.ron\", \"large1.ron\", \"large2.ron\"])"),
            "more than 256 mib, with all that they include",
        ),
        (nested, "nest"),
    ] {
        let said = verdict(&scene, home.path(), &[]).expect_err("bounded");
        assert!(said.to_lowercase().contains(expected), "{expected}: {}", &said[..said.len().min(500)]);
    }
    assert!(began.elapsed() < Duration::from_secs(20), "{:?}", began.elapsed());
}
