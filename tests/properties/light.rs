//! Whole pixels: random objects under an even sky are no brighter than it, at any scale and place.

use super::describe::{folder, material, place, shape};
use super::hold;
use crate::render::shot::shot;
use proptest::prelude::*;

/// A furnace: the sky of 1 all around. What is not glass seen from inside shows 1 at most, in the mean over
/// what a pass draws; nothing is dropped, and nothing is negative.
#[test]
fn a_furnace_stays_a_furnace() {
    hold(80, (shape(), place(30.0, 100.0), material()), |(form, place, material)| {
        let (c, s) = (place.centre, place.scale);
        let scene = format!(
            r#"(camera: (eye: ({:e}, {:e}, {:e}), target: ({:e}, {:e}, {:e})), image: (width: 6, height: 6), render: (max_depth: 40),
            materials: {{ "m": ({}) }}, lights: {{ "sky": environment(map: constant(1), samples: 4) }},
            objects: [(shape: {}, material: "m", transform: [{}])])"#,
            c.x + 60.0 * s,
            c.y + 90.0 * s,
            c.z + 200.0 * s,
            c.x,
            c.y,
            c.z,
            material.text(),
            form.text,
            place.text
        );
        let picture = shot(scene).folder(&folder()).passes(8).render();
        prop_assert!(picture.is_sound());
        prop_assert!(picture.rendered.stats.rare_events.iter().all(|event| event.count == 0));
        let mean = picture.mean();
        prop_assert!(mean <= 1.05, "{}", mean);
        Ok(())
    });
}
