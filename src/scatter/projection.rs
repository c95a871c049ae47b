//! The projection map: the parts of each source's emission that can reach what photons are aimed at
//! (Jensen, Realistic Image Synthesis Using Photon Mapping, 2001, 5.2).
//!
//! Directions are the icosahedron's cells, halved where their beam holds the edge of a target, so that
//! few photons pass it by; parallel light is divided into rectangles in the same way; the sky by the
//! targets and by the square of its own sampling.

use super::bounds::{Beam, Bound, Reach};
use super::source::{Domain, Kind, Source};
use crate::build::World;
use crate::math::sampling::SphericalCell;
use crate::math::{DVec2, DVec3, Frame};

/// Cells are halved this often at least, so that the pilot can tell what each yields.
const COARSEST: u32 = 3;

/// Halvings after which a cell is left as it is: 4e-8 sr.
const DEEPEST: u32 = 24;

/// The domains of `source` from which a target can be reached, about `most` of them.
pub(super) fn domains(world: &World, source: &Source, targets: &[Bound], most: usize) -> Vec<Domain> {
    match &source.kind {
        Kind::Sky => sky(targets, most),
        Kind::Parallel { frame, .. } => {
            let shadows: Vec<Shadow> = targets.iter().map(|t| Shadow::new(t, frame)).collect();
            let root = shadows.iter().copied().reduce(|a, b| a.union(&b));
            let roots = root.map(|r| Area { min: r.min, max: r.max });
            let reach = |area: &Area, target: usize| shadows[target].reach(area);
            refined(roots, targets.len(), most, Area::halves, reach, |_| Reach::Whole)
                .into_iter()
                .map(|a| Domain::Rectangle { min: a.min, max: a.max })
                .collect()
        }
        _ => {
            let roots = SphericalCell::icosahedron().map(Beam::new);
            let halves = |beam: &Beam| beam.cell.halves().map(Beam::new);
            let reach = |beam: &Beam, target: usize| beam.reach(&source.bound, &targets[target]);
            refined(roots, targets.len(), most, halves, reach, |beam| lit(world, source, beam))
                .into_iter()
                .map(|beam| Domain::Directions(beam.cell))
                .collect()
        }
    }
}

/// A part with the targets that it may reach.
struct Candidate<T> {
    part: T,
    targets: Vec<u32>,
    divide: bool,
}

/// Halves parts, level by level, as long as that sets light apart from dark or reached from missed.
fn refined<T>(
    roots: impl IntoIterator<Item = T>,
    targets: usize,
    most: usize,
    halves: impl Fn(&T) -> [T; 2],
    reach: impl Fn(&T, usize) -> Reach,
    lit: impl Fn(&T) -> Reach,
) -> Vec<T> {
    let examine = |part: T, of: &[u32], depth: u32| -> Option<Candidate<T>> {
        let light = lit(&part);
        if light == Reach::Missed {
            return None;
        }
        let (mut reached, mut partly, mut whole) = (Vec::new(), false, false);
        for &target in of {
            let reach = reach(&part, target as usize);
            if reach != Reach::Missed {
                reached.push(target);
            }
            partly |= reach == Reach::Partly;
            whole |= reach == Reach::Whole;
        }
        let divide = depth < COARSEST || light == Reach::Partly || (partly && !whole);
        (!reached.is_empty()).then_some(Candidate { part, targets: reached, divide })
    };
    let all: Vec<u32> = (0..targets as u32).collect();
    let mut parts: Vec<_> = roots.into_iter().filter_map(|root| examine(root, &all, 0)).collect();
    for depth in 1..=DEEPEST {
        let divided = parts.iter().filter(|p| p.divide).count();
        if divided == 0 || parts.len() + divided > most {
            break;
        }
        let next = Vec::with_capacity(parts.len() + divided);
        parts = parts.into_iter().fold(next, |mut next, p| {
            if p.divide {
                next.extend(halves(&p.part).into_iter().filter_map(|half| examine(half, &p.targets, depth)));
            } else {
                next.push(p);
            }
            next
        });
    }
    parts.into_iter().map(|p| p.part).collect()
}

