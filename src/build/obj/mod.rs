//! Triangle meshes from Wavefront OBJ files.
//!
//! The reference reading goes through the `tobj` library (`through_tobj.rs`), which is given the
//! file line by line in a canonical form (`canonical.rs`): that is where every mistake is found,
//! with its line. Files of nothing but plain statements, which is what exporters write, are read in
//! parallel by `plain.rs` instead, several times as fast; whatever it does not know, it leaves to the
//! reference. Both give the same faces, from which `assemble.rs` makes the mesh.
//!
//! Read: `v`, `vt`, `vn`, `f`, `g`, `o`, `usemtl`. Smoothing groups are ignored, with a warning where
//! they would show. No file but the OBJ is ever opened: materials are named, never loaded.

mod assemble;
mod canonical;
mod number;
mod plain;
mod polygon;
mod through_tobj;

use crate::description::Reach;
use crate::math::{DVec3, Vec2, Vec3};
use std::io::{self, Read, Seek};
use std::path::{Path, PathBuf};

/// Largest file that is read, in bytes. Every index then fits in 32 bits.
const MAX_BYTES: u64 = 4 << 30;

/// A triangle mesh as its file says it, vertices unified over (position, normal, uv).
#[derive(Clone, Debug, Default)]
pub struct ObjMesh {
    /// Subtracted from the positions in double precision, before they were rounded to single, so
    /// that a mesh far from its origin keeps its detail.
    pub center: DVec3,
    /// Relative to `center`; finite.
    pub positions: Vec<Vec3>,
    /// A unit vector per vertex, or zero where the file has none (or one that has no direction);
    /// empty when no vertex has one.
    pub normals: Vec<Vec3>,
    /// A pair per vertex, (0, 0) where the file has none; empty when no vertex has one.
    pub uvs: Vec<Vec2>,
    /// Three vertices each, counter-clockwise seen from the front, none of zero area.
    pub triangles: Vec<[u32; 3]>,
    /// Index into `part_names` per triangle; empty when all are 0.
    pub parts: Vec<u32>,
    /// In the order of their first face; at least one.
    pub part_names: Vec<PartName>,
    /// Per vertex the first vertex of the same `v` line: vertices that share it differ in normal or
    /// uv only, and normals computed from the triangles must be shared among them. Empty when each
    /// vertex is its own.
    pub welded: Vec<u32>,
    /// How many triangles were dropped for having no area.
    pub degenerate: usize,
    /// What was ignored or mended, counted, in words.
    pub warnings: Vec<String>,
}

/// The names that stood above a face. Empty where there was none.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct PartName {
    /// Of the last `g` or `o`.
    pub group: String,
    /// Of the last `usemtl`.
    pub material: String,
}

/// Why there is no mesh.
#[derive(Debug, thiserror::Error)]
pub enum ObjError {
    /// The file could not be read.
    #[error("{}: {source}", path.display())]
    Io { path: PathBuf, source: io::Error },
    /// The file is not what it should be. Lines count from 1.
    #[error("{}: {message}", place(path, *line))]
    Invalid { path: PathBuf, line: Option<u64>, message: String },
    /// The file may well be right, but goes beyond what is read here.
    #[error("{}: {message}", place(path, *line))]
    NotSupported { path: PathBuf, line: Option<u64>, message: String },
}

fn place(path: &Path, line: Option<u64>) -> String {
    match line {
        Some(line) => format!("{}:{line}", path.display()),
        None => path.display().to_string(),
    }
}

/// A fault before the file's name is put to it.
#[derive(Debug)]
enum Fault {
    Io(io::Error),
    Invalid(Option<u64>, String),
    NotSupported(Option<u64>, String),
}

impl Fault {
    fn at(self, path: &Path) -> ObjError {
        let path = path.to_owned();
        match self {
            Fault::Io(source) => ObjError::Io { path, source },
            Fault::Invalid(line, message) => ObjError::Invalid { path, line, message },
            Fault::NotSupported(line, message) => ObjError::NotSupported { path, line, message },
        }
    }
}

impl From<io::Error> for Fault {
    fn from(source: io::Error) -> Fault {
        Fault::Io(source)
    }
}

