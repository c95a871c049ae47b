//! Shapes against implicit functions, parity and closed forms.

use super::*;
use crate::math::random::{Counter, Sequence, Stage};
use crate::math::sampling;
use std::f64::consts::{PI, TAU};

const SOLIDS: [Solid; 5] =
    [Solid::Tetrahedron, Solid::Cube, Solid::Octahedron, Solid::Dodecahedron, Solid::Icosahedron];

/// One of each kind, none of them centred or of unit size; with volumes of those that have one.
fn shapes() -> Vec<(&'static str, Shape, Option<f64>)> {
    let frustum = |a: f64, b: f64, h: f64| PI * h * (a * a + a * b + b * b) / 3.0;
    let mut list = vec![
        ("sphere", Shape::Sphere(Sphere::new(0.7, DVec3::new(0.3, -0.2, 0.5))), Some(4.0 / 3.0 * PI * 0.343)),
        (
            "cuboid",
            Shape::Cuboid(Cuboid::new(DVec3::new(1.5, 0.5, 0.8), DVec3::new(0.1, 0.4, -0.3))),
            Some(0.6),
        ),
        ("cylinder", Shape::Cone(Cone::new(0.6, 0.6, 1.3, true)), Some(frustum(0.6, 0.6, 1.3))),
        ("cone", Shape::Cone(Cone::new(0.9, 0.0, 1.4, true)), Some(frustum(0.9, 0.0, 1.4))),
        ("funnel", Shape::Cone(Cone::new(0.0, 0.8, 0.3, true)), Some(frustum(0.0, 0.8, 0.3))),
        ("frustum", Shape::Cone(Cone::new(0.4, 0.9, 0.8, true)), Some(frustum(0.4, 0.9, 0.8))),
        ("open cone", Shape::Cone(Cone::new(0.9, 0.2, 1.0, false)), None),
        ("disk", Shape::Disk(Disk::new(0.8, 0.0)), None),
        ("ring", Shape::Disk(Disk::new(0.8, 0.3)), None),
        ("quad", Shape::Quad(Quad::new([1.7, 0.6])), None),
    ];
    // Volumes for circumradius 1.
    let g = 1.618_033_988_749_895;
    let volumes = [
        8.0 * 3f64.sqrt() / 27.0,
        8.0 * 3f64.sqrt() / 9.0,
        4.0 / 3.0,
        // Of edge a: (15 + 7√5)/4·a³, a = 4/(√3·(1 + √5)).
        (15.0 + 7.0 * 5f64.sqrt()) / 4.0 * libm::pow(2.0 / (3f64.sqrt() * g), 3.0),
        // Of edge a: 5(3 + √5)/12·a³, a = 1/sin(2π/5).
        5.0 * (3.0 + 5f64.sqrt()) / 12.0 / libm::pow(libm::sin(TAU / 5.0), 3.0),
    ];
    let names = ["tetrahedron", "cube", "octahedron", "dodecahedron", "icosahedron"];
    for i in 0..5 {
        list.push((names[i], Shape::Polyhedron(Polyhedron::new(SOLIDS[i], 1.0)), Some(volumes[i])));
    }
    list
}

/// All of the surface lies in the ball; and a part of it, or of the box's faces, near the ball's own.
#[test]
fn balls_hold_their_shapes() {
    for (name, shape, _) in shapes() {
        let (center, radius) = shape.ball();
        let distance = |i| {
            let u = Sequence::new(32, Stage::Test, 1, i).pair();
            shape.sample_area(u).p.distance(center)
        };
        let farthest = (0..20_000).map(distance).fold(0.0, f64::max);
        assert!(farthest <= radius * (1.0 + 1e-12), "{name}: {farthest} of {radius}");
        assert!(farthest > 0.93 * radius, "{name}: {farthest} of {radius}");
    }
}

