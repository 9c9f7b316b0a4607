//! Wavefront OBJ.
use crate::Failure;
use kirkas_scene::{Diagnostic, MeshData};
use std::sync::Arc;
/// Read a mesh.
pub fn read(_: &[u8], _: &str, _: &mut dyn FnMut(&str) -> Result<Arc<[u8]>, Diagnostic>) -> Result<MeshData, Failure> {
    Err(Diagnostic::error("todo", "no OBJ reader yet").into())
}
