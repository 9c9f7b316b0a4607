//! Stanford PLY.
use crate::Failure;
use kirkas_scene::{Diagnostic, MeshData};
/// Read a mesh.
pub fn read(_: &[u8], _: &str) -> Result<MeshData, Failure> {
    Err(Diagnostic::error("todo", "no PLY reader yet").into())
}
