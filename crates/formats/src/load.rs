//! Any scene file, by its extension.

use crate::assets::{MeshCache, extension, unknown_format};
use crate::mesh_scene::mesh_scene;
use crate::{Failure, mit6837, toml};
use kirkas_scene::Description;
use kirkas_scene::files::FileAccess;

/// The scene formats, by extension.
pub const SCENE_EXTENSIONS: [&str; 4] = ["toml", "txt", "obj", "ply"];

/// Read the scene `path`: native TOML, MIT 6.837 text, or a mesh that is framed and lit.
pub fn load(files: &FileAccess, path: &str) -> Result<Description, Failure> {
    load_cached(files, path, &MeshCache::default())
}

/// The same; a mesh that had to be read stays in `meshes` for [`crate::FormatAssets::with_cache`].
pub fn load_cached(files: &FileAccess, path: &str, meshes: &MeshCache) -> Result<Description, Failure> {
    match extension(path).as_str() {
        "toml" => toml::read(files, path),
        "txt" => mit6837::read(files, path),
        "obj" | "ply" => mesh_scene(files, path, meshes),
        _ => Err(unknown_format("scene", path, &SCENE_EXTENSIONS).into()),
    }
}
