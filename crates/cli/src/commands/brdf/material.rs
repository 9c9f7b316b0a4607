//! The materials a command names: by type, out of a scene, or as a file of measurements.

use crate::input::cannot_read;
use crate::problem::Problem;
use crate::scene_file::SceneFile;
use kirkas_formats::load::SCENE_EXTENSIONS;
use kirkas_formats::toml::apply_override;
use kirkas_geometry::DVec3;
use kirkas_optics::{Bsdf, ColorMode, Index, Interface, Lanes, LobeSet};
use kirkas_render::textures::TexturePoint;
use kirkas_render::{Options, Prepared, prepare};
use kirkas_scene::diagnostic::{nearest, unknown_name};
use kirkas_scene::{Description, Diagnostic, Entity, Kind, Map, Name, Span};
use std::path::{Path, PathBuf};

/// The formats of measurements, by extension.
const MEASURED: [&str; 2] = ["binary", "bsdf"];

/// Which materials.
#[derive(Clone, Debug, clap::Args)]
pub struct MaterialArgs {
    /// TYPE[:NAME=VALUE,...], SCENE#NAME, or a file of measurements (.binary, .bsdf)
    #[arg(value_name = "MATERIAL", required = true)]
    pub materials: Vec<String>,
    #[command(flatten)]
    pub common: CommonArgs,
}

/// What is said of all materials.
#[derive(Clone, Debug, clap::Args)]
pub struct CommonArgs {
    /// Set a parameter of every material
    #[arg(long, value_name = "NAME=VALUE")]
    pub set: Vec<String>,
    /// What a material is called, in their order; may be given several times
    #[arg(long, value_name = "TEXT")]
    pub label: Vec<String>,
    /// Light as rgb, or spectral: as wavelengths
    #[arg(long, value_name = "MODE", default_value = "rgb", value_parser = ColorMode::NAMES)]
    pub color: String,
}

impl CommonArgs {
    /// How colour is carried.
    pub fn mode(&self) -> ColorMode {
        ColorMode::from_name(&self.color).unwrap_or_default()
    }

    /// All materials that are named.
    pub fn open(&self, texts: &[String]) -> Result<Vec<Matter>, Problem> {
        texts
            .iter()
            .enumerate()
            .map(|(i, text)| Matter::open(text, self.label.get(i), &self.set, self.mode()))
            .collect()
    }
}

impl MaterialArgs {
    /// All of them.
    pub fn open(&self) -> Result<Vec<Matter>, Problem> {
        self.common.open(&self.materials)
    }
}

/// A material on its own.
pub struct Matter {
    /// What it is called.
    pub label: String,
    /// The scene that it is of: nothing but materials and what they need.
    pub file: SceneFile,
    /// Its name there.
    pub name: String,
    mode: ColorMode,
    prepared: Prepared,
    number: usize,
}

impl Matter {
    /// The material that `text` names, with the parameters in it and in `set`.
    pub fn open(text: &str, label: Option<&String>, set: &[String], mode: ColorMode) -> Result<Self, Problem> {
        let (source, inline) = split(text);
        let (mut file, name) = find(source)?;
        let label = label.cloned().unwrap_or_else(|| shown(source, &inline));
        let mut wrong = Vec::new();
        for parameter in inline.iter().copied().chain(set.iter().map(String::as_str)) {
            let done = set_parameter(&mut file.description, &name, parameter);
            wrong.extend(done.err());
        }
        if !wrong.is_empty() {
            return Err(file.failure(wrong).into());
        }
        Self::of(file, name, label, mode)
    }

    /// The same material with one more parameter.
    pub fn with(&self, parameter: &str, label: String) -> Result<Self, Problem> {
        let mut file = SceneFile::described(self.file.description.clone(), self.file.root.clone());
        match set_parameter(&mut file.description, &self.name, parameter) {
            Err(wrong) => Err(file.failure(vec![wrong]).into()),
            Ok(()) => Self::of(file, self.name.clone(), label, self.mode),
        }
    }

    /// The same material as another type, with the parameters that this type knows.
    pub fn retyped(&self, type_name: &str) -> Result<Self, Problem> {
        let mut description = self.file.description.clone();
        let catalog = kirkas_render::catalog();
        let rows = catalog.find(Kind::Material, type_name).map_or(&[][..], |spec| spec.params);
        if let Some(e) = description.all_mut(Kind::Material).iter_mut().find(|e| e.name.text == self.name) {
            e.type_name = Name::new(type_name);
            e.params.0.retain(|(name, _)| rows.iter().any(|r| r.name == name.text));
        }
        let file = SceneFile::described(description, self.file.root.clone());
        Self::of(file, self.name.clone(), self.label.clone(), self.mode)
    }

