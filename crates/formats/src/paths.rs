//! Paths in a description, as seen from another folder.

use kirkas_scene::files::resolve;
use kirkas_scene::{Catalog, Description, Kind, ParamType, Span, Value};

/// Rewrite every path in `description` so that it is right in a file that lies in `folder`: for writing a scene elsewhere than it
/// was read from. Paths that nobody wrote count from the root folder.
pub fn rebase_paths(description: &mut Description, catalog: &Catalog, folder: &str) {
    let sources = std::mem::take(&mut description.sources);
    for kind in Kind::ALL {
        for entity in description.all_mut(kind) {
            let Some(spec) = catalog.find(kind, &entity.type_name.text) else { continue };
            let is_path = |name: &str| catalog.rows(spec).any(|r| r.ty == ParamType::Path && r.name == name);
            for (_, node) in entity.params.0.iter_mut().filter(|(name, _)| is_path(&name.text)) {
                let Value::Text(path) = &node.value else { continue };
                if let Ok(full) = resolve(sources.folder(node.span.source), path) {
                    node.value = Value::Text(relative(folder, &full));
                    node.span = Span::NONE;
                }
            }
        }
    }
    description.sources = sources;
}

/// The path `full`, counted from the root folder, as seen from `folder`.
fn relative(folder: &str, full: &str) -> String {
    let from: Vec<&str> = folder.split('/').filter(|p| !p.is_empty() && *p != ".").collect();
    let to: Vec<&str> = full.split('/').collect();
    let shared = from.iter().zip(&to[..to.len() - 1]).take_while(|(a, b)| a == b).count();
    std::iter::repeat_n("..", from.len() - shared).chain(to[shared..].iter().copied()).collect::<Vec<_>>().join("/")
}
