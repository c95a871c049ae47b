//! Glass against water, glass in glass, eyes inside, open and hollow glass.

use super::proofs::prove;
use super::record::{Record, row, sized};
use crate::render::glass::{AROUND, GLASS, Ruler, fresnel, furnace, ray, unevenness};
use crate::render::media;
use crate::render::meshes::{folder, icosphere};
use crate::render::shot::shot;
use std::path::Path;
use terrarium::math::DVec3;

#[test]
fn h17_glass_against_water() {
    row("H17", |row| {
        three_ways(row);
        prove(row, "glass-on-water");
        reflectance(row);
        no_speckle(row);
    });
}

/// A ray through air, water, glass and air again, whichever way the two are built.
fn three_ways(row: &mut Record) {
    let ruler = Ruler::new(3.0);
    let angle = 40f64.to_radians();
    let dir = DVec3::new(angle.cos(), angle.sin(), 0.0);
    let sin_w = angle.sin() / 1.33;
    let sin_g = angle.sin() / 1.5;
    let tan = |s: f64| s / (1.0 - s * s).sqrt();
    for (name, water, depth, gap) in [
        ("coincident", "box(size: (1, 50, 50), center: (-0.5, 0, 0))", 3, 0.0),
        ("overlapping", "box(size: (1.2, 50, 50), center: (-0.4, 0, 0))", 4, 0.0),
        ("1 mm apart", "box(size: (1, 50, 50), center: (-0.501, 0, 0))", 4, 1e-3),
    ] {
        let materials =
            r#""glass": (transmission: 1, ior: 1.5, priority: 1), "water": (transmission: 1, ior: 1.33)"#;
        let objects = format!(
            r#"(shape: {water}, material: "water"), (shape: box(size: (0.5, 50, 50), center: (0.25, 0, 0)), material: "glass")"#
        );
        let eye = DVec3::new(-2.0, -2.0, 0.0);
        let (y, weight) = ruler.measure(eye, dir, depth, materials, &objects);
        let expected = -2.0
            + (1.0 - gap) * tan(angle.sin())
            + tan(sin_w)
            + gap * tan(angle.sin())
            + 0.5 * tan(sin_g)
            + 2.5 * tan(angle.sin());
        row.is(&format!("where a ray ends behind water on glass, {name}, by sinθ/n, m"), y, expected, 4e-6);
        let cos_w = (1.0 - sin_w * sin_w).sqrt();
        let cos_g = (1.0 - sin_g * sin_g).sqrt();
        if gap == 0.0 {
            let t = (1.0 - fresnel(angle.cos(), 1.33))
                * (1.0 - fresnel(cos_w, 1.5 / 1.33))
                * (1.0 - fresnel(cos_g, 1.0 / 1.5));
            row.is_close(&format!("what of it arrives, {name}"), weight, t, 1e-5);
        }
    }
}

/// Looked at from within the water, the bottom reflects ((1.5 − 1.33)/(1.5 + 1.33))².
fn reflectance(row: &mut Record) {
    let up = DVec3::new(0.0, 0.25, 0.0);
    let seeds = sized(400, 6_400);
    let scenes = [
        (
            "coincident",
            "box(size: (4, 1, 4), center: (0, -0.5, 0))",
            "box(size: (4, 1, 4), center: (0, 0.5, 0))",
            0,
        ),
        (
            "overlapping",
            "box(size: (4, 1, 4), center: (0, -0.5, 0))",
            "box(size: (4, 1.3, 4), center: (0, 0.35, 0))",
            1,
        ),
        (
            "1 cm within",
            "box(size: (4, 1, 4), center: (0, -0.5, 0))",
            "box(size: (4, 1.01, 4), center: (0, 0.495, 0))",
            5,
        ),
        ("cylinders", "cylinder(radius: 3, height: 1)", "cylinder(radius: 3, height: 1)", 0),
    ];
    for (name, glass, water, priority) in scenes {
        let lift = if name == "cylinders" { "translate((0, -1, 0))" } else { "translate((0, 0, 0))" };
        let rest = format!(
            r#"materials: {{ "glow": (emission: 1), "glass": (transmission: 1, ior: 1.5, priority: {priority}), "water": (transmission: 1, ior: 1.33) }},
            objects: [(shape: {glass}, material: "glass", transform: [{lift}]), (shape: {water}, material: "water"),
            (shape: quad(size: (0.4, 0.4)), material: "glow", transform: [translate((0, 0.6, 0))])]"#
        );
        // One reflection is as far as the path may go; so light a branch survives by chance, hence many seeds.
        let shot = shot(ray(up, DVec3::new(0.0, 0.24, 0.0), 1, &rest));
        let mean = (0..seeds).map(|seed| shot.clone().seed(seed).render().mean()).sum::<f64>() / seeds as f64;
        // It survives with probability 256 F = 0.92: 4 standard errors.
        let error = 4.0 * 0.3 / (seeds as f64).sqrt();
        row.is_close(&format!("F at 0° from water to glass, {name}"), mean, 0.003_608_5, error);
    }
}

