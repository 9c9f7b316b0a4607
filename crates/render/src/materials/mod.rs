//! Materials: a model of `optics` whose parameters may be textures, an opacity, and what the surface emits. The models and
//! their tables live in `optics`; here textures become values, and composed materials find their parts.

mod compose;

pub use compose::compile_all;

use crate::lights::units::EFFICACY;
use crate::shapes::Detail;
use crate::textures::{ColorSource, NumberSource, TextureNames, TexturePoint, Textures};
use kirkas_optics::bsdf::{Parts, Shares, texture_rows};
use kirkas_optics::{Bsdf, BsdfModel, Index, Interface, Lanes, Light, Medium, Palette, Spectrum};
use kirkas_scene::spec::UNIT;
use kirkas_scene::{ParamSpec, ParamType, Params};
use std::sync::Arc;

/// What every material takes.
pub const COMMON: &[ParamSpec] = &[ParamSpec::number_texture(
    "alpha",
    1.0,
    UNIT,
    "Opacity: 1 opaque, 0 not there; an image's alpha channel if it has one.",
)];

/// The most texture rows that a model has.
const MOST_ROWS: usize = 16;

/// A compiled material.
#[derive(Clone)]
pub struct Material {
    /// Its name.
    pub name: String,
    model: BsdfModel,
    rows: Vec<Row>,
    alpha: NumberSource,
    /// The opacity of a mask.
    opacity: NumberSource,
    /// What it is made of.
    parts: Vec<Arc<Material>>,
    /// What it emits.
    pub emission: Option<Emission>,
    /// What fills the body, if the surface bounds one.
    pub medium: Option<Medium>,
    /// What scatters inside the body, by number among the scene's media.
    pub interior: Option<u32>,
    /// Rays go through its surface as if it were not there.
    pub is_hull: bool,
    scales_radiance: bool,
    /// What it has to know of a point.
    pub detail: Detail,
}

/// One texture row of the model.
#[derive(Clone)]
struct Row {
    spec: &'static ParamSpec,
    value: Value,
}

/// What a row says.
#[derive(Clone)]
enum Value {
    Absent,
    /// The same vector everywhere.
    Vector([f32; 3]),
    /// The same number everywhere.
    Number(f32),
    /// The same colour everywhere.
    Color(Spectrum),
    /// Look it up, by number.
    Texture(u32),
}

impl Row {
    fn new(spec: &'static ParamSpec, source: Option<ColorSource>, params: &Params, palette: &Palette) -> Self {
        if let Some(spectrum) = palette.surface(params, spec.name, spec.range.1 as f32) {
            return Row { spec, value: Value::Color(spectrum) };
        }
        let value = match (source, spec.ty) {
            (None, _) => Value::Absent,
            (Some(ColorSource::Texture(number)), _) => Value::Texture(number),
            (Some(ColorSource::Constant(v)), ParamType::VectorTexture) => Value::Vector(v),
            (Some(ColorSource::Constant(c)), ParamType::NumberTexture) => {
                Value::Number(Lanes::RGB.parameter(spec, c)[0])
            }
            (Some(ColorSource::Constant(c)), _) if spec.range.1 <= 1.0 => Value::Color(palette.reflectance(c)),
            (Some(ColorSource::Constant(c)), _) => Value::Color(palette.unbounded(c)),
        };
        Row { spec, value }
    }

    #[inline]
    fn at(&self, lanes: &Lanes, textures: &Textures, at: &TexturePoint) -> Light {
        match &self.value {
            Value::Absent => Light::BLACK,
            Value::Vector(v) => lanes.parameter(self.spec, *v),
            Value::Number(x) => Light::splat(*x),
            Value::Color(spectrum) => spectrum.at(lanes),
            Value::Texture(number) => lanes.parameter(self.spec, textures.color(ColorSource::Texture(*number), at)),
        }
    }
}

/// What a surface emits.
#[derive(Clone, Debug)]
pub struct Emission {
    radiance: Radiance,
    intensity: f64,
    unit: Unit,
    /// Also from its back.
    pub two_sided: bool,
    /// Shadow rays per point.
    pub samples: u32,
}

#[derive(Clone, Debug)]
enum Radiance {
    /// The same everywhere.
    Constant(Spectrum),
    /// Look it up, by number.
    Texture(u32),
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Unit {
    Radiance,
    Luminance,
    Watt,
    Lumen,
}

impl Material {
    /// From its parameters, made of nothing else; `None` if the type is not a model's.
    pub fn new(params: &Params, names: &TextureNames, palette: &Palette) -> Option<Material> {
        Self::composed(params, names, palette, Vec::new())
    }

