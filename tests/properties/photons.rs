//! Photons of random scenes: all power is accounted for, and what is stored is sound.

use super::describe::{material, place, shape, unit, world};
use super::hold;
use proptest::prelude::*;
use terrarium::math::DVec3;
use terrarium::scatter::{Aim, Emission, Store};

/// Three random objects of random materials over a floor, at any scale, lit by a light of any kind. The account
/// balances in every channel, no photon that is stored holds a NaN or infinity, and the account is the same for
/// caustics, indirect and direct light.
#[test]
fn the_account_of_power_balances() {
    let object = || (shape(), place(10.0, 1.0), material());
    let objects = prop::collection::vec(object(), 3);
    hold(60, (objects, 0..7usize, unit(), -6.0..6.0f64), |(objects, kind, way, e)| {
        let unit = libm::pow(10.0, e);
        let at = way * 6.0;
        let position = format!("({}, {}, {})", at.x, at.y.abs() + 3.0, at.z);
        let light = match kind {
            0 => format!("point(position: {position}, intensity: 1)"),
            1 => format!("spot(position: {position}, target: (0, 0, 0), intensity: 1)"),
            2 => format!("sphere(center: {position}, radius: 0.5, radiance: (1, 2, 3))"),
            3 => format!("disk(center: {position}, normal: (0, -1, 0.1), radius: 0.5, radiance: 1)"),
            4 => format!(
                "quad(corner: {position}, edge_u: (1, 0, 0), edge_v: (0, 0, 1), radiance: 1, two_sided: true)"
            ),
            5 => "directional(direction: (0.3, -1, 0.2), irradiance: 1)".to_owned(),
            _ => "environment(map: gradient(zenith: 1, horizon: 0.5, nadir: 0.1))".to_owned(),
        };
        // One scale for the whole scene: shapes lose theirs.
        let placed = objects.iter().enumerate().map(|(i, (form, place, _))| {
            let turn =
                place.text.split("rotate").nth(1).and_then(|t| t.split("translate").next()).expect("a turn");
            format!(
                r#"(shape: {}, material: "m{i}", transform: [rotate{turn} translate(({}, 1, {}))]), "#,
                form.text,
                2.0 * i as f64 - 2.0,
                0.5 * i as f64
            )
        });
        let placed: String = placed.collect();
        let materials: String =
            objects.iter().enumerate().map(|(i, (_, _, m))| format!(r#""m{i}": ({}), "#, m.text())).collect();
        let rest = format!(
            r#"materials: {{ "floor": (diffuse: 0.5), {materials} }}, lights: {{ "lamp": {light} }},
            objects: [(shape: group(objects: [(shape: quad(size: (20, 20)), material: "floor"), {placed}]), transform: [scale({unit:e})])]"#
        );
        let (world, plan) = world(DVec3::ZERO, unit, &rest);
        for store in [Store::Caustics, Store::Indirect, Store::Direct] {
            let Some(emission) = Emission::of(&world, &plan, store, Aim::Scene) else { continue };
            let scattered = emission.scatter(&world, 0, 2000);
            let off = scattered.ledger.imbalance();
            prop_assert!(off < 1e-9, "{:?}: {} of {:?}", store, off, scattered.ledger);
            for photon in scattered.photons.iter() {
                let sound = photon.position.is_finite()
                    && photon.power.is_finite()
                    && photon.power.min_element() >= 0.0
                    && (photon.wi.length() - 1.0).abs() < 1e-5
                    && photon.wi.dot(photon.normal) >= 0.0;
                prop_assert!(sound, "{:?}", photon);
            }
        }
        Ok(())
    });
}
