//! Spheres as meshes, to see what facets cost: the same ball from ever more triangles.
//!
//! A sphere becomes rings of latitude and segments of longitude with its own normals at the corners. Only
//! spheres that are objects or definitions by themselves are replaced, not those within groups.

use crate::description::{NameMap, Object, Scene, Shape, Smooth};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// How many spheres would be replaced.
pub fn spheres(scene: &Scene) -> usize {
    let of = |object: &Object| matches!(object.shape, Shape::Sphere { .. });
    scene.objects.iter().filter(|o| of(o)).count() + scene.definitions.iter().filter(|(_, o)| of(o)).count()
}

/// The file of a mesh: a unit sphere would need a transform of its own, so each has its radius and centre.
fn file(meshes: &Path, segments: u32, number: usize) -> PathBuf {
    meshes.join(format!("sphere-{number}-{segments}.obj"))
}

/// Replaces the spheres by meshes that are in the folder.
pub fn replace(scene: &mut Scene, segments: u32, meshes: &Path) {
    for (number, object) in each(scene).enumerate() {
        let path = file(meshes, segments, number).to_string_lossy().into_owned();
        object.shape = Shape::Mesh { path, smooth: Smooth::Interpolated, parts: NameMap::default() };
    }
    scene.reach.allow(meshes);
}

/// The meshes' files and what they hold.
pub fn files(scene: &Scene, segments: u32, meshes: &Path) -> Vec<(PathBuf, String)> {
    let mut scene = scene.clone();
    let text = |object: &mut Object| match object.shape {
        Shape::Sphere { radius, center } => obj(radius, center, segments),
        _ => String::new(),
    };
    each(&mut scene)
        .map(text)
        .enumerate()
        .map(|(number, text)| (file(meshes, segments, number), text))
        .collect()
}

fn each(scene: &mut Scene) -> impl Iterator<Item = &mut Object> {
    let definitions = scene.definitions.iter_mut().map(|(_, object)| object);
    scene.objects.iter_mut().chain(definitions).filter(|object| matches!(object.shape, Shape::Sphere { .. }))
}

/// OBJ text, anticlockwise from outside, with normals.
fn obj(radius: f64, center: [f64; 3], segments: u32) -> String {
    let around = segments.max(3);
    let rings = (around / 2).max(2);
    let mut text = String::new();
    let mut corner = |polar: f64, azimuth: f64| {
        let (sin, cos) = (libm::sin(polar), libm::cos(polar));
        let n = [sin * libm::cos(azimuth), cos, -sin * libm::sin(azimuth)];
        let p = [0, 1, 2].map(|i| center[i] + radius * n[i]);
        // writing to a string cannot fail
        let _ = write!(text, "v {} {} {}\nvn {} {} {}\n", p[0], p[1], p[2], n[0], n[1], n[2]);
    };
    corner(0.0, 0.0);
    for ring in 1..rings {
        for segment in 0..around {
            let turn = std::f64::consts::TAU * f64::from(segment) / f64::from(around);
            corner(std::f64::consts::PI * f64::from(ring) / f64::from(rings), turn);
        }
    }
    corner(std::f64::consts::PI, 0.0);
    let at = |ring: u32, segment: u32| 2 + (ring - 1) * around + segment % around;
    let last = 2 + (rings - 1) * around;
    let mut face = |corners: &[u32]| {
        let parts: Vec<String> = corners.iter().map(|c| format!("{c}//{c}")).collect();
        let _ = writeln!(text, "f {}", parts.join(" "));
    };
    for segment in 0..around {
        face(&[1, at(1, segment), at(1, segment + 1)]);
        for ring in 1..rings - 1 {
            let (upper, lower) = (at(ring, segment), at(ring + 1, segment));
            face(&[upper, lower, at(ring + 1, segment + 1)]);
            face(&[upper, at(ring + 1, segment + 1), at(ring, segment + 1)]);
        }
        face(&[last, at(rings - 1, segment + 1), at(rings - 1, segment)]);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Volume by the divergence theorem: positive if faces are anticlockwise from outside, and 4/3·π·r³ in
    /// the limit.
    #[test]
    fn meshes_are_closed_and_approach_the_sphere() {
        let volume = |segments: u32| {
            let text = obj(2.0, [1.0, -3.0, 0.5], segments);
            let numbers = |line: &str| -> Vec<f64> {
                line.split(' ').skip(1).filter_map(|word| word.split('/').next()?.parse().ok()).collect()
            };
            let corners: Vec<Vec<f64>> = text.lines().filter(|l| l.starts_with("v ")).map(numbers).collect();
            text.lines()
                .filter(|line| line.starts_with("f "))
                .map(|line| {
                    let [a, b, c] = [0, 1, 2].map(|i| &corners[numbers(line)[i] as usize - 1]);
                    (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
                        + a[2] * (b[0] * c[1] - b[1] * c[0]))
                        / 6.0
                })
                .sum::<f64>()
        };
        let truth = 4.0 / 3.0 * std::f64::consts::PI * 8.0;
        let (coarse, fine) = (1.0 - volume(16) / truth, 1.0 - volume(64) / truth);
        assert!(coarse > 0.02 && fine > 0.0, "{coarse} and {fine}");
        // the error of facets goes as the square of their size
        assert!((coarse / fine / 16.0 - 1.0).abs() < 0.1, "{coarse} and {fine}");
    }
}
