//! Broad-leaved trees by space colonisation (Runions, Lane & Prusinkiewicz 2007): twigs grow toward
//! points strewn in the crown's volume and use them up; thickness follows from the twigs that a
//! branch carries (Leonardo's rule); leaves are rhombs of two triangles with normals bent outward,
//! so that the crown is shaded as one round thing.

use glam::{DVec2, DVec3};

use super::mesh::Mesh;
use super::random::Random;
use super::tube::{self, Joint};

/// The shape of a kind of tree. Heights and lengths are parts of the tree's height.
struct Kind {
    title: &'static str,
    /// Centre and half axes of the crown's ellipsoid.
    centre: DVec3,
    half: DVec3,
    points: usize,
    step: f64,
    /// Points are seen from this far, and used up within a third of it.
    sight: f64,
    twig: f64,
    trunk_sides: usize,
    leaf: f64,
    /// Leaves on a node, on nodes thinner than `leafy` twigs.
    leaves: usize,
    leafy: f64,
    /// How much leaves hang: 0 stand in any direction, 1 point down.
    droop: f64,
    /// How far up the crown's half height the stem goes on by itself: −1 to its foot, 1 to its top.
    leader: f64,
    /// Stems from the ground.
    stems: usize,
}

/// An oak-like tree, as wide as high.
pub fn broadleaf(seed: u64) -> Mesh {
    grow(
        seed,
        &Kind {
            title: "broad-leaved tree, height 1, foot at the origin; groups trunk, leaves",
            centre: DVec3::new(0.0, 0.62, 0.0),
            half: DVec3::new(0.40, 0.37, 0.40),
            points: 900,
            step: 0.028,
            sight: 0.18,
            twig: 0.0030,
            trunk_sides: 8,
            leaf: 0.056,
            leaves: 4,
            leafy: 2.2,
            droop: 0.25,
            leader: -0.5,
            stems: 1,
        },
    )
}

/// A slender tree with hanging leaves, its crown on a clear stem.
pub fn birch(seed: u64) -> Mesh {
    grow(
        seed,
        &Kind {
            title: "birch, height 1, foot at the origin; groups trunk, leaves",
            centre: DVec3::new(0.0, 0.63, 0.0),
            half: DVec3::new(0.20, 0.36, 0.20),
            points: 620,
            step: 0.025,
            sight: 0.15,
            twig: 0.0022,
            trunk_sides: 7,
            leaf: 0.036,
            leaves: 4,
            leafy: 2.6,
            droop: 0.75,
            leader: 0.75,
            stems: 1,
        },
    )
}

/// A low bush of several stems.
pub fn bush(seed: u64) -> Mesh {
    grow(
        seed,
        &Kind {
            title: "bush, height 1, foot at the origin; groups trunk, leaves",
            centre: DVec3::new(0.0, 0.52, 0.0),
            half: DVec3::new(0.62, 0.47, 0.62),
            points: 420,
            step: 0.045,
            sight: 0.24,
            twig: 0.006,
            trunk_sides: 5,
            leaf: 0.075,
            leaves: 5,
            leafy: 2.5,
            droop: 0.15,
            leader: -0.75,
            stems: 5,
        },
    )
}

/// A branch's node.
struct Node {
    at: DVec3,
    parent: Option<usize>,
    children: Vec<usize>,
    radius: f64,
}

fn grow(seed: u64, kind: &Kind) -> Mesh {
    let mut random = Random::new(seed);
    let mut nodes = colonise(kind, &mut random);
    thicken(&mut nodes, kind.twig);
    fit(&mut nodes, kind);
    let mut mesh = Mesh::new(kind.title);
    mesh.group("trunk");
    branches(&mut mesh, &nodes, kind);
    mesh.group("leaves");
    for node in nodes.iter().filter(|n| n.parent.is_some() && n.radius < kind.leafy * kind.twig) {
        for _ in 0..kind.leaves {
            leaf(&mut mesh, node.at, kind, &mut random);
        }
    }
    let top = mesh.positions.iter().fold(0.0_f64, |top, p| top.max(p.y));
    mesh.positions.iter_mut().for_each(|p| *p /= top);
    mesh
}

fn colonise(kind: &Kind, random: &mut Random) -> Vec<Node> {
    // More points toward the outside: leaves want light.
    let mut points: Vec<DVec3> = (0..kind.points)
        .map(|_| {
            let p = random.in_ball();
            kind.centre + kind.half * p * (0.55 + 0.45 * p.length())
        })
        .collect();
    let mut nodes = Vec::new();
    for stem in 0..kind.stems {
        let (sin, cos) = super::solid::turn(360.0 * stem as f64 / kind.stems as f64 + 20.0);
        let lean = if kind.stems > 1 { DVec3::new(sin, 1.4, cos).normalize() } else { DVec3::Y };
        stem_up(&mut nodes, kind, lean, random);
    }
    for _ in 0..120 {
        let mut pull = vec![DVec3::ZERO; nodes.len()];
        for &point in &points {
            let near = nearest(&nodes, point);
            let toward = point - nodes[near].at;
            if toward.length() < kind.sight {
                pull[near] += toward.normalize_or_zero();
            }
        }
        let before = nodes.len();
        for (i, pull) in pull.into_iter().enumerate() {
            if pull.length() > 0.05 && nodes[i].children.len() < 3 {
                let wander = random.in_ball() * 0.25;
                let direction = (pull.normalize() + wander + DVec3::Y * 0.08).normalize();
                add(&mut nodes, i, kind.step, direction);
            }
        }
        if nodes.len() == before {
            break;
        }
        points.retain(|&p| (nodes[nearest(&nodes, p)].at - p).length() > kind.sight / 3.0);
    }
    nodes
}

