//! Scene files as a user has them: both formats, `include`, `--set`, conversion, the schema, and
//! malformed texts of every sort.

use std::path::{Path, PathBuf};
use terrarium::description::{Format, Loaded, Object, Report, Scene, Shape};
use terrarium::description::{json_schema, load, load_str, load_str_as_written, to_string};

const FULL_RON: &str = include_str!("description/full.ron");
const FULL_TOML: &str = include_str!("description/full.toml");

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/description")
}

fn full(text: &str, format: Format, overrides: &[&str]) -> Result<Loaded, Report> {
    let overrides: Vec<String> = overrides.iter().map(|s| s.to_string()).collect();
    load_str(text, format, &folder(), &overrides)
}

fn full_scene(overrides: &[&str]) -> Scene {
    full(FULL_RON, Format::Ron, overrides).unwrap_or_else(|report| panic!("{report}")).scene
}

fn refused(overrides: &[&str]) -> Vec<String> {
    let report = full(FULL_RON, Format::Ron, overrides).expect_err("the override is wrong");
    report.diagnostics.iter().map(|d| d.headline()).collect()
}

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

#[test]
fn set_reaches_every_kind_of_place() {
    let scene = full_scene(&[
        "materials.glass.ior=1.33",
        "image.width=64",
        "objects.0.material=glass",
        "objects.gem.material=water",
        "lights.ball.sphere.radius=0.2",
        "lights.ball.samples=9",
        "antialiasing=grid(2)",
        "render.passes=3",
        "camera.eye=(1, 2, 3)",
        "camera.target.1=0.25",
        "objects.gem.transform.2.scale=0.75",
        "textures.photo.path=./wood.png",
        "materials.water.diffuse=texture(\"squares\")",
        "materials.lamp.shininess=20",
        "textures.photo.wrap=clamp",
    ]);
    let plain = full_scene(&[]);
    let mut expected = full_scene(&[]);
    use terrarium::description::*;
    expected.image.width = 64;
    expected.antialiasing = Antialiasing::Grid(2);
    expected.render.passes = Some(3);
    expected
        .camera
        .as_mut()
        .map(|c| (c.eye, c.target[1]) = ([1.0, 2.0, 3.0], 0.25))
        .expect("it has a camera");
    expected.objects[0].material = Some("glass".into());
    expected.objects[2].material = Some("water".into());
    expected.objects[2].transform[2] = Transform::Scale(Scale::Uniform(0.75));
    for (name, material) in expected.materials.iter_mut() {
        match name {
            "glass" => material.ior = Some(Ior::Number(1.33)),
            "lamp" => material.shininess = Some(20.0),
            "water" => {
                material.diffuse =
                    Source::Texture(TextureRef { name: "squares".into(), scale: Rgb::grey(1.0) })
            }
            _ => {}
        }
    }
    for (name, light) in expected.lights.iter_mut() {
        if let ("ball", Light::Sphere { radius, samples, .. }) = (name, light) {
            (*radius, *samples) = (0.2, Some(9));
        }
    }
    for (name, texture) in expected.textures.iter_mut() {
        if let ("photo", Texture::Image { path, wrap, .. }) = (name, texture) {
            *path = folder().join("./wood.png").display().to_string();
            *wrap = Wrap::Clamp;
        }
    }
    assert_eq!(scene, expected);
    assert_ne!(scene, plain);
    let toml = full(FULL_TOML, Format::Toml, &["lights.ball.radius=0.2", "objects.gem.kind=cube"]);
    let headlines: Vec<String> =
        toml.err().map(|r| r.diagnostics.iter().map(|d| d.headline()).collect()).unwrap_or_default();
    assert_eq!(
        headlines,
        ["--set objects.gem.kind=cube:13: error: objects.2: there is no field `kind` here"]
    );
    let shorthand = full(FULL_TOML, Format::Toml, &["lights.ball.radius=0.2", "objects.gem.shape.kind=cube"]);
    let direct = full(
        FULL_RON,
        Format::Ron,
        &["lights.ball.sphere.radius=0.2", "objects.2.shape.polyhedron.kind=cube"],
    );
    assert_eq!(shorthand.ok().map(|l| l.hash), direct.ok().map(|l| l.hash));
}

