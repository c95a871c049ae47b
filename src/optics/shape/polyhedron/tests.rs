//! Regular solids against their known measures.

use super::*;
use crate::math::robust::UNIT;

const SOLIDS: [Solid; 5] =
    [Solid::Tetrahedron, Solid::Cube, Solid::Octahedron, Solid::Dodecahedron, Solid::Icosahedron];

#[test]
fn polyhedra_stand_on_a_face_with_their_corners_at_the_radius() {
    for (kind, faces) in SOLIDS.into_iter().zip([4, 6, 8, 12, 20]) {
        let p = Polyhedron::new(kind, 2.5);
        assert_eq!(p.faces.len(), faces);
        assert!(p.faces[0].normal.distance(DVec3::NEG_Y) < 8.0 * UNIT);
        for corner in p.triangles.iter().flat_map(|(t, _)| t) {
            assert!((corner.length() - 2.5).abs() < 1e-14);
        }
        for (triangle, face) in &p.triangles {
            let n = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).normalize();
            assert!(n.distance(p.faces[*face as usize].normal) < 1e-14, "{kind:?}: wound outwards");
        }
        // The lowest points are a whole face.
        let low = p.bounds().0.y;
        let down = Ray { origin: DVec3::new(0.1, -9.0, 0.1), dir: DVec3::Y };
        let hit = p.nearest(&down, 0.0, 9.0).expect("stands above");
        assert!((hit.t - 9.0 - low).abs() < 1e-13 && hit.face == 0, "{kind:?}");
    }
}

/// Face by face, and four faces at a time: the same bits, also of rays through edges, along faces and from inside.
#[test]
fn the_planes_of_a_solid_are_met_as_one_by_one() {
    use crate::math::random::{Counter, Stage};
    use crate::optics::shape::span::Span;
    let mut random = Counter::new(31, Stage::Test, 0);
    let mut point = |size: f64| {
        let [x, y] = random.pair();
        DVec3::new(x - 0.5, y - 0.5, random.value() - 0.5) * size
    };
    for kind in SOLIDS {
        let p = Polyhedron::new(kind, 1.5);
        let corners: Vec<DVec3> = p.triangles.iter().flat_map(|(t, _)| *t).collect();
        let (mut inside, mut missed) = (0, 0);
        for i in 0..20_000 {
            let corner = corners[i % corners.len()];
            let other = corners[(i / 7) % corners.len()];
            let ray = match i % 5 {
                0 => Ray { origin: point(4.0), dir: point(1.0) },
                1 => Ray { origin: point(0.5), dir: point(1.0) },
                2 => Ray { origin: point(6.0), dir: corner },
                3 => Ray { origin: corner, dir: other - corner },
                _ => Ray { origin: p.faces[i % p.faces.len()].normal * p.inradius, dir: other - corner },
            };
            let one_by_one = p.faces.iter().enumerate().try_fold(Span::LINE, |span, (number, face)| {
                let height = ray.origin.dot(face.normal) - p.inradius;
                span.clip(height, ray.dir.dot(face.normal), number as u32)
            });
            let found = p.planes.span(&ray);
            let bits =
                |span: Option<Span>| span.map(|s| [s.enter, s.exit].map(|hit| (hit.t.to_bits(), hit.face)));
            assert_eq!(bits(found), bits(one_by_one), "{kind:?}: {ray:?}");
            missed += u32::from(found.is_none());
            let from = ray.origin;
            if p.inside(from) {
                inside += 1;
                let mut depths: Vec<f64> =
                    p.faces.iter().map(|face| p.inradius - from.dot(face.normal)).collect();
                depths.sort_by(f64::total_cmp);
                assert_eq!(p.clearance(from), depths[1], "{kind:?}: {from}");
            }
        }
        assert!(inside > 1000 && missed > 1000, "{inside} {missed}");
    }
}
