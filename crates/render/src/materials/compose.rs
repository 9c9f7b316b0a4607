//! Compiles materials, those that are made of others after these. Refuses those that are made of themselves, of too much, or of what
//! cannot be a part.

use super::Material;
use crate::textures::TextureNames;
use kirkas_optics::Palette;
use kirkas_optics::bsdf::{MOST_PARTS, part_names};
use kirkas_scene::{Catalog, Description, Diagnostic, Entity, Kind, Params, Span};
use std::collections::BTreeMap;
use std::sync::Arc;

/// How deep parts may be nested.
const MOST_DEEP: usize = 16;
/// How many materials one may be made of, all told.
const MOST_TOGETHER: usize = 64;

/// All materials of a validated description, in order; `interior` is the number of the medium within one.
pub fn compile_all(
    d: &Description,
    catalog: &Catalog,
    textures: &TextureNames,
    palette: &Palette,
    interior: &dyn Fn(&Entity) -> Option<u32>,
) -> Result<Vec<Material>, Vec<Diagnostic>> {
    let mut compiler = Compiler { d, catalog, textures, palette, interior, done: BTreeMap::new(), open: Vec::new() };
    let mut all = Vec::new();
    for entity in d.all(Kind::Material) {
        all.extend(compiler.compile(entity).map_err(|d| vec![d])?);
    }
    drop(compiler);
    Ok(all.into_iter().map(|done| Arc::try_unwrap(done.material).unwrap_or_else(|shared| (*shared).clone())).collect())
}

#[derive(Clone)]
struct Done {
    material: Arc<Material>,
    /// How many materials it is made of, with itself.
    size: usize,
}

struct Compiler<'a> {
    d: &'a Description,
    catalog: &'a Catalog,
    textures: &'a TextureNames,
    palette: &'a Palette,
    interior: &'a dyn Fn(&Entity) -> Option<u32>,
    done: BTreeMap<&'a str, Done>,
    /// What is being compiled, outermost first, each with the place that names the next.
    open: Vec<(&'a str, Span)>,
}

impl<'a> Compiler<'a> {
    fn compile(&mut self, entity: &'a Entity) -> Result<Option<Done>, Diagnostic> {
        let name = entity.name.text.as_str();
        if let Some(done) = self.done.get(name) {
            return Ok(Some(done.clone()));
        }
        if let Some(start) = self.open.iter().position(|step| step.0 == name) {
            return Err(cycle(&self.open[start..]));
        }
        if self.open.len() >= MOST_DEEP {
            let message = format!("material `{}` is made of materials more than {MOST_DEEP} deep", self.open[0].0);
            return Err(Diagnostic::error("too-deep", message)
                .at(self.open[0].1, "made of this")
                .help("put less into each other"));
        }
        let Some(params) = Params::new(entity, Kind::Material, self.catalog) else { return Ok(None) };
        let (mut parts, mut size) = (Vec::new(), 1);
        for (part_name, span) in part_names(&params) {
            let Some(part) = self.d.find(Kind::Material, part_name) else { continue };
            self.open.push((name, span));
            let part = self.compile(part)?;
            self.open.pop();
            let Some(part) = part else { continue };
            check_part(&params, &part.material, span)?;
            size += part.size;
            parts.push(part.material);
        }
        check_counts(&params, parts.len(), size)?;
        check_bodies(&params, &parts)?;
        let is_plain = parts.is_empty();
        let Some(mut material) = Material::composed(&params, self.textures, self.palette, parts) else {
            return Ok(None);
        };
        if is_plain {
            material.interior = (self.interior)(entity);
        }
        let done = Done { material: Arc::new(material), size };
        self.done.insert(name, done.clone());
        Ok(Some(done))
    }
}

fn cycle(path: &[(&str, Span)]) -> Diagnostic {
    let names: Vec<String> = path.iter().chain(&path[..1]).map(|step| format!("`{}`", step.0)).collect();
    let message = format!("material {} is made of itself: {}", names[0], names.join(" -> "));
    let error = Diagnostic::error("material-cycle", message).help("make one of these of another material");
    path.iter()
        .enumerate()
        .fold(error, |error, (i, (_, span))| error.at(*span, format!("{} is made of {}", names[i], names[i + 1])))
}

/// Lamps shine as a whole, and hulls are not there.
fn check_part(params: &Params, part: &Material, span: Span) -> Result<(), Diagnostic> {
    let owner = &params.entity.name.text;
    let refuse = |what: &str, cure: &str| {
        let message = format!("`{}` is {what}, which cannot be part of `{owner}`", part.name);
        Err(Diagnostic::error("bad-part", message).at(span, what).help(cure))
    };
    if part.is_hull {
        return refuse("a hull", "a hull bounds a medium by itself: give it an object of its own");
    }
    if part.emission.is_some() && params.spec().name != "mask" {
        return refuse("a lamp", "only a `mask` can be made of an `emitter`");
    }
    Ok(())
}

fn check_counts(params: &Params, parts: usize, size: usize) -> Result<(), Diagnostic> {
    let name = &params.entity.name.text;
    let error = |code, message: String, row: &str, help: String| {
        Err(Diagnostic::error(code, message).at(params.span(row), "here").help(help))
    };
    if params.spec().name == "sum" {
        if parts == 0 || parts > MOST_PARTS {
            let message = format!("`{name}` adds up {parts} materials");
            return error("bad-sum", message, "materials", format!("name from 1 to {MOST_PARTS}"));
        }
        let weights = params.entity.params.get("weights").and_then(|n| n.list()).map(<[_]>::len);
        if weights.is_some_and(|count| count != parts) {
            let message = format!("`{name}` has {} weights for {parts} materials", weights.unwrap_or_default());
            return error("bad-sum", message, "weights", "give one weight for each material".into());
        }
    }
    if size > MOST_TOGETHER {
        let message = format!("`{name}` is made of {size} materials, all told");
        return Err(Diagnostic::error("too-deep", message)
            .at(params.entity.name.span, "this material")
            .help(format!("at most {MOST_TOGETHER} can be put together")));
    }
    Ok(())
}

/// A surface has one body behind it.
fn check_bodies(params: &Params, parts: &[Arc<Material>]) -> Result<(), Diagnostic> {
    let mut bodies = parts.iter().filter_map(|part| Some((part, part.medium.as_ref()?)));
    let Some((first, body)) = bodies.next() else { return Ok(()) };
    let differs = |part: &Material, other: &kirkas_optics::Medium| {
        other.ior != body.ior
            || other.priority != body.priority
            || other.absorption.rgb() != body.absorption.rgb()
            || part.interior != first.interior
            || part.scales_radiance != first.scales_radiance
    };
    let Some((other, _)) = bodies.find(|(part, medium)| differs(part, medium)) else { return Ok(()) };
    if params.spec().name == "two_sided" {
        return Ok(());
    }
    let message = format!(
        "`{}` and `{}` are filled differently, but `{}` has one inside",
        first.name, other.name, params.entity.name.text
    );
    Err(Diagnostic::error("two-bodies", message)
        .at(params.entity.name.span, "made of both")
        .help("give both the same `ior`, `absorption`, `priority`, `fresnel` and `interior`"))
}
