//! Closed shapes of all kinds and sizes, lines that cross them, and places for them to stand.

use terrarium::math::random::Counter;
use terrarium::math::{DAffine3, DMat3, DVec3, Placement, Ray, sampling};
use terrarium::optics::{Cone, Cuboid, Polyhedron, Shape, Solid, Sphere};

pub fn unit(counter: &mut Counter) -> DVec3 {
    sampling::sphere(counter.pair())
}

/// All closed shapes, `size` times as large as about 1; cones of many proportions.
pub fn solids(size: f64) -> Vec<Shape> {
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

/// Below 0 inside, above outside, 0 on the surface, as shares of the size: definitions of the solids as
/// comparisons.
pub fn inside(size: f64, index: usize, p: DVec3) -> Option<f64> {
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

/// A ray from around the shape to a place in its bounds; every eighth from within.
pub fn ray_at(shape: &Shape, distance: f64, counter: &mut Counter) -> Ray {
    let (min, max) = shape.bounds();
    let within = min + (max - min) * DVec3::new(counter.value(), counter.value(), counter.value());
    let away = if counter.bits().is_multiple_of(8) { 0.0 } else { distance * (max - min).length() };
    let dir = unit(counter) * libm::pow(10.0, 4.0 * counter.value() - 2.0);
    Ray { origin: within - dir.normalize() * away, dir }
}

/// Crossings by restarting behind each hit.
pub fn crossings(shape: &Shape, ray: &Ray) -> Vec<f64> {
    let mut list = vec![];
    let mut t_min = f64::NEG_INFINITY;
    while let Some(hit) = shape.nearest(ray, t_min, f64::INFINITY) {
        list.push(hit.t);
        t_min = hit.t;
        assert!(list.len() < 4);
    }
    list
}

/// Turned, scaled unevenly by up to a hundred each way, mirrored or not, up to 1e5 away.
pub fn random_placement(counter: &mut Counter) -> Placement {
    let axis = unit(counter);
    let scale = DVec3::from([0; 3].map(|_| libm::pow(10.0, 4.0 * counter.value() - 2.0)));
    let scale = if counter.value() < 0.5 { scale } else { scale * DVec3::new(-1.0, 1.0, 1.0) };
    let place = unit(counter) * libm::pow(10.0, 5.0 * counter.value());
    let turn = DMat3::from_axis_angle(axis, 6.0 * counter.value());
    let other = DMat3::from_axis_angle(unit(counter), 6.0 * counter.value());
    let m = turn * DMat3::from_diagonal(scale) * other;
    Placement::new(DAffine3::from_mat3_translation(m, place)).expect("invertible")
}
