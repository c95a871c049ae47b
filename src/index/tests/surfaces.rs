//! What the estimate sees of surfaces that end, bend, or lie close behind one another. The caller
//! corrects edges; the raw estimate is held to what it must be there.

use super::*;
use crate::math::Color;
use crate::scatter::Photon;

fn estimate(map: &PhotonMap, p: Vec3, n: Vec3, radius: f32) -> Gathered {
    map.gather(&Query { p, n, radius: Radius::Fixed(radius) }, Kernel::Disc, |_| Color::ONE)
}

/// A wall of 1e-6 with light on one side only.
#[test]
fn the_other_side_of_a_thin_wall_is_black() {
    let map = PhotonMap::new(floor(10_000, 1));
    let behind = Vec3::new(0.5, -1e-6, 0.5);
    assert!(estimate(&map, behind, Vec3::Y, 0.1).photons > 0);
    assert_eq!(estimate(&map, behind, Vec3::NEG_Y, 0.1), Gathered { radius: 0.1, ..Gathered::default() });
    let nearest = Radius::Nearest { k: 10, min: 0.0, max: 1.0 };
    let query = Query { p: behind, n: Vec3::NEG_Y, radius: nearest };
    assert_eq!(map.gather(&query, Kernel::Disc, |_| Color::ONE).radiance, Color::ZERO);
}

/// Light on both sides of the wall, twice as much on one: each side sees its own, by k nearest too.
#[test]
fn both_sides_of_a_thin_wall_see_their_own_light() {
    let mut photons = floor(20_000, 2);
    photons.extend(floor(40_000, 3).into_iter().map(|above| Photon {
        position: above.position - Vec3::Y * 1e-6,
        wi: Vec3::NEG_Y,
        normal: Vec3::NEG_Y,
        ..above
    }));
    let map = PhotonMap::new(photons);
    let radius = Radius::Nearest { k: 500, min: 0.0, max: 1.0 };
    for (n, expected) in [(Vec3::Y, 2e4), (Vec3::NEG_Y, 4e4)] {
        let query = Query { p: Vec3::new(0.4, 0.0, 0.6), n, radius };
        let e = map.gather(&query, Kernel::Disc, |_| Color::ONE).radiance.x;
        assert!((e / expected - 1.0).abs() < 4.0 / (498.0f32).sqrt(), "{n}: {e}");
    }
}

/// A step as high as a quarter of the radius, and the wall of a room: none of their light leaks.
#[test]
fn a_step_and_a_wall_do_not_leak_onto_the_floor() {
    let mut photons = floor(10_000, 4);
    let step = photons.iter().map(|p| Photon { position: p.position + Vec3::Y * 0.025, ..*p });
    let wall = |p: &Photon| Photon {
        position: Vec3::new(p.position.z, p.position.x, 0.0),
        wi: Vec3::Z,
        normal: Vec3::Z,
        ..*p
    };
    let others: Vec<Photon> = step.chain(photons.iter().map(wall)).collect();
    let count = |photons: Vec<Photon>, p: Vec3| estimate(&PhotonMap::new(photons), p, Vec3::Y, 0.1).photons;
    for p in [Vec3::new(0.5, 0.0, 0.5), Vec3::new(0.5, 0.0, 0.02)] {
        assert_eq!(count(others.clone(), p), 0);
        let alone = count(photons.clone(), p);
        photons.extend(&others);
        assert_eq!(count(photons.clone(), p), alone);
        photons.truncate(10_000);
    }
}

/// The faces of painted glass and of what it lies on, in one plane: each photon says on which of them it is.
#[test]
fn photons_of_one_plane_tell_their_faces() {
    let lit = [(Face::Opaque, 10_000), (Face::Outer, 20_000), (Face::Inner, 40_000)];
    let on = |(face, count)| floor(count, 7).into_iter().map(move |p| Photon { face, ..p });
    let map = PhotonMap::new(lit.into_iter().flat_map(on).collect::<Vec<_>>());
    for (face, count) in lit {
        let query = Query { p: Vec3::new(0.5, 0.0, 0.5), n: Vec3::Y, radius: Radius::Fixed(0.2) };
        let e = map.gather_seen(&query, Kernel::Disc, |hit| hit.face == face, |_| Color::ONE).radiance.x;
        let expected = count as f32;
        assert!((e / expected - 1.0).abs() < 5.0 / (0.126 * expected).sqrt(), "{face:?}: {e}");
    }
}

/// A lit sphere, radius a quarter of its own: 1 − d²/4R² of a chord's disc is lost to none of the
/// tests for surfaces, so the density is the true one (the cap of chord d has exactly area πd²).
#[test]
fn a_sphere_loses_nothing_by_its_curvature() {
    let mut random = counter(5);
    let count = 200_000;
    let on_sphere = |[u, v]: [f64; 2]| {
        let (z, phi) = (1.0 - 2.0 * u, std::f64::consts::TAU * v);
        let s = (1.0 - z * z).sqrt();
        Vec3::new((s * libm::cos(phi)) as f32, z as f32, (s * libm::sin(phi)) as f32)
    };
    let photons: Vec<Photon> = (0..count).map(|_| on_sphere(random.pair())).map(|n| photon(n, n)).collect();
    let map = PhotonMap::new(photons);
    let truth = count as f32 / (4.0 * std::f32::consts::PI);
    let (mut sum, mut gathered) = (0.0, 0);
    for _ in 0..200 {
        let n = on_sphere(random.pair());
        let found = estimate(&map, n, n, 0.25);
        sum += found.radiance.x / truth / 200.0;
        gathered += found.photons;
    }
    assert!((sum - 1.0).abs() < 0.006, "{sum}, from {gathered} photons");
}