#[test]
fn wrong_overrides_are_reported_in_the_argument() {
    let cases = [
        (
            "materials.glas.ior=1.33",
            "--set materials.glas.ior=1.33:11: error: no material `glas`; did you mean `glass`?",
        ),
        (
            "materials.glass.iro=1.33",
            "--set materials.glass.iro=1.33:17: error: materials.glass: there is no field `iro` here; did you mean `ior`?",
        ),
        (
            "image.width=wide",
            "--set image.width=wide:13: error: image.width: expected a whole number from 0 to 4294967295, found `wide`",
        ),
        ("image.width=0", "--set image.width=0:13: error: image.width: 0 is outside [1, 65536]"),
        (
            "objects.gme.material=glass",
            "--set objects.gme.material=glass:9: error: no entry is named `gme`; did you mean `gem`? (known: `floor`, `pillar`, `gem`, `tree`, `two`, `meadow`, `glow`, `cube`)",
        ),
        (
            "objects.99.material=glass",
            "--set objects.99.material=glass:9: error: there is no entry 99, the list has 8",
        ),
        (
            "objects.0.material=glas",
            "--set objects.0.material=glas:20: error: objects.0.material: no material `glas`; did you mean `glass`?",
        ),
        (
            "antialiasing=gird(2)",
            "--set antialiasing=gird(2):14: error: antialiasing: there is no `gird` here; did you mean `grid`?",
        ),
        (
            "antialiasing=grid(0)",
            "--set antialiasing=grid(0):19: error: antialiasing.grid: 0 is outside [1, 64]",
        ),
        ("image.width", "--set image.width:1: error: expected path.to.key=value"),
        ("image..width=1", "--set image..width=1:7: error: a name is missing in the path"),
        ("camera.eye=(1,2", "--set camera.eye=(1,2:12: error: camera.eye: expected 3 values, found `(1,2`"),
        (
            "camera.fov_deg=1e999",
            "--set camera.fov_deg=1e999:16: error: camera.fov_deg: a finite number is expected, this is infinite or beyond 1.8e308",
        ),
    ];
    for (argument, expected) in cases {
        assert_eq!(refused(&[argument]), [expected]);
    }
}

fn write(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().expect("it is in the folder")).expect("a folder can be made");
    std::fs::write(&path, text).expect("a file can be written");
    path
}

const CAMERA: &str = "camera: (eye: (0, 0, 5), target: (0, 0, 0)), ambient: 1";

#[test]
fn include_takes_in_both_formats_with_paths_of_their_own_folder() {
    let temp = tempfile::tempdir().expect("a folder can be made");
    let main = write(
        temp.path(),
        "main.ron",
        &format!(
            "({CAMERA}, include: [\"lib/a.toml\", \"lib/b.ron\"], materials: {{ \"m\": (diffuse: 0.5) }}, objects: [(name: \"first\", shape: sphere(), material: \"glass\")])"
        ),
    );
    write(
        temp.path(),
        "lib/a.toml",
        "include = [\"deep/c.ron\"]\n[materials.glass]\ntransmission = 1\n[[objects]]\nmaterial = \"m\"\nshape.mesh = { path = \"t.obj\" }\n",
    );
    write(
        temp.path(),
        "lib/b.ron",
        "(include: [\"deep/c.ron\"], lights: { \"l\": point(position: (0, 1, 0), intensity: 1) })",
    );
    write(temp.path(), "lib/deep/c.ron", "(definitions: { \"d\": (shape: mesh(path: \"../t.obj\")) })");
    write(temp.path(), "lib/t.obj", "v 0 0 0\n");
    let loaded = load(&main, &["objects.0.name=main".into()]).unwrap_or_else(|r| panic!("{r}"));
    assert_eq!(loaded.files.len(), 4);
    assert!(loaded.scene.include.is_empty());
    assert_eq!(loaded.scene.objects[0].name.as_deref(), Some("main"));
    let path = |object: &Object| match &object.shape {
        Shape::Mesh { path, .. } => path.clone(),
        _ => String::new(),
    };
    for object in [&loaded.scene.objects[1], loaded.scene.definitions.get("d").expect("it is included")] {
        assert!(Path::new(&path(object)).is_file(), "{}", path(object));
    }
    let elsewhere = tempfile::tempdir().expect("a folder can be made");
    let copy = elsewhere.path().join("moved");
    std::fs::rename(temp.path(), &copy).expect("a folder can be moved");
    let moved =
        load(&copy.join("main.ron"), &["objects.0.name=main".into()]).unwrap_or_else(|r| panic!("{r}"));
    assert_eq!(moved.hash, loaded.hash);
    std::fs::rename(&copy, temp.path()).expect("a folder can be moved");
}

