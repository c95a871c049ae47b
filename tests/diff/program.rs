//! `terrarium diff` as its caller sees it: exit codes, streams, JSON and maps.

use super::{Exr, exr_file};
use assert_cmd::Command;
use exr::prelude::FlatSamples;
use serde_json::Value;
use std::fs;
use tempfile::TempDir;

/// A grey picture of 16 × 12 pixels.
fn grey(value: impl Fn(usize) -> f32) -> Vec<u8> {
    let plane: Vec<f32> = (0..192).map(value).collect();
    let channels = ["R", "G", "B"].map(|name| (name, FlatSamples::F32(plane.clone())));
    exr_file(vec![Exr::new((16, 12), channels.into())])
}

/// `reference.exr` is 1 throughout; `brighter.exr` is 1.1; `spot.exr` has one pixel of 3; `nan.exr` one of NaN;
/// `wide.exr` is of another size; `broken.exr` is cut; `depth.exr` has no picture.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).expect("written");
    write("reference.exr", &grey(|_| 1.0));
    write("copy.exr", &grey(|_| 1.0));
    write("brighter.exr", &grey(|_| 1.1));
    write("spot.exr", &grey(|i| if i == 37 { 3.0 } else { 1.0 }));
    write("nan.exr", &grey(|i| if i == 37 { f32::NAN } else { 1.0 }));
    let depth = |value: f32| vec![("Z", FlatSamples::F32(vec![value; 192]))];
    write("wide.exr", &exr_file(vec![Exr::new((24, 8), depth(1.0))]));
    write("depth.exr", &exr_file(vec![Exr::new((16, 12), depth(1.0))]));
    write("deeper.exr", &exr_file(vec![Exr::new((16, 12), depth(2.0))]));
    write("broken.exr", &grey(|_| 1.0)[..200]);
    folder
}

struct Outcome {
    code: Option<i32>,
    stdout: String,
    stderr: String,
}

fn diff(folder: &TempDir, arguments: &str) -> Outcome {
    diff_with(folder, arguments, &[])
}

fn diff_with(folder: &TempDir, arguments: &str, input: &[u8]) -> Outcome {
    let mut command = Command::new(env!("CARGO_BIN_EXE_terrarium"));
    command.current_dir(folder.path()).env_remove("CLICOLOR_FORCE").arg("diff").args(arguments.split(' '));
    let output = command.write_stdin(input).output().expect("the program runs");
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    let (stdout, stderr) = (text(output.stdout), text(output.stderr));
    assert!(!stderr.contains("broke off"), "{stderr}");
    Outcome { code: output.status.code(), stdout, stderr }
}

fn code(folder: &TempDir, arguments: &str) -> i32 {
    diff(folder, arguments).code.expect("a code")
}

#[test]
fn without_limits_any_differing_bit_is_a_difference() {
    let folder = folder();
    let same = diff(&folder, "reference.exr copy.exr");
    assert_eq!((same.code, same.stderr.as_str()), (Some(0), ""));
    assert!(same.stdout.contains("same       bit for bit"), "{}", same.stdout);
    let found = diff(&folder, "spot.exr reference.exr");
    assert_eq!(found.code, Some(1));
    assert!(found.stdout.contains("2.000 at (5, 2): 3.000 3.000 3.000 against 1.000"), "{}", found.stdout);
    assert_eq!(found.stderr, "error: spot.exr and reference.exr differ\n");
    let quiet = diff(&folder, "spot.exr reference.exr -q");
    assert_eq!((quiet.code, quiet.stdout.as_str(), quiet.stderr.as_str()), (Some(1), "", ""));
}

