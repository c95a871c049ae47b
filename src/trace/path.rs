//! Camera paths: from the eye through mirrors and interfaces to what is not specular.
//!
//! At a surface of reflection km and transmission kt (all from the outside in, so that no weights
//! gain energy), with Fresnel reflectance F:
//!
//! L = km·L_mirror + (1−km)·[ kt·(F·L_reflected + (1−F)·(n₁/n₂)²·L_refracted) + (1−kt)·L_shaded ] + highlight
//!
//! A branch of at least `Plan::split_weight` is always followed; a lighter one survives with
//! probability weight / split_weight and then weighs split_weight: unbiased, and no path ever has
//! more than about 1 / split_weight branches. (n₁/n₂)² is the compression of solid angle across an
//! interface (Veach 1997, 5.2).

use super::bounce;
use super::record::{Fate, InterfaceRecord, Recorder};
use super::sample::FirstHit;
use super::{Part, Sample, Tally, Tracer};
use crate::build::{Cone, Crossing, MediaSet, Shading, Surface};
use crate::math::random::Sequence;
use crate::math::{DVec2, Ray, Vec3};
use crate::plan::Carriers;

/// The first specular event of a path, which decides the layer that its light counts to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Class {
    Direct,
    Reflection,
    Refraction,
}

impl Class {
    fn then(self, event: Class) -> Class {
        if self == Class::Direct { event } else { self }
    }
}

/// A part of a path that is still to be followed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Branch {
    pub ray: Ray,
    pub throughput: Vec3,
    pub media: MediaSet,
    pub cone: Cone,
    /// Specular events in a row.
    pub depth: u32,
    /// Diffuse surfaces behind it.
    pub bounces: u32,
    /// µm, once something has dispersed.
    pub wavelength: Option<f64>,
    pub sequence: Sequence,
    pub class: Class,
}

impl Branch {
    /// What the time of following it counts to.
    fn part(&self) -> Part {
        match self.class {
            _ if self.bounces > 0 => Part::Bounce,
            Class::Direct => Part::Camera,
            Class::Reflection => Part::Reflection,
            Class::Refraction => Part::Refraction,
        }
    }
}

/// Dimensions of a path vertex's random values.
pub(super) const LIGHTS: u64 = 1;
const ROULETTE: u64 = 2;
pub(super) const MIRROR: u64 = 3;
pub(super) const REFLECTED: u64 = 4;
pub(super) const REFRACTED: u64 = 5;

pub(super) const BOUNCE: u64 = 7;
pub(super) const COVERAGE: u64 = 8;
pub(super) const INNER: u64 = 10;
pub(super) const OUTER: u64 = 11;
const WAVELENGTH: u64 = 9;

/// Dimensions of a camera sample.
const LENS: u64 = 6;

/// Storage that samples of one tile use again, and what holds for all of them.
pub struct Scratch {
    branches: Vec<Branch>,
    sample: Sample,
    /// The media around the eye; `None` where a lens may lie across the border of one.
    start: Option<MediaSet>,
}

impl Scratch {
    pub fn new(tracer: &Tracer) -> Scratch {
        let world = tracer.world;
        let camera = &world.camera;
        let across = camera.lens_radius > 0.0 && world.has_medium_near(camera.eye, camera.lens_radius);
        let start = (!across).then(|| world.media_at(camera.eye));
        Scratch { branches: Vec::new(), sample: Sample::default(), start }
    }
}