#[test]
fn wrong_includes_are_reported_where_they_are() {
    let temp = tempfile::tempdir().expect("a folder can be made");
    let at = |name: &str| temp.path().join(name).display().to_string();
    let main = write(
        temp.path(),
        "main.ron",
        &format!(
            "({CAMERA},\n include: [\"a.ron\", \"none.ron\", \"x.txt\", \"bad.ron\"],\n materials: {{ \"m\": (diffuse: 2) }})"
        ),
    );
    write(
        temp.path(),
        "a.ron",
        "(image: (width: 3), include: [\"b.toml\"], material: {},\n materials: { \"m\": (), \"n\": (specular: -1) })",
    );
    write(temp.path(), "b.toml", "include = [\"a.ron\", \"main.ron\"]\nmaterials = 3\n");
    write(temp.path(), "bad.ron", "(materials: {");
    let report = load(&main, &[]).expect_err("nearly everything is wrong");
    assert_eq!(report.exit_code(), 2);
    let found: Vec<String> = report.diagnostics.iter().map(|d| d.headline()).collect();
    let (m, a, b) = (at("main.ron"), at("a.ron"), at("b.toml"));
    let expected = [
        format!(
            "{m}:2:21: error: `{}` cannot be read: No such file or directory (os error 2)",
            at("none.ron")
        ),
        format!("{m}:2:33: error: `x.txt` does not end in .ron or .toml"),
        format!("{m}:3:30: error: materials.m.diffuse: 2 is outside [0, 1]"),
        format!("{a}:1:2: error: `image` belongs to the main file, an included file cannot set it"),
        format!("{a}:1:42: error: there is no field `material` here; did you mean `materials`?"),
        format!("{a}:2:15: error: materials: `m` is given twice; the first is at {m}:3:15"),
        format!("{a}:2:40: error: materials.n.specular: -1 is outside [0, 1]"),
        format!("{b}:1:12: error: files include each other: {a} → {b} → {a}"),
        format!("{b}:1:21: error: files include each other: {m} → {a} → {b} → {m}"),
        format!("{b}:2:13: error: expected a map from names to entries, found `3`"),
        format!("{}:1:14: error: a name in quotes is expected", at("bad.ron")),
    ];
    assert_eq!(found, expected, "\n{report}");
}

#[test]
fn files_that_cannot_be_read_are_io_errors() {
    let missing = load(Path::new("no/such/scene.ron"), &[]).expect_err("there is no such file");
    assert_eq!(missing.exit_code(), 3);
    let temp = tempfile::tempdir().expect("a folder can be made");
    let latin = temp.path().join("latin.toml");
    std::fs::write(&latin, b"# one\n# caf\xe9\n").expect("a file can be written");
    let report = load(&latin, &[]).expect_err("it is not UTF-8");
    assert_eq!(report.exit_code(), 2);
    assert_eq!(
        report.diagnostics[0].headline(),
        format!("{}:2:6: error: byte 11 is not valid UTF-8", latin.display())
    );
    let lost = format!(
        "({CAMERA}, objects: [(shape: mesh(path: \"tre.obj\"), material: \"m\")], materials: {{ \"m\": () }})"
    );
    let report = load_str(&lost, Format::Ron, &folder(), &[]).expect_err("the mesh is missing");
    assert_eq!(report.exit_code(), 3);
    let message = format!(
        "`{}` cannot be read: there is no such file; did you mean `tree.obj`?",
        folder().join("tre.obj").display()
    );
    assert_eq!(report.diagnostics[0].message, message);
    let json = serde_json::to_value(&report.diagnostics[0]).expect("diagnostics have a JSON form");
    assert_eq!(json["kind"], "io");
    assert_eq!(json["path"], "objects.0.shape.mesh.path");
}

/// Reads a text and lays out the report; only panics matter.
fn survives(text: &str, format: Format) {
    if let Err(report) = full(text, format, &[]) {
        assert!(!report.to_string().is_empty());
        assert!(report.errors().next().is_some());
    }
}

