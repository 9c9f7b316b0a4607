//! Values of the scene that the command line sets: each is a small text with a place of its own, so that what is wrong with it
//! is underlined like a line of the scene.

use crate::problem::Problem;
use crate::scene_file::SceneFile;
use kirkas_formats::toml::apply_override;
use kirkas_render::catalog;
use kirkas_render::film::SpectralBins;
use kirkas_scene::validate::validate;
use kirkas_scene::{Diagnostic, Kind, Map, Name, Node, Span, Value};
use std::path::PathBuf;

/// The scene and what is changed in it.
#[derive(Debug, clap::Args)]
pub struct SceneArgs {
    /// Scene: .toml, .txt (MIT 6.837), or a mesh to look at: .obj, .ply
    pub scene: PathBuf,
    /// Set any value of the scene: `-D integrator.max_depth=3 -D lights.lamp.intensity=2`
    #[arg(short = 'D', value_name = "PATH=VALUE")]
    pub set: Vec<String>,
    /// Folder below which the scene may read files; its own by default
    #[arg(long, value_name = "DIR")]
    pub root: Option<PathBuf>,
}

/// Told by texts of their own in a picture's header.
const TOLD_APART: [&str; 5] = ["sampler.samples", "sampler.max_samples", "sampler.seed", "film.exposure", "film.tone"];

/// Sets values and remembers them.
pub struct Settings<'a> {
    scene: &'a mut SceneFile,
    lines: Vec<String>,
    errors: Vec<Diagnostic>,
}

impl<'a> Settings<'a> {
    /// Of this scene.
    pub fn new(scene: &'a mut SceneFile) -> Self {
        Settings { scene, lines: Vec::new(), errors: Vec::new() }
    }

    /// The value at `path`, as the option `flag` gave it.
    pub fn flag(&mut self, flag: &str, path: &str, value: impl Into<Value>) {
        let value = value.into();
        let text = match &value {
            Value::Int(i) => i.to_string(),
            Value::Float(f) => f.to_string(),
            Value::Text(t) => t.clone(),
            Value::Bool(b) => b.to_string(),
            other => format!("{other:?}"),
        };
        let description = &mut self.scene.description;
        let source = description.sources.add(flag, &text);
        let span = Span::new(source, 0, text.len());
        self.lines.push(format!("{path}={text}"));
        self.errors.extend(description.set(path, span, Node::spanned(value, span)).err());
    }

    /// Another type for a single kind: what was said of the old one is forgotten.
    pub fn type_of(&mut self, flag: &str, kind: Kind, name: &str) {
        let entity = self.scene.description.single_mut(kind);
        if entity.type_name.text != name {
            entity.params = Map::default();
        }
        self.flag(flag, &format!("{}.type", kind.section()), name);
    }

    /// The error target of adaptive sampling, if the sampler is not of a fixed number of samples.
    pub fn error_target(&mut self, error: f64) {
        let sampler = self.scene.description.single(Kind::Sampler).map_or("", |e| &e.type_name.text);
        if sampler == "stratified" {
            let message = "`--error` needs a sampler to whose samples more can be added, which `stratified` is not";
            let help = "take another, such as `-D sampler.type=sobol`, or a number of samples instead";
            self.errors.push(Diagnostic::error("no-more-samples", message).help(help));
        } else {
            self.flag("--error", "sampler.error", error);
        }
    }

    /// Samples per pixel; of adaptive sampling, at most.
    pub fn samples(&mut self, samples: i64) {
        let sampler = self.scene.description.single(Kind::Sampler);
        let is_adaptive = sampler.and_then(|e| e.params.get("error")?.number()).is_some_and(|e| e > 0.0);
        self.flag("--spp", if is_adaptive { "sampler.max_samples" } else { "sampler.samples" }, samples);
    }

    /// Bins of wavelength.
    pub fn spectral_bins(&mut self, bins: SpectralBins) {
        self.flag("--spectral-bins", "film.spectral_bins", i64::from(bins.count));
        self.overrides(&[format!("film.spectral_range=[{:?}, {:?}]", bins.low, bins.high)]);
    }

    /// All shutters open at `time`, for as long as they did.
    pub fn time(&mut self, time: f64) {
        for camera in self.scene.description.all_mut(Kind::Camera) {
            let [open, close] = camera.params.get("shutter").and_then(|n| n.numbers::<2>()).unwrap_or_default();
            camera.params.set(Name::new("shutter"), Node::new([time, time + (close - open)]));
        }
        self.lines.push(format!("time={time}"));
    }

    /// What `-D` says.
    pub fn overrides(&mut self, texts: &[String]) {
        for text in texts {
            self.errors.extend(apply_override(&mut self.scene.description, text).err());
            if let Some((path, value)) = text.split_once('=') {
                self.lines.push(format!("{}={}", path.trim(), value.trim()));
            }
        }
    }

    /// Everything that is wrong, in the options and in the scene as they changed it; else one line per value set, but for those
    /// that a header tells by themselves.
    pub fn finish(mut self) -> Result<String, Problem> {
        if !self.errors.is_empty() {
            self.errors.extend(validate(&self.scene.description, &catalog()).into_iter().filter(Diagnostic::is_error));
            return Err(self.scene.failure(self.errors).into());
        }
        let is_told_apart = |line: &String| TOLD_APART.iter().any(|p| line.split('=').next() == Some(p));
        Ok(self.lines.into_iter().filter(|line| !is_told_apart(line)).collect::<Vec<_>>().join("\n"))
    }
}
