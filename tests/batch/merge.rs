//! Parts of a render, put together in any order.

use super::{ADAPTIVE, CAUSTIC, Lab};
use std::fs;

/// Numbers of shards that are tried: some, or with `KILLS` (`make faults`) all up to 7.
fn numbers(some: &[u32]) -> Vec<u32> {
    if std::env::var_os("KILLS").is_some() { (1..=7).collect() } else { some.to_vec() }
}

/// Renders `n` shards with other threads and tiles each, and merges them from the last to the first.
pub(crate) fn in_parts(lab: &Lab, n: u32, more: &[&str]) -> Vec<u8> {
    let names: Vec<String> = (0..n).map(|i| format!("part{i}.exr")).collect();
    for (i, name) in names.iter().enumerate() {
        let (shard, threads) = (format!("{i}/{n}"), ["1", "2", "5"][i % 3]);
        lab.render(&[&["--shard", &shard, "--threads", threads, "-o", name], more].concat());
    }
    let mut words = vec!["merge", "-o", "merged.exr", "-o", "merged.png"];
    // 0, then from the last down: neither in order nor in reverse.
    words.push(&names[0]);
    words.extend(names[1..].iter().rev().map(String::as_str));
    lab.done(&words);
    lab.bytes("merged.exr")
}

#[test]
fn shards_of_passes_with_caustics_merge_to_the_bits_of_one_render() {
    let lab = Lab::new(CAUSTIC);
    let more = ["--passes", "9", "--aov", "normal,caustic,variance,bias,photons,samples"];
    lab.render(&[&["-o", "whole.exr", "-o", "whole.png"], &more[..]].concat());
    for n in numbers(&[2, 7]) {
        assert!(in_parts(&lab, n, &more) == lab.bytes("whole.exr"), "{n} shards");
        assert!(lab.bytes("merged.png") == lab.bytes("whole.png"), "{n} shards");
    }
}

#[test]
fn shards_of_tiles_with_adaptive_antialiasing_merge_to_the_bits_of_one_render() {
    let lab = Lab::new(ADAPTIVE);
    lab.render(&["-o", "whole.exr", "--aov", "edges,depth"]);
    for n in numbers(&[3]) {
        assert!(in_parts(&lab, n, &["--aov", "edges,depth"]) == lab.bytes("whole.exr"), "{n} shards");
    }
}

#[test]
fn shards_of_a_frame_merge_to_the_bits_of_that_frame() {
    let keys = r#"animation: (frames: 5, keys: {
        "lights.lamp.center": linear([(frame: 1, value: (1, 3, 0.5)), (frame: 5, value: (-1, 3, 0))]),
        "camera.fov_deg": linear([(frame: 1, value: 40), (frame: 5, value: 30)]),
    }),"#;
    let lab = Lab::new(&CAUSTIC.replacen('(', &format!("({keys}"), 1));
    let more = ["--frame", "4", "--passes", "8"];
    lab.render(&[&["-o", "whole.exr", "-o", "whole.png"], &more[..]].concat());
    lab.render(&["-o", "other.exr", "--frame", "3", "--passes", "8"]);
    assert!(lab.bytes("other.exr") != lab.bytes("whole.exr"), "frames differ");
    for n in numbers(&[7]) {
        assert!(in_parts(&lab, n, &more) == lab.bytes("whole.exr"), "{n} shards");
        assert!(lab.bytes("merged.png") == lab.bytes("whole.png"), "{n} shards");
    }
    // into a folder, each frame's parts have names of their own
    for i in 0..2 {
        let shard = format!("{i}/2");
        lab.render(&["--frames", "3-4", "--shard", &shard, "--passes", "8", "--out-dir", "parts"]);
    }
    let again = ["--frames", "3-4", "--shard", "1/2", "--passes", "8", "--out-dir", "parts"];
    let said = lab.done(&[&["render", "scene.ron"], &again[..]].concat());
    assert_eq!(said.matches("there already").count(), 2, "{said}");
    let said = lab.done(&[&["render", "scene.ron", "--again"], &again[..]].concat());
    assert_eq!(said.matches("there already").count(), 0, "{said}");
    let parts = [0, 1].map(|i| format!("parts/scene.0004.shard-000{i}-of-0002.exr"));
    lab.done(&["merge", &parts[0], &parts[1], "-o", "merged.exr"]);
    assert!(lab.bytes("merged.exr") == lab.bytes("whole.exr"));
    lab.render(&["--frame", "3", "--shard", "0/2", "--passes", "8", "-o", "a.exr"]);
    lab.render(&["--frame", "4", "--shard", "1/2", "--passes", "8", "-o", "b.exr"]);
    lab.fails(2, &["merge", "a.exr", "b.exr", "-o", "mixed.exr"]);
}