#[test]
fn scenes_cut_off_at_any_byte_are_refused_without_panic() {
    for (text, format) in [(FULL_RON, Format::Ron), (FULL_TOML, Format::Toml)] {
        for end in (0..text.len()).filter(|end| text.is_char_boundary(*end)) {
            survives(&text[..end], format);
        }
    }
}

#[test]
fn scenes_with_random_bytes_are_read_without_panic() {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = move |n: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % n
    };
    let snippets: Vec<&[u8]> = vec![
        b"(",
        b")",
        b"\"",
        b"{",
        b"}",
        b"[",
        b"]",
        b":",
        b"=",
        b",",
        b"'",
        b"\\",
        b"1e999",
        b"NaN",
        b"-",
        b"r#\"",
        b"/*",
        b"//",
        b"\0",
        b"0x",
        b"\xc3\xa9",
        b"Some(",
        b"b\"",
        b"..",
        b"\n",
    ];
    for round in 0..4000 {
        let (text, format) = if round % 2 == 0 { (FULL_RON, Format::Ron) } else { (FULL_TOML, Format::Toml) };
        let mut bytes = text.as_bytes().to_vec();
        for _ in 0..1 + random(4) {
            let at = random(bytes.len());
            match random(4) {
                0 => bytes[at] = random(256) as u8,
                1 => drop(bytes.drain(at..(at + 1 + random(20)).min(bytes.len()))),
                2 => drop(bytes.splice(at..at, snippets[random(snippets.len())].iter().copied())),
                _ => {
                    let part = bytes[at..(at + random(60)).min(bytes.len())].to_vec();
                    let to = random(bytes.len());
                    bytes.splice(to..to, part);
                }
            }
            bytes.push(b' ');
        }
        survives(&String::from_utf8_lossy(&bytes), format);
    }
}

#[test]
fn deep_nesting_is_refused() {
    for open in ["(", "[", "{\"a\":", "a(", "(a:", "Some(", "/*"] {
        let report =
            load_str(&open.repeat(100_000), Format::Ron, Path::new(""), &[]).expect_err("it is too deep");
        assert_eq!(report.exit_code(), 2, "{open}");
    }
    for text in [
        "a = ".to_owned() + &"[".repeat(100_000),
        "a.".repeat(100_000) + "a = 1",
        "a = {a = ".repeat(100_000),
        format!("[{}a]", "a.".repeat(100_000)),
    ] {
        assert!(load_str(&text, Format::Toml, Path::new(""), &[]).is_err());
    }
    let mut groups = "(shape: sphere())".to_owned();
    for _ in 0..25 {
        groups = format!("(shape: group(objects: [{groups}]), material: \"m\")");
    }
    let text = format!("({CAMERA}, materials: {{ \"m\": () }}, objects: [{groups}])");
    assert!(load_str(&text, Format::Ron, Path::new(""), &[]).is_ok());
    let path = "a.".repeat(50_000) + "a=1";
    assert!(full(FULL_RON, Format::Ron, &[&path]).is_err());
}

/// The keys of a scene text, `key` followed by `:` or ` =`, with their offsets.
fn keys(text: &str, format: Format) -> Vec<(usize, &str)> {
    let mark = |rest: &str| match format {
        Format::Ron => rest.starts_with(':'),
        Format::Toml => rest.starts_with(" =") || rest.starts_with('.'),
    };
    let word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut found = Vec::new();
    let mut start: Option<usize> = None;
    for (i, c) in text.char_indices() {
        match (word(c), start) {
            (true, None) => start = Some(i),
            (false, Some(from)) => {
                let name: &str = &text[from..i];
                if mark(&text[i..])
                    && name.len() >= 3
                    && name.starts_with(|c: char| c.is_ascii_alphabetic())
                    && text.as_bytes()[from - 1] != b'"'
                {
                    found.push((from, name));
                }
                start = None;
            }
            _ => {}
        }
    }
    found
}

