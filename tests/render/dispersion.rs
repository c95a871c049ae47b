//! Dispersion: what has no colour stays white, prisms bend each colour by Cauchy's law, and eye paths
//! and photons agree about it.
//!
//! A path is of one wavelength after the first interface that disperses. What is expected is a sum
//! over the same wavelengths, with Snell's and Fresnel's laws in the plane.

use super::meshes::{Obj, folder, write_exr};
use super::shot::{Picture, assert_close, focused as shot};
use std::path::Path;
use terrarium::description::{Format, load_str, load_str_as_written, to_string};
use terrarium::math::{DVec2, DVec3};
use terrarium::optics::{Cauchy, Interface, Spectrum};

fn channels(picture: &Picture) -> DVec3 {
    let rgb = picture.rgb();
    rgb.iter().map(|p| DVec3::from(p.map(f64::from))).sum::<DVec3>() / rgb.len() as f64
}

/// Mean and standard error by channel of what several seeds give.
fn over_seeds(seeds: u64, of: impl Fn(u64) -> DVec3) -> (DVec3, DVec3) {
    let found: Vec<DVec3> = (0..seeds).map(of).collect();
    let n = seeds as f64;
    let mean = found.iter().sum::<DVec3>() / n;
    let variance = found.iter().map(|f| (f - mean) * (f - mean)).sum::<DVec3>() / (n - 1.0);
    (mean, DVec3::from((variance / n).to_array().map(f64::sqrt)))
}

#[track_caller]
fn assert_within(what: &str, (mean, error): (DVec3, DVec3), expected: DVec3, relative: f64) {
    println!("{what}: {mean} ± {error}, expected {expected}");
    for c in 0..3 {
        let off = (mean[c] - expected[c]).abs();
        assert!(
            off < 3.0 * error[c] + 1e-6 * expected[c].abs() && off < relative * expected[c].abs(),
            "{what}: channel {c} is {} ± {} instead of {}",
            mean[c],
            error[c],
            expected[c]
        );
    }
}

/// The mean over all wavelengths, by channel, of what `of` gives for an index.
fn over_wavelengths(glass: Cauchy, of: impl Fn(f64) -> f64) -> DVec3 {
    let spectrum = Spectrum::new();
    let n = 20_000;
    let part = |i: u32| {
        let sample = spectrum.sample((f64::from(i) + 0.5) / f64::from(n));
        sample.weight.as_dvec3() * of(glass.ior(Some(sample.um)))
    };
    (0..n).map(part).sum::<DVec3>() / f64::from(n)
}

fn refract(dir: DVec2, normal: DVec2, eta: f64) -> (DVec2, f64) {
    let cos_i = -dir.dot(normal);
    let interface = Interface::new(cos_i, eta);
    let tangent = dir + normal * cos_i;
    (tangent / eta - normal * interface.cos_t, 1.0 - interface.reflectance)
}

/// An upright equilateral prism with edges of `edge` along the x axis, in the plane.
struct Prism {
    corners: [DVec2; 3],
}

impl Prism {
    fn new(edge: f64) -> Prism {
        let h = 0.75f64.sqrt();
        Prism { corners: [[-0.5, 0.0], [0.5, 0.0], [0.0, h]].map(|p| DVec2::from(p) * edge) }
    }

    /// By an angle in radians about a point.
    fn turned(&self, angle: f64, about: DVec2) -> Prism {
        Prism { corners: self.corners.map(|p| about + DVec2::from_angle(angle).rotate(p - about)) }
    }

    /// From z = −`half` to z = `half`.
    fn mesh(&self, half: f64) -> Obj {
        let vertices =
            [-half, half].iter().flat_map(|&z| self.corners.map(|p| p.extend(z))).collect::<Vec<_>>();
        let faces = vec![vec![0, 2, 1], vec![3, 4, 5], vec![0, 1, 4, 3], vec![1, 2, 5, 4], vec![2, 0, 3, 5]];
        Obj { vertices, normals: Vec::new(), faces }
    }

    /// In by the left face at `entry`, out by the right: where on the line x = `wall` a ray ends that
    /// came in the direction `dir`, where it goes, and its transmittance.
    fn through(&self, entry: DVec2, dir: DVec2, ior: f64, wall: f64) -> (f64, DVec2, f64) {
        let [left, right, top] = self.corners;
        let outward = |from: DVec2, to: DVec2| (to - from).perp().normalize();
        let (inside, in_share) = refract(dir, outward(left, top), ior);
        let face = outward(top, right);
        let exit = entry + inside * ((top - entry).dot(face) / inside.dot(face));
        let (out, out_share) = refract(inside, -face, 1.0 / ior);
        (exit.y + out.y / out.x * (wall - exit.x), out, in_share * out_share)
    }
}

