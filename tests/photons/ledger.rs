//! The ledger balances, and passes are pure functions of the scene and their number.

use super::lab::{Lab, lab};
use terrarium::scatter::{Aim, Store};

/// Coloured mixed materials, absorption, nested media, a mapped mirror and every kind of light.
pub(crate) fn medley() -> Lab {
    lab(
        r#""ink": (transmission: (0.9, 0.5, 0.2), reflection: (0.1, 0.2, 0.3), diffuse: 0.7, ior: 1.4, absorption: (0.5, 1, 2)),
           "gloss": (diffuse: 0.4, specular: 0.3, shininess: 20, reflection: (0.3, 0.1, 0)),
           "glow": (diffuse: 0.3, emission: (1, 2, 3), transmission: 0.2, ior: 1.2)"#,
        r#""point": point(position: (1, 3, 0), intensity: (5, 3, 1)),
           "spot": spot(position: (-2, 4, 1), target: (0, 0, 0), intensity: 9, inner_deg: 10, outer_deg: 30),
           "sun": directional(direction: (0.3, -1, 0.2), irradiance: 1),
           "sky": environment(map: gradient(zenith: (0.2, 0.4, 1), horizon: 1, nadir: 0.1)),
           "ball": sphere(center: (-3, 5, -2), radius: 0.4, radiance: 20),
           "quad": quad(corner: (-1, 4, -1), edge_u: (0.5, 0, 0), edge_v: (0, 0, 0.5), radiance: 10),
           "disk": disk(center: (2, 1, 2), normal: (-1, 0, -1), radius: 0.3, radiance: 10, two_sided: true)"#,
        r#"(shape: quad(size: (9, 9)), material: "gloss"),
           (shape: sphere(center: (0, 1, 0), radius: 0.8), material: "ink"),
           (shape: sphere(center: (0, 1, 0), radius: 0.4), material: "glass"),
           (shape: box(size: (1, 1, 1), center: (1.8, 0.5, 0)), material: "mirror"),
           (shape: cylinder(radius: 0.4, height: 1), material: "glow", transform: [translate((-1.5, 0.2, 1))])"#,
    )
}

#[test]
fn the_same_photons_come_of_any_number_of_threads_and_any_order_of_passes() {
    let lab = medley();
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let emission = lab.emission(Store::Caustics, Aim::Casters).expect("lights");
            let last = emission.scatter(&lab.world, 5, 10_000);
            let first = emission.scatter(&lab.world, 0, 10_000);
            [first, last]
        })
    };
    let one = on(1);
    for threads in [2, 5] {
        for (a, b) in one.iter().zip(&on(threads)) {
            assert_eq!(a.photons, b.photons);
            assert_eq!(a.ledger, b.ledger);
        }
    }
    assert_ne!(one[0].photons, one[1].photons);
}

#[test]
fn so_many_samples_are_taken_as_were_asked_for_in_the_mean() {
    let passes = medley().caustics(50, 5_000);
    let mean = passes.iter().map(|p| p.emitted as f64).sum::<f64>() / 50.0;
    assert!((mean / 5000.0 - 1.0).abs() < 0.01, "{mean}");
    assert!(passes.iter().all(|p| (p.emitted as f64 / 5000.0 - 1.0).abs() < 0.05));
}