    fn of(file: SceneFile, name: String, label: String, mode: ColorMode) -> Result<Self, Problem> {
        // The smallest scene in which it can be looked at.
        let mut description = file.description.clone();
        let film = Map::default().with("width", 1_i64).with("height", 1_i64).with("color", mode.name());
        *description.all_mut(Kind::Film) = vec![Entity::new("", "image", film)];
        *description.all_mut(Kind::Camera) = vec![Entity::new("camera", "perspective", Map::default())];
        let ball = Map::default().with("material", name.as_str());
        *description.all_mut(Kind::Object) = vec![Entity::new("ball", "sphere", ball)];
        let prepared = prepare(&description, &file.assets(), &Options::default()).map_err(|d| file.failure(d))?;
        let number = prepared.scene.materials.iter().position(|m| m.name == name);
        let number = number.ok_or_else(|| Problem::input(Diagnostic::error("no-material", format!("no `{name}`"))))?;
        Ok(Matter { label, file, name, mode, prepared, number })
    }

    /// What it is at the middle of its textures, in vacuum.
    pub fn at(&self, lanes: &Lanes) -> Bsdf {
        let scene = &self.prepared.scene;
        let material = &scene.materials[self.number];
        let interface = match &material.medium {
            Some(inside) => Interface::between(lanes, &Index::Even(1.0), &inside.ior),
            None => Interface::VACUUM,
        };
        let middle = TexturePoint::at([0.5, 0.5], DVec3::ZERO, DVec3::ZERO);
        material.bsdf(lanes, &scene.textures, &middle, interface)
    }

    /// Its type.
    pub fn type_name(&self) -> &str {
        self.file.description.find(Kind::Material, &self.name).map_or("", |e| &e.type_name.text)
    }

    /// Lanes in which to look at it where wavelengths do not matter.
    pub fn lanes(&self) -> Lanes {
        self.mode.lanes(0.5)
    }

    /// True when some of its light goes in single directions only, which no value shows.
    pub fn has_delta(&self) -> bool {
        self.at(&self.lanes()).lobes().intersects(LobeSet::DELTA)
    }
}

/// `NAME=VALUE`, also where NAME leads into a table that nobody wrote yet: `ior.material=gold`.
fn set_parameter(description: &mut Description, material: &str, parameter: &str) -> Result<(), Diagnostic> {
    let parameter = parameter.trim();
    let is_there =
        |name: &str| description.find(Kind::Material, material).is_some_and(|e| e.params.get(name).is_some());
    let deeper = parameter.split_once('=').and_then(|(path, value)| Some((path.trim().split_once('.')?, value.trim())));
    let text = match deeper {
        Some(((name, key), value)) if !is_there(name) && !key.contains('.') => {
            let is_word = !value.starts_with(['[', '{', '"', '\'']) && value.parse::<f64>().is_err();
            let quote = if is_word { "\"" } else { "" };
            format!("materials.{material}.{name}={{ {key} = {quote}{value}{quote} }}")
        }
        _ => format!("materials.{material}.{parameter}"),
    };
    let done = apply_override(description, &text);
    // Shown as what it came from.
    if let Some(last) = description.sources.0.last_mut() {
        last.path = "--set".into();
    }
    done
}

/// What stands before the parameters, and these.
fn split(text: &str) -> (&str, Vec<&str>) {
    let is_parameter = |rest: &str| {
        let name = rest.split('=').next().unwrap_or_default().trim();
        rest.contains('=')
            && !name.is_empty()
            && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '.')
    };
    let colon = text.match_indices(':').map(|m| m.0).find(|&i| is_parameter(&text[i + 1..]));
    match colon {
        Some(i) => (&text[..i], parameters(&text[i + 1..])),
        None => (text, Vec::new()),
    }
}

/// Cut at the commas that stand in no list, table or text.
pub fn parameters(text: &str) -> Vec<&str> {
    let (mut depth, mut quote, mut start, mut found) = (0_i32, None, 0, Vec::new());
    for (i, c) in text.char_indices() {
        match (quote, c) {
            (Some(q), c) if c == q => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(c),
            (None, '[' | '{') => depth += 1,
            (None, ']' | '}') => depth -= 1,
            (None, ',') if depth == 0 => {
                found.push(&text[start..i]);
                start = i + 1;
            }
            _ => {}
        }
    }
    found.push(&text[start..]);
    found
}

/// A short name: no folders.
fn shown(source: &str, inline: &[&str]) -> String {
    let short = source.rsplit(['/', '\\']).next().unwrap_or(source);
    let short = short.split_once('#').map_or(short, |(_, name)| name);
    match inline.len() {
        0 => short.to_string(),
        _ => format!("{short} {}", inline.iter().map(|p| p.trim()).collect::<Vec<_>>().join(", ")),
    }
}

