//! Surfaces of meshes against closed forms, and rays that leave them.

use super::*;
use crate::math::DVec2;
use crate::math::Ray;
use crate::math::random::{Counter, Stage};
use crate::math::sampling;

fn triangle(positions: [[f32; 3]; 3]) -> TriangleMesh {
    TriangleMesh {
        positions: positions.map(Vec3::from).to_vec(),
        triangles: vec![[0, 1, 2]],
        ..Default::default()
    }
}

/// An octahedron of radius 1, subdivided: a sphere's mesh without and with its normals.
fn ball(subdivisions: u32) -> TriangleMesh {
    let signs =
        [(1, 1, 1), (-1, 1, 1), (-1, -1, 1), (1, -1, 1), (1, 1, -1), (-1, 1, -1), (-1, -1, -1), (1, -1, -1)];
    let mut faces: Vec<[Vec3; 3]> = vec![];
    for (x, y, z) in signs {
        let [a, b, c] = [Vec3::X * x as f32, Vec3::Y * y as f32, Vec3::Z * z as f32];
        faces.push(if x * y * z > 0 { [a, b, c] } else { [a, c, b] });
    }
    for _ in 0..subdivisions {
        let divide = |[a, b, c]: [Vec3; 3]| {
            let [d, e, f] = [(a + b).normalize(), (b + c).normalize(), (c + a).normalize()];
            [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
        };
        faces = faces.into_iter().flat_map(divide).collect();
    }
    let positions: Vec<Vec3> = faces.into_iter().flatten().collect();
    let triangles = (0..positions.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    TriangleMesh { normals: positions.clone(), positions, triangles, ..Default::default() }
}

/// The single-precision test that the error bound is made for (Woop, Benthin, Wald 2013): t, if hit.
fn woop(corners: [Vec3; 3], ray: &Ray) -> Option<f32> {
    let (o, d) = (ray.origin.as_vec3(), ray.dir.as_vec3());
    let kz = d.abs().to_array().iter().enumerate().fold(0, |k, (i, &v)| if v > d.abs()[k] { i } else { k });
    let (kx, ky) = ((kz + 1) % 3, (kz + 2) % 3);
    let (sx, sy, sz) = (d[kx] / d[kz], d[ky] / d[kz], 1.0 / d[kz]);
    let [a, b, c] = corners.map(|v| {
        let v = v - o;
        Vec3::new(v[kx] - sx * v[kz], v[ky] - sy * v[kz], sz * v[kz])
    });
    let (u, v, w) = (c.x * b.y - c.y * b.x, a.x * c.y - a.y * c.x, b.x * a.y - b.y * a.x);
    if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
        return None;
    }
    let det = u + v + w;
    let t = (u * a.z + v * b.z + w * c.z) / det;
    (t > 0.0).then_some(t)
}

/// Random triangles of any aspect, near and far from the origin; directions down to grazing.
#[test]
fn rays_that_leave_a_triangle_do_not_meet_it_again_in_single_precision() {
    let mut counter = Counter::new(41, Stage::Test, 0);
    for _ in 0..200_000 {
        let place = sampling::sphere(counter.pair()) * libm::pow(10.0, 5.0 * counter.value());
        let thin = libm::pow(10.0, -3.0 * counter.value());
        let along = sampling::sphere(counter.pair());
        let across = sampling::sphere(counter.pair()) * thin;
        let slide = counter.value();
        let corners = [place, place + along, place + along * slide + across];
        let mesh = triangle(corners.map(|c| c.as_vec3().to_array()));
        let [b0, b1, b2] = sampling::triangle(counter.pair()).map(|b| b as f32);
        let at = mesh.facet(0, [b0, b1, b2]).surface();
        let (e1, e2) = (mesh.corners(0)[1] - mesh.corners(0)[0], mesh.corners(0)[2] - mesh.corners(0)[0]);
        if e1.cross(e2).length() < 1e-9 * e1.length() * e2.length() {
            continue;
        }
        let slope = libm::pow(10.0, -8.0 * counter.value()) * if counter.value() < 0.5 { 1.0 } else { -1.0 };
        let tangent = at.ng.cross(sampling::sphere(counter.pair())).normalize();
        let dir = (tangent + at.ng * slope).normalize();
        let ray = Ray::leaving(at.p, at.p_error, at.ng, dir);
        let again = woop([0, 1, 2].map(|i| mesh.positions[i]), &ray);
        assert_eq!(again, None, "{corners:?} from {} by {} towards {dir}", at.p, at.p_error);
    }
}

#[test]
fn points_are_in_the_plane_of_their_triangle_and_normals_on_its_side() {
    let mut mesh = triangle([[1e3, 0.0, 0.0], [1e3, 1.0, 0.5], [1e3, 0.5, 2.0]]);
    mesh.normals = vec![Vec3::new(-1.0, 0.2, 0.0), Vec3::NEG_X * 7.0, Vec3::new(-1.0, 0.0, -0.3)];
    let mut counter = Counter::new(42, Stage::Test, 0);
    for _ in 0..1000 {
        let b = sampling::triangle(counter.pair()).map(|b| b as f32);
        let at = mesh.facet(0, b).surface();
        assert_eq!(at.p.x, 1e3);
        assert_eq!(at.ng, DVec3::X);
        assert!(at.ns.dot(at.ng) > 0.9 && (at.ns.length() - 1.0).abs() < 1e-15);
    }
}

#[test]
fn missing_normals_fall_back_to_the_geometric_one() {
    for bad in [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY] {
        let mut mesh = triangle([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        mesh.normals = vec![bad; 3];
        let at = mesh.facet(0, [0.2, 0.3, 0.5]).surface();
        assert_eq!(at.ns, DVec3::Z, "{bad}");
        assert_eq!(mesh.facet(0, [0.2, 0.3, 0.5]).shadow_terminator_point(true), at.p);
    }
    // Opposite normals cancel in the middle.
    let mut mesh = triangle([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    mesh.normals = vec![Vec3::Z, Vec3::NEG_Z, Vec3::NEG_Z];
    assert_eq!(mesh.facet(0, [0.5, 0.25, 0.25]).surface().ns, DVec3::Z);
}

#[test]
fn derivatives_follow_the_texture_coordinates_mirrored_and_degenerate_ones_too() {
    let mut mesh = triangle([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0]]);
    mesh.uvs = vec![Vec2::new(0.25, 0.5), Vec2::new(0.75, 0.5), Vec2::new(0.25, 1.5)];
    let at = mesh.facet(0, [0.5, 0.25, 0.25]).surface();
    assert_eq!((at.uv, at.dpdu, at.dpdv), (DVec2::new(0.375, 0.75), DVec3::X * 4.0, DVec3::Y * 3.0));
    mesh.uvs = vec![Vec2::new(0.0, 0.0), Vec2::new(-1.0, 0.0), Vec2::new(0.0, 1.0)];
    let at = mesh.facet(0, [0.5, 0.25, 0.25]).surface();
    assert_eq!((at.dpdu, at.dpdv), (DVec3::X * -2.0, DVec3::Y * 3.0));
    for line in [Vec2::ZERO, Vec2::ONE] {
        mesh.uvs = vec![line * 0.0, line * 0.5, line];
        let at = mesh.facet(0, [0.5, 0.25, 0.25]).surface();
        assert_eq!((at.dpdu, at.dpdv), (DVec3::ZERO, DVec3::ZERO));
    }
    mesh.uvs.clear();
    let at = mesh.facet(0, [0.5, 0.25, 0.125]).surface();
    assert_eq!((at.uv, at.dpdu, at.dpdv), (DVec2::new(0.25, 0.125), DVec3::X * 2.0, DVec3::Y * 3.0));
}

/// A cube's corner is met by one or two triangles of each face; its normal is the diagonal all the same.
#[test]
fn angle_weights_make_normals_independent_of_how_faces_are_divided() {
    let positions: Vec<Vec3> =
        (0..8).map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32)).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let mut triangles: Vec<[u32; 3]> =
        quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    triangles.push([0, 0, 7]);
    let normals = TriangleMesh::angle_weighted_normals(&positions, &triangles);
    for (p, n) in positions.iter().zip(&normals) {
        assert!(n.distance((*p - 0.5).normalize()) < 1e-6, "{p}: {n}");
    }
    let lonely = TriangleMesh::angle_weighted_normals(&[Vec3::X, Vec3::Y], &[[0, 1, 1]]);
    assert_eq!(lonely, [Vec3::ZERO; 2]);
    // Closed, though a degenerate triangle is in it; open by three edges without one triangle.
    let mut mesh = TriangleMesh { positions, triangles, ..Default::default() };
    assert_eq!(mesh.boundary_edges(), 0);
    mesh.triangles.remove(0);
    assert_eq!(mesh.boundary_edges(), 3);
}

#[test]
fn meshes_are_closed_where_vertices_are_doubled_and_where_zeros_differ_in_sign() {
    let mut mesh = ball(2);
    for p in mesh.positions.iter_mut().step_by(2) {
        *p = p.map(|c| if c == 0.0 { -0.0 } else { c });
    }
    assert_eq!(mesh.boundary_edges(), 0);
}

/// Lifted points of a ball are near the sphere that its normals describe, never below the triangle.
#[test]
fn shadow_rays_start_near_the_curved_surface() {
    let mut worst = [0.0f64; 2];
    for (w, subdivisions) in worst.iter_mut().zip([2, 3]) {
        let mesh = ball(subdivisions);
        let mut counter = Counter::new(43, Stage::Test, 0);
        for t in 0..mesh.triangles.len() as u32 {
            let b = sampling::triangle(counter.pair()).map(|b| b as f32);
            let at = mesh.facet(t, b).surface();
            let lifted = mesh.facet(t, b).shadow_terminator_point(true);
            assert!((lifted - at.p).dot(at.ng) >= -1e-12);
            assert!(lifted.length() < 1.0 + 0.1 * (1.0 - at.p.length()) + 1e-6);
            *w = w.max((lifted.length() - 1.0).abs());
            // From inside the ball the surface curves away.
            assert!(mesh.facet(t, b).shadow_terminator_point(false).distance(at.p) < 1e-6);
        }
    }
    assert!(worst[0] < 0.06 && worst[1] < worst[0] / 3.0, "{worst:?}");
}
