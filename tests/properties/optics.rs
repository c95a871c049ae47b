//! Energy of every material and interface, and the laws of refraction.

use super::describe::{Layers, material, unit, world};
use super::hold;
use proptest::prelude::*;
use std::f64::consts::{FRAC_1_PI, TAU};
use terrarium::build::{Cone, Shading, World};
use terrarium::math::random::{Sequence, Stage};
use terrarium::math::{Color, DVec3, Ray, sampling};
use terrarium::optics::{Interface, reflected, refracted};

fn ball(layers: &Layers) -> World {
    let objects = format!(
        r#"materials: {{ "m": ({}) }}, objects: [(shape: sphere(), material: "m")], lights: {{ "sky": environment(map: constant(1)) }}"#,
        layers.text()
    );
    world(DVec3::ZERO, 1.0, &objects).0
}

/// The share of light from all around that goes back towards `wo`, by the directions that paths draw; and by
/// uniform ones and the formula of the layers. With the standard error of both.
fn albedo(shading: &Shading, layers: &Layers, base: Color) -> ([f64; 2], f64) {
    let n = 2048u32;
    let [mut drawn, mut even] = [[0.0; 2]; 2];
    let add = |sums: &mut [f64; 2], x: f64| {
        sums[0] += x;
        sums[1] += x * x;
    };
    let (ns, ng) = (shading.ns, shading.ng);
    let mirror = ns * (2.0 * shading.wo.dot(ns)) - shading.wo;
    for i in 0..n {
        let sequence = Sequence::new(5, Stage::Test, 0, i);
        let found = shading.scattered(base, sequence.pair(), || sequence.dimension(1).value());
        add(&mut drawn, found.map_or(0.0, |(_, weight)| f64::from(weight.x)));
        let wi = sampling::sphere(sequence.dimension(2).pair());
        let (cos, s) = (wi.dot(ns), layers.shininess);
        let lobe = f64::from(shading.ks.x) * (s + 2.0) / TAU * libm::pow(mirror.dot(wi).max(0.0), s);
        let f = f64::from(base.x) * FRAC_1_PI + lobe;
        add(&mut even, if cos > 0.0 && wi.dot(ng) > 0.0 { f * cos * 2.0 * TAU } else { 0.0 });
    }
    let n = f64::from(n);
    let variance = |[sum, squares]: [f64; 2]| (squares / n - (sum / n) * (sum / n)).max(0.0) / n;
    let error = (variance(drawn) + variance(even)).sqrt();
    ([drawn[0] / n, even[0] / n], error)
}

/// A white furnace about each layer: what the mirror, the interface, the matt layer and the highlight send on is
/// no more than what came, for every angle; and drawn directions weigh what the formula says.
#[test]
fn no_material_sends_on_more_than_it_gets() {
    hold(300, (material(), unit()), |(layers, wo)| {
        let world = ball(&layers);
        let ray = Ray { origin: wo * 3.0 + wo.any_orthonormal_vector() * 0.9, dir: -wo };
        let hit = world.nearest(&ray, f64::INFINITY).expect("aimed at it");
        let surface = world.surface(&ray, &hit);
        let shading = Shading::new(&world, &surface, wo, &Cone { width: 0.0, spread: 0.0 });
        let base = (Color::ONE - shading.km) * (Color::ONE - shading.kt) * shading.kd;
        let ([drawn, even], error) = albedo(&shading, &layers, base);
        let (km, kt) = (f64::from(shading.km.x), f64::from(shading.kt.x));
        let all = km + (1.0 - km) * kt + drawn;
        prop_assert!(all <= 1.0 + 5.0 * error + 1e-6, "{} ± {}", all, error);
        // Very narrow lobes are beyond directions from all around.
        if layers.shininess < 300.0 {
            prop_assert!((drawn - even).abs() <= 6.0 * error + 1e-3, "{} and {} ± {}", drawn, even, error);
        }
        Ok(())
    });
}

/// Fresnel's share is a share, the same from both sides; directions are unit vectors that obey Snell's law.
#[test]
fn interfaces_obey_their_laws() {
    hold(4000, (unit(), unit(), -1.0..1.0f64), |(n, other, e)| {
        let eta = libm::pow(4.0, e);
        let wo = if other.dot(n) < 0.0 { -other } else { other };
        let cos = wo.dot(n);
        let interface = Interface::new(cos, eta);
        prop_assert!((0.0..=1.0).contains(&interface.reflectance), "{:?}", interface);
        let mirror = reflected(wo, n);
        prop_assert!((mirror.length() - 1.0).abs() < 1e-9 && (mirror.dot(n) - cos).abs() < 1e-9);
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        if interface.reflectance == 1.0 {
            prop_assert!(sin / eta > 1.0 - 1e-9 || cos == 0.0);
            return Ok(());
        }
        let wi = refracted(wo, n, eta, interface.cos_t);
        prop_assert!((wi.length() - 1.0).abs() < 1e-9 && wi.dot(n) <= 0.0);
        let sin_t = wi.cross(n).length();
        prop_assert!((sin - eta * sin_t).abs() < 1e-7, "{} and {}", sin, eta * sin_t);
        let back = Interface::new(interface.cos_t, 1.0 / eta);
        prop_assert!((back.reflectance - interface.reflectance).abs() < 1e-7);
        Ok(())
    });
}
