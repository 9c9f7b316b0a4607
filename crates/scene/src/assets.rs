//! What the renderer asks for while it compiles a description: meshes and files. The formats answer.

use crate::{Diagnostic, Entity, SourceId};
use kirkas_geometry::{Vec2, Vec3};
use std::sync::Arc;

/// A triangle mesh as read: one index per corner for all its attributes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshData {
    /// Vertex positions.
    pub positions: Vec<Vec3>,
    /// Vertex normals (unit, or zero where unknown), one per position, or empty.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, one per position, or empty.
    pub uvs: Vec<Vec2>,
    /// Linear Rec.709 colours, one per position, or empty.
    pub colors: Vec<Vec3>,
    /// Corners of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Runs of triangles with one material; empty when the file names none.
    pub parts: Vec<MeshPart>,
    /// Materials (of `Kind::Material`) and textures (of `Kind::Texture`) that came with the mesh. Names are unique within the mesh.
    pub materials: Vec<Entity>,
    /// See `materials`.
    pub textures: Vec<Entity>,
    /// The source that paths in `textures` are relative to.
    pub folder: String,
}

/// A run of triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshPart {
    /// Name of one of the mesh's materials.
    pub material: String,
    /// First triangle.
    pub first: u32,
    /// How many.
    pub count: u32,
}

impl MeshData {
    /// All that must hold: attributes match, indices are in range, every number is finite.
    pub fn validate(&self) -> Result<(), String> {
        let n = self.positions.len();
        if [self.normals.len(), self.uvs.len(), self.colors.len()].iter().any(|&m| m != 0 && m != n) {
            return Err("normals, texture coordinates or colours do not match the vertices in number".into());
        }
        if let Some(i) = self.triangles.iter().position(|t| t.iter().any(|&i| i as usize >= n)) {
            return Err(format!("triangle {i} uses a vertex that does not exist (there are {n})"));
        }
        if let Some(i) = self.positions.iter().position(|p| !p.is_finite()) {
            return Err(format!("vertex {i} is not a finite point"));
        }
        Ok(())
    }
}

/// Answers the renderer's questions. `from` is the source whose folder `path` is relative to.
pub trait Assets {
    /// A mesh, by path; the extension tells the format.
    fn mesh(&self, from: Option<SourceId>, path: &str) -> Result<Arc<MeshData>, Diagnostic>;
    /// A file's bytes, by path.
    fn bytes(&self, from: Option<SourceId>, path: &str) -> Result<Arc<[u8]>, Diagnostic>;
}
