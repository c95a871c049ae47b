//! Single interfaces: Fresnel's and Snell's laws at their ends.

use super::proofs::prove;
use super::record::{Record, row, sized};
use crate::plan::lab::{LAMP, own_plan, render, scene};
use crate::render::caustics::absent;
use crate::render::glass::fresnel;
use crate::render::materials::plane;
use crate::render::shot::focused;
use std::path::Path;
use terrarium::description::{Format, load_str};
use terrarium::optics::Interface;
use terrarium::plan::{Effect, Overrides};

/// The transmitted power by Fresnel's amplitudes, independent of the reflected.
fn transmittance(cos_i: f64, cos_t: f64, eta: f64) -> f64 {
    let (s, p) = (cos_i + eta * cos_t, eta * cos_i + cos_t);
    2.0 * eta * cos_i * cos_t * (1.0 / (s * s) + 1.0 / (p * p))
}

const GRAZING: [f64; 6] = [f64::MIN_POSITIVE / 4.0, f64::MIN_POSITIVE, 1e-300, 1e-20, 1e-8, 1e-3];

#[test]
fn h12_grazing_incidence() {
    row("H12", |row| {
        let (mut wrong, mut tried, mut at_zero, mut unit) = (0, 0, 0.0f64, 0.0f64);
        for eta in [1.5, 1.0 / 1.5, 1.333, 2.417, 0.05, 10.0] {
            at_zero = at_zero.max((Interface::new(0.0, eta).reflectance - 1.0).abs());
            let mut last = 1.0;
            for cos in GRAZING {
                let f = Interface::new(cos, eta);
                let sound = (0.0..=1.0).contains(&f.reflectance) && f.cos_t.is_finite();
                wrong += u64::from(!sound || f.reflectance > last);
                tried += 1;
                last = f.reflectance;
                let t = if f.cos_t > 0.0 { transmittance(cos, f.cos_t, eta) } else { 0.0 };
                unit = unit.max((f.reflectance + t - 1.0).abs());
            }
        }
        row.is("|F − 1| at cosθ = 0, six indices", at_zero, 0.0, 0.0);
        row.none(
            "cosines down to a denormal at which F is no share, or does not rise towards grazing",
            wrong,
            tried,
        );
        row.at_most("|F + T − 1|, T from its own amplitudes", unit, 1e-7);
    });
}

#[test]
fn h13_critical_angle() {
    row("H13", |row| {
        let at = |degrees: f64| Interface::new(libm::cos(degrees.to_radians()), 1.5).reflectance;
        row.is("F(0°), n = 1.5", at(0.0), 0.04, 1e-15);
        row.is("F(60°)", at(60.0), 0.089_186_7, 1e-7);
        row.is("F at Brewster's angle, 56.3099°", at(56.309_932_474), 0.073_964_5, 1e-7);
        let critical = libm::asin(1.0 / 1.5);
        row.is("the critical angle, degrees", critical.to_degrees(), 41.810_314_9, 1e-7);
        let inside = |angle: f64| Interface::new(libm::cos(angle), 1.0 / 1.5).reflectance;
        row.is("F 1e-9 rad below it, from inside", inside(critical - 1e-9), 0.999_725, 1e-6);
        row.is("F 1e-9 rad above it", inside(critical + 1e-9), 1.0, 0.0);
        let mut cos = (0..64).fold(libm::cos(critical), |cos, _| cos.next_down());
        let mut wrong = 0;
        for _ in 0..128 {
            let f = Interface::new(cos, 1.0 / 1.5);
            wrong += u64::from(!((0.999..=1.0).contains(&f.reflectance) && f.cos_t >= 0.0));
            cos = cos.next_up();
        }
        row.none("cosines within 64 units in the last place of it that give no number", wrong, 128);
        prove(row, "brewster");
        for (deg, expected) in [(0.0, 0.04), (60.0, 0.089_186_7)] {
            // One event only: what is reflected at the front; the inside ends in the depth limit.
            let angle = f64::to_radians(deg);
            let eye = format!("({}, {}, 0)", 3.0 * angle.sin(), 3.0 * angle.cos() + 1e-9);
            let found =
                plane("transmission: 1, ior: 1.5", "", "render: (max_depth: 1), background: 1,", &eye);
            row.is_close(&format!("a sky of radiance 1 seen in glass under {deg}°"), found, expected, 1e-5);
        }
    });
}