/// A stem from the ground to where the crown's points come into sight.
fn stem_up(nodes: &mut Vec<Node>, kind: &Kind, lean: DVec3, random: &mut Random) {
    nodes.push(Node {
        at: lean * DVec3::new(0.02, 0.0, 0.02),
        parent: None,
        children: Vec::new(),
        radius: 0.0,
    });
    let height = kind.centre.y + kind.leader * kind.half.y;
    let mut direction = lean;
    while nodes.last().expect("the stem has a foot").at.y < height {
        direction = (direction + lean * 0.5 + random.in_ball() * 0.22).normalize();
        let end = nodes.len() - 1;
        add(nodes, end, kind.step, direction);
    }
}

fn add(nodes: &mut Vec<Node>, from: usize, step: f64, direction: DVec3) {
    let at = nodes[from].at + direction * step;
    nodes.push(Node { at, parent: Some(from), children: Vec::new(), radius: 0.0 });
    let new = nodes.len() - 1;
    nodes[from].children.push(new);
}

fn nearest(nodes: &[Node], point: DVec3) -> usize {
    let square = |i: usize| (nodes[i].at - point).length_squared();
    (0..nodes.len()).min_by(|&a, &b| square(a).total_cmp(&square(b))).expect("a tree has nodes")
}

/// Cross-sections add up toward the foot. Children come after their parents in the list.
fn thicken(nodes: &mut [Node], twig: f64) {
    for i in (0..nodes.len()).rev() {
        let area: f64 = nodes[i].children.iter().map(|&c| nodes[c].radius * nodes[c].radius).sum();
        nodes[i].radius = area.sqrt().max(twig);
    }
}

/// Scales the tree to height 1, leaves included.
fn fit(nodes: &mut [Node], kind: &Kind) {
    let top = nodes.iter().fold(0.0_f64, |top, n| top.max(n.at.y)) + 0.35 * kind.leaf;
    for node in nodes {
        node.at /= top;
        let flare = 1.0 + 0.7 * libm::exp(-node.at.y / 0.035);
        node.radius *= flare / top;
    }
}

/// Tubes along the thickest child each, and a new tube from every other child.
fn branches(mesh: &mut Mesh, nodes: &[Node], kind: &Kind) {
    let thickest = |i: usize| {
        nodes[i].children.iter().copied().max_by(|&a, &b| nodes[a].radius.total_cmp(&nodes[b].radius))
    };
    for i in 0..nodes.len() {
        let first = nodes[i].parent.is_none_or(|p| thickest(p) != Some(i));
        if !first {
            continue;
        }
        let mut joints: Vec<Joint> = Vec::new();
        if let Some(parent) = nodes[i].parent {
            joints.push(Joint { at: nodes[parent].at, radius: nodes[i].radius });
        }
        let mut at = Some(i);
        while let Some(node) = at {
            joints.push(Joint { at: nodes[node].at, radius: nodes[node].radius });
            at = thickest(node);
        }
        if joints.len() < 2 {
            continue;
        }
        joints.last_mut().expect("joints has two or more").radius *= 0.4;
        let thin = joints[0].radius < 4.0 * kind.twig;
        let sides = if nodes[i].parent.is_none() {
            kind.trunk_sides
        } else if thin {
            3
        } else {
            5
        };
        tube::add(mesh, &joints, sides, 6.0);
    }
}

/// A rhomb from its stalk outward: two triangles.
fn leaf(mesh: &mut Mesh, at: DVec3, kind: &Kind, random: &mut Random) {
    let outward = ((at - kind.centre) / kind.half).normalize_or_zero();
    let free = random.direction() + outward * 0.5;
    let along = (free * (1.0 - kind.droop) - DVec3::Y * kind.droop * 1.2).normalize();
    let side = along.cross(random.direction()).normalize_or_zero();
    let facing = side.cross(along);
    let facing = if facing.dot(outward + DVec3::Y * 0.5) < 0.0 { -facing } else { facing };
    let side = along.cross(facing);
    let size = kind.leaf * random.within(0.75, 1.15);
    let from = at + random.in_ball() * 0.3 * kind.leaf;
    let bent = |p: DVec3| {
        let out = ((p - kind.centre) / kind.half).normalize_or_zero();
        (facing * 0.45 + out * 0.7 + DVec3::Y * 0.25).normalize()
    };
    let corners = [(0.0, 0.0), (0.45, 0.33), (1.0, 0.0), (0.45, -0.33)].map(|(length, width)| {
        let p = from + (along * length + side * width) * size;
        let droop = DVec3::Y * (-0.15 * length * length * size);
        let uv = DVec2::new(0.5 - 1.2 * width, length);
        mesh.vertex(p + droop, uv, bent(p))
    });
    let [foot, left, tip, right] = corners;
    mesh.face([foot, right, tip]);
    mesh.face([foot, tip, left]);
}
