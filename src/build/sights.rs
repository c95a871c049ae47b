//! What rays meet that start on a surface, or end in a lamp's point: in scenes of a handful of objects, those
//! that lie in their direction (see [`Sight`]), in others whatever the tree finds.

use super::sight::{FEW, Left, Sight};
use super::world::{Geometry, Hit, Instance, World};
use crate::math::{Aabb, DVec3, Ray};
use crate::optics::{Emitter, EmitterKind};

/// Where a ray starts that goes on from a surface.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    pub instance: u32,
    /// Whether it leaves the outer side; of a flat shape, either side may count as that.
    pub outside: bool,
}

/// The sights of a scene of few objects; none of others.
#[derive(Clone, Debug, Default)]
pub struct Sights {
    /// By emitter, what lies around those without an extent.
    lamps: Vec<Option<Sight<64>>>,
    /// By instance, what lies around its bounds.
    surfaces: Vec<Option<Sight<16>>>,
}

impl Sights {
    /// `bounds` are the instances'; what can neither be seen nor felt has empty ones, but is somewhere `placed`.
    pub(super) fn new(
        instances: &[Instance],
        geometries: &[Geometry],
        bounds: &[Aabb],
        placed: &[Aabb],
        emitters: &[Emitter],
    ) -> Sights {
        if bounds.iter().filter(|b| b.min.cmple(b.max).all()).count() > FEW {
            return Sights::default();
        }
        let lamps = emitters.iter().map(|emitter| match emitter.kind {
            EmitterKind::Point { position, .. } | EmitterKind::Spot { position, .. } => {
                Sight::new([position; 2], instances, geometries, bounds)
            }
            _ => None,
        });
        let surfaces = placed.iter().map(|b| {
            let corners: [DVec3; 2] = [b.min.as_dvec3(), b.max.as_dvec3()];
            Sight::new(corners, instances, geometries, bounds)
        });
        Sights { lamps: lamps.collect(), surfaces: surfaces.collect() }
    }

    pub fn memory_bytes(&self) -> usize {
        self.lamps.iter().flatten().map(Sight::memory_bytes).sum::<usize>()
            + self.surfaces.iter().flatten().map(Sight::memory_bytes).sum::<usize>()
    }

    fn around(&self, instance: u32) -> Option<&Sight<16>> {
        self.surfaces.get(instance as usize)?.as_ref()
    }
}

impl World {
    /// The nearest hit with 0 < t < t_max of a ray of unit direction that starts on a surface.
    #[inline]
    pub fn nearest_from(&self, start: Start, ray: &Ray, t_max: f64) -> Option<Hit> {
        let Some(sight) = self.sights.around(start.instance) else { return self.nearest(ray, t_max) };
        let mut left = sight.towards(ray.dir);
        if start.outside {
            left = sight.but(left, start.instance);
        }
        self.nearest_among(sight, left, ray, t_max)
    }

    /// The nearest hit with 0 < t < t_max of a ray of unit direction that an emitter sends, by its index.
    #[inline]
    pub fn nearest_from_emitter(&self, emitter: u32, ray: &Ray, t_max: f64) -> Option<Hit> {
        match self.emitters[emitter as usize].kind {
            EmitterKind::Point { .. } | EmitterKind::Spot { .. } => {
                let Some(Some(sight)) = self.sights.lamps.get(emitter as usize) else {
                    return self.nearest(ray, t_max);
                };
                self.nearest_among(sight, sight.towards(ray.dir), ray, t_max)
            }
            EmitterKind::Shape { instance } | EmitterKind::Mesh { instance, .. } => {
                self.nearest_from(Start { instance, outside: false }, ray, t_max)
            }
            EmitterKind::Directional { .. } | EmitterKind::Environment => self.nearest(ray, t_max),
        }
    }

    #[inline]
    fn nearest_among<const SIDE: usize>(
        &self,
        sight: &Sight<SIDE>,
        mut left: Left,
        ray: &Ray,
        t_max: f64,
    ) -> Option<Hit> {
        let mut best = Hit { t: t_max, instance: 0, primitive: 0, b: [0.0; 3] };
        let mut met = false;
        while let Some((instance, near)) = sight.next(&mut left) {
            if best.t < near {
                break;
            }
            met |= self.nearer(instance, ray, &mut best);
        }
        met.then_some(best)
    }

    /// Whether anything but `except` lies on a ray that starts on a surface, at 0 < t < t_max. The direction may
    /// be of any length.
    #[inline]
    pub fn occluded_from(&self, start: Start, ray: &Ray, t_max: f64, except: Option<u32>) -> bool {
        let Some(sight) = self.sights.around(start.instance) else {
            return self.occluded(ray, t_max, except);
        };
        let mut left = sight.towards(ray.dir);
        if start.outside {
            left = sight.but(left, start.instance);
        }
        while let Some((instance, _)) = sight.next(&mut left) {
            if except != Some(instance) && self.hides(instance, ray, t_max) {
                return true;
            }
        }
        false
    }

