//! Animation: the scene of each frame, and every mistake with its place.

use super::CAMERA;
use std::path::Path;
use terrarium::description::*;

fn load_frame(text: &str, frame: u32, set: &[&str]) -> Result<Loaded, Vec<String>> {
    let terms = Terms { frame: Some(frame), ..Terms::default() };
    let set: Vec<String> = set.iter().map(|s| s.to_string()).collect();
    let loaded = load_str_on(&terms, text, Format::Ron, Path::new(""), &set);
    loaded.map_err(|report| report.diagnostics.iter().map(|d| d.headline()).collect())
}

/// A scene with a ball whose values `keys` move.
fn scene(animation: &str) -> String {
    format!(
        "({CAMERA}, animation: ({animation}),
          materials: {{ \"chalk\": (diffuse: 0.5), \"brass\": (reflection: (0.9, 0.7, 0.3)) }},
          lights: {{ \"lamp\": sphere(center: (0, 3, 0), radius: 0.1, radiance: 5) }},
          objects: [(name: \"ball\", shape: sphere(radius: 1), material: \"chalk\", transform: [translate((0, 0, 0)), scale(2)])])"
    )
}

#[test]
fn every_kind_of_value_follows_its_keys() {
    let text = scene(
        r#"frames: 9, keys: {
            "objects.ball.transform.0.translate": linear([(frame: 1, value: (0, 0, 0)), (frame: 9, value: (8, -4, 0.8))]),
            "objects.0.transform.1.scale": smooth([(frame: 1, value: 2), (frame: 9, value: (1, 2, 3))]),
            "objects.ball.shape.radius": linear([(frame: 2, value: 1), (frame: 4, value: 2)]),
            "objects.ball.material": step([(frame: 1, value: "chalk"), (frame: 5, value: "brass")]),
            "materials.chalk.diffuse": linear([(frame: 1, value: 0), (frame: 9, value: (0.8, 0.4, 0))]),
            "lights.lamp.visible": step([(frame: 3, value: false)]),
            "lights.lamp.sphere.samples": step([(frame: 1, value: 2), (frame: 9, value: 7)]),
            "image.width": linear([(frame: 1, value: 100), (frame: 9, value: 180)]),
            "camera.target.1": linear([(frame: 1, value: 0), (frame: 9, value: 1)]),
        }"#,
    );
    let at = |frame| load_frame(&text, frame, &[]).unwrap_or_else(|found| panic!("{found:?}")).scene;
    let middle = at(5);
    let ball = &middle.objects[0];
    assert_eq!(ball.transform[0], Transform::Translate([4.0, -2.0, 0.4]));
    assert_eq!(ball.transform[1], Transform::Scale(Scale::PerAxis([1.5, 2.0, 2.5])));
    assert!(matches!(ball.shape, Shape::Sphere { radius: 2.0, .. }), "{:?}", ball.shape);
    assert_eq!(ball.material.as_deref(), Some("brass"));
    assert_eq!(
        middle.materials.get("chalk").map(|m| m.diffuse.clone()),
        Some(Source::Constant(Rgb([0.4, 0.2, 0.0])))
    );
    assert_eq!(middle.image.width, 140);
    assert_eq!(middle.camera.as_ref().map(|c| c.target), Some([0.0, 0.5, 0.0]));
    let lamp = |scene: &Scene| match scene.lights.get("lamp") {
        Some(Light::Sphere { visible, samples, .. }) => (*visible, *samples),
        other => panic!("{other:?}"),
    };
    assert_eq!((lamp(&middle), lamp(&at(9))), ((false, Some(2)), (false, Some(7))));
    assert_eq!(at(1).objects[0].material.as_deref(), Some("chalk"));
    assert!(matches!(at(3).objects[0].shape, Shape::Sphere { radius: 1.5, .. }));
    assert!(middle.animation.is_none());
}

#[test]
fn the_first_frame_is_the_still_and_each_frame_has_its_own_hash() {
    let still = load_frame(&scene("frames: 8"), 1, &[]).expect("valid");
    let text = scene("frames: 8, fps: 12.5, orbit: (deg: 90)");
    let hashes: Vec<[u8; 32]> = (1..=8).map(|f| load_frame(&text, f, &[]).expect("valid").hash).collect();
    assert_eq!((hashes[0], still.scene), (still.hash, load_frame(&text, 1, &[]).expect("valid").scene));
    assert_eq!(hashes.iter().collect::<std::collections::HashSet<_>>().len(), 8);
    let loaded = load_frame(&text, 3, &[]).expect("valid");
    assert_eq!(loaded.animation.map(|a| (a.frames, a.fps)), Some((8, 12.5)));
    // what is written in another way is the same frame
    let toml = to_string(&load_str_as_written(&text, Format::Ron, &[]).expect("it reads"), Format::Toml)
        .expect("it can be written");
    let terms = Terms { frame: Some(3), ..Terms::default() };
    let same = load_str_on(&terms, &toml, Format::Toml, Path::new(""), &[]).expect("valid");
    assert_eq!(same.hash, hashes[2]);
}

#[test]
fn overrides_come_before_keys_and_say_so_where_they_do_nothing() {
    let text = scene(
        r#"frames: 3, orbit: (deg: 360), keys: { "materials.chalk.diffuse": linear([(frame: 1, value: 0.25)]) }"#,
    );
    let loaded = load_frame(&text, 1, &["materials.chalk.diffuse=0.5"]).expect("valid");
    let diffuse = |loaded: &Loaded| loaded.scene.materials.get("chalk").map(|m| m.diffuse.clone());
    assert_eq!(diffuse(&loaded), Some(Source::Constant(Rgb::grey(0.25))));
    let warning = loaded.warnings.iter().map(|w| w.headline()).find(|w| w.contains("has keys"));
    assert!(warning.is_some_and(|w| w.contains("animation.keys")), "{:?}", loaded.warnings);
    let changed = load_frame(&text, 1, &["animation.keys={}", "materials.chalk.diffuse=0.5"]).expect("valid");
    assert_eq!(diffuse(&changed), Some(Source::Constant(Rgb::grey(0.5))));
    // the orbit starts from the camera that is set
    let moved = load_frame(&text, 1, &["camera.eye=(1,2,3)"]).expect("valid");
    assert_eq!(moved.scene.camera.map(|c| c.eye), Some([1.0, 2.0, 3.0]));
}

#[test]
fn every_mistake_has_its_place() {
    for (animation, frame, expected) in [
        ("frames: 0", 1, "animation.frames: 0 is outside [1, 1000000]"),
        ("frames: 4", 5, "animation.frames: there is no frame 5: they are numbered from 1 to 4"),
        ("frames: 4, fps: 0", 1, "animation.fps: 0 is not above 0"),
        ("frames: 4, fps: NaN", 1, "animation.fps: a finite number is expected"),
        ("frames: 4, orbit: (axis: (0, 0, 0))", 1, "animation.orbit.axis: this is no direction"),
        ("frames: 4, orbit: (degrees: 3)", 1, "there is no field `degrees`"),
        ("fps: 4", 1, "animation: `frames` is missing"),
        ("frames: 4, keys: { \"camera.fov_deg\": linear([]) }", 1, "a value needs at least one key"),
        (
            "frames: 4, keys: { \"camera.fov_deg\": linear([(frame: 2, value: 1), (frame: 2, value: 3)]) }",
            1,
            "camera.fov_deg\".linear.1: keys stand in the order of their frames",
        ),
        (
            "frames: 4, keys: { \"objects.bal.material\": step([(frame: 2, value: \"brass\")]) }",
            1,
            "animation.keys.\"objects.bal.material\": no entry is named `bal`; did you mean `ball`?",
        ),
        (
            "frames: 4, keys: { \"materials.bras.diffuse\": step([(frame: 2, value: 1)]) }",
            1,
            "no material `bras`; did you mean `brass`?",
        ),
        ("frames: 4, keys: { \"camera.fov\": step([(frame: 2, value: 1)]) }", 1, "there is no field `fov`"),
        (
            "frames: 4, keys: { \"objects.ball.material\": linear([(frame: 2, value: \"brass\")]) }",
            1,
            "linear.0: there is nothing between this and another value: `step` takes it",
        ),
        (
            "frames: 4, keys: { \"camera.eye\": smooth([(frame: 2, value: (0, 1, 2)), (frame: 3, value: (0, 1))]) }",
            1,
            "smooth.1: the keys' values have different numbers of components",
        ),
        (
            "frames: 4, keys: { \"camera.fov_deg\": linear([(frame: 1, value: 20), (frame: 4, value: 200)]) }",
            4,
            "camera.fov_deg: 200 is outside (0, 180)",
        ),
        (
            "frames: 4, keys: { \"image.width\": linear([(frame: 1, value: 20), (frame: 4, value: 21)]) }",
            2,
            "image.width: expected a whole number",
        ),
        (
            "frames: 4, keys: { \"animation.frames\": step([(frame: 1, value: 20)]) }",
            1,
            "`animation` is the same for all frames",
        ),
        (
            "frames: 4, keys: { \"camera..eye\": step([(frame: 1, value: 20)]) }",
            1,
            "a name is missing in the path",
        ),
    ] {
        let found = load_frame(&scene(animation), frame, &[]).expect_err("it is wrong");
        assert_eq!(found.len(), 1, "{animation}: {found:?}");
        assert!(found[0].contains(expected), "{animation}: {found:?}");
        assert!(found[0].starts_with("<input>:1:"), "no place: {found:?}");
    }
}

#[test]
fn many_values_with_keys_are_read_in_time_and_too_many_are_refused() {
    let tracks = |count: usize| {
        let objects: Vec<String> =
            (0..count).map(|_| "(shape: sphere(), material: \"m\")".to_owned()).collect();
        let keys: Vec<String> = (0..count)
            .map(|i| {
                format!("\"objects.{i}.shape.radius\": linear([(frame: 1, value: 1), (frame: 9, value: 2)])")
            })
            .collect();
        let text = format!(
            "({CAMERA}, animation: (frames: 9, keys: {{ {} }}), materials: {{ \"m\": () }}, objects: [{}])",
            keys.join(", "),
            objects.join(", ")
        );
        load_frame(&text, 5, &[])
    };
    let began = std::time::Instant::now();
    let loaded = tracks(5_000).expect("valid");
    assert!(matches!(loaded.scene.objects[4_999].shape, Shape::Sphere { radius: 1.5, .. }));
    assert!(began.elapsed().as_secs() < 20, "{:?}", began.elapsed());
    let refused = tracks(10_001).expect_err("too many");
    assert!(refused.len() == 1 && refused[0].contains("more than 10000 values"), "{refused:?}");
}
