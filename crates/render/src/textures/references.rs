//! Names of textures become numbers; textures that are made of themselves are refused.

use kirkas_scene::diagnostic::unknown_name;
use kirkas_scene::params::read_color;
use kirkas_scene::{Catalog, Diagnostic, Entity, Kind, ParamType, Params, Span};
use std::collections::BTreeMap;

/// A colour parameter: plain, or a texture by number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ColorSource {
    /// The same everywhere, linear Rec.709.
    Constant([f32; 3]),
    /// Look it up.
    Texture(u32),
}

/// A number parameter: plain, or a texture by number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NumberSource {
    /// The same everywhere.
    Constant(f32),
    /// Look it up.
    Texture(u32),
}

impl From<NumberSource> for ColorSource {
    fn from(source: NumberSource) -> Self {
        match source {
            NumberSource::Constant(value) => ColorSource::Constant([value; 3]),
            NumberSource::Texture(number) => ColorSource::Texture(number),
        }
    }
}

/// The numbers of textures that can be named in one place: in a scene, or in a mesh's own materials.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TextureNames(BTreeMap<String, u32>);

impl TextureNames {
    /// The colour parameter `name`: as written, else its default.
    pub fn color(&self, params: &Params, name: &str) -> ColorSource {
        match self.written(params, name) {
            Some(number) => ColorSource::Texture(number),
            None => ColorSource::Constant(params.color(name).map(|c| c as f32)),
        }
    }

    /// The colour parameter `name`, if written.
    pub fn optional_color(&self, params: &Params, name: &str) -> Option<ColorSource> {
        params.has(name).then(|| self.color(params, name))
    }

    /// The number parameter `name`: as written, else its default.
    pub fn number(&self, params: &Params, name: &str) -> NumberSource {
        match self.written(params, name) {
            Some(number) => NumberSource::Texture(number),
            None => NumberSource::Constant(params.f32(name)),
        }
    }

    /// The vector parameter `name`: as written, else its default.
    pub fn vector(&self, params: &Params, name: &str) -> ColorSource {
        match self.written(params, name) {
            Some(number) => ColorSource::Texture(number),
            None => ColorSource::Constant(params.vector(name).map(|x| x as f32)),
        }
    }

    /// The number of the texture called `name`.
    pub fn find(&self, name: &str) -> Option<u32> {
        self.0.get(name).copied()
    }

    pub(super) fn numbered(entities: &[Entity], first: usize) -> Self {
        TextureNames(entities.iter().zip(first as u32..).map(|(e, number)| (e.name.text.clone(), number)).collect())
    }

    fn written(&self, params: &Params, name: &str) -> Option<u32> {
        params.entity.params.get(name).and_then(|node| self.find(texture_name(node)?))
    }
}

/// A texture costs one lookup and those of everything it is made of; more than this is refused.
const MAX_LOOKUPS: u64 = 1000;

/// Everything that is wrong with how `entities` refer to each other.
pub(super) fn check(entities: &[Entity], names: &TextureNames, catalog: &Catalog) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    let first = names.0.values().min().copied().unwrap_or(0);
    let mut children = Vec::with_capacity(entities.len());
    for entity in entities {
        let made_of = references(entity, catalog, &mut found);
        let mut known = Vec::with_capacity(made_of.len());
        for (name, span) in made_of {
            match names.find(name) {
                Some(number) => known.push(Reference { to: (number - first) as usize, span }),
                None => {
                    let all: Vec<&str> = names.0.keys().map(String::as_str).collect();
                    found.push(unknown_name("texture", name, span, all));
                }
            }
        }
        children.push(known);
    }
    check_graph(entities, &children, &mut found);
    found
}

struct Reference {
    to: usize,
    span: Span,
}

/// The textures that `entity` names, and where.
fn references<'a>(entity: &'a Entity, catalog: &Catalog, found: &mut Vec<Diagnostic>) -> Vec<(&'a str, Span)> {
    let Some(spec) = catalog.find(Kind::Texture, &entity.type_name.text) else {
        let known: Vec<&str> = catalog.of_kind(Kind::Texture).map(|t| t.name).collect();
        found.push(unknown_name("texture type", &entity.type_name.text, entity.type_name.span, known));
        return Vec::new();
    };
    catalog
        .rows(spec)
        .filter(|row| matches!(row.ty, ParamType::ColorTexture | ParamType::NumberTexture | ParamType::VectorTexture))
        .filter_map(|row| entity.params.get(row.name))
        .filter_map(|node| Some((texture_name(node)?, node.span)))
        .collect()
}

fn texture_name(node: &kirkas_scene::Node) -> Option<&str> {
    node.text().filter(|_| read_color(&node.value).is_none())
}

#[derive(Clone, Copy, PartialEq)]
enum Visit {
    New,
    Open,
    Done,
}

/// Walks from every texture into what it is made of (with a stack of its own: a scene may be arbitrarily deep).
fn check_graph(entities: &[Entity], children: &[Vec<Reference>], found: &mut Vec<Diagnostic>) {
    let mut visits = vec![Visit::New; entities.len()];
    let mut lookups = vec![0_u64; entities.len()];
    for root in 0..entities.len() {
        if visits[root] != Visit::New {
            continue;
        }
        visits[root] = Visit::Open;
        // Each entry: a texture and how many of its references have been followed.
        let mut path = vec![(root, 0)];
        while let Some((at, followed)) = path.last_mut() {
            let (at, child) = (*at, children[*at].get(*followed));
            *followed += 1;
            match child {
                Some(reference) => match visits[reference.to] {
                    Visit::New => {
                        visits[reference.to] = Visit::Open;
                        path.push((reference.to, 0));
                    }
                    Visit::Open => {
                        let start = path.iter().position(|step| step.0 == reference.to).unwrap_or(0);
                        found.push(cycle(entities, children, &path[start..]));
                    }
                    Visit::Done => {}
                },
                None => {
                    let below = children[at].iter().map(|c| lookups[c.to]);
                    let is_first_too_deep = below.clone().all(|n| n <= MAX_LOOKUPS);
                    lookups[at] = below.fold(1, u64::saturating_add);
                    if lookups[at] > MAX_LOOKUPS && is_first_too_deep {
                        found.push(too_deep(&entities[at]));
                    }
                    visits[at] = Visit::Done;
                    path.pop();
                }
            }
        }
    }
}

fn cycle(entities: &[Entity], children: &[Vec<Reference>], path: &[(usize, usize)]) -> Diagnostic {
    let name = |i: usize| entities[i].name.text.as_str();
    let start = path[0].0;
    let chain: Vec<String> = path.iter().map(|step| step.0).chain([start]).map(|i| format!("`{}`", name(i))).collect();
    let message = format!("texture `{}` is made of itself: {}", name(start), chain.join(" -> "));
    let error = Diagnostic::error("texture-cycle", message)
        .help("replace one of these references by a colour or by another texture");
    path.iter().fold(error, |error, &(at, followed)| {
        // The walk has counted the reference that it follows.
        let reference = &children[at][followed - 1];
        error.at(reference.span, format!("`{}` uses `{}`", name(at), name(reference.to)))
    })
}

fn too_deep(entity: &Entity) -> Diagnostic {
    Diagnostic::error(
        "texture-too-deep",
        format!("texture `{}` needs more than {MAX_LOOKUPS} lookups of other textures at each point", entity.name.text),
    )
    .at(entity.name.span, "made of too many textures")
    .help("nest fewer textures in it, for example by rendering a part of them into an image")
}
