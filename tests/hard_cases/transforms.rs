//! Scales that are uneven, mirrored, flat, or merely extreme.

use super::proofs::prove;
use super::record::{Record, row, sized};
use super::solids::unit;
use crate::render::shot::{agreement, shot};
use crate::render::stability::{assets, everything};
use std::path::Path;
use terrarium::description::{Format, load_str};
use terrarium::math::random::{Counter, Stage};
use terrarium::math::{DAffine3, DVec3, Placement, Ray};
use terrarium::optics::{Shape, Sphere};

#[test]
fn h23_uneven_scale() {
    row("H23", |row| {
        let twice = Placement::new(DAffine3::from_scale(DVec3::new(2.0, 1.0, 1.0))).expect("invertible");
        let found = twice.normal(DVec3::new(1.0, 1.0, 0.0));
        let expected = DVec3::new(1.0, 2.0, 0.0) / 5f64.sqrt();
        row.at_most(
            "diag(2, 1, 1) takes the normal (1, 1, 0) to (1, 2, 0)/√5: off by",
            found.distance(expected),
            1e-15,
        );
        ellipsoid_normals(row);
        ellipsoid_picture(row);
        prove(row, "ellipsoid");
    });
}

fn ellipsoid_normals(row: &mut Record) {
    let shape = Shape::Sphere(Sphere::new(1.0, DVec3::ZERO));
    let mut counter = Counter::new(55, Stage::Test, 0);
    let (mut off, mut inwards, mut points) = (0.0f64, 0, 0);
    for scale in [DVec3::new(2.0, 1.0, 1.0), DVec3::new(-1.0, 1.0, 1.0), DVec3::new(0.1, -3.0, 20.0)] {
        let placement = Placement::new(DAffine3::from_scale(scale)).expect("invertible");
        for _ in 0..sized(1_000, 300_000) {
            let from = unit(&mut counter) * 100.0;
            let target = unit(&mut counter) * scale * 0.5;
            let ray = Ray { origin: from, dir: (target - from).normalize() };
            let local = placement.local_ray(&ray);
            let hit = shape.nearest(&local, 0.0, f64::INFINITY).expect("aimed at it");
            let at = shape.surface(&local, hit);
            let p = ray.at(hit.t);
            assert!(placement.point(at.p).distance(p) < 1e-9, "t is the world's");
            let n = placement.normal(at.ng);
            off = off.max(n.distance((p / (scale * scale)).normalize()));
            inwards += u64::from(n.dot(ray.dir) >= 0.0);
            points += 1;
        }
    }
    row.at_most("normals of scaled spheres, mirrored ones too: distance from the ellipsoid's", off, 1e-6);
    row.none("of which point inwards", inwards, points);
}

/// A scaled sphere is lit as the ellipsoid that it is: E = n·s, with n from the gradient.
fn ellipsoid_picture(row: &mut Record) {
    let picture = shot(
        r#"(camera: (eye: (0, 0, 60), target: (0, 0, 0), fov_deg: 4), image: (width: 41, height: 41), antialiasing: none,
        materials: { "white": (diffuse: 1) }, lights: { "sun": directional(direction: (-1, -2, -2), irradiance: 3) },
        objects: [(shape: sphere(), material: "white", transform: [scale((2, 1, 0.5))])])"#,
    )
    .render();
    let half = f64::to_radians(2.0).tan();
    let (mut lit, mut off, sun) = (0, 0.0f64, DVec3::new(1.0, 2.0, 2.0) / 3.0);
    for y in 0..41 {
        for x in 0..41 {
            let at = |k: usize| ((k as f64 + 0.5) / 41.0 * 2.0 - 1.0) * half;
            let (o, d) = (DVec3::new(0.0, 0.0, 60.0), DVec3::new(at(x), -at(y), -1.0));
            let inverse = DVec3::new(0.5, 1.0, 2.0);
            let (o1, d1) = (o * inverse, d * inverse);
            let (a, b, c) = (d1.dot(d1), o1.dot(d1), o1.dot(o1) - 1.0);
            let expected = if b * b < a * c {
                0.0
            } else {
                let p = o + d * ((-b - (b * b - a * c).sqrt()) / a);
                let n = (p * inverse * inverse).normalize();
                3.0 * n.dot(sun).max(0.0) / std::f64::consts::PI
            };
            lit += usize::from(expected > 0.0);
            off = off.max((picture.at(x, y) - expected).abs());
        }
    }
    assert!(lit > 300, "{lit} pixels are lit");
    row.at_most("a sphere scaled by (2, 1, ½) in sunlight, every pixel against the ellipsoid's", off, 1e-5);
}

/// Light samples differ, so that means over passes are compared.
#[test]
fn h24_mirrored_transforms() {
    row("H24", |row| {
        let dir = assets();
        let passes = sized(96, 1024);
        let render = |flip: f64| shot(everything(1.0, 0.0, flip)).folder(dir.path()).passes(passes).render();
        let (one, other) = (render(1.0), render(-1.0));
        let (w, h) = (one.width(), one.height());
        let pairs = (0..w * h).map(|i| (one.at(i % w, i / w), other.at(w - 1 - i % w, i / w)));
        let noise = sized(0.06, 0.02);
        let same = pairs.filter(|(a, b)| (a - b).abs() <= noise * a.max(*b) + noise / 6.0).count();
        row.is_close(
            "mean of a scene mirrored by scale(−1, 1, 1): that of the original",
            one.mean(),
            other.mean(),
            2e-3,
        );
        let what =
            format!("pixels of its mirror image, glass and normal maps too, equal within noise of {noise}");
        row.share(&what, same as u64, (w * h) as u64, 0.995);
        without_noise(row);
    });
}

