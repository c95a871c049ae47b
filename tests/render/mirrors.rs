//! A mirror shows the mirrored view.

use super::shot::shot;

/// What a plane mirror shows is what an eye behind it would see, left and right exchanged.
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
