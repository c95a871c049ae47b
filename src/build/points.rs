//! Lamps without an extent that lie exactly on a face of glass.
//!
//! Whether such a lamp is inside or outside, rounding would decide, for each ray anew. Like lamps with an extent that
//! are flush with glass it is outside: it is moved off the face by a few times the error within which that is known.

use super::contact::BAND;
use super::world::World;
use crate::math::{DVec3, Ray};
use crate::optics::EmitterKind;

/// A lamp on an edge, or where two media touch, is moved off one face after the other.
const FACES: i32 = 4;

/// No plane is parallel to all of these, nor close to it.
const DIRECTIONS: [DVec3; 6] = [
    DVec3::X,
    DVec3::Y,
    DVec3::Z,
    DVec3::new(0.48, 0.6, 0.64),
    DVec3::new(-0.64, 0.48, 0.6),
    DVec3::new(0.6, -0.64, 0.48),
];

impl World {
    /// Moves point and spot lamps off the faces of glass. Whether there are such.
    pub(super) fn move_points_off_faces(&mut self) -> bool {
        let mut emitters = std::mem::take(&mut self.emitters);
        let mut moved = false;
        for emitter in &mut emitters {
            if let EmitterKind::Point { position, .. } | EmitterKind::Spot { position, .. } =
                &mut emitter.kind
            {
                let off = self.off_faces(*position);
                moved |= off != *position;
                *position = off;
            }
        }
        self.emitters = emitters;
        moved
    }

    fn off_faces(&self, mut p: DVec3) -> DVec3 {
        for n in 0..FACES {
            let Some((ng, reach)) = self.face_at(p) else { break };
            // Twice as far each time: between two faces that look at each other it ends beside both.
            p += ng * (reach * f64::from(2 << n));
        }
        p
    }

    /// The outward normal of a face of glass at a point, of what counts most there, and within how many metres it does.
    fn face_at(&self, p: DVec3) -> Option<(DVec3, f64)> {
        self.media.iter().rev().find_map(|medium| {
            let reach = BAND * (medium.error + 4.0 * f64::EPSILON * p.abs().element_sum());
            let met = |dir: DVec3| {
                let probe = Ray { origin: p - dir * reach, dir };
                let hit = self.nearest_of(medium.instance, &probe, 2.0 * reach)?;
                Some((self.surface(&probe, &hit).ng, reach))
            };
            if medium.bounds.near(p, reach) { DIRECTIONS.into_iter().find_map(met) } else { None }
        })
    }
}
