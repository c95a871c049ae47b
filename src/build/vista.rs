//! What a pinhole camera can see where, for scenes of few objects: which of them a ray through a pixel may
//! meet, without a test of their bounds.
//!
//! A column of pixels is a wedge between two planes through the eye, and so is a row. Each holds the set of the
//! objects whose bounds reach into it; a pixel's are those of both. This is the vista buffer of Weghorst, Hooper
//! & Greenberg 1984 (Improved Computational Methods for Ray Tracing, TOG 3(1)), with bounds instead of shapes.

use super::world::{Hit, World};
use crate::math::{Aabb, DVec2, DVec3, Ray};
use crate::optics::Camera;

/// Objects at most: bits of a set.
const FEW: usize = 64;

/// The objects in front of a camera, by pixel.
#[derive(Clone, Debug)]
pub struct Vista {
    /// The nearest bounds first, each with its least distance; bit i of a set stands for the i-th.
    instances: Vec<(u32, f64)>,
    columns: Vec<u64>,
    rows: Vec<u64>,
}

/// A corner seen from the eye: along the view, to the right, up.
type Corner = [f64; 3];

impl Vista {
    /// `bounds` are the instances'. `None` where they are too many, or the camera has a lens.
    pub(super) fn new(camera: &Camera, bounds: &[Aabb]) -> Option<Vista> {
        let eye = camera.eye;
        let mut near: Vec<(u32, f64)> = (0u32..)
            .zip(bounds)
            .filter(|(_, b)| b.min.cmple(b.max).all())
            .map(|(i, b)| (i, eye.clamp(b.min.as_dvec3(), b.max.as_dvec3()).distance(eye) * (1.0 - 1e-9)))
            .collect();
        if near.len() > FEW || camera.lens_radius > 0.0 || !eye.is_finite() {
            return None;
        }
        near.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        let [mut columns, mut rows] = [camera.width, camera.height].map(|n| vec![0; n as usize]);
        for (bit, &(i, _)) in near.iter().enumerate() {
            let corners = corners(camera, &bounds[i as usize]);
            mark(&mut columns, 1 << bit, camera.pixel, &corners.map(|[along, right, _]| [along, right]));
            // Rows are counted from the top.
            mark(&mut rows, 1 << bit, camera.pixel, &corners.map(|[along, _, up]| [along, -up]));
        }
        Some(Vista { instances: near, columns, rows })
    }

    #[inline]
    fn through(&self, film: DVec2) -> Candidates {
        let of = |sets: &[u64], x: f64| sets[(x as usize).min(sets.len() - 1)];
        Candidates(of(&self.columns, film.x) & of(&self.rows, film.y))
    }
}

/// What the camera's rays through a pixel may meet.
#[derive(Clone, Copy, Debug)]
pub struct Candidates(u64);

/// The corners of bounds with room for the rounding that they and rays are subject to.
fn corners(camera: &Camera, bounds: &Aabb) -> [Corner; 8] {
    let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let size = (camera.eye.abs() + min.abs().max(max.abs())).max_element();
    let room = size * 16.0 * f64::from(f32::EPSILON);
    let (min, max) = (min - camera.eye - room, max - camera.eye + room);
    std::array::from_fn(|i| {
        let pick = |bit: usize, lo: f64, hi: f64| if i & bit == 0 { lo } else { hi };
        let p = DVec3::new(pick(1, min.x, max.x), pick(2, min.y, max.y), pick(4, min.z, max.z));
        [camera.forward, camera.right, camera.up].map(|axis| axis.dot(p))
    })
}

/// Sets a bit in all strips of pixels, by their order across the film, whose wedge the corners' hull may reach
/// into: neither are all corners before its first plane, nor all behind its second one, nor all behind the eye.
fn mark(strips: &mut [u64], bit: u64, pixel: f64, corners: &[[f64; 2]; 8]) {
    if corners.iter().all(|&[along, _]| along < 0.0) {
        return;
    }
    let middle = 0.5 * strips.len() as f64;
    // Wider than the rounding of a place on the film.
    let plane = |edge: f64| (edge - middle) * pixel;
    for (i, set) in strips.iter_mut().enumerate() {
        let (first, second) = (plane(i as f64 - 1e-3), plane(i as f64 + 1.001));
        let before = corners.iter().all(|&[along, across]| across < first * along);
        let behind = corners.iter().all(|&[along, across]| across > second * along);
        if !before && !behind {
            *set |= bit;
        }
    }
}

