//! Shapes under rays that are none.

use crate::hard_cases::solids::solids;
use terrarium::math::{DVec3, Ray};
use terrarium::optics::{Quad, Shape};

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
