//! From a file's faces to a mesh: polygons cut, vertices unified over (position, normal, uv),
//! positions centred, triangles without area dropped, and what happened put into words.

use super::polygon::{Cut, triangulate};
use super::{Faces, Fault, NONE, Notes, ObjMesh};
use crate::math::{DVec3, Vec2, Vec3};
use rayon::prelude::*;
use std::collections::HashMap;

/// # Errors
/// `Invalid` when nothing with an area is left or the mesh spans more than single precision holds;
/// `NotSupported` for a huge concave polygon.
pub(super) fn mesh(mut faces: Faces) -> Result<ObjMesh, Fault> {
    let mut mesh = ObjMesh { part_names: std::mem::take(&mut faces.part_names), ..ObjMesh::default() };
    let crossing = cut_polygons(&mut faces)?;
    let notes = std::mem::take(&mut faces.notes);
    let parts = std::mem::take(&mut faces.parts);
    let missing = [&faces.vn, &faces.vt].map(|column| column.iter().filter(|&&i| i == NONE).count());
    let (positions, corners) = unify(faces, &mut mesh);
    place(&positions, &mut mesh)?;
    drop(positions);
    keep_triangles(&corners, parts, &mut mesh)?;
    describe(&notes, crossing, missing, &mut mesh);
    Ok(mesh)
}

/// Turns all faces into triangles; the number of outlines that cross themselves.
fn cut_polygons(faces: &mut Faces) -> Result<usize, Fault> {
    if faces.arities.is_empty() {
        return Ok(0);
    }
    let mut crossing = 0;
    let mut corners = Vec::with_capacity(faces.v.len() * 2);
    let mut parts = Vec::new();
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    let mut first = 0;
    for (face, &arity) in faces.arities.iter().enumerate() {
        points.clear();
        triangles.clear();
        let end = first + arity as usize;
        points.extend(faces.v[first..end].iter().map(|&v| faces.positions[v as usize]));
        match triangulate(&points, &mut triangles) {
            Cut::Whole => {}
            Cut::Crossing => crossing += 1,
            Cut::TooLarge => {
                let limit = super::polygon::MAX_EARS;
                let message =
                    format!("face {} is concave with {arity} corners; the limit is {limit}", face + 1);
                return Err(Fault::NotSupported(None, message));
            }
        }
        corners.extend(triangles.as_flattened().iter().map(|&k| first as u32 + k));
        if !faces.parts.is_empty() {
            parts.resize(corners.len() / 3, faces.parts[face]);
        }
        first = end;
    }
    for column in [&mut faces.v, &mut faces.vt, &mut faces.vn] {
        if !column.is_empty() {
            *column = corners.iter().map(|&k| column[k as usize]).collect();
        }
    }
    faces.parts = parts;
    faces.arities = Vec::new();
    Ok(crossing)
}

/// Fills the mesh's normals, uvs and `welded`; returns its positions, and a vertex per corner.
fn unify(mut faces: Faces, mesh: &mut ObjMesh) -> (Vec<DVec3>, Vec<u32>) {
    let follows = |column: &[u32]| column.is_empty() || column == faces.v;
    if follows(&faces.vt) && follows(&faces.vn) && all_used(&faces.v, faces.positions.len()) {
        let n = faces.positions.len();
        if !faces.vt.is_empty() {
            faces.uvs.truncate(n);
            mesh.uvs = faces.uvs;
        }
        if !faces.vn.is_empty() {
            faces.normals.truncate(n);
            mesh.normals = faces.normals;
        }
        return (faces.positions, faces.v);
    }
    let mut vertices = Unified::new(faces.positions.len());
    let column = |column: &[u32], k: usize| column.get(k).copied().unwrap_or(NONE);
    for k in 0..faces.v.len() {
        let (vt, vn) = (column(&faces.vt, k), column(&faces.vn, k));
        faces.v[k] = vertices.add(faces.v[k], vt, vn);
    }
    let keys = &vertices.keys;
    if !faces.vt.is_empty() {
        let pool = &faces.uvs;
        mesh.uvs = keys.iter().map(|key| pool.get(key[1] as usize).copied().unwrap_or(Vec2::ZERO)).collect();
    }
    if !faces.vn.is_empty() {
        let pool = &faces.normals;
        mesh.normals =
            keys.iter().map(|key| pool.get(key[2] as usize).copied().unwrap_or(Vec3::ZERO)).collect();
    }
    let welded: Vec<u32> = keys.iter().map(|key| vertices.first[key[0] as usize]).collect();
    if welded.iter().enumerate().any(|(i, &first)| i != first as usize) {
        mesh.welded = welded;
    }
    (keys.iter().map(|key| faces.positions[key[0] as usize]).collect(), faces.v)
}

fn all_used(indices: &[u32], count: usize) -> bool {
    let mut used = vec![false; count];
    for &i in indices {
        used[i as usize] = true;
    }
    used.iter().all(|&used| used)
}

/// Vertices by (position, uv, normal) index. Those of one position are a chain; where it gets long,
/// as at the tip of a cone, a table takes over, so that no file can make it slow.
struct Unified {
    keys: Vec<[u32; 3]>,
    /// First vertex of each position.
    first: Vec<u32>,
    /// The next vertex of the same position.
    next: Vec<u32>,
    rest: HashMap<[u32; 3], u32>,
}