    /// Whether anything lies on the way of a ray at 0 < t < 1 that ends in the position of an emitter, by its
    /// index; the ray may start off the surface. `None` if the emitter has an extent, or objects are many.
    #[inline]
    pub fn hidden_from(&self, emitter: usize, start: Start, ray: &Ray) -> Option<bool> {
        let sight = self.sights.lamps.get(emitter)?.as_ref()?;
        let mut left = sight.towards(-ray.dir);
        if start.outside {
            left = sight.but(left, start.instance);
        }
        while let Some((instance, _)) = sight.next(&mut left) {
            if self.hides(instance, ray, 1.0) {
                return Some(true);
            }
        }
        Some(false)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::math::random::{Counter, Stage};

    /// A world of every shape, with a lamp in its midst. No two surfaces coincide.
    pub fn few_objects() -> World {
        let text = r#"(camera: (eye: (0.3, 1.5, 4), target: (0, 0.4, 0)), image: (width: 32, height: 24),
            materials: { "m": (diffuse: 0.5), "glass": (transmission: 1) },
            lights: { "lamp": point(position: (-1, 2, 1), intensity: 1) },
            objects: [(shape: quad(size: (9, 9)), material: "m"), (shape: sphere(radius: 0.5, center: (-0.6, 0.5, 0)), material: "glass"),
                (shape: box(size: (1, 1, 1), center: (0, 0.51, 0)), material: "m", transform: [rotate(axis: (0, 1, 0), deg: 30), translate((1.4, 0, -1))]),
                (shape: cone(radius: 0.4, height: 1.2, caps: false), material: "m", transform: [translate((0.6, 0.01, 0.4))]),
                (shape: polyhedron(kind: icosahedron, radius: 0.3), material: "glass", transform: [translate((-1, 0.5, 1))]),
                (shape: disk(radius: 0.7), material: "m", transform: [rotate(axis: (1, 0, 0), deg: 70), translate((0, 1.6, -1))])])"#;
        let format = crate::description::Format::Ron;
        let scene =
            crate::description::load_str(text, format, std::path::Path::new(""), &[]).expect("valid").scene;
        let plan = crate::plan::Plan::new(&scene, &Default::default()).expect("nothing is overridden");
        crate::build::build(&scene, &plan).expect("it can be built").world
    }

    /// The same answers as the tree's, for rays all over a scene of every shape, lit from within it: on their way to
    /// the lamp, and on in any direction from what they have met, inside and outside of it.
    #[test]
    fn what_lies_around_is_what_the_tree_finds() {
        let world = few_objects();
        let EmitterKind::Point { position, .. } = world.emitters[0].kind else { unreachable!() };
        let mut random = Counter::new(8, Stage::Test, 0);
        let (mut met, mut hidden, mut on, mut within) = (0, 0, 0, 0);
        for _ in 0..20_000 {
            let [x, y, z] = [(); 3].map(|()| random.value());
            let aim = DVec3::new(5.0 * x - 2.5, 2.0 * y - 0.4, 4.0 * z - 2.5);
            let ray = Ray { origin: world.camera.eye, dir: (aim - world.camera.eye).normalize() };
            let Some(hit) = world.nearest(&ray, f64::INFINITY) else { continue };
            met += 1;
            let surface = world.surface(&ray, &hit);
            let side = if ray.dir.dot(surface.ng) < 0.0 { 1.0 } else { -1.0 };
            let origin = surface.p + surface.ng * (side * surface.p_error);
            let shadow = Ray { origin, dir: position - origin };
            let outside = side > 0.0 && shadow.dir.dot(surface.ng) > 0.0;
            let expected = world.occluded(&shadow, 1.0, None);
            let start = Start { instance: surface.instance, outside };
            assert_eq!(world.hidden_from(0, start, &shadow), Some(expected));
            assert_eq!(world.occluded_from(start, &shadow, 1.0, None), expected);
            hidden += u32::from(expected);
            let dir = crate::math::sampling::sphere([random.value(), random.value()]);
            let (start, away) =
                (surface.start(dir), Ray::leaving(surface.p, surface.p_error, surface.ng, dir));
            let expected = world.nearest(&away, f64::INFINITY);
            assert_eq!(world.nearest_from(start, &away, f64::INFINITY), expected, "{start:?} {away:?}");
            on += u32::from(expected.is_some());
            within += u32::from(expected.is_some_and(|hit| hit.instance == start.instance));
        }
        assert!(met > 5_000 && hidden > 200 && hidden < met, "{met} met, {hidden} hidden");
        assert!(on > 1_000 && within > 100 && on < met, "{met} met, {on} met more, {within} the same again");
    }
}
