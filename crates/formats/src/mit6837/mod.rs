//! Scene text of MIT 6.837.
use crate::Failure;
use kirkas_scene::{Description, Diagnostic, files::FileAccess};
/// Read a scene.
pub fn read(_: &FileAccess, _: &str) -> Result<Description, Failure> {
    Err(Diagnostic::error("todo", "no 6.837 reader yet").into())
}
