//! Meshes and other files that a scene names, for whoever compiles its description.

use crate::failure::{file_problem, standing_alone};
use crate::{Failure, obj, ply};
use kirkas_scene::files::{FileAccess, resolve};
use kirkas_scene::{Assets, Description, Diagnostic, Kind, MeshData, SourceId, Sources};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

/// The mesh formats, by extension.
pub const MESH_EXTENSIONS: [&str; 2] = ["obj", "ply"];

/// Meshes already read, by path from the root folder, and what their readers passed over.
#[derive(Debug, Default)]
pub struct MeshCache(Mutex<BTreeMap<String, ReadMesh>>);

/// A mesh and what its reader passed over.
type ReadMesh = (Arc<MeshData>, Vec<Diagnostic>);

impl MeshCache {
    /// The mesh `path`, relative to `folder`; read now unless it was read before.
    pub fn read(&self, files: &FileAccess, folder: &str, path: &str) -> Result<Arc<MeshData>, Failure> {
        let full = resolve(folder, path).map_err(|e| file_problem(&e))?;
        if let Some(mesh) = self.0.lock().ok().and_then(|m| m.get(&full).map(|(mesh, _)| mesh.clone())) {
            return Ok(mesh);
        }
        let (mesh, warnings) = read_mesh(files, &full)?;
        let mesh = Arc::new(mesh);
        if let Ok(mut meshes) = self.0.lock() {
            meshes.insert(full, (mesh.clone(), warnings));
        }
        Ok(mesh)
    }

    /// What could not be taken over from the meshes read so far, in order of their paths.
    pub fn warnings(&self) -> Vec<Diagnostic> {
        self.0.lock().map_or(Vec::new(), |m| m.values().flat_map(|(_, warnings)| warnings.clone()).collect())
    }
}

fn read_mesh(files: &FileAccess, path: &str) -> Result<(MeshData, Vec<Diagnostic>), Failure> {
    let extension = extension(path);
    if !MESH_EXTENSIONS.contains(&extension.as_str()) {
        return Err(unknown_format("mesh", path, &MESH_EXTENSIONS).into());
    }
    let (path, bytes) = files.read("", path).map_err(|e| file_problem(&e))?;
    let folder = path.rfind('/').map_or("", |i| &path[..i]);
    let mut library = |name: &str| Ok(files.read(folder, name).map_err(|e| file_problem(&e))?.1);
    let (mut mesh, warnings) = match extension.as_str() {
        "obj" => {
            let reading = obj::read_with_warnings(&bytes, &path, &mut library)?;
            let stands_alone = |w| standing_alone(&reading.sources, w);
            (reading.mesh, reading.warnings.into_iter().map(stands_alone).collect())
        }
        _ => (ply::read(&bytes, &path)?, Vec::new()),
    };
    mesh.validate().map_err(|why| Diagnostic::error("bad-mesh", format!("`{path}`: {why}")))?;

    // The mesh's own texts are not among the scene's: its spans must not point there.
    let mut things = Description::default();
    things.all_mut(Kind::Material).append(&mut mesh.materials);
    things.all_mut(Kind::Texture).append(&mut mesh.textures);
    let mut things = things.without_spans();
    mesh.materials.append(things.all_mut(Kind::Material));
    mesh.textures.append(things.all_mut(Kind::Texture));
    Ok((mesh, warnings))
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

    /// What could not be taken over from the meshes read so far.
    pub fn warnings(&self) -> Vec<Diagnostic> {
        self.meshes.warnings()
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
