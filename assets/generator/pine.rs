//! A conifer: a straight trunk with tiers of drooping branches, each a spine with pairs of side
//! twigs, shorter toward the top.

use glam::{DVec2, DVec3};

use super::mesh::Mesh;
use super::random::Random;
use super::solid::turn;
use super::tube::{self, Joint};

const TIERS: usize = 20;

/// The tree: height 1, foot at the origin, groups `trunk` and `leaves`.
pub fn tree(seed: u64) -> Mesh {
    let mut random = Random::new(seed);
    let mut mesh = Mesh::new("pine, height 1, foot at the origin; groups trunk, leaves");
    mesh.group("trunk");
    let joints: Vec<Joint> = (0..=7)
        .map(|i| {
            let y = i as f64 / 7.0 * 0.97;
            let sway = DVec3::new(random.within(-1.0, 1.0), 0.0, random.within(-1.0, 1.0)) * 0.004;
            let flare = 0.012 * libm::exp(-y / 0.04);
            Joint { at: DVec3::Y * y + sway, radius: 0.021 * (1.0 - y) + 0.002 + flare }
        })
        .collect();
    tube::add(&mut mesh, &joints, 8, 6.0);
    mesh.group("leaves");
    for tier in 0..TIERS {
        let t = tier as f64 / (TIERS - 1) as f64;
        let branches = 12 - (4.0 * t) as usize;
        let spin = random.within(0.0, 360.0);
        for k in 0..branches {
            let degrees = spin + 360.0 * k as f64 / branches as f64 + random.within(-9.0, 9.0);
            let y = 0.155 + 0.795 * t * (1.25 - 0.25 * t) + random.within(-0.016, 0.016);
            let reach = (0.225 * (1.0 - t * (1.2 - 0.2 * t)) + 0.046) * random.within(0.80, 1.12);
            branch(&mut mesh, y, degrees, reach, t, &mut random);
        }
    }
    let tip = Branch { foot: DVec3::Y * 0.93, out: DVec3::Y, side: DVec3::X, sag: 0.0, reach: 0.07 };
    tip.frond(&mut mesh, 0.012);
    let tip = Branch { side: DVec3::Z, ..tip };
    tip.frond(&mut mesh, 0.012);
    mesh
}

fn branch(mesh: &mut Mesh, y: f64, degrees: f64, reach: f64, t: f64, random: &mut Random) {
    let (sin, cos) = turn(degrees);
    let lift = 0.02 + 0.55 * t * t + random.within(-0.08, 0.08);
    let out = DVec3::new(sin, lift, cos).normalize();
    let side = DVec3::new(cos, 0.0, -sin);
    let main = Branch { foot: DVec3::Y * y, out, side, sag: 0.50 - 0.15 * t, reach };
    main.frond(mesh, 0.17 * reach + 0.008);
    let pairs = if reach > 0.10 { 4 } else { 2 };
    for pair in 0..pairs {
        let s = 0.25 + 0.62 * pair as f64 / pairs as f64;
        for hand in [-1.0, 1.0] {
            let twig_out =
                (out * 0.75 + side * hand * 0.75 + DVec3::Y * random.within(-0.12, 0.05)).normalize();
            let twig_side = twig_out.cross(DVec3::Y).normalize() * -1.0;
            let twig = Branch {
                foot: main.at(s),
                out: twig_out,
                side: twig_side,
                sag: 0.35,
                reach: reach * (0.52 - 0.34 * s) * random.within(0.85, 1.15),
            };
            twig.frond(mesh, 0.085 * reach + 0.006);
        }
    }
}

/// A sagging spine of length `reach`.
struct Branch {
    foot: DVec3,
    out: DVec3,
    side: DVec3,
    sag: f64,
    reach: f64,
}

impl Branch {
    fn at(&self, s: f64) -> DVec3 {
        self.foot + self.out * (self.reach * s) - DVec3::Y * (self.sag * self.reach * s * s)
    }

    /// Needles as a roof on both sides of the spine: two strips that taper to the tip.
    fn frond(&self, mesh: &mut Mesh, width: f64) {
        let ridge = self.side.cross(self.out).normalize();
        let ridge = if ridge.y < 0.0 { -ridge } else { ridge };
        let stations = [(0.0, 0.4), (0.5, 1.0)];
        let tip = mesh.vertex(self.at(1.0), DVec2::new(0.5, 1.0), (ridge + self.out * 0.6).normalize());
        for hand in [-1.0, 1.0] {
            let eaves = (ridge + self.side * (hand * 0.8)).normalize();
            let pairs = stations.map(|(s, part)| {
                let p = self.at(s);
                let hang = self.side * (hand * width * part) - ridge * (0.45 * width * part)
                    + self.out * (0.5 * width * part);
                let inner = mesh.vertex(p, DVec2::new(0.5, s), ridge);
                let outer = mesh.vertex(p + hang, DVec2::new(0.5 + 0.4 * hand, s), eaves);
                (inner, outer)
            });
            let mut face = |a: usize, b: usize, c: usize| {
                let across =
                    (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]);
                let turned = across.dot(mesh.normals[a]) < 0.0;
                mesh.face(if turned { [a, c, b] } else { [a, b, c] });
            };
            for pair in pairs.windows(2) {
                face(pair[0].0, pair[0].1, pair[1].1);
                face(pair[0].0, pair[1].1, pair[1].0);
            }
            face(pairs[1].0, pairs[1].1, tip);
        }
    }
}
