//! Everything by wavelength or measured that a scene names: known names are looked up, files are read, and what is wrong is
//! told.

use kirkas_optics::index::{MetalCurves, file as index_file, known};
use kirkas_optics::measured::MeasuredData;
use kirkas_optics::spectrum::file::read_pairs;
use kirkas_optics::spectrum::illuminants;
use kirkas_optics::{ColorMode, Palette};
use kirkas_scene::diagnostic::unknown_name;
use kirkas_scene::{Assets, Catalog, Description, Diagnostic, Entity, Kind, Node, ParamSpec, ParamType, Span};
use std::collections::BTreeSet;
use std::sync::Arc;

/// The palette of a validated description.
pub(crate) fn palette(
    d: &Description,
    catalog: &Catalog,
    assets: &dyn Assets,
    mode: ColorMode,
) -> Result<Palette, Vec<Diagnostic>> {
    let mut reader = Reader { palette: Palette::new(mode), assets, found: Vec::new(), measured: BTreeSet::new() };
    for kind in Kind::ALL {
        for entity in d.all(kind) {
            let Some(spec) = catalog.find(kind, &entity.type_name.text) else { continue };
            for row in catalog.rows(spec) {
                let Some(node) = entity.params.get(row.name) else { continue };
                if node.map().is_some() {
                    reader.visit(kind, entity, row, node);
                }
                if kind == Kind::Material && row.ty == ParamType::Path {
                    reader.measured_file(node);
                }
            }
        }
    }
    if reader.found.is_empty() { Ok(reader.palette) } else { Err(reader.found) }
}

struct Reader<'a> {
    palette: Palette,
    assets: &'a dyn Assets,
    found: Vec<Diagnostic>,
    /// Files of measured reflectance that were read, by source and path.
    measured: BTreeSet<(u32, String)>,
}

impl Reader<'_> {
    fn visit(&mut self, kind: Kind, entity: &Entity, row: &ParamSpec, node: &Node) {
        let Some((name, value)) = node.map().and_then(|m| m.iter().next()) else { return };
        let shines = match kind {
            Kind::Light | Kind::Background => row.name == "color",
            _ => row.name == "radiance",
        };
        match (row.ty, name.text.as_str()) {
            (ParamType::Color | ParamType::ColorTexture, _) if !shines && kind != Kind::Material => self.found.push(
                Diagnostic::error("plain-color", format!("`{}` takes a plain colour only", row.name))
                    .at(node.span, "given by wavelength")
                    .help("write [r, g, b]"),
            ),
            (ParamType::Color | ParamType::ColorTexture, "blackbody" | "illuminant") if !shines => self.found.push(
                Diagnostic::error("wave-light", format!("`{}` is no light source", row.name))
                    .at(node.span, "the spectrum of one")
                    .help("write [r, g, b] or { spectrum = \"FILE\" }"),
            ),
            (ParamType::Color | ParamType::ColorTexture, "illuminant") => {
                let text = value.text().unwrap_or_default();
                if illuminants::illuminant(text).is_none() {
                    self.found.push(unknown_name("illuminant", text, value.span, illuminants::NAMES));
                }
            }
            (ParamType::Color | ParamType::ColorTexture, "spectrum") => {
                let path = value.text().unwrap_or_default();
                match self.text(value, path).and_then(|t| read_pairs(&t).map_err(|e| bad_file(value.span, path, &e))) {
                    Ok(pairs) => self.palette.add_spectrum(value.span, path, pairs),
                    Err(e) => self.found.push(e),
                }
            }
            (ParamType::Index, "material") => self.known_material(entity, value),
            (ParamType::Index, "file") => self.index_file(entity, value),
            _ => {}
        }
    }

    fn known_material(&mut self, entity: &Entity, value: &Node) {
        let text = value.text().unwrap_or_default();
        match known::constants(text) {
            None => {
                let names: Vec<&str> = known::NAMES.iter().flat_map(|n| [n.0, n.1]).collect();
                self.found.push(unknown_name("material with a known refractive index", text, value.span, names));
            }
            Some(c) => self.check_metal(entity, value, MetalCurves::new(&c).is_some()),
        }
    }

    fn index_file(&mut self, entity: &Entity, value: &Node) {
        let path = value.text().unwrap_or_default();
        let read = self.text(value, path);
        match read.and_then(|t| index_file::read(&t).map_err(|e| bad_file(value.span, path, &e))) {
            Ok(constants) => {
                self.check_metal(entity, value, MetalCurves::new(&constants).is_some());
                self.palette.add_constants(value.span, path, constants);
            }
            Err(e) => self.found.push(e),
        }
    }

    fn measured_file(&mut self, node: &Node) {
        let path = node.text().unwrap_or_default();
        if !self.measured.insert((node.span.source.0, path.to_string())) {
            return;
        }
        let read = self.bytes(node, path).and_then(|b| {
            MeasuredData::read(&b, self.palette.mode()).map_err(|e| {
                Diagnostic::error("bad-measured", format!("`{path}` cannot be read: {e}"))
                    .at(node.span, "this file")
                    .help("measured materials come as MERL `.binary` or RGL `.bsdf`")
            })
        });
        match read {
            Ok(data) => self.palette.add_measured(node.span, path, Arc::new(data)),
            Err(e) => self.found.push(e),
        }
    }

    fn check_metal(&mut self, entity: &Entity, value: &Node, has_extinction: bool) {
        if entity.type_name.text.ends_with("conductor") && !has_extinction {
            self.found.push(
                Diagnostic::error("no-extinction", "a conductor needs an extinction coefficient, and this has none")
                    .at(value.span, "has n alone")
                    .help("use `dielectric` for clear materials, or name a metal such as \"gold\""),
            );
        }
    }

    fn bytes(&self, value: &Node, path: &str) -> Result<Arc<[u8]>, Diagnostic> {
        let from = value.span.is_some().then_some(value.span.source);
        let bytes = self.assets.bytes(from, path);
        bytes.map_err(|e| if e.labels.is_empty() { e.at(value.span, "named here") } else { e })
    }

    fn text(&self, value: &Node, path: &str) -> Result<String, Diagnostic> {
        let bytes = self.bytes(value, path)?;
        String::from_utf8(bytes.to_vec()).map_err(|_| bad_file(value.span, path, "it is no text (UTF-8)"))
    }
}

fn bad_file(span: Span, path: &str, problem: &str) -> Diagnostic {
    Diagnostic::error("bad-spectrum", format!("`{path}` cannot be read: {problem}")).at(span, "this file").help(
        "a spectrum has two columns, wavelength in nm and value; an index comes from refractiveindex.info as .yml",
    )
}
