//! Photons against shadow rays, scenes of any scale, and caustics seen in mirrors and through glass.

use super::proofs::prove;
use super::record::{Record, row, sized};
use super::seen;
use crate::photons::lab::{lab, lab_in, on_patch, power};
use crate::render::caustics::lab::{estimate, parts};
use crate::render::caustics::scales;
use crate::render::meshes::{cube, folder, write_exr};
use crate::render::shot::{agreement, shot};
use crate::render::stability::{assets, render_everything};
use std::f64::consts::PI;
use std::path::Path;
use terrarium::scatter::{Aim, Store};

const LIGHTS: [(&str, &str); 9] = [
    ("point", r#""a": point(position: (0.5, 2, 0.3), intensity: 7)"#),
    (
        "point, classic falloff",
        r#""a": point(position: (0, 2, 0), intensity: 7, falloff: (0.5, 0.25, 0.125))"#,
    ),
    (
        "spot",
        r#""a": spot(position: (0, 2, 0), target: (1, 0, 0.5), intensity: 8, inner_deg: 10, outer_deg: 30)"#,
    ),
    ("directional", r#""a": directional(direction: (1, -2, 0.5), irradiance: 3)"#),
    ("sphere", r#""a": sphere(center: (0.5, 2, 0.3), radius: 0.6, radiance: 5)"#),
    ("quad", r#""a": quad(corner: (-0.5, 2, -0.4), edge_u: (1, 0, 0), edge_v: (0, 0, 0.8), radiance: 5)"#),
    (
        "disk",
        r#""a": disk(center: (0, 2, 0), normal: (0.3, -1, 0), radius: 0.6, radiance: 5, two_sided: true)"#,
    ),
    ("environment", r#""a": environment(map: gradient(zenith: 3, horizon: 1, nadir: 0.1))"#),
    ("environment, image", r#""a": environment(map: image(path: "sky.exr"))"#),
];

/// Emitting objects: material, object.
const OBJECTS: [(&str, &str); 4] = [
    (
        "ellipsoid",
        r#"(shape: sphere(radius: 1), material: "lamp", transform: [scale((0.3, 0.9, 0.5)), translate((0, 2, 0))])"#,
    ),
    ("box", r#"(shape: box(size: (0.4, 0.3, 0.5), center: (0.2, 2, 0.1)), material: "lamp")"#),
    (
        "mesh",
        r#"(shape: mesh(path: "lamp.obj", smooth: false), material: "lamp", transform: [translate((0.1, 2, 0))])"#,
    ),
    (
        "cylinder",
        r#"(shape: cylinder(radius: 0.3, height: 0.5), material: "lamp", transform: [translate((0, 1.8, 0.4))])"#,
    ),
];

const FLOOR: &str = r#"(shape: quad(size: (4, 4)), material: "white")"#;
const LAMP: &str = r#""lamp": (diffuse: 0, emission: 5)"#;

/// Irradiance of the square metre around (0.4, 0, 0.2): by photons with its error, and by shadow rays.
fn both(folder: &Path, lights: &str, objects: &str) -> [f64; 3] {
    let at = [0.4, 0.2];
    let scene = lab_in(folder, "", LAMP, lights, &format!("{FLOOR}{objects}"));
    let passes = scene.passes(Store::Direct, Aim::Scene, 24, sized(40_000, 160_000));
    let found = power(&passes, |p| on_patch(&scene, p, at, 0.5));
    // From straight above and below all lamps; a ray a pixel has its shadow rays.
    let text = format!(
        r#"(camera: (eye: (0.4, 1.2, 0.2), target: (0.4, 0, 0.2), up: (0, 0, -1), fov_deg: {}), image: (width: 32, height: 32),
        materials: {{ "white": (diffuse: 1), {LAMP} }}, lights: {{ {lights} }}, objects: [{FLOOR}{objects}])"#,
        2.0 * (0.5f64 / 1.2).atan().to_degrees()
    );
    let rays = shot(text).folder(folder).passes(sized(64, 512)).render().mean() * PI;
    [found.mean, found.error, rays]
}

#[test]
fn h35_photons_agree_with_shadow_rays() {
    row("H35", |row| {
        let dir = folder();
        // A sun in a sky that is uneven to the last texel.
        write_exr(&dir.path().join("sky.exr"), 16, 8, |x, y| {
            if (x, y) == (5, 1) { [60.0; 3] } else { [0.2 + ((3 * x + 5 * y) % 7) as f32; 3] }
        });
        cube().scaled(0.3).write(&dir.path().join("lamp.obj"));
        let objects = OBJECTS.map(|(name, object)| (name, String::new(), format!(", {object}")));
        let lights = LIGHTS.map(|(name, light)| (name, light.to_owned(), String::new()));
        for (name, light, object) in lights.into_iter().chain(objects) {
            let [photons, error, rays] = both(dir.path(), &light, &object);
            let what = format!(
                "{name}: irradiance by photons over that by shadow rays (3σ, at most {} %)",
                sized(2, 1)
            );
            row.is(&what, photons / rays, 1.0, (3.0 * error / rays + 1e-3).min(sized(0.02, 0.01)));
        }
        pane(row);
    });
}

/// (1 − R)/(1 + R), reflections inside of the pane included; a single passage would be 0.9216.
fn pane(row: &mut Record) {
    let sun = r#""sun": directional(direction: (0, -1, 0), irradiance: 1)"#;
    let scene = lab(
        "",
        sun,
        &format!(r#"{FLOOR}, (shape: box(size: (4, 0.1, 4), center: (0, 1, 0)), material: "glass")"#),
    );
    let found = power(&scene.caustics(64, sized(4_000, 40_000)), |p| on_patch(&scene, p, [0.0, 0.0], 1.0));
    row.is(
        "a flat pane, n = 1.5, sun head on: photons under it over without it (3σ)",
        found.mean / 4.0,
        0.923_077,
        3.0 * found.error / 4.0 + 1e-5,
    );
    prove(row, "pane");
}

#[test]
fn h36_scale_of_the_scene() {
    row("H36", |row| {
        let dir = assets();
        let one = render_everything(dir.path(), 1.0, 0.0, 1.0);
        let pixels = one.grey().len() as u64;
        for s in [1e-4, 0.03, 1e4] {
            let same = agreement(&one, &render_everything(dir.path(), s, 0.0, 1.0), 1e-4) * pixels as f64;
            let what = format!("pixels of a scene {s:e} times as large that are the same to 1e-4");
            row.share(&what, same.round() as u64, pixels, 0.999);
        }
        let photons = "classic(count: 20000, k: 50)";
        for (lamp, name) in [(0, "a sphere"), (1, "a point")] {
            let one = scales::scaled(1.0, &[lamp], photons);
            assert!(one.mean() > 0.01, "there is light");
            let pixels = one.grey().len() as u64;
            let other =
                [1e-4, 1e-3, 1e3, 1e4].map(|s| agreement(&one, &scales::scaled(s, &[lamp], photons), 1e-4));
            let least = other.into_iter().fold(1.0, f64::min) * pixels as f64;
            let what = format!("the same with caustics, by {name}, 1e-4 to 1e4: the worst");
            row.share(&what, least.round() as u64, pixels, 0.999);
        }
        let one = scales::scaled(1.0, &[0, 1], scales::PASSES);
        for s in [1e-3, 1e3] {
            let other = scales::scaled(s, &[0, 1], scales::PASSES);
            row.is_close(
                &format!("mean by progressive photons of two lamps, {s:e} times as large, over"),
                other.mean() / one.mean(),
                1.0,
                1e-3,
            );
        }
    });
}

#[test]
fn h50_caustic_seen_in_glass() {
    row("H50", |row| {
        let n = sized(10, 24);
        let direct = seen::blocks(&seen::scene(seen::FROM_ABOVE, "", n), false);
        // The mirror folds the view at a height of 3 m, by 90°.
        let mirror = r#", (shape: quad(size: (0.8, 0.8)), material: "mirror", transform: [rotate(axis: (1, 0, 0), deg: 135), translate((0, 3, 0))])"#;
        let folded = seen::blocks(&seen::scene("eye: (0, 3, 2), target: (0, 3, 0)", mirror, n), true);
        // Within 7° of the normal the pane transmits 0.923077 to 1e-4.
        let pane = r#", (shape: box(size: (2, 0.001, 2), center: (0, 4, 0)), material: "glass")"#;
        let through = seen::blocks(&seen::scene(seen::FROM_ABOVE, pane, n), false);
        for (what, found, factor) in
            [("a caustic in a perfect mirror", folded, 1.0), ("a caustic through a pane", through, 0.923_077)]
        {
            let (beyond, ratio, lit) = seen::compare(&found, &direct, factor);
            assert!(lit > 40, "{lit} blocks are lit");
            // Of 64 blocks whose errors are known from ten parts, one is beyond 3σ by chance.
            row.at_most(&format!("{what}: blocks of 64 beyond 3σ of it seen directly"), beyond as f64, 2.0);
            row.is("its power over that", ratio, 1.0, 0.01);
        }
        from_within(row);
    });
}

/// The terrarium's case: eye, lamp and floor within one body of glass's walls. A hollow glass cube around the
/// floor; the sun comes through its lid.
fn from_within(row: &mut Record) {
    use crate::render::shot::{Picture, focused};
    use terrarium::render::Aov;
    let scene = |eye: f64| {
        let shot = focused(format!(
            r#"(camera: (eye: (0, {eye}, 0), target: (0, 0, 0), up: (0, 0, 1), fov_deg: 8), image: (width: 16, height: 16),
            photons: progressive(count: 50000),
            materials: {{ "white": (diffuse: 0.8), "glass": (transmission: 1), "air": (transmission: 1, ior: 1, priority: 1) }},
            lights: {{ "sun": directional(direction: (0, -1, 0), irradiance: 1) }},
            objects: [(shape: quad(size: (1.8, 1.8)), material: "white", transform: [translate((0, 0.01, 0))]),
                      (shape: box(size: (2.1, 2.1, 2.1), center: (0, 1, 0)), material: "glass"),
                      (shape: box(size: (2, 2, 2), center: (0, 1, 0)), material: "air")])"#
        ))
        .aovs(&[Aov::Caustic]);
        let means: Vec<f64> = parts(&shot, sized(8, 32)).iter().map(Picture::mean).collect();
        estimate(&means)
    };
    let irradiance = 0.923_077 * 0.8 / PI;
    for (what, eye, expected) in [
        ("from within a cube of glass", 1.9, irradiance),
        ("from outside of it", 4.0, 0.923_077 * irradiance),
    ] {
        let found = scene(eye);
        row.is(
            &format!("its floor in the sun, {what} (3σ)"),
            found.mean,
            expected,
            3.0 * found.error + 1e-4 * expected,
        );
    }
}
