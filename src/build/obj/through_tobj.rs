//! The reference reading: the canonical form of the file, given to `tobj`, and its models gathered.
//!
//! `tobj` keeps polygons whole here and separate indices, because its own cut is a fan from the first
//! corner, wrong for concave polygons, and its single index has no place for missing normals.

use super::canonical::Canonical;
use super::{Faces, Fault, NONE, direction};
use crate::math::DVec3;
use std::io::{BufReader, Read};
use tobj::{LoadError, LoadOptions, Model};

/// # Errors
/// `Invalid` for every mistake, with its line; `Io` from `source`.
pub(super) fn read(source: &mut impl Read) -> Result<Faces, Fault> {
    let mut canonical = Canonical::new(BufReader::with_capacity(1 << 16, source));
    let loaded = tobj::load_obj_buf(&mut canonical, &LoadOptions::default(), |_| Err(LoadError::ReadError));
    if let Some(fault) = canonical.fault.take() {
        return Err(fault);
    }
    let (models, _) = loaded.map_err(|error| refusal(error, canonical.line))?;
    if canonical.faces == 0 {
        let seems_obj = canonical.counts[0] > 0 || canonical.lines == 0;
        let hint = if seems_obj { "" } else { ": is it an OBJ file?" };
        return Err(Fault::Invalid(None, format!("has no faces{hint}")));
    }
    let mut faces = Faces { part_names: canonical.part_names, notes: canonical.notes, ..Faces::default() };
    let mut place_of = vec![NONE; canonical.counts[0] as usize];
    let mut face_count = 0;
    for model in models {
        gather(model, &mut faces, &mut place_of, &mut face_count);
    }
    if faces.vt.iter().all(|&i| i == NONE) {
        faces.vt = Vec::new();
    }
    if faces.vn.iter().all(|&i| i == NONE) {
        faces.vn = Vec::new();
    }
    Ok(faces)
}

fn refusal(error: LoadError, line: u64) -> Fault {
    let message = match error {
        LoadError::FaceVertexOutOfBounds
        | LoadError::FaceTexCoordOutOfBounds
        | LoadError::FaceNormalOutOfBounds => {
            "a face above refers to a vertex that comes after its group".into()
        }
        other => other.to_string(),
    };
    Fault::Invalid(Some(line), message)
}

/// Adds a model, whose name is its part's number and whose colours are its positions' numbers.
fn gather(model: Model, faces: &mut Faces, place_of: &mut [u32], face_count: &mut u32) {
    let mesh = model.mesh;
    let triples = |values: &[f64]| values.as_chunks::<3>().0.to_vec();
    let numbers: Vec<usize> = triples(&mesh.vertex_color).iter().map(|color| color[0] as usize).collect();
    for (&number, position) in numbers.iter().zip(triples(&mesh.positions)) {
        if place_of[number] == NONE {
            place_of[number] = faces.positions.len() as u32;
            faces.positions.push(DVec3::from(position));
        }
    }
    // "Missing" was put in as what is no number.
    let uvs: Vec<u32> = (mesh.texcoords.as_chunks::<2>().0.iter())
        .map(|&uv| {
            if uv[0].is_nan() {
                return NONE;
            }
            faces.push_uv(uv);
            faces.uvs.len() as u32 - 1
        })
        .collect();
    let normals: Vec<u32> = (mesh.normals.as_chunks::<3>().0.iter())
        .map(|&normal| {
            if normal[0].is_nan() {
                return NONE;
            }
            faces.normals.push(direction(normal));
            faces.normals.len() as u32 - 1
        })
        .collect();
    for (k, &i) in mesh.indices.iter().enumerate() {
        let (vt, vn) = (mesh.texcoord_indices[k] as usize, mesh.normal_indices[k] as usize);
        faces.push_corner(place_of[numbers[i as usize]], uvs[vt], normals[vn]);
    }
    let part: u32 = model.name.parse().unwrap_or(0);
    let arities: Vec<u32> =
        if mesh.face_arities.is_empty() { vec![3; mesh.indices.len() / 3] } else { mesh.face_arities };
    for arity in arities {
        faces.push_arity(arity, *face_count);
        *face_count += 1;
        if faces.part_names.len() > 1 {
            faces.parts.push(part);
        }
    }
}
