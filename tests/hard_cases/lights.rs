//! Lamps that touch, shrink to points, hold what they light, or give no light; against closed forms.

use super::proofs::prove;
use super::record::{Record, row, sized};
use crate::render::light::{floor, irradiance};
use crate::render::meshes::{folder, write_exr};
use crate::render::shot::{focused, shot};
use std::f64::consts::{FRAC_PI_2, PI};
use terrarium::description::{Format, load_str};
use terrarium::math::random::{Counter, Sequence, Stage};
use terrarium::math::{DVec3, Ray};
use terrarium::optics::{Cone, Cuboid, Disk, Polyhedron, Quad, Shape, Solid, Sphere};

/// Irradiance at `from` with normal `n` from a shape of radiance 1, by sampled directions.
fn sampled(shape: &Shape, from: DVec3, n: DVec3, samples: u32) -> f64 {
    let estimate = |i| {
        let u = Sequence::new(56, Stage::Test, 0, i).pair();
        let Some(s) = shape.sample_direction(from, u) else { return 0.0 };
        let hit = shape.nearest(&Ray { origin: from, dir: s.dir }, 0.0, f64::INFINITY);
        if hit.is_some() { s.dir.dot(n).max(0.0) / s.pdf } else { 0.0 }
    };
    (0..samples).map(estimate).sum::<f64>() / f64::from(samples)
}

