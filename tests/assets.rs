//! The committed assets are what their program makes, and the meshes are what scenes take them for.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use glam::DVec3;

#[path = "../assets/generator/generator.rs"]
mod generator;

use generator::solid::{CAVITY, Solid};
use generator::water;

/// Positions and triangles of an OBJ file.
struct Obj {
    positions: Vec<DVec3>,
    faces: Vec<[usize; 3]>,
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets")
}

fn obj(name: &str) -> Obj {
    let text = std::fs::read_to_string(folder().join("obj").join(name)).expect("the asset is committed");
    let mut mesh = Obj { positions: Vec::new(), faces: Vec::new() };
    for line in text.lines() {
        let mut words = line.split(' ');
        match words.next() {
            Some("v") => {
                let p: Vec<f64> = words.map(|w| w.parse().expect("a number")).collect();
                mesh.positions.push(DVec3::from_slice(&p));
            }
            Some("f") => {
                let index = |w: &str| {
                    let first = w.split('/').next().expect("an index");
                    first.parse::<usize>().expect("a whole number") - 1
                };
                let corners: Vec<usize> = words.map(index).collect();
                mesh.faces.push(corners.try_into().expect("a triangle"));
            }
            _ => {}
        }
    }
    mesh
}

impl Obj {
    /// Each directed edge must occur once, and its reverse once.
    fn open_edges(&self) -> usize {
        let mut edges: HashMap<(usize, usize), u32> = HashMap::new();
        for face in &self.faces {
            for i in 0..3 {
                *edges.entry((face[i], face[(i + 1) % 3])).or_default() += 1;
            }
        }
        edges.iter().filter(|&(&(a, b), &n)| n != 1 || edges.get(&(b, a)) != Some(&1)).count()
    }

    /// The enclosed volume, positive when the triangles wind outward.
    fn volume(&self) -> f64 {
        let p = &self.positions;
        self.faces.iter().map(|&[a, b, c]| p[a].dot(p[b].cross(p[c])) / 6.0).sum()
    }

    /// The plan's area of the triangles that look up and whose middle satisfies `keep`.
    fn plan_area(&self, keep: impl Fn(DVec3) -> bool) -> f64 {
        let area = |&[a, b, c]: &[usize; 3]| {
            let (p, q, r) = (self.positions[a], self.positions[b], self.positions[c]);
            let up = 0.5 * (q - p).cross(r - p).y;
            if up > 0.0 && keep((p + q + r) / 3.0) { up } else { 0.0 }
        };
        self.faces.iter().map(area).sum()
    }
}

#[test]
fn the_generator_makes_the_committed_files_byte_for_byte() {
    let made = generator::assets();
    let scratch = tempfile::tempdir().expect("a temporary folder");
    generator::write(&made, scratch.path()).expect("the temporary folder is writable");
    assert_eq!(generator::differences(&made, scratch.path()), Vec::<String>::new());
    assert_eq!(generator::differences(&made, &folder()), Vec::<String>::new());
    let total: usize = made.iter().map(|a| a.bytes.len()).sum();
    assert!(total < 20_000_000, "the assets take {total} bytes");
}

#[test]
fn solids_are_closed_wind_outward_and_stay_within_the_glass() {
    for (name, least) in [("terrain.obj", 0.3), ("water.obj", 0.3)] {
        let mesh = obj(name);
        assert_eq!(mesh.open_edges(), 0, "{name}");
        assert!(mesh.volume() > least, "{name}: {}", mesh.volume());
        let glass = Solid::new(1.0);
        for &p in &mesh.positions {
            assert!(glass.depth(p) > 0.02, "{name}: {p} is not inside the wall");
        }
    }
    // Of the pool, 3.24² · 1.25; of the lens 2·(π h² (R − h/3)) + 0.06 π with R = 2.6, h = R − √(R² − 1).
    for (name, least, most) in [
        ("pebble_1.obj", 0.5, 4.0),
        ("pebble_2.obj", 0.5, 4.0),
        ("wine_glass.obj", 0.05, 0.2),
        ("wine.obj", 0.12, 0.25),
        ("lens.obj", 0.79, 0.83),
        ("pool_water.obj", 13.0, 13.25),
        // 2π²·0.5·0.22² of the smooth one.
        ("torus.obj", 0.4, 0.477),
    ] {
        let mesh = obj(name);
        assert_eq!(mesh.open_edges(), 0, "{name}");
        assert!((least..most).contains(&mesh.volume()), "{name}: {}", mesh.volume());
    }
}

/// Where land or water meets the wall it reaches into it, so that no gap is left.
#[test]
fn rims_reach_into_the_wall() {
    let cavity = Solid::new(CAVITY);
    for name in ["terrain.obj", "water.obj"] {
        let mesh = obj(name);
        let inside = mesh.positions.iter().filter(|&&p| cavity.depth(p) < -0.004).count();
        assert!(inside > 360, "{name}: {inside} vertices in the wall");
    }
}

#[test]
fn a_lake_of_decent_size_lies_open() {
    let terrain = obj("terrain.obj");
    let lake = terrain.plan_area(|p| p.y < water::surface(p.x, p.z)[0]);
    let all = terrain.plan_area(|_| true);
    let part = lake / all;
    assert!((0.12..0.4).contains(&part), "the lake takes {part} of the plan");
}

/// Grass, trees and stones stand on the terrain's own triangles.
#[test]
fn carriers_are_parts_of_the_terrain() {
    let key = |p: DVec3| (p * 1e5).round().as_i64vec3();
    let terrain: std::collections::HashSet<_> = obj("terrain.obj").positions.into_iter().map(key).collect();
    for (name, least) in [("meadow.obj", 0.2), ("forest.obj", 0.1), ("beach.obj", 0.03)] {
        let mesh = obj(name);
        assert!(mesh.positions.iter().all(|&p| terrain.contains(&key(p))), "{name}");
        assert!(mesh.plan_area(|_| true) > least, "{name}: {}", mesh.plan_area(|_| true));
    }
}

#[test]
fn plants_are_one_high_and_stand_on_the_origin() {
    for (name, most) in [
        ("tree_pine.obj", 15_000),
        ("tree_broadleaf.obj", 15_000),
        ("tree_birch.obj", 15_000),
        ("bush.obj", 15_000),
        ("grass_tuft.obj", 400),
    ] {
        let mesh = obj(name);
        let top = mesh.positions.iter().fold(f64::MIN, |top, p| top.max(p.y));
        let foot = mesh.positions.iter().fold(f64::MAX, |foot, p| foot.min(p.y));
        assert!((top - 1.0).abs() < 0.02 && foot > -0.05, "{name}: {foot} to {top}");
        assert!(mesh.faces.len() <= most, "{name}: {} triangles", mesh.faces.len());
    }
}
