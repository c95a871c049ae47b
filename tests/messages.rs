//! Wrong scenes and what is said about each, word for word: place, path, message.

use std::path::Path;
use terrarium::description::{Format, Report, load, load_str};

/// A scene of one line, its second; what a scene needs besides follows.
fn scene(line: &str) -> String {
    let rest = [
        ("camera", "camera: (eye: (0, 0, 5), target: (0, 0, 0)),\n"),
        ("ambient", "ambient: 1,\n"),
        ("materials", "materials: { \"m\": (diffuse: 0.5) },\n"),
    ];
    let rest: String = rest.iter().filter(|(key, _)| !line.contains(key)).map(|(_, text)| *text).collect();
    format!("(\n{line},\n{rest})")
}

fn headlines(report: &Report) -> Vec<String> {
    report.diagnostics.iter().map(|d| d.headline()).collect()
}

#[test]
fn each_mistake_is_named_with_its_place() {
    for (line, expected) in CASES {
        let found = match load_str(&scene(line), Format::Ron, Path::new("tests/description"), &[]) {
            Ok(loaded) => loaded.warnings.iter().map(|d| d.headline()).collect(),
            Err(report) => headlines(&report),
        };
        let found: Vec<&str> = found.iter().map(|line| line.trim_start_matches("<input>:")).collect();
        // that the line has a material too many or nothing to see is not its point
        let doubts =
            |line: &&str| !(line.ends_with("is not used") || line.ends_with("the scene has no objects"));
        assert_eq!(found.into_iter().filter(doubts).collect::<Vec<_>>(), *expected, "{line}");
    }
}

#[test]
fn whole_scenes_full_of_mistakes_are_reported_in_one_run() {
    for name in ["many.ron", "many.toml", "syntax.toml", "unclosed.ron"] {
        let path = Path::new("tests/bad_scenes").join(name);
        let report = load(&path, &[]).err().unwrap_or_else(|| panic!("{name} was read"));
        assert_eq!(report.exit_code(), 2);
        let expected = std::fs::read_to_string(format!("tests/bad_scenes/{name}.txt"))
            .expect("it lies beside the scene");
        let found: Vec<String> = headlines(&report)
            .iter()
            .map(|line| line.trim_start_matches("tests/bad_scenes/").to_owned())
            .collect();
        assert_eq!(found.join("\n"), expected.trim_end(), "{name}");
    }
}

