//! The surface of a scatter may be any placed object with a name, also one within a group.

use super::CAMERA;
use std::path::Path;
use terrarium::build::build;
use terrarium::description::{Format, load_str};
use terrarium::plan::{Plan, Request};

/// A hill within a group that is moved and mirrored, and what stands besides it and in it.
fn scene(inside: &str, outside: &str) -> String {
    format!(
        r#"({CAMERA}, materials: {{ "m": (diffuse: 0.5) }},
        definitions: {{ "dot": (shape: sphere(radius: 0.001), material: "m") }},
        objects: [
            (name: "land", shape: group(objects: [
                (name: "hill", shape: quad(size: (2, 4)), material: "m", transform: [translate((0, 1, 0))]),
                {inside}
            ]), transform: [scale((3, 1, -1)), translate((10, 2, 0))]),
            {outside}
        ])"#
    )
}

#[test]
fn copies_stand_on_an_object_of_a_group_wherever_the_scatter_is() {
    let scatter = r#"(shape: scatter(of: ["dot"], over: "hill", count: 500))"#;
    for text in [scene("", scatter), scene(scatter, "")] {
        let scene = load_str(&text, Format::Ron, Path::new(""), &[]).unwrap_or_else(|r| panic!("{r}")).scene;
        let world = build(&scene, &Plan::new(&scene, &Request::default()).expect("nothing is overridden"))
            .unwrap_or_else(|e| panic!("{e}"))
            .world;
        assert_eq!(world.instances.len(), 501);
        let mut reach = (f64::MAX, f64::MIN);
        for dot in &world.instances {
            let p = dot.placement.world_from_object.translation + world.origin;
            assert!((p.y - 3.0).abs() < 1e-9 && (p.x - 10.0).abs() <= 3.0 && p.z.abs() <= 2.0, "{p}");
            reach = (reach.0.min(p.x), reach.1.max(p.x));
        }
        assert!(reach.0 < 7.3 && reach.1 > 12.7, "the copies reach from {} to {}", reach.0, reach.1);
    }
}

#[test]
fn a_group_cannot_carry_what_is_in_it() {
    let text = scene(r#"(shape: scatter(of: ["dot"], over: "land", count: 3))"#, "");
    let report = load_str(&text, Format::Ron, Path::new(""), &[]).expect_err("it contains itself");
    let messages: Vec<&str> = report.errors().map(|d| d.message.as_str()).collect();
    assert_eq!(messages, ["contains itself: land → land"]);
    let text = scene("", r#"(shape: scatter(of: ["dot"], over: "hil", count: 3))"#);
    let report = load_str(&text, Format::Ron, Path::new(""), &[]).expect_err("there is no hil");
    assert!(report.to_string().contains("did you mean `hill`?"), "{report}");
}