const FLINT: &str = r#""flint": (transmission: 1, ior: 1.62, dispersion: abbe(25))"#;

fn flint() -> Cauchy {
    Cauchy::from_abbe(1.62, 25.0)
}

/// Symmetric passage at the d line: half the deviation before, half behind.
fn incidence() -> f64 {
    (1.62f64 * 0.5).asin()
}

#[test]
fn a_dispersive_ball_vanishes_in_an_even_white_glow() {
    let scene = format!(
        r#"(camera: (eye: (0, 0, 5), target: (0, 0, 0), fov_deg: 15), image: (width: 24, height: 24),
        render: (max_depth: 1000), materials: {{ {FLINT} }}, lights: {{ "sky": environment(map: constant(1)) }},
        objects: [(shape: sphere(), material: "flint")])"#
    );
    let found = over_seeds(6, |seed| channels(&shot(&scene).passes(32).seed(seed).render()));
    assert_within("ball", found, DVec3::ONE, 5e-3);
}

/// Behind a pane all colours meet again; seen at a slant as well.
#[test]
fn a_dispersive_pane_vanishes_in_an_even_white_glow() {
    let scene = format!(
        r#"(camera: (eye: (3, 2, 1), target: (0, 0, 0), fov_deg: 3), image: (width: 24, height: 24),
        render: (max_depth: 1000), materials: {{ {FLINT} }}, lights: {{ "sky": environment(map: constant(1)) }},
        objects: [(shape: box(size: (9, 0.1, 9)), material: "flint"), (shape: box(size: (9, 0.1, 9), center: (0, -0.1, 0)), material: "flint")])"#
    );
    let found = over_seeds(6, |seed| channels(&shot(&scene).passes(32).seed(seed).render()));
    assert_within("panes", found, DVec3::ONE, 5e-3);
}

fn still_life(glass: &str) -> String {
    format!(
        r#"(camera: (eye: (0, 2, 4), target: (0, 0.5, 0)), image: (width: 32, height: 24),
        photons: progressive(count: 20000),
        materials: {{ "floor": (diffuse: 0.7), "glass": (transmission: 1, ior: 1.5{glass}), "water": (transmission: 1, ior: 1.33) }},
        lights: {{ "lamp": sphere(center: (1, 4, 0), radius: 0.3, radiance: 9), "sky": environment(map: constant(0.1)) }},
        objects: [(shape: quad(size: (9, 9)), material: "floor"), (shape: sphere(radius: 0.6, center: (0, 0.61, 0)), material: "glass"),
            (shape: box(center: (1.5, 0.51, 0)), material: "water")])"#
    )
}

#[test]
fn no_dispersion_and_dispersion_by_nothing_are_the_same_bits() {
    let without = shot(still_life("")).passes(4).render();
    let by_nothing = shot(still_life(", dispersion: cauchy(0)")).passes(4).render();
    let some = shot(still_life(", dispersion: cauchy(0.01)")).passes(4).render();
    assert!(without.bits() == by_nothing.bits());
    assert!(without.bits() != some.bits());
    // And nothing else in the picture is coloured without it.
    let grey = |[r, g, b]: &[f32; 3]| (r - g).abs().max((g - b).abs()) <= 1e-5 * r.abs();
    assert!(without.rgb().iter().all(grey));
}

