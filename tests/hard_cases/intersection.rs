//! Rays and shapes where rounding hurts: far away, grazing, very small and very large.

use super::proofs::prove;
use super::record::{Record, row, sized};
use super::solids::{crossings, inside, random_placement, ray_at, solids, unit};
use crate::render::shot::{agreement, shot};
use crate::render::stability::{assets, render_everything};
use std::sync::atomic::{AtomicU64, Ordering};
use terrarium::math::random::{Counter, Stage};
use terrarium::math::{DVec3, Frame, Ray, robust};
use terrarium::optics::{Shape, Sphere};

/// Rays that leave a placed convex shape, at every slope down to the last bit: how many leave outwards, how
/// many of those meet it again, and how many that go in steeply do not come out.
fn leave(shape: &Shape, rays: u32, item: u64) -> [u64; 3] {
    let mut counter = Counter::new(54, Stage::Test, item);
    let mut counts = [0; 3];
    for _ in 0..rays {
        let placement = random_placement(&mut counter);
        let ray = ray_at(shape, 3.0, &mut counter);
        let Some(hit) = shape.nearest(&ray, 0.0, f64::INFINITY) else { continue };
        let at = shape.surface(&ray, hit);
        let (p, n) = (placement.point(at.p), placement.normal(at.ng));
        let error = robust::placed_error(&placement, at.p, at.p_error);
        let slope = libm::pow(10.0, -17.0 * counter.value());
        let dir = (n.cross(unit(&mut counter)).normalize() + n * slope).normalize();
        if dir.dot(n) >= 0.0 {
            let leaving = placement.local_ray(&Ray::leaving(p, error, n, dir));
            counts[0] += 1;
            counts[1] += u64::from(shape.nearest(&leaving, 0.0, f64::INFINITY).is_some());
        }
        // And into it, steeply: out again on some other side, unless it is so thin or so small for its distance
        // from the origin that its faces are no further apart than points are known.
        let inwards = placement.local_ray(&Ray::leaving(p, error, n, -n));
        let (min, max) = shape.bounds();
        let thick = placement.stretch() < 3.0 * placement.det().abs().cbrt()
            && error < 1e-6 * placement.scale() * (max - min).min_element();
        counts[2] += u64::from(thick && shape.nearest(&inwards, 0.0, f64::INFINITY).is_none());
    }
    counts
}

#[test]
fn h01_self_intersection() {
    row("H1", |row| {
        // About a quarter of the rays miss.
        let each = sized(3_000, 400_000);
        let mut total = [0; 3];
        for (i, size) in [1e-4, 1.0, 1e4].into_iter().enumerate() {
            for (k, shape) in solids(size).iter().enumerate() {
                let counts = leave(shape, each, (100 * i + k) as u64);
                total.iter_mut().zip(counts).for_each(|(sum, n)| *sum += n);
            }
        }
        let [outwards, again, lost] = total;
        row.at_least("rays that leave convex shapes outwards", outwards as f64, sized(5e4, 1e7));
        row.none("of them meet it again", again, outwards);
        row.none("rays that go in steeply and do not come out", lost, outwards);

        let dir = assets();
        let one = render_everything(dir.path(), 1.0, 0.0, 1.0);
        let pixels = one.grey().len() as u64;
        for (m, least) in [(1e3, 1.0), (-1e6, 1.0), (1e7, 0.99)] {
            let share = agreement(&one, &render_everything(dir.path(), 1.0, m, 1.0), 1e-4);
            let same = (share * pixels as f64).round() as u64;
            row.share(
                &format!("pixels equal to 1e-4 of a scene moved by {m:e} m along all axes"),
                same,
                pixels,
                least,
            );
        }
    });
}

#[test]
fn h02_distant_spheres() {
    row("H2", |row| {
        let shape = Shape::Sphere(Sphere::new(1.0, DVec3::ZERO));
        let mut counter = Counter::new(53, Stage::Test, 0);
        let lines = sized(2_000u32, 200_000);
        let (mut inner, mut outer) = (0, 0);
        let (mut off_surface, mut off_normal) = (0.0f64, 0.0f64);
        for exponent in 2..=6 {
            let distance = libm::pow(10.0, f64::from(exponent));
            for _ in 0..lines {
                let frame = Frame::around(unit(&mut counter));
                let around = frame.to_world(DVec3::new(libm::cos(1.0), libm::sin(1.0), 0.0));
                let line = |offset: f64| Ray { origin: frame.n * distance + around * offset, dir: -frame.n };
                let grazing = line(1.0 - 1e-6);
                let hit = shape.nearest(&grazing, 0.0, f64::INFINITY);
                inner += u64::from(hit.is_none());
                outer += u64::from(shape.nearest(&line(1.0 + 1e-6), 0.0, f64::INFINITY).is_some());
                let offset = counter.value();
                let ray = line(offset);
                let aimed = shape.nearest(&ray, 0.0, f64::INFINITY).expect("aimed at it");
                let exact = around * offset + frame.n * (1.0 - offset * offset).sqrt();
                let at = shape.surface(&ray, aimed);
                off_normal = off_normal.max(at.ng.distance(exact));
                let unit = 16.0 * f64::EPSILON * (distance + 1.0);
                let found = hit.map(|hit| shape.surface(&grazing, hit).p).into_iter().chain([at.p]);
                off_surface = found.fold(off_surface, |most, p| most.max((p.length() - 1.0).abs() / unit));
            }
        }
        let lines = 5 * u64::from(lines);
        row.none("lines at 1 − 1e-6 radii from the centre that miss, D from 1e2 to 1e6", inner, lines);
        row.none("lines at 1 + 1e-6 radii that hit", outer, lines);
        row.at_most("|‖p − c‖ − r| over 16 ε (D + r), ε that of double precision", off_surface, 1.0);
        row.at_most("normals' distance from the exact ones", off_normal, 1e-6);
    });
}

