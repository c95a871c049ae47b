//! One pixel of one pass, replayed: its value is that of the render, and its vertices say why.

use crate::render::shot::{Shot, focused};
use std::path::Path;
use std::process::{Command, Output};
use terrarium::math::Place;
use terrarium::render::{Replay, replay};
use terrarium::trace::{Event, Fate, SampleRecord};

/// Glass over a matt floor under a lamp, a sky and a mirror, with whatever else is asked for.
fn scene(more: &str) -> Shot {
    focused(format!(
        r#"(camera: (eye: (0.4, 2, 6), target: (0, 0.5, 0), fov_deg: 40), image: (width: 16, height: 12), {more},
        textures: {{ "check": checker(a: 0.2, b: 0.8, squares: (24, 24)) }},
        materials: {{ "floor": (diffuse: texture("check"), specular: 0.1, shininess: 20), "glass": (transmission: 1, absorption: (0.1, 0.2, 0.3)),
            "steel": (reflection: 0.8, diffuse: 0.5) }},
        lights: {{ "lamp": sphere(center: (-2, 4, 1), radius: 0.4, radiance: 30), "bulb": point(position: (3, 2, 3), intensity: 9),
            "sky": environment(map: gradient(zenith: (0.1, 0.2, 0.4), horizon: 0.3, nadir: 0.1)) }},
        objects: [(name: "ground", shape: quad(size: (12, 12)), material: "floor"),
            (name: "ball", shape: sphere(radius: 0.9), material: "glass", transform: [translate((0, 0.9, 0))]),
            (name: "block", shape: box(size: (1, 1, 1)), material: "steel", transform: [translate((2, 0.6, -1))])])"#
    ))
}

fn look(shot: &Shot, x: u32, y: u32, pass: u32) -> Replay {
    replay(&shot.load(), &shot.options, Place { x, y, pass }).unwrap_or_else(|error| panic!("{error}"))
}

fn sum(sample: &SampleRecord) -> [f32; 3] {
    sample.vertices.iter().fold([0.0; 3], |sum, v| std::array::from_fn(|c| sum[c] + v.adds[c]))
}

/// Every kind of antialiasing and photons: the pixel is the render's, bit for bit; a sample is the sum of its
/// vertices, bit for bit; the pixel is the mean of its samples.
#[test]
fn a_replay_is_the_pixel_of_the_pass() {
    for (more, passes) in [
        ("antialiasing: progressive, photons: progressive(count: 5000)", &[0, 5][..]),
        (
            "antialiasing: progressive, indirect: 2, indirect_by: paths, photons: progressive(count: 5000)",
            &[3],
        ),
        (
            "antialiasing: progressive, indirect: true, indirect_by: photons, photons: progressive(count: 5000)",
            &[2],
        ),
        ("antialiasing: none, photons: classic(count: 5000, k: 30)", &[0, 2]),
        ("antialiasing: grid(3), photons: off", &[1]),
        ("antialiasing: adaptive(threshold: 0.1, depth: 3), photons: progressive(count: 5000)", &[0, 1]),
    ] {
        let shot = scene(more);
        for &pass in passes {
            let image = shot.clone().pass_range(pass..pass + 1).render().rgb();
            for (x, y) in [(0, 0), (8, 6), (7, 8), (11, 5), (15, 11), (3, 9)] {
                let found = look(&shot, x, y, pass);
                let pixel = image[(y * 16 + x) as usize];
                assert_eq!(found.value, pixel, "({x}, {y}) of pass {pass}: {more}");
                assert!(found.finite);
                let mut mean = [0.0; 3];
                for sample in &found.samples {
                    assert_eq!(sum(sample), sample.radiance, "({x}, {y}) of pass {pass}: {more}");
                    (0..3).for_each(|c| mean[c] += sample.weight * f64::from(sample.radiance[c]));
                }
                for (mean, value) in mean.into_iter().zip(found.value) {
                    assert!((mean - f64::from(value)).abs() <= 1e-6 * mean, "{mean}, {value}: {more}");
                }
            }
        }
    }
}

