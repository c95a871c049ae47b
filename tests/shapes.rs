//! Rays and shapes where rounding hurts: extreme sizes and distances, faces met edge-on, placements of
//! every kind, and light from spheres and squares against its closed forms.

use std::f64::consts::{FRAC_PI_2, PI};
use terrarium::math::random::{Counter, Sequence, Stage};
use terrarium::math::{DAffine3, DMat3, DVec3, Frame, Placement, Ray, robust, sampling};
use terrarium::optics::{Cone, Cuboid, Disk, LocalSurface, Polyhedron, Quad, Shape, Solid, Sphere};

fn unit(counter: &mut Counter) -> DVec3 {
    sampling::sphere(counter.pair())
}

/// All closed shapes, `size` times as large as about 1; cones of many proportions.
fn solids(size: f64) -> Vec<Shape> {
    let at = DVec3::new(0.3, -0.2, 0.1) * size;
    let mut list = vec![
        Shape::Sphere(Sphere::new(0.8 * size, at)),
        Shape::Cuboid(Cuboid::new(DVec3::new(1.1, 0.7, 0.4) * size, at)),
    ];
    for (a, b, h) in [(0.5, 0.5, 1.0), (1.0, 0.0, 1.0), (0.0, 0.6, 2.0), (0.3, 0.9, 0.2), (1.0, 0.999, 0.01)]
    {
        list.push(Shape::Cone(Cone::new(a * size, b * size, h * size, true)));
    }
    let kinds = [Solid::Tetrahedron, Solid::Cube, Solid::Octahedron, Solid::Dodecahedron, Solid::Icosahedron];
    list.extend(kinds.map(|kind| Shape::Polyhedron(Polyhedron::new(kind, size))));
    list
}

/// A ray from around the shape to a place in its bounds; every eighth from within.
fn ray_at(shape: &Shape, distance: f64, counter: &mut Counter) -> Ray {
    let (min, max) = shape.bounds();
    let within = min + (max - min) * DVec3::new(counter.value(), counter.value(), counter.value());
    let away = if counter.bits().is_multiple_of(8) { 0.0 } else { distance * (max - min).length() };
    let dir = unit(counter) * libm::pow(10.0, 4.0 * counter.value() - 2.0);
    Ray { origin: within - dir.normalize() * away, dir }
}

/// Crossings by restarting behind each hit.
fn crossings(shape: &Shape, ray: &Ray) -> Vec<f64> {
    let mut list = vec![];
    let mut t_min = f64::NEG_INFINITY;
    while let Some(hit) = shape.nearest(ray, t_min, f64::INFINITY) {
        list.push(hit.t);
        t_min = hit.t;
        assert!(list.len() < 4);
    }
    list
}

#[test]
fn lines_cross_closed_shapes_an_even_number_of_times() {
    even_crossings(4_000);
}

/// As above with 1.2e6 lines for each kind of shape and each size.
#[test]
#[ignore = "half a minute"]
fn a_million_lines_cross_each_closed_shape_an_even_number_of_times() {
    even_crossings(1_200_000);
}

fn even_crossings(lines: u32) {
    for size in [1e-4, 1.0, 1e4] {
        for shape in solids(size) {
            let mut counter = Counter::new(51, Stage::Test, 0);
            for i in 0..lines {
                let ray = if i % 4 == 0 {
                    // Through a rim, an edge or a corner, as nearly as can be said.
                    let corner =
                        shape.bounds().1 * DVec3::new(counter.value().round(), 1.0, counter.value().round());
                    let dir = unit(&mut counter);
                    Ray { origin: corner - dir * size, dir }
                } else {
                    ray_at(&shape, 3.0, &mut counter)
                };
                let list = crossings(&shape, &ray);
                assert!(list.is_empty() || list.len() == 2, "{shape:?} {ray:?}: {list:?}");
            }
        }
    }
}

/// Below 0 inside, above outside, 0 on the surface: definitions of the solids as comparisons.
fn inside(size: f64, index: usize, p: DVec3) -> Option<f64> {
    let q = p / size;
    let at = DVec3::new(0.3, -0.2, 0.1);
    let cone = |a: f64, b: f64, h: f64| {
        let r = a + (b - a) * q.y / h;
        ((q.x * q.x + q.z * q.z).sqrt() - r).max(-q.y).max(q.y - h)
    };
    Some(match index {
        0 => (q - at).length() - 0.8,
        1 => ((q - at).abs() - DVec3::new(0.55, 0.35, 0.2)).max_element(),
        2 => cone(0.5, 0.5, 1.0),
        3 => cone(1.0, 0.0, 1.0),
        4 => cone(0.0, 0.6, 2.0),
        5 => cone(0.3, 0.9, 0.2),
        6 => cone(1.0, 0.999, 0.01),
        8 => q.abs().max_element() - 1.0 / 3f64.sqrt(),
        _ => return None,
    })
}