/// Loads the mesh of an OBJ file.
///
/// # Errors
/// `Io` when the file cannot be read; `Invalid`, with the line where there is one, when it is no
/// regular file, not OBJ, or has no faces; `NotSupported` beyond 4 GiB and for concave polygons of
/// thousands of corners.
pub fn load(path: &Path) -> Result<ObjMesh, ObjError> {
    load_within(&Reach::default(), path)
}

/// As [`load`], of a file within reach.
///
/// # Errors
/// As [`load`].
pub fn load_within(reach: &Reach, path: &Path) -> Result<ObjMesh, ObjError> {
    reach.open(path).map_err(Fault::from).and_then(|mut file| read(&mut file)).map_err(|fault| fault.at(path))
}

/// Loads the mesh of an OBJ text from anything that can be read and rewound; `name` stands for the
/// path in messages.
///
/// # Errors
/// As [`load`].
pub fn load_from(mut source: impl Read + Seek + Send, name: &Path) -> Result<ObjMesh, ObjError> {
    read(&mut source).map_err(|fault| fault.at(name))
}

/// Loads through the reference reading only, however plain the file: for comparison.
///
/// # Errors
/// As [`load`].
#[doc(hidden)]
pub fn load_by_reference(mut source: impl Read + Seek + Send, name: &Path) -> Result<ObjMesh, ObjError> {
    through_tobj::read(&mut source).and_then(assemble::mesh).map_err(|fault| fault.at(name))
}

fn read(source: &mut (impl Read + Seek + Send)) -> Result<ObjMesh, Fault> {
    let bytes = source.seek(io::SeekFrom::End(0))?;
    if bytes > MAX_BYTES {
        let gib = bytes as f64 / (1u64 << 30) as f64;
        return Err(Fault::NotSupported(None, format!("has {gib:.1} GiB; the limit is 4 GiB")));
    }
    source.rewind()?;
    if let Some(faces) = plain::read(&mut source.by_ref().take(bytes))? {
        return assemble::mesh(faces);
    }
    source.rewind()?;
    through_tobj::read(&mut source.by_ref().take(bytes)).and_then(assemble::mesh)
}

/// A missing normal or uv index.
const NONE: u32 = u32::MAX;

/// What both readings give: the file's statements, resolved to numbers from 0.
#[derive(Debug, Default)]
struct Faces {
    positions: Vec<DVec3>,
    uvs: Vec<Vec2>,
    /// Unit length or zero.
    normals: Vec<Vec3>,
    /// Index into `positions` per corner, face after face; in range.
    v: Vec<u32>,
    /// Index into `uvs` per corner, or `NONE`; empty when no corner has one.
    vt: Vec<u32>,
    /// Index into `normals` per corner, or `NONE`; empty when no corner has one.
    vn: Vec<u32>,
    /// Corners per face, at least 3; empty when all are triangles.
    arities: Vec<u32>,
    /// Part per face; empty when all are 0.
    parts: Vec<u32>,
    part_names: Vec<PartName>,
    notes: Notes,
}

/// What a reading has seen that deserves a word.
#[derive(Clone, Debug, Default)]
struct Notes {
    /// `vn` lines that give no direction.
    bad_normals: usize,
    /// `vt` lines that are not finite.
    bad_uvs: usize,
    /// The first smoothing group, and whether there is a second.
    smoothing: Option<Vec<u8>>,
    several_smoothings: bool,
    /// Statements of other kinds: how many, and the first one's line and keyword.
    ignored: usize,
    first_ignored: Option<(u64, String)>,
}

impl Notes {
    fn smoothing(&mut self, group: &[u8]) {
        match &self.smoothing {
            None => self.smoothing = Some(group.to_vec()),
            Some(first) => self.several_smoothings |= first != group,
        }
    }
}

/// The unit vector along (x, y, z), or zero where there is no direction.
fn direction(v: [f64; 3]) -> Vec3 {
    let largest = v[0].abs().max(v[1].abs()).max(v[2].abs());
    if !(v.iter().all(|x| x.is_finite()) && largest > 0.0) {
        return Vec3::ZERO;
    }
    // Divided first, so that neither huge nor tiny lengths leave the range.
    (DVec3::from(v) / largest).normalize_or_zero().as_vec3()
}
