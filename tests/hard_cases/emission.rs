//! Photons on their way: directions, which of them are stored, and an account of their power.

use super::record::{Record, row, sized};
use crate::photons::directions::{Judged, judge, judge_places, lamp_in_a_sphere};
use crate::photons::lab::{Lab, estimate, lab, lab_in};
use crate::photons::ledger::medley;
use crate::render::caustics::absent;
use crate::render::shot::focused;
use std::f64::consts::PI;
use std::path::Path;
use terrarium::math::sampling::SphericalCell;
use terrarium::math::{DVec2, DVec3, Frame};
use terrarium::scatter::{Aim, Photons, Scattered, Store};

const POINT: &str = r#""a": point(position: (0, 0, 0), intensity: 3)"#;
const SPHERE: &str = r#""a": sphere(center: (0, 0, 0), radius: 0.5, radiance: 3)"#;
const DISK: &str = r#""a": disk(center: (0, 0, 0), normal: (1, 2, 2), radius: 0.5, radiance: 2)"#;

#[test]
fn s02_photon_directions() {
    row("S2", |row| {
        let scene = lamp_in_a_sphere(POINT);
        // The icosahedron whose corners the course project's photons avoided or sought.
        let faces = SphericalCell::icosahedron();
        let middles: Vec<DVec3> =
            faces.iter().map(|f| f.corners().iter().sum::<DVec3>().normalize()).collect();
        let mut corners: Vec<DVec3> = Vec::new();
        for corner in faces.iter().flat_map(SphericalCell::corners) {
            if corners.iter().all(|c| c.distance(corner) > 1e-6) {
                corners.push(corner);
            }
        }
        assert_eq!(corners.len(), 12, "an icosahedron has twelve corners");
        let photons = sized(400_000, 4_000_000);
        let pass = &scene.passes(Store::Direct, Aim::Scene, 1, photons)[0];
        // Within 10° of each, by share of the solid angle.
        let near = libm::cos(10f64.to_radians());
        let density = |places: &[DVec3]| {
            let within = |d: DVec3| places.iter().filter(|p| p.dot(d) > near).count() as f64;
            let sum: f64 = pass.photons.iter().map(|p| f64::from(p.power.x) * within(-p.wi.as_dvec3())).sum();
            sum / (places.len() as f64 * 2.0 * PI * (1.0 - near) * 3.0)
        };
        let (corner, middle) = (density(&corners), density(&middles));
        row.is(
            "density towards an icosahedron's corners over that towards its faces' middles",
            corner / middle,
            1.0,
            sized(0.02, 5e-3),
        );
        row.is("density towards the corners over an even one", corner, 1.0, sized(0.02, 5e-3));
        for (halvings, ratio) in laid_over(&pass.photons).into_iter().enumerate() {
            // Of N independent photons a sixteenth is known to 4/√N, and sixteen of them span 3.5 times that.
            let bound = 1.0 + 4.0 * 4.0 / (pass.photons.len() as f64).sqrt();
            let what = format!(
                "faces of the icosahedron, {halvings} times halved, laid over each other: their fullest sixteenth over their emptiest"
            );
            row.at_most(&what, ratio, bound);
        }
        for n in [sized(20_000, 20_000), sized(320_000, 4_000_000)] {
            let Judged { ratio, .. } = judge(&scene, n, |_| 3.0);
            // Of independent photons a cell is known to σ = √(320/n), and 320 of them span 5.8 σ.
            let bound = 1.0 + 3.0 * (320.0 / n as f64).sqrt();
            row.at_most(
                &format!("the fullest over the emptiest of 320 equal cells, {n} photons"),
                ratio,
                bound,
            );
        }
    });
}

/// The faces of the icosahedron, halved none to three times, and each of these cells in sixteen equal parts: the power in
/// the fullest of the sixteen over that in the emptiest, each summed over all cells.
fn laid_over(photons: &Photons) -> [f64; 4] {
    let planes = |cells: &[SphericalCell], step| -> Vec<[DVec3; 3]> {
        cells.iter().step_by(step).map(SphericalCell::planes).collect()
    };
    let mut cells = SphericalCell::icosahedron().to_vec();
    let faces = planes(&cells, 1);
    // Cells 2i and 2i + 1 of a level are the halves of cell i of the level before.
    let firsts = [(); 7].map(|()| {
        cells = cells.iter().flat_map(SphericalCell::halves).collect();
        planes(&cells, 2)
    });
    let within = |planes: &[DVec3; 3], dir: DVec3| planes.iter().all(|n| n.dot(dir) >= 0.0);
    let mut parts = [[0.0f64; 16]; 4];
    for photon in photons.iter() {
        let dir = -photon.wi.as_dvec3();
        // On an edge to the last bit it may be in none.
        let mut cell = faces.iter().position(|face| within(face, dir)).unwrap_or(0);
        for (level, first) in firsts.iter().enumerate() {
            cell = 2 * cell + usize::from(!within(&first[cell], dir));
            if level >= 3 {
                parts[level - 3][cell % 16] += f64::from(photon.power.x);
            }
        }
    }
    parts.map(|of| {
        of.iter().fold(0.0, |a: f64, b| a.max(*b)) / of.iter().fold(f64::INFINITY, |a, b| a.min(*b))
    })
}