const LONGEST_CHAIN: usize = 16;

impl Unified {
    fn new(positions: usize) -> Unified {
        Unified { keys: Vec::new(), first: vec![NONE; positions], next: Vec::new(), rest: HashMap::new() }
    }

    fn add(&mut self, v: u32, vt: u32, vn: u32) -> u32 {
        let key = [v, vt, vn];
        if self.first[v as usize] == NONE {
            self.first[v as usize] = self.keys.len() as u32;
            return self.push(key);
        }
        let mut at = self.first[v as usize] as usize;
        for _ in 1..LONGEST_CHAIN {
            if self.keys[at] == key {
                return at as u32;
            }
            if self.next[at] == NONE {
                self.next[at] = self.keys.len() as u32;
                return self.push(key);
            }
            at = self.next[at] as usize;
        }
        if self.keys[at] == key {
            return at as u32;
        }
        if let Some(&known) = self.rest.get(&key) {
            return known;
        }
        self.rest.insert(key, self.keys.len() as u32);
        self.push(key)
    }

    fn push(&mut self, key: [u32; 3]) -> u32 {
        self.keys.push(key);
        self.next.push(NONE);
        self.keys.len() as u32 - 1
    }
}

/// Fills the mesh's centre and positions.
fn place(positions: &[DVec3], mesh: &mut ObjMesh) -> Result<(), Fault> {
    let around = |(lo, hi): (DVec3, DVec3), p: &DVec3| (lo.min(*p), hi.max(*p));
    let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (lo, hi) = positions
        .par_chunks(1 << 16)
        .map(|some| some.iter().fold(none, around))
        .reduce(|| none, |a, b| (a.0.min(b.0), a.1.max(b.1)));
    mesh.center = 0.5 * lo + 0.5 * hi;
    mesh.positions = positions.par_iter().map(|&p| (p - mesh.center).as_vec3()).collect();
    if mesh.positions.par_iter().all(|p| p.is_finite()) {
        return Ok(());
    }
    Err(Fault::Invalid(
        None,
        format!("the mesh spans {:e}, more than can be rendered", (hi - lo).max_element()),
    ))
}

/// Fills the mesh's triangles and parts, leaving out those without area.
fn keep_triangles(corners: &[u32], parts: Vec<u32>, mesh: &mut ObjMesh) -> Result<(), Fault> {
    let (all, _) = corners.as_chunks::<3>();
    let positions = &mesh.positions;
    let counts: Vec<usize> = all
        .par_chunks(1 << 16)
        .map(|some| some.iter().filter(|triangle| is_flat(positions, triangle)).count())
        .collect();
    mesh.degenerate = counts.iter().sum();
    if mesh.degenerate == all.len() {
        let message = match all.len() {
            1 => "its one triangle has no area".to_owned(),
            n => format!("none of its {n} triangles has an area"),
        };
        return Err(Fault::Invalid(None, message));
    }
    if mesh.degenerate == 0 {
        mesh.triangles = all.to_vec();
        mesh.parts = parts;
    } else {
        let kept = |i: &usize| !is_flat(positions, &all[*i]);
        mesh.triangles = (0..all.len()).filter(kept).map(|i| all[i]).collect();
        mesh.parts = (0..parts.len()).filter(kept).map(|i| parts[i]).collect();
    }
    Ok(())
}

/// Exactly zero area. Differences of nearby single-precision numbers and their products are exact in
/// double precision, so this is no matter of rounding.
fn is_flat(positions: &[Vec3], &[a, b, c]: &[u32; 3]) -> bool {
    if a == b || b == c || c == a {
        return true;
    }
    let [a, b, c] = [a, b, c].map(|i| positions[i as usize].as_dvec3());
    (b - a).cross(c - a) == DVec3::ZERO
}

/// `missing` is of normals and uvs, in corners of triangles.
fn describe(notes: &Notes, crossing: usize, missing: [usize; 2], mesh: &mut ObjMesh) {
    let mut say = |n: usize, one: &str, many: &str| match n {
        0 => {}
        1 => mesh.warnings.push(format!("1 {one}")),
        n => mesh.warnings.push(format!("{n} {many}")),
    };
    say(mesh.degenerate, "degenerate triangle dropped", "degenerate triangles dropped");
    say(crossing, "polygon crosses itself", "polygons cross themselves");
    say(
        notes.bad_normals,
        "normal is zero or not finite: the geometric normal stands in",
        "normals are zero or not finite: the geometric normals stand in",
    );
    say(
        notes.bad_uvs,
        "texture coordinate is not finite: taken as (0, 0)",
        "texture coordinates are not finite: taken as (0, 0)",
    );
    let one = "corner without a normal among others with one: the geometric normal stands in";
    say(missing[0], one, "corners without a normal among others with one: the geometric normals stand in");
    let one = "corner without texture coordinates among others with them: taken as (0, 0)";
    say(missing[1], one, "corners without texture coordinates among others with them: taken as (0, 0)");
    if notes.several_smoothings && mesh.normals.is_empty() {
        mesh.warnings.push("smoothing groups are ignored".into());
    }
    if let Some((line, word)) = &notes.first_ignored {
        let first = format!("`{word}` in line {line}");
        mesh.warnings.push(match notes.ignored {
            1 => format!("1 statement ignored: {first}"),
            n => format!("{n} statements ignored, the first {first}"),
        });
    }
}