#[test]
fn every_misspelt_field_is_named_and_the_right_one_suggested() {
    let names = [
        "photo", "squares", "cubes", "clouds", "veins", "rings", "wall", "table", "tinted", "glass", "water",
        "mirror", "lamp", "bulb", "cone", "sun", "relief", "mixed", "ball", "panel", "plate", "sky", "blade",
        "ground", "pair", "bark", "leaf", "wood", "tree",
    ];
    let mut tried = 0;
    for (text, format) in [(FULL_RON, Format::Ron), (FULL_TOML, Format::Toml)] {
        for (at, key) in keys(text, format) {
            // names are free, only fields and variants can be misspelt; table headers name several places at once
            let line_start = text[..at].rfind('\n').map_or(0, |i| i + 1);
            let header = text[line_start..].starts_with(['[', '#', '/']);
            if header
                || names.contains(&key)
                    && !text[at..].starts_with("squares =")
                    && !text[at..].starts_with("squares:")
            {
                continue;
            }
            let middle = at + key.len() / 2;
            let wrong = format!("{}{}", &text[..middle], &text[middle + 1..]);
            let misspelt = format!("{}{}", &key[..key.len() / 2], &key[key.len() / 2 + 1..]);
            let report =
                full(&wrong, format, &[]).err().unwrap_or_else(|| panic!("`{misspelt}` at {at} passed"));
            let first = report.diagnostics.iter().find(|d| d.message.contains(&format!("`{misspelt}`")));
            let Some(first) = first else { panic!("`{misspelt}` is not named:\n{report}") };
            assert!(first.message.contains(&format!("did you mean `{key}`?")), "{report}");
            assert_eq!(report.errors().count(), 1, "`{misspelt}`:\n{report}");
            tried += 1;
        }
    }
    assert!(tried > 250, "only {tried} keys were tried");
}

#[test]
fn the_schema_accepts_the_full_scene_and_refuses_misspelt_ones() {
    let schema = json_schema();
    let value = |text: &str| {
        serde_json::to_value(toml::from_str::<toml::Table>(text).expect("it is TOML")).expect("no dates")
    };
    let problems = |text: &str| {
        let mut problems = Vec::new();
        validate(&schema, &schema, &value(text), "", &mut problems);
        problems
    };
    assert_eq!(problems(FULL_TOML), Vec::<String>::new());
    assert_eq!(problems("antialiasing = \"progressive\""), Vec::<String>::new());
    for wrong in [
        "camra = 1",
        "[camera]\neye = [1, 2]\ntarget = [0, 0, 0]",
        "[camera]\neye = [1, 2, 3]",
        "antialiasing = \"often\"",
        "[materials.a]\nior = \"glas\"",
        "[materials.a]\ndiffuse = { texture = 3 }",
        "[[objects]]\nshape.sphere = { radus = 1 }",
        "[image]\nwidth = -1",
    ] {
        assert!(!problems(wrong).is_empty(), "{wrong}");
    }
}