#[test]
fn h51_emission_is_uniform() {
    row("H51", |row| {
        let n = sized(150_000, 2_000_000);
        let tilted = DVec3::new(1.0, 2.0, 2.0) / 3.0;
        type Intensity = Box<dyn Fn(DVec3) -> f64>;
        let lamps: [(&str, &str, Intensity); 3] = [
            ("point, even", POINT, Box::new(|_| 3.0)),
            ("sphere, even", SPHERE, Box::new(|_| 3.0 * PI * 0.25)),
            ("disk, cosine", DISK, Box::new(move |d| 2.0 * PI * 0.25 * d.dot(tilted).max(0.0))),
        ];
        for (name, light, intensity) in lamps {
            let judged = judge(&lamp_in_a_sphere(light), n, intensity);
            row.at_most(
                &format!("{name}: χ² over 320 cells of {n} photons (p = 1e-3)"),
                judged.chi2,
                judged.limit,
            );
            row.at_most("its first moment less the exact one, as a share of the power", judged.moment, 5e-3);
        }
        places(row, n);
    });
}

/// Where on the lamps they start: even over what is seen of a sphere along a direction, and over a disk.
fn places(row: &mut Record, n: u64) {
    let flat = |frame: Frame, p: DVec3| DVec2::new(p.dot(frame.s), p.dot(frame.t)) / 0.5;
    let normal = DVec3::new(1.0, 2.0, 2.0) / 3.0;
    let sphere = lamp_in_a_sphere(SPHERE);
    let disk = lamp_in_a_sphere(DISK);
    for (name, (chi2, limit)) in [
        ("a sphere along each direction", judge_places(&sphere, n, |p, dir| flat(Frame::around(dir), p))),
        (
            "a disk",
            judge_places(&disk, n, |p, dir| {
                flat(Frame::around(normal), p - dir * (p.dot(normal) / dir.dot(normal)))
            }),
        ),
    ] {
        let what = format!("χ² over 64 equal parts of {name}, where {n} photons start (p = 1e-3)");
        row.at_most(&what, chi2, limit);
    }
}

#[test]
fn s03_direct_light_counts_once() {
    row("S3", |row| {
        let ball = r#"(shape: sphere(center: (0, 0.5, 0), radius: 0.5), material: "white")"#;
        let picture = absent::scene("progressive()", "", absent::LAMPS, ball).render();
        let (lit, values) = absent::photon_layers(&picture);
        row.none(
            "values of the caustic and photon layers that are not +0, four lamps and no glass",
            lit,
            values,
        );
        row.holds("no photon stage has run", picture.rendered.stats.photons.photons.is_none());
        row.is("bytes held for photons", picture.rendered.stats.memory.photons_bytes as f64, 0.0, 0.0);
        let floor = r#"(shape: quad(size: (8, 8)), material: "white")"#;
        let unaimed =
            lab("", absent::LAMPS, floor).passes(Store::Caustics, Aim::Scene, 1, sized(10_000, 1_000_000));
        row.none(
            "photons stored of those sent all over such a scene",
            unaimed[0].photons.len() as u64,
            unaimed[0].emitted,
        );
    });
}

#[test]
fn s05_roulette_keeps_power() {
    row("S5", |row| {
        let passes = medley().caustics(64, sized(4_000, 100_000));
        let share = estimate(passes.iter().map(|p| p.ledger.roulette.x / p.ledger.emitted.x));
        row.is("power that roulette takes, as a share (3σ)", share.mean, 0.0, 3.0 * share.error);
        row.at_most("σ of that", share.error, 0.01);
        tint(row);
    });
}

