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

use super::branch::{BOUNCE, Branch, Class, LENS, MIRROR, REFLECTED, REFRACTED, WAVELENGTH};
use super::departure::Todo;
use super::record::{InterfaceRecord, Recorder};
use super::sample::FirstHit;
use super::{Part, Sample, Tally, Tracer};
use crate::build::{Beside, Candidates, Cone, Crossing, Hit, MediaSet, Shading, Start, Surface};
use crate::math::random::Sequence;
use crate::math::{Color, DVec2, DVec3, Ray, sampling};
use crate::plan::Carriers;

/// Storage that samples of one tile use again, and what holds for all of them.
pub struct Scratch {
    todo: Todo,
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
        Scratch { todo: Todo::default(), sample: Sample::default(), start }
    }
}

/// What shadow rays find.
const LAMPS: Carriers = Carriers::DIRECT.with(Carriers::HIGHLIGHTS).with(Carriers::ENVIRONMENT);

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
        self.sample_among(self.world.before_eye(film), film, sequence, scratch, tally)
    }

    /// The same, of which it is known what it may meet first.
    pub(super) fn sample_among<'s>(
        &self,
        candidates: Candidates,
        film: DVec2,
        sequence: Sequence,
        scratch: &'s mut Scratch,
        tally: &mut Tally,
    ) -> &'s Sample {
        let camera = &self.world.camera;
        tally.rays.camera += 1;
        tally.health.samples += 1;
        tally.watch.begin();
        tally.note(|recorder| recorder.begin(film));
        scratch.sample.clear();
        scratch.todo.clear();
        let ray = if camera.lens_radius > 0.0 {
            camera.ray_through_lens(film, sampling::disk(sequence.dimension(LENS).pair()))
        } else {
            camera.ray(film)
        };
        let mut hit = self.world.nearest_from_eye(&ray, candidates);
        let mut branch = Branch {
            ray,
            start: Start { instance: 0, outside: false },
            throughput: Color::ONE,
            media: scratch.start.unwrap_or_else(|| self.world.media_at(ray.origin)),
            cone: Cone { width: 0.0, spread: camera.pixel_spread(ray.dir) },
            depth: 0,
            bounces: 0,
            wavelength: None,
            sequence,
            class: Class::Direct,
            entry: None,
        };
        let Scratch { sample, todo, .. } = scratch;
        loop {
            let goes_on = self.follow(&mut branch, hit, sample, todo, tally);
            if !goes_on && !todo.pop(&mut branch) {
                break;
            }
            tally.watch.enter(branch.part());
            hit = match todo.entry(&branch) {
                None => self.world.nearest_from(branch.start, &branch.ray, f64::INFINITY),
                Some(entry) => Some(entry.hit()),
            };
        }
        tally.note(|recorder| recorder.end(&scratch.sample));
        &scratch.sample
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

    /// What the surface that it has hit sends to the eye. Of the ways on from there the last becomes `branch`
    /// itself, which spares its copies; `todo` takes the others. Whether `branch` goes on.
    #[inline(never)]
    fn follow(
        &self,
        branch: &mut Branch,
        hit: Option<Hit>,
        sample: &mut Sample,
        todo: &mut Todo,
        tally: &mut Tally,
    ) -> bool {
        tally.note(Recorder::arrive);
        let Some(hit) = hit else {
            self.deposit(sample, branch, self.leaving(branch), tally);
            return false;
        };
        let mut surface = self.world.surface_here(&branch.ray, &hit);
        let mut beside = Beside::Nothing;
        if let Some(entry) = todo.entry(branch) {
            beside = entry.at(&mut surface);
            branch.entry = None;
        } else if let Some(met) = self.world.coinciding(&branch.ray, &branch.media, &hit, &surface) {
            (surface, beside) = (met.surface, met.beside);
        }
        branch.throughput *= self.world.transmittance(&branch.media, surface.t.max(0.0));
        let wo = -branch.ray.dir;
        let mut shading = Shading::bare(self.world, &surface, wo);
        shading.look_up(self.world, &surface, &branch.cone);
        if self.wants.first_hit && branch.depth == 0 && branch.bounces == 0 {
            sample.first = self.first_hit(&surface, &shading);
        }
        let mut crossing = self.world.crossing(
            &branch.media,
            branch.ray.dir,
            &surface,
            &beside,
            &shading,
            &mut tally.health,
        );
        if let Some(through) = crossing.take_if(|through| through.after.top() == branch.media.top()) {
            let Beside::Behind(opaque) = &beside else {
                // Within an object of higher priority this surface does not exist.
                tally.note(|recorder| recorder.pass(self.world, &surface, branch.throughput));
                let Some(step) = self.step(branch, Color::ONE, 0, branch.class, tally) else { return false };
                branch.start = surface.start(branch.ray.dir);
                branch.ray = self.world.leaving(&surface, through.tolerance, branch.ray.dir);
                branch.cone = branch.cone.after(surface.t);
                branch.media = through.after;
                step.take(branch);
                return true;
            };
            // Nothing is left here, so that what is opaque shows.
            surface = self.world.surface(&branch.ray, opaque);
            shading = Shading::new(self.world, &surface, wo, &branch.cone);
        }
        // After a bounce, lights have been counted where the path left.
        let mut carried = self.carried(branch);
        if let Beside::Before(_) = beside {
            // Into the gap nothing shines but through the glass: photons bring it.
            carried = carried.without(LAMPS);
        }
        let seen = branch.bounces == 0 && carried.any(Carriers::SEEN);
        let emitted = if seen { shading.emitted() } else { Color::ZERO };
        let before = todo.len();
        let radiance = emitted + self.shaded(carried, branch, &surface, &shading, sample, todo, tally);
        if todo.len() > before {
            self.depart_scattered(&surface, &beside, todo);
        }
        tally.note(|recorder| recorder.meet(self.world, &surface, emitted));
        self.deposit(sample, branch, radiance, tally);
        if shading.km != Color::ZERO && carried.any(Carriers::REFLECTION) {
            tally.rays.reflection += 1;
            if let Some(step) = self.step(branch, shading.km, MIRROR, Class::Reflection, tally) {
                if crossing.is_none() {
                    self.reflect(branch, &surface, &shading, surface.p_error, &beside, tally);
                    self.depart(branch, &surface, todo);
                    step.take(branch);
                    return true;
                }
                let mut next = *branch;
                self.reflect(&mut next, &surface, &shading, surface.p_error, &beside, tally);
                step.take(&mut next);
                todo.push(&next);
            }
        }
        match crossing {
            Some(crossing) => self.interface(branch, &surface, &shading, &crossing, &beside, todo, tally),
            None => false,
        }
    }

    /// Turns the branch around at a surface that it has come to.
    #[inline]
    fn reflect(
        &self,
        branch: &mut Branch,
        surface: &Surface,
        shading: &Shading,
        tolerance: f64,
        beside: &Beside,
        tally: &mut Tally,
    ) {
        let wi = shading.mirrored(&mut tally.health);
        let touches = matches!(beside, Beside::Before(_));
        (branch.start, branch.ray) = self.going_on(surface, tolerance, wi, touches);
        branch.cone = branch.cone.after(surface.t);
    }

    /// Where a way on from a surface starts: if something opaque `touches` it on that side, before the surface,
    /// which is no longer there for it, so that what touches is met.
    #[inline(always)]
    pub(super) fn going_on(
        &self,
        surface: &Surface,
        tolerance: f64,
        wi: DVec3,
        touches: bool,
    ) -> (Start, Ray) {
        if touches {
            let start = Start { outside: false, ..surface.start(wi) };
            return (start, Ray::reaching(surface.p, tolerance, surface.ng, wi));
        }
        (surface.start(wi), self.world.leaving(surface, tolerance, wi))
    }

    /// What a ray meets that leaves the scene.
    #[inline(never)]
    fn leaving(&self, branch: &Branch) -> Color {
        let world = self.world;
        if branch.bounces > 0 {
            return Color::ZERO;
        }
        let (_, absorption) = world.medium(&branch.media);
        if absorption != Color::ZERO {
            return Color::ZERO;
        }
        let carried = self.carried(branch);
        match &world.environment {
            Some(environment) if world.environment_visible => {
                if carried.any(Carriers::ENVIRONMENT) {
                    environment.radiance(branch.ray.dir)
                } else {
                    Color::ZERO
                }
            }
            _ if carried.any(Carriers::SEEN) => world.background,
            _ => Color::ZERO,
        }
    }

    /// Sends the branch on through an interface, and `todo` what it reflects, or the branch itself where
    /// nothing goes through; it may have something opaque `beside` it. Whether `branch` goes on.
    #[expect(clippy::too_many_arguments, reason = "all of it is the state of one path vertex")]
    fn interface(
        &self,
        branch: &mut Branch,
        surface: &Surface,
        shading: &Shading,
        crossing: &Crossing,
        beside: &Beside,
        todo: &mut Todo,
        tally: &mut Tally,
    ) -> bool {
        let u = || branch.sequence.dimension(WAVELENGTH).value();
        let (eta, colour) = self.world.relative_ior(&branch.media, &crossing.after, branch.wavelength, u);
        let interface = shading.interface(eta);
        let weight = (Color::ONE - shading.km) * shading.kt * colour.weight;
        if weight == Color::ZERO {
            return false;
        }
        let wavelength = colour.um;
        let carried = self.carried(branch);
        tally.note(|recorder| {
            recorder.interface(InterfaceRecord::new(self.world, branch, crossing, wavelength, &interface))
        });
        let wi = if interface.reflectance < 1.0 && carried.any(Carriers::REFRACTION) {
            shading.refracted(eta, &interface, &mut tally.health)
        } else {
            None
        };
        if interface.reflectance > 0.0 && carried.any(Carriers::REFLECTION) {
            tally.rays.reflection += 1;
            let weight = weight * interface.reflectance as f32;
            if let Some(step) = self.step(branch, weight, REFLECTED, Class::Reflection, tally) {
                let alone = wi.is_none();
                let mut copy;
                let next = if alone {
                    &mut *branch
                } else {
                    copy = *branch;
                    &mut copy
                };
                self.reflect(next, surface, shading, crossing.tolerance, beside, tally);
                next.wavelength = wavelength;
                step.take(next);
                if alone {
                    return true;
                }
                todo.push(next);
            }
        }
        let Some(wi) = wi else { return false };
        tally.rays.refraction += 1;
        let weight = weight * ((1.0 - interface.reflectance) / (eta * eta)) as f32;
        let Some(step) = self.step(branch, weight, REFRACTED, Class::Refraction, tally) else { return false };
        let touches = matches!(beside, Beside::Behind(_));
        (branch.start, branch.ray) = self.going_on(surface, crossing.tolerance, wi, touches);
        branch.media = crossing.after;
        branch.cone = branch.cone.after(surface.t).refracted(eta);
        branch.wavelength = wavelength;
        step.take(branch);
        true
    }

    /// What the layers that are not specular send on; the path's further way is pushed.
    #[expect(clippy::too_many_arguments, reason = "all of it is the state of one path vertex")]
    #[inline]
    fn shaded(
        &self,
        carried: Carriers,
        branch: &Branch,
        surface: &Surface,
        shading: &Shading,
        sample: &mut Sample,
        todo: &mut Todo,
        tally: &mut Tally,
    ) -> Color {
        let base = (Color::ONE - shading.km) * (Color::ONE - shading.kt) * shading.kd;
        if base == Color::ZERO && shading.ks == Color::ZERO {
            return Color::ZERO;
        }
        let ambient = if carried.any(Carriers::SEEN) { base * self.world.ambient } else { Color::ZERO };
        tally.watch.enter(Part::Direct);
        tally.note(|recorder| recorder.ambient(ambient));
        let radiance = ambient + self.direct(carried, base, branch, surface, shading, tally);
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
        mut radiance: Color,
        carried: Carriers,
        base: Color,
        branch: &Branch,
        surface: &Surface,
        shading: &Shading,
        sample: &mut Sample,
        todo: &mut Todo,
        tally: &mut Tally,
    ) -> Color {
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
            && let Some((mut next, weight)) = self.bounced(branch, base, surface, shading, tally)
            && let Some(step) = self.step(&next, weight, BOUNCE, branch.class, tally)
        {
            step.take(&mut next);
            todo.push(&next);
        }
        radiance
    }

    #[inline(never)]
    fn first_hit(&self, surface: &Surface, shading: &Shading) -> FirstHit {
        let world = self.world;
        let specular = shading.km.max(shading.kt);
        FirstHit {
            albedo: shading.kd * (Color::ONE - specular) + specular,
            normal: shading.ns.as_vec3a(),
            depth: (surface.p - world.camera.eye).dot(world.camera.forward) as f32,
            position: (surface.p + world.origin).as_vec3a(),
            object: world.instances[surface.instance as usize].object + 1,
        }
    }

    fn deposit(&self, sample: &mut Sample, branch: &Branch, radiance: Color, tally: &mut Tally) {
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
