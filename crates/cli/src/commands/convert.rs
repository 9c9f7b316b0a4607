//! `kirkas convert`: any scene as native TOML, which renders to the same picture.

use crate::output::{check_no_loss, write_atomically};
use crate::problem::{Outcome, Problem};
use crate::report;
use crate::scene_file::SceneFile;
use crate::settings::{SceneArgs, Settings};
use kirkas_formats::{rebase_paths, toml};
use kirkas_render::catalog;
use kirkas_scene::files::{FileAccess, Limits, MemoryFiles};
use kirkas_scene::{Catalog, Description, Diagnostic, Kind, ParamType, Value};
use std::path::{Component, Path, PathBuf};

const EXAMPLES: &str = "Examples:
  kirkas convert scene.txt scene.toml
  kirkas convert bunny.ply bunny.toml";

/// Write a scene of any format as native TOML
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Convert {
    #[command(flatten)]
    scene: SceneArgs,
    /// Scene to write: .toml
    #[arg(value_name = "OUT")]
    out: PathBuf,
}

/// Do it.
pub fn run(args: &Convert) -> Result<Outcome, Problem> {
    if args.out.extension().is_none_or(|e| !e.eq_ignore_ascii_case("toml")) {
        let message = format!("`{}`: scenes are written as `.toml` only", args.out.display());
        return Err(Problem::input(
            Diagnostic::error("unknown-format", message).help("give OUT the extension `.toml`"),
        ));
    }
    crate::output::check_writable(&args.out)?;
    let mut scene = SceneFile::open(&args.scene.scene, args.scene.root.as_deref())?;
    let inputs: Vec<PathBuf> = scene.files.record().keys().map(|k| scene.root.join(k)).collect();
    check_no_loss([args.out.as_path()], &inputs)?;
    let mut settings = Settings::new(&mut scene);
    settings.overrides(&args.scene.set);
    settings.finish()?;
    let catalog = catalog();

    // A scene that is wrong stays wrong in another format.
    let problems = kirkas_scene::validate::validate(&scene.description, &catalog);
    let (errors, warnings): (Vec<_>, Vec<_>) = problems.into_iter().partition(Diagnostic::is_error);
    if !errors.is_empty() {
        return Err(scene.failure(errors).into());
    }
    let warnings = scene.failure([scene.warnings.clone(), warnings].concat());
    report::print(&warnings.sources, &warnings.diagnostics);

    // Paths, as seen from the new file.
    let mut description = scene.description.clone();
    rebase_paths(&mut description, &catalog, "");
    let folder = match args.out.parent().filter(|p| !p.as_os_str().is_empty()) {
        Some(parent) => parent.canonicalize(),
        None => Path::new(".").canonicalize(),
    };
    let folder = folder.map_err(|e| Problem::failed(Diagnostic::error("cannot-write", e.to_string())))?;
    move_paths(&mut description, &catalog, &scene.root, &folder, args.scene.root.is_some())?;

    // Write, once it is sure to read back as what it was.
    let text = toml::write(&description);
    if reads_back(&text) != Some(description.without_spans()) {
        let message = format!("`{}` cannot be written as TOML without loss", args.scene.scene.display());
        return Err(Problem::failed(Diagnostic::error("cannot-convert", message).help("please report this scene")));
    }
    write_atomically(&args.out, text.as_bytes())?;
    Ok(Outcome::Done)
}

fn reads_back(text: &str) -> Option<Description> {
    let files = MemoryFiles([("out.toml".to_string(), text.as_bytes().to_vec())].into());
    let files = FileAccess::new(Box::new(files), Limits::default());
    toml::read(&files, "out.toml").ok().map(Description::without_spans)
}

/// From paths below `root` to paths as seen from `folder`. Those that climb need a root folder when they are read again.
fn move_paths(
    d: &mut Description,
    catalog: &Catalog,
    root: &Path,
    folder: &Path,
    may_climb: bool,
) -> Result<(), Problem> {
    for kind in Kind::ALL {
        for entity in d.all_mut(kind) {
            let Some(spec) = catalog.find(kind, &entity.type_name.text) else { continue };
            let is_path = |name: &str| catalog.rows(spec).any(|r| r.ty == ParamType::Path && r.name == name);
            for (_, node) in entity.params.0.iter_mut().filter(|(name, _)| is_path(&name.text)) {
                let Value::Text(path) = &mut node.value else { continue };
                let seen = relative(folder, &root.join(path.as_str()));
                if seen.starts_with("..") && !may_climb {
                    let message = format!("`{path}` would lie outside the folder of the new scene");
                    let cure = format!(
                        "write the new scene into `{}`, or give --root DIR (and give it again to render)",
                        root.display()
                    );
                    return Err(Problem::input(Diagnostic::error("file-outside", message).help(cure)));
                }
                *path = seen;
            }
        }
    }
    Ok(())
}

fn relative(folder: &Path, file: &Path) -> String {
    let (from, to): (Vec<Component>, Vec<Component>) = (folder.components().collect(), file.components().collect());
    let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    let up = std::iter::repeat_n("..".to_string(), from.len() - shared);
    let down = to[shared..].iter().map(|c| c.as_os_str().to_string_lossy().into_owned());
    up.chain(down).collect::<Vec<_>>().join("/")
}