#[test]
fn a_diagnostic_shows_the_line_the_place_and_what_helps() {
    let report = load_str(
        &scene("materials: { \"m\": (diffuse: 0.8, specular: 0.3) }"),
        Format::Ron,
        Path::new(""),
        &[],
    );
    let expected = "<input>:2:19: error: materials.m: gives back 1.1 of the light it gets: 0.8 by its layers and 0.3 by its highlight
 2 | materials: { \"m\": (diffuse: 0.8, specular: 0.3) },
   |                   ^
  help: lower `specular` to 0.2, or the layers (reflection, transmission, diffuse)";
    assert_eq!(report.err().map(|report| report.to_string()).as_deref(), Some(expected));
}

const CASES: &[(&str, &[&str])] = &[
    (
        "camera: (eye: (0, 0, 0), target: (0, 0, 0))",
        &["2:34: error: camera.target: the camera's target is its eye: it looks nowhere"],
    ),
    (
        "camera: (eye: (0, 0), target: (0, 0, 0, 1))",
        &[
            "2:15: error: camera.eye: expected 3 values, found a list of 2 values",
            "2:31: error: camera.target: expected 3 values, found a list of 4 values",
        ],
    ),
    ("camera: (eye: (0, 0, 5))", &["2:9: error: camera: `target` is missing"]),
    (
        "camera: (eye: (0, 0, 5), target: (0, 0, 0), fov_deg: 180)",
        &["2:54: error: camera.fov_deg: 180 is outside (0, 180)"],
    ),
    (
        r#"camera: (eye: (0, 0, 5), target: (0, 0, 0), fov_deg: "wide", aperture_m: -0.1, focus_m: 0)"#,
        &[
            r#"2:54: error: camera.fov_deg: expected a number, found the text "wide""#,
            "2:74: error: camera.aperture_m: -0.1 is below 0",
            "2:89: error: camera.focus_m: 0 is not above 0",
        ],
    ),
    (
        "camera: (eye: (0, 0, 5), target: (0, 0, 0), up: (0, 0, 0))",
        &["2:49: error: camera.up: a direction cannot be (0, 0, 0)"],
    ),
    (
        "camera: (eye: (0, 0, 5), target: (0, 0, 0), up: (0, 0, -2))",
        &["2:49: warning: camera.up: `up` is parallel to the view, another one is chosen"],
    ),
    (
        "camera: (eye: (NaN, 0, 5), target: (0, inf, 1e999))",
        &[
            "2:16: error: camera.eye.0: a finite number is expected, this is not a number",
            "2:40: error: camera.target.1: a finite number is expected, this is infinite or beyond 1.8e308",
            "2:45: error: camera.target.2: a finite number is expected, this is infinite or beyond 1.8e308",
        ],
    ),
    (
        r#"camera: { "eye": (0, 0, 5), "target": (0, 0, 0) }"#,
        &["2:9: error: camera: expected (field: …), found a map in { }"],
    ),
    (
        "image: (width: 0, height: 65537)",
        &[
            "2:16: error: image.width: 0 is outside [1, 65536]",
            "2:27: error: image.height: 65537 is outside [1, 65536]",
        ],
    ),
    (
        "image: (width: 3.5, height: -1)",
        &[
            "2:16: error: image.width: expected a whole number from 0 to 4294967295, found `3.5`",
            "2:29: error: image.height: expected a whole number from 0 to 4294967295, found `-1`",
        ],
    ),
    (
        "image: (png_bits: 12, exposure_ev: 100)",
        &[
            "2:19: error: image.png_bits: 12 is neither 8 nor 16",
            "2:36: error: image.exposure_ev: 100 is outside [-64, 64]",
        ],
    ),
    ("image: (widht: 3)", &["2:9: error: image: there is no field `widht` here; did you mean `width`?"]),
    ("image: (width: 3, width: 4)", &["2:19: error: image: `width` is given twice; the first is at 2:9"]),
    ("imagee: (width: 3)", &["2:1: error: there is no field `imagee` here; did you mean `image`?"]),
    ("antialiasing: grid(65)", &["2:20: error: antialiasing.grid: 65 is outside [1, 64]"]),
    ("antialiasing: grid", &["2:15: error: antialiasing: `grid` needs its values: `grid(…)`"]),
    (
        "antialiasing: progresive",
        &["2:15: error: antialiasing: there is no `progresive` here; did you mean `progressive`?"],
    ),
    (
        "antialiasing: grid(2, 3)",
        &[
            "2:19: error: antialiasing.grid: expected a whole number from 0 to 4294967295, found a list of 2 values",
        ],
    ),
    ("antialiasing: none(2)", &["2:15: error: antialiasing: expected `none` alone, found `none(…)`"]),
    (
        "antialiasing: adaptive(threshold: 2, depth: 9)",
        &[
            "2:35: error: antialiasing.adaptive.threshold: 2 is outside [0, 1]",
            "2:45: error: antialiasing.adaptive.depth: 9 is outside [1, 8]",
        ],
    ),
    (
        "antialiasing: 4",
        &["2:15: error: antialiasing: expected one of `none`, `grid`, `adaptive`, `progressive`, found `4`"],
    ),
    (
        "render: (passes: 0, max_depth: 0, seed: -1)",
        &[
            "2:18: error: render.passes: 0 passes make no image, at least 1 is needed",
            "2:32: error: render.max_depth: 0 is outside [1, 10000]",
            "2:41: error: render.seed: expected a whole number from 0 to 18446744073709551615, found `-1`",
        ],
    ),
    (
        "background: (0, -1, 0), ambient: -2",
        &["2:13: error: background: -1 is below 0", "2:34: error: ambient: -2 is below 0"],
    ),
    ("background: (1, 2)", &["2:13: error: background: expected 3 values, found a list of 2 values"]),
    (
        "background: true",
        &[
            "2:13: error: background: expected a number (grey) or three numbers (red, green, blue), found `true`",
        ],
    ),
    (
        r#"textures: { "t": checker(a: 0, b: 1, squares: (0, -1)) }"#,
        &[
            "2:48: error: textures.t.checker.squares.0: 0 is not above 0",
            "2:51: error: textures.t.checker.squares.1: -1 is not above 0",
        ],
    ),
    (
        r#"textures: { "t": cheker(a: 0, b: 1, squares: (1, 1)) }"#,
        &["2:18: error: textures.t: there is no `cheker` here; did you mean `checker`?"],
    ),
    (
        r#"textures: { "t": noise(a: 0, b: 1, size_m: 0, octaves: 17) }"#,
        &[
            "2:44: error: textures.t.noise.size_m: 0 is not above 0",
            "2:56: error: textures.t.noise.octaves: 17 is outside [1, 16]",
        ],
    ),
    (
        r#"textures: { "t": brick(a: -1, b: 1, bricks: (4, 0), mortar: 0.6) }"#,
        &[
            "2:27: error: textures.t.brick.a: -1 is below 0",
            "2:49: error: textures.t.brick.bricks.1: 0 is not above 0",
            "2:61: error: textures.t.brick.mortar: 0.6 is outside [0, 0.5]",
        ],
    ),
    (
        r#"textures: { "t": image(path: "wod.png") }"#,
        &[
            "2:30: error: textures.t.image.path: `tests/description/wod.png` cannot be read: there is no such file; did you mean `wood.png`?",
        ],
    ),
    (
        r#"textures: { "t": image(path: "wood.png", wrap: repeated, color_space: "sRGB") }"#,
        &[
            "2:48: error: textures.t.image.wrap: there is no `repeated` here; did you mean `repeat`?",
            "2:71: error: textures.t.image.color_space: there is no `sRGB` here; did you mean `srgb`?",
        ],
    ),
    (r#"textures: { "t": wood(a: 0, b: 1) }"#, &["2:22: error: textures.t.wood: `ring_m` is missing"]),
    (
        "textures: ( t: wood(a: 0, b: 1, ring_m: 1) )",
        &[r#"2:11: error: textures: expected { "name": … }, found fields in ( )"#],
    ),
    (
        r#"materials: { "m": (diffuse: 1.5), "n": (specular: -0.1) }"#,
        &[
            "2:29: error: materials.m.diffuse: 1.5 is outside [0, 1]",
            "2:51: error: materials.n.specular: -0.1 is outside [0, 1]",
        ],
    ),
    (
        r#"materials: { "m": (diffuse: 0.8, specular: 0.3) }"#,
        &[
            "2:19: error: materials.m: gives back 1.1 of the light it gets: 0.8 by its layers and 0.3 by its highlight",
        ],
    ),
    (
        r#"materials: { "m": (diffuse: (0.5, 0.9, 0.5), reflection: 0.5, specular: 0.2) }"#,
        &[
            "2:19: error: materials.m: green: gives back 1.15 of the light it gets: 0.95 by its layers and 0.2 by its highlight",
        ],
    ),
    (r#"materials: { "m": (ior: 0) }"#, &["2:25: error: materials.m.ior: 0 is outside (0.05, 10)"]),
    (
        r#"materials: { "m": (ior: "glas") }"#,
        &["2:25: error: materials.m.ior: no index of refraction is named `glas`; did you mean `glass`?"],
    ),
    (
        r#"materials: { "m": (ior: glass) }"#,
        &[r#"2:25: error: materials.m.ior: expected a number or a name such as "glass", found `glass`"#],
    ),
    (
        r#"materials: { "m": (transmission: 1, ior: -1.5, shininess: 0.5) }"#,
        &[
            "2:42: error: materials.m.ior: -1.5 is outside (0.05, 10)",
            "2:59: error: materials.m.shininess: 0.5 is outside [1, 1000000]",
        ],
    ),
    (
        r#"materials: { "m": (absorption: 1) }"#,
        &["2:32: error: materials.m.absorption: `absorption` needs `transmission` above 0"],
    ),
    (
        r#"materials: { "m": (diffuse: texture("wood")) }"#,
        &["2:37: error: materials.m.diffuse.texture: no texture `wood`"],
    ),
    (
        r#"materials: { "m": (diffuse: texture(nam: "wood")) }"#,
        &[
            "2:37: error: materials.m.diffuse.texture: there is no field `nam` here; did you mean `name`?",
            "2:42: error: materials.m.diffuse.texture.name: no texture `wood`",
        ],
    ),
    (
        r#"materials: { "m": (diffuse: texture(3)) }"#,
        &[
            "2:37: error: materials.m.diffuse.texture: expected a texture's name, or (name: …, scale: …), found `3`",
        ],
    ),
    (
        r#"materials: { "m": (diffuse: textur("wood")) }"#,
        &[
            "2:29: error: materials.m.diffuse: there is no `textur` here; did you mean `texture`?",
            "2:36: error: materials.m.diffuse.texture: no texture `wood`",
        ],
    ),
    (
        r#"materials: { "m": (diffuse: "wood") }"#,
        &[
            r#"2:29: error: materials.m.diffuse: expected a number (grey), three numbers (red, green, blue) or texture("name"), found the text "wood""#,
        ],
    ),
    (
        r#"materials: { "m": (normal_map: (texture: "x", strength: 11), bump_map: (texture: "y")) }"#,
        &[
            "2:42: error: materials.m.normal_map.texture: no texture `x`",
            "2:57: error: materials.m.normal_map.strength: 11 is outside [0, 10]",
            "2:72: error: materials.m.bump_map: `height_m` is missing",
            "2:82: error: materials.m.bump_map.texture: no texture `y`",
        ],
    ),
    (
        r#"materials: { "m": (), "m": (diffuse: 0.5) }"#,
        &["2:23: error: materials: `m` is given twice; the first is at 2:14"],
    ),
    ("materials: { m: () }", &["2:14: error: a name in quotes is expected"]),
    (r#"materials: { "m": (colour: 1) }"#, &["2:20: error: materials.m: there is no field `colour` here"]),
    (
        r#"materials: { "m": (diffuse: texture("t")) }, textures: { "t": checker(a: 0, b: 2, squares: (1, 1)) }"#,
        &["2:29: error: materials.m.diffuse: the texture `t` reaches 2 here, above 1"],
    ),
    (
        r#"materials: { "m": (transmision: 1, absorption: 1) }"#,
        &["2:20: error: materials.m: there is no field `transmision` here; did you mean `transmission`?"],
    ),
    (
        r#"lights: { "l": point(position: (0, 0, 0)) }"#,
        &["2:21: error: lights.l.point: `intensity` is missing"],
    ),
    (
        r#"lights: { "l": point(position: (0, 0, 0), intensity: 0, falloff: (0, 0, 0)) }"#,
        &[
            "2:66: error: lights.l.point.falloff: at least one term must be above 0",
            "2:54: warning: lights.l.point.intensity: this light emits nothing",
        ],
    ),
    (
        r#"lights: { "l": spot(position: (0, 0, 0), target: (0, 0, 0), intensity: 1, inner_deg: 40, outer_deg: 30) }"#,
        &[
            "2:50: error: lights.l.spot.target: the spot's target is its position",
            "2:86: error: lights.l.spot.inner_deg: 40 is above `outer_deg`, 30",
        ],
    ),
    (
        r#"lights: { "l": sphere(center: (0, 0, 0), radius: 0, radiance: -1, samples: 0) }"#,
        &[
            "2:50: error: lights.l.sphere.radius: 0 is not above 0",
            "2:63: error: lights.l.sphere.radiance: -1 is below 0",
            "2:76: error: lights.l.sphere.samples: 0 is outside [1, 65536]",
        ],
    ),
    (
        r#"lights: { "l": quad(corner: (0, 0, 0), edge_u: (1, 0, 0), edge_v: (-2, 0, 0), radiance: 1) }"#,
        &["2:67: error: lights.l.quad.edge_v: `edge_v` is parallel to `edge_u`: the quad has no area"],
    ),
    (
        r#"lights: { "l": disk(center: (0, 0, 0), normal: (0, 0, 0), radius: 1, radiance: 1) }"#,
        &["2:48: error: lights.l.disk.normal: a direction cannot be (0, 0, 0)"],
    ),
    (
        r#"lights: { "l": directional(direction: (0, 0, 0), irradiance: 1) }"#,
        &["2:39: error: lights.l.directional.direction: a direction cannot be (0, 0, 0)"],
    ),
    (
        r#"lights: { "a": environment(map: constant(1)), "b": environment(map: constant(1), scale: -1) }"#,
        &[
            "2:52: error: lights.b: only one environment light can shine, `a` is one already",
            "2:89: error: lights.b.environment.scale: -1 is below 0",
        ],
    ),
    (
        r#"lights: { "l": environment(map: image(path: "sky.exr")) }"#,
        &[
            "2:45: error: lights.l.environment.map.image.path: `tests/description/sky.exr` cannot be read: there is no such file",
        ],
    ),
    (r#"lights: { "l": lamp(position: (0, 0, 0)) }"#, &["2:16: error: lights.l: there is no `lamp` here"]),
    (
        r#"objects: [(shape: sphere(radius: 0), material: "m")]"#,
        &["2:34: error: objects.0.shape.sphere.radius: 0 is not above 0"],
    ),
    ("objects: [(shape: sphere())]", &["2:11: error: objects.0: no `material` is given, here or by a group"]),
    (r#"objects: [(shape: sphere(), material: "n")]"#, &["2:39: error: objects.0.material: no material `n`"]),
    (r#"objects: [(material: "m")]"#, &["2:11: error: objects.0: `shape` is missing"]),
    (
        r#"objects: [(shape: spere(radius: 1), material: "m")]"#,
        &["2:19: error: objects.0.shape: there is no `spere` here; did you mean `sphere`?"],
    ),
    (
        r#"objects: [(shape: sphere(radius: 1, centre: (0, 0, 0)), material: "m")]"#,
        &["2:37: error: objects.0.shape.sphere: there is no field `centre` here; did you mean `center`?"],
    ),
    (
        "objects: [(shape: group(objects: []))]",
        &["2:34: error: objects.0.shape.group.objects: the group is empty"],
    ),
    (
        r#"objects: [(shape: group(objects: [(shape: box(size: (1, 0, 1)))]), material: "m")]"#,
        &["2:57: error: objects.0.shape.group.objects.0.shape.box.size.1: 0 is not above 0"],
    ),
    (
        r#"objects: [(shape: cone(radius: 0, height: -1), material: "m"), (shape: disk(radius: 1, inner_radius: 2), material: "m")]"#,
        &[
            "2:32: error: objects.0.shape.cone.radius: `radius` and `top_radius` cannot both be 0",
            "2:43: error: objects.0.shape.cone.height: -1 is not above 0",
            "2:102: error: objects.1.shape.disk.inner_radius: 2 is not below `radius`, 1",
        ],
    ),
    (
        r#"objects: [(shape: cylinder(caps: 1), material: "m")]"#,
        &["2:34: error: objects.0.shape.cylinder.caps: expected true or false, found `1`"],
    ),
    (
        r#"objects: [(shape: polyhedron(kind: icosaeder), material: "m")]"#,
        &["2:36: error: objects.0.shape.polyhedron.kind: there is no `icosaeder` here"],
    ),
    (
        r#"objects: [(name: "a", shape: sphere(), material: "m"), (name: "a", shape: sphere(), material: "m")]"#,
        &["2:63: error: objects.1.name: the name `a` is given twice; the first is at 2:18"],
    ),
    (
        r#"objects: [(shape: mesh(path: "tree.obj", parts: { "bark": "n" }), material: "m")]"#,
        &["2:59: error: objects.0.shape.mesh.parts.bark: no material `n`"],
    ),
    (
        r#"objects: [(shape: mesh(path: "trees.obj"), material: "m")]"#,
        &[
            "2:30: error: objects.0.shape.mesh.path: `tests/description/trees.obj` cannot be read: there is no such file; did you mean `tree.obj`?",
        ],
    ),
    (
        r#"objects: [(shape: sphere(), material: "m", transform: [scale(0), scale((1, 0, 1)), rotate(axis: (0, 0, 0), deg: 5)])]"#,
        &[
            "2:56: error: objects.0.transform.0: this step flattens the object to nothing: a factor or the determinant is 0",
            "2:66: error: objects.0.transform.1: this step flattens the object to nothing: a factor or the determinant is 0",
            "2:97: error: objects.0.transform.2.rotate.axis: a direction cannot be (0, 0, 0)",
        ],
    ),
    (
        r#"objects: [(shape: sphere(), material: "m", transform: [matrix(((1, 2, 3, 0), (2, 4, 6, 0), (0, 0, 1, 0)))])]"#,
        &[
            "2:56: error: objects.0.transform.0: this step flattens the object to nothing: a factor or the determinant is 0",
        ],
    ),
    (
        r#"objects: [(shape: sphere(), material: "m", transform: translate((1, 2, 3)))]"#,
        &["2:55: error: objects.0.transform: expected a list [ ], found `translate(…)`"],
    ),
    (
        r#"objects: [(shape: sphere(), material: "m", transform: [scale((1, 2)), turn(3), translate(1, 2)])]"#,
        &[
            "2:62: error: objects.0.transform.0.scale: expected 3 values, found a list of 2 values",
            "2:71: error: objects.0.transform.1: there is no `turn` here",
            "2:89: error: objects.0.transform.2.translate: expected 3 values, found a list of 2 values",
        ],
    ),
    (
        r#"objects: [(shape: instance(of: "d"))], definitions: { "dd": (shape: sphere(), material: "m") }"#,
        &["2:32: error: objects.0.shape.instance.of: no definition `d`; did you mean `dd`?"],
    ),
    (
        r#"objects: [(shape: instance(of: "a"))], definitions: { "a": (shape: instance(of: "b")), "b": (shape: group(objects: [(shape: instance(of: "a"))])) }"#,
        &["2:60: error: definitions.a: contains itself: a → b → a"],
    ),
    (
        r#"objects: [(shape: scatter(of: [], over: "floor", count: 0))]"#,
        &[
            "2:31: error: objects.0.shape.scatter.of: at least one definition is needed",
            "2:41: error: objects.0.shape.scatter.over: no object or definition `floor`",
            "2:57: error: objects.0.shape.scatter.count: 0 is outside [1, 10000000]",
        ],
    ),
    (
        r#"objects: [(shape: scatter(of: ["d"], over: "d", count: 3, scale: (2, 1), turn_deg: (9, 3), max_slope_deg: -1, align: 2))], definitions: { "d": (shape: sphere(), material: "m") }"#,
        &[
            "2:66: error: objects.0.shape.scatter.scale: the smallest, 2, is above the largest, 1",
            "2:84: error: objects.0.shape.scatter.turn_deg: the smallest, 9, is above the largest, 3",
            "2:107: error: objects.0.shape.scatter.max_slope_deg: -1 is outside [0, 180]",
            "2:118: error: objects.0.shape.scatter.align: 2 is outside [0, 1]",
        ],
    ),
    (
        r#"objects: [(name: "s", shape: scatter(of: ["d"], over: "s", count: 3))], definitions: { "d": (shape: sphere(), material: "m") }"#,
        &[
            "2:11: error: objects.0: contains itself: s → s",
            "2:55: error: objects.0.shape.scatter.over: `s` is itself a scatter, not a surface",
        ],
    ),
    (
        r#"objects: (shape: sphere(), material: "m")"#,
        &["2:10: error: objects: expected a list [ ], found fields in ( )"],
    ),
    (
        r#"objects: [3, "x", (shape: sphere(), material: 3)]"#,
        &[
            "2:11: error: objects.0: expected fields of `name`, `shape`, `material`, `transform`, found `3`",
            r#"2:14: error: objects.1: expected fields of `name`, `shape`, `material`, `transform`, found the text "x""#,
            "2:47: error: objects.2.material: expected a text in quotes, found `3`",
        ],
    ),
    (r#"materials: { "m": (diffuse: 0.5) objects: []"#, &["2:34: error: `,` or `}` is expected, found `o`"]),
    (r#"materials: { "m": (diffuse: 0..5) }"#, &["2:29: error: `0..5` is not a number"]),
    (
        r#"materials: { "m": (diffuse: 'x') }"#,
        &[
            r#"2:29: error: materials.m.diffuse: expected a number (grey), three numbers (red, green, blue) or texture("name"), found a character in single quotes"#,
        ],
    ),
    (r#"textures: { "t": image(path: "wood.png\q") }"#, &["2:39: error: this escape is not known"]),
    (r#"include: "a.ron""#, &[r#"2:10: error: include: expected a list [ ], found the text "a.ron""#]),
    (r#"include: ["a.json"]"#, &["2:11: error: `a.json` does not end in .ron or .toml"]),
];