/// The part of JSON Schema that our schema uses; an unknown keyword is a problem too.
fn validate(
    root: &serde_json::Value,
    schema: &serde_json::Value,
    value: &serde_json::Value,
    at: &str,
    problems: &mut Vec<String>,
) {
    use serde_json::Value;
    let valid = |schema: &Value| {
        let mut inner = Vec::new();
        validate(root, schema, value, at, &mut inner);
        inner.is_empty()
    };
    let Some(rules) = schema.as_object() else { return };
    for (rule, argument) in rules {
        let ok = match rule.as_str() {
            "$schema" | "title" | "description" | "default" | "format" | "$defs" => true,
            "$ref" => {
                let pointer = argument.as_str().expect("a reference is a text").trim_start_matches('#');
                validate(
                    root,
                    root.pointer(pointer).expect("references lead somewhere"),
                    value,
                    at,
                    problems,
                );
                true
            }
            "type" => match argument.as_str() {
                Some("object") => value.is_object(),
                Some("array") => value.is_array(),
                Some("string") => value.is_string(),
                Some("boolean") => value.is_boolean(),
                Some("number") => value.is_number(),
                Some("integer") => value.is_i64() || value.is_u64(),
                _ => false,
            },
            "properties" => {
                for (key, schema) in argument.as_object().expect("properties are a map") {
                    if let Some(inner) = value.get(key) {
                        validate(root, schema, inner, &format!("{at}.{key}"), problems);
                    }
                }
                true
            }
            "additionalProperties" => {
                let known = rules.get("properties").and_then(Value::as_object);
                for (key, inner) in value.as_object().into_iter().flatten() {
                    if known.is_some_and(|known| known.contains_key(key)) {
                        continue;
                    }
                    match argument {
                        Value::Bool(false) => problems.push(format!("{at}: `{key}` is not known")),
                        schema => validate(root, schema, inner, &format!("{at}.{key}"), problems),
                    }
                }
                true
            }
            "required" => argument
                .as_array()
                .into_iter()
                .flatten()
                .all(|key| value.get(key.as_str().unwrap_or("")).is_some()),
            "items" => {
                for (i, inner) in value.as_array().into_iter().flatten().enumerate() {
                    validate(root, argument, inner, &format!("{at}.{i}"), problems);
                }
                true
            }
            "minItems" => value.as_array().is_none_or(|a| a.len() as u64 >= argument.as_u64().unwrap_or(0)),
            "maxItems" => value.as_array().is_none_or(|a| a.len() as u64 <= argument.as_u64().unwrap_or(0)),
            "anyOf" => argument.as_array().into_iter().flatten().any(valid),
            "oneOf" => argument.as_array().into_iter().flatten().filter(|s| valid(s)).count() == 1,
            "enum" => argument.as_array().is_some_and(|all| all.contains(value)),
            "const" => argument == value,
            "minimum" => value.as_f64().is_none_or(|x| x >= argument.as_f64().unwrap_or(0.0)),
            "maximum" => value.as_f64().is_none_or(|x| x <= argument.as_f64().unwrap_or(0.0)),
            "exclusiveMinimum" => value.as_f64().is_none_or(|x| x > argument.as_f64().unwrap_or(0.0)),
            "exclusiveMaximum" => value.as_f64().is_none_or(|x| x < argument.as_f64().unwrap_or(0.0)),
            other => {
                problems.push(format!("{at}: the validator does not know `{other}`"));
                true
            }
        };
        if !ok {
            problems.push(format!("{at}: {rule} {argument}"));
        }
    }
}

/// The `ron` blocks of a source text's documentation.
fn snippets(source: &str) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    let mut inside = false;
    for line in source.lines().map(str::trim) {
        match line.strip_prefix("///").map(str::trim) {
            Some("```ron") => {
                inside = true;
                found.push(String::new());
            }
            Some("```") => inside = false,
            Some(text) if inside => found.last_mut().expect("a block is open").extend([text, "\n"]),
            _ => {}
        }
    }
    found
}

#[test]
fn every_snippet_of_the_documentation_is_a_scene_and_every_variant_has_one() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/description");
    let mut all = String::new();
    for entry in std::fs::read_dir(folder).expect("the sources are there") {
        let path = entry.expect("the sources are there").path();
        if path.is_file() {
            let source = std::fs::read_to_string(&path).expect("a source can be read");
            for snippet in snippets(&source) {
                let scene = load_str_as_written(&format!("({snippet})"), Format::Ron, &[]);
                scene.unwrap_or_else(|report| panic!("{}:\n{report}", path.display()));
                all += &snippet;
            }
        }
    }
    let schema = json_schema();
    let mut tags = Vec::new();
    variants(&schema, &mut tags);
    assert!(tags.len() > 35, "{tags:?}");
    let values = ["auto", "linear", "repeat", "mirror"];
    for tag in tags.iter().filter(|tag| !values.contains(&tag.as_str())) {
        let shown = [format!("{tag}("), format!(": {tag}")].iter().any(|form| all.contains(form));
        assert!(shown, "no snippet shows `{tag}`");
    }
}

/// The names of all variants in a schema.
fn variants(schema: &serde_json::Value, tags: &mut Vec<String>) {
    use serde_json::Value;
    if let Some(Value::Array(options)) = schema.get("oneOf") {
        for option in options {
            let required = option.get("required").and_then(Value::as_array).and_then(|r| r.first());
            let listed = option.get("enum").and_then(Value::as_array).into_iter().flatten();
            let names = required.into_iter().chain(option.get("const")).chain(listed);
            tags.extend(names.filter_map(Value::as_str).map(str::to_owned));
        }
    }
    match schema {
        Value::Object(map) => map.values().for_each(|inner| variants(inner, tags)),
        Value::Array(items) => items.iter().for_each(|inner| variants(inner, tags)),
        _ => {}
    }
}