impl World {
    /// What may be met through the pixel of a place on the film, in pixels from the top left corner.
    #[inline]
    pub fn before_eye(&self, film: DVec2) -> Candidates {
        self.vista.as_ref().map_or(Candidates(u64::MAX), |vista| vista.through(film))
    }

    /// The nearest hit of a ray of the camera through a pixel with these candidates.
    #[inline]
    pub fn nearest_from_eye(&self, ray: &Ray, candidates: Candidates) -> Option<Hit> {
        let Some(vista) = &self.vista else { return self.nearest(ray, f64::INFINITY) };
        let Candidates(mut left) = candidates;
        let mut best = Hit { t: f64::INFINITY, instance: 0, primitive: 0, b: [0.0; 3] };
        let mut met = false;
        while left != 0 {
            let (instance, near) = vista.instances[left.trailing_zeros() as usize];
            left &= left - 1;
            if best.t < near {
                break;
            }
            met |= self.nearer(instance, ray, &mut best);
        }
        met.then_some(best)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::{Counter, Stage};

    /// Of boxes of all sizes, before, beside, behind and around the eye, every one that a pixel's ray meets is in
    /// the pixel's set.
    #[test]
    fn everything_behind_a_pixel_is_listed_there() {
        let mut random = Counter::new(9, Stage::Test, 0);
        let mut value = || random.value();
        let mut alone = 0;
        for round in 0..200 {
            let scale = [1e-3, 1.0, 1e3][round % 3];
            let mut vector = |scale: f64| DVec3::from([(); 3].map(|()| (value() - 0.5) * scale));
            let (eye, forward) = (vector(4.0 * scale), vector(1.0).normalize());
            let right = forward.cross(DVec3::new(0.3, 1.0, 0.2)).normalize();
            let boxes: Vec<Aabb> = (0..FEW)
                .map(|i| {
                    let (middle, half) = (vector(4.0 * scale), vector([0.1, 1.0, 4.0][i % 3] * scale).abs());
                    Aabb::from_f64(middle - half, middle + half)
                })
                .collect();
            let (width, height) = (40, 30);
            let pixel = [0.01, 0.1][round % 2];
            let up = right.cross(forward);
            let camera =
                Camera { eye, right, up, forward, pixel, lens_radius: 0.0, focus: 1.0, width, height };
            let vista = Vista::new(&camera, &boxes).expect("few");
            for _ in 0..500 {
                let share = 0.5 + vector(1.0);
                // Corners of pixels, too.
                let film = DVec2::new(share.x * f64::from(width), share.y * f64::from(height));
                let film = if share.z < 0.3 { film.floor() } else { film };
                let dir = camera.ray(film).dir;
                let Candidates(set) = vista.through(film);
                for (bit, &(i, near)) in vista.instances.iter().enumerate() {
                    let (min, max) = (boxes[i as usize].min.as_dvec3(), boxes[i as usize].max.as_dvec3());
                    let (a, b) = ((min - eye) / dir, (max - eye) / dir);
                    let (enter, exit) = (a.min(b).max_element().max(0.0), a.max(b).min_element());
                    if enter < exit {
                        assert!(set >> bit & 1 == 1 && enter >= near, "round {round}, box {i}, at {film}");
                    }
                }
                alone += u32::from(set.count_ones() < 32);
            }
        }
        assert!(alone > 0, "every pixel lists nearly everything");
    }

    /// The same answers as the tree's, for rays all over a picture of every shape.
    #[test]
    fn the_eye_sees_what_the_tree_finds() {
        let world = crate::build::sights::tests::few_objects();
        assert!(world.vista.is_some());
        let mut random = Counter::new(8, Stage::Test, 0);
        let mut met = [0; 6];
        for _ in 0..20_000 {
            let film = DVec2::new(32.0 * random.value(), 24.0 * random.value());
            let ray = world.camera.ray(film);
            let hit = world.nearest(&ray, f64::INFINITY);
            assert_eq!(world.nearest_from_eye(&ray, world.before_eye(film)), hit);
            if let Some(hit) = hit {
                met[hit.instance as usize] += 1;
            }
        }
        assert!(met.iter().all(|&n| n > 100), "{met:?}");
    }
}
