//! Antialiasing: what each method costs and how near it comes, and features smaller than a pixel.

use super::shot::{Picture, assert_close, shot};
use terrarium::render::Aov;

fn scene(antialiasing: &str) -> String {
    format!(
        r#"(camera: (eye: (0.3, 1.5, 4), target: (0, 0.4, 0)), image: (width: 64, height: 48), antialiasing: {antialiasing},
        textures: {{ "tiles": checker(a: 0.8, b: 0.2, squares: (12, 12)) }},
        materials: {{ "floor": (diffuse: texture("tiles")), "red": (diffuse: (0.7, 0.2, 0.2)), "mirror": (reflection: 0.8, diffuse: 0.5) }},
        lights: {{ "lamp": point(position: (-3, 6, 4), intensity: 120) }},
        objects: [(shape: quad(size: (9, 9)), material: "floor"), (shape: sphere(radius: 0.5, center: (-0.6, 0.5, 0)), material: "mirror"),
                  (shape: cone(radius: 0.4, height: 1.2), material: "red", transform: [translate((0.6, 0, 0.2))])])"#
    )
}

fn rms(a: &Picture, b: &Picture) -> f64 {
    let (a, b) = (a.grey(), b.grey());
    (a.iter().zip(&b).map(|(x, y)| (x - y).powi(2)).sum::<f64>() / a.len() as f64).sqrt()
}

#[test]
fn none_is_a_grid_of_one() {
    assert!(shot(scene("none")).render().bits() == shot(scene("grid(1)")).render().bits());
}

/// For like numbers of samples it comes nearer to the truth than a grid.
#[test]
fn adaptive_is_as_good_as_a_grid_for_fewer_samples() {
    let truth = shot(scene("grid(32)")).render();
    let error = |a: &str| rms(&shot(scene(a)).render(), &truth);
    let adaptive = shot(scene("adaptive(threshold: 0.03, depth: 4)")).render();
    let (none, three, found) = (error("none"), error("grid(3)"), rms(&adaptive, &truth));
    let samples = adaptive.rendered.stats.samples as f64 / (64.0 * 48.0);
    println!("rms: none {none}, grid(3) {three}, adaptive {found} at {samples} samples a pixel");
    assert!(three < none);
    assert!(found < error("grid(8)"));
    assert!(samples < 80.0, "{samples}");
    let coarse = shot(scene("adaptive(threshold: 0.1, depth: 2)")).render();
    let (found, samples) = (rms(&coarse, &truth), coarse.rendered.stats.samples as f64 / (64.0 * 48.0));
    println!("coarse: {found} at {samples} samples a pixel");
    assert!(found < three && samples < 16.0, "{found} at {samples}");
    let progressive = rms(&shot(scene("progressive")).passes(256).render(), &truth);
    assert!(progressive < three, "{progressive}");
}

/// A cell is divided for its contrast times its share of the pixel, so that the threshold tells the quality and the
/// depth is a bound: contrast is at most 1, and no cell of a 64th of a pixel comes above a threshold of 0.1.
#[test]
fn the_depth_is_a_bound_and_not_every_edges() {
    let truth = shot(scene("grid(32)")).render();
    let of = |antialiasing: &str| {
        let picture = shot(scene(antialiasing)).render();
        (rms(&picture, &truth), picture.rendered.stats.rays.camera as f64 / (64.0 * 48.0), picture.bits())
    };
    let [three, five] = [3, 5].map(|depth| of(&format!("adaptive(threshold: 0.1, depth: {depth})")));
    assert!(three.2 == five.2);
    let grid = of("grid(3)");
    println!("rms {} of {} samples a pixel, {} of 9", five.0, five.1, grid.0);
    assert!(five.0 < 0.6 * grid.0 && five.1 < 7.0, "{} of {}; {}", five.0, five.1, grid.0);
    // And the threshold gives what it takes.
    let fine = of("adaptive(threshold: 0.01, depth: 5)");
    assert!(fine.0 < 0.25 * five.0 && fine.1 < 6.0 * five.1, "{} of {}", fine.0, fine.1);
}

/// Samples are drawn where there are edges, and nowhere else.
#[test]
fn the_edges_layer_is_dark_away_from_edges() {
    // One black sphere before a glowing background: the only edge is its outline.
    let picture = shot(
        r#"(camera: (eye: (0, 0, 5), target: (0, 0, 0), fov_deg: 30), image: (width: 64, height: 64), antialiasing: adaptive(),
        background: 1, materials: { "black": () }, objects: [(shape: sphere(), material: "black")])"#,
    )
    .aovs(&[Aov::Edges, Aov::Samples])
    .render();
    let edges = picture.channel("edges", "Y");
    let half = f64::to_radians(15.0).tan();
    let outline = (1.0f64 / 24.0).sqrt() / half * 32.0;
    let (mut near, mut seen) = (0, 0);
    for (i, &e) in edges.iter().enumerate() {
        let (x, y) = ((i % 64) as f64 - 31.5, (i / 64) as f64 - 31.5);
        let off = (x.hypot(y) - outline).abs();
        if off > 1.5 {
            assert_eq!(e, 0.0, "pixel {i}, {off} pixels from the outline");
        } else if off < 0.4 {
            near += 1;
            seen += usize::from(e > 0.0);
        }
    }
    assert!(near > 50 && seen == near, "{seen} of {near}");
}

/// Even surfaces are not divided, and cost one sample a pixel.
#[test]
fn an_even_picture_is_not_divided() {
    let picture = shot(
        r#"(camera: (eye: (0, 0, 5), target: (0, 0, 0)), image: (width: 32, height: 32), antialiasing: adaptive(), background: 0.4)"#,
    )
    .aovs(&[Aov::Edges])
    .render();
    assert!(picture.channel("edges", "Y").iter().all(|&e| e == 0.0));
    assert!(picture.grey().iter().all(|&x| x as f32 == 0.4));
    assert_eq!(picture.rendered.stats.samples, 32 * 32);
}

/// The lens: a point out of focus is a disk of the right size and the same light.
#[test]
fn a_thin_lens_spreads_a_point_over_its_circle_of_confusion() {
    let scene = |aperture: f64| {
        shot(format!(
            r#"(camera: (eye: (0, 0, 4), target: (0, 0, 0), fov_deg: 30, aperture_m: {aperture}, focus_m: 2), image: (width: 33, height: 33),
            materials: {{ "glow": (emission: 1) }}, objects: [(shape: disk(radius: 0.1), material: "glow", transform: [rotate(axis: (1, 0, 0), deg: 90)])])"#
        ))
        .passes(512)
        .render()
    };
    let (sharp, soft) = (scene(0.0), scene(0.2));
    assert_close(soft.mean(), sharp.mean(), 0.03);
    // In the focal plane, at 2: of the disk 0.1·2/4, of the lens 0.1·(4−2)/4, and their sum.
    let pixel = 2.0 * f64::to_radians(15.0).tan() * 2.0 / 33.0;
    let radius = 0.1 / pixel;
    for (i, value) in soft.grey().into_iter().enumerate() {
        let off = ((i % 33) as f64 - 16.0).hypot((i / 33) as f64 - 16.0);
        assert!(off <= radius + 1.2 || value == 0.0, "{value} at {off} pixels, radius {radius}");
        // Wholly within: each of the lens's points sees some of the disk.
        assert!(off > radius - 1.6 || value > 0.0, "dark at {off} pixels, radius {radius}");
    }
}
