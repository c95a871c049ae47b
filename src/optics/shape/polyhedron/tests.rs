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
