//! RON and TOML say the same, whatever the layout, and convert into each other.

use super::{FULL_RON, folder, full};
use std::path::Path;
use terrarium::description::{Format, load, load_str, load_str_as_written, to_string};

#[test]
fn ron_and_toml_say_the_same_scene() {
    let ron = load(&folder().join("full.ron"), &[]).unwrap_or_else(|report| panic!("{report}"));
    let toml = load(&folder().join("full.toml"), &[]).unwrap_or_else(|report| panic!("{report}"));
    assert_eq!(ron.scene, toml.scene);
    assert_eq!(ron.hash, toml.hash);
    assert!(ron.warnings.is_empty(), "{:?}", ron.warnings);
    assert_eq!(ron.files, [folder().join("full.ron")]);
}

#[test]
fn converted_scenes_are_equal_and_stay_as_they_are() {
    let scene = load_str_as_written(FULL_RON, Format::Ron, &[]).unwrap_or_else(|report| panic!("{report}"));
    for format in [Format::Ron, Format::Toml] {
        let text = to_string(&scene, format).expect("every scene has a text");
        let again =
            load_str_as_written(&text, format, &[]).unwrap_or_else(|report| panic!("{report}\n{text}"));
        assert_eq!(scene, again, "{text}");
        assert_eq!(text, to_string(&again, format).expect("every scene has a text"));
        let hash =
            |text: &str, format| full(text, format, &[]).unwrap_or_else(|r| panic!("{r}\n{text}")).hash;
        assert_eq!(hash(&text, format), hash(FULL_RON, Format::Ron));
    }
}

#[test]
fn converted_ron_keeps_to_the_grammar_of_ron() {
    let scene = load_str_as_written(FULL_RON, Format::Ron, &[]).unwrap_or_else(|report| panic!("{report}"));
    let text = to_string(&scene, Format::Ron).expect("every scene has a text");
    for text in [&text, FULL_RON] {
        ron::from_str::<serde::de::IgnoredAny>(text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    }
}

#[test]
fn layout_and_folder_leave_the_hash_alone_and_values_do_not() {
    let hash = |text: &str, overrides: &[&str]| {
        full(text, Format::Ron, overrides).unwrap_or_else(|r| panic!("{r}")).hash
    };
    let plain = hash(FULL_RON, &[]);
    assert_eq!(plain, hash(&FULL_RON.replace('\n', "\r\n"), &[]));
    assert_eq!(plain, hash(&format!("\u{feff}{}", FULL_RON.replace("    ", " ")), &[]));
    let relative = load_str(FULL_RON, Format::Ron, Path::new("tests/description"), &[])
        .expect("tests run in the package");
    assert_eq!(plain, relative.hash);
    assert_ne!(plain, hash(FULL_RON, &["render.seed=8"]));
    assert_ne!(plain, hash(FULL_RON, &["camera.fov_deg=40.000000000000007"]));
}

#[test]
fn explicit_and_implicit_some_and_both_brackets_are_read() {
    let scene = |text: &str| load_str_as_written(text, Format::Ron, &[]).unwrap_or_else(|r| panic!("{r}"));
    let plain = scene("(camera: (eye: (0, 1, 2), target: (0, 0, 0), focus_m: 3))");
    assert_eq!(plain, scene("(camera: Some((eye: [0, 1.0, 2e0], target: [0, 0, 0,], focus_m: Some(3.0))))"));
    assert_eq!(
        plain,
        scene(
            "#![enable(implicit_some)]\n/* /* */ */ Scene(camera: Camera(eye: (0, 1, 2), target: (0, 0, 0), focus_m: 3)) // end"
        )
    );
    let sphere = scene("(objects: [(shape: sphere())])");
    let toml = load_str_as_written("objects = [{ shape = { sphere = {} } }]", Format::Toml, &[]);
    assert_eq!(Some(sphere), toml.ok());
    let scatter = "of: [\"a\"], over: \"b\", count: 3";
    let flat = scene(&format!("(objects: [(shape: scatter({scatter}))])"));
    assert_eq!(flat, scene(&format!("(objects: [(shape: scatter(({scatter})))])")));
}
