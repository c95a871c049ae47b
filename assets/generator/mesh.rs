//! Triangle meshes and their OBJ text: positions, texture coordinates and normals with short
//! numbers, and named groups.

use std::fmt::Write;

use glam::{DVec2, DVec3};

/// A corner's indices of position, texture coordinate and normal, from 0.
pub type Corner = [usize; 3];

/// Triangles that share a name; an empty name writes no `g` line.
pub struct Group {
    pub name: &'static str,
    pub faces: Vec<[Corner; 3]>,
}

/// A mesh in the making. Without texture coordinates the corners' second index is ignored, without
/// normals the third.
#[derive(Default)]
pub struct Mesh {
    pub title: &'static str,
    pub positions: Vec<DVec3>,
    pub coordinates: Vec<DVec2>,
    pub normals: Vec<DVec3>,
    pub groups: Vec<Group>,
    /// Digits after the point of normals; positions have 5, coordinates 4.
    pub normal_digits: usize,
}

impl Mesh {
    pub fn new(title: &'static str) -> Self {
        Self { title, normal_digits: 3, ..Self::default() }
    }

    /// Begins a group; faces that are added later belong to it.
    pub fn group(&mut self, name: &'static str) {
        self.groups.push(Group { name, faces: Vec::new() });
    }

    /// Adds a vertex whose corner indices are all the same, and returns that index.
    /// Only for meshes whose vertices are all added this way.
    pub fn vertex(&mut self, position: DVec3, coordinate: DVec2, normal: DVec3) -> usize {
        self.positions.push(position);
        self.coordinates.push(coordinate);
        self.normals.push(normal);
        self.positions.len() - 1
    }

    /// Adds a triangle of vertices made by `vertex`.
    pub fn face(&mut self, indices: [usize; 3]) {
        self.corners(indices.map(|i| [i; 3]));
    }

    /// Adds a triangle.
    pub fn corners(&mut self, corners: [Corner; 3]) {
        if self.groups.is_empty() {
            self.group("");
        }
        self.groups.last_mut().expect("a group was begun").faces.push(corners);
    }

    /// Normals of the shared vertices: the faces' normals weighed by their angles there.
    /// Every corner must use the same index for position and normal.
    pub fn smooth(&mut self) {
        let mut sums = vec![DVec3::ZERO; self.positions.len()];
        for face in self.groups.iter().flat_map(|g| &g.faces) {
            let p = face.map(|c| self.positions[c[0]]);
            let across = (p[1] - p[0]).cross(p[2] - p[0]);
            for i in 0..3 {
                let (a, b) = (p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]);
                let angle = libm::atan2(across.length(), a.dot(b));
                sums[face[i][0]] += across.normalize_or_zero() * angle;
            }
        }
        self.normals = sums.into_iter().map(DVec3::normalize_or_zero).collect();
    }

    /// The OBJ text.
    pub fn obj(&self) -> Vec<u8> {
        let mut out = format!("# {}\n", self.title);
        for p in &self.positions {
            line(&mut out, "v", &p.to_array(), 5);
        }
        for t in &self.coordinates {
            line(&mut out, "vt", &t.to_array(), 4);
        }
        for n in &self.normals {
            line(&mut out, "vn", &n.to_array(), self.normal_digits);
        }
        for group in &self.groups {
            if !group.name.is_empty() {
                let _ = writeln!(out, "g {}", group.name);
            }
            for face in &group.faces {
                out.push('f');
                for [v, t, n] in face.map(|c| c.map(|i| i + 1)) {
                    let _ = match (self.coordinates.is_empty(), self.normals.is_empty()) {
                        (true, true) => write!(out, " {v}"),
                        (true, false) => write!(out, " {v}//{n}"),
                        (false, true) => write!(out, " {v}/{t}"),
                        (false, false) => write!(out, " {v}/{t}/{n}"),
                    };
                }
                out.push('\n');
            }
        }
        out.into_bytes()
    }
}

fn line(out: &mut String, keyword: &str, values: &[f64], digits: usize) {
    out.push_str(keyword);
    for value in values {
        let text = format!("{value:.digits$}");
        let short = text.trim_end_matches('0').trim_end_matches('.');
        out.push(' ');
        out.push_str(if short == "-0" { "0" } else { short });
    }
    out.push('\n');
}
