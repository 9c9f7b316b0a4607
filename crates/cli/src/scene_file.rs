//! A scene file on the disk, opened: the root folder below which it may read, and its description.

use crate::disk_files::DiskFiles;
use crate::input::cannot_read;
use crate::problem::Problem;
use kirkas_formats::assets::MeshCache;
use kirkas_formats::load::load_with_warnings;
use kirkas_formats::{Failure, FormatAssets};
use kirkas_scene::files::{FileAccess, Limits};
use kirkas_scene::{Description, Diagnostic};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A scene and the door to its files.
pub struct SceneFile {
    /// What it says.
    pub description: Description,
    /// What its format could not say exactly.
    pub warnings: Vec<Diagnostic>,
    /// Reads and records.
    pub files: FileAccess,
    /// The folder below which everything lies, canonical.
    pub root: PathBuf,
    meshes: Arc<MeshCache>,
    /// What the user calls the root folder: "" or ending in `/`.
    prefix: String,
}

impl SceneFile {
    /// Open the scene at `path`, which may read below `root` (absent: below its own folder).
    pub fn open(path: &Path, root: Option<&Path>) -> Result<Self, Problem> {
        let (root, name, prefix) = locate(path, root)?;
        let files = FileAccess::new(Box::new(DiskFiles::new(root.clone())), Limits::default());
        let meshes = Arc::new(MeshCache::default());
        let (description, warnings) =
            load_with_warnings(&files, &name, &meshes).map_err(|f| Problem::from(told_to_user(f, &prefix)))?;
        Ok(SceneFile { description, warnings, files, root, meshes, prefix })
    }

    /// A scene that nobody wrote, which may read files below `root`.
    pub fn described(description: Description, root: PathBuf) -> Self {
        let files = FileAccess::new(Box::new(DiskFiles::new(root.clone())), Limits::default());
        SceneFile { description, warnings: Vec::new(), files, root, meshes: Arc::default(), prefix: String::new() }
    }

    /// Answers the renderer's questions.
    pub fn assets(&self) -> FormatAssets<'_> {
        FormatAssets::with_cache(&self.files, &self.description.sources, self.meshes.clone())
    }

    /// What the meshes read so far could not give.
    pub fn mesh_warnings(&self) -> Vec<Diagnostic> {
        self.meshes.warnings()
    }

    /// These diagnostics, in words and paths that the user knows.
    pub fn failure(&self, diagnostics: Vec<Diagnostic>) -> Failure {
        told_to_user(Failure::new(self.description.sources.clone(), diagnostics), &self.prefix)
    }
}

/// Root folder, path from there, and what the user calls the root folder.
fn locate(path: &Path, root: Option<&Path>) -> Result<(PathBuf, String, String), Problem> {
    if path.is_dir() {
        return Err(Problem::input(
            Diagnostic::error("not-a-file", format!("`{}` is a folder", path.display()))
                .help("name a scene file in it"),
        ));
    }
    let full = path.canonicalize().map_err(|e| cannot_read(path, &e))?;
    let own = full.parent().unwrap_or(Path::new("/")).to_path_buf();
    let Some(asked) = root else {
        // The scene's own name, not that of a file that it is a link to: its extension tells the format.
        let given = path.file_name().unwrap_or_default();
        let (folder, name) = match path.parent().map(|p| if p.as_os_str().is_empty() { Path::new(".") } else { p }) {
            Some(parent) if path.is_symlink() => (parent.canonicalize().map_err(|e| cannot_read(path, &e))?, given),
            _ => (own, full.file_name().unwrap_or_default()),
        };
        let shown = path.to_string_lossy().replace('\\', "/");
        let prefix = shown.rfind('/').map_or(String::new(), |i| shown[..=i].to_string());
        return Ok((folder, name.to_string_lossy().into_owned(), prefix));
    };
    let root = asked.canonicalize().map_err(|e| cannot_read(asked, &e))?;
    let Ok(inner) = full.strip_prefix(&root) else {
        return Err(Problem::input(
            Diagnostic::error("file-outside", format!("`{}` does not lie in `{}`", path.display(), asked.display()))
                .help("let --root name a folder that holds the scene and all its files"),
        ));
    };
    let shown = asked.to_string_lossy().trim_end_matches('/').to_string() + "/";
    Ok((root.clone(), inner.to_string_lossy().replace('\\', "/"), if shown == "./" { String::new() } else { shown }))
}

/// Paths as the user wrote them, and the cure that only the command line knows.
fn told_to_user(mut failure: Failure, prefix: &str) -> Failure {
    for source in failure.sources.0.iter_mut().filter(|s| !s.path.starts_with('-')) {
        source.path.insert_str(0, prefix);
    }
    for diagnostic in failure.diagnostics.iter_mut().filter(|d| d.code == "file-outside") {
        diagnostic.help = Some("give --root DIR, a folder that holds the scene and all its files".into());
    }
    failure
}
