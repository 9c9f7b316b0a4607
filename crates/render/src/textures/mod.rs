//! Textures: colours that depend on where a surface is hit. Each is a pure function of a [`TexturePoint`].
//!
//! A texture may be made of others; names become numbers when the scene is compiled, and [`Textures`] holds them all in
//! one flat table. A looked-up value has four lanes: linear Rec.709 and, last, the number that the texture means where it
//! is used as a mask (the alpha channel of an image that has one, else the mean of the colour).

mod brick;
mod checker;
mod footprint;
mod fractal;
mod gradient;
mod image;
mod image_files;
mod mapping;
mod marble;
mod noise;
pub(crate) mod perlin;
mod references;
mod taps;
mod texels;
mod vertex_color;
mod wood;

pub use footprint::{Patch, RayCone, SurfacePatch};
pub use image_files::{Picture, PictureNote, read_picture};
pub use references::{ColorSource, NumberSource, TextureNames};

use brick::Brick;
use checker::Checker;
use gradient::Gradient;
use image::Image;
use image_files::ImageFiles;
use kirkas_geometry::{DAffine3, DVec3};
use kirkas_scene::spec::ANY;
use kirkas_scene::transforms::read_transform;
use kirkas_scene::{
    Assets, Catalog, Description, Diagnostic, Entity, Fallback, Kind, ParamSpec, ParamType, Params, TypeSpec,
};
use mapping::Mapping;
use marble::Marble;
use noise::Noise;
use vertex_color::VertexColor;
use wood::Wood;

/// Where a texture is asked.
#[derive(Clone, Copy, Debug)]
pub struct TexturePoint {
    /// Texture coordinates; v = 0 is the bottom row of an image.
    pub uv: [f32; 2],
    /// In object space, for solid textures.
    pub object_position: DVec3,
    /// In world space, for solid textures with `space = "world"`.
    pub world_position: DVec3,
    /// What is around it.
    pub patch: Patch,
}

impl TexturePoint {
    /// A point that is asked for itself alone.
    pub const fn at(uv: [f32; 2], object_position: DVec3, world_position: DVec3) -> Self {
        TexturePoint { uv, object_position, world_position, patch: Patch::POINT }
    }

    /// The same point, whatever its sample stands for.
    pub fn alone(mut self) -> Self {
        let Patch { object_axes, world_axes, uv_axes, .. } = Patch::POINT;
        self.patch = Patch { object_axes, world_axes, uv_axes, ..self.patch };
        self
    }
}

/// Every type of texture.
pub const TEXTURES: &[&TypeSpec] = &[
    &checker::SPEC,
    &image::SPEC,
    &noise::SPEC,
    &marble::SPEC,
    &wood::SPEC,
    &gradient::SPEC,
    &brick::SPEC,
    &vertex_color::SPEC,
];

/// Rows that every texture takes.
pub const COMMON: &[ParamSpec] = &[
    ParamSpec::new(
        "transform",
        ParamType::Transform,
        Fallback::Absent,
        "steps that place the pattern in its space; in the plane of u and v for flat textures",
    )
    .range(ANY),
    ParamSpec::choice("space", &["object", "world"], "what a solid texture is fixed to: the object or the world"),
];

/// One compiled texture, before it is placed.
#[derive(Clone, Debug)]
enum Texture {
    Checker(Checker),
    Image(Image),
    Noise(Noise),
    Marble(Marble),
    Wood(Wood),
    Gradient(Gradient),
    Brick(Brick),
    VertexColor(VertexColor),
}

/// All textures of a scene.
#[derive(Clone, Debug, Default)]
pub struct Textures {
    placed: Vec<Placed>,
    names: TextureNames,
    files: ImageFiles,
}

#[derive(Clone, Debug)]
struct Placed {
    texture: Texture,
    /// `None` for the identity.
    texture_from_space: Option<DAffine3>,
    is_in_world: bool,
    mapping: Mapping,
}

/// A [`TexturePoint`] as the pattern sees it.
#[derive(Clone, Copy, Debug)]
struct PatternPoint<'a> {
    uv: [f64; 2],
    /// What one sample covers, in steps of `uv`.
    uv_axes: [[f64; 2]; 2],
    position: DVec3,
    /// The same in steps of `position`.
    axes: [DVec3; 2],
    /// For the textures that this one is made of.
    original: &'a TexturePoint,
}

/// What a texture is compiled from.
struct TextureInput<'a> {
    params: Params<'a>,
    names: &'a TextureNames,
    assets: &'a dyn Assets,
    /// What paths are relative to; `None`: the file in which they are written.
    folder: Option<&'a str>,
}

impl Textures {
    /// All textures of a validated description, or everything that is wrong with them.
    pub fn compile(
        description: &Description,
        catalog: &Catalog,
        assets: &dyn Assets,
    ) -> Result<Textures, Vec<Diagnostic>> {
        let mut textures = Textures::default();
        textures.names = textures.extend(description.all(Kind::Texture), None, catalog, assets)?;
        Ok(textures)
    }

    /// The numbers of the description's textures.
    pub fn names(&self) -> &TextureNames {
        &self.names
    }

    /// Add the textures that came with a mesh, whose paths are relative to `folder`. They see only each other; the answer
    /// gives their numbers. On an error nothing is added.
    pub fn add(
        &mut self,
        entities: &[Entity],
        folder: &str,
        catalog: &Catalog,
        assets: &dyn Assets,
    ) -> Result<TextureNames, Vec<Diagnostic>> {
        self.extend(entities, Some(folder), catalog, assets)
    }

