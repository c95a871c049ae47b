//! What the built world's bounds tell: which light reaches which mirror or interface, and what overlaps.

use super::lab::{BALL, LAMP, render, scene};
use terrarium::plan::{Effect, Overrides};
use terrarium::survey::{LightReach, Survey};

fn survey(materials: &str, lights: &str, objects: &str) -> Survey {
    render(&scene("", materials, lights, objects), &Overrides::default()).rendered.survey
}

fn line(survey: &Survey, effect: Effect) -> String {
    survey.decisions.iter().find(|d| d.effect == effect).expect("one an effect").to_string()
}

fn light<'a>(survey: &'a Survey, name: &str) -> &'a LightReach {
    survey.lights.iter().find(|l| l.name == name).expect("one a light")
}

/// From a distance d a ball of radius r fills (1 − √(1 − r²/d²))/2 of the sphere.
#[test]
fn the_share_of_a_lamp_that_is_aimed_at_a_ball_is_about_its_solid_angle() {
    let lamp = r#""lamp": point(position: (0, 3, 0), intensity: 5)"#;
    let ball = r#"(name: "ball", shape: sphere(radius: 0.5, center: (0, 1, 0)), material: "glass")"#;
    let survey = survey("", lamp, ball);
    let exact = 0.5 * (1.0 - (1.0f64 - 0.0625).sqrt());
    let aimed = light(&survey, "lamp").aimed.expect("photons are sent");
    assert!(aimed >= exact && aimed < 1.25 * exact, "{aimed} for {exact}");
    let said = line(&survey, Effect::Caustics);
    let expected = "caustics: on: `lamp` reaches `floor` through `ball` (dielectric, ior 1.5); 1.";
    assert!(said.starts_with(expected) && said.ends_with(" % of `lamp`'s sphere is aimed at"), "{said}");
}

#[test]
fn lights_that_reach_nothing_specular_are_told_and_send_nothing() {
    let lights = r#""lamp": point(position: (1, 4, 2), intensity: 40),
        "rim": spot(position: (0, 3, 0), target: (0, 9, 0), intensity: 5, inner_deg: 20, outer_deg: 30),
        "wall": quad(corner: (-1, 0, -3), edge_u: (0, 2, 0), edge_v: (2, 0, 0), radiance: 2),
        "sun": directional(direction: (0, -1, 0), irradiance: 1)"#;
    let picture = render(&scene("", "", lights, BALL), &Overrides::default());
    let survey = &picture.rendered.survey;
    let off = "caustics from `rim`: off: its cone meets no specular object";
    assert_eq!(light(survey, "rim").to_string(), off);
    assert_eq!(light(survey, "wall").reason, "no specular object lies before it");
    assert!(survey.text().contains(off), "{}", survey.text());
    let sun = light(survey, "sun");
    // The ball's shadow and what of its bounds lies around it.
    let area = sun.aimed_m2.expect("parallel light");
    let disk = std::f64::consts::PI * 0.25;
    assert!(sun.on && area >= disk && area < 1.25 * disk, "{area}");
    let shares = picture.rendered.stats.photons.photons.expect("two lights send photons").lights;
    for share in shares {
        assert_eq!(share.share > 0.0, light(survey, &share.name).on, "{}", share.name);
    }
}

/// Many objects are told apart one by one, although photons are aimed at them in groups.
#[test]
fn a_spot_between_many_balls_sends_no_photons() {
    let ball = |i: u32| {
        let (x, z) = (f64::from(i % 8) * 4.0 - 14.0, f64::from(i / 8) * 4.0 - 14.0);
        format!(
            r#"(name: "ball{i}", shape: sphere(radius: 0.2, center: ({x}, 0.3, {z})), material: "glass"),"#
        )
    };
    let balls: String = (0..64).map(ball).collect();
    // Straight down between four of them.
    let narrow =
        r#""rim": spot(position: (0, 3, 0), target: (0, 0, 0), intensity: 5, inner_deg: 2, outer_deg: 5)"#;
    let picture = render(&scene("", "", narrow, &balls), &Overrides::default());
    assert!(picture.rendered.stats.photons.photons.is_none());
    assert_eq!(
        line(&picture.rendered.survey, Effect::Caustics),
        "caustics: off: `rim`: its cone meets no specular object"
    );
    let wide = narrow.replace("outer_deg: 5", "outer_deg: 60");
    let survey = survey("", &wide, &balls);
    assert!(light(&survey, "rim").on && light(&survey, "rim").objects.len() == 4);
}

#[test]
fn media_that_overlap_are_told_in_pairs() {
    let at = |x: f64| {
        format!(
            r#"(name: "box{x}", shape: box(size: (1, 1, 1)), material: "glass", transform: [translate(({x}, 1, 0))])"#
        )
    };
    let apart = survey("", LAMP, &format!("{}, {}", at(0.0), at(2.0)));
    assert_eq!(
        line(&apart, Effect::NestedMedia),
        "nested media: off: no two objects that transmit overlap, not even by their bounds"
    );
    let touching = survey("", LAMP, &format!("{}, {}, {}", at(0.0), at(0.5), at(1.2)));
    assert_eq!(
        touching.nested.pairs,
        [["box0", "box0.5"], ["box0.5", "box1.2"]].map(|p| p.map(str::to_owned))
    );
    assert_eq!(
        line(&touching, Effect::NestedMedia),
        "nested media: on: the bounds of `box0` and `box0.5` overlap; and 1 more pair"
    );
}

#[test]
fn a_survey_is_written_for_machines() {
    let json = serde_json::to_value(survey("", LAMP, BALL)).expect("it can be written");
    assert_eq!(json["decisions"][0]["effect"], "direct");
    assert_eq!(json["decisions"][0]["cause"], "scene");
    assert_eq!(json["lights"][0]["objects"][0], "ball");
    assert_eq!(json["nested"]["pairs"].as_array().map(Vec::len), Some(0));
}
