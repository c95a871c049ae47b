//! Plain OBJ files, read in parallel.
//!
//! The file is taken in blocks that end at a line's end; while the next block is read, the current
//! one is cut into pieces at line ends, the pieces are parsed in parallel and appended in order. At no
//! time is the whole text in memory. Plain are `v` with three finite numbers, `vt`, `vn`, `f` with
//! positive indices, names, `s`, `mtllib`, comments and blank lines; at anything else the reading gives
//! up, without a word on why, because the reference reading finds the line and says it better.

use super::number::{float, index, is_blank};
use super::{Faces, NONE, PartName, direction};
use crate::math::{DVec3, Vec2};
use rayon::prelude::*;
use std::collections::HashMap;
use std::io::{self, Read};

const BLOCK_BYTES: usize = 4 << 20;
const PIECES: usize = 8;

/// Reads a plain file; `None` when it is not plain.
///
/// # Errors
/// Those of `source`.
pub(super) fn read(source: &mut (impl Read + Send)) -> io::Result<Option<Faces>> {
    read_blocks(source, BLOCK_BYTES)
}

fn read_blocks(source: &mut (impl Read + Send), block_bytes: usize) -> io::Result<Option<Faces>> {
    let mut pieces: Vec<Piece> = (0..PIECES).map(|_| Piece::default()).collect();
    let mut gathered = Gathered::default();
    let (mut block, mut next) = (Vec::new(), Vec::new());
    source.by_ref().take(block_bytes as u64).read_to_end(&mut next)?;
    if next.starts_with(b"\xef\xbb\xbf") {
        next.drain(..3);
    }
    while !next.is_empty() {
        std::mem::swap(&mut block, &mut next);
        // The start of the last line goes over to the next block, unless the file ends here.
        let is_last = block.len() < block_bytes - 3;
        let cut = if is_last { Some(block.len()) } else { block.iter().rposition(|&byte| byte == b'\n') };
        let Some(cut) = cut.filter(|&cut| cut > 0) else { return Ok(None) };
        next.clear();
        next.extend_from_slice(&block[cut..]);
        let (read, plain) = rayon::join(
            || {
                let room = (block_bytes - next.len()) as u64;
                source.by_ref().take(room).read_to_end(&mut next)
            },
            || parse(&block[..cut], &mut pieces),
        );
        read?;
        if !plain || !pieces.iter_mut().all(|piece| gathered.append(piece)) {
            return Ok(None);
        }
    }
    Ok(gathered.finish())
}

/// Cuts the text at line ends, a piece each; false when it is not plain.
fn parse(text: &[u8], pieces: &mut [Piece]) -> bool {
    let mut rest = text;
    let mut cuts = Vec::with_capacity(pieces.len());
    for left in (1..=pieces.len()).rev() {
        let aim = rest.len() / left;
        let end = rest[aim..].iter().position(|&byte| byte == b'\n').map_or(rest.len(), |n| aim + n + 1);
        let (piece, tail) = rest.split_at(if left == 1 { rest.len() } else { end });
        cuts.push(piece);
        rest = tail;
    }
    pieces.par_iter_mut().zip(cuts).all(|(piece, text)| {
        piece.clear();
        piece.parse(text).is_some()
    })
}

/// A name that changes the part of the faces after it.
enum Naming {
    Group(String),
    Material(String),
}

/// The statements of some successive lines.
#[derive(Default)]
struct Piece {
    faces: Faces,
    face_count: u32,
    /// Each with the number of faces before it.
    namings: Vec<(u32, Naming)>,
    /// Largest index seen, plus one, of v, vt, vn.
    reach: [u32; 3],
}

impl Piece {
    fn clear(&mut self) {
        let f = &mut self.faces;
        f.positions.clear();
        f.uvs.clear();
        f.normals.clear();
        for column in [&mut f.v, &mut f.vt, &mut f.vn, &mut f.arities] {
            column.clear();
        }
        f.notes = super::Notes::default();
        self.face_count = 0;
        self.namings.clear();
    }

    /// `None` when a line is not plain.
    fn parse(&mut self, text: &[u8]) -> Option<()> {
        let mut rest = text;
        loop {
            rest = skip_blanks(rest);
            rest = match rest {
                [] => return Some(()),
                [b'\n', rest @ ..] => rest,
                [b'v', blank, rest @ ..] if is_blank(*blank) => self.position(rest)?,
                [b'f', blank, rest @ ..] if is_blank(*blank) => self.face(rest)?,
                [b'v', b'n', blank, rest @ ..] if is_blank(*blank) => self.normal(rest)?,
                [b'v', b't', blank, rest @ ..] if is_blank(*blank) => self.uv(rest)?,
                _ => self.name(rest)?,
            };
        }
    }