/// Depth is 0 on the surface of a solid, and within it what no ray's way out is shorter than.
#[test]
fn depth_is_the_distance_to_the_nearest_face() {
    for (name, shape, _) in shapes().into_iter().filter(|(_, shape, _)| shape.closed()) {
        let mut counter = Counter::new(33, Stage::Test, 0);
        let (middle, radius) = shape.ball();
        for i in 0..2_000 {
            let s = shape.sample_area(Sequence::new(33, Stage::Test, 1, i).pair());
            assert!(shape.depth(s.p).abs() < 1e-12, "{name}: {}", shape.depth(s.p));
            let p = s.p + (middle - s.p) * counter.value();
            let depth = shape.depth(p);
            assert!(depth > -1e-12, "{name}: {depth}");
            let mut shortest = |steps: u32| {
                let ways = (0..steps).map(|_| Ray { origin: p, dir: random_direction(&mut counter) });
                ways.filter_map(|ray| shape.nearest(&ray, 0.0, 4.0 * radius))
                    .map(|hit| hit.t)
                    .fold(radius, f64::min)
            };
            let out = shortest(400);
            assert!(depth <= out * (1.0 + 1e-9) + 1e-12, "{name}: {depth} {out}");
            // Directions 0.2 rad apart or so find all but 2 % of it.
            assert!(depth > 0.85 * out - 1e-12, "{name}: {depth} {out}");
        }
    }
}

fn random_direction(counter: &mut Counter) -> DVec3 {
    sampling::sphere(counter.pair())
}

/// A point outside, at a distance of up to three times the size.
fn outside(shape: &Shape, counter: &mut Counter) -> DVec3 {
    let (min, max) = shape.bounds();
    let reach = (max - min).length();
    0.5 * (min + max) + random_direction(counter) * reach * (0.55 + 2.5 * counter.value())
}

#[test]
fn points_sampled_by_area_are_on_the_surface_and_uniform() {
    for (name, shape, volume) in shapes() {
        let mut counter = Counter::new(31, Stage::Test, 0);
        let n = 65536;
        let (mut normals, mut flux) = (DVec3::ZERO, 0.0);
        for i in 0..n {
            let s = shape.sample_area(Sequence::new(31, Stage::Test, 1, i).pair());
            normals += s.ng;
            flux += s.p.dot(s.ng);
            assert!((s.pdf * shape.area() - 1.0).abs() < 1e-12);
            if i % 64 == 0 {
                // A ray down onto the point meets it, and finds the same coordinates and normal.
                let above = 1e-3 * (0.1 + counter.value());
                let ray = Ray { origin: s.p + s.ng * above, dir: -s.ng };
                let Some(hit) = shape.nearest(&ray, 0.0, 2.0 * above) else { continue };
                let at = shape.surface(&ray, hit);
                assert!((hit.t - above).abs() < 1e-12, "{name}: {} {above}", hit.t);
                assert!(at.ng.distance(s.ng) < 1e-9 && at.p.distance(s.p) < 1e-12, "{name}: {s:?} {at:?}");
                let du = (at.uv - s.uv).abs();
                assert!(du.x.min(1.0 - du.x) < 1e-9 && du.y < 1e-9, "{name}: {} {}", at.uv, s.uv);
            }
        }
        // The divergence theorem: ∮ n dA = 0 and ∮ p·n dA = 3V.
        if let Some(volume) = volume {
            let mean = shape.area() / f64::from(n);
            assert!((normals * mean).length() < 0.01 * shape.area(), "{name}: {}", normals * mean);
            assert!((flux * mean / (3.0 * volume) - 1.0).abs() < 0.01, "{name}: {}", flux * mean / 3.0);
        }
    }
}

