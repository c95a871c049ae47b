//! Emission of light from afar: parallel light through rectangles perpendicular to it, and the sky's
//! through the disks of the targets' balls.

use super::bounds::Bound;
use super::source::{Kind, Source, Start};
use crate::build::World;
use crate::math::{DVec2, DVec3, Frame, Ray, sampling};
use std::f64::consts::PI;

impl Source {
    /// Power: E·A. The photon starts beyond all that rays can meet.
    pub(super) fn through(&self, min: DVec2, max: DVec2, u: [f64; 2]) -> Option<Start> {
        let Kind::Parallel { frame, irradiance } = &self.kind else { return None };
        let size = max - min;
        let at = min + size * DVec2::from(u);
        let ray = self.ray_of_afar(frame, at);
        let power = *irradiance * (size.x * size.y);
        let media = self.media.unwrap_or_default();
        Some(self.start_within(ray, power, media))
    }

    /// Power: L/p(ω)·A/k, where `share` of the sky's sampling is this domain and k is the number of
    /// targets that the line meets, each of which would have found it.
    pub(super) fn sent_by_sky(
        &self,
        world: &World,
        targets: &[Bound],
        target: usize,
        square: [f64; 2],
        share: f64,
        u: [f64; 2],
    ) -> Option<Start> {
        let sample = world.environment.as_ref()?.sample(square)?;
        let Bound { center, radius, .. } = targets[target];
        let frame = Frame::around(sample.dir);
        let disk = sampling::disk(u) * radius;
        let in_plane = |p: DVec3| DVec2::new(frame.s.dot(p), frame.t.dot(p));
        let at = in_plane(center) + disk;
        let meets = |(i, other): (usize, &Bound)| {
            i == target || in_plane(other.center).distance_squared(at) < other.radius * other.radius
        };
        let met = targets.iter().enumerate().filter(|&t| meets(t)).count();
        let power = sample.radiance.as_dvec3() * (share * PI * radius * radius / (sample.pdf * met as f64));
        if power == DVec3::ZERO || !power.is_finite() {
            return None;
        }
        let media = self.media.unwrap_or_default();
        Some(self.start_within(self.ray_of_afar(&frame, at), power, media))
    }

    /// The ray against `frame.n` through a point of the plane perpendicular to it.
    fn ray_of_afar(&self, frame: &Frame, at: DVec2) -> Ray {
        let height = self.bound.most(frame.n) + 1e-6 * self.bound.radius;
        Ray { origin: frame.to_world(at.extend(height)), dir: -frame.n }
    }
}
