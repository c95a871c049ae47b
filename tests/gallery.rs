//! The scenes of the repository: each passes `check` without a word, has a caption, and is on the
//! gallery's page with a picture.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The scenes of `scenes/` and `scenes/gallery/`, relative to the root.
fn scenes() -> Vec<String> {
    let mut found = Vec::new();
    for folder in ["scenes", "scenes/gallery"] {
        for entry in fs::read_dir(root().join(folder)).expect("the folder is committed") {
            let path = entry.expect("readable").path();
            if path.extension().is_some_and(|ending| ending == "ron" || ending == "toml") {
                let name = path.file_name().expect("a file").to_str().expect("plain names");
                found.push(format!("{folder}/{name}"));
            }
        }
    }
    found.sort();
    found
}

/// The lines of the comment that a scene begins with.
fn comment(scene: &str) -> Vec<String> {
    let text = fs::read_to_string(root().join(scene)).expect("a scene");
    let mark = if scene.ends_with(".ron") { "// " } else { "# " };
    text.lines().map_while(|line| line.strip_prefix(mark)).map(str::to_owned).collect()
}

/// Name and caption of a scene's pictures: the first line is that of the picture as the scene has it,
/// and further ones are asked for by `picture NAME: OPTIONS "CAPTION"`.
fn pictures(scene: &str) -> Vec<(String, String)> {
    let comment = comment(scene);
    let stem = PathBuf::from(scene).file_stem().expect("a name").to_str().expect("plain names").to_owned();
    let mut found = vec![(stem, comment.first().unwrap_or_else(|| panic!("{scene}: no caption")).clone())];
    for line in comment.iter().filter_map(|line| line.strip_prefix("picture ")) {
        let (name, rest) = line.split_once(": ").unwrap_or_else(|| panic!("{scene}: {line}"));
        let caption = rest.strip_suffix('"').and_then(|rest| rest.rsplit_once('"'));
        found.push((name.to_owned(), caption.unwrap_or_else(|| panic!("{scene}: {line}")).1.to_owned()));
    }
    found
}

#[test]
fn every_scene_passes_check_without_a_warning() {
    let scenes = scenes();
    assert!(scenes.len() > 15 && scenes.iter().filter(|scene| scene.ends_with(".toml")).count() >= 4);
    let run = Command::new(env!("CARGO_BIN_EXE_terrarium"))
        .current_dir(root())
        .args(["check", "--format", "json"])
        .args(&scenes)
        .output()
        .expect("the program runs");
    let report: Value = serde_json::from_slice(&run.stdout).expect("JSON");
    let report = report.as_array().expect("a list");
    assert_eq!(report.len(), scenes.len());
    for scene in report {
        let clean = scene["valid"] == true && scene["diagnostics"].as_array().is_some_and(Vec::is_empty);
        assert!(clean, "{scene:#}");
    }
}

#[test]
fn every_scene_is_on_the_page_with_its_captions_and_pictures() {
    let page = fs::read_to_string(root().join("docs/gallery.md")).expect("the page is committed");
    for scene in scenes() {
        assert!(page.contains(&format!("[{scene}](../{scene})")), "{scene} is not named");
        for (name, caption) in pictures(&scene) {
            assert!(caption.len() > 20 && caption.ends_with('.'), "{scene}: `{caption}` is no caption");
            let shown = format!("![{caption}](../renders/gallery/{name}.png)");
            assert!(page.contains(&shown), "{scene}: the page lacks {shown}");
            let picture = root().join(format!("renders/gallery/{name}.png"));
            let bytes = fs::metadata(&picture).unwrap_or_else(|error| panic!("{name}: {error}")).len();
            assert!(bytes < 700_000, "{name}.png has {bytes} bytes");
        }
    }
}
