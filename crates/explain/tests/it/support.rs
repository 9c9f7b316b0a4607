//! The scenes of the gallery, changed as a test wants them.

use kirkas_formats::toml::apply_override;
use kirkas_formats::{FormatAssets, load};
use kirkas_render::render::Undisturbed;
use kirkas_render::{Film, Options, Prepared, prepare};
use kirkas_scene::files::{FileAccess, Limits, MemoryFiles};
use kirkas_scene::{Kind, Map, Name};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes")
}

/// Every file of the gallery, by its path from the gallery's folder.
fn files() -> BTreeMap<String, Vec<u8>> {
    fn walk(at: &Path, top: &Path, all: &mut BTreeMap<String, Vec<u8>>) {
        for entry in std::fs::read_dir(at).expect("a folder").flatten() {
            let path = entry.path();
            if path.is_dir() {
                walk(&path, top, all);
            } else {
                let name = path.strip_prefix(top).expect("below").to_string_lossy().replace('\\', "/");
                all.insert(name, std::fs::read(&path).expect("a file"));
            }
        }
    }
    let mut all = BTreeMap::new();
    walk(&folder(), &folder(), &mut all);
    all
}

/// The names of all gallery scenes, such as `lecture/mirror.toml`.
pub fn scenes() -> Vec<String> {
    let is_scene = |name: &String| name.ends_with(".toml") && !name.contains("/parts/");
    files().into_keys().filter(is_scene).collect()
}

/// A gallery scene with these values set (the type of the integrator first), and with other files.
pub fn scene_with(name: &str, set: &[&str], more: &[(&str, Vec<u8>)]) -> Prepared {
    let mut all = files();
    all.extend(more.iter().map(|(name, bytes)| ((*name).to_string(), bytes.clone())));
    let access = FileAccess::new(Box::new(MemoryFiles(all)), Limits::default());
    let mut description = load(&access, name).unwrap_or_else(|e| panic!("{name}: {e:?}"));
    for line in set {
        if let Some(type_name) = line.strip_prefix("integrator.type=") {
            let integrator = description.single_mut(Kind::Integrator);
            if integrator.type_name.text != type_name {
                integrator.params = Map::default();
                integrator.type_name = Name::new(type_name);
            }
            continue;
        }
        apply_override(&mut description, line).unwrap_or_else(|e| panic!("{name}, {line}: {e:?}"));
    }
    let assets = FormatAssets::new(&access, &description.sources);
    prepare(&description, &assets, &Options::default()).unwrap_or_else(|e| panic!("{name}, {set:?}: {e:#?}"))
}

/// The same without other files.
pub fn scene(name: &str, set: &[&str]) -> Prepared {
    scene_with(name, set, &[])
}

/// All samples of all pixels.
pub fn expose(p: &Prepared) -> Film {
    let mut film = Film::new(p.film.clone());
    p.renderer(64).render(&mut film, 0..p.samples, &Undisturbed);
    film
}
