//! OBJ files as a scene's author meets them: every way to write the same mesh (`forms`), polygons of
//! every kind (`polygons`), and files that are broken in every way we could think of (`broken`).

mod broken;
mod forms;
mod polygons;

use std::io::Cursor;
use std::path::Path;
use terrarium::build::obj::{self, ObjError, ObjMesh};

fn load(text: impl AsRef<[u8]>) -> Result<ObjMesh, ObjError> {
    obj::load_from(Cursor::new(text.as_ref()), Path::new("mesh.obj"))
}

fn reference(text: impl AsRef<[u8]>) -> Result<ObjMesh, ObjError> {
    obj::load_by_reference(Cursor::new(text.as_ref()), Path::new("mesh.obj"))
}

fn message(text: impl AsRef<[u8]>) -> String {
    load(text).expect_err("the file is broken").to_string()
}

/// Deterministic values for the fuzzing.
struct Dice(u64);

impl Dice {
    fn roll(&mut self, sides: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) % sides as u64) as usize
    }

    fn number(&mut self) -> f64 {
        (self.roll(20001) as f64 - 10000.0) / 1000.0
    }
}

type Soup = Vec<([[f32; 3]; 3], [[f32; 3]; 3], [[f32; 2]; 3], String, String)>;

/// The triangles with all that stands at their corners, free of how the vertices are numbered.
fn soup(mesh: &ObjMesh) -> Soup {
    let normal = |i: u32| mesh.normals.get(i as usize).copied().unwrap_or_default().to_array();
    let uv = |i: u32| mesh.uvs.get(i as usize).copied().unwrap_or_default().to_array();
    let part = |k: usize| &mesh.part_names[mesh.parts.get(k).copied().unwrap_or(0) as usize];
    let triangles = mesh.triangles.iter().enumerate();
    triangles
        .map(|(k, t)| {
            let positions = t.map(|i| mesh.positions[i as usize].to_array());
            (positions, t.map(normal), t.map(uv), part(k).group.clone(), part(k).material.clone())
        })
        .collect()
}

fn points(mesh: &ObjMesh) -> usize {
    let first = |i: usize| mesh.welded.is_empty() || mesh.welded[i] == i as u32;
    (0..mesh.positions.len()).filter(|&i| first(i)).count()
}

fn assert_same(a: &ObjMesh, b: &ObjMesh, text: &[u8]) {
    let text = String::from_utf8_lossy(text);
    assert_eq!(a.center, b.center, "{text}");
    assert_eq!(soup(a), soup(b), "{text}");
    assert_eq!(points(a), points(b), "{text}");
    assert_eq!((a.degenerate, a.part_names.clone()), (b.degenerate, b.part_names.clone()), "{text}");
}

fn area(mesh: &ObjMesh) -> f64 {
    let triangle = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize].as_dvec3());
        (b - a).cross(c - a).length() / 2.0
    };
    mesh.triangles.iter().map(triangle).sum()
}

/// Each way to write an index, of v, vt, vn, as corners of a cube's faces.
fn cube(corner: impl Fn(i32, i32, i32) -> String) -> String {
    let mut text = String::new();
    for k in 0..8 {
        text += &format!("v {} {} {}\n", k & 1, k >> 1 & 1, k >> 2 & 1);
    }
    text += "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
    text += "vn -1 0 0\nvn 1 0 0\nvn 0 -1 0\nvn 0 1 0\nvn 0 0 -1\nvn 0 0 1\n";
    let sides = [[1, 5, 7, 3], [2, 4, 8, 6], [1, 2, 6, 5], [3, 7, 8, 4], [1, 3, 4, 2], [5, 6, 8, 7]];
    for (n, side) in sides.iter().enumerate() {
        let words: Vec<String> =
            side.iter().enumerate().map(|(t, &v)| corner(v, t as i32 + 1, n as i32 + 1)).collect();
        text += &format!("f {}\n", words.join(" "));
    }
    text
}
