//! Renders that are killed or stopped, and gone on with.

use super::{ADAPTIVE, CAUSTIC, Lab};
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

fn begun(lab: &Lab, words: &[&str]) -> Child {
    lab.command(words).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("the program starts")
}

/// Sends a signal by name.
#[cfg(unix)]
fn signal(child: &Child, name: &str) {
    let sent = std::process::Command::new("kill").args([name, &child.id().to_string()]).status();
    assert!(sent.is_ok_and(|status| status.success()));
}

/// Milliseconds that are spread over those below `most`.
fn moment(i: u64, most: u64) -> Duration {
    let mixed = (i + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    Duration::from_millis((mixed ^ mixed >> 31) % most)
}

/// A render that would last some seconds.
const WORK: [&str; 5] = ["render", "scene.ron", "--passes", "200", "-q"];

/// Kills of each render at most; `KILLS=200 cargo test --release --test all batch::resume::a_render_that_is_killed`
/// for more of them.
fn kills_at_most() -> u64 {
    std::env::var("KILLS").ok().and_then(|text| text.parse().ok()).unwrap_or(5)
}

/// Renders to `killed.exr`, killed at most so many times, each at another moment, until it is done; `whole` is
/// what a render that is not killed takes, in milliseconds. How often it was killed.
pub(crate) fn killed(lab: &Lab, words: &[&str], most: u64, whole: u64) -> u32 {
    let again = [words, &["-o", "killed.exr", "--checkpoint", "10ms", "--resume"]].concat();
    let mut kills = 0;
    for i in 0..most {
        let mut child = begun(lab, &again);
        let end = Instant::now() + moment(i, whole / 2 + 20);
        while Instant::now() < end && child.try_wait().expect("a child").is_none() {
            std::thread::sleep(Duration::from_millis(1));
        }
        kills += u32::from(child.try_wait().expect("a child").is_none());
        let _ = child.kill();
        let _ = child.wait();
        let found = lab.path("killed.exr");
        if found.exists() {
            assert!(lab.bytes("killed.exr") == lab.bytes("whole.exr"), "a file that is not whole");
            // Begun anew, to be killed at other moments.
            std::fs::remove_file(found).expect("removed");
        }
    }
    lab.done(&again);
    kills
}

/// Killed again and again, at other moments, until it is done.
#[test]
fn a_render_that_is_killed_goes_on_to_the_bits_of_one_that_is_not() {
    for (scene, work) in [
        (CAUSTIC, &["--passes", "24"][..]),
        (CAUSTIC, &["--error", "10%", "--passes", "4000"]),
        (ADAPTIVE, &["--passes", "1", "--set", "image.width=320", "--set", "image.height=240"]),
    ] {
        let lab = Lab::new(scene);
        let words = [&["render", "scene.ron", "-q"], work].concat();
        let began = Instant::now();
        lab.done(&[&words[..], &["-o", "whole.exr"]].concat());
        let kills = killed(&lab, &words, kills_at_most(), began.elapsed().as_millis() as u64);
        assert!(kills > 0, "nothing was killed");
        assert!(lab.bytes("killed.exr") == lab.bytes("whole.exr"), "{work:?} after {kills} kills");
        assert!(!lab.names().iter().any(|name| name.ends_with(".checkpoint")), "{:?}", lab.names());
    }
}

#[cfg(unix)]
#[test]
fn a_render_that_is_stopped_leaves_a_valid_image_and_goes_on() {
    let lab = Lab::new(CAUSTIC);
    for (i, name) in ["-TERM", "-INT", "-USR1"].into_iter().enumerate() {
        let words = [&WORK[..], &["-o", "out.exr", "-o", "out.png", "--resume"]].concat();
        let mut child = begun(&lab, &words);
        std::thread::sleep(Duration::from_millis(400));
        let asked = Instant::now();
        signal(&child, name);
        let status = child.wait().expect("it ends");
        assert!(asked.elapsed() < Duration::from_secs(5), "{:?}", asked.elapsed());
        if i > 0 && status.success() {
            // On a fast machine nothing was left to stop.
            break;
        }
        assert_eq!(status.code(), Some(6), "{name}");
        assert!(image::open(lab.path("out.png")).is_ok());
        assert!(exr::prelude::read_first_flat_layer_from_file(lab.path("out.exr")).is_ok());
        assert!(lab.path("out.exr.checkpoint").exists());
    }
    lab.done(&[&WORK[..], &["-o", "out.exr", "-o", "out.png", "--resume"]].concat());
    lab.done(&[&WORK[..], &["-o", "whole.exr"]].concat());
    assert!(lab.bytes("out.exr") == lab.bytes("whole.exr"));
    // What is complete already is a success, and is not touched.
    let before = std::fs::metadata(lab.path("out.exr")).and_then(|found| found.modified()).expect("there");
    lab.done(&[&WORK[..], &["-o", "out.exr", "-o", "out.png", "--resume"]].concat());
    assert_eq!(std::fs::metadata(lab.path("out.exr")).and_then(|found| found.modified()).ok(), Some(before));
}

#[test]
fn a_part_that_is_there_is_not_rendered_again() {
    let lab = Lab::new(CAUSTIC);
    let words = ["render", "scene.ron", "--passes", "4", "--shard", "1/2", "-o", "part.exr", "--resume"];
    lab.done(&words);
    assert!(lab.done(&words).contains("there already"));
    let said = lab.done(&[&words[..], &["--seed", "2"]].concat());
    assert!(!said.contains("there already"), "{said}");
}

/// There is nothing to write yet: what is there stays, and the program does not wait for its stages.
#[cfg(unix)]
#[test]
fn a_signal_before_anything_is_traced_leaves_the_old_image() {
    let many = r#"definitions: { "ball": (shape: sphere(radius: 0.001), material: "glass") }, objects: [
        (shape: scatter(of: ["ball"], over: "ground", count: 400000)),
        (name: "ground", shape: quad(size: (9, 9)), material: "floor"),"#;
    let lab = Lab::new(CAUSTIC);
    lab.done(&["render", "scene.ron", "--passes", "1", "-q", "-o", "out.exr"]);
    let before = lab.bytes("out.exr");
    std::fs::write(lab.path("many.ron"), CAUSTIC.replace("objects: [", many)).expect("written");
    let mut child = begun(&lab, &["render", "many.ron", "-q", "-o", "out.exr", "--progress", "json"]);
    std::thread::sleep(Duration::from_millis(250));
    let asked = Instant::now();
    signal(&child, "-TERM");
    assert_eq!(child.wait().expect("it ends").code(), Some(6));
    assert!(asked.elapsed() < Duration::from_secs(2), "{:?}", asked.elapsed());
    let mut said = String::new();
    std::io::Read::read_to_string(&mut child.stderr.take().expect("piped"), &mut said).expect("text");
    assert!(said.contains("\"failed\"") && said.contains("stopped before anything was traced"), "{said}");
    assert!(lab.bytes("out.exr") == before && !lab.path("out.exr.checkpoint").exists());
}

#[cfg(unix)]
#[test]
fn a_signal_that_comes_twice_at_once_is_one_request() {
    let lab = Lab::new(CAUSTIC);
    let mut child = begun(&lab, &["render", "scene.ron", "--passes", "100000", "-q", "-o", "out.exr"]);
    std::thread::sleep(Duration::from_millis(400));
    signal(&child, "-TERM");
    signal(&child, "-TERM");
    assert_eq!(child.wait().expect("it ends").code(), Some(6));
    assert!(exr::prelude::read_first_flat_layer_from_file(lab.path("out.exr")).is_ok());
}

/// Nobody takes the image from its standard output, so that it cannot come to an end.
#[cfg(unix)]
#[test]
fn a_later_signal_ends_at_once() {
    let lab = Lab::new(CAUSTIC);
    let long = ["render", "scene.ron", "--passes", "100000", "-q", "-o", "-", "--set", "image.width=600"];
    let mut command = lab.command(&long);
    let mut child =
        command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program starts");
    std::thread::sleep(Duration::from_millis(400));
    signal(&child, "-TERM");
    std::thread::sleep(Duration::from_millis(1500));
    signal(&child, "-TERM");
    let asked = Instant::now();
    assert_eq!(child.wait().expect("it ends").code(), Some(143));
    assert!(asked.elapsed() < Duration::from_secs(2), "{:?}", asked.elapsed());
}

#[test]
fn a_checkpoint_of_another_render_is_refused_with_both_hashes() {
    let lab = Lab::new(CAUSTIC);
    let words = [&WORK[..], &["-o", "out.exr", "--checkpoint", "10ms"]].concat();
    let mut child = begun(&lab, &words);
    while !lab.path("out.exr.checkpoint").exists() {
        assert!(child.try_wait().expect("a child").is_none(), "it ended without a checkpoint");
        std::thread::sleep(Duration::from_millis(5));
    }
    let _ = child.kill();
    let _ = child.wait();
    for (more, reason) in [
        (&["--set", "materials.glass.ior=1.4"][..], "the scene's hash is "),
        (&["--seed", "9"], "the seed is 0 there and 9 here"),
        (&["--passes", "300"], "the range of passes is 0..200 there and 0..300 here"),
        (&["--aov", "normal"], "layers"),
    ] {
        let mut again: Vec<&str> = words.iter().copied().filter(|word| *word != "-q").collect();
        if more[0] == "--passes" {
            again.retain(|word| !["--passes", "200"].contains(word));
        }
        let said = lab.fails(2, &[&again[..], &["--resume"], more].concat());
        assert!(said.contains("out.exr.checkpoint") && said.contains(reason), "{said}");
    }
    // A damaged one is told; without --resume it is replaced.
    let bytes = lab.bytes("out.exr.checkpoint");
    std::fs::write(lab.path("out.exr.checkpoint"), &bytes[..bytes.len() - 100]).expect("written");
    let said = lab.fails(3, &[&words[..], &["--resume"]].concat());
    assert!(said.contains("can't go on from out.exr.checkpoint"), "{said}");
}
