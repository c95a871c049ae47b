//! Going on with a study, given references, and calls that are refused.

use super::{MATT, folder, json, study, terrarium};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::time::SystemTime;

fn changed(folder: &Path) -> Vec<(String, SystemTime)> {
    let mut times = Vec::new();
    for place in ["out/pictures", "out/errors"] {
        for entry in fs::read_dir(folder.join(place)).expect("a folder") {
            let entry = entry.expect("an entry");
            let name = entry.file_name().to_string_lossy().into_owned();
            if name != "reference.png" {
                times.push((
                    format!("{place}/{name}"),
                    entry.metadata().and_then(|m| m.modified()).expect("a time"),
                ));
            }
        }
    }
    times.sort();
    times
}

#[test]
fn nothing_is_rendered_twice_and_what_is_missing_is() {
    let folder = folder(MATT);
    let knobs = ["--knobs", "passes,shadow_rays"];
    let first = study(folder.path(), &knobs);
    assert_eq!(first.code, Some(0), "{}", first.stderr);
    assert!(first.stderr.contains("rendered 14 and the reference in"), "{}", first.stderr);
    let (before, times) = (json(folder.path()), changed(folder.path()));

    let second = study(folder.path(), &knobs);
    assert!(second.stderr.contains("rendered 0 in"), "{}", second.stderr);
    assert_eq!((json(folder.path()), changed(folder.path())), (before.clone(), times));

    // As if it had been broken off: a run is not there yet.
    let mut broken = before.clone();
    broken["rungs"][2]["runs"].as_array_mut().expect("a list").pop();
    fs::write(folder.path().join("out/study.json"), broken.to_string()).expect("written");
    let third = study(folder.path(), &knobs);
    assert!(third.stderr.contains("rendered 1 in"), "{}", third.stderr);
    let error = |study: &Value| study["rungs"][2]["result"]["error"].clone();
    assert_eq!(error(&json(folder.path())), error(&before));

    // A picture that is gone is rendered again, with all seeds of its rung.
    fs::remove_file(folder.path().join("out/pictures/passes-2.png")).expect("there");
    let fourth = study(folder.path(), &knobs);
    assert!(fourth.stderr.contains("rendered 2 in"), "{}", fourth.stderr);

    // More seeds: only those that are new.
    let fifth = study(folder.path(), &["--knobs", "passes", "--seeds", "3"]);
    assert!(fifth.stderr.contains("rendered 3 in"), "{}", fifth.stderr);

    // Another scene in the same folder: nothing is taken over.
    fs::write(folder.path().join("scene.ron"), MATT.replace("diffuse: 0.7", "diffuse: 0.6"))
        .expect("written");
    let other = study(folder.path(), &knobs);
    assert!(other.stderr.contains("rendered 14 and the reference in"), "{}", other.stderr);
}

#[test]
fn a_given_reference_is_used_and_said() {
    let folder = folder(MATT);
    let rendered = terrarium(
        folder.path(),
        &["render", "scene.ron", "-o", "truth.exr", "--passes", "300", "--seed", "9"],
    );
    assert_eq!(rendered.code, Some(0), "{}", rendered.stderr);
    let outcome = study(folder.path(), &["--knobs", "passes", "--reference", "truth.exr"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("rendered 6 in"), "{}", outcome.stderr);
    let found = json(folder.path());
    assert_eq!(
        (&found["reference"]["given"], &found["reference"]["error"]),
        (&Value::Bool(true), &Value::Null)
    );
    let page = fs::read_to_string(folder.path().join("out/index.html")).expect("the page");
    assert!(page.contains("truth.exr, as given; its own error is not known here"));
    assert!(!folder.path().join("out/reference.exr").exists());
}

#[test]
fn wrong_calls_are_refused_before_anything_is_rendered() {
    let folder = folder(MATT);
    fs::write(folder.path().join("small.exr"), "no image").expect("written");
    let small = ["render", "scene.ron", "-o", "other.exr", "--passes", "1", "--set", "image.width=16"];
    assert_eq!(terrarium(folder.path(), &small).code, Some(0));
    for (code, says, arguments) in [
        (2, "did you mean `passes`?", ["--knobs", "pases"]),
        (3, "can't read missing.exr", ["--reference", "missing.exr"]),
        (3, "can't read small.exr", ["--reference", "small.exr"]),
        (1, "the reference has 16 × 24 pixels", ["--reference", "other.exr"]),
    ] {
        let outcome = study(folder.path(), &arguments);
        assert_eq!(outcome.code, Some(code), "{}", outcome.stderr);
        assert!(outcome.stderr.contains(says), "{}", outcome.stderr);
    }
    fs::write(folder.path().join("file"), "kept").expect("written");
    let outcome = terrarium(folder.path(), &["study", "scene.ron", "-o", "file"]);
    assert_eq!(outcome.code, Some(4), "{}", outcome.stderr);
    assert_eq!(fs::read(folder.path().join("file")).ok(), Some(b"kept".to_vec()));
    // A folder within folders that are not there yet is made.
    let arguments = [
        "study",
        "scene.ron",
        "-o",
        "a/b/c",
        "--knobs",
        "passes",
        "--ladder",
        "1",
        "--seeds",
        "1",
        "--time",
        "5s",
    ];
    let outcome = terrarium(folder.path(), &arguments);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(folder.path().join("a/b/c/index.html").is_file());
}
