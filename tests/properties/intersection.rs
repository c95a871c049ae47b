//! Rays and placed shapes: what is met is where it is said to be, and is not met again by what leaves it.

use super::describe::{Form, Kind, Place, place, shape, unit, world};
use super::hold;
use proptest::prelude::*;
use terrarium::build::{Cone, Shading, Surface, World};
use terrarium::math::{DVec3, Ray};

/// A shape in its place, and rays towards its middle: from where, and past the centre by how much of the size.
type Case = (Form, Place, bool, Vec<(DVec3, f64, DVec3)>);

fn cases(squash: f64, far: f64) -> impl Strategy<Value = Case> {
    let ray = (unit(), 0.0..4.0f64, [-0.6..0.6f64, -0.6..0.6, -0.6..0.6].prop_map(DVec3::from));
    (shape(), place(squash, far), any::<bool>(), prop::collection::vec(ray, 8))
}

/// The world, its one instance's bounds, and the rays; the camera looks at the shape or at the origin.
///
/// Which of two triangles is nearer is told in single precision of the distance: from a thousand sizes away the rim
/// of a thin mesh may show its far side. Rays at meshes begin within ten.
fn built((form, place, at_it, rays): &Case) -> (World, f64, Vec<Ray>) {
    let objects = format!(
        r#"materials: {{ "m": (diffuse: 0.5) }}, objects: [(shape: {}, material: "m", transform: [{}])]"#,
        form.text, place.text
    );
    let target = if *at_it { place.centre } else { DVec3::ZERO };
    let (world, _) = world(target, place.scale, &objects);
    let bounds = World::placed_bounds(world.geometry(0), &world.instances[0].placement);
    let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let (centre, reach) = (0.5 * (min + max), (max - min).length());
    let rays = rays.iter().filter_map(|&(way, distance, past)| {
        let distance = if form.text.starts_with("mesh") { distance / 4.0 } else { distance };
        let origin = centre + way * reach * libm::pow(10.0, distance);
        let through = centre + past * (max - min);
        Some(Ray { origin, dir: (through - origin).try_normalize()? })
    });
    (world, reach, rays.collect())
}

fn finite(surface: &Surface) -> bool {
    surface.p.is_finite() && surface.t.is_finite() && surface.ng.is_finite() && surface.ns.is_finite()
}

/// At any scale, squashed, mirrored and far away. (Points are put onto surfaces in the space of their shape, so that on
/// shapes that are squashed a million times they lie on the surface, but not as near to the ray.)
#[test]
fn hits_are_sound_and_lie_where_they_are_said_to() {
    hold(400, cases(30.0, 1e6), |case| {
        let (world, _, rays) = built(&case);
        for ray in rays {
            let Some(hit) = world.nearest(&ray, f64::INFINITY) else { continue };
            let surface = world.surface(&ray, &hit);
            prop_assert!(finite(&surface) && hit.t > 0.0, "{:?}", surface);
            let (ng, ns) = (surface.ng, surface.ns);
            prop_assert!((ng.length() - 1.0).abs() < 1e-9 && (ns.length() - 1.0).abs() < 1e-9);
            prop_assert!(ng.dot(ns) > 0.0);
            // Along the normal, the ray at t and the point agree within the stated error and the ray's own rounding.
            let mut rounding = 8.0 * f64::EPSILON * (ray.origin.abs().element_sum() + surface.t);
            if case.0.text.starts_with("mesh") {
                // Triangles are met in single precision, in their own space: from far away, that far to the side.
                let placement = &world.instances[hit.instance as usize].placement;
                let local = placement.local_ray(&ray);
                let reach = local.origin.abs().element_sum() + local.dir.length() * surface.t;
                rounding += 8.0 * f64::from(f32::EPSILON) * placement.stretch() * reach;
            }
            let off = (ray.at(surface.t) - surface.p).dot(ng).abs();
            prop_assert!(off <= surface.p_error + rounding, "{} is more than {}", off, surface.p_error);
            let off = (hit.t - surface.t).abs() * ng.dot(ray.dir).abs();
            prop_assert!(off <= surface.p_error + rounding, "t: {} and {}", hit.t, surface.t);
            let cone = Cone { width: 0.0, spread: 0.0 };
            let shading = Shading::new(&world, &surface, -ray.dir, &cone);
            prop_assert!(shading.ng.dot(-ray.dir) >= 0.0 && shading.ng.dot(shading.ns) > 0.0);
            // Nothing lies before the nearest hit.
            prop_assert!(!world.occluded(&ray, hit.t * 0.999_999, None));
        }
        Ok(())
    });
}