/// Matt and mirroring shapes in the sun, a ray a pixel: nothing in them is left to chance.
fn without_noise(row: &mut Record) {
    let view = |flip: f64| {
        shot(format!(
            r#"(camera: (eye: (0, 1.5, 5), target: (0, 0.4, 0), fov_deg: 40), image: (width: 65, height: 48), antialiasing: none, background: 0.3,
            textures: {{ "tiles": checker(a: 0.2, b: 0.8, squares: (5, 3)) }},
            materials: {{ "floor": (diffuse: 0.6), "tiles": (diffuse: texture("tiles")), "shiny": (diffuse: 0.5, specular: 0.2, shininess: 20, reflection: 0.3) }},
            lights: {{ "sun": directional(direction: ({}, -1, -0.7), irradiance: 3) }},
            objects: [(shape: quad(size: (8, 8)), material: "floor"),
                (shape: group(objects: [(shape: cone(radius: 0.5, height: 1), material: "tiles", transform: [translate((-1, 0, 0.3))]),
                    (shape: cylinder(radius: 0.4, height: 0.8), material: "shiny", transform: [rotate(axis: (1, 0, 0.3), deg: 20), translate((0.2, 0.1, 0))]),
                    (shape: box(size: (0.6, 0.9, 0.4)), material: "tiles", transform: [rotate(axis: (0, 1, 0), deg: 33), translate((1.1, 0.45, -0.4))])]),
                 transform: [scale(({flip}, 1, 1))])])"#,
            0.5 * flip
        ))
        .render()
    };
    let (one, other) = (view(1.0), view(-1.0));
    let (w, h) = (one.width(), one.height());
    let pairs = (0..w * h).map(|i| (one.at(i % w, i / w), other.at(w - 1 - i % w, i / w)));
    let same = pairs.filter(|(a, b)| (a - b).abs() <= 1e-6 * a.max(*b)).count();
    row.all(
        "pixels of a mirror image in which nothing is left to chance, to 1e-6",
        same as u64,
        (w * h) as u64,
    );
}

#[test]
fn h25_singular_transforms() {
    row("H25", |row| {
        for bad in [
            "scale((0, 1, 1))",
            "scale(0)",
            "matrix(((1, 2, 0, 0), (2, 4, 0, 0), (0, 0, 1, 0)))",
            "scale((1, 1e-40, 1))",
            "scale((1e-14, 1, 1))",
            "scale((1e-25, 1, 1e25))",
            "scale(1e-110)",
            "scale(1e-60), scale(1e-60)",
            "scale(1e-170)",
            "scale(1e110)",
        ] {
            let scene = format!(
                "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), materials: {{ \"white\": (diffuse: 1) }},\n\
                 objects: [(shape: sphere(), material: \"white\", transform: [{bad}])])"
            );
            let report = load_str(&scene, Format::Ron, Path::new(""), &[]).err();
            let said = report.and_then(|r| {
                let headline = r.errors().next().map(|error| error.headline())?;
                Some(format!("code {}, {headline}", r.exit_code()))
            });
            let said = said.unwrap_or_default().replace("<input>:2:", "line 2, column ");
            row.says(&format!("what is said of {bad}"), &said, "objects.0.transform");
        }
        let view = |s: f64| {
            shot(format!(
                r#"(camera: (eye: (0, {s:e}, {:e}), target: (0, 0, 0)), image: (width: 9, height: 9), antialiasing: none,
                materials: {{ "white": (diffuse: 1) }}, lights: {{ "sun": directional(direction: (-1, -2, -2), irradiance: 3) }},
                objects: [(shape: sphere(), material: "white", transform: [scale({s:e})])])"#,
                4.0 * s
            ))
            .render()
        };
        let squeezed = |s: f64| {
            shot(format!(
                r#"(camera: (eye: (3, 0.5, 0), target: (0, 0, 0)), image: (width: 32, height: 32), antialiasing: none,
                materials: {{ "glow": (emission: 1) }}, objects: [(shape: sphere(), material: "glow", transform: [scale(({s:e}, 1, 1))])])"#
            ))
            .render()
        };
        let (disk, thin) = (squeezed(1e-6), squeezed(1e-12));
        let same = (agreement(&disk, &thin, 0.0) * 1024.0).round() as u64;
        row.all("pixels of a ball squeezed by 1e-12 that are those of one squeezed by 1e-6", same, 1024);
        let one = view(1.0);
        for s in [1e-12, 1e12] {
            let same = (agreement(&one, &view(s), 1e-4) * 81.0).round() as u64;
            row.all(
                &format!("pixels of a ball scaled by {s:e} that are those of the ball, to 1e-4"),
                same,
                81,
            );
        }
    });
}