/// First change of sign along the ray, by steps and bisection, against the reported hit.
#[test]
fn hits_are_where_the_implicit_function_changes_its_sign() {
    for size in [1e-6, 1e-4, 1.0, 1e4, 1e6] {
        for (index, shape) in solids(size).iter().enumerate() {
            let mut counter = Counter::new(52, Stage::Test, 1);
            for _ in 0..400 {
                let mut ray = ray_at(shape, 1.5, &mut counter);
                ray.dir = ray.dir.normalize() * size;
                let Some(start) = inside(size, index, ray.origin) else { continue };
                let f = |t: f64| inside(size, index, ray.at(t)).expect("a definition");
                let hit = shape.nearest(&ray, 0.0, f64::INFINITY);
                let end = hit.map_or(12.0, |hit| hit.t);
                if let Some(hit) = hit {
                    let p = shape.surface(&ray, hit).p;
                    let there = inside(size, index, p).expect("a definition");
                    assert!(there.abs() < 1e-13, "{shape:?}: off by {there}");
                    assert!(p.distance(ray.at(hit.t)) < 1e-12 * size);
                    // The sign does change here, unless the ray only grazes.
                    let (before, after) = (f(end - 1e-6), f(end + 1e-6));
                    assert!(
                        before * after < 0.0 || before.abs().max(after.abs()) < 1e-5,
                        "{shape:?} {ray:?}"
                    );
                }
                for i in 0..200 {
                    let value = f(end * (f64::from(i) + 0.5) / 200.0);
                    assert!(
                        value * start > 0.0 || value.abs() < 1e-12,
                        "{shape:?} {ray:?}: missed a crossing"
                    );
                }
            }
        }
    }
}

#[test]
fn distant_spheres_keep_their_silhouette_and_their_normals() {
    let center = DVec3::new(0.0, 0.0, 0.0);
    let shape = Shape::Sphere(Sphere::new(1.0, center));
    let mut counter = Counter::new(53, Stage::Test, 0);
    for exponent in 2..=6 {
        let distance = libm::pow(10.0, f64::from(exponent));
        for _ in 0..2000 {
            let frame = Frame::around(unit(&mut counter));
            let around = frame.to_world(DVec3::new(libm::cos(1.0), libm::sin(1.0), 0.0));
            let line = |offset: f64| Ray { origin: frame.n * distance + around * offset, dir: -frame.n };
            let grazing = line(1.0 - 1e-6);
            let hit = shape.nearest(&grazing, 0.0, f64::INFINITY).expect("inside the silhouette");
            assert!(shape.nearest(&line(1.0 + 1e-6), 0.0, f64::INFINITY).is_none());
            let at = shape.surface(&grazing, hit);
            let rounding = 16.0 * f64::EPSILON * (distance + 1.0);
            assert!((at.p.length() - 1.0).abs() <= 16.0 * f64::EPSILON);
            // Near the silhouette a sideways shift moves the hit along the sphere by its square root.
            assert!(at.p.distance(grazing.at(hit.t)) <= rounding * 1e3);
            let offset = counter.value();
            let ray = line(offset);
            let hit = shape.nearest(&ray, 0.0, f64::INFINITY).expect("hit");
            let exact = around * offset + frame.n * (1.0 - offset * offset).sqrt();
            let n = shape.surface(&ray, hit).ng;
            assert!(n.distance(exact) < 1e-6, "{distance} {offset}: {}", n.distance(exact));
        }
    }
}

/// A sphere of 1e6 m as the ground, the eye 1.7 m above it: the horizon dips by √(2h/r).
#[test]
fn horizon_of_a_huge_sphere_is_where_it_belongs_and_things_rest_on_it() {
    let ground = Shape::Sphere(Sphere::new(1e6, DVec3::new(0.0, -1e6, 0.0)));
    let sees = |dip: f64| {
        let dir = DVec3::new(libm::cos(dip), -libm::sin(dip), 0.0);
        ground.nearest(&Ray { origin: DVec3::Y * 1.7, dir }, 0.0, f64::INFINITY).is_some()
    };
    let horizon = (2.0 * 1.7 / 1e6f64).sqrt();
    assert!(sees(horizon * 1.0001) && !sees(horizon * 0.9999));
    // From under a ball of 1 m that rests on it, shadow rays meet the ball, not the ground.
    let ball = Shape::Sphere(Sphere::new(1.0, DVec3::Y));
    for x in [1e-3, 1e-2, 0.1] {
        let down = Ray { origin: DVec3::new(x, 1e-9, 0.0), dir: DVec3::NEG_Y };
        let at = ground.surface(&down, ground.nearest(&down, 0.0, f64::INFINITY).expect("ground"));
        let ray = Ray::leaving(at.p, at.p_error, at.ng, DVec3::Y);
        assert!(at.p_error < 2e-8);
        assert!(ground.nearest(&ray, 0.0, f64::INFINITY).is_none());
        assert!(ball.nearest(&ray, 0.0, f64::INFINITY).is_some(), "contact shadow at {x}");
    }
}

