//! What is predicted before the first tile, against what then happens.

use super::render::shot::{Shot, focused};
use std::path::Path;
use terrarium::plan::Effect;
use terrarium::render::{self, Options, Planned, Silent};
use terrarium::trace::Rays;

const GLASS: &str = r#"(
    camera: (eye: (0, 2, 6), target: (0, 0.8, 0), fov_deg: 40),
    image: (width: 160, height: 120),
    materials: {
        "floor": (diffuse: texture("squares")),
        "glass": (transmission: 1, ior: 1.5),
        "mirror": (reflection: 0.8),
    },
    textures: { "squares": checker(a: 0.7, b: 0.2, squares: (8, 8)) },
    lights: { "lamp": sphere(center: (-2, 5, 2), radius: 0.3, radiance: 80) },
    objects: [
        (name: "floor", shape: quad(size: (10, 10)), material: "floor"),
        (name: "ball", shape: sphere(radius: 0.8, center: (-0.9, 0.8, 0)), material: "glass"),
        (name: "mirror", shape: sphere(radius: 0.6, center: (0.9, 0.6, 0.4)), material: "mirror"),
    ],
)"#;

const MATT: &str = r#"(
    camera: (eye: (0, 2, 6), target: (0, 0.8, 0), fov_deg: 40),
    image: (width: 160, height: 120),
    antialiasing: grid(3),
    materials: { "floor": (diffuse: 0.5) },
    lights: { "lamp": point(position: (-2, 5, 2), intensity: 80) },
    objects: [ (name: "floor", shape: quad(size: (10, 10)), material: "floor") ],
)"#;

fn planned(shot: &Shot) -> Planned {
    render::plan(&shot.load(), &shot.options, &Silent).expect("a plan")
}

fn near(predicted: u64, real: u64, share: f64) -> bool {
    let (p, r) = (predicted as f64, real as f64);
    (p - r).abs() <= share * r
}

/// The pilot's blocks are a fair sample of the image: rays of every kind are foretold.
#[test]
fn rays_are_foretold_by_kind() {
    for text in
        [GLASS.to_owned(), GLASS.replace("textures", "antialiasing: grid(2), textures"), MATT.to_owned()]
    {
        // So small that a pilot sees about as many pixels as there are; eight of them leave little to chance.
        let text = text.replace("width: 160, height: 120", "width: 40, height: 32");
        let real = focused(&text).passes(4).render().rendered.stats;
        let plans: Vec<Planned> =
            (0..8).map(|seed| planned(&focused(&text).passes(1000).seed(seed))).collect();
        assert!(plans.iter().all(|planned| planned.samples == 250 * real.samples));
        let mean = |of: fn(&Rays) -> u64| plans.iter().map(|planned| of(&planned.rays)).sum::<u64>() / 8;
        for (kind, of) in [
            ("shadow", (|rays| rays.shadow) as fn(&Rays) -> u64),
            ("reflection", |rays| rays.reflection),
            ("refraction", |rays| rays.refraction),
        ] {
            let (predicted, real) = (mean(of), 250 * of(&real.rays));
            assert!(near(predicted, real, 0.25), "{kind}: {predicted} predicted, {real} traced");
        }
    }
}

/// Every stage and every effect that runs has its time, and no other has; the whole is that of the stages.
#[test]
fn time_is_told_for_what_runs_and_for_nothing_else() {
    let (planned, stats) =
        (self::planned(&focused(GLASS).passes(4000)), focused(GLASS).passes(40).render().rendered.stats);
    let stage = |name: &str| planned.stages.iter().any(|stage| stage.name == name);
    assert!(["plan", "build", "pilot", "photons", "forecast", "trace"].into_iter().all(stage));
    let sum: f64 = planned.stages.iter().map(|stage| stage.seconds).sum();
    assert!((planned.seconds / sum - 1.0).abs() < 1e-9);
    for effect in [Effect::Direct, Effect::Reflection, Effect::Refraction, Effect::Caustics] {
        assert!(planned.prices.of(effect.key()) > 0.0, "{effect} has no price");
        let price = stats.prices.iter().find(|price| price.effect == effect.key()).expect("a row");
        assert!(price.seconds > 0.0 && price.predicted_seconds > 0.0, "{price:?}");
    }
    assert_eq!(planned.prices.of(Effect::Indirect.key()), 0.0);
    let took: f64 = stats.prices.iter().map(|price| price.seconds).sum();
    let traced: f64 = stats
        .stages
        .iter()
        .filter(|stage| ["pilot", "photons", "trace"].contains(&stage.name.as_str()))
        .map(|stage| stage.seconds)
        .sum();
    assert!((took / traced - 1.0).abs() < 1e-6, "{took} s by effect, {traced} s by stage");

    let planned = self::planned(&focused(MATT));
    assert!(planned.stages.iter().all(|stage| stage.name != "pilot" && stage.name != "photons"));
    assert!(planned.photons.photons.is_none());
    assert_eq!(planned.prices.of(Effect::Caustics.key()), 0.0);
}

