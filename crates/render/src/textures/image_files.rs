//! Pictures from files: read once each, however many textures name them, and what was taken for what.

use super::texels::{Encoding, Texels};
use super::{TextureInput, TextureNames};
use kirkas_images::decode;
use kirkas_scene::{Assets, Diagnostic, Params, Span};
use std::collections::BTreeMap;
use std::sync::Arc;

/// What a texture's picture is, and how its numbers were understood.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureNote {
    /// As written in the scene.
    pub path: String,
    /// Columns and rows.
    pub size: (u32, u32),
    /// True where its numbers were decoded by the sRGB curve, false where they were taken as they are.
    pub is_srgb: bool,
    /// The scene said so; else the file's kind did.
    pub is_chosen: bool,
}

/// A picture's linear colours, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// In texels.
    pub width: usize,
    /// In texels.
    pub height: usize,
    /// `width * height` of them, linear Rec.709.
    pub texels: Vec<[f32; 3]>,
}

impl From<&Texels> for Picture {
    fn from(t: &Texels) -> Self {
        let (width, height) = (t.size().0 as usize, t.size().1 as usize);
        Picture { width, height, texels: (0..width * height).map(|i| t.color(i)).collect() }
    }
}

/// Pictures that have been read: materials name the same one more than once.
#[derive(Clone, Debug, Default)]
pub(super) struct ImageFiles(BTreeMap<(Folder, String, Encoding), Arc<Texels>>);

#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Folder {
    OfSource(u32),
    Path(String),
}

impl ImageFiles {
    /// Every picture that was read, in the order of their paths.
    pub(super) fn notes(&self) -> Vec<PictureNote> {
        let note = |((_, path, encoding), texels): (&(Folder, String, Encoding), &Arc<Texels>)| PictureNote {
            path: path.clone(),
            size: texels.size(),
            is_srgb: texels.is_srgb,
            is_chosen: *encoding != Encoding::Auto,
        };
        self.0.iter().map(note).collect()
    }

    pub(super) fn read(&mut self, input: &TextureInput) -> Result<Arc<Texels>, Diagnostic> {
        let encoding = match input.params.text("encoding") {
            Some("srgb") => Encoding::Srgb,
            Some("linear") => Encoding::Linear,
            _ => Encoding::Auto,
        };
        let path = input.params.text("file").unwrap_or_default();
        let span = input.params.span("file");
        let from = span.is_some().then_some(span.source);
        let folder = match input.folder {
            Some(folder) => Folder::Path(folder.to_string()),
            None => Folder::OfSource(from.map_or(u32::MAX, |source| source.0)),
        };
        let key = (folder, path.to_string(), encoding);
        if let Some(texels) = self.0.get(&key) {
            return Ok(texels.clone());
        }
        let read = match input.folder {
            Some("") => input.assets.bytes(None, path),
            Some(folder) => input.assets.bytes(None, &format!("{folder}/{path}")),
            None => input.assets.bytes(from, path),
        };
        let bytes = read.map_err(|error| if error.labels.is_empty() { error.at(span, "named here") } else { error })?;
        let ending = path.rsplit_once('.').map(|(_, ending)| ending);
        let image = decode(&bytes, ending).map_err(|error| unreadable(path, span, &error))?;
        let texels = Arc::new(Texels::new(image, encoding));
        self.0.insert(key, texels.clone());
        Ok(texels)
    }
}

/// The picture that the parameters `file` and `encoding` name.
pub fn read_picture(params: &Params, assets: &dyn Assets) -> Result<Picture, Diagnostic> {
    let input = TextureInput { params: *params, names: &TextureNames::default(), assets, folder: None };
    ImageFiles::default().read(&input).map(|texels| Picture::from(&*texels))
}

fn unreadable(path: &str, span: Span, error: &kirkas_images::ImageError) -> Diagnostic {
    let text = error.to_string();
    // Errors of pictures say the problem, then the cure.
    let (problem, cure) = text.split_once("; ").unwrap_or((&text, "give another picture"));
    Diagnostic::error("bad-image", format!("the picture `{path}` cannot be read: {problem}"))
        .at(span, "this picture")
        .help(cure)
}
