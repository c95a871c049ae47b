//! Aiming changes how many photons arrive, and not how much light.

use super::lab::{Lab, lab, power};
use terrarium::scatter::{Aim, Store};

const OBJECTS: &str = r#"(shape: quad(size: (8, 8)), material: "white"),
    (shape: sphere(center: (0, 1.2, 0), radius: 0.6), material: "glass"),
    (shape: box(size: (0.4, 0.8, 0.3), center: (1.4, 0.5, 0.6)), material: "mirror")"#;

/// Stored power within 3σ of the unaimed, with a higher yield.
pub(super) fn assert_aimed_is_unaimed(lab: &Lab) {
    let aimed = lab.caustics(32, 10_000);
    let unaimed = lab.passes(Store::Caustics, Aim::Scene, 32, 10_000);
    // By quadrant of the floor as well as in all.
    for quadrant in 0..5 {
        let within = |p: &terrarium::scatter::Photon| {
            let q = lab.place(p);
            quadrant == 4 || (usize::from(q.x > 0.0) + 2 * usize::from(q.z > 0.0) == quadrant)
        };
        let (a, b) = (power(&aimed, within), power(&unaimed, within));
        let sigma = a.error.hypot(b.error);
        assert!((a.mean - b.mean).abs() < 3.0 * sigma + 1e-9 * b.mean, "{quadrant}: {a:?} {b:?}");
    }
    let (a, b) = (power(&aimed, |_| true), power(&unaimed, |_| true));
    assert!(a.error < 0.02 * a.mean && a.error < 1.2 * b.error, "{a:?} {b:?}");
}

macro_rules! aimed {
    ($($name:ident: $lights:expr, $more:expr;)*) => {
        $(#[test]
        fn $name() {
            assert_aimed_is_unaimed(&lab(
                r#""lamp": (diffuse: 0, emission: 5)"#,
                $lights,
                &format!("{OBJECTS}{}", $more),
            ));
        })*
    };
}

aimed! {
    point: r#""a": point(position: (0.5, 3, 0.3), intensity: 7)"#, "";
    spot: r#""a": spot(position: (0, 4, 0), target: (0.5, 0, 0), intensity: 8, inner_deg: 10, outer_deg: 30)"#, "";
    directional: r#""a": directional(direction: (1, -2, 0.5), irradiance: 3)"#, "";
    sky: r#""a": environment(map: gradient(zenith: 3, horizon: 1, nadir: 0.2))"#, "";
    sphere: r#""a": sphere(center: (-1.5, 3, -1), radius: 0.4, radiance: 5)"#, "";
    hidden_sphere_that_holds_a_caster: r#""a": sphere(center: (0, 1.2, 0), radius: 0.9, radiance: 5, visible: false)"#, "";
    quad: r#""a": quad(corner: (-1, 3, -1), edge_u: (1, 0, 0), edge_v: (0, 0, 1), radiance: 5)"#, "";
    hidden_two_sided_disk_that_cuts_a_caster: r#""a": disk(center: (0, 1.4, 0), normal: (0.3, -1, 0), radius: 1, radiance: 5, two_sided: true, visible: false)"#, "";
    ellipsoid: "", r#", (shape: sphere(radius: 1), material: "lamp", transform: [scale((0.3, 0.1, 0.5)), translate((-1, 2.5, 1))])"#;
    polyhedron: "", r#", (shape: polyhedron(kind: dodecahedron, radius: 0.4), material: "lamp", transform: [translate((-1, 2.5, 1))])"#;
    touching_cylinder: "", r#", (shape: cylinder(radius: 0.2, height: 0.5), material: "lamp", transform: [translate((0, 1.8, 0))])"#;
}

#[test]
fn a_small_ball_far_from_a_lamp_gets_most_of_its_photons() {
    let lab = lab(
        "",
        r#""a": sphere(center: (-3, 5, -2), radius: 0.4, radiance: 60)"#,
        r#"(shape: quad(size: (20, 20)), material: "white"), (shape: sphere(center: (0, 1.2, 0)), material: "glass")"#,
    );
    let passes = lab.caustics(8, 20_000);
    let stored: u64 = passes.iter().map(|p| p.ledger.photons).sum();
    let emitted: u64 = passes.iter().map(|p| p.emitted).sum();
    // The ball fills 0.9 % of the lamp's light.
    assert!(stored as f64 > 0.3 * emitted as f64, "{stored} of {emitted}");
}