    #[inline]
    fn position<'a>(&mut self, rest: &'a [u8]) -> Option<&'a [u8]> {
        let (v, rest) = floats(rest)?;
        self.faces.positions.push(DVec3::from_array(v));
        v.iter().all(|x| x.is_finite()).then_some(rest)
    }

    fn normal<'a>(&mut self, rest: &'a [u8]) -> Option<&'a [u8]> {
        let (v, rest) = floats(rest)?;
        let normal = direction(v);
        self.faces.notes.bad_normals += usize::from(normal == super::Vec3::ZERO);
        self.faces.normals.push(normal);
        Some(rest)
    }

    fn uv<'a>(&mut self, rest: &'a [u8]) -> Option<&'a [u8]> {
        let (uv, rest) = match floats::<2>(rest) {
            Some(found) => found,
            None => floats::<3>(rest).map(|([u, v, _], rest)| ([u, v], rest))?,
        };
        self.faces.push_uv(uv);
        Some(rest)
    }

    #[inline]
    fn face<'a>(&mut self, mut rest: &'a [u8]) -> Option<&'a [u8]> {
        let mut corners = 0u32;
        loop {
            rest = skip_blanks(rest);
            match rest {
                [] => break,
                [b'\n', tail @ ..] => {
                    rest = tail;
                    break;
                }
                _ => rest = self.corner(rest)?,
            }
            corners += 1;
        }
        if corners < 3 {
            return None;
        }
        self.faces.push_arity(corners, self.face_count);
        self.face_count += 1;
        Some(rest)
    }

    /// One of v, v/vt, v//vn, v/vt/vn.
    #[inline]
    fn corner<'a>(&mut self, text: &'a [u8]) -> Option<&'a [u8]> {
        let (v, n) = index(text)?;
        let mut rest = &text[n..];
        let (mut vt, mut vn) = (NONE, NONE);
        if let [b'/', tail @ ..] = rest {
            rest = tail;
            if rest.first() != Some(&b'/') {
                let (i, n) = index(rest)?;
                (vt, rest) = (i, &rest[n..]);
                self.reach[1] = self.reach[1].max(i + 1);
            }
            if let [b'/', tail @ ..] = rest {
                let (i, n) = index(tail)?;
                (vn, rest) = (i, &tail[n..]);
                self.reach[2] = self.reach[2].max(i + 1);
            }
        }
        self.reach[0] = self.reach[0].max(v + 1);
        self.faces.push_corner(v, vt, vn);
        rest.first().is_none_or(|&byte| byte == b'\n' || is_blank(byte)).then_some(rest)
    }

    /// The statements that are rare: names, comments.
    fn name<'a>(&mut self, line: &'a [u8]) -> Option<&'a [u8]> {
        let end = line.iter().position(|&byte| byte == b'\n').unwrap_or(line.len());
        let (line, rest) = line.split_at(end);
        if line.contains(&0) {
            return None;
        }
        if line[0] == b'#' {
            return Some(rest);
        }
        let line = line.trim_ascii();
        if line.ends_with(b"\\") || line.contains(&b'#') {
            return None;
        }
        let word = line.iter().position(|&byte| is_blank(byte)).unwrap_or(line.len());
        let value = line[word..].trim_ascii();
        let text = || String::from_utf8_lossy(value).into_owned();
        match &line[..word] {
            b"g" | b"o" => self.namings.push((self.face_count, Naming::Group(text()))),
            b"usemtl" => self.namings.push((self.face_count, Naming::Material(text()))),
            b"s" => self.faces.notes.smoothing(value),
            b"mtllib" => {}
            _ => return None,
        }
        Some(rest)
    }
}

#[inline]
fn skip_blanks(text: &[u8]) -> &[u8] {
    let mut rest = text;
    while let [byte, tail @ ..] = rest
        && is_blank(*byte)
    {
        rest = tail;
    }
    rest
}

/// N numbers and the end of the line.
#[inline]
fn floats<const N: usize>(mut rest: &[u8]) -> Option<([f64; N], &[u8])> {
    let mut values = [0.0; N];
    for value in &mut values {
        rest = skip_blanks(rest);
        let (x, n) = float(rest)?;
        *value = x;
        rest = &rest[n..];
    }
    match skip_blanks(rest) {
        [] => Some((values, &[])),
        [b'\n', rest @ ..] => Some((values, rest)),
        _ => None,
    }
}