fn no_speckle(row: &mut Record) {
    let cup = r#"(shape: cylinder(radius: 0.8, height: 1), material: "glass")"#;
    let (mut mean, mut pixel) = (0.0f64, 0.0f64);
    for water in [
        r#"(shape: cylinder(radius: 0.6, height: 0.7), material: "water")"#,
        r#"(shape: cylinder(radius: 0.6, height: 0.7), material: "water", transform: [translate((0, 0.3, 0))])"#,
        r#"(shape: cylinder(radius: 0.8, height: 0.5), material: "water", transform: [translate((0, 1, 0))])"#,
        r#"(shape: box(center: (1.3, 0.5, 0)), material: "water"), (shape: box(center: (2.3, 0.5, 0)), material: "glass")"#,
        r#"(shape: sphere(radius: 0.7, center: (0.5, 1, 0)), material: "water")"#,
        r#"(shape: cylinder(radius: 0.8, height: 1), material: "water")"#,
    ] {
        let picture = furnace(Path::new(""), AROUND, GLASS, &format!("{cup}, {water}"), sized(64, 256));
        let (of_mean, of_each) = unevenness(&picture, 1.0);
        (mean, pixel) = (mean.max(of_mean), pixel.max(of_each));
    }
    row.at_most("six cups and pools in an even sky: mean off 1", mean, 2e-3);
    row.at_most("the worst pixel off 1", pixel, sized(0.1, 0.05));
}

#[test]
fn h18_eye_inside_glass() {
    row("H18", |row| {
        let passes = sized(16, 256);
        let off =
            |row: &mut Record, what: &str, camera: &str, materials: &str, objects: &str, expected: f64| {
                let picture = furnace(Path::new(""), camera, materials, objects, passes);
                row.is_close(what, picture.mean(), expected, 3e-3);
                row.at_most("its worst pixel off that", unevenness(&picture, expected).1, sized(0.3, 0.1));
            };
        prove(row, "eye-in-glass");
        lens(row, passes);
        let ball = r#"(shape: sphere(), material: "glass")"#;
        let camera = "(eye: (0, 0, 0), target: (0, 0.2, 1), fov_deg: 60)";
        off(row, "a sky of 1 seen from outside through a ball of glass", AROUND, GLASS, ball, 1.0);
        let bubble = r#"(shape: sphere(), material: "glass"), (shape: sphere(radius: 0.3), material: "air")"#;
        let materials =
            r#""glass": (transmission: 1, ior: 1.5), "air": (transmission: 1, ior: 1, priority: 1)"#;
        off(row, "from within a bubble of air in it", camera, materials, bubble, 1.0);
        let beside = "(eye: (0.1, 0.6, 0), target: (0.2, 2, 0), fov_deg: 20)";
        off(row, "from the glass beside the bubble", beside, materials, bubble, 2.25);
    });
}

/// A lens half in glass: rays that begin inside see a sky of 2.25, the others one of 1.
fn lens(row: &mut Record, passes: u32) {
    let cube = r#"(shape: box(size: (4, 1, 4)), material: "glass")"#;
    let mean = |y: f64| {
        let camera =
            format!("(eye: (0, {y}, 0), target: (0, {y}, -1), fov_deg: 4, aperture_m: 0.2, focus_m: 1)");
        furnace(Path::new(""), &camera, GLASS, cube, passes).mean()
    };
    row.is(
        "a lens half in glass, n = 1.5, in a sky of 1: half of 2.25 and half of 1",
        mean(0.5),
        1.625,
        0.02,
    );
    row.is("one that is just outside", mean(0.6000001), 1.0, 3e-3);
    row.is("one that is just inside", mean(0.3999999), 2.25, 3e-3 * 2.25);
}