#[test]
fn limits_decide_alone_and_say_which_was_exceeded() {
    let folder = folder();
    // of `brighter`: relMSE 0.0099, E 0.0874; of `spot`: one pixel in 192, 0.52 %, differs by 2
    for (arguments, kept, exceeded) in [
        ("brighter.exr reference.exr --max-relmse", "0.01", "0.0098"),
        ("brighter.exr reference.exr --max-relmse-trimmed", "0.01", "0.0098"),
        ("brighter.exr reference.exr --max-e", "8.8%", "0.087"),
        ("brighter.exr reference.exr --max-flip", "0.5", "1e-4"),
        ("brighter.exr reference.exr --max-flip-hdr", "0.5", "1e-4"),
        ("brighter.exr reference.exr --fail", "0.11", "0.09"),
        ("brighter.exr reference.exr --hardfail", "0.11", "0.09"),
        ("spot.exr reference.exr --fail 0.5 --failpercent", "0.53", "0.52"),
        ("spot.exr reference.exr --fail 1.99 --failpercent", "0.53%", "0.52%"),
        ("depth.exr deeper.exr --fail", "1", "0.99"),
    ] {
        assert_eq!(code(&folder, &format!("{arguments} {kept}")), 0, "{arguments} {kept}");
        let found = diff(&folder, &format!("{arguments} {exceeded}"));
        assert_eq!(found.code, Some(1), "{arguments} {exceeded}");
        let limit = arguments.split(" --").nth(1).and_then(|rest| rest.split(' ').next()).expect("a limit");
        assert!(found.stderr.contains(&format!("error: --{limit}: ")), "{}", found.stderr);
    }
    let none = diff(&folder, "depth.exr depth.exr --max-relmse 1");
    assert_eq!(none.code, Some(1), "a limit that nothing was held to is not kept");
    assert!(none.stderr.contains("no such figure"), "{}", none.stderr);
}

#[test]
fn warnings_are_said_and_fail_nothing() {
    let folder = folder();
    let found = diff(&folder, "spot.exr reference.exr --max-e 1 --warn 0.5 --hardwarn 1");
    assert_eq!(found.code, Some(0));
    assert!(found.stderr.contains("warning: --warn: 0.5208 %"), "{}", found.stderr);
    assert!(found.stderr.contains("warning: --hardwarn: 2.000 of picture is over 1"), "{}", found.stderr);
    assert_eq!(code(&folder, "spot.exr reference.exr --warn 5"), 1, "a warning is no limit");
    assert_eq!(diff(&folder, "spot.exr reference.exr --max-e 1 --warn 0.5 --warnpercent 1").stderr, "");
}

#[test]
fn a_value_that_is_not_finite_fails_whatever_the_limits() {
    let folder = folder();
    for arguments in ["nan.exr reference.exr --max-e 1", "reference.exr nan.exr --max-relmse 1 --json"] {
        let found = diff(&folder, arguments);
        assert_eq!(found.code, Some(1));
        assert!(found.stderr.contains("3 values are not finite in one image only, the first at (5, 2)"));
    }
    assert_eq!(code(&folder, "nan.exr nan.exr"), 0);
}

#[test]
fn what_cannot_be_compared_has_its_own_code() {
    let folder = folder();
    let sizes = diff(&folder, "wide.exr reference.exr");
    assert_eq!(sizes.code, Some(1));
    assert!(sizes.stderr.contains("24 × 8 pixels, and 16 × 12"), "{}", sizes.stderr);
    for (arguments, expected) in [
        ("reference.exr missing.exr", 3),
        ("broken.exr reference.exr", 3),
        ("reference.exr .", 3),
        ("reference.exr", 2),
        ("- -", 2),
        ("reference.exr copy.exr --layer glow", 2),
        ("reference.exr copy.exr --max-e -1", 2),
        ("reference.exr copy.exr --max-e nan", 2),
        ("reference.exr copy.exr --failpercent 3", 2),
        ("reference.exr copy.exr --fast --max-flip 0.1", 2),
        ("reference.exr copy.exr --heat map.exr", 2),
        ("reference.exr copy.exr --heat a.png --side-by-side ./a.png", 2),
        ("depth.exr depth.exr --heat map.png", 2),
        ("reference.exr copy.exr --heat none/map.png", 4),
    ] {
        let found = diff(&folder, arguments);
        assert_eq!(found.code, Some(expected), "{arguments}: {}", found.stderr);
        assert!(!found.stderr.is_empty());
    }
}

