//! Casters by the hundred: aimed at in groups, without a loss.

use super::aimed::assert_aimed_is_unaimed;
use super::lab::lab;

fn balls(n: usize) -> String {
    let mut text = String::from(r#"(shape: quad(size: (8, 8)), material: "white")"#);
    for i in 0..n * n {
        let at = |i: usize| (i as f64 + 0.5) / n as f64 * 6.0 - 3.0;
        let (x, z) = (at(i / n), at(i % n));
        let y = 0.4 + 0.2 * (i % 3) as f64;
        let material = if i % 4 == 3 { "mirror" } else { "glass" };
        text += &format!(
            r#", (shape: sphere(center: ({x:?}, {y:?}, {z:?}), radius: 0.2), material: "{material}")"#
        );
    }
    text
}

#[test]
fn under_a_point_light() {
    assert_aimed_is_unaimed(&lab("", r#""a": point(position: (0.5, 3, 0.3), intensity: 7)"#, &balls(10)));
}

#[test]
fn under_the_sun() {
    let sun = r#""a": directional(direction: (1, -2, 0.5), irradiance: 3)"#;
    assert_aimed_is_unaimed(&lab("", sun, &balls(10)));
}

#[test]
fn under_a_lamp_and_a_sky() {
    let lights = r#""a": sphere(center: (-1.5, 3, -1), radius: 0.4, radiance: 5), "sky": environment(map: constant(0.3))"#;
    assert_aimed_is_unaimed(&lab("", lights, &balls(7)));
}