#[test]
fn h19_open_and_hollow_glass() {
    row("H19", |row| {
        let dir = folder();
        let mut open = icosphere(1);
        open.faces.truncate(60);
        open.write(&dir.path().join("open.obj"));
        let shapes =
            ["quad()", "disk()", "cone(caps: false)", "cylinder(caps: false)", r#"mesh(path: "open.obj")"#];
        let (mut unsound, mut silent, mut brightest, mut overflows) = (0, 0, 0.0f64, 0);
        for shape in shapes {
            let object = format!(r#"(shape: {shape}, material: "glass")"#);
            let picture = furnace(dir.path(), AROUND, GLASS, &object, 16);
            unsound += u64::from(!picture.is_sound());
            brightest = picture.grey().into_iter().fold(brightest, f64::max);
            // of a shape the scene tells, of a mesh its file
            let scene = format!("(camera: {AROUND}, materials: {{ {GLASS} }}, objects: [{object}])");
            let doubts = shot(scene).folder(dir.path()).load().warnings;
            let told = doubts.iter().any(|w| w.message.contains("this shape has no inside"))
                || picture.rendered.warnings.iter().any(|w| w.contains("is not closed"));
            silent += u64::from(!told);
            overflows += picture.rendered.stats.rare_events[1].count;
        }
        let n = shapes.len() as u64;
        row.none("open shapes of glass in an even sky that give no sound picture", unsound, n);
        row.none("of which no warning says so", silent, n);
        row.at_most("the brightest pixel of them (noise about n² = 2.25 at most)", brightest, 6.0);
        row.is("media that were left without being entered, or are too many", overflows as f64, 0.0, 0.0);
        hollow(row);
    });
}

/// A hollow ball, its inner wall a reversed mesh or a ball of air.
fn hollow(row: &mut Record) {
    let dir = folder();
    icosphere(4).write(&dir.path().join("outer.obj"));
    icosphere(4).scaled(0.8).write(&dir.path().join("inner.obj"));
    icosphere(4).with(icosphere(4).scaled(0.8).reversed()).write(&dir.path().join("hollow.obj"));
    let scene = |objects: &str| {
        let scene = format!(
            r#"(camera: {AROUND}, image: (width: 24, height: 24), antialiasing: grid(2),
            materials: {{ "glass": (transmission: 1), "air": (transmission: 1, ior: 1, priority: 1) }},
            lights: {{ "sky": environment(map: gradient(zenith: 3, horizon: 1, nadir: 0.2)) }}, objects: [{objects}])"#
        );
        shot(scene).folder(dir.path()).passes(sized(16, 128)).render()
    };
    let reversed = scene(r#"(shape: mesh(path: "hollow.obj", smooth: false), material: "glass")"#);
    let air = scene(
        r#"(shape: mesh(path: "outer.obj", smooth: false), material: "glass"), (shape: mesh(path: "inner.obj", smooth: false), material: "air")"#,
    );
    row.is_close(
        "a hollow ball by a reversed wall, its mean: that of a ball of air within",
        reversed.mean(),
        air.mean(),
        2e-3,
    );
    let most = reversed.grey().iter().zip(air.grey()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    row.at_most("the most by which pixels differ, of values up to 3", most, sized(0.12, 0.06));
}

#[test]
fn s10_radiance_across_interfaces() {
    row("S10", |row| {
        let picture =
            furnace(Path::new(""), AROUND, GLASS, r#"(shape: box(), material: "water")"#, sized(16, 256));
        row.is_close(
            "an even sky through closed water, seen from air: the factors cancel",
            picture.mean(),
            1.0,
            3e-3,
        );
        prove(row, "under-water");
        let slab = r#"(shape: box(size: (2, 9, 9)), material: "glass")"#;
        let inked = media::view(0.2, 1, "transmission: 1, ior: 1.5, absorption: 0.7", slab);
        row.is_close(
            "a wall of 1 seen from within ink of n = 1.5 and σ = 0.7/m: n²(1 − F) e^−σd",
            inked,
            2.25 * 0.96 * libm::exp(-0.7 * 0.8),
            1e-5,
        );
        power_through_a_ball(row);
    });
}

/// All around the ball is white: what the lamp sends to the ball arrives on the walls, whole.
fn power_through_a_ball(row: &mut Record) {
    use crate::photons::lab::{lab, power};
    let lab = lab(
        "",
        r#""lamp": point(position: (0, 2.5, 0), intensity: 1)"#,
        r#"(shape: sphere(radius: 8), material: "white"), (shape: sphere(radius: 1), material: "glass")"#,
    );
    let found = power(&lab.caustics(32, sized(4_000, 100_000)), |_| true);
    let cone = 2.0 * std::f64::consts::PI * (1.0 - (1.0f64 - 0.16).sqrt());
    row.is(
        "watts of photons that a ball of glass gets, and gives to the walls (3σ)",
        found.mean,
        cone,
        3.0 * found.error + 1e-6,
    );
    row.at_most("σ of that as a share", found.error / cone, 3e-3);
}
