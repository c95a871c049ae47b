//! Camera, image, antialiasing and the rest of the top level.

pub const CASES: &[super::Case] = &[
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
        "camera: (eye: (0, 0, 5), target: (0, 0, 0), focus_m: 3)",
        &[
            "2:54: warning: camera.focus_m: `focus_m` does nothing where `aperture_m` is 0: a pinhole shows everything sharply",
        ],
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
        "image: (width: 0, height: 1048577)",
        &[
            "2:16: error: image.width: 0 is outside [1, 1048576]",
            "2:27: error: image.height: 1048577 is outside [1, 1048576]",
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
];