/// All signs of directions, zeros of both signs included, from below to above the box on each axis.
#[test]
fn axis_parallel_rays_meet_boxes_as_comparisons_say() {
    let cuboid = Shape::Cuboid(Cuboid::new(DVec3::splat(2.0), DVec3::ZERO));
    let components = [-1.0, -0.0, 0.0, 1.0];
    let places = [-2.0, -1.0, 0.25, 1.0, 2.0];
    let product = |list: &[f64]| -> Vec<DVec3> {
        let pairs = |a: f64| list.iter().flat_map(move |&b| list.iter().map(move |&c| DVec3::new(a, b, c)));
        list.iter().flat_map(|&a| pairs(a)).collect()
    };
    for dir in product(&components).into_iter().filter(|d| *d != DVec3::ZERO) {
        for origin in product(&places) {
            let hit = cuboid.nearest(&Ray { origin, dir }, 0.0, f64::INFINITY);
            // All coordinates are quarters, so that stepping by eighths is exact.
            let inside = |i: i32| (origin + dir * (f64::from(i) / 8.0)).abs().max_element() <= 1.0;
            let steps: Vec<i32> = (-64..=64).filter(|&i| inside(i)).collect();
            // The line's part in the closed box, if it is longer than a point.
            let span = steps.first().zip(steps.last()).filter(|(a, b)| a < b);
            let expected = span.and_then(|(&a, &b)| [a, b].into_iter().find(|&i| i > 0));
            assert_eq!(hit.map(|h| h.t), expected.map(|i| f64::from(i) / 8.0), "{origin} towards {dir}");
            let positive = cuboid.nearest(&Ray { origin, dir: dir + DVec3::ZERO }, 0.0, f64::INFINITY);
            assert_eq!(hit, positive, "signs of zeros");
        }
    }
}

fn random_placement(counter: &mut Counter) -> Placement {
    let axis = unit(counter);
    let scale = DVec3::from([0; 3].map(|_| libm::pow(10.0, 4.0 * counter.value() - 2.0)));
    let scale = if counter.value() < 0.5 { scale } else { scale * DVec3::new(-1.0, 1.0, 1.0) };
    let place = unit(counter) * libm::pow(10.0, 5.0 * counter.value());
    let turn = DMat3::from_axis_angle(axis, 6.0 * counter.value());
    let other = DMat3::from_axis_angle(unit(counter), 6.0 * counter.value());
    let m = turn * DMat3::from_diagonal(scale) * other;
    Placement::new(DAffine3::from_mat3_translation(m, place)).expect("invertible")
}

#[test]
fn rays_that_leave_a_convex_shape_never_meet_it_again() {
    let mut counter = Counter::new(54, Stage::Test, 0);
    let (mut tested, mut through) = (0, 0);
    for size in [1e-4, 1.0, 1e4] {
        for shape in solids(size) {
            for _ in 0..3000 {
                let placement = random_placement(&mut counter);
                let ray = ray_at(&shape, 3.0, &mut counter);
                let Some(hit) = shape.nearest(&ray, 0.0, f64::INFINITY) else { continue };
                let at = shape.surface(&ray, hit);
                let (p, n) = (placement.point(at.p), placement.normal(at.ng));
                let error = robust::placed_error(&placement, at.p, at.p_error);
                let slope = libm::pow(10.0, -17.0 * counter.value());
                let dir = (n.cross(unit(&mut counter)).normalize() + n * slope).normalize();
                let leaving = placement.local_ray(&Ray::leaving(p, error, n, dir));
                let again = shape.nearest(&leaving, 0.0, f64::INFINITY);
                if dir.dot(n) >= 0.0 {
                    assert_eq!(again, None, "{shape:?} {placement:?} {at:?} {dir}");
                    tested += 1;
                } else if dir.dot(n) < -1e-3 {
                    through += 1;
                }
                // And into it, steeply: out again on some other side.
                let inwards = placement.local_ray(&Ray::leaving(p, error, n, -n));
                let thick = placement.stretch() < 3.0 * placement.det().abs().cbrt();
                assert!(!thick || shape.nearest(&inwards, 0.0, f64::INFINITY).is_some(), "{shape:?} {at:?}");
            }
        }
    }
    assert!(tested > 50_000 && through == 0, "{tested} {through}");
}