#[test]
fn h14_index_of_the_surroundings() {
    row("H14", |row| {
        let air = r#""air": (transmission: 1, ior: 1)"#;
        let (mut differ, mut values) = (0, 0);
        for shape in ["sphere(radius: 0.5, center: (0, 0.6, 0))", "box(center: (0, 0.5, 0))", "cylinder()"] {
            let ball = format!(r#"(shape: {shape}, material: "air")"#);
            let with = render(&scene("", air, LAMP, &ball), &Overrides::default());
            let none = render(&scene("", air, LAMP, ""), &Overrides::default());
            differ += with.bits().iter().zip(none.bits()).filter(|(a, b)| **a != *b).count() as u64;
            values += none.bits().len() as u64;
        }
        row.none("values that glass of index 1 changes in a picture with its shadows", differ, values);
        let ball = r#"(shape: sphere(center: (0, 0.5, 0), radius: 0.5), material: "air")"#;
        let with = absent::scene("progressive()", air, absent::LAMPS, ball).render();
        let none = absent::scene("progressive()", air, absent::LAMPS, "").render();
        row.holds("photons are not made, whatever the lamps", with.rendered.stats.photons.photons.is_none());
        row.holds(
            "the picture by four kinds of lamp and indirect light is the same to the bit",
            with.bits() == none.bits(),
        );
        let plan = own_plan(&scene("", air, LAMP, ball));
        row.holds("the plan has caustics off", !plan.is_on(Effect::Caustics));
        let reason = plan.decisions.iter().find(|d| d.effect == Effect::Refraction).map(ToString::to_string);
        row.says("the plan's word on refraction", &reason.unwrap_or_default(), "off");
        prove(row, "glass-of-air");
        drop_in_water(row);
        shadow_in_water(row);
    });
}

/// What the camera sees through a drop of water in water is the same to rounding.
fn drop_in_water(row: &mut Record) {
    let water =
        r#""water": (transmission: 1, ior: 1.333), "drop": (transmission: 1, ior: 1.333, priority: -1)"#;
    let pool =
        r#"(shape: box(size: (1.6, 1, 1.6)), material: "water", transform: [translate((0, 0.51, 0))])"#;
    let drop = r#", (shape: sphere(radius: 0.3, center: (0, 0.5, 0)), material: "drop")"#;
    let text = |objects: &str| scene("antialiasing: none, photons: off,", water, LAMP, objects);
    let with = render(&text(&format!("{pool}{drop}")), &Overrides::default());
    let none = render(&text(pool), &Overrides::default());
    let brightest = none.grey().into_iter().fold(0.0, f64::max);
    let pairs: Vec<(f64, f64)> = with.grey().into_iter().zip(none.grey()).collect();
    // Branches lighter than 1/256 survive by chance, and not by the same.
    let far = pairs.iter().filter(|(a, b)| (a - b).abs() > 1e-5 * b + brightest / 128.0).count() as u64;
    let same = pairs.iter().filter(|(a, b)| (a - b).abs() <= 1e-5 * b).count() as u64;
    row.none(
        "pixels that a drop of water in water changes by more than a light branch",
        far,
        pairs.len() as u64,
    );
    row.share("pixels that it leaves the same to 1e-5", same, pairs.len() as u64, 0.9);
}

/// Lamp, drop and floor under water: what the drop keeps from shadow rays photons bring, and no light is lost.
fn shadow_in_water(row: &mut Record) {
    let scene = |drop: &str| {
        focused(format!(
            r#"(camera: (eye: (1.2, 2, 0), target: (0, 0, 0), fov_deg: 30), image: (width: 16, height: 16), photons: progressive(count: 40000),
            materials: {{ "white": (diffuse: 0.8), "water": (transmission: 1, ior: 1.333), "drop": (transmission: 1, ior: 1.333, priority: -1) }},
            lights: {{ "lamp": sphere(center: (0, 2, 0), radius: 0.1, radiance: 30) }},
            objects: [(shape: quad(size: (3, 3)), material: "white"), (shape: box(size: (40, 40, 40)), material: "water"){drop}])"#
        ))
        .passes(sized(16, 256))
        .render()
    };
    let drop = r#", (shape: sphere(radius: 0.4, center: (0, 1, 0)), material: "drop")"#;
    let (with, none) = (scene(drop), scene(""));
    row.is_close(
        "a floor under water below such a drop, over that floor without it",
        with.mean() / none.mean(),
        1.0,
        5e-3,
    );
}

#[test]
fn h15_indices_below_one() {
    row("H15", |row| {
        let mut off = 0.0f64;
        let mut angles = 0;
        for eta in [1.5, 1.333, 2.4] {
            for i in 0..sized(900, 90_000) {
                let cos_i = libm::cos((f64::from(i) / f64::from(sized(10, 1_000))).to_radians());
                let outside = Interface::new(cos_i, eta);
                let inside = Interface::new(outside.cos_t, 1.0 / eta);
                // Towards grazing a rounding of the cosine is more and more of it.
                off = off.max((outside.reflectance - inside.reflectance).abs() * cos_i);
                angles += 1;
            }
        }
        row.at_most(
            &format!("F from inside (index 1/n) less F from outside, times cosθ, at {angles} angles"),
            off,
            1e-14,
        );
        let bubble = plane(
            "transmission: 1, ior: 0.6666666666666667",
            "",
            "render: (max_depth: 1), background: 1,",
            "(0, 3, 0.000001)",
        );
        row.is_close("a sky of radiance 1 seen in a box of index 1/1.5, head on", bubble, 0.04, 1e-5);
        for deg in [30.0, 41.0, 42.0, 60.0] {
            let (sin, cos) = f64::to_radians(deg).sin_cos();
            let found = plane(
                "transmission: 1, ior: 0.6666666666666667",
                "",
                "render: (max_depth: 1), background: 1,",
                &format!("({}, {}, 0)", 3.0 * sin, 3.0 * cos),
            );
            let what = format!("the same under {deg}° (all of it from 41.81° on)");
            row.is_close(&what, found, fresnel(cos, 1.0 / 1.5), 1e-4);
        }
        for bad in ["0", "-1.5", "10", "11", "0.05", "NaN", "inf", "1e999"] {
            let scene = format!(
                "(camera: (eye: (0, 0, 5), target: (0, 0, 0)),\nmaterials: {{ \"m\": (transmission: 1, ior: {bad}) }})"
            );
            let report = load_str(&scene, Format::Ron, Path::new(""), &[]).err();
            let said = report.and_then(|r| {
                let headline = r.errors().next().map(|error| error.headline())?;
                Some(format!("code {}, {headline}", r.exit_code()))
            });
            let place = "code 2, <input>:2:42: error: materials.m.ior";
            row.says(&format!("what is said of the index {bad}"), &said.unwrap_or_default(), place);
        }
    });
}
