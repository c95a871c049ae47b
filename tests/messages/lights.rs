//! Lights.

pub const CASES: &[super::Case] = &[
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
        r#"lights: { "l": quad(corner: (0, 0, 0), edge_u: (1, 0, 0), edge_v: (0, 1e40, 0), radiance: 1) }"#,
        &[
            "2:67: error: lights.l.quad.edge_v: a quad more than 1e13 times as long as wide, or whose area leaves the range of numbers, cannot be placed",
        ],
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
        r#"lights: { "l": point(position: (0, 3, 0), intensity: 9, samples: 4) }"#,
        &["2:57: error: lights.l.point: there is no field `samples` here"],
    ),
    (
        r#"animation: (frames: 2, keys: { "lights.l.intensity": linear([(frame: 1, value: 0), (frame: 2, value: 1)]) }), lights: { "l": point(position: (0, 3, 0), intensity: 0) }"#,
        &[],
    ),
    (
        r#"background: 1, lights: { "l": environment(map: constant(1), turn_deg: 30) }"#,
        &[
            "2:13: warning: background: `background` does nothing: the environment `l` is seen in its place",
            "2:71: warning: lights.l.environment.turn_deg: `turn_deg` does nothing: this map is the same all around",
        ],
    ),
];
