//! Events that should be rare: each is provoked, counted, told, and refused where it is asked to be.

use crate::render::meshes::icosphere;
use crate::render::shot::{Shot, focused};
use std::path::Path;
use terrarium::math::Rare;

fn scene(more: &str, lamp: &str, objects: &str) -> Shot {
    focused(format!(
        r#"(camera: (eye: (0, 0.5, 5), target: (0, 0, 0), fov_deg: 30), image: (width: 12, height: 12), {more}
        materials: {{ "matt": (diffuse: 0.7), "glass": (transmission: 1) }}, lights: {{ "lamp": {lamp} }}, objects: [{objects}])"#
    ))
}

const SKY: &str = "environment(map: constant(1))";
/// A scene for each event.
fn provoked(folder: &Path) -> Vec<(Rare, Shot)> {
    icosphere(0).write(&folder.join("coarse.obj"));
    let nested: String = (0..9)
        .map(|i| format!(r#"(shape: sphere(radius: {}), material: "glass"), "#, 1.0 - 0.1 * f64::from(i)))
        .collect();
    let few = "photons: progressive(count: 1000),";
    let all = Rare::ALL.into_iter().map(|event| {
        let shot = match event {
            Rare::NonFiniteSample => {
                let hot = "point(position: (0, 0, 1.5), intensity: 3e38)";
                scene("photons: off,", hot, r#"(shape: sphere(radius: 1), material: "matt")"#)
            }
            Rare::MediaOverflow => scene("photons: off,", SKY, &nested),
            Rare::DirectionThroughSurface => scene(
                "photons: off,",
                SKY,
                r#"(shape: mesh(path: "coarse.obj", smooth: true), material: "glass")"#,
            ),
            Rare::NonFinitePhoton => {
                let objects = r#"(shape: sphere(radius: 1000), material: "glass"),
                    (shape: quad(size: (9000, 9000)), material: "matt", transform: [translate((0, -1500, 0))])"#;
                scene(few, "directional(direction: (0, -1, 0.1), irradiance: 3e38)", objects)
            }
        };
        (event, shot.folder(folder).passes(2))
    });
    all.collect()
}

#[test]
fn every_rare_event_is_counted_told_and_refused_under_strict() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (event, shot) in provoked(folder.path()) {
        let rendered = shot.render().rendered;
        let name = event.name();
        let found = rendered.stats.rare_events.iter().find(|e| e.name == name).expect("all are listed");
        assert!(found.count > 0 && found.count as f64 > found.allowed * found.of as f64, "{found:?}");
        assert!(rendered.warnings.iter().any(|w| w.starts_with(name)), "{name}: {:?}", rendered.warnings);
        let mut strict = shot;
        strict.options.strict = true;
        let Err(refused) = strict.try_render() else { panic!("{name} is not refused") };
        assert!(refused.exit_code() == 1 && refused.to_string().contains(name), "{name}: {refused}");
    }
}

/// Counts travel with the tiles that they are of: neither their size nor the threads change a sum, but for corners
/// that tiles share, which these scenes have none of.
#[test]
fn counts_are_the_same_for_any_tiles_and_threads() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (event, shot) in provoked(folder.path()) {
        let counts = |threads, tile| {
            let mut shot = shot.clone();
            (shot.options.threads, shot.options.tile) = (Some(threads), tile);
            shot.render().rendered.stats.rare_events.iter().map(|e| (e.count, e.of)).collect::<Vec<_>>()
        };
        assert_eq!(counts(1, 32), counts(2, 5), "{}", event.name());
    }
}

/// Sums have a unit: below it a picture is black, and near it coarse, which is told; a dark place is neither.
#[test]
fn a_picture_near_the_unit_of_sums_is_told() {
    let of = |radiance: f64| {
        let sky = format!("environment(map: constant({radiance:e}))");
        scene("", &sky, r#"(shape: sphere(radius: 1), material: "matt")"#).passes(2).render()
    };
    for radiance in [1e-25, 1e-14] {
        let picture = of(radiance);
        let told =
            picture.rendered.warnings.iter().any(|w| w.contains("the brightest sample has a radiance"));
        assert!(told, "{radiance}: {:?}", picture.rendered.warnings);
    }
    assert_eq!(of(1e-25).mean(), 0.0);
    let picture = of(1e-9);
    assert!(picture.rendered.warnings.is_empty(), "{:?}", picture.rendered.warnings);
    assert!((picture.mean() / of(1.0).mean() / 1e-9 - 1.0).abs() < 1e-6);
    let black =
        scene("", "point(position: (0, 0, 0), intensity: 1)", r#"(shape: sphere(), material: "matt")"#);
    assert!(black.passes(2).render().rendered.warnings.is_empty());
}