#[test]
fn one_image_may_come_from_standard_input() {
    let folder = folder();
    let bytes = fs::read(folder.path().join("brighter.exr")).expect("it is there");
    for (arguments, ratio) in [("- reference.exr --json", 1.1), ("reference.exr - --json", 1.0 / 1.1)] {
        let found = diff_with(&folder, arguments, &bytes);
        let json: Value = serde_json::from_str(&found.stdout).expect("JSON");
        let found = json["layers"][0]["colour"]["mean_ratio"].as_f64().expect("a number");
        assert!((found - ratio).abs() < 1e-6, "{found}");
    }
    assert_eq!(diff_with(&folder, "- reference.exr", b"no image").code, Some(3));
}

/// GUIDE.md names these keys: programs rely on them.
#[test]
fn json_has_the_keys_that_the_guide_names() {
    let folder = folder();
    let found = diff(&folder, "spot.exr reference.exr --json --max-e 0.5 --warn 0.1");
    assert_eq!(found.code, Some(0));
    let json: Value = serde_json::from_str(&found.stdout).expect("JSON");
    let keys =
        |value: &Value| -> Vec<String> { value.as_object().expect("an object").keys().cloned().collect() };
    let sorted = |list: &str| -> Vec<String> {
        let mut names: Vec<String> = list.split(' ').map(str::to_owned).collect();
        names.sort();
        names
    };
    let layer = &json["layers"][0];
    for (value, expected) in [
        (
            &json,
            "version image reference passed limits width height same layers only_in_image only_in_reference notes",
        ),
        (
            layer,
            "name kind channels same differing mse rmse max_error worst non_finite mean_image mean_reference colour",
        ),
        (&layer["worst"], "x y image reference"),
        (&layer["non_finite"], "image reference unmatched first"),
        (
            &layer["colour"],
            "rel_mse rel_mse_trimmed relative_rms mape mean_ratio exposure_ev psnr_db ssim flip flip_hdr",
        ),
        (&layer["colour"]["flip"], "mean weighted_quartiles max"),
        (&layer["colour"]["flip_hdr"], "mean weighted_quartiles max start_ev stop_ev count"),
        (&json["limits"][0], "limit layer value allowed exceeded fatal"),
    ] {
        let mut found = keys(value);
        found.sort();
        assert_eq!(found, sorted(expected));
    }
    let guide = include_str!("../../GUIDE.md");
    for key in keys(layer).iter().chain(&keys(&layer["colour"])).chain(&keys(&json)) {
        assert!(guide.contains(&format!("`{key}`")), "GUIDE.md does not name {key}");
    }
    assert_eq!(
        (&json["passed"], &json["same"], &layer["kind"]),
        (&true.into(), &false.into(), &"colour".into())
    );
    assert_eq!((&layer["worst"]["x"], &layer["worst"]["y"]), (&5.into(), &2.into()));
    let limits = json["limits"].as_array().expect("a list");
    assert_eq!((limits.len(), &limits[1]["exceeded"], &limits[1]["fatal"]), (2, &true.into(), &false.into()));
}

#[test]
fn maps_are_pictures_of_the_error() {
    let folder = folder();
    let found = diff(
        &folder,
        "spot.exr reference.exr --max-e 1 --fast --heat map.png --side-by-side all.png --exposure -1",
    );
    assert_eq!(found.code, Some(0), "{}", found.stderr);
    let open = |name: &str| image::open(folder.path().join(name)).expect("a PNG").to_rgb8();
    let (map, all) = (open("map.png"), open("all.png"));
    assert_eq!((map.dimensions(), all.dimensions()), ((16, 12), (48, 12)));
    assert_eq!((map.get_pixel(5, 2).0, map.get_pixel(6, 2).0), ([255; 3], [0; 3]));
    // half of 1 in sRGB; 3 is white still
    assert_eq!((all.get_pixel(0, 0).0, all.get_pixel(5, 2).0), ([188; 3], [255; 3]));
    assert_eq!((all.get_pixel(21, 2).0, all.get_pixel(37, 2).0), ([188; 3], [255; 3]));
}
