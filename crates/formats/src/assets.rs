//! Meshes and other files that a scene names, for whoever compiles its description.

use crate::failure::file_problem;
use crate::{Failure, obj, ply};
use kirkas_scene::files::{FileAccess, resolve};
use kirkas_scene::{Assets, Diagnostic, MeshData, SourceId, Sources};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

/// The mesh formats, by extension.
pub const MESH_EXTENSIONS: [&str; 2] = ["obj", "ply"];

/// Meshes already read, by path from the root folder.
#[derive(Debug, Default)]
pub struct MeshCache(Mutex<BTreeMap<String, Arc<MeshData>>>);

impl MeshCache {
    /// The mesh `path`, relative to `folder`; read now unless it was read before.
    pub fn read(&self, files: &FileAccess, folder: &str, path: &str) -> Result<Arc<MeshData>, Failure> {
        let full = resolve(folder, path).map_err(|e| file_problem(&e))?;
        if let Some(mesh) = self.0.lock().ok().and_then(|m| m.get(&full).cloned()) {
            return Ok(mesh);
        }
        let mesh = Arc::new(read_mesh(files, &full)?);
        if let Ok(mut meshes) = self.0.lock() {
            meshes.insert(full, mesh.clone());
        }
        Ok(mesh)
    }
}

fn read_mesh(files: &FileAccess, path: &str) -> Result<MeshData, Failure> {
    let extension = extension(path);
    if !MESH_EXTENSIONS.contains(&extension.as_str()) {
        return Err(unknown_format("mesh", path, &MESH_EXTENSIONS).into());
    }
    let (path, bytes) = files.read("", path).map_err(|e| file_problem(&e))?;
    let folder = path.rfind('/').map_or("", |i| &path[..i]);
    let mesh = match extension.as_str() {
        "obj" => obj::read(&bytes, &path, &mut |name| Ok(files.read(folder, name).map_err(|e| file_problem(&e))?.1))?,
        _ => ply::read(&bytes, &path)?,
    };
    mesh.validate().map_err(|why| Diagnostic::error("bad-mesh", format!("`{path}`: {why}")))?;
    Ok(mesh)
}

/// The part of the path after the last point, in lower case.
pub(crate) fn extension(path: &str) -> String {
    let file = path.rsplit(['/', '\\']).next().unwrap_or(path);
    file.rsplit_once('.').map_or(String::new(), |(_, e)| e.to_lowercase())
}

pub(crate) fn unknown_format(what: &str, path: &str, known: &[&str]) -> Diagnostic {
    let extension = extension(path);
    let known = known.iter().map(|e| format!("`.{e}`")).collect::<Vec<_>>().join(", ");
    let message = match extension.is_empty() {
        true => format!("`{path}` has no extension that tells its format"),
        false => format!("`{path}`: `.{extension}` is not a {what} format that Kirkas reads"),
    };
    Diagnostic::error("unknown-format", message).help(format!("use one of: {known}"))
}

/// Answers the renderer's questions about the files beside a description.
pub struct FormatAssets<'a> {
    files: &'a FileAccess,
    sources: &'a Sources,
    meshes: Arc<MeshCache>,
}

impl<'a> FormatAssets<'a> {
    /// For the description that `sources` belongs to. Each mesh is read once.
    pub fn new(files: &'a FileAccess, sources: &'a Sources) -> Self {
        Self::with_cache(files, sources, Arc::default())
    }

    /// The same, knowing the meshes that [`crate::load_cached`] has read already.
    pub fn with_cache(files: &'a FileAccess, sources: &'a Sources, meshes: Arc<MeshCache>) -> Self {
        FormatAssets { files, sources, meshes }
    }

    fn folder(&self, from: Option<SourceId>) -> &str {
        from.map_or("", |id| self.sources.folder(id))
    }
}

impl Assets for FormatAssets<'_> {
    fn mesh(&self, from: Option<SourceId>, path: &str) -> Result<Arc<MeshData>, Diagnostic> {
        self.meshes.read(self.files, self.folder(from), path).map_err(Failure::into_diagnostic)
    }

    fn bytes(&self, from: Option<SourceId>, path: &str) -> Result<Arc<[u8]>, Diagnostic> {
        Ok(self.files.read(self.folder(from), path).map_err(|e| file_problem(&e))?.1)
    }
}
