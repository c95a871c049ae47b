//! Mesh files, each loaded once, with its tree.

use super::world::Mesh;
use super::{BuildError, obj};
use crate::build::bvh::TriangleBvh;
use crate::description::{Reach, Smooth};
use crate::math::{DVec3, Vec3};
use crate::optics::TriangleMesh;
use std::collections::HashMap;
use std::path::PathBuf;

/// A loaded mesh: its geometry, and where its own origin lies in the file's coordinates.
#[derive(Clone, Debug)]
pub(super) struct LoadedMesh {
    pub geometry: u32,
    pub center: DVec3,
    pub parts: Vec<obj::PartName>,
}

#[derive(Default)]
pub(super) struct Meshes {
    reach: Reach,
    loaded: HashMap<(PathBuf, Smooth), LoadedMesh>,
    pub files: Vec<PathBuf>,
    pub warnings: Vec<String>,
}

impl Meshes {
    /// Of files within reach.
    pub fn within(reach: &Reach) -> Meshes {
        Meshes { reach: reach.clone(), ..Meshes::default() }
    }

    /// The mesh of a file; `add` stores a new one and returns its index.
    pub fn get(
        &mut self,
        path: &str,
        smooth: Smooth,
        add: impl FnOnce(Mesh) -> u32,
    ) -> Result<LoadedMesh, BuildError> {
        let file = PathBuf::from(path);
        let key = (file.canonicalize().unwrap_or_else(|_| file.clone()), smooth);
        if let Some(mesh) = self.loaded.get(&key) {
            return Ok(mesh.clone());
        }
        let mut read = obj::load_within(&self.reach, &file)?;
        self.warnings.append(&mut read.warnings);
        let normals = match smooth {
            Smooth::Flat => Vec::new(),
            Smooth::Interpolated if read.normals.is_empty() => averaged_normals(&read),
            Smooth::Interpolated => read.normals,
        };
        let tree = TriangleBvh::build(&read.positions, &read.triangles);
        let surface = TriangleMesh {
            positions: read.positions,
            normals,
            uvs: read.uvs,
            triangles: read.triangles,
            parts: read.parts,
        };
        let mesh = LoadedMesh {
            geometry: add(Mesh::new(surface, tree, path.to_owned())),
            center: read.center,
            parts: read.part_names,
        };
        self.files.push(file);
        self.loaded.insert(key, mesh.clone());
        Ok(mesh)
    }
}

/// Angle-weighted normals, shared by the vertices of one place.
fn averaged_normals(read: &obj::ObjMesh) -> Vec<Vec3> {
    if read.welded.is_empty() {
        return TriangleMesh::angle_weighted_normals(&read.positions, &read.triangles);
    }
    let welded: Vec<[u32; 3]> = read.triangles.iter().map(|t| t.map(|v| read.welded[v as usize])).collect();
    let normals = TriangleMesh::angle_weighted_normals(&read.positions, &welded);
    read.welded.iter().map(|&v| normals[v as usize]).collect()
}