/// Mean places of red, green and blue on a wall behind a prism: the least deviation by 60° of flint
/// is 48.2° for the d line, 1.8° more for F than for C.
#[test]
fn a_prism_bends_red_green_and_blue_as_cauchy_says() {
    let lines = [0.656_281, 0.587_562, 0.486_134].map(|um| flint().ior(Some(um)));
    assert_close((1.62 - 1.0) / (lines[2] - lines[0]), 25.0, 1e-9);
    let least = |ior: f64| 2.0 * (ior / 2.0).asin() - 60f64.to_radians();
    let (prism, wall) = (Prism::new(1.0), 2.0);
    let entry = (prism.corners[0] + prism.corners[2]) / 2.0;
    let dir = DVec2::from_angle(incidence() - 30f64.to_radians());
    for ior in lines {
        let (_, out, _) = prism.through(entry, dir, ior, wall);
        // The least deviation is flat: off the symmetric passage it is more, by little.
        let more = dir.angle_to(out).abs() - least(ior);
        assert!((-1e-12..6e-4).contains(&more), "{more}");
    }
    let folder = folder();
    write_exr(&folder.path().join("ruler.exr"), 2, 2, |x, _| [x as f32; 3]);
    prism.mesh(1.0).write(&folder.path().join("prism.obj"));
    let eye = entry - dir * 1.5;
    let seen = |emission: &str| {
        let scene = format!(
            r#"(camera: (eye: ({:?}, {:?}, 0), target: ({:?}, {:?}, 0), up: (0, 0, 1), fov_deg: 1e-7),
            image: (width: 8, height: 8), antialiasing: none, render: (max_depth: 2), photons: off,
            textures: {{ "ruler": image(path: "ruler.exr", wrap: clamp, uv: (scale: (0.5, 0.5), offset: (0.25, 0.25))) }},
            materials: {{ "wall": (emission: {emission}), {FLINT} }},
            objects: [(shape: mesh(path: "prism.obj", smooth: false), material: "flint"),
                (shape: quad(size: (4, 4)), material: "wall", transform: [rotate(axis: (0, 0, 1), deg: 90), translate(({wall:?}, 0, 0))])])"#,
            eye.x, eye.y, entry.x, entry.y
        );
        over_seeds(8, |seed| {
            let shot = shot(&scene).folder(folder.path()).passes(512).seed(seed);
            channels(&shot.render())
        })
    };
    let share = |ior: f64| prism.through(entry, dir, ior, wall).2;
    let place = |ior: f64| prism.through(entry, dir, ior, wall).0;
    let all = seen("1");
    let expected = over_wavelengths(flint(), share);
    assert_within("transmittance", all, expected, 5e-3);
    let read = seen(r#"texture("ruler")"#);
    let on_ruler = over_wavelengths(flint(), |ior| share(ior) * (place(ior) / 4.0 + 0.5));
    assert_within("place", read, on_ruler, 5e-3);
    let [red, green, blue] = (read.0 / all.0).to_array();
    assert!(red > green + 0.003 && green > blue + 0.003, "{red} {green} {blue}");
    // Only the colours' places differ so much: they are where C, d and F say.
    let [c, d, f] = lines.map(|ior| place(ior) / 4.0 + 0.5);
    assert!(c > d && d > f && red < c + 0.002 && blue > f - 0.02 && blue < d, "{c} {d} {f}");
}

/// Photons through a pane: white, and as many as Fresnel lets through in the mean over wavelengths.
#[test]
fn the_light_below_a_dispersive_pane_is_white() {
    for deg in [0.0, 60.0] {
        let (sin, cos) = f64::to_radians(deg).sin_cos();
        let scene = format!(
            r#"(camera: (eye: (0, 0.8, 0), target: (0, 0, 0), up: (0, 0, 1), fov_deg: 60), image: (width: 12, height: 12),
            photons: progressive(count: 50000),
            materials: {{ "floor": (diffuse: 0.5), {FLINT} }},
            lights: {{ "sun": directional(direction: ({sin:?}, {:?}, 0), irradiance: 2) }},
            objects: [(shape: quad(size: (9, 9)), material: "floor"), (shape: box(size: (2.4, 0.1, 2.4), center: ({:?}, 1, 0)), material: "flint")])"#,
            -cos,
            -sin / cos
        );
        let found = over_seeds(6, |seed| channels(&shot(&scene).passes(6).seed(seed).render()));
        // (1 − R)/(1 + R): all orders of reflection in the pane.
        let share = over_wavelengths(flint(), |ior| {
            let r = Interface::new(cos, ior).reflectance;
            (1.0 - r) / (1.0 + r)
        });
        assert!((share / share.x - 1.0).abs().max_element() < 1e-2, "{share}");
        let radiance = share * (2.0 * cos * 0.5 / std::f64::consts::PI);
        assert_within("floor", found, radiance, 1e-2);
    }
}

