//! Materials: a model of `optics` whose parameters may be textures, an opacity, and what the surface emits. The models and
//! their tables live in `optics`; here textures become values.

use crate::lights::units::EFFICACY;
use crate::textures::{ColorSource, NumberSource, TextureNames, TexturePoint, Textures};
use kirkas_optics::bsdf::texture_rows;
use kirkas_optics::{Bsdf, BsdfModel, Interface, Lanes, Light, Medium};
use kirkas_scene::spec::UNIT;
use kirkas_scene::{ParamSpec, ParamType, Params};

/// What every material takes.
pub const COMMON: &[ParamSpec] = &[ParamSpec::number_texture(
    "alpha",
    1.0,
    UNIT,
    "Opacity: 1 opaque, 0 not there; an image's alpha channel if it has one.",
)];

/// The most texture rows that a model has.
const MOST_ROWS: usize = 8;

/// A compiled material.
pub struct Material {
    /// Its name.
    pub name: String,
    model: BsdfModel,
    rows: Vec<Row>,
    /// The rows' values where they are the same everywhere; textures fill in the others.
    slots: [Light; MOST_ROWS],
    alpha: NumberSource,
    /// What it emits.
    pub emission: Option<Emission>,
    /// What fills the body, if the surface bounds one.
    pub medium: Option<Medium>,
    /// How much brighter radiance is inside the body: the index squared, or 1 with the classics' constants.
    pub radiance_gain: f32,
}

/// One texture row of the model.
struct Row {
    spec: &'static ParamSpec,
    /// `None` where it is absent.
    source: Option<ColorSource>,
}

impl Row {
    fn value(&self, textures: &Textures, at: &TexturePoint) -> Light {
        self.source.map_or(Light::BLACK, |s| Lanes::RGB.parameter(self.spec, textures.color(s, at)))
    }

    fn constant(&self) -> Light {
        match self.source {
            Some(ColorSource::Constant(c)) => Lanes::RGB.parameter(self.spec, c),
            _ => Light::BLACK,
        }
    }
}

/// What a surface emits.
#[derive(Clone, Copy, Debug)]
pub struct Emission {
    radiance: ColorSource,
    intensity: f64,
    unit: Unit,
    /// Also from its back.
    pub two_sided: bool,
    /// Shadow rays per point.
    pub samples: u32,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Unit {
    Radiance,
    Luminance,
    Watt,
    Lumen,
}

impl Material {
    /// From its parameters; `None` if the type is not a model's.
    pub fn new(params: &Params, names: &TextureNames) -> Option<Material> {
        let model = BsdfModel::prepare(params)?;
        let source = |row: &'static ParamSpec| match (row.ty, row.fallback) {
            (ParamType::NumberTexture, _) => Some(names.number(params, row.name).into()),
            (_, kirkas_scene::Fallback::Absent) => names.optional_color(params, row.name),
            _ => Some(names.color(params, row.name)),
        };
        let rows: Vec<Row> = texture_rows(params.spec()).map(|spec| Row { spec, source: source(spec) }).collect();
        debug_assert!(rows.len() <= MOST_ROWS);
        let slots = std::array::from_fn(|i| rows.get(i).map_or(Light::BLACK, Row::constant));
        let medium = model.medium();
        let is_constant =
            params.spec().params.iter().any(|r| r.name == "fresnel") && params.text("fresnel") == Some("constant");
        Some(Material {
            name: params.entity.name.text.clone(),
            rows,
            slots,
            alpha: names.number(params, "alpha"),
            emission: (params.spec().name == "emitter").then(|| Emission::new(params, names)),
            medium,
            radiance_gain: medium.filter(|_| !is_constant).map_or(1.0, |m| m.ior * m.ior),
            model,
        })
    }

    /// True when every hit counts.
    pub fn is_opaque(&self) -> bool {
        self.alpha == NumberSource::Constant(1.0)
    }

    /// Opacity at a point.
    pub fn alpha(&self, textures: &Textures, at: &TexturePoint) -> f32 {
        textures.alpha(self.alpha, at)
    }

    /// The model at a point.
    pub fn bsdf(&self, textures: &Textures, at: &TexturePoint, interface: Interface) -> Bsdf {
        let mut slots = self.slots;
        for (slot, row) in slots.iter_mut().zip(&self.rows) {
            if matches!(row.source, Some(ColorSource::Texture(_))) {
                *slot = row.value(textures, at);
            }
        }
        self.model.at(&slots[..self.rows.len()], interface)
    }

    /// What a straight shadow ray keeps on its way through the surface (the classics' coloured shadows): the constant or
    /// tint of transmission, without Fresnel or bending; `None` for surfaces that bound no body.
    pub fn straight_transmittance(&self, textures: &Textures, at: &TexturePoint) -> Option<Light> {
        self.medium?;
        let named = |n: &str| self.rows.iter().find(|row| row.spec.name == n);
        let row = named("transmittance").or_else(|| named("transmit"))?;
        Some(row.value(textures, at))
    }

    /// Colour for the albedo AOV: what ambient light is multiplied by, or the first colour of clear and mirroring surfaces.
    pub fn albedo(&self, textures: &Textures, at: &TexturePoint) -> [f32; 3] {
        let ambient = self.bsdf(textures, at, Interface::VACUUM).ambient();
        if !ambient.is_black() {
            return Lanes::RGB.to_film(ambient);
        }
        let first = self.rows.iter().find(|row| row.spec.ty == ParamType::ColorTexture && row.source.is_some());
        first.and_then(|row| row.source).map_or([0.0; 3], |s| textures.color(s, at))
    }
}

impl Emission {
    fn new(p: &Params, names: &TextureNames) -> Self {
        Emission {
            radiance: names.color(p, "radiance"),
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
        matches!(self.radiance, ColorSource::Texture(_))
    }

    /// Radiance at a point; `per_power` is 1 / (pi area) of the whole lamp.
    pub fn radiance(&self, textures: &Textures, at: &TexturePoint, per_power: f64) -> Light {
        let color = textures.color(self.radiance, at).map(f64::from);
        let luminance = 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
        let mean = (color[0] + color[1] + color[2]) / 3.0;
        let over = |x: f64, by: f64| if by > 0.0 { x / by } else { 0.0 };
        let sides = if self.two_sided { 0.5 } else { 1.0 };
        let scale = match self.unit {
            Unit::Radiance => 1.0,
            Unit::Luminance => over(1.0, luminance * EFFICACY),
            Unit::Watt => over(per_power * sides, mean),
            Unit::Lumen => over(per_power * sides, luminance * EFFICACY),
        };
        Lanes::RGB.illuminant(color.map(|c| (c * scale * self.intensity) as f32))
    }
}