/// Steps along ∂p/∂u and ∂p/∂v, brought back to the surface by a ray, against the coordinates found there.
#[test]
fn surface_coordinates_have_the_derivatives_that_are_reported() {
    for (name, shape, _) in shapes() {
        let mut counter = Counter::new(32, Stage::Test, 0);
        for _ in 0..500 {
            let s = shape.sample_area(counter.pair());
            let uv_at = |p: DVec3| {
                let ray = Ray { origin: p + s.ng * 0.01, dir: -s.ng };
                let hit = shape.nearest(&ray, 0.0, 0.02)?;
                let at = shape.surface(&ray, hit);
                (at.ng.dot(s.ng) > 0.99).then_some(at)
            };
            let Some(at) = uv_at(s.p) else { continue };
            assert!(at.dpdu.cross(at.dpdv).dot(at.ng) > 0.0, "{name}: mirrored");
            assert!(at.dpdu.dot(at.ng).abs() < 1e-12 && at.dpdv.dot(at.ng).abs() < 1e-12, "{name}");
            let step = 1e-6;
            for (tangent, expected) in [(at.dpdu, DVec2::X), (at.dpdv, DVec2::Y)] {
                let Some(moved) = uv_at(s.p + tangent * step) else { continue };
                let change = (moved.uv - at.uv) / step;
                // Over the seam of u; and next to a pole the steps are not small.
                if change.x.abs() > 1e3 || at.dpdu.length() < 0.1 {
                    continue;
                }
                assert!(change.distance(expected) < 1e-3, "{name} at {}: {change} {expected}", at.uv);
            }
        }
    }
}

/// As seen from in front with +y up: u to the right, v up.
#[test]
fn textures_read_from_left_to_right_and_upright() {
    let cases = [
        Shape::Sphere(Sphere::new(1.0, DVec3::ZERO)),
        Shape::Cuboid(Cuboid::new(DVec3::ONE, DVec3::ZERO)),
        Shape::Cone(Cone::new(1.0, 1.0, 2.0, true)),
        Shape::Polyhedron(Polyhedron::new(Solid::Cube, 1.0)),
    ];
    for shape in cases {
        for view in [DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::NEG_Z] {
            let ray = Ray { origin: view * 5.0 + DVec3::new(0.01, 0.02, 0.03), dir: -view };
            let at = shape.surface(&ray, shape.nearest(&ray, 0.0, 10.0).expect("hit"));
            let right = DVec3::Y.cross(view);
            assert!(at.dpdu.normalize().dot(right) > 0.99, "{shape:?} from {view}: {}", at.dpdu);
            assert!(at.dpdv.normalize().dot(DVec3::Y) > 0.99, "{shape:?} from {view}: {}", at.dpdv);
        }
    }
}

#[test]
fn direction_pdf_is_the_density_of_sampled_directions() {
    for (name, shape, _) in shapes() {
        let mut counter = Counter::new(33, Stage::Test, 0);
        let mut differing = 0;
        for k in 0..4000 {
            let from = match k % 4 {
                0 => random_direction(&mut counter) * 0.05,
                1 => random_direction(&mut counter) * libm::pow(10.0, 1.0 + 7.0 * counter.value()),
                _ => outside(&shape, &mut counter),
            };
            let Some(sample) = shape.sample_direction(from, counter.pair()) else { continue };
            assert!((sample.dir.length() - 1.0).abs() < 1e-14 && sample.pdf > 0.0 && sample.pdf.is_finite());
            let pdf = shape.direction_pdf(from, sample.dir);
            differing += u32::from((pdf / sample.pdf - 1.0).abs() > 1e-6);
        }
        // Directions to within rounding of an edge may be taken for outside, or for two triangles.
        assert!(differing <= 2, "{name}: {differing}");
    }
}

#[test]
fn direction_densities_integrate_to_one() {
    for (name, shape, _) in shapes() {
        let mut counter = Counter::new(34, Stage::Test, 0);
        for _ in 0..4 {
            let from = outside(&shape, &mut counter);
            let mut sum = 0.0;
            let (mut n, mut seen) = (0u32, 0u32);
            // Until the figure is seen often enough to expect eight percent at the worst.
            while seen < 4000 && n < 1 << 16 {
                let pdf =
                    shape.direction_pdf(from, sampling::sphere(Sequence::new(34, Stage::Test, 7, n).pair()));
                sum += pdf;
                seen += u32::from(pdf > 0.0);
                n += 1;
            }
            let integral = 2.0 * TAU * sum / f64::from(n);
            let tolerance = 5.0 / f64::from(seen.max(1)).sqrt();
            assert!((integral - 1.0).abs() < tolerance, "{name} from {from}: {integral} ({seen} of {n})");
        }
    }
}

