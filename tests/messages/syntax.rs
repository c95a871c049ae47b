//! Syntax, and what is included.

pub const CASES: &[super::Case] = &[
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