/// The middle of the picture looks into the ball: Fresnel at the entrance, what is inside, and what follows.
#[test]
fn vertices_tell_what_happened_and_where() {
    let shot = scene("antialiasing: none, photons: off");
    let found = look(&shot, 8, 5, 0);
    let [sample] = &found.samples[..] else { panic!("one sample") };
    let first = &sample.vertices[0];
    let met = first.met.as_ref().expect("the ball");
    assert_eq!((met.object.as_str(), met.material.as_str(), first.by), ("ball", "glass", Event::Camera));
    let [x, y, z] = met.position;
    assert!(((x * x + (y - 0.9) * (y - 0.9) + z * z).sqrt() - 0.9).abs() < 1e-9, "{met:?}");
    let interface = first.interface.as_ref().expect("glass");
    assert_eq!((interface.near_ior, interface.far_ior), (1.0, 1.5));
    let [reflected, refracted] = &first.sends[..] else { panic!("two ways on: {first:?}") };
    assert_eq!((reflected.event, refracted.event), (Event::Reflected, Event::Refracted));
    assert_eq!(f64::from(reflected.throughput[0]) as f32, interface.reflectance as f32);
    let inside = &sample.vertices[refracted.to.expect("it is followed")];
    assert_eq!((inside.from, inside.by), (Some(0), Event::Refracted));
    // Beer–Lambert over the way inside.
    let way = inside.met.as_ref().expect("the ball again").distance;
    let expected = f64::from(refracted.throughput[2]) * (-0.3 * way).exp();
    assert!((f64::from(inside.throughput[2]) - expected).abs() < 1e-6, "{inside:?}");
    let floor = sample.vertices.iter().find(|v| v.met.as_ref().is_some_and(|m| m.object == "ground"));
    let lights: Vec<&str> = floor.expect("the floor").lights.iter().map(|l| l.light.as_str()).collect();
    assert_eq!(lights, ["lamp", "bulb", "sky"]);
    for (i, vertex) in sample.vertices.iter().enumerate().skip(1) {
        let from = &sample.vertices[vertex.from.expect("only the first comes from the eye")];
        assert!(
            from.sends.iter().any(|s| s.to == Some(i) && s.event == vertex.by && s.fate == Fate::Followed)
        );
    }
    // A vertex adds its throughput times the light that leaves from it.
    for vertex in &sample.vertices {
        let Some(_) = &vertex.met else { continue };
        let light: f32 = vertex.lights.iter().map(|l| l.radiance[0]).sum();
        let expected = vertex.throughput[0] * (vertex.emitted[0] + vertex.ambient[0] + light);
        assert!((vertex.adds[0] - expected).abs() <= 1e-5 * expected.abs(), "{vertex:?}");
    }
}

/// Photons are told by their number; the depth limit and surfaces within others by what they do.
#[test]
fn photons_and_limits_are_told() {
    let found = look(&scene("antialiasing: progressive, photons: progressive(count: 20000)"), 8, 8, 4);
    let vertices = || found.samples.iter().flat_map(|sample| &sample.vertices);
    assert!(vertices().any(|v| v.caustic.is_some_and(|c| c.photons > 0 && c.radius > 0.0)), "{found:?}");
    let found = look(&scene("antialiasing: none, photons: off, render: (max_depth: 2)"), 8, 5, 0);
    let sends = found.samples.iter().flat_map(|s| &s.vertices).flat_map(|v| &v.sends);
    assert!(sends.into_iter().any(|s| s.fate == Fate::DepthLimit && s.to.is_none()), "{found:?}");
}

fn program(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_terrarium"));
    command.current_dir(folder).args(arguments).output().expect("the program starts")
}

/// A lamp whose light overflows single precision: the message names the pixel and how to look at it.
#[test]
fn what_was_dropped_can_be_replayed_by_its_message() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(
        folder.path().join("hot.ron"),
        r#"(camera: (eye: (0, 0, 5), target: (0, 0, 0)), image: (width: 4, height: 4),
            materials: { "white": (diffuse: 0.8) }, lights: { "sun": point(position: (0, 0, 1.5), intensity: 3e38) },
            objects: [(name: "ball", shape: sphere(radius: 1), material: "white")])"#,
    )
    .expect("written");
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).expect("UTF-8");
    let done = program(folder.path(), &["render", "hot.ron", "-o", "a.exr", "--passes", "2"]);
    let said = text(&done.stderr);
    assert!(done.status.success() && said.contains("non-finite samples"), "{said}");
    let options = said.split("with `").nth(1).and_then(|rest| rest.split('`').next()).expect("a command");
    let words: Vec<&str> = options.split(' ').collect();
    assert!(matches!(words[..], ["--pixel", _, "--pass", _]), "{options}");
    let arguments = [&["render", "hot.ron"], &words[..]].concat();
    let replayed = program(folder.path(), &arguments);
    let told = text(&replayed.stdout);
    assert!(replayed.status.success(), "{}", text(&replayed.stderr));
    assert!(told.contains("not finite: dropped") && told.contains("light `sun`: (inf, inf, inf)"), "{told}");
    let strictly = program(folder.path(), &[&arguments[..], &["--strict"]].concat());
    assert_eq!(strictly.status.code(), Some(1), "{}", text(&strictly.stderr));
    assert!(text(&strictly.stdout) == told, "it is told all the same");
    let strict = program(folder.path(), &["render", "hot.ron", "-o", "b.exr", "--strict"]);
    let said = text(&strict.stderr);
    assert!(strict.status.code() == Some(1) && said.contains("--pixel"), "{said}");
    assert!(!folder.path().join("b.exr").exists());
}