/// Lines, a quarter of them through a rim, an edge or a corner as nearly as can be said, that cross a closed
/// shape once or three times.
fn odd_crossings(shape: &Shape, size: f64, lines: u32) -> u64 {
    let mut counter = Counter::new(51, Stage::Test, 0);
    let mut odd = 0;
    for i in 0..lines {
        let ray = if i % 4 == 0 {
            let corner = shape.bounds().1 * DVec3::new(counter.value().round(), 1.0, counter.value().round());
            let dir = unit(&mut counter);
            Ray { origin: corner - dir * size, dir }
        } else {
            ray_at(shape, 3.0, &mut counter)
        };
        odd += u64::from(!matches!(crossings(shape, &ray).len(), 0 | 2));
    }
    odd
}

/// The first change of sign along a ray, by steps, against the reported hit: how far off the hit is, and
/// whether a crossing was missed or made up.
fn against_definition(size: f64, index: usize, shape: &Shape, rays: u32) -> (f64, u64, u64) {
    let mut counter = Counter::new(52, Stage::Test, 1);
    let (mut worst, mut wrong, mut tried) = (0.0f64, 0, 0);
    for _ in 0..rays {
        let mut ray = ray_at(shape, 1.5, &mut counter);
        ray.dir = ray.dir.normalize() * size;
        let Some(start) = inside(size, index, ray.origin) else { continue };
        tried += 1;
        let f = |t: f64| inside(size, index, ray.at(t)).expect("a definition");
        let hit = shape.nearest(&ray, 0.0, f64::INFINITY);
        let end = hit.map_or(12.0, |hit| hit.t);
        if let Some(hit) = hit {
            let p = shape.surface(&ray, hit).p;
            worst = worst.max(inside(size, index, p).expect("a definition").abs());
            worst = worst.max(p.distance(ray.at(hit.t)) / size);
            // The sign does change here, unless the ray only grazes.
            let (before, after) = (f(end - 1e-6), f(end + 1e-6));
            wrong += u64::from(before * after >= 0.0 && before.abs().max(after.abs()) >= 1e-5);
        }
        let passed = (0..200).map(|i| f(end * (f64::from(i) + 0.5) / 200.0));
        wrong += u64::from(passed.into_iter().any(|value| value * start <= 0.0 && value.abs() >= 1e-12));
    }
    (worst, wrong, tried)
}

#[test]
fn h03_quadrics_and_rims() {
    row("H3", |row| {
        let each = sized(4_000, 1_000_000);
        let (odd, lines) = (AtomicU64::new(0), AtomicU64::new(0));
        rayon::scope(|scope| {
            for size in [1e-6, 1e-3, 1.0, 1e3, 1e6] {
                for shape in solids(size) {
                    let (odd, lines) = (&odd, &lines);
                    scope.spawn(move |_| {
                        odd.fetch_add(odd_crossings(&shape, size, each), Ordering::Relaxed);
                        lines.fetch_add(u64::from(each), Ordering::Relaxed);
                    });
                }
            }
        });
        row.none(
            "lines that cross a closed shape an odd number of times",
            odd.into_inner(),
            lines.into_inner(),
        );
        let (mut worst, mut wrong, mut tried) = (0.0f64, 0, 0);
        for size in [1e-6, 1e-4, 1.0, 1e4, 1e6] {
            for (index, shape) in solids(size).iter().enumerate() {
                let (off, bad, of) = against_definition(size, index, shape, sized(200, 4_000));
                (worst, wrong, tried) = (worst.max(off), wrong + bad, tried + of);
            }
        }
        row.at_most(
            "hits' distance from the surface as a share of the size, radius 1e-6 to 1e6",
            worst,
            1e-12,
        );
        row.none("crossings missed or made up, against steps along the ray", wrong, tried);
    });
}