/// The shapes sampled exactly: every direction hits, the density is one over the solid angle, and the
/// directions are spread as uniform ones that happen to hit (two-sample χ² in cells of the sphere).
#[test]
fn directions_are_uniform_over_the_solid_angle() {
    for (name, shape, _) in shapes() {
        if matches!(shape, Shape::Cone(_) | Shape::Disk(_)) {
            continue;
        }
        let from = outside(&shape, &mut Counter::new(35, Stage::Test, 3));
        let hits = |dir| shape.nearest(&Ray { origin: from, dir }, 0.0, f64::INFINITY).is_some();
        let cell = |d: DVec3| {
            let across = ((0.5 + 0.5 * d.z) * 32.0) as usize;
            let around = ((libm::atan2(d.y, d.x) / TAU + 0.5) * 64.0) as usize;
            across.min(31) * 64 + around.min(63)
        };
        let (mut ours, mut theirs) = (vec![0.0; 2048], vec![0.0; 2048]);
        let (mut counter, tries) = (Counter::new(35, Stage::Test, 1), 200_000);
        let mut seen = 0.0;
        for _ in 0..tries {
            let dir = random_direction(&mut counter);
            if hits(dir) {
                theirs[cell(dir)] += 1.0;
                seen += 1.0;
            }
        }
        let solid_angle = 2.0 * TAU * seen / f64::from(tries);
        let n = 20_000;
        let mut missed = 0;
        for _ in 0..n {
            let s = shape.sample_direction(from, counter.pair()).expect("seen");
            assert!((s.pdf * solid_angle - 1.0).abs() < 5.0 / seen.sqrt(), "{name}: {}", s.pdf * solid_angle);
            missed += u32::from(!hits(s.dir));
            ours[cell(s.dir)] += 1.0;
        }
        assert!(missed <= 1, "{name}: {missed} directions miss");
        let (a, b) = ((seen / f64::from(n)).sqrt(), (f64::from(n) / seen).sqrt());
        let used = ours.iter().zip(&theirs).filter(|(o, t)| *o + *t > 10.0);
        let terms: Vec<f64> = used.map(|(o, t)| (a * o - b * t) * (a * o - b * t) / (o + t)).collect();
        let (chi2, dof) = (terms.iter().sum::<f64>(), terms.len() as f64);
        assert!(chi2 < dof + 5.0 * (2.0 * dof).sqrt(), "{name}: χ² = {chi2} of {dof}");
    }
}

#[test]
fn cubes_and_polyhedral_cubes_are_the_same_to_rays_and_in_solid_angle() {
    let cuboid = Shape::Cuboid(Cuboid::new(DVec3::splat(2.0 / 3f64.sqrt()), DVec3::ZERO));
    let solid = Shape::Polyhedron(Polyhedron::new(Solid::Cube, 1.0));
    let mut counter = Counter::new(36, Stage::Test, 0);
    for _ in 0..2000 {
        let from = outside(&cuboid, &mut counter);
        let s = cuboid.sample_direction(from, counter.pair()).expect("seen");
        let t = solid.sample_direction(from, counter.pair()).expect("seen");
        assert!((s.pdf / t.pdf - 1.0).abs() < 1e-9);
        let ray = Ray { origin: from, dir: t.dir };
        let [a, b] = [&cuboid, &solid].map(|s| s.nearest(&ray, 0.0, f64::INFINITY));
        if let (Some(a), Some(b)) = (a, b) {
            assert!((a.t - b.t).abs() < 1e-9, "{a:?} {b:?}");
            assert!(cuboid.surface(&ray, a).ng.distance(solid.surface(&ray, b).ng) < 1e-9);
        }
    }
}