#[test]
fn several_shards_at_once_and_the_engines_numbers_name_the_same_parts() {
    let lab = Lab::new(CAUSTIC);
    lab.render(&["-o", "whole.exr", "--passes", "8"]);
    lab.render(&["--shards", "0-1,6", "--of", "8", "--passes", "8", "--out-dir", "parts"]);
    lab.render(&["--shards", "3-5", "--of", "8", "--passes", "8", "--out-dir", "parts"]);
    for (variable, i) in [("SLURM_ARRAY_TASK_ID", "2"), ("JOB_COMPLETION_INDEX", "7")] {
        let words =
            ["render", "scene.ron", "--shard", "auto", "--of", "8", "--passes", "8", "--out-dir", "parts"];
        let output = lab.command(&words).env(variable, i).output().expect("the program runs");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    lab.done(&["merge", "parts", "-o", "merged.exr"]);
    assert!(lab.bytes("merged.exr") == lab.bytes("whole.exr"));
    let said = lab.fails(2, &["render", "scene.ron", "--shard", "auto", "--of", "8", "-o", "x.exr"]);
    assert!(said.contains("no engine says"), "{said}");
}

#[test]
fn a_crop_is_divided_like_a_whole_image() {
    let lab = Lab::new(CAUSTIC);
    let more = ["--passes", "4", "--crop", "7,9,41,30"];
    lab.render(&[&["-o", "whole.exr"], &more[..]].concat());
    assert!(in_parts(&lab, 3, &more) == lab.bytes("whole.exr"));
}

#[test]
fn missing_doubled_and_foreign_parts_are_named() {
    let lab = Lab::new(CAUSTIC);
    for i in 0..4 {
        lab.render(&["--passes", "8", "--shard", &format!("{i}/4"), "-o", &format!("{i}.exr")]);
    }
    let said = lab.fails(2, &["merge", "0.exr", "3.exr", "-o", "out.exr"]);
    assert!(said.contains("of 4 shards, numbers 1-2 are not there"), "{said}");
    let said = lab.fails(2, &["merge", "0.exr", "1.exr", "2.exr", "3.exr", "1.exr", "-o", "out.exr"]);
    assert!(said.contains("shard 1 is there twice: in 1.exr and in 1.exr"), "{said}");
    let foreign: [(&[&str], &str); 7] = [
        (&["--passes", "8", "--seed", "3"], "the seed is 0 there and 3 here"),
        (&["--passes", "9"], "the range of passes"),
        (&["--passes", "8", "--set", "materials.glass.ior=1.4"], "the scene's hash"),
        (&["--passes", "8", "--without", "shadows"], "effects are overridden in another way: "),
        (&["--passes", "8", "--tile", "16"], "the side of a tile is "),
        (&["--passes", "8", "--crop", "0,0,20,20"], "the crop is "),
        (&["--passes", "8", "--aov", "normal"], "the list of further layers is "),
    ];
    for (more, difference) in foreign {
        lab.render(&[&["--shard", "1/4", "-o", "other.exr"], more].concat());
        let said = lab.fails(2, &["merge", "other.exr", "0.exr", "2.exr", "3.exr", "-o", "out.exr"]);
        let known = difference.split(" is ").next().expect("text");
        assert!(said.contains("0.exr is of another render than other.exr") && said.contains(known), "{said}");
    }
    lab.render(&["--passes", "8", "-o", "whole.exr"]);
    assert!(
        lab.fails(3, &["merge", "whole.exr", "-o", "out.exr"])
            .contains("without its sums: no part of one; parts are what")
    );
    let said = lab.fails(2, &["merge", "0.exr", "1.exr", "3.exr", "-o", "out.exr"]);
    assert!(said.contains("of 4 shards, number 2 is not there"), "{said}");
    fs::write(lab.path("text.exr"), "no image").expect("written");
    assert!(lab.fails(3, &["merge", "text.exr", "-o", "out.exr"]).contains("text.exr"));
    assert!(lab.fails(2, &["merge", "0.exr", "-o", "0.exr"]).contains("can't be an output"));
    assert!(!lab.names().contains(&"out.exr".to_owned()));
}

/// What is there is a render of fewer passes: with the same pixels as those passes alone, and an error that holds
/// against all of them.
#[test]
fn parts_that_are_there_make_an_honest_image() {
    let lab = Lab::new(CAUSTIC);
    for i in [0, 1, 3] {
        lab.render(&["--passes", "16", "--shard", &format!("{i}/4"), "-o", &format!("{i}.exr")]);
    }
    let said = lab.done(&["merge", "0.exr", "1.exr", "-o", "half.exr", "--allow-missing"]);
    assert!(
        said.contains("2 of 4 shards, 8 passes, error ")
            && said.contains("of 4 shards, numbers 2-3 are not there"),
        "{said}"
    );
    lab.render(&["--passes", "8", "-o", "first.exr"]);
    lab.done(&["diff", "half.exr", "first.exr", "--fail", "0", "-q"]);
    lab.done(&["merge", "0.exr", "3.exr", "1.exr", "-o", "most.exr", "--allow-missing"]);
    let json = lab.run(&["diff", "most.exr", "first.exr", "--json"]);
    assert!(!json.stdout.is_empty());
}

#[test]
fn a_damaged_part_is_refused() {
    let lab = Lab::new(CAUSTIC);
    lab.render(&["--passes", "2", "--shard", "0/1", "-o", "part.exr"]);
    let sound = lab.bytes("part.exr");
    let mut other = sound.clone();
    let at = sound.len() / 2;
    other[at] ^= 4;
    fs::write(lab.path("part.exr"), other).expect("written");
    assert!(lab.fails(3, &["merge", "part.exr", "-o", "out.exr"]).contains("damaged"));
    // what it says of itself: any byte of it
    let place = sound.windows(12).position(|bytes| bytes == b"\"sceneHash\":").expect("it says its scene");
    for at in (place..place + 1200).step_by(97) {
        let mut other = sound.clone();
        other[at] ^= 1;
        fs::write(lab.path("part.exr"), other).expect("written");
        let said = lab.fails(3, &["merge", "part.exr", "-o", "out.exr"]);
        assert!(said.contains("damaged: what it says of itself"), "{at}: {said}");
    }
    fs::write(lab.path("part.exr"), &sound[..sound.len() / 2]).expect("written");
    lab.fails(3, &["merge", "part.exr", "-o", "out.exr"]);
}

#[test]
fn shards_that_could_not_be_put_together_are_refused() {
    let lab = Lab::new(CAUSTIC);
    for (words, reason) in [
        (&["--shard", "4/4", "-o", "x.exr"][..], "a part is `2/8`"),
        (&["--shards", "3-9", "--of", "8", "-o", "x.exr"], "there is no shard 8 of 8"),
        (&["--shard", "0/2", "--time", "5s", "-o", "x.exr"], "known number of passes"),
        (&["--shard", "0/2", "--error", "5%", "-o", "x.exr"], "known number of passes"),
        (&["--shard", "0/2", "-o", "x.png"], "one EXR file"),
        (&["--shard", "0/2", "-o", "x.exr", "-o", "y.exr"], "one EXR file"),
        (&["--of", "2", "-o", "x.exr"], "--of goes with"),
        (&["--shard", "0/4", "--of", "5", "-o", "x.exr"], "--of says another number"),
        (&["--shard", "1/4000000000", "-o", "x.exr"], "1048576 parts at most"),
    ] {
        let said = lab.fails(2, &[&["render", "scene.ron", "--progress", "none"], words].concat());
        assert!(said.contains(reason), "{words:?}: {said}");
    }
}

/// What is rare is told of all parts together, and `--strict` refuses it; as it is after a checkpoint.
#[test]
fn what_is_unhealthy_in_the_parts_is_unhealthy_in_the_whole() {
    let lab = Lab::new(
        r#"(camera: (eye: (0, 0, 5), target: (0, 0, 0)), image: (width: 4, height: 4), photons: off,
        materials: { "white": (diffuse: 0.8) }, lights: { "sun": point(position: (0, 0, 1.5), intensity: 3e38) },
        objects: [(shape: sphere(radius: 1), material: "white")])"#,
    );
    let whole = lab.render(&["-o", "whole.exr", "--passes", "4"]);
    let told = |said: &str| {
        let line = said.lines().find(|line| line.contains("non-finite samples")).map(str::to_owned);
        line.unwrap_or_else(|| panic!("{said}"))
    };
    lab.render(&["--shard", "0/2", "-o", "a.exr", "--passes", "4"]);
    lab.render(&["--shard", "1/2", "-o", "b.exr", "--passes", "4"]);
    let merged = lab.done(&["merge", "b.exr", "a.exr", "-o", "merged.exr"]);
    let counted = |line: &str| line.split(", first").next().map(str::to_owned);
    assert_eq!(counted(&told(&merged)), counted(&told(&whole)));
    let refused = lab.fails(1, &["merge", "a.exr", "b.exr", "-o", "strict.exr", "--strict"]);
    assert!(refused.contains("unhealthy") && !lab.path("strict.exr").exists(), "{refused}");
}