impl Tracer<'_> {
    /// The sample at `film` (pixels from the top left corner) of a sequence. What is not wanted of it may
    /// stay 0.
    #[inline]
    pub fn sample<'s>(
        &self,
        film: DVec2,
        sequence: Sequence,
        scratch: &'s mut Scratch,
        tally: &mut Tally,
    ) -> &'s Sample {
        let camera = &self.world.camera;
        let lens = if camera.lens_radius > 0.0 {
            crate::math::sampling::disk(sequence.dimension(LENS).pair())
        } else {
            DVec2::ZERO
        };
        tally.rays.camera += 1;
        tally.health.samples += 1;
        tally.watch.begin();
        tally.note(|recorder| recorder.begin(film));
        scratch.sample = Sample::default();
        scratch.branches.clear();
        let ray = camera.ray(film, lens);
        let mut branch = Branch {
            ray,
            throughput: Vec3::ONE,
            media: scratch.start.unwrap_or_else(|| self.world.media_at(ray.origin)),
            cone: Cone { width: 0.0, spread: camera.pixel_spread(ray.dir) },
            depth: 0,
            bounces: 0,
            wavelength: None,
            sequence,
            class: Class::Direct,
        };
        loop {
            self.follow(&mut branch, &mut scratch.sample, &mut scratch.branches, tally);
            match scratch.branches.pop() {
                Some(next) => branch = next,
                None => {
                    tally.note(|recorder| recorder.end(&scratch.sample));
                    return &scratch.sample;
                }
            }
        }
    }

    /// What light the path carries from where the branch is.
    #[inline]
    pub(super) fn carried(&self, branch: &Branch) -> Carriers {
        match (branch.bounces, branch.class) {
            (0, Class::Direct) => self.plan.carried.first,
            (0, _) => self.plan.carried.behind,
            _ => Carriers::ALL,
        }
    }

    #[inline(never)]
    fn follow(&self, branch: &mut Branch, sample: &mut Sample, todo: &mut Vec<Branch>, tally: &mut Tally) {
        tally.watch.enter(branch.part());
        tally.note(Recorder::arrive);
        let hit = if branch.depth == 0 && branch.bounces == 0 {
            self.world.nearest_from_eye(&branch.ray)
        } else {
            self.world.nearest(&branch.ray, f64::INFINITY)
        };
        let Some(hit) = hit else {
            return self.deposit(sample, branch, self.leaving(branch), tally);
        };
        let mut surface = self.world.surface_here(&branch.ray, &hit);
        let mut behind = None;
        if let Some(met) = self.world.coinciding(&branch.ray, &branch.media, &hit, &surface) {
            (surface, behind) = (met.surface, met.behind);
        }
        branch.throughput *= self.world.transmittance(&branch.media, surface.t);
        let wo = -branch.ray.dir;
        let mut shading = Shading::new(self.world, &surface, wo, &branch.cone);
        if self.wants.first_hit && branch.depth == 0 && branch.bounces == 0 {
            sample.first = self.first_hit(&surface, &shading);
        }
        let crossing =
            self.world.crossing(&branch.media, branch.ray.dir, &surface, &shading, &mut tally.health);
        match (crossing, behind) {
            (Some(crossing), Some(opaque)) if crossing.after.top() == branch.media.top() => {
                // Nothing is left here, so that what is opaque shows.
                surface = self.world.surface(&branch.ray, &opaque);
                shading = Shading::new(self.world, &surface, wo, &branch.cone);
            }
            (Some(crossing), _) => {
                if crossing.after.top() == branch.media.top() {
                    // Within an object of higher priority this surface does not exist.
                    let ray = self.world.leaving(&surface, crossing.tolerance, branch.ray.dir);
                    let cone = branch.cone.after(surface.t);
                    let next = Branch { ray, media: crossing.after, cone, ..*branch };
                    tally.note(|recorder| recorder.pass(self.world, &surface, branch.throughput));
                    return self.push(next, Vec3::ONE, 0, branch.class, todo, tally);
                }
                self.interface(branch, &surface, &shading, &crossing, behind.is_some(), todo, tally);
            }
            _ => {}
        }
        // After a bounce, lights have been counted where the path left.
        let carried = self.carried(branch);
        let seen = branch.bounces == 0 && carried.any(Carriers::SEEN);
        let emitted = if seen { shading.emitted() } else { Vec3::ZERO };
        let radiance = emitted + self.shaded(branch, &surface, &shading, sample, todo, tally);
        tally.note(|recorder| recorder.meet(self.world, &surface, emitted));
        self.deposit(sample, branch, radiance, tally);
        if shading.km != Vec3::ZERO && carried.any(Carriers::REFLECTION) {
            let wi = shading.mirrored(&mut tally.health);
            let ray = self.world.leaving(&surface, surface.p_error, wi);
            let next = Branch { ray, cone: branch.cone.after(surface.t), ..*branch };
            tally.rays.reflection += 1;
            self.push(next, shading.km, MIRROR, Class::Reflection, todo, tally);
        }
    }

    /// What a ray meets that leaves the scene.
    #[inline(never)]
    fn leaving(&self, branch: &Branch) -> Vec3 {
        let world = self.world;
        if branch.bounces > 0 {
            return Vec3::ZERO;
        }
        let (_, absorption) = world.medium(&branch.media);
        if absorption != Vec3::ZERO {
            return Vec3::ZERO;
        }
        let carried = self.carried(branch);
        match &world.environment {
            Some(environment) if world.environment_visible => {
                if carried.any(Carriers::ENVIRONMENT) {
                    environment.radiance(branch.ray.dir)
                } else {
                    Vec3::ZERO
                }
            }
            _ if carried.any(Carriers::SEEN) => world.background,
            _ => Vec3::ZERO,
        }
    }

    /// Pushes the reflected and the refracted branch of an interface; `touches` if something opaque lies
    /// right behind it.
    #[expect(clippy::too_many_arguments, reason = "all of it is the state of one path vertex")]
    fn interface(
        &self,
        branch: &Branch,
        surface: &Surface,
        shading: &Shading,
        crossing: &Crossing,
        touches: bool,
        todo: &mut Vec<Branch>,
        tally: &mut Tally,
    ) {
        let u = || branch.sequence.dimension(WAVELENGTH).value();
        let (eta, colour) = self.world.relative_ior(&branch.media, &crossing.after, branch.wavelength, u);
        let interface = shading.interface(eta);
        let weight = (Vec3::ONE - shading.km) * shading.kt * colour.weight;
        if weight == Vec3::ZERO {
            return;
        }
        let wavelength = colour.um;
        let cone = branch.cone.after(surface.t);
        let carried = self.carried(branch);
        tally.note(|recorder| {
            recorder.interface(InterfaceRecord::new(self.world, branch, crossing, wavelength, &interface))
        });
        if interface.reflectance > 0.0 && carried.any(Carriers::REFLECTION) {
            let wi = shading.mirrored(&mut tally.health);
            let ray = self.world.leaving(surface, crossing.tolerance, wi);
            tally.rays.reflection += 1;
            let weight = weight * interface.reflectance as f32;
            self.push(
                Branch { ray, cone, wavelength, ..*branch },
                weight,
                REFLECTED,
                Class::Reflection,
                todo,
                tally,
            );
        }
        if interface.reflectance < 1.0 && carried.any(Carriers::REFRACTION) {
            let Some(wi) = shading.refracted(eta, &interface, &mut tally.health) else { return };
            // From before the interface, which is no longer there for it, so that what touches is met.
            let ray = if touches {
                Ray::reaching(surface.p, crossing.tolerance, surface.ng, wi)
            } else {
                self.world.leaving(surface, crossing.tolerance, wi)
            };
            tally.rays.refraction += 1;
            let weight = weight * ((1.0 - interface.reflectance) / (eta * eta)) as f32;
            let next =
                Branch { ray, media: crossing.after, cone: cone.refracted(eta), wavelength, ..*branch };
            self.push(next, weight, REFRACTED, Class::Refraction, todo, tally);
        }
    }

    /// Adds a branch, or drops it by chance in proportion to its weight, or by the depth limit.
    fn push(
        &self,
        mut branch: Branch,
        weight: Vec3,
        event: u64,
        class: Class,
        todo: &mut Vec<Branch>,
        tally: &mut Tally,
    ) {
        branch.throughput *= weight;
        if event != BOUNCE {
            branch.depth += 1;
        }
        branch.sequence = branch.sequence.dimension(event);
        branch.class = branch.class.then(class);
        let heaviest = branch.throughput.max_element();
        if heaviest <= 0.0 || heaviest.is_nan() {
            tally.note(|recorder| recorder.send(&branch, event, Fate::Weightless));
            return;
        }
        if branch.depth > self.plan.max_depth {
            tally.cut.paths += 1;
            tally.cut.weight += f64::from(heaviest);
            tally.note(|recorder| recorder.send(&branch, event, Fate::DepthLimit));
            return;
        }
        let survival = if event == BOUNCE {
            bounce::survival(f64::from(heaviest), branch.bounces)
        } else {
            f64::from(heaviest) / self.plan.split_weight
        };
        if survival < 1.0 {
            if branch.sequence.dimension(ROULETTE).value() >= survival {
                tally.note(|recorder| recorder.send(&branch, event, Fate::Roulette));
                return;
            }
            branch.throughput /= survival as f32;
        }
        tally.note(|recorder| recorder.send(&branch, event, Fate::Followed));
        todo.push(branch);
    }

    /// What the layers that are not specular send on; the path's further way is pushed.
    fn shaded(
        &self,
        branch: &Branch,
        surface: &Surface,
        shading: &Shading,
        sample: &mut Sample,
        todo: &mut Vec<Branch>,
        tally: &mut Tally,
    ) -> Vec3 {
        let base = (Vec3::ONE - shading.km) * (Vec3::ONE - shading.kt) * shading.kd;
        if base == Vec3::ZERO && shading.ks == Vec3::ZERO {
            return Vec3::ZERO;
        }
        let carried = self.carried(branch);
        let ambient = if carried.any(Carriers::SEEN) { base * self.world.ambient } else { Vec3::ZERO };
        tally.watch.enter(Part::Direct);
        tally.note(|recorder| recorder.ambient(ambient));
        let radiance = ambient + self.direct(base, branch, surface, shading, tally);
        if self.caustics.is_none() && self.indirect.is_none() && branch.bounces >= self.plan.bounces {
            tally.watch.enter(branch.part());
            return radiance;
        }
        let radiance = self.gathered(radiance, carried, base, branch, surface, shading, sample, todo, tally);
        tally.watch.enter(branch.part());
        radiance
    }

    /// Adds to the direct light what photons and diffuse surfaces bring.
    #[inline(never)]
    #[expect(clippy::too_many_arguments, reason = "the rest of `shaded`, apart for scenes that do without")]
    fn gathered(
        &self,
        mut radiance: Vec3,
        carried: Carriers,
        base: Vec3,
        branch: &Branch,
        surface: &Surface,
        shading: &Shading,
        sample: &mut Sample,
        todo: &mut Vec<Branch>,
        tally: &mut Tally,
    ) -> Vec3 {
        if let Some(caustics) = &self.caustics
            && carried.any(Carriers::CAUSTICS)
        {
            tally.watch.enter(Part::Caustics);
            let caustic = self.caustic(caustics, branch, base, surface, shading, tally);
            radiance += caustic.radiance;
            tally.note(|recorder| recorder.caustic(&caustic));
            tally.blurred(0, branch.throughput, caustic.bias);
            if branch.bounces == 0 {
                sample.caustic += branch.throughput * caustic.radiance;
                sample.photon_density += branch.throughput.max_element() * caustic.density;
                if self.wants.photons {
                    sample.photons +=
                        branch.throughput * self.photon_dots(caustics, branch, surface, shading);
                }
            }
        }
        if !carried.any(Carriers::INDIRECT) {
            return radiance;
        }
        if let Some(indirect) = &self.indirect {
            tally.watch.enter(Part::Indirect);
            let gathered = self.caustic(indirect, branch, base, surface, shading, tally);
            tally.note(|recorder| recorder.indirect(&gathered));
            sample.indirect += branch.throughput * gathered.radiance;
            tally.blurred(1, branch.throughput, gathered.bias);
            radiance += gathered.radiance;
        }
        if self.indirect.is_none()
            && branch.bounces < self.plan.bounces
            && let Some((next, weight)) = self.bounced(branch, base, surface, shading, tally)
        {
            self.push(next, weight, BOUNCE, branch.class, todo, tally);
        }
        radiance
    }

    #[inline(never)]
    fn first_hit(&self, surface: &Surface, shading: &Shading) -> FirstHit {
        let world = self.world;
        let specular = shading.km.max(shading.kt);
        FirstHit {
            albedo: shading.kd * (Vec3::ONE - specular) + specular,
            normal: shading.ns.as_vec3(),
            depth: (surface.p - world.camera.eye).dot(world.camera.forward) as f32,
            position: (surface.p + world.origin).as_vec3(),
            object: world.instances[surface.instance as usize].object + 1,
        }
    }

    fn deposit(&self, sample: &mut Sample, branch: &Branch, radiance: Vec3, tally: &mut Tally) {
        let radiance = branch.throughput * radiance;
        tally.note(|recorder| recorder.deposit(branch.throughput, radiance));
        sample.radiance += radiance;
        if branch.bounces > 0 {
            sample.indirect += radiance;
        }
        if !self.wants.split {
            return;
        }
        match branch.class {
            Class::Direct => sample.direct += radiance,
            Class::Reflection => sample.reflection += radiance,
            Class::Refraction => sample.refraction += radiance,
        }
    }
}