/// What leaves a convex shape to the outside meets nothing, at any slope.
#[test]
fn nothing_that_leaves_meets_itself() {
    let slopes = prop::collection::vec((unit(), 0.0..12.0f64), 8);
    hold(400, (cases(1e6, 1e6), slopes), |(case, slopes)| {
        if case.0.kind == Kind::Other {
            return Ok(());
        }
        let (world, _, rays) = built(&case);
        for (ray, (around, slope)) in rays.into_iter().zip(slopes) {
            let Some(hit) = world.nearest(&ray, f64::INFINITY) else { continue };
            let surface = world.surface(&ray, &hit);
            let sheet = case.0.kind == Kind::Sheet;
            let n = if sheet && surface.ng.dot(ray.dir) > 0.0 { -surface.ng } else { surface.ng };
            let Some(along) = n.cross(around).try_normalize() else { continue };
            let dir = (along + n * libm::pow(10.0, -slope)).normalize();
            if dir.dot(surface.ng) == 0.0 || (dir.dot(n) > 0.0) != (dir.dot(n) >= 0.0) {
                continue;
            }
            let leaving = Ray::leaving(surface.p, surface.p_error, surface.ng, dir);
            let again = world.nearest(&leaving, f64::INFINITY);
            prop_assert!(again.is_none(), "{:?} leaves {:?} and meets {:?}", leaving, surface, again);
        }
        Ok(())
    });
}

/// A ray from outside goes into a solid and out of it, in turn, and in the end is out: normals say which.
#[test]
fn solids_are_entered_and_left_in_turn() {
    hold(400, cases(30.0, 1e3), |case| {
        let open = case.0.kind == Kind::Sheet || case.0.text.contains("caps: false");
        if open {
            return Ok(());
        }
        let (world, reach, rays) = built(&case);
        for mut ray in rays {
            let mut inside = false;
            let mut crossings = 0;
            while let Some(hit) = world.nearest(&ray, f64::INFINITY) {
                let surface = world.surface(&ray, &hit);
                // Grazing to within rounding, either side is right.
                if surface.ng.dot(ray.dir).abs() < 1e-4 || surface.p_error > 1e-4 * reach {
                    inside = false;
                    break;
                }
                prop_assert_eq!(surface.ng.dot(ray.dir) > 0.0, inside, "crossing {}", crossings);
                inside = !inside;
                crossings += 1;
                prop_assert!(crossings < 20);
                ray = Ray::leaving(surface.p, surface.p_error, surface.ng, ray.dir);
            }
            prop_assert!(!inside, "{} crossings", crossings);
        }
        Ok(())
    });
}

/// Mirrored, turned and squashed, a solid's normal points out: against any ray that comes from outside of it.
#[test]
fn the_normal_faces_what_comes_from_outside() {
    hold(400, cases(1e3, 1e4), |case| {
        if case.0.kind != Kind::Solid {
            return Ok(());
        }
        let (world, _, rays) = built(&case);
        for ray in rays {
            let Some(hit) = world.nearest(&ray, f64::INFINITY) else { continue };
            let cos = world.surface(&ray, &hit).ng.dot(ray.dir);
            prop_assert!(cos <= 1e-6, "{}", cos);
        }
        Ok(())
    });
}