/// A slit of light on a prism, the wall behind it, and a camera that looks at the rainbow.
#[test]
fn a_prism_throws_a_rainbow_whose_colours_lie_where_cauchy_says() {
    let upright = Prism::new(0.4);
    let entry = (upright.corners[0] + upright.corners[2]) / 2.0;
    let turn = 30f64.to_radians() - incidence();
    // The beam comes along +x at the height of `entry`.
    let prism = upright.turned(turn, entry);
    let wall = 1.0;
    let place = |ior: f64| prism.through(entry, DVec2::X, ior, wall);
    let centre = place(1.62).0;
    let folder = folder();
    prism.mesh(0.5).write(&folder.path().join("prism.obj"));
    let (distance, n, fov) = (1.0, 160, 30f64);
    let scene = format!(
        r#"(camera: (eye: ({:?}, {centre:?}, 0), target: ({wall:?}, {centre:?}, 0), fov_deg: {fov:?}),
        image: (width: 8, height: {n}), photons: progressive(count: 150000, k: 8, max_radius_m: 0.01),
        materials: {{ "wall": (diffuse: 1), "black": (diffuse: 0), {FLINT} }},
        lights: {{ "sun": directional(direction: (1, 0, 0), irradiance: 1000) }},
        objects: [(shape: mesh(path: "prism.obj", smooth: false), material: "flint"),
            (shape: box(size: (0.01, 6, 6), center: (-0.5, {:?}, 0)), material: "black"),
            (shape: box(size: (0.01, 6, 6), center: (-0.5, {:?}, 0)), material: "black"),
            (shape: quad(size: (4, 4)), material: "wall", transform: [rotate(axis: (0, 0, 1), deg: 90), translate(({wall:?}, 0, 0))])])"#,
        wall - distance,
        entry.y + 3.005,
        entry.y - 3.005,
    );
    // Centroids along y, by channel, off the middle of the picture.
    let centroids = |picture: &Picture| {
        let step = 2.0 * (fov.to_radians() / 2.0).tan() * distance / n as f64;
        let (mut sum, mut moment) = (DVec3::ZERO, DVec3::ZERO);
        for (i, pixel) in picture.rgb().into_iter().enumerate() {
            let y = (n as f64 / 2.0 - (i / 8) as f64 - 0.5) * step;
            let value = DVec3::from(pixel.map(f64::from));
            sum += value;
            moment += value * y;
        }
        moment / sum
    };
    let found =
        over_seeds(4, |seed| centroids(&shot(&scene).folder(folder.path()).passes(32).seed(seed).render()));
    let share = over_wavelengths(flint(), |ior| place(ior).2);
    let expected = over_wavelengths(flint(), |ior| place(ior).2 * (place(ior).0 - centre)) / share;
    println!("{} ± {}, expected {expected}", found.0, found.1);
    let (found, error) = found;
    assert!(found.x > found.y && found.y > found.z, "{found}");
    let separation = |v: DVec3| [v.x - v.y, v.y - v.z, v.x - v.z];
    for (a, b) in separation(found).into_iter().zip(separation(expected)) {
        assert_close(a, b, 0.03);
    }
    for c in 0..3 {
        assert!((found[c] - expected[c]).abs() < 3.0 * error[c] + 1e-3 * (expected.x - expected.z));
    }
}

#[test]
fn both_languages_say_dispersion_and_convert_it() {
    let ron = r#"(camera: (eye: (0, 0, 1), target: (0, 0, 0)), materials: {
        "flint": (transmission: 1, ior: 1.62, dispersion: abbe(36)), "crown": (transmission: 1, dispersion: cauchy(0.0042)) })"#;
    let toml = r"
        camera = { eye = [0, 0, 1], target = [0, 0, 0] }
        [materials]
        flint = { transmission = 1, ior = 1.62, dispersion = { abbe = 36 } }
        crown = { transmission = 1, dispersion.cauchy = 0.0042 }
    ";
    let load = |text: &str, format| {
        load_str(text, format, Path::new(""), &[]).unwrap_or_else(|report| panic!("{report}\n{text}"))
    };
    let (a, b) = (load(ron, Format::Ron), load(toml, Format::Toml));
    assert_eq!(a.scene, b.scene);
    assert_eq!(a.hash, b.hash);
    let written = load_str_as_written(ron, Format::Ron, &[]).unwrap_or_else(|report| panic!("{report}"));
    for format in [Format::Ron, Format::Toml] {
        let text = to_string(&written, format).expect("every scene has a text");
        assert_eq!(load(&text, format).scene, a.scene, "{text}");
    }
    let fewer = load(&ron.replace("abbe(36)", "abbe(35)"), Format::Ron);
    assert_ne!(fewer.hash, a.hash);
}

#[test]
fn impossible_dispersion_is_refused_with_its_place() {
    for (material, expected) in [
        (
            "(transmission: 1, dispersion: abbe(0))",
            "2:54: error: materials.m.dispersion.abbe: 0 is outside [5, 200]",
        ),
        (
            "(transmission: 1, dispersion: abbe(-30))",
            "2:54: error: materials.m.dispersion.abbe: -30 is outside [5, 200]",
        ),
        (
            "(transmission: 1, dispersion: cauchy(-1))",
            "2:56: error: materials.m.dispersion.cauchy: -1 is outside [0, 0.1]",
        ),
        (
            "(transmission: 1, dispersion: cauchy(0.2))",
            "2:56: error: materials.m.dispersion.cauchy: 0.2 is outside [0, 0.1]",
        ),
        (
            "(transmission: 1, dispersion: abe(30))",
            "2:49: error: materials.m.dispersion: there is no `abe` here; did you mean `abbe`?",
        ),
    ] {
        let text =
            format!("(camera: (eye: (0, 0, 1), target: (0, 0, 0)),\nmaterials: {{ \"m\": {material} }})");
        let report = load_str(&text, Format::Ron, Path::new(""), &[]).expect_err(material).to_string();
        assert!(report.contains(expected), "{report}\ninstead of {expected}");
    }
}