    /// From its parameters and what it is made of.
    fn composed(
        params: &Params,
        names: &TextureNames,
        palette: &Palette,
        parts: Vec<Arc<Material>>,
    ) -> Option<Material> {
        let model = BsdfModel::prepare(params, palette)?;
        let source = |row: &'static ParamSpec| match (row.ty, row.fallback) {
            (ParamType::NumberTexture, _) => Some(names.number(params, row.name).into()),
            (ParamType::VectorTexture, _) => Some(names.vector(params, row.name)),
            (_, kirkas_scene::Fallback::Absent) => names.optional_color(params, row.name),
            _ => Some(names.color(params, row.name)),
        };
        let rows: Vec<Row> =
            texture_rows(params.spec()).map(|spec| Row::new(spec, source(spec), params, palette)).collect();
        debug_assert!(rows.len() <= MOST_ROWS);
        let alpha = names.number(params, "alpha");
        let is_mask = params.spec().name == "mask";
        let opacity = if is_mask { names.number(params, "opacity") } else { NumberSource::Constant(1.0) };
        let emission = match params.spec().name {
            "emitter" => Some(Emission::new(params, names, palette)),
            "mask" => parts.first().and_then(|part| part.emission.clone()),
            _ => None,
        };
        let is_textured = rows.iter().any(|row| matches!(row.value, Value::Texture(_)))
            || matches!(alpha, NumberSource::Texture(_))
            || matches!(opacity, NumberSource::Texture(_))
            || parts.iter().any(|part| part.detail == Detail::Texture)
            || emission.as_ref().is_some_and(Emission::is_textured);
        // What a composed material bounds is what its first part does that bounds anything.
        let body = parts.iter().find(|part| part.medium.is_some() && !model.is_opaque());
        let medium = model.medium().cloned().or_else(|| body.and_then(|part| part.medium.clone()));
        let is_constant =
            params.spec().params.iter().any(|r| r.name == "fresnel") && params.text("fresnel") == Some("constant");
        Some(Material {
            name: params.entity.name.text.clone(),
            rows,
            alpha,
            opacity,
            emission,
            detail: if is_textured { Detail::Texture } else { Detail::Place },
            scales_radiance: body.map_or(!is_constant, |part| part.scales_radiance),
            medium,
            interior: body.and_then(|part| part.interior),
            is_hull: params.spec().name == "hull",
            model,
            parts,
        })
    }

    /// How much brighter radiance is inside the body: the index squared, or 1 with the classics' constants.
    pub fn radiance_gain(&self, lanes: &Lanes) -> Light {
        match &self.medium {
            Some(m) if self.scales_radiance => m.ior.at(lanes).map(|n| n * n),
            _ => Light::splat(1.0),
        }
    }

    /// True when every hit counts.
    pub fn is_opaque(&self) -> bool {
        let is_whole = |source: NumberSource| source == NumberSource::Constant(1.0);
        is_whole(self.alpha) && is_whole(self.opacity) && self.parts.iter().all(|part| part.is_opaque())
    }

    /// Opacity at a point.
    pub fn alpha(&self, textures: &Textures, at: &TexturePoint) -> f32 {
        let own = textures.alpha(self.alpha, at);
        if self.parts.is_empty() {
            return own;
        }
        let shares = self.shares(&Lanes::RGB, textures, at);
        let there: f32 = self.parts.iter().zip(shares).map(|(part, share)| share * part.alpha(textures, at)).sum();
        let all: f32 = shares.iter().sum();
        own * textures.alpha(self.opacity, at) * if all > 0.0 { there / all } else { 1.0 }
    }

    /// How much each part counts at a point.
    fn shares(&self, lanes: &Lanes, textures: &Textures, at: &TexturePoint) -> Shares {
        self.model.shares(&self.slots(lanes, textures, at)[..self.rows.len()])
    }

    #[inline(always)]
    fn slots(&self, lanes: &Lanes, textures: &Textures, at: &TexturePoint) -> [Light; MOST_ROWS] {
        let mut slots = [Light::BLACK; MOST_ROWS];
        for (slot, row) in slots.iter_mut().zip(&self.rows) {
            *slot = row.at(lanes, textures, at);
        }
        slots
    }

    /// The model at a point.
    #[inline(always)]
    pub fn bsdf(&self, lanes: &Lanes, textures: &Textures, at: &TexturePoint, interface: Interface) -> Bsdf {
        let slots = self.slots(lanes, textures, at);
        let parts = PartsHere { material: self, lanes, textures, at, interface };
        self.model.at(lanes, &slots[..self.rows.len()], interface, &parts)
    }