    /// The linear Rec.709 colour at a point.
    pub fn color(&self, source: ColorSource, point: &TexturePoint) -> [f32; 3] {
        let [r, g, b, _] = self.lookup(source, point);
        [r, g, b]
    }

    /// The number at a point: of a texture, the mean of its red, green and blue.
    pub fn number(&self, source: NumberSource, point: &TexturePoint) -> f32 {
        match source {
            NumberSource::Constant(value) => value,
            NumberSource::Texture(_) => mean(self.color(source.into(), point)),
        }
    }

    /// The opacity at a point: the alpha channel of an image that has one, else as [`Textures::number`].
    pub fn alpha(&self, source: NumberSource, point: &TexturePoint) -> f32 {
        match source {
            NumberSource::Constant(value) => value,
            NumberSource::Texture(_) => self.lookup(source.into(), point)[3],
        }
    }

    /// True when some texture looks at more of the surface than the point, were it but that.
    pub fn looks_around(&self) -> bool {
        self.placed.iter().any(|p| p.mapping.needs_normal() || matches!(p.texture, Texture::VertexColor(_)))
    }

    /// True when some texture is filtered over what a sample stands for.
    pub fn filters(&self) -> bool {
        self.placed.iter().any(|p| match &p.texture {
            Texture::Image(image) => image.filters(),
            Texture::VertexColor(_) => false,
            _ => true,
        })
    }

    /// The pictures that were read, and how their numbers were understood.
    pub fn pictures(&self) -> Vec<PictureNote> {
        self.files.notes()
    }

    fn lookup(&self, source: ColorSource, point: &TexturePoint) -> [f32; 4] {
        let number = match source {
            ColorSource::Constant(c) => return [c[0], c[1], c[2], mean(c)],
            ColorSource::Texture(number) => number,
        };
        // Numbers come from `TextureNames` of this table; any other is seen as black.
        let Some(placed) = self.placed.get(number as usize) else { return [0.0; 4] };
        placed.lookup(self, point)
    }

    /// `a` where `weight_of_a` is 1, `b` where it is 0.
    fn mix(&self, [a, b]: [ColorSource; 2], weight_of_a: f64, point: &TexturePoint) -> [f32; 4] {
        let (a, b, w) = (self.lookup(a, point), self.lookup(b, point), weight_of_a as f32);
        std::array::from_fn(|i| a[i] * w + b[i] * (1.0 - w))
    }

    fn extend(
        &mut self,
        entities: &[Entity],
        folder: Option<&str>,
        catalog: &Catalog,
        assets: &dyn Assets,
    ) -> Result<TextureNames, Vec<Diagnostic>> {
        let names = TextureNames::numbered(entities, self.placed.len());
        let mut found = references::check(entities, &names, catalog);
        let mut placed = Vec::with_capacity(entities.len());
        for entity in entities {
            let Some(params) = Params::new(entity, Kind::Texture, catalog) else { continue };
            let input = TextureInput { params, names: &names, assets, folder };
            match Placed::compile(&input, &mut self.files) {
                Ok(texture) => placed.push(texture),
                Err(diagnostic) => found.push(diagnostic),
            }
        }
        if !found.is_empty() {
            return Err(found);
        }
        self.placed.append(&mut placed);
        Ok(names)
    }
}

impl Placed {
    fn compile(input: &TextureInput, files: &mut ImageFiles) -> Result<Self, Diagnostic> {
        let texture = match input.params.spec().name {
            "image" => Texture::Image(Image::compile(input, files)?),
            "noise" => Texture::Noise(Noise::compile(input)),
            "marble" => Texture::Marble(Marble::compile(input)),
            "wood" => Texture::Wood(Wood::compile(input)),
            "gradient" => Texture::Gradient(Gradient::compile(input)),
            "brick" => Texture::Brick(Brick::compile(input)),
            "vertex_color" => Texture::VertexColor(VertexColor::compile(input)),
            _ => Texture::Checker(Checker::compile(input)),
        };
        let transform = input.params.entity.params.get("transform").map(read_transform).transpose()?;
        let texture_from_space = transform.filter(|m| *m != DAffine3::IDENTITY).map(|m| m.inverse());
        let is_in_world = input.params.text("space") == Some("world");
        Ok(Placed { texture, texture_from_space, is_in_world, mapping: Mapping::compile(&input.params) })
    }

    fn lookup(&self, textures: &Textures, point: &TexturePoint) -> [f32; 4] {
        if self.mapping == Mapping::Triplanar {
            return self.blend_sides(textures, point);
        }
        self.eval(textures, &self.pattern_point(point))
    }

    fn eval(&self, textures: &Textures, at: &PatternPoint) -> [f32; 4] {
        match &self.texture {
            Texture::Checker(t) => t.eval(textures, at),
            Texture::Image(t) => t.eval(at),
            Texture::Noise(t) => t.eval(textures, at),
            Texture::Marble(t) => t.eval(textures, at),
            Texture::Wood(t) => t.eval(textures, at),
            Texture::Gradient(t) => t.eval(at),
            Texture::Brick(t) => t.eval(textures, at),
            Texture::VertexColor(t) => t.eval(textures, at),
        }
    }
}

impl TextureInput<'_> {
    /// The two things that most textures mix.
    fn a_and_b(&self) -> [ColorSource; 2] {
        ["a", "b"].map(|name| self.names.color(&self.params, name))
    }
}

fn mean([r, g, b]: [f32; 3]) -> f32 {
    (r + g + b) / 3.0
}