/// Ω of a disk seen on its axis is 2π(1 − h/√(h² + r²)): misses are part of the density.
#[test]
fn directions_to_disks_and_cones_estimate_their_solid_angle() {
    let disk = Shape::Disk(Disk::new(0.5, 0.0));
    let cone = Shape::Cone(Cone::new(0.5, 0.0, 0.5, true));
    let ring = Shape::Disk(Disk::new(0.5, 0.2));
    let cap = |r: f64, h: f64| TAU * (1.0 - h / (h * h + r * r).sqrt());
    let below = DVec3::new(0.0, -0.7, 0.0);
    for (shape, from, expected) in [
        (&disk, DVec3::new(0.0, 0.7, 0.0), cap(0.5, 0.7)),
        (&ring, DVec3::new(0.0, -0.7, 0.0), cap(0.5, 0.7) - cap(0.2, 0.7)),
        (&cone, below, cap(0.5, 0.7)),
    ] {
        let n = 16384;
        let mut sum = 0.0;
        for i in 0..n {
            let s = shape.sample_direction(from, Sequence::new(37, Stage::Test, 0, i).pair()).expect("seen");
            let hit = shape.nearest(&Ray { origin: from, dir: s.dir }, 0.0, f64::INFINITY);
            sum += if hit.is_some() { 1.0 / s.pdf } else { 0.0 };
        }
        assert!((sum / f64::from(n) / expected - 1.0).abs() < 5e-3, "{shape:?}");
    }
}

/// Solid angles of far and small triangles, for which sums of angles are all rounding.
#[test]
fn tiny_triangles_keep_their_solid_angle_and_uniformity() {
    let corners = [DVec3::new(0.0, 0.0, 5.0), DVec3::new(1.0, 0.0, 5.0), DVec3::new(0.0, 1.0, 5.0)];
    for distance in [1e2, 1e4, 1e6, 1e7, 1e9, 1e12] {
        let from = DVec3::new(0.2, 0.3, 5.0 - distance);
        let expected = 0.5 / (distance * distance);
        let mut sum = DVec3::ZERO;
        let n = 1024;
        for i in 0..n {
            let s = sample_triangle_direction(from, corners, Sequence::new(38, Stage::Test, 0, i).pair())
                .expect("seen");
            assert!(
                (s.pdf * expected - 1.0).abs() < 3.0 / distance + 1e-9,
                "{distance}: {}",
                s.pdf * expected
            );
            sum += (s.dir / s.dir.z) * distance + from;
        }
        let mean = sum / f64::from(n) - DVec3::new(1.0 / 3.0, 1.0 / 3.0, 5.0);
        // Rounding of directions and of their sums moves points by distance·ε.
        let rounding = distance * 64.0 * f64::EPSILON;
        assert!(mean.truncate().length() < 2e-3 + rounding, "{distance}: {mean}");
    }
}

#[test]
fn shapes_that_cannot_be_seen_give_no_directions() {
    let u = [0.3, 0.6];
    assert_eq!(Shape::Quad(Quad::new([1.0, 1.0])).sample_direction(DVec3::X * 2.0, u), None, "edge-on");
    assert_eq!(Shape::Quad(Quad::new([0.0, 1.0])).sample_direction(DVec3::Y, u), None, "no area");
    assert_eq!(Shape::Disk(Disk::new(1.0, 0.0)).sample_direction(DVec3::ZERO, u), None, "in the plane");
    assert_eq!(Shape::Sphere(Sphere::new(0.0, DVec3::X)).sample_direction(DVec3::ZERO, u), None, "a point");
    let corners = [DVec3::X, DVec3::Y, DVec3::Z];
    assert_eq!(sample_triangle_direction(DVec3::X, corners, u), None, "at a corner");
    assert_eq!(sample_triangle_direction(DVec3::ZERO, [DVec3::X; 3], u), None, "degenerate");
    assert_eq!(triangle_direction_pdf(DVec3::ZERO, corners, -DVec3::ONE.normalize()), 0.0, "behind");
}