    /// What a straight shadow ray keeps on its way through the surface (the classics' coloured shadows): the constant or
    /// tint of transmission, without Fresnel or bending; `None` for surfaces that bound no body.
    pub fn straight_transmittance(&self, lanes: &Lanes, textures: &Textures, at: &TexturePoint) -> Option<Light> {
        self.medium.as_ref()?;
        if self.is_hull {
            return Some(Light::splat(1.0));
        }
        if !self.parts.is_empty() {
            let shares = self.shares(lanes, textures, at);
            let passed = |part: &Material| part.straight_transmittance(lanes, textures, at).unwrap_or(Light::BLACK);
            return Some(self.parts.iter().zip(shares).map(|(part, share)| passed(part) * share).sum());
        }
        let named = |n: &str| self.rows.iter().find(|row| row.spec.name == n);
        let row = named("transmittance").or_else(|| named("transmit"))?;
        Some(row.at(lanes, textures, at))
    }

    /// Colour for the albedo AOV: what ambient light is multiplied by, or the first colour of clear and mirroring surfaces.
    pub fn albedo(&self, textures: &Textures, at: &TexturePoint) -> [f32; 3] {
        let ambient = self.bsdf(&Lanes::RGB, textures, at, Interface::VACUUM).ambient();
        if !ambient.is_black() {
            return Lanes::RGB.to_film(ambient);
        }
        if !self.parts.is_empty() {
            let mut sum = [0.0; 3];
            for (part, share) in self.parts.iter().zip(self.shares(&Lanes::RGB, textures, at)) {
                let albedo = part.albedo(textures, at);
                sum = std::array::from_fn(|c| sum[c] + share * albedo[c]);
            }
            return sum;
        }
        let is_color = |row: &&Row| row.spec.ty == ParamType::ColorTexture && !matches!(row.value, Value::Absent);
        let first = self.rows.iter().find(is_color);
        first.map_or([0.0; 3], |row| Lanes::RGB.to_film(row.at(&Lanes::RGB, textures, at)))
    }
}

/// The parts of a material at a point.
struct PartsHere<'a> {
    material: &'a Material,
    lanes: &'a Lanes,
    textures: &'a Textures,
    at: &'a TexturePoint,
    interface: Interface,
}

impl Parts for PartsHere<'_> {
    fn part(&self, number: usize) -> Bsdf {
        let part = &self.material.parts[number];
        // A sheet bounds nothing; its faces look as their bodies would in vacuum.
        let interface = match (&self.material.medium, &part.medium) {
            (None, Some(body)) => Interface::between(self.lanes, &Index::Even(1.0), &body.ior),
            _ => self.interface,
        };
        part.bsdf(self.lanes, self.textures, self.at, interface)
    }

    fn opacity(&self, number: usize) -> f32 {
        let part = &self.material.parts[number];
        if part.is_opaque() { 1.0 } else { part.alpha(self.textures, self.at) }
    }
}

impl Emission {
    fn new(p: &Params, names: &TextureNames, palette: &Palette) -> Self {
        Emission {
            radiance: match names.color(p, "radiance") {
                ColorSource::Constant(_) => Radiance::Constant(palette.shine(&palette.light(p, "radiance"), 1.0)),
                ColorSource::Texture(number) => Radiance::Texture(number),
            },
            intensity: p.number("intensity"),
            unit: match p.text("unit") {
                Some("nit") => Unit::Luminance,
                Some("W") => Unit::Watt,
                Some("lm") => Unit::Lumen,
                _ => Unit::Radiance,
            },
            two_sided: p.bool("two_sided"),
            samples: p.integer("samples") as u32,
        }
    }

    /// True when it may differ from place to place.
    pub fn is_textured(&self) -> bool {
        matches!(self.radiance, Radiance::Texture(_))
    }

    /// Radiance at a point; `per_power` is 1 / (pi area) of the whole lamp.
    pub fn radiance(
        &self,
        lanes: &Lanes,
        textures: &Textures,
        at: &TexturePoint,
        per_power: impl FnOnce() -> f64,
    ) -> Light {
        let color = match &self.radiance {
            Radiance::Constant(spectrum) => return spectrum.scaled_at(lanes, self.scale(spectrum.rgb(), per_power)),
            Radiance::Texture(number) => textures.color(ColorSource::Texture(*number), at),
        };
        let scale = self.scale(color, per_power);
        lanes.illuminant(color.map(|c| (f64::from(c) * scale) as f32))
    }

    /// What a colour is multiplied by to become radiance.
    fn scale(&self, color: [f32; 3], per_power: impl FnOnce() -> f64) -> f64 {
        if self.unit == Unit::Radiance {
            return self.intensity;
        }
        let color = color.map(f64::from);
        let luminance = 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
        let mean = (color[0] + color[1] + color[2]) / 3.0;
        let over = |x: f64, by: f64| if by > 0.0 { x / by } else { 0.0 };
        let sides = if self.two_sided { 0.5 } else { 1.0 };
        let scale = match self.unit {
            Unit::Radiance => 1.0,
            Unit::Luminance => over(1.0, luminance * EFFICACY),
            Unit::Watt => over(per_power() * sides, mean),
            Unit::Lumen => over(per_power() * sides, luminance * EFFICACY),
        };
        scale * self.intensity
    }
}
