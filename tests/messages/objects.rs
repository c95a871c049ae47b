//! Objects, shapes, transforms and scatter.

pub const CASES: &[super::Case] = &[
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
    (
        r#"objects: [(shape: sphere(), material: "m", transform: [scale(1e-300)])]"#,
        &[
            "2:55: error: objects.0.transform: together these steps flatten the object to nothing, or take its volume out of the range of numbers",
        ],
    ),
    (
        r#"objects: [(shape: sphere(), material: "m", transform: [scale((1, 1e-14, 1))])]"#,
        &[
            "2:56: error: objects.0.transform.0: this step squeezes more than 1e13 times as much one way as another",
        ],
    ),
    (
        r#"objects: [(shape: group(objects: [(shape: sphere(), material: "m", transform: [scale((1, 1e-7, 1))])]), transform: [scale((1, 1e-7, 1))])]"#,
        &[
            "2:79: error: objects.0.shape.group.objects.0.transform: together with the transforms of the groups around it these flatten the object to nothing, or take its volume out of the range of numbers",
        ],
    ),
    (
        r#"objects: [(shape: sphere(), material: "m", transform: [rotate(axis: (1e300, 0, 0), deg: 5)])]"#,
        &[
            "2:69: error: objects.0.transform.0.rotate.axis: a direction this long or short cannot be told: its square leaves the range of numbers",
        ],
    ),
    (
        r#"materials: { "g": (transmission: 1) }, definitions: { "d": (shape: cone(caps: false)) }, objects: [(shape: group(objects: [(shape: instance(of: "d")), (shape: box())]), material: "g")]"#,
        &[
            "2:72: warning: definitions.d.shape.cone: the material `g` transmits, and this shape has no inside: how far light goes through it, and where it leaves, is not defined; give it `caps`",
        ],
    ),
    (r#"materials: { "g": (transmission: 1, ior: 1) }, objects: [(shape: quad(), material: "g")]"#, &[]),
];