/// The pieces so far, in the file's order.
#[derive(Default)]
struct Gathered {
    faces: Faces,
    face_count: u32,
    reach: [u32; 3],
    name: PartName,
    /// The part of `name`, if it has a face already.
    part: Option<u32>,
    known: HashMap<PartName, u32>,
}

impl Gathered {
    /// Empties the piece; false when there are more faces than can be counted.
    fn append(&mut self, piece: &mut Piece) -> bool {
        if self.face_count.checked_add(piece.face_count).is_none() {
            return false;
        }
        self.append_parts(piece);
        let (all, new) = (&mut self.faces, &mut piece.faces);
        all.append_corners(new, self.face_count, piece.face_count);
        all.positions.append(&mut new.positions);
        all.uvs.append(&mut new.uvs);
        all.normals.append(&mut new.normals);
        all.notes.bad_normals += new.notes.bad_normals;
        all.notes.bad_uvs += new.notes.bad_uvs;
        all.notes.several_smoothings |= new.notes.several_smoothings;
        if let Some(group) = &new.notes.smoothing {
            all.notes.smoothing(group);
        }
        self.face_count += piece.face_count;
        for (all, new) in self.reach.iter_mut().zip(piece.reach) {
            *all = (*all).max(new);
        }
        true
    }

    fn append_parts(&mut self, piece: &mut Piece) {
        let mut done = 0;
        for (before, naming) in std::mem::take(&mut piece.namings) {
            self.add_faces(done, before);
            done = before;
            let (slot, name) = match naming {
                Naming::Group(name) => (&mut self.name.group, name),
                Naming::Material(name) => (&mut self.name.material, name),
            };
            if *slot != name {
                *slot = name;
                self.part = None;
            }
        }
        self.add_faces(done, piece.face_count);
    }

    /// Faces `from..to` of the piece, counted on to those before it, belong to the current name.
    fn add_faces(&mut self, from: u32, to: u32) {
        if from == to {
            return;
        }
        let names = &mut self.faces.part_names;
        let part = *self.part.get_or_insert_with(|| {
            *self.known.entry(self.name.clone()).or_insert_with(|| {
                names.push(self.name.clone());
                names.len() as u32 - 1
            })
        });
        let parts = &mut self.faces.parts;
        if part > 0 && parts.is_empty() {
            parts.resize((self.face_count + from) as usize, 0);
        }
        if names.len() > 1 {
            parts.resize((self.face_count + to) as usize, part);
        }
    }

    /// `None` when an index points beyond the end, or there is no face at all.
    fn finish(self) -> Option<Faces> {
        let f = self.faces;
        let counts = [f.positions.len(), f.uvs.len(), f.normals.len()];
        let in_range = self.reach.iter().zip(counts).all(|(&reach, count)| reach as usize <= count);
        (in_range && self.face_count > 0).then_some(f)
    }
}

impl Faces {
    pub(super) fn push_uv(&mut self, [u, v]: [f64; 2]) {
        let uv = Vec2::new(u as f32, v as f32);
        self.notes.bad_uvs += usize::from(!uv.is_finite());
        self.uvs.push(if uv.is_finite() { uv } else { Vec2::ZERO });
    }

    #[inline]
    pub(super) fn push_corner(&mut self, v: u32, vt: u32, vn: u32) {
        for (column, i) in [(&mut self.vt, vt), (&mut self.vn, vn)] {
            if i != NONE || !column.is_empty() {
                // The first of its kind: the corners before it have none.
                column.resize(self.v.len(), NONE);
                column.push(i);
            }
        }
        self.v.push(v);
    }

    #[inline]
    pub(super) fn push_arity(&mut self, corners: u32, faces_before: u32) {
        if corners != 3 || !self.arities.is_empty() {
            self.arities.resize(faces_before as usize, 3);
            self.arities.push(corners);
        }
    }

    /// Moves `new`'s corners here, columns that are empty for "none" filled as needed.
    fn append_corners(&mut self, new: &mut Faces, faces_before: u32, new_faces: u32) {
        let (before, after) = (self.v.len(), self.v.len() + new.v.len());
        for (all, new) in [(&mut self.vt, &mut new.vt), (&mut self.vn, &mut new.vn)] {
            append_column(all, new, before, after, NONE);
        }
        let (before, after) = (faces_before as usize, (faces_before + new_faces) as usize);
        append_column(&mut self.arities, &mut new.arities, before, after, 3);
        self.v.append(&mut new.v);
    }
}

fn append_column(all: &mut Vec<u32>, new: &mut Vec<u32>, before: usize, after: usize, usual: u32) {
    if !all.is_empty() || !new.is_empty() {
        all.resize(before, usual);
        all.append(new);
        all.resize(after, usual);
    }
}