#[test]
fn h04_planet_for_ground() {
    row("H4", |row| {
        dip(row);
        horizon(row);
        prove(row, "horizon");
        contact(row);
    });
}

const PLANET: &str = r#"(shape: sphere(radius: 1e6, center: (0, -1e6, 0)), material: "white")"#;

/// From under a ball of 1 m that rests on the planet, shadow rays meet the ball, not the ground.
fn dip(row: &mut Record) {
    let ground = Shape::Sphere(Sphere::new(1e6, DVec3::new(0.0, -1e6, 0.0)));
    let sees = |dip: f64| {
        let dir = DVec3::new(libm::cos(dip), -libm::sin(dip), 0.0);
        ground.nearest(&Ray { origin: DVec3::Y * 1.7, dir }, 0.0, f64::INFINITY).is_some()
    };
    let dip = (2.0 * 1.7 / 1e6f64).sqrt();
    row.holds(
        "rays meet the ground from 1.0001 of √(2h/r) downwards, and not at 0.9999",
        sees(dip * 1.0001) && !sees(dip * 0.9999),
    );
    let ball = Shape::Sphere(Sphere::new(1.0, DVec3::Y));
    let mut shadowed = 0;
    for x in [1e-6, 1e-3, 1e-2, 0.1] {
        let down = Ray { origin: DVec3::new(x, 1e-9, 0.0), dir: DVec3::NEG_Y };
        let at = ground.surface(&down, ground.nearest(&down, 0.0, f64::INFINITY).expect("ground"));
        let ray = Ray::leaving(at.p, at.p_error, at.ng, DVec3::Y);
        let free = ground.nearest(&ray, 0.0, f64::INFINITY).is_none();
        shadowed += u64::from(free && ball.nearest(&ray, 0.0, f64::INFINITY).is_some());
    }
    row.all("shadow rays under a ball of 1 m, 1e-6 to 0.1 m from where it stands, that meet it and not the ground", shadowed, 4);
}

fn horizon(row: &mut Record) {
    let picture = shot(format!(
        r#"(camera: (eye: (0, 1.7, 0), target: (0, 1.7, -1), fov_deg: 0.4), image: (width: 1, height: 4000), antialiasing: none,
        background: 5, materials: {{ "white": (diffuse: 1) }}, objects: [{PLANET}])"#
    ))
    .render();
    let sky = picture.grey().iter().filter(|x| **x == 5.0).count();
    let below = (sky as f64 / 4000.0 * 2.0 - 1.0) * f64::to_radians(0.2).tan();
    row.is_close(
        "the horizon below the horizontal: √(2h/r), radians",
        below,
        (2.0 * 1.7 / 1e6f64).sqrt(),
        0.01,
    );
}

/// Sun at 45°: the shadow of a ball of radius 0.5 that rests at the origin, pixel by pixel.
fn contact(row: &mut Record) {
    let picture = shot(format!(
        r#"(camera: (eye: (0, 12, 0.01), target: (0, 0, 0), fov_deg: 20), image: (width: 60, height: 60), antialiasing: none,
        materials: {{ "white": (diffuse: 1), "black": () }}, lights: {{ "sun": directional(direction: (1, -1, 0), irradiance: 1) }},
        objects: [{PLANET}, (shape: sphere(radius: 0.5, center: (0, 0.5, 0)), material: "black")])"#
    ))
    .render();
    let lit = 0.5f64.sqrt() / std::f64::consts::PI;
    let (mut shadow, mut wrong, mut looked_at) = (0, 0, 0);
    let half = f64::to_radians(10.0).tan() * 12.0;
    for y in 0..60 {
        for x in 0..60 {
            let at = |k: usize| ((k as f64 + 0.5) / 30.0 - 1.0) * half;
            let (px, pz) = (at(x), at(y));
            // Distance of the ball's centre from the ray towards the sun, and from the eye's ray.
            let from = DVec3::new(px, 0.0, pz);
            let to_sun = DVec3::new(-1.0, 1.0, 0.0).normalize();
            let apart = |o: DVec3, d: DVec3| (DVec3::new(0.0, 0.5, 0.0) - o).cross(d).length();
            let seen = apart(from, (DVec3::new(0.0, 12.0, 0.01) - from).normalize());
            let lit_by = apart(from, to_sun);
            if (seen - 0.5).abs() < 0.03 || (lit_by - 0.5).abs() < 0.03 {
                continue;
            }
            let expected = if seen < 0.5 || (lit_by < 0.5 && px > -0.5) { 0.0 } else { lit };
            shadow += u64::from(seen > 0.5 && expected == 0.0);
            looked_at += 1;
            wrong += u64::from((picture.at(x, y) - expected).abs() >= 1e-4);
        }
    }
    row.at_least("pixels in the shadow of a ball that rests on it", shadow as f64, 41.0);
    row.none("pixels that are not as lit or as black as the closed form", wrong, looked_at);
}
