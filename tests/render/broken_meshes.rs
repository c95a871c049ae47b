//! Coarse, tilted, cracked and degenerate meshes.

use super::meshes::{Obj, folder, icosphere};
use super::shot::{agreement, shot};
use terrarium::math::DVec3;

/// H20: a smooth coarse mesh is not black where its smooth normals are lit, and nears the sphere.
#[test]
fn smooth_meshes_have_no_shadow_terminator() {
    let dir = folder();
    let view = |shape: &str| {
        shot(format!(
            r#"(camera: (eye: (0, 0, 9), target: (0, 0, 0), fov_deg: 13), image: (width: 64, height: 64), antialiasing: none,
            materials: {{ "white": (diffuse: 1) }}, lights: {{ "sun": directional(direction: (-1, 0, 0), irradiance: 3.1415926535) }},
            objects: [(shape: {shape}, material: "white", transform: [rotate(axis: (1, 2, 3), deg: 10)])])"#
        ))
        .folder(dir.path())
        .render()
    };
    let sphere = view("sphere()");
    let errors: Vec<f64> = (1..4)
        .map(|n| {
            let name = format!("ball{n}.obj");
            icosphere(n).write(&dir.path().join(&name));
            let mesh = view(&format!(r#"mesh(path: "{name}")"#));
            let (mut sum, mut count) = (0.0, 0);
            for (i, (a, b)) in sphere.grey().iter().zip(mesh.grey()).enumerate() {
                let (x, y) = ((i % 64) as f64 - 31.5, (i / 64) as f64 - 31.5);
                if x.hypot(y) > 24.0 {
                    continue;
                }
                assert!(
                    *a <= 0.05 || b > 0.0,
                    "black at {i} with {n} subdivisions, where the sphere shows {a}"
                );
                sum += (a - b).abs();
                count += 1;
            }
            sum / f64::from(count)
        })
        .collect();
    println!("errors {errors:?}");
    assert!(errors[0] > 3.0 * errors[1] && errors[1] > 3.0 * errors[2], "{errors:?}");
}

/// A plane of two triangles, normals tilted by 45° towards +x; seen from above.
fn tilted_plane() -> Obj {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    Obj {
        vertices: corners.map(|(x, z)| DVec3::new(x, 0.0, z)).to_vec(),
        normals: vec![DVec3::new(1.0, 1.0, 0.0).normalize(); 4],
        faces: vec![vec![0, 3, 2, 1]],
    }
}

/// H21: tilted normals do not let light through from behind, not even at the border.
#[test]
fn tilted_normals_let_no_light_through() {
    let dir = folder();
    tilted_plane().write(&dir.path().join("plane.obj"));
    for light in [
        "directional(direction: (-1, 0.5, 0), irradiance: 1)",
        "directional(direction: (-1, 0.01, 0.3), irradiance: 1)",
        "point(position: (3, -0.5, 0), intensity: 9)",
        "point(position: (1.5, -0.001, 0), intensity: 9)",
        "sphere(center: (2, -0.6, 0), radius: 0.5, radiance: 9, visible: false)",
    ] {
        let picture = shot(format!(
            r#"(camera: (eye: (0, 3, 0), target: (0, 0, 0), up: (0, 0, 1), fov_deg: 40), image: (width: 65, height: 65), antialiasing: none,
            materials: {{ "white": (diffuse: 1) }}, lights: {{ "lamp": {light} }},
            objects: [(shape: mesh(path: "plane.obj"), material: "white")])"#
        ))
        .folder(dir.path())
        .passes(4)
        .render();
        let lit = picture.grey().iter().filter(|x| **x != 0.0).count();
        assert_eq!(lit, 0, "{light} from behind lights {lit} pixels");
    }
}

/// H5: an even sky seen from inside a closed black mesh through its triangles' edges: nothing.
#[test]
fn closed_meshes_have_no_cracks() {
    let dir = folder();
    icosphere(4).write(&dir.path().join("ball.obj"));
    for place in ["scale(1)", "scale((1e-3, 1e3, 1))", "scale(2), translate((148376, 1234, -223423))"] {
        let eye = if place.contains("148376") { "(148376, 1234, -223423)" } else { "(0, 0, 0)" };
        let target = if place.contains("148376") { "(148376.3, 1234.1, -223422)" } else { "(0.3, 0.1, 1)" };
        let picture = shot(format!(
            r#"(camera: (eye: {eye}, target: {target}, fov_deg: 150), image: (width: 200, height: 200), antialiasing: none,
            background: 1, materials: {{ "black": () }},
            objects: [(shape: mesh(path: "ball.obj"), material: "black", transform: [{place}])])"#
        ))
        .folder(dir.path())
        .render();
        assert_eq!(picture.mean(), 0.0, "{place}");
    }
}

/// H10, H11: degenerate triangles change nothing and are told of.
#[test]
fn degenerate_triangles_change_nothing() {
    let dir = folder();
    let ball = icosphere(2);
    ball.write(&dir.path().join("sound.obj"));
    let mut broken = ball;
    let n = broken.vertices.len();
    for i in 0..1000 {
        let (a, b) = (i % n, (i * 7 + 1) % n);
        broken.faces.push(if i % 2 == 0 { vec![a, a, b] } else { vec![a, b, b] });
    }
    broken.write(&dir.path().join("broken.obj"));
    let view = |name: &str| {
        shot(format!(
            r#"(camera: (eye: (0, 2, 4), target: (0, 0, 0)), image: (width: 32, height: 32), antialiasing: none,
            materials: {{ "white": (diffuse: 1), "glass": (transmission: 1) }}, lights: {{ "sun": directional(direction: (-1, -1, -1), irradiance: 1) }},
            objects: [(shape: mesh(path: "{name}"), material: "white"), (shape: mesh(path: "{name}"), material: "glass", transform: [translate((1.5, 0, 0))])])"#
        ))
        .folder(dir.path())
        .render()
    };
    let (sound, broken) = (view("sound.obj"), view("broken.obj"));
    assert!(sound.bits() == broken.bits());
    let warnings = &broken.rendered.warnings;
    assert!(warnings.iter().any(|w| w.contains("1000") || w.contains("1,000")), "{warnings:?}");
}

/// H11: zero and missing normals: shaded flat, finite.
#[test]
fn zero_normals_are_shaded_flat() {
    let dir = folder();
    let mut ball = icosphere(1);
    ball.normals.iter_mut().for_each(|n| *n = DVec3::ZERO);
    ball.write(&dir.path().join("ball.obj"));
    let view = |smooth: bool| {
        shot(format!(
            r#"(camera: (eye: (0, 2, 4), target: (0, 0, 0)), image: (width: 32, height: 32), antialiasing: none,
            materials: {{ "white": (diffuse: 1) }}, lights: {{ "sun": directional(direction: (-1, -1, -1), irradiance: 1) }},
            objects: [(shape: mesh(path: "ball.obj", smooth: {smooth}), material: "white")])"#
        ))
        .folder(dir.path())
        .render()
    };
    let (zero, flat) = (view(true), view(false));
    assert!(zero.is_sound());
    assert!(flat.mean() > 0.02);
    assert!(agreement(&zero, &flat, 1e-5) > 0.995);
}
