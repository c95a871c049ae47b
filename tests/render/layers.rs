//! The layers beside the picture: parts of the light, the first surface, variance.

use super::shot::{assert_close, shot};
use terrarium::render::Aov;

/// The parts of the light add up to the picture.
#[test]
fn direct_and_reflection_and_refraction_are_the_whole() {
    let picture = shot(
        r#"(camera: (eye: (1, 2, 4), target: (0, 0.3, 0)), image: (width: 32, height: 24), background: 0.1,
        materials: { "floor": (diffuse: 0.6, reflection: 0.2, specular: 0.1), "glass": (transmission: 1), "lamp": (emission: 2) },
        lights: { "lamp": sphere(center: (-1, 4, 1), radius: 0.5, radiance: 9) },
        objects: [(shape: quad(size: (9, 9)), material: "floor"), (shape: sphere(radius: 0.6, center: (0, 0.6, 0)), material: "glass"),
                  (shape: box(size: (0.3, 0.3, 0.3)), material: "lamp", transform: [translate((1.4, 0.2, 0))])])"#,
    )
    .passes(8)
    .aovs(&[Aov::Direct, Aov::Reflection, Aov::Refraction])
    .render();
    for channel in ["R", "G", "B"] {
        let parts = ["direct", "reflection", "refraction"].map(|l| picture.channel(l, channel));
        for (i, &whole) in picture.channel("", channel).iter().enumerate() {
            let sum = parts.iter().map(|p| p[i]).sum::<f32>();
            assert!((sum - whole).abs() <= 1e-5 * whole.max(0.1), "{sum} and {whole}");
        }
        assert!(parts.iter().all(|p| p.iter().any(|&x| x > 0.0)));
    }
}

/// Position, depth, normal, albedo and object of a plane, in closed form per pixel.
#[test]
fn the_first_hit_of_a_plane_is_exact() {
    let picture = shot(
        r#"(camera: (eye: (100, 3, 200), target: (100, 0, 198), fov_deg: 40), image: (width: 21, height: 21), antialiasing: none,
        materials: { "floor": (diffuse: (0.1, 0.2, 0.3)) },
        objects: [(shape: sphere(), material: "floor", transform: [translate((0, 50, 0))]), (name: "floor", shape: quad(size: (1000, 1000)), material: "floor")])"#,
    )
    .aovs(&[Aov::Position, Aov::Depth, Aov::Normal, Aov::Albedo, Aov::ObjectId])
    .render();
    let forward = glam::DVec3::new(0.0, -3.0, -2.0).normalize();
    let right = forward.cross(glam::DVec3::Y).normalize();
    let up = right.cross(forward);
    let half = f64::to_radians(20.0).tan();
    for i in 0..21 * 21 {
        let at = |k: usize| ((k as f64 + 0.5) / 10.5 - 1.0) * half;
        let dir = forward + right * at(i % 21) - up * at(i / 21);
        let t = 3.0 / -dir.y;
        let p = glam::DVec3::new(100.0, 3.0, 200.0) + dir * t;
        for (channel, expected) in ["X", "Y", "Z"].into_iter().zip(p.to_array()) {
            let found = f64::from(picture.channel("position", channel)[i]);
            assert!((found - expected).abs() < 2e-5, "{channel} of pixel {i}: {found} for {expected}");
        }
        // Along the view direction.
        assert_close(picture.channel("depth", "Z")[i].into(), t, 1e-6);
        let normal = ["X", "Y", "Z"].map(|c| picture.channel("normal", c)[i]);
        assert_eq!(normal, [0.0, 1.0, 0.0]);
        assert_eq!(["R", "G", "B"].map(|c| picture.channel("albedo", c)[i]), [0.1, 0.2, 0.3]);
        assert_eq!(picture.channel("object_id", "Y")[i], 2.0);
    }
}

/// What meets nothing is 0 in every layer of the first surface.
#[test]
fn nothing_has_no_first_hit() {
    let picture =
        shot(r#"(camera: (eye: (0, 0, 5), target: (0, 0, 0)), image: (width: 4, height: 4), background: 1)"#)
            .passes(2)
            .aovs(&[Aov::Position, Aov::Depth, Aov::Normal, Aov::Albedo, Aov::ObjectId])
            .render();
    for (layer, channel) in
        [("position", "X"), ("depth", "Z"), ("normal", "Y"), ("albedo", "G"), ("object_id", "Y")]
    {
        assert!(picture.channel(layer, channel).iter().all(|&x| x == 0.0), "{layer}");
    }
}

/// The stated variance of the mean is that of the means over independent seeds.
#[test]
fn the_variance_layer_predicts_the_spread_over_seeds() {
    let scene = |seed| {
        shot(
            r#"(camera: (eye: (0, 1, 3), target: (0, 0, 0), fov_deg: 30), image: (width: 16, height: 16),
            materials: { "floor": (diffuse: 0.8), "black": () },
            lights: { "lamp": sphere(center: (0, 2, 0), radius: 0.6, radiance: 5, visible: false) },
            objects: [(shape: quad(size: (5, 5)), material: "floor"), (shape: disk(radius: 0.4), material: "black", transform: [translate((0, 1, 0))])])"#,
        )
        .passes(16)
        .seed(seed)
        .aovs(&[Aov::Variance])
        .render()
    };
    let runs: Vec<_> = (0..48).map(scene).collect();
    let n = runs.len() as f64;
    let (mut predicted, mut actual) = (0.0, 0.0);
    for i in 0..256 {
        let values: Vec<f64> = runs.iter().map(|r| r.grey()[i]).collect();
        let mean = values.iter().sum::<f64>() / n;
        actual += values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
        predicted += runs.iter().map(|r| f64::from(r.channel("variance", "R")[i])).sum::<f64>() / n;
    }
    println!("predicted {predicted:e}, actual {actual:e}");
    // Independent samples would agree; well-distributed ones do better than they predict, never worse.
    assert!(actual <= predicted * 1.15, "{actual} against {predicted}");
    assert!(actual > predicted * 0.02, "{actual} against {predicted}");
}

/// The first surface is what the camera sees, wherever a path goes on from there.
#[test]
fn bounces_change_nothing_of_the_first_surface() {
    let layers = ["albedo", "normal", "position", "depth", "object_id"];
    let room = |indirect: &str| {
        let picture = shot(format!(
            r#"(camera: (eye: (0, 1, 3), target: (0, 0, 0)), image: (width: 16, height: 12), {indirect}
            materials: {{ "floor": (diffuse: 0.3), "sky": (diffuse: (0.9, 0.8, 0.7)) }},
            objects: [(shape: quad(size: (9, 9)), material: "floor"), (shape: sphere(radius: 20), material: "sky")])"#
        ))
        .passes(4)
        .aovs(&[Aov::Albedo, Aov::Normal, Aov::Position, Aov::Depth, Aov::ObjectId])
        .render();
        layers.map(|layer| {
            let channels = &picture.rendered.image.layer(layer).expect("the layer was asked for").channels;
            channels.iter().map(|(_, values)| values.clone()).collect::<Vec<_>>()
        })
    };
    assert_eq!(room("indirect: true, indirect_by: paths,"), room(""));
}
