//! Colours as scenes write them by wavelength: `{ blackbody = 2700 }`, `{ illuminant = "F2" }`, `{ spectrum = "lamp.spd" }`.
//!
//! What shines in such a colour is brought to luminance 1, as white is; how bright it is, its intensity says. A surface's
//! values are taken as they are.

use super::curve::Curve;
use super::observer::observer;
use super::{Palette, Spectrum, Waves, illuminants};
use crate::index::formula::Formula;
use crate::index::{Index, OpticalConstants, known};
use crate::measured::MeasuredData;
use kirkas_scene::{Node, Params, Span};
use std::sync::Arc;

/// The colour of something that shines: linear Rec.709, and what stands behind it if it was given by wavelength.
#[derive(Clone, Debug, PartialEq)]
pub struct Paint {
    /// Linear Rec.709; may be negative where the colour is purer than any of red, green and blue.
    pub rgb: [f64; 3],
    curve: Option<Curve>,
}

impl From<[f64; 3]> for Paint {
    fn from(rgb: [f64; 3]) -> Self {
        Paint { rgb, curve: None }
    }
}

impl Palette {
    /// Let scenes name a file of pairs of wavelength (nm) and value; `from` is the place that names it.
    pub fn add_spectrum(&mut self, from: Span, path: &str, pairs: Vec<(f64, f64)>) {
        self.spectra.insert((from.source.0, path.to_string()), pairs);
    }

    fn pairs(&self, node: &Node) -> Option<&Vec<(f64, f64)>> {
        self.spectra.get(&(node.span.source.0, node.text()?.to_string()))
    }

    /// The colour parameter `name` of something that shines.
    pub fn light(&self, params: &Params, name: &str) -> Paint {
        let written = params.entity.params.get(name).and_then(Node::map);
        let curve = written.and_then(|map| match (map.get("blackbody"), map.get("illuminant"), map.get("spectrum")) {
            (Some(kelvin), _, _) => kelvin.number().map(illuminants::blackbody),
            (_, Some(name), _) => illuminants::illuminant(name.text()?),
            (_, _, Some(file)) => Some(Curve::of_pairs(self.pairs(file)?, false)),
            _ => None,
        });
        let Some(curve) = curve else { return params.color(name).into() };
        let rgb = observer().color_of_light(curve.samples());
        let luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
        let scale = if luminance > 0.0 { 1.0 / luminance } else { 0.0 };
        Paint { rgb: rgb.map(|c| c * scale), curve: Some(Curve::new(curve.samples().map(|s| s * scale as f32))) }
    }

    /// What shines in this colour, times `scale`.
    pub fn shine(&self, paint: &Paint, scale: f64) -> Spectrum {
        let rgb = paint.rgb.map(|c| (c * scale) as f32);
        match &paint.curve {
            None => self.illuminant(rgb),
            Some(curve) => {
                Spectrum { rgb: rgb.map(|x| x.max(0.0)), waves: Waves::Sampled(curve.clone(), scale as f32) }
            }
        }
    }

    /// The colour parameter `name` of a body, without upper bound.
    pub fn absorption(&self, params: &Params, name: &str) -> Spectrum {
        let plain = || self.unbounded(params.color(name).map(|x| x as f32));
        self.surface(params, name, f32::INFINITY).unwrap_or_else(plain)
    }

    /// The colour parameter `name` of a surface or body, if it was given by wavelength; values above `most` are cut.
    pub fn surface(&self, params: &Params, name: &str, most: f32) -> Option<Spectrum> {
        let file = params.entity.params.get(name)?.map()?.get("spectrum")?;
        let curve = Curve::of_pairs(self.pairs(file)?, true);
        let curve = Curve::new(curve.samples().map(|s| s.max(0.0).min(most)));
        let rgb = observer().color_of_reflectance(curve.samples()).map(|c| (c as f32).max(0.0).min(most));
        Some(Spectrum { rgb, waves: Waves::Sampled(curve, 1.0) })
    }

    /// Let scenes name a file of refractive indices; `from` is the place that names it.
    pub fn add_constants(&mut self, from: Span, path: &str, constants: OpticalConstants) {
        self.constants.insert((from.source.0, path.to_string()), constants);
    }

    /// The constants that the parameter `name` names, if it names some.
    pub fn constants(&self, params: &Params, name: &str) -> Option<OpticalConstants> {
        let map = params.entity.params.get(name)?.map()?;
        if let Some(material) = map.get("material") {
            return known::constants(material.text()?);
        }
        let file = map.get("file")?;
        self.constants.get(&(file.span.source.0, file.text()?.to_string())).cloned()
    }

    /// Let scenes name a file of measured reflectance; `from` is the place that names it.
    pub fn add_measured(&mut self, from: Span, path: &str, data: Arc<MeasuredData>) {
        self.measured.insert((from.source.0, path.to_string()), data);
    }

    /// The measured reflectance in the file that the parameter `name` names.
    pub fn measured(&self, params: &Params, name: &str) -> Option<Arc<MeasuredData>> {
        let file = params.entity.params.get(name)?;
        self.measured.get(&(file.span.source.0, file.text()?.to_string())).cloned()
    }

    /// The refractive index that the parameter `name` says.
    pub fn index(&self, params: &Params, name: &str) -> Index {
        if let Some(constants) = self.constants(params, name) {
            return Index::Curve(constants.n.curve());
        }
        let map = params.entity.params.get(name).and_then(Node::map);
        let numbers = |key| -> Option<Vec<f64>> { map?.get(key)?.list()?.iter().map(Node::number).collect() };
        let formula = match (numbers("cauchy"), numbers("sellmeier")) {
            (Some(c), _) => Formula::cauchy(&c),
            (_, Some(c)) => Formula::sellmeier(&c),
            _ => return Index::Even(params.f32(name)),
        };
        Index::Curve(Curve::of(|w| formula.at(w / 1000.0)))
    }
}