fn find(source: &str) -> Result<(SceneFile, String), Problem> {
    let extension = Path::new(source).extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    if let Some((scene, name)) = source.rsplit_once('#') {
        return of_scene(Path::new(scene), Some(name));
    }
    if MEASURED.contains(&extension.as_str()) {
        return of_measurements(Path::new(source));
    }
    if SCENE_EXTENSIONS.contains(&extension.as_str()) {
        return of_scene(Path::new(source), None);
    }
    of_type(source)
}

fn of_type(name: &str) -> Result<(SceneFile, String), Problem> {
    let catalog = kirkas_render::catalog();
    let mut description = Description::default();
    let id = description.sources.add("MATERIAL", name);
    let span = Span::new(id, 0, name.len());
    if catalog.find(Kind::Material, name).is_none() {
        let names: Vec<&str> = catalog.of_kind(Kind::Material).map(|t| t.name).collect();
        let mut wrong = unknown_name("material type", name, span, names.iter().copied());
        if nearest(name, names.iter().copied()).is_none() {
            let help = "write a type (`kirkas schema --manual` lists them), a scene's material (scene.toml#NAME), or a file of \
                        measurements (.binary, .bsdf)";
            wrong.help = Some(help.into());
        }
        return Err(Problem::in_sources(&description.sources, vec![wrong]));
    }
    let entity = Entity { name: Name { text: name.into(), span }, ..Entity::new(name, name, Map::default()) };
    *description.all_mut(Kind::Material) = vec![entity];
    let here = Path::new(".").canonicalize().unwrap_or_else(|_| PathBuf::from("."));
    Ok((SceneFile::described(description, here), name.to_string()))
}

fn of_measurements(path: &Path) -> Result<(SceneFile, String), Problem> {
    let full = path.canonicalize().map_err(|e| cannot_read(path, &e))?;
    let file = full.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let mut description = Description::default();
    let entity = Entity::new("measured", "measured", Map::default().with("file", file.as_str()));
    *description.all_mut(Kind::Material) = vec![entity];
    let root = full.parent().unwrap_or(Path::new("/")).to_path_buf();
    Ok((SceneFile::described(description, root), "measured".into()))
}

/// Of a scene everything is forgotten but its materials and what they are made of.
fn of_scene(path: &Path, name: Option<&str>) -> Result<(SceneFile, String), Problem> {
    let mut file = SceneFile::open(path, None)?;
    let names: Vec<String> = file.description.all(Kind::Material).iter().map(|e| e.name.text.clone()).collect();
    let all = names.iter().map(String::as_str);
    let chosen = match (name, &names[..]) {
        (Some(name), _) if names.iter().any(|n| n == name) => name.to_string(),
        (Some(name), _) => {
            let id = file.description.sources.add("MATERIAL", name);
            let wrong = unknown_name("material", name, Span::new(id, 0, name.len()), all.collect::<Vec<_>>());
            return Err(Problem::in_sources(&file.description.sources, vec![wrong]));
        }
        (None, [only]) => only.clone(),
        (None, _) => {
            let message = format!("`{}` has {} materials", path.display(), names.len());
            let help = format!("name one of them, as in `{}#NAME`: {}", path.display(), names.join(", "));
            return Err(Problem::input(Diagnostic::error("which-material", message).help(help)));
        }
    };
    for kind in Kind::ALL {
        if !matches!(kind, Kind::Material | Kind::Texture | Kind::Phase | Kind::Medium) {
            file.description.all_mut(kind).clear();
        }
    }
    Ok((file, chosen))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_stand_behind_a_colon() {
        assert_eq!(split("ward"), ("ward", vec![]));
        assert_eq!(split("ward:roughness=0.2, anisotropy=0.5"), ("ward", vec!["roughness=0.2", " anisotropy=0.5"]));
        let list = "phong:diffuse=[0.1, 0.2, 0.3],exponent=5";
        assert_eq!(split(list), ("phong", vec!["diffuse=[0.1, 0.2, 0.3]", "exponent=5"]));
        assert_eq!(split("C:/a/b.toml#paint:ior.file=\"a,b\""), ("C:/a/b.toml#paint", vec!["ior.file=\"a,b\""]));
        assert_eq!(split("a:b.toml"), ("a:b.toml", vec![]));
    }

    #[test]
    fn labels_have_no_folders() {
        assert_eq!(shown("a/b.toml#paint", &[]), "paint");
        assert_eq!(shown("a/gold.binary", &[]), "gold.binary");
        assert_eq!(shown("ward", &["roughness=0.1", " ior=2"]), "ward roughness=0.1, ior=2");
    }
}