/// Twice the passes take twice the time of tracing, whatever else the machine does: only orders of
/// magnitude are asserted of wall time here; `benches/plan.py forecast` measures it.
#[test]
fn time_grows_with_the_passes() {
    let trace = |passes: u32| {
        let planned = planned(&focused(GLASS).passes(passes));
        planned.stages.iter().find(|stage| stage.name == "trace").expect("it traces").seconds
    };
    let (few, many) = (trace(4), trace(400));
    assert!((10.0..1000.0).contains(&(many / few)), "{few} s and {many} s");
}

/// A block of the pilot never reaches over the image, however small that is.
#[test]
fn the_smallest_images_are_planned() {
    for (width, height) in [(1, 1), (1, 300), (7, 2)] {
        for kind in ["none", "grid(16)", "adaptive()", "progressive"] {
            let text = MATT
                .replace("160", &width.to_string())
                .replace("120", &height.to_string())
                .replace("grid(3)", kind);
            let planned = planned(&focused(text).passes(2));
            assert!(planned.seconds > 0.0 && planned.samples > 0, "{width} × {height}, {kind}: {planned:?}");
        }
    }
}

/// The render is not changed by what is timed in it: the same bits whoever asks for the plan.
#[test]
fn planning_changes_no_pixel() {
    let shot = focused(GLASS).passes(2);
    let before = shot.render();
    planned(&shot);
    let mut alone = shot;
    alone.options.threads = Some(1);
    let after = alone.render();
    assert_eq!(before.rendered.image, after.rendered.image);
}

/// What an effect brings is what is missing without it; what brings nothing leaves every bit.
#[test]
fn effects_left_out_change_what_they_bring() {
    let loaded = focused(GLASS).load();
    let options = Options { passes: Some(0..2), ..Options::default() };
    let planned = render::plan(&loaded, &options, &Silent).expect("a plan");
    let prices = terrarium::measure::prices(&loaded, &options, 2, &planned.survey.decisions, &Silent)
        .expect("renders");
    let of = |effect| prices.left_out.iter().find(|row| row.effect == effect).expect("a row");
    for effect in [Effect::Direct, Effect::Reflection, Effect::Refraction, Effect::Textures, Effect::Caustics]
    {
        assert!(of(effect).relative_rms > 0.01 && !of(effect).same, "{:?}", of(effect));
    }
    for effect in [Effect::Direct, Effect::Reflection, Effect::Caustics] {
        assert!(of(effect).mean_change < 0.0, "{:?}", of(effect));
    }
    assert!(of(Effect::Shadows).mean_change > 0.0);
    assert!(
        prices.left_out.iter().all(|row| row.effect != Effect::Indirect && row.effect != Effect::Dispersion)
    );
    let folder = Path::new("").to_owned();
    let clear = focused(MATT).folder(&folder).load();
    let planned = render::plan(&clear, &options, &Silent).expect("a plan");
    let prices =
        terrarium::measure::prices(&clear, &options, 2, &planned.survey.decisions, &Silent).expect("renders");
    // Nothing stands between the lamp and the floor.
    let shadows = prices.left_out.iter().find(|row| row.effect == Effect::Shadows).expect("a row");
    assert!(shadows.same && shadows.relative_rms == 0.0);
}
