//! Mirrors: endless chains end and are told of, and a mirror shows the mirrored view.

use super::shot::{assert_close, shot};

/// H46: glass in a box of mirrors: bounded time, no overflow of the stack, and what was cut is told.
#[test]
fn facing_mirrors_end_at_the_depth_limit_and_say_what_is_missing() {
    let scene = |reflection: f64, depth: u32| {
        shot(format!(
            r#"(camera: (eye: (0, 0.3, 0), target: (1, 0.31, 0.02), fov_deg: 10), image: (width: 4, height: 4), antialiasing: none,
            render: (max_depth: {depth}), materials: {{ "mirror": (reflection: {reflection}) }}, background: 1,
            objects: [(shape: quad(size: (9e9, 9e9)), material: "mirror", transform: [rotate(axis: (0, 0, 1), deg: 90), translate((1, 0, 0))]),
                      (shape: quad(size: (9e9, 9e9)), material: "mirror", transform: [rotate(axis: (0, 0, 1), deg: 90), translate((-1, 0, 0))])])"#
        ))
        .render()
    };
    let endless = scene(1.0, 10_000);
    assert_eq!(endless.mean(), 0.0);
    let stats = &endless.rendered.stats;
    assert_eq!((stats.truncated_paths, stats.truncated_weight), (16, 1.0));
    assert_eq!(stats.rays.reflection, 16 * 10_001);
    assert!(endless.rendered.warnings.iter().any(|w| w.contains("max_depth")));
    let fading = scene(0.99, 100);
    assert_close(fading.rendered.stats.truncated_weight, 0.99f64.powi(101), 1e-4);
    // Lighter branches die by chance long before.
    assert_eq!(scene(0.9, 10_000).rendered.stats.truncated_paths, 0);
}

#[test]
fn a_glass_ball_in_a_box_of_mirrors_ends_soon() {
    let scene = r#"(camera: (eye: (0.9, 0.8, 0.7), target: (0, 0, 0)), image: (width: 16, height: 16),
        render: (max_depth: 10000), materials: { "mirror": (reflection: 0.98), "glass": (transmission: 1) },
        lights: { "lamp": sphere(center: (0, 0.9, 0), radius: 0.05, radiance: 10) },
        objects: [(shape: box(size: (2, 2, 2)), material: "mirror"), (shape: sphere(radius: 0.5), material: "glass")])"#;
    let picture = shot(scene).passes(8).render();
    assert!(picture.is_sound());
    assert_eq!(picture.rendered.stats.truncated_paths, 0);
}

/// H50: what a plane mirror shows is what an eye behind it would see, left and right exchanged.
#[test]
fn a_mirror_shows_the_mirrored_view() {
    let scene = |eye_z: f64, mirror: &str| {
        shot(format!(
            r#"(camera: (eye: (0.4, 1, {eye_z}), target: (0, 0.5, 0), fov_deg: 30), image: (width: 32, height: 32), antialiasing: grid(2),
            materials: {{ "white": (diffuse: texture("tiles"), specular: 0.1), "mirror": (reflection: 1) }},
            textures: {{ "tiles": checker(a: 0.8, b: 0.3, squares: (9, 9)) }},
            lights: {{ "lamp": point(position: (1, 4, 5), intensity: 30) }},
            objects: [(shape: box(size: (8, 0.1, 8), center: (0, -0.05, 4.5)), material: "white"),
                      (shape: sphere(radius: 0.4, center: (-0.3, 0.5, 1.2)), material: "white") {mirror}])"#
        ))
        .render()
    };
    let mirror =
        r#", (shape: quad(size: (6, 6)), material: "mirror", transform: [rotate(axis: (1, 0, 0), deg: 90)])"#;
    // The eye between mirror and scene would be in the picture of neither.
    let (through, direct) = (scene(0.9, mirror), scene(-0.9, ""));
    let mut same = 0;
    for y in 0..32 {
        for x in 0..32 {
            let (a, b) = (through.at(x, y), direct.at(31 - x, y));
            same += usize::from((a - b).abs() <= 1e-3 * a.max(b));
        }
    }
    println!("mean {} and {}", through.mean(), direct.mean());
    assert!(through.mean() > 0.01);
    assert!(same >= 1010, "{same} of 1024 pixels agree");
}