/// A tinted mirror turns sunlight into its own colours and nothing else.
fn tint(row: &mut Record) {
    let lab = lab(
        r#""tinted": (reflection: (0.5, 0.25, 1), diffuse: 0)"#,
        r#""sun": directional(direction: (0, -1, 0), irradiance: 2)"#,
        r#"(shape: quad(size: (1, 1)), material: "tinted", transform: [rotate(axis: (0, 0, 1), deg: 45)]),
           (shape: quad(size: (4, 4)), material: "white", transform: [rotate(axis: (0, 0, 1), deg: 90), translate((3, 0, 0))]),
           (shape: quad(size: (4, 4)), material: "white", transform: [rotate(axis: (0, 0, 1), deg: 90), translate((-3, 0, 0))])"#,
    );
    let passes = lab.caustics(32, sized(2_000, 50_000));
    for (channel, share) in [0.5, 0.25, 1.0].into_iter().enumerate() {
        let sum = |pass: &Scattered| pass.photons.iter().map(|p| f64::from(p.power[channel])).sum::<f64>();
        let found = estimate(passes.iter().map(sum));
        let expected = 2.0 * 0.5f64.sqrt() * share;
        let what = format!("watts by a mirror of {share} in one channel: that part of what falls on it (3σ)");
        row.is(&what, found.mean, expected, 3.0 * found.error + 1e-5);
        assert!(found.error < 0.01 * expected, "{found:?}");
    }
}

#[test]
fn h34_power_ledger() {
    row("H34", |row| {
        let lab: Lab = medley();
        let passes = lab.caustics(3, sized(40_000, 3_000_000));
        let (mut imbalance, mut cut, mut single, mut wrong) = (0.0f64, 0.0f64, 0.0f64, 0);
        for pass in &passes {
            let l = &pass.ledger;
            let out = l.stored + l.absorbed + l.escaped + l.cut + l.roulette;
            let off = (out - l.emitted - l.bent).abs().max_element() / l.emitted.max_element();
            imbalance = imbalance.max(off).max(l.imbalance());
            cut = cut.max(l.cut.max_element() / l.emitted.max_element());
            for (light, emitter) in pass.by_light.iter().zip(&lab.world.emitters) {
                imbalance = imbalance.max(light.imbalance());
                assert!(light.photons > 0, "{} sends none", emitter.name);
            }
            let arrived: DVec3 = pass.photons.iter().map(|p| p.power.as_dvec3()).sum();
            single = single.max((arrived / l.arrived - 1.0).abs().max_element());
            wrong += u64::from(l.photons != pass.photons.len() as u64);
            for p in pass.photons.iter() {
                let sound = p.wi.dot(p.normal) > 0.0 && (p.wi.length() - 1.0).abs() < 1e-6;
                wrong += u64::from(!(sound && p.power.min_element() >= 0.0));
            }
        }
        let photons: u64 = passes.iter().map(|p| p.ledger.photons).sum();
        row.at_most(
            "emitted less stored, absorbed, escaped, cut and by roulette: the share, of all and of each lamp",
            imbalance,
            1e-12,
        );
        row.at_most("photons' own power added up, off the ledger's as a share", single, 1e-5);
        row.at_most("the share cut at the depth limit", cut, 1e-3);
        cut_off(row);
        row.none("photons that come from behind, are no unit, or not counted", wrong, photons);
    });
}

/// Sun between two mirrors that face each other, aslant: half of it goes on for ever, and is cut.
fn cut_off(row: &mut Record) {
    let mirrors = r#"(shape: quad(size: (9, 9)), material: "mirror", transform: [translate((0, -1, 0))]),
        (shape: quad(size: (9, 9)), material: "mirror", transform: [translate((0, 1, 0))]),
        (shape: quad(size: (1, 1)), material: "white", transform: [translate((0, 4, 0))])"#;
    let lamp = r#""lamp": point(position: (0, 0, 0), intensity: 1)"#;
    let lab = lab_in(Path::new(""), "render: (max_depth: 5),", "", lamp, mirrors);
    let passes = lab.caustics(3, sized(20_000, 1_000_000));
    let (mut imbalance, mut cut) = (0.0f64, f64::INFINITY);
    for pass in &passes {
        imbalance = imbalance.max(pass.ledger.imbalance());
        cut = cut.min(pass.ledger.cut.x / pass.ledger.emitted.x);
    }
    row.at_least("a lamp between two mirrors, 5 reflections at most: the share cut", cut, 0.1);
    row.at_most("emitted less all the rest there, as a share", imbalance, 1e-12);
    let picture = focused(format!(
        r#"(camera: (eye: (3, 0.5, 0), target: (0, 0, 0)), image: (width: 8, height: 8), render: (max_depth: 5),
        materials: {{ "white": (diffuse: 1), "mirror": (reflection: 1) }}, lights: {{ {lamp} }}, objects: [{mirrors}])"#
    ))
    .passes(2)
    .render();
    let told = picture.rendered.warnings.iter().find(|w| w.contains("photons' power")).cloned();
    row.says("what is said of it", &told.unwrap_or_default(), "of the photons' power was cut off after 5");
}
