//! Meshes and images written for a test.

use std::fmt::Write;
use std::path::Path;
use terrarium::math::DVec3;

/// A mesh to be written as OBJ.
#[derive(Clone, Default)]
pub struct Obj {
    pub vertices: Vec<DVec3>,
    /// As many as vertices, or none.
    pub normals: Vec<DVec3>,
    pub faces: Vec<Vec<usize>>,
}

impl Obj {
    pub fn text(&self) -> String {
        let mut text = String::new();
        for v in &self.vertices {
            writeln!(text, "v {} {} {}", v.x, v.y, v.z).expect("memory");
        }
        for n in &self.normals {
            writeln!(text, "vn {} {} {}", n.x, n.y, n.z).expect("memory");
        }
        for face in &self.faces {
            text.push('f');
            for &i in face {
                let i = i + 1;
                let corner = if self.normals.is_empty() { format!(" {i}") } else { format!(" {i}//{i}") };
                text.push_str(&corner);
            }
            text.push('\n');
        }
        text
    }

    pub fn write(&self, path: &Path) {
        std::fs::write(path, self.text()).expect("the folder is writable");
    }

    /// Two meshes in one.
    pub fn with(mut self, other: Obj) -> Obj {
        let first = self.vertices.len();
        self.vertices.extend(other.vertices);
        self.normals.extend(other.normals);
        self.faces.extend(other.faces.into_iter().map(|f| f.into_iter().map(|i| i + first).collect()));
        self
    }

    /// Inside out.
    pub fn reversed(mut self) -> Obj {
        self.faces.iter_mut().for_each(|f| f.reverse());
        self.normals.iter_mut().for_each(|n| *n = -*n);
        self
    }

    pub fn scaled(mut self, factor: f64) -> Obj {
        self.vertices.iter_mut().for_each(|v| *v *= factor);
        self
    }
}

/// The box of edge lengths 2 around 0, faces outwards.
pub fn cube() -> Obj {
    let vertices = (0..8)
        .map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 2.0 - 1.0)
        .collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Obj { vertices, normals: Vec::new(), faces: faces.map(|f| f.to_vec()).to_vec() }
}

/// The unit sphere of an icosahedron whose triangles are divided into four so many times.
pub fn icosphere(subdivisions: u32) -> Obj {
    let g = (1.0 + 5.0f64.sqrt()) / 2.0;
    let mut vertices: Vec<DVec3> = [
        (-1.0, g, 0.0),
        (1.0, g, 0.0),
        (-1.0, -g, 0.0),
        (1.0, -g, 0.0),
        (0.0, -1.0, g),
        (0.0, 1.0, g),
        (0.0, -1.0, -g),
        (0.0, 1.0, -g),
        (g, 0.0, -1.0),
        (g, 0.0, 1.0),
        (-g, 0.0, -1.0),
        (-g, 0.0, 1.0),
    ]
    .map(|(x, y, z)| DVec3::new(x, y, z).normalize())
    .to_vec();
    let mut faces: Vec<[usize; 3]> = vec![
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    for _ in 0..subdivisions {
        let mut middles = std::collections::HashMap::new();
        let mut middle = |a: usize, b: usize| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                vertices.push((vertices[a] + vertices[b]).normalize());
                vertices.len() - 1
            })
        };
        faces = faces
            .iter()
            .flat_map(|&[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
            })
            .collect();
    }
    let faces = faces.iter().map(|f| f.to_vec()).collect();
    Obj { normals: vertices.clone(), vertices, faces }
}

/// An EXR of linear colours by (column, row from the top).
pub fn write_exr(path: &Path, width: usize, height: usize, color: impl Fn(usize, usize) -> [f32; 3] + Sync) {
    exr::prelude::write_rgb_file(path, width, height, |x, y| {
        let [r, g, b] = color(x, y);
        (r, g, b)
    })
    .expect("the folder is writable");
}

/// A temporary folder.
pub fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("there is a temporary folder")
}
