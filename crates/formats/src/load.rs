//! Any scene file, by its extension.

use crate::assets::{MeshCache, extension, unknown_format};
use crate::mesh_scene::mesh_scene;
use crate::{Failure, mit6837, toml};
use kirkas_scene::files::FileAccess;
use kirkas_scene::{Description, Diagnostic};

/// The scene formats, by extension.
pub const SCENE_EXTENSIONS: [&str; 4] = ["toml", "txt", "obj", "ply"];

/// Read the scene `path`: native TOML, MIT 6.837 text, or a mesh that is framed and lit.
pub fn load(files: &FileAccess, path: &str) -> Result<Description, Failure> {
    load_cached(files, path, &MeshCache::default())
}

/// The same; a mesh that had to be read stays in `meshes` for [`crate::FormatAssets::with_cache`].
pub fn load_cached(files: &FileAccess, path: &str, meshes: &MeshCache) -> Result<Description, Failure> {
    load_with_warnings(files, path, meshes).map(|(description, _)| description)
}

/// The same, with what the format could not say exactly; the warnings point into the description's sources. What the meshes
/// could not say stands in [`MeshCache::warnings`], once they are read.
pub fn load_with_warnings(
    files: &FileAccess,
    path: &str,
    meshes: &MeshCache,
) -> Result<(Description, Vec<Diagnostic>), Failure> {
    match extension(path).as_str() {
        "toml" => Ok((toml::read(files, path)?, Vec::new())),
        "txt" => mit6837::read_with_warnings(files, path),
        "obj" | "ply" => Ok((mesh_scene(files, path, meshes)?, Vec::new())),
        _ => Err(unknown_format("scene", path, &SCENE_EXTENSIONS).into()),
    }
}