/// A sample at a corner on the image's border that is dropped is the last pixel's; one that is finite but more than
/// can be added up is told as dropped too.
#[test]
fn dropped_samples_at_the_border_and_beyond_the_sums_are_told_as_such() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let hot = |antialiasing: &str, x: f64, width: f64| {
        format!(
            r#"(camera: (eye: (0, 0, 4), target: (0, 0, 0), fov_deg: 40), image: (width: 16, height: 16), antialiasing: {antialiasing},
            materials: {{ "hot": (emission: 1e14), "dim": (emission: 1) }},
            objects: [(shape: box(size: ({width}, 9, 0.001)), material: "hot", transform: [translate(({x}, 0, 0))]),
                (shape: box(size: (0.15, 9, 0.001)), material: "dim", transform: [translate((1.35, 0, 0))])])"#
        )
    };
    let cases =
        [("adaptive(threshold: 0.05, depth: 3)", 1.4559, 0.012), ("none", 0.0, 0.3), ("grid(2)", 0.0, 0.3)];
    for (antialiasing, x, width) in cases {
        std::fs::write(folder.path().join("hot.ron"), hot(antialiasing, x, width)).expect("written");
        let done = program(folder.path(), &["render", "hot.ron", "-o", "a.exr", "--passes", "1"]);
        let said = String::from_utf8_lossy(&done.stderr).into_owned();
        let options = said.split("with `").nth(1).and_then(|rest| rest.split('`').next());
        let options = options.unwrap_or_else(|| panic!("{antialiasing}: {said}"));
        let arguments = [&["render", "hot.ron"], &options.split(' ').collect::<Vec<_>>()[..]].concat();
        let replayed = program(folder.path(), &arguments);
        let told = String::from_utf8_lossy(&replayed.stdout).into_owned();
        assert!(replayed.status.success(), "{antialiasing}: {}", String::from_utf8_lossy(&replayed.stderr));
        assert!(told.contains("beyond 3.5e13: dropped"), "{antialiasing}, {options}: {told}");
        let json = program(folder.path(), &[&arguments[..], &["--json"]].concat());
        assert!(String::from_utf8_lossy(&json.stdout).contains("\"finite\": false"), "{antialiasing}");
    }
}

#[test]
fn the_program_prints_text_or_json_and_refuses_what_makes_no_sense() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(
        folder.path().join("s.ron"),
        r#"(camera: (eye: (0, 0, 5), target: (0, 0, 0)), image: (width: 8, height: 8),
            materials: { "glass": (transmission: 1) }, lights: { "sky": environment(map: constant(0.5)) },
            objects: [(name: "ball", shape: sphere(radius: 1), material: "glass")])"#,
    )
    .expect("written");
    let run = |words: &str| {
        let arguments: Vec<&str> = ["render", "s.ron"].into_iter().chain(words.split(' ')).collect();
        let done = program(folder.path(), &arguments);
        (done.status.code(), String::from_utf8(done.stdout).expect("UTF-8"))
    };
    let (code, text) = run("--pixel 4,4 --pass 2");
    assert_eq!(code, Some(0));
    for part in ["pixel (4, 4), pass 2", "`ball` of `glass`", "1.00000 → 1.50000", "leaves the scene"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let (code, json) = run("--pixel 4,4 --pass 2 --json");
    let found: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!((code, &found["pass"], &found["finite"]), (Some(0), &2.into(), &true.into()));
    assert_eq!(found["samples"][0]["vertices"][0]["met"]["object"], "ball");
    assert_eq!(found["samples"][0]["vertices"][0]["by"], "camera");
    for wrong in [
        "--pixel 4,4 -o a.exr",
        "--pixel 8,0",
        "--pixel 4",
        "--pass 2",
        "--json -o a.exr",
        "--pixel 0,0 --pass 4294967295",
        "--pixel 0,0 --stats a.json",
    ] {
        assert_eq!(run(wrong), (Some(2), String::new()), "{wrong}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).expect("the folder").count(), 1, "nothing is written");
}
