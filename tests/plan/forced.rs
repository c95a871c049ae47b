//! The plan against everything forced on: what is not run would have added nothing.
//!
//! Forced, photons are sent from every light towards all of the scene, media that light does not notice are
//! traced as interfaces, and every material is looked up as if it were textured.

use super::lab::{BALL, LAMP, scene, shot};
use crate::render::shot::Picture;
use terrarium::description::load;
use terrarium::plan::Overrides;
use terrarium::render::{Options, Silent, render};

fn forced() -> Overrides {
    Overrides { forced: true, ..Overrides::default() }
}

/// Where an effect adds exactly nothing, the bits are the same.
#[test]
fn stages_that_nothing_calls_for_add_nothing() {
    let lights = [
        LAMP,
        r#""sky": environment(map: constant(0.5)), "panel": quad(corner: (-1, 3, -1), edge_u: (2, 0, 0), edge_v: (0, 0, 2), radiance: 5)"#,
    ];
    for lights in lights {
        let text =
            scene("indirect: 2, indirect_by: paths,", "", lights, r#"(shape: box(), material: "matt")"#);
        let (plan, all) = (shot(&text, &Overrides::default()).render(), shot(&text, &forced()).render());
        assert!(plan.rendered.stats.photons.photons.is_none());
        let sent = all.rendered.stats.photons.photons.as_ref().expect("photons are sent");
        assert!(sent.emitted > 0 && sent.stored == 0);
        assert!(plan.bits() == all.bits());
    }
}

/// Photons that are aimed at the ball alone bring the light of photons sent everywhere.
#[test]
fn aiming_changes_no_light() {
    let text = scene("photons: progressive(count: 20000, max_radius_m: 0.1),", "", LAMP, BALL);
    let means = |overrides: &Overrides| -> Vec<f64> {
        let one = |seed| shot(&text, overrides).passes(4).seed(seed).render();
        (0..4).map(|seed| one(seed).mean()).collect()
    };
    assert_agree(&means(&Overrides::default()), &means(&forced()), "a ball");
}

/// Means of the two within three standard errors of their difference.
#[track_caller]
fn assert_agree(a: &[f64], b: &[f64], what: &str) {
    let moments = |x: &[f64]| {
        let n = x.len() as f64;
        let mean = x.iter().sum::<f64>() / n;
        (mean, x.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0) / n)
    };
    let ((a, va), (b, vb)) = (moments(a), moments(b));
    // 3σ of a normal variable is 4.9 standard errors of so few samples (t of 6 degrees of freedom); and the
    // rounding of equal images.
    let allowed = 4.9 * (va + vb).sqrt() + 1e-6 * a.abs();
    assert!((a - b).abs() <= allowed, "{what}: {a} and {b} ± {allowed:e}");
}

/// Every scene of the repository, small.
#[test]
fn every_scene_agrees_with_everything_forced_on() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let scenes = [
        "scenes/gallery/antialiasing.ron",
        "scenes/gallery/tumbler.ron",
        "scenes/gallery/reflection.ron",
        "scenes/gallery/normal_maps.ron",
        "scenes/gallery/prism.ron",
        "scenes/gallery/primitives.toml",
        "scenes/gallery/still_life.toml",
        "scenes/terrarium.ron",
        "scenes/yardstick/caustic-sphere.ron",
        "scenes/yardstick/cornell-glass.ron",
        "scenes/yardstick/primitives.ron",
    ];
    let set = [
        "image.width=24",
        "image.height=18",
        "antialiasing=progressive",
        "photons=progressive(count: 10000)",
    ];
    for name in scenes {
        let loaded = load(&root.join(name), &set.map(str::to_owned))
            .unwrap_or_else(|report| panic!("{name}: {report:?}"));
        let one = |seed: u64, overrides: Overrides| -> Picture {
            let options = Options { passes: Some(0..2), seed: Some(seed), overrides, ..Options::default() };
            let rendered =
                render(&loaded, &options, &Silent).unwrap_or_else(|error| panic!("{name}: {error}"));
            Picture { rendered }
        };
        let planned: Vec<Picture> = (0..4).map(|seed| one(seed, Overrides::default())).collect();
        let all: Vec<Picture> = (0..4).map(|seed| one(seed, forced())).collect();
        if planned[0].rendered.stats.photons.photons.is_none() {
            let same = planned.iter().zip(&all).all(|(a, b)| a.bits() == b.bits());
            assert!(same, "{name}: nothing is focused, so that nothing changes");
        }
        let means = |pictures: &[Picture]| pictures.iter().map(Picture::mean).collect::<Vec<f64>>();
        assert_agree(&means(&planned), &means(&all), name);
    }
}
