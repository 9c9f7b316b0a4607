//! Files that a command names itself.

use crate::problem::Problem;
use kirkas_scene::Diagnostic;
use kirkas_scene::diagnostic::nearest;
use std::io::{Error, ErrorKind};
use std::path::Path;

/// All bytes of a file.
pub fn read_file(path: &Path) -> Result<Vec<u8>, Problem> {
    std::fs::read(path).map_err(|e| cannot_read(path, &e))
}

/// Why `path` cannot be read, with the name that may have been meant.
pub fn cannot_read(path: &Path, error: &Error) -> Problem {
    let (code, message) = match error.kind() {
        ErrorKind::NotFound => ("file-not-found", format!("there is no file `{}`", path.display())),
        _ => ("file-unreadable", format!("`{}` cannot be read: {error}", path.display())),
    };
    let near = near_file(path).map(|n| format!("did you mean `{n}`?"));
    Problem::input(Diagnostic::error(code, message).help(near.unwrap_or("check the path".into())))
}

/// The path in the same folder that is nearest to a misspelt one.
fn near_file(path: &Path) -> Option<String> {
    let folder = path.parent().map(|p| if p.as_os_str().is_empty() { Path::new(".") } else { p })?;
    let entries = std::fs::read_dir(folder).ok()?.flatten();
    let mut names: Vec<String> = entries.map(|e| e.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    let near = nearest(&path.file_name()?.to_string_lossy(), names.iter().map(String::as_str))?.to_string();
    Some(path.with_file_name(near).display().to_string())
}