/// Whether a source sends light into a beam.
fn lit(world: &World, source: &Source, beam: &Beam) -> Reach {
    match &source.kind {
        Kind::Spot { axis, cos_outer, .. } => beam.overlap(*axis, *cos_outer),
        Kind::Quad { instance, .. } | Kind::Shape { instance } => {
            // A flat lamp sends nothing behind itself.
            let Some((normal, one_sided)) = flat(world, *instance) else { return Reach::Whole };
            let behind = beam.cell.corners().iter().all(|c| c.dot(normal) < -1e-12);
            if one_sided && behind { Reach::Missed } else { Reach::Whole }
        }
        _ => Reach::Whole,
    }
}

/// The normal of a placed quad or disk, and whether only its front emits.
pub(super) fn flat(world: &World, instance: u32) -> Option<(DVec3, bool)> {
    use crate::{build::Geometry, optics::Shape};
    let Geometry::Shape(Shape::Quad(_) | Shape::Disk(_)) = world.geometry(instance) else { return None };
    let placed = &world.instances[instance as usize];
    let id = world.bindings[placed.binding as usize][0];
    Some((placed.placement.unit_normal(DVec3::Y), !world.materials[id.0 as usize].emits_back))
}

/// For each target a grid of the square from which the sky is sampled.
fn sky(targets: &[Bound], most: usize) -> Vec<Domain> {
    let grid = ((most / targets.len().max(1)) as f64).sqrt().clamp(1.0, 16.0) as u32;
    let side = 1.0 / f64::from(grid);
    let squares = move |target| {
        (0..grid * grid).map(move |i| Domain::Sky {
            target,
            corner: [f64::from(i % grid) * side, f64::from(i / grid) * side],
            side,
        })
    };
    (0..targets.len() as u32).flat_map(squares).collect()
}

/// A rectangle of the plane perpendicular to parallel light.
#[derive(Clone, Copy)]
struct Area {
    min: DVec2,
    max: DVec2,
}

impl Area {
    fn halves(&self) -> [Area; 2] {
        let size = self.max - self.min;
        let middle = 0.5 * (self.min + self.max);
        let cut = if size.x > size.y {
            [DVec2::new(middle.x, self.max.y), DVec2::new(middle.x, self.min.y)]
        } else {
            [DVec2::new(self.max.x, middle.y), DVec2::new(self.min.x, middle.y)]
        };
        [Area { max: cut[0], ..*self }, Area { min: cut[1], ..*self }]
    }
}

/// A target's bounds along parallel light: a rectangle and a disk.
#[derive(Clone, Copy)]
struct Shadow {
    min: DVec2,
    max: DVec2,
    center: DVec2,
    radius: f64,
}

impl Shadow {
    fn new(target: &Bound, frame: &Frame) -> Shadow {
        let flat = |of: &dyn Fn(DVec3) -> f64| DVec2::new(of(frame.s), of(frame.t));
        Shadow {
            min: flat(&|n| target.least(n)),
            max: flat(&|n| target.most(n)),
            center: flat(&|n| target.center.dot(n)),
            radius: target.radius,
        }
    }

    fn union(&self, other: &Shadow) -> Shadow {
        Shadow { min: self.min.min(other.min), max: self.max.max(other.max), ..*self }
    }

    fn reach(&self, area: &Area) -> Reach {
        let nearest = self.center.clamp(area.min, area.max);
        let apart = nearest.distance_squared(self.center) > self.radius * self.radius;
        if apart || !(area.min.cmple(self.max).all() && self.min.cmple(area.max).all()) {
            return Reach::Missed;
        }
        let farthest = (area.min - self.center).abs().max((area.max - self.center).abs());
        let in_ball = farthest.length_squared() <= self.radius * self.radius;
        let in_box = self.min.cmple(area.min).all() && area.max.cmple(self.max).all();
        if in_ball && in_box {
            return Reach::Whole;
        }
        let fine = (area.max - area.min).max_element() < 0.25 * (self.max - self.min).min_element();
        if fine { Reach::Met } else { Reach::Partly }
    }
}
