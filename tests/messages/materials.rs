//! Materials and textures.

pub const CASES: &[super::Case] = &[
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
            "2:30: warning: textures.t.image.path: `tests/description/wod.png` cannot be read: there is no such file; did you mean `wood.png`?",
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
        &["2:32: warning: materials.m.absorption: `absorption` does nothing where `transmission` is 0"],
    ),
    (
        r#"materials: { "m": (diffuse: 1, dispersion: abbe(30)) }"#,
        &["2:44: warning: materials.m.dispersion: `dispersion` does nothing where `transmission` is 0"],
    ),
    (
        r#"materials: { "m": (diffuse: 0.5, ior: 1.4, priority: 2, shininess: 30) }"#,
        &[
            "2:39: warning: materials.m.ior: `ior` does nothing where `transmission` is 0",
            "2:54: warning: materials.m.priority: `priority` does nothing where `transmission` is 0",
            "2:68: warning: materials.m.shininess: `shininess` does nothing where `specular` is 0",
        ],
    ),
    (
        r#"animation: (frames: 2, keys: { "materials.m.transmission": linear([(frame: 1, value: 0), (frame: 2, value: 1)]) }), materials: { "m": (transmission: 0, ior: 1.4) }"#,
        &[],
    ),
    (
        r#"materials: { "m": (diffuse: 0.3, reflection: 1) }"#,
        &[
            "2:29: warning: materials.m.diffuse: `diffuse` does nothing where `reflection` is 1: it lies below",
        ],
    ),
    (
        r#"animation: (frames: 2, keys: { "textures.t.wood.b": linear([(frame: 1, value: 0), (frame: 2, value: 1)]) }), textures: { "t": wood(a: 0, b: 1, ring_m: 1) }, materials: { "m": (diffuse: 0.5, bump_map: (texture: "t", height_m: 1)) }"#,
        &[],
    ),
    (
        r#"materials: { "m": (transmission: 1, ior: 1, dispersion: abbe(30)) }"#,
        &[
            "2:62: warning: materials.m.dispersion.abbe: an Abbe number does nothing where `ior` is 1: it spreads `ior` − 1; `cauchy` gives the spread itself",
        ],
    ),
    (
        r#"textures: { "t": wood(a: 1, b: 1, ring_m: 1) }, materials: { "m": (diffuse: 0.5, bump_map: (texture: "t", height_m: 1)) }"#,
        &[
            "2:102: warning: materials.m.bump_map.texture: this bump map does nothing: its texture is of one colour",
        ],
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
];