#[test]
fn scaled_spheres_have_the_normals_of_ellipsoids_mirrored_or_not() {
    let shape = Shape::Sphere(Sphere::new(1.0, DVec3::ZERO));
    let mut counter = Counter::new(55, Stage::Test, 0);
    for scale in [DVec3::new(2.0, 1.0, 1.0), DVec3::new(-1.0, 1.0, 1.0), DVec3::new(0.1, -3.0, 20.0)] {
        let placement = Placement::new(DAffine3::from_scale(scale)).expect("invertible");
        for _ in 0..1000 {
            let from = unit(&mut counter) * 100.0;
            let target = unit(&mut counter) * scale * 0.5;
            let ray = Ray { origin: from, dir: (target - from).normalize() };
            let local = placement.local_ray(&ray);
            let hit = shape.nearest(&local, 0.0, f64::INFINITY).expect("aimed at it");
            let at = shape.surface(&local, hit);
            let p = ray.at(hit.t);
            assert!(placement.point(at.p).distance(p) < 1e-9, "t is the world's");
            let n = placement.normal(at.ng);
            assert!(n.distance((p / (scale * scale)).normalize()) < 1e-6);
            assert!(n.dot(ray.dir) < 0.0, "outwards");
        }
    }
    let twice = Placement::new(DAffine3::from_scale(DVec3::new(2.0, 1.0, 1.0))).expect("invertible");
    assert!(
        twice.normal(DVec3::new(1.0, 1.0, 0.0)).distance(DVec3::new(1.0, 2.0, 0.0) / 5f64.sqrt()) < 1e-15
    );
}

/// Irradiance at `from` with normal `n` from a shape of radiance 1, by sampled directions.
fn irradiance(shape: &Shape, from: DVec3, n: DVec3, samples: u32) -> f64 {
    let estimate = |i| {
        let u = Sequence::new(56, Stage::Test, 0, i).pair();
        let Some(s) = shape.sample_direction(from, u) else { return 0.0 };
        let hit = shape.nearest(&Ray { origin: from, dir: s.dir }, 0.0, f64::INFINITY);
        if hit.is_some() { s.dir.dot(n).max(0.0) / s.pdf } else { 0.0 }
    };
    (0..samples).map(estimate).sum::<f64>() / f64::from(samples)
}

/// A sphere wholly above the horizon gives π(r/d)²cosθ, whatever its size; from inside, π.
#[test]
fn sphere_lights_give_their_closed_form_irradiance_down_to_points() {
    for r in [0.9, 0.3, 1e-2, 1e-4, 1e-6, 1e-8] {
        for (d, theta) in [(2.0, 0.0), (2.0, 0.7), (3.0, 1.2)] {
            let axis = DVec3::new(libm::sin(theta), libm::cos(theta), 0.0);
            let shape = Shape::Sphere(Sphere::new(r, axis * d));
            let sine: f64 = r / d;
            if libm::asin(sine) + theta > FRAC_PI_2 {
                continue;
            }
            let exact = PI * sine * sine * libm::cos(theta);
            let got = irradiance(&shape, DVec3::ZERO, DVec3::Y, 4096);
            // Rounding of the directions to a ball seen under 2r/d makes some miss it.
            let tolerance = 2e-3 + 1e-15 / sine;
            assert!((got / exact - 1.0).abs() < tolerance, "r = {r}, d = {d}, θ = {theta}: {}", got / exact);
        }
    }
    let around = Shape::Sphere(Sphere::new(2.0, DVec3::new(0.3, 0.5, 0.1)));
    assert!((irradiance(&around, DVec3::ZERO, DVec3::Y, 4096) / PI - 1.0).abs() < 2e-3);
}

