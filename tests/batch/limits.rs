//! What would take too much is refused before it is taken, and what is too long or too small is not.

use super::{ADAPTIVE, CAUSTIC, Lab};
use std::time::Instant;

/// Ten times as many spheres a level.
fn nested(levels: usize) -> String {
    let ten = |of: usize| vec![format!("(shape: instance(of: \"d{of}\"))"); 10].join(", ");
    let groups: Vec<String> =
        (1..=levels).map(|i| format!("\"d{i}\": (shape: group(objects: [{}]))", ten(i - 1))).collect();
    format!(
        "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), image: (width: 8, height: 8), antialiasing: none, background: 1,
        materials: {{ \"m\": () }},
        definitions: {{ \"d0\": (shape: sphere()), {} }},
        objects: [(shape: instance(of: \"d{levels}\"), material: \"m\")])",
        groups.join(",\n")
    )
}

#[test]
fn instances_are_counted_before_they_are_made() {
    let began = Instant::now();
    let lab = Lab::new(&nested(14));
    for command in [&["check", "scene.ron"][..], &["render", "scene.ron", "-o", "x.exr"]] {
        let said = lab.fails(2, command);
        assert!(said.contains("objects.0: places 100000000000000 instances at least"), "{said}");
        assert!(said.contains("scene.ron:17:19:"), "{said}");
    }
    let said = Lab::new(&nested(7)).fails(5, &["render", "scene.ron", "-o", "x.exr", "--memory", "1GiB"]);
    assert!(said.contains("the scene takes 10000000 instances × "), "{said}");
    assert!(began.elapsed().as_secs_f64() < 5.0, "{:?}", began.elapsed());
    Lab::new(&nested(3)).render(&["-o", "x.exr", "--memory", "1GiB"]);
}

/// How many photons a pass stores is known from the pilot, before any pass has scattered its own.
#[test]
fn photons_that_have_no_room_are_refused_before_they_are_scattered() {
    let began = Instant::now();
    let lab = Lab::new(CAUSTIC);
    for photons in ["progressive(count: 100000000)", "classic(count: 100000000, k: 50)"] {
        let set = format!("photons={photons}");
        let render =
            ["render", "scene.ron", "-o", "x.exr", "--passes", "1", "--memory", "1GiB", "--set", &set];
        let said = lab.fails(5, &render);
        assert!(said.contains("a pass stores about ") && said.contains("the limit is 1073741824"), "{said}");
    }
    assert!(began.elapsed().as_secs_f64() < 5.0, "{:?}", began.elapsed());
    lab.render(&["-o", "x.exr", "--passes", "1", "--memory", "1GiB"]);
}

#[test]
fn a_time_that_no_clock_can_add_is_no_limit() {
    let lab = Lab::new(ADAPTIVE);
    for more in [&["--time", "1e30h"][..], &["--set", "render.time_s=1e19"]] {
        lab.render(&[&["-o", "x.exr"], more].concat());
    }
}

#[test]
fn the_smallest_tiles_take_little_memory() {
    let lab = Lab::new(ADAPTIVE);
    let size = ["--set", "image.width=400", "--set", "image.height=400", "--set", "antialiasing=none"];
    let peak = |tile: &str| {
        lab.render(&[&["-o", "x.exr", "--tile", tile, "--stats", "stats.json"], &size[..]].concat());
        let stats: serde_json::Value = serde_json::from_slice(&lab.bytes("stats.json")).expect("statistics");
        stats["peak_bytes"].as_f64().expect("a number")
    };
    // A kilobyte a tile: its sums, and no tally of its own.
    let (small, large) = (peak("1"), peak("32"));
    assert!(small - large < 160_000.0 * 1024.0, "{small} and {large} bytes");
}

#[test]
fn layers_need_a_file_that_holds_them() {
    let lab = Lab::new(CAUSTIC);
    let said = lab.fails(2, &["render", "scene.ron", "-o", "x.png", "--aov", "albedo"]);
    assert!(said.contains("only EXR files have any"), "{said}");
}

#[test]
fn what_sums_cannot_hold_is_told() {
    let lab = Lab::new(
        r#"(camera: (eye: (0, 0, 1e39), target: (0, 0, 0)), image: (width: 8, height: 8), background: 1,
        materials: { "m": () }, objects: [(shape: sphere(radius: 1e38), material: "m")])"#,
    );
    let said = lab.render(&["-o", "x.exr", "--passes", "1", "--aov", "depth"]);
    assert!(said.contains("warning: the layer `depth` is cut to 3.5e13 at "), "{said}");
}

#[test]
fn a_setting_finds_names_as_messages_show_them() {
    let lab = Lab::new(&CAUSTIC.replace("\"floor\"", "\"a.b = c\""));
    let said = lab.fails(2, &["check", "scene.ron", "--set", "materials.\"a.b = c\".diffuse=1.5"]);
    assert!(said.contains("materials.\"a.b = c\".diffuse"), "{said}");
    lab.done(&["check", "scene.ron", "--set", "materials.\"a.b = c\".diffuse=0.5"]);
    let said = lab.fails(2, &["check", "scene.ron", "--set", "include=[\"x.ron\"]"]);
    assert!(said.contains("what is included is read before anything is set"), "{said}");
}
