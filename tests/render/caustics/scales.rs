//! The size of a scene changes nothing. Lengths times s, intensities times s².

use crate::render::shot::{Picture, focused as shot};

pub(crate) const PASSES: &str = "progressive(count: 20000)";

/// A glass ball and a box of mirrors on a floor under some of two lamps, s times as large.
pub(crate) fn scaled(s: f64, lamps: &[usize], photons: &str) -> Picture {
    let v = |x: f64, y: f64, z: f64| format!("({:e}, {:e}, {:e})", x * s, y * s, z * s);
    let l = |x: f64| format!("{:e}", x * s);
    let lights = [
        format!(r#""lamp": sphere(center: {}, radius: {}, radiance: 60),"#, v(-3.0, 5.0, -2.0), l(0.4)),
        format!(r#""bulb": point(position: {}, intensity: {:e}),"#, v(2.0, 4.0, 2.0), 20.0 * s * s),
    ];
    let lights: String = lamps.iter().map(|&i| lights[i].as_str()).collect();
    shot(format!(
        r#"(camera: (eye: {eye}, target: {target}, fov_deg: 40), image: (width: 48, height: 48),
        photons: {photons}, indirect: 2,
        materials: {{ "floor": (diffuse: 0.7), "glass": (transmission: 1), "mirror": (reflection: 0.9) }},
        lights: {{ {lights} }},
        objects: [(shape: quad(size: ({floor}, {floor})), material: "floor"), (shape: sphere(radius: {ball}, center: {center}), material: "glass"),
                  (shape: box(size: {size}, center: {place}), material: "mirror")])"#,
        eye = v(0.0, 3.0, 6.5),
        target = v(0.0, 0.8, 0.0),
        floor = l(20.0),
        ball = l(1.0),
        center = v(0.0, 1.2, 0.0),
        size = v(0.7, 1.3, 0.3),
        place = v(-2.1, 0.651, 0.1),
    ))
    .passes(4)
    .render()
}

/// By powers of two every rounding is the same, so that every bit is.
#[test]
fn a_scene_scaled_by_powers_of_two_has_the_same_bits() {
    let one = scaled(1.0, &[0, 1], PASSES).bits();
    for s in [-13, -10, 10, 13] {
        assert!(one == scaled(f64::from(s).exp2(), &[0, 1], PASSES).bits(), "2^{s}");
    }
}