#[test]
fn a_square_light_gives_its_closed_form_irradiance_at_any_height() {
    let quad = Shape::Quad(Quad::new([1.0, 1.0]));
    // Centred square of edge 1 at height h: E = 4·(a/s)·atan(a/s) with a = ½ and s = √(h² + ¼).
    for h in [1e-12, 1e-6, 1e-3, 0.1, 1.0, 10.0, 1e3, 1e6] {
        let s: f64 = (h * h + 0.25f64).sqrt();
        let exact = 4.0 * (0.5 / s) * libm::atan(0.5 / s);
        let got = irradiance(&quad, DVec3::Y * h, DVec3::NEG_Y, 4096);
        assert!((got / exact - 1.0).abs() < 2e-3, "h = {h}: {got} for {exact}");
        assert!(got <= PI * (1.0 + 2e-3));
    }
    let at_one = irradiance(&quad, DVec3::Y, DVec3::NEG_Y, 65536);
    assert!((at_one - 0.752_274_7).abs() < 2e-4, "{at_one}");
}

/// Touching or coincident, no light of radiance 1 gives more than π.
#[test]
fn touching_lights_never_give_more_than_pi() {
    let lights = [
        Shape::Quad(Quad::new([1.0, 1.0])),
        Shape::Disk(Disk::new(1.0, 0.0)),
        Shape::Sphere(Sphere::new(1.0, DVec3::Y)),
        Shape::Cuboid(Cuboid::new(DVec3::ONE, DVec3::Y * 0.5)),
        Shape::Cone(Cone::new(1.0, 0.5, 1.0, true)),
        Shape::Polyhedron(Polyhedron::new(Solid::Dodecahedron, 1.0)),
    ];
    let mut counter = Counter::new(57, Stage::Test, 0);
    for light in lights {
        let bottom = light.bounds().0.y;
        for exponent in [0, -3, -9, -15, -300] {
            for _ in 0..16 {
                let below = libm::pow(10.0, f64::from(exponent));
                let from = DVec3::new(counter.value() - 0.5, bottom - below, counter.value() - 0.5);
                let e = irradiance(&light, from, DVec3::Y, 1024);
                assert!((0.0..=PI * 1.02).contains(&e), "{light:?} at {from}: {e}");
            }
        }
    }
}

fn is_usable(at: &LocalSurface) -> bool {
    let frame = Frame::with_tangent(at.ns, at.dpdu);
    let orthonormal = frame.s.dot(frame.n).abs() < 1e-12
        && (frame.s.length() - 1.0).abs() < 1e-12
        && frame.s.cross(frame.t).distance(frame.n) < 1e-12;
    at.p.is_finite() && at.uv.is_finite() && at.dpdu.is_finite() && at.dpdv.is_finite() && orthonormal
}

/// On the sphere's poles, seam and three coordinate circles, at cones' apexes and on all axes.
#[test]
fn frames_never_degenerate_on_axes_poles_and_seams() {
    let steps = [0.0, -0.0, 5e-324, 1e-300, 1e-160, 1e-17, 1e-9, 1.0];
    let signs = [-1.0, 1.0];
    for shape in solids(1.0).into_iter().chain([Shape::Sphere(Sphere::new(1.0, DVec3::ZERO))]) {
        let (min, max) = shape.bounds();
        let middle = 0.5 * (min + max);
        for (x, y, z) in steps.iter().flat_map(|&x| steps.iter().flat_map(move |&y| steps.map(|z| (x, y, z))))
        {
            for sign in signs
                .iter()
                .flat_map(|&x| signs.iter().flat_map(move |&y| signs.map(|z| DVec3::new(x, y, z))))
            {
                let Some(dir) = (DVec3::new(x, y, z) * sign).try_normalize() else { continue };
                let ray = Ray { origin: DVec3::new(0.0, middle.y, 0.0) - dir * 4.0, dir };
                if let Some(hit) = shape.nearest(&ray, 0.0, f64::INFINITY) {
                    let at = shape.surface(&ray, hit);
                    assert!(is_usable(&at), "{shape:?} {ray:?} {at:?}");
                    assert!((0.0..=1.0).contains(&at.uv.x) && (0.0..=1.0).contains(&at.uv.y), "{}", at.uv);
                }
            }
        }
    }
}

/// Not a number, infinite or of no length: no hit, no panic.
#[test]
fn rays_that_are_no_rays_hit_nothing() {
    let bad = [DVec3::NAN, DVec3::INFINITY, DVec3::ZERO];
    for shape in solids(1.0).into_iter().chain([Shape::Quad(Quad::new([1.0, 1.0]))]) {
        for dir in bad {
            let hit = shape.nearest(&Ray { origin: DVec3::new(0.1, 5.0, 0.1), dir }, 0.0, f64::INFINITY);
            assert_eq!(hit, None, "{shape:?} {dir}");
        }
        let hit = shape.nearest(&Ray { origin: DVec3::NAN, dir: DVec3::X }, 0.0, f64::INFINITY);
        assert_eq!(hit, None, "{shape:?}");
    }
}