#[test]
fn s09_sphere_light() {
    row("S9", |row| {
        prove(row, "sphere-light");
        for (x, y, r) in [(0.0, 2.0, 1.0), (3.0, 1.0, 0.9), (0.0, 1.0, 0.99)] {
            let z = 0.4 * x;
            let d2: f64 = x * x + y * y + z * z;
            let expected = PI * 3.0 * r * r / d2 * y / d2.sqrt();
            let light = format!(r#""a": sphere(center: ({x}, {y}, {z}), radius: {r}, radiance: 3)"#);
            let what = format!("irradiance under a sphere of radius {r} at ({x}, {y}, {z}): πL(r/d)²cosθ");
            row.is_close(&what, irradiance(&light, sized(1024, 16_384)), expected, 1e-3);
        }
    });
}

#[test]
fn h26_touching_area_lights() {
    row("H26", |row| {
        prove(row, "square-light");
        form_factor(row);
        any_height(row);
        touching(row);
        flush(row);
        // As rendered, a floor of which is seen what lies before the lamp.
        let (mut most, mut least) = (0.0f64, f64::INFINITY);
        for height in [1e-2, 6e-3] {
            for light in [
                format!(
                    r#""a": quad(corner: (-1, {height}, -1), edge_u: (2, 0, 0), edge_v: (0, 0, 2), radiance: 1)"#
                ),
                format!(r#""a": disk(center: (0, {height}, 0), normal: (0, -1, 0), radius: 1, radiance: 1)"#),
                format!(r#""a": sphere(center: (0, {}, 0), radius: 1, radiance: 1)"#, 1.0 + height),
            ] {
                let found = irradiance(&light, 256);
                (most, least) = (most.max(found / PI), least.min(found / PI));
            }
        }
        row.at_most("rendered irradiance close below quad, disk and sphere, over πL", most, 1.001);
        row.at_least("and it is nearly that", least, 0.97);
    });
}

/// The centred unit square at height 1.
fn form_factor(row: &mut Record) {
    let quad = |edges: &str, more: &str| {
        let light = format!(r#""a": quad(corner: (-0.5, 1, -0.5), {edges}, radiance: 2{more})"#);
        irradiance(&light, sized(256, 4_096))
    };
    // edge_u × edge_v = −y: towards the floor.
    let (towards, away) = ("edge_u: (1, 0, 0), edge_v: (0, 0, 1)", "edge_u: (0, 0, 1), edge_v: (1, 0, 0)");
    let expected = 2.0 * 0.752_274_7;
    for (what, edges, more) in [
        ("a unit square of radiance 2 at height 1 that is not seen", towards, ", visible: false"),
        ("turned away, of two sides", away, ", two_sided: true"),
    ] {
        row.is_close(&format!("irradiance under {what}"), quad(edges, more), expected, 2e-3);
    }
    row.is("turned away", quad(away, ""), 0.0, 0.0);
}

/// Centred square of edge 1 at height h: E = 4·(a/s)·atan(a/s) with a = ½ and s = √(h² + ¼).
fn any_height(row: &mut Record) {
    let quad = Shape::Quad(Quad::new([1.0, 1.0]));
    let mut off = 0.0f64;
    for h in [1e-12, 1e-6, 1e-3, 0.1, 1.0, 10.0, 1e3, 1e6] {
        let s: f64 = (h * h + 0.25f64).sqrt();
        let exact = 4.0 * (0.5 / s) * libm::atan(0.5 / s);
        off = off.max((sampled(&quad, DVec3::Y * h, DVec3::NEG_Y, 4096) / exact - 1.0).abs());
    }
    row.at_most("a square at heights from 1e-12 to 1e6: off its closed form, as a share", off, 2e-3);
    row.is("at height 1", sampled(&quad, DVec3::Y, DVec3::NEG_Y, 65_536), 0.752_274_7, 2e-4);
}

/// A lamp set in a ceiling, on glass, or in a glass of its own size gives as much light as without them (with photons
/// where it is glass, of an index that reflects nothing to speak of).
fn flush(row: &mut Record) {
    let scene = |lamp: &str, objects: &str| {
        focused(format!(
            r#"(camera: (eye: (0, 0.9, 0), target: (0, 0, 0), up: (0, 0, -1), fov_deg: 60), image: (width: 12, height: 12),
            photons: progressive(count: 20000), materials: {{ "white": (diffuse: 0.8), "black": (), "thin": (transmission: 1, ior: 1.0001), "lamp": (emission: 3) }},
            lights: {{ {lamp} }}, objects: [(shape: quad(size: (6, 6)), material: "white"){objects}])"#
        ))
        .passes(sized(4, 64))
        .render()
    };
    let (mut opaque, mut opaque_pixel, mut clear) = (0.0f64, 0.0f64, 0.0f64);
    for y in [1.0, 1.9, 2.0, 2.4, 3.3] {
        let quad = format!(
            r#""lamp": quad(corner: (-0.4, {y}, -0.4), edge_u: (0.8, 0, 0), edge_v: (0, 0, 0.8), radiance: 10)"#
        );
        let disk =
            format!(r#""lamp": disk(center: (0, {y}, 0), normal: (0, -1, 0), radius: 0.4, radiance: 10)"#);
        let ball = format!(r#""lamp": sphere(center: (0, {y}, 0), radius: 0.4, radiance: 10)"#);
        let glow = format!(
            r#", (shape: box(size: (0.6, 0.5, 0.4)), material: "lamp", transform: [translate((0, {y}, 0))])"#
        );
        let ceiling = format!(
            r#", (shape: quad(size: (6, 6)), material: "black", transform: [translate((0, {y}, 0))])"#
        );
        for lamp in [&quad, &disk] {
            let (with, none) = (scene(lamp, &ceiling), scene(lamp, ""));
            opaque = opaque.max((with.mean() / none.mean() - 1.0).abs());
            let off =
                with.grey().iter().zip(none.grey()).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
            opaque_pixel = opaque_pixel.max(off);
        }
        let slab = format!(
            r#", (shape: box(size: (3, 0.2, 3)), material: "thin", transform: [translate((0, {}, 0))])"#,
            y + 0.1
        );
        let below = format!(
            r#", (shape: box(size: (3, 0.2, 3)), material: "thin", transform: [translate((0, {}, 0))])"#,
            y - 0.1
        );
        let around = format!(r#", (shape: sphere(radius: 0.4, center: (0, {y}, 0)), material: "thin")"#);
        let case = format!(
            r#"{glow}, (shape: box(size: (0.6, 0.5, 0.4)), material: "thin", transform: [translate((0, {y}, 0))])"#
        );
        for (lamp, plain, object) in [
            (&quad[..], "", slab.clone()),
            (&quad, "", below.clone()),
            (&disk, "", slab),
            (&disk, "", below),
            (&ball, "", around),
            ("", &glow, case),
        ] {
            let off = (scene(lamp, &object).mean() / scene(lamp, plain).mean() - 1.0).abs();
            clear = clear.max(off);
        }
    }
    row.at_most(
        "quad and disk in the plane of a black ceiling, 1 to 3.3 m up: the floor's mean off that without",
        opaque,
        1e-5,
    );
    row.at_most("its worst pixel", opaque_pixel, 1e-4);
    row.at_most(
        "quad, disk, sphere and box flush with clear glass, above, below, around: the same",
        clear,
        sized(0.03, 0.01),
    );
}

fn touching(row: &mut Record) {
    let lights = [
        Shape::Quad(Quad::new([1.0, 1.0])),
        Shape::Disk(Disk::new(1.0, 0.0)),
        Shape::Sphere(Sphere::new(1.0, DVec3::Y)),
        Shape::Cuboid(Cuboid::new(DVec3::ONE, DVec3::Y * 0.5)),
        Shape::Cone(Cone::new(1.0, 0.5, 1.0, true)),
        Shape::Polyhedron(Polyhedron::new(Solid::Dodecahedron, 1.0)),
    ];
    let mut counter = Counter::new(57, Stage::Test, 0);
    let (mut most, mut bad, mut places) = (0.0f64, 0, 0);
    for light in lights {
        let bottom = light.bounds().0.y;
        for exponent in [0, -3, -9, -15, -300] {
            for _ in 0..sized(16, 200) {
                let below = libm::pow(10.0, f64::from(exponent));
                let from = DVec3::new(counter.value() - 0.5, bottom - below, counter.value() - 0.5);
                let e = sampled(&light, from, DVec3::Y, 1024);
                most = most.max(e / PI);
                bad += u64::from(!(e >= 0.0 && e.is_finite()));
                places += 1;
            }
        }
    }
    row.at_most("irradiance over πL from 1 m to 1e-300 m below six kinds of lamp (1024 samples)", most, 1.02);
    row.none("places where it is no number", bad, places);
}

#[test]
fn h27_tiny_and_enclosing_sphere_lights() {
    row("H27", |row| {
        let point = irradiance(r#""a": point(position: (1, 2, -2), intensity: 7)"#, 16);
        for r in [1e-2, 1e-4, 1e-9, 1e-15] {
            let radiance = 7.0 / (PI * r * r);
            let light = format!(r#""a": sphere(center: (1, 2, -2), radius: {r:e}, radiance: {radiance:e})"#);
            let what = format!(
                "irradiance by a sphere of radius {r:e} m and the power of a point, over the point's"
            );
            row.is(&what, irradiance(&light, 16) / point, 1.0, f64::max(1e-4, 4.0 * r));
        }
        shrinking(row);
        let mut off = 0.0f64;
        for r in [0.9, 0.3, 1e-2, 1e-4, 1e-6, 1e-8] {
            for (d, theta) in [(2.0, 0.0), (2.0, 0.7), (3.0, 1.2)] {
                let axis = DVec3::new(libm::sin(theta), libm::cos(theta), 0.0);
                let sine: f64 = r / d;
                if libm::asin(sine) + theta > FRAC_PI_2 {
                    continue;
                }
                let shape = Shape::Sphere(Sphere::new(r, axis * d));
                let exact = PI * sine * sine * libm::cos(theta);
                off = off.max((sampled(&shape, DVec3::ZERO, DVec3::Y, 4096) / exact - 1.0).abs());
            }
        }
        row.at_most("spheres of radius 0.9 to 1e-8: off πL(r/d)²cosθ, as a share", off, 2e-3);
        for (x, y) in [(0.0, 0.0), (0.5, 0.3), (0.0, -0.9)] {
            let light = format!(r#""a": sphere(center: ({x}, {y}, 0), radius: 1, radiance: 2)"#);
            let what = format!("inside of a sphere of radius 1 about ({x}, {y}, 0): E/πL");
            row.is(&what, irradiance(&light, sized(4096, 65_536)) / (PI * 2.0), 1.0, 5e-3);
        }
        let zero = floor(r#""a": sphere(center: (0, 2, 0), radius: 0, radiance: 1)"#, "");
        let report = load_str(&zero, Format::Ron, "".as_ref(), &[]);
        let said = report.err().and_then(|r| r.errors().next().map(|e| e.headline())).unwrap_or_default();
        row.says(
            "a radius of 0 is refused, as it has no radiance",
            &said,
            "lights.a.sphere.radius: 0 is not above 0",
        );
    });
}

/// A sphere of the power of a point, the smaller the nearer to it. Samples lie symmetrically in its cone, so that
/// their own noise is far below (r/d)².
fn shrinking(row: &mut Record) {
    let (d, theta) = (3.0, 0.7);
    let axis = DVec3::new(libm::sin(theta), libm::cos(theta), 0.0);
    // I cosθ/d² with I = πr²L.
    let point = |r: f64| PI * r * r * libm::cos(theta) / (d * d);
    let mut most = 0.0f64;
    for r in [0.9, 0.3, 0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8] {
        let shape = Shape::Sphere(Sphere::new(r, axis * d));
        let estimate = |u| shape.sample_direction(DVec3::ZERO, u).map_or(0.0, |s| s.dir.y.max(0.0) / s.pdf);
        let side = 64;
        let at = |i: i32| (f64::from(i) + 0.5) / f64::from(side);
        let sum: f64 = (0..side * side).map(|i| estimate([at(i % side), at(i / side)])).sum();
        let e = sum / f64::from(side * side);
        // Below 1e-7 rounding is more than the bound.
        most = most.max((e / point(r) - 1.0).abs() / f64::max((r / d).powi(2), 1e-14));
    }
    row.at_most(
        "spheres of radius 0.9 to 1e-8 and the power of a point: |E/E of the point − 1| over (r/d)² (or 1e-14)",
        most,
        1.0,
    );
}

#[test]
fn h28_lights_without_light() {
    row("H28", |row| {
        let dir = folder();
        write_exr(&dir.path().join("black.exr"), 16, 8, |_, _| [0.0; 3]);
        std::fs::write(dir.path().join("line.obj"), "v 0 1 0\nv 1 1 0\nv 0 2 0\nv 1 2 0\nf 1 2 2\nf 1 2 3\n")
            .expect("the folder is writable");
        let (mut lit, mut dropped, mut passes, mut scenes) = (0, 0, 0, 0);
        let mut look = |lights: &str, object: &str| {
            // A ball of glass, so that photons would be made of what there is.
            let more = format!(
                r#""glass": (transmission: 1), "glow": (emission: 1)|(shape: sphere(radius: 0.1, center: (0, 0.5, 0)), material: "glass"), {object}"#
            );
            let picture = focused(floor(lights, &more)).folder(dir.path()).passes(8).render();
            lit += picture.grey().iter().filter(|x| **x != 0.0).count() as u64;
            dropped += picture.rendered.stats.rare_events.iter().map(|event| event.count).sum::<u64>();
            passes += u64::from(picture.rendered.stats.photons.photons.is_some());
            scenes += 1;
        };
        for lights in [
            "",
            r#""a": point(position: (0, 1, 0), intensity: 0)"#,
            r#""a": spot(position: (0, 1, 0), target: (0, 0, 0), intensity: 0)"#,
            r#""a": directional(direction: (0, -1, 0), irradiance: 0)"#,
            r#""a": sphere(center: (0, 1, 0), radius: 0.1, radiance: 0)"#,
            r#""a": environment(map: constant(0))"#,
            r#""a": environment(map: constant(1), scale: 0)"#,
            r#""a": environment(map: gradient(zenith: 0, horizon: 0, nadir: 0))"#,
            r#""a": environment(map: image(path: "black.exr"))"#,
            r#""a": quad(corner: (0, 1, 0), edge_u: (1, 0, 0), edge_v: (0, 0, 1), radiance: 0)"#,
            r#""a": disk(center: (0, 1, 0), normal: (0, -1, 0), radius: 0.1, radiance: 0)"#,
        ] {
            look(lights, "");
        }
        // Its area is below all numbers.
        look(
            "",
            r#"(shape: mesh(path: "line.obj"), material: "glow", transform: [scale(1e-90), translate((0, 1, 0))])"#,
        );
        row.none("pixels that are not exactly black, in scenes of no light or black ones", lit, 4 * scenes);
        row.is("samples or photons dropped in them", dropped as f64, 0.0, 0.0);
        row.is("scenes of them with a photon stage", passes as f64, 0.0, 0.0);
        let lamp = r#""b": point(position: (0, 1, 0), intensity: 1)"#;
        let view = |more: &str| {
            let lights = format!("{lamp}, {more}");
            shot(floor(&lights, "")).folder(dir.path()).passes(8).render()
        };
        let (alone, under) = (view(""), view(r#""a": environment(map: image(path: "black.exr"))"#));
        row.holds(
            "a lamp under a black sky lights the floor as it does alone, to the bit",
            alone.mean() > 0.1 && alone.bits() == under.bits(),
        );
        let more = r#""glow": (emission: 1)|(shape: mesh(path: "line.obj"), material: "glow", transform: [translate((0, 0, 9))])"#;
        let picture = shot(floor("", more)).folder(dir.path()).passes(8).render();
        row.holds("a lamp of one triangle without area and one with it renders", picture.is_sound());
    });
}
