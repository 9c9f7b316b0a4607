//! Wavefront OBJ meshes with MTL materials: the format that every modeller writes.
//!
//! # What is read
//!
//! `v` (weights are dropped; colours behind the position, linear, are kept), `vt`, `vn`, `f` in all four forms with positive and negative indices,
//! `usemtl`, `mtllib`. Groups, smoothing, lines, points, curves and surfaces are passed over; other words are warned of.
//! Polygons are taken as planar; see [`polygon`] for how they are cut. Every different (position, texture coordinate,
//! normal) becomes one vertex, in order of first use. Triangles without a defined material lie in no part of the mesh and
//! take the material of the object that uses it; a missing MTL file is a warning, a broken one an error.
//!
//! # Materials
//!
//! | MTL | native |
//! |---|---|
//! | `Ke` or `map_Ke` not black | `emitter`, with `reflectance = Kd` or `map_Kd`; `Ks` and what refracts are warned of |
//! | `illum` 4, 6, 7, 9 with `d` < 1, `Tf` or `Ni`, black `Kd` | `dielectric` with `ior = Ni`, `transmittance = Tf` |
//! | the same with a `Kd` | `blinn_phong` with `reflect = Ks` (not for 9), `transmit = Tf` or `1 - d`, `ior`; 7: exact Fresnel |
//! | `illum` 3, 5 with `Ks`, black `Kd` | `mirror`; 5: Schlick |
//! | the same with a `Kd` | `blinn_phong` with `reflect = Ks` |
//! | `illum` 0, 1, or no `Ks` | `lambert` |
//! | else | `blinn_phong`, `form = "classic"`, `exponent = Ns` |
//!
//! `d`, `1 - Tr` or `map_d` becomes `alpha` where light does not pass by refraction. Maps are `image` textures; `-s`, `-o`
//! and `-clamp` are honoured, other options and maps are warned of.
//!
//! # Limits
//!
//! Concave polygons of more than 100 corners are cut as if convex.
//!
//! # References
//!
//! Wavefront Technologies, Advanced Visualizer Manual, appendices B1 (OBJ) and "MTL material format" (1995).

mod lines;
mod materials;
mod mtl;
pub mod polygon;
mod statements;
mod unify;

use crate::Failure;
use kirkas_scene::{Diagnostic, Entity, MeshData, Sources};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Gives the bytes of a file that an `mtllib` line names, by its name as written.
pub type OpenMtl<'a> = dyn FnMut(&str) -> Result<Arc<[u8]>, Diagnostic> + 'a;

/// A mesh, and what was passed over in reading it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// The mesh.
    pub mesh: MeshData,
    /// Warnings.
    pub warnings: Vec<Diagnostic>,
    /// The texts that they point into.
    pub sources: Sources,
}

/// Read the OBJ file `bytes`, known to the user as `path`. `mtl` gives the bytes of a file that `mtllib` names.
pub fn read(bytes: &[u8], path: &str, mtl: &mut OpenMtl) -> Result<MeshData, Failure> {
    read_with_warnings(bytes, path, mtl).map(|r| r.mesh)
}

/// [`read`], with the warnings.
pub fn read_with_warnings(bytes: &[u8], path: &str, mtl: &mut OpenMtl) -> Result<Reading, Failure> {
    let fail = |d: Diagnostic| {
        let mut sources = Sources::default();
        sources.add(path, printable(bytes));
        Failure::one(sources, d)
    };
    let statements = statements::read(bytes).map_err(fail)?;
    if statements.faces.is_empty() {
        return Err(fail(no_faces(path, &statements)));
    }

    // Read the material libraries.
    let mut warnings = statements.warnings.clone();
    let mut libraries = Vec::new();
    let mut found: Vec<Entity> = Vec::new();
    let mut textures = Vec::new();
    let mut names = BTreeSet::new();
    for (name, content) in open_libraries(&statements, mtl, &mut warnings) {
        let source = kirkas_scene::SourceId(1 + libraries.len() as u32);
        libraries.push((beside(path, &name), printable(&content)));
        let materials = mtl::read(&content, source, &mut warnings).map_err(|d| {
            let mut sources = Sources::default();
            sources.add(path, printable(bytes));
            libraries.drain(..).for_each(|(p, t)| {
                sources.add(p, t);
            });
            Failure::one(sources, d)
        })?;
        let folder = name.rfind('/').map_or("", |i| &name[..=i]);
        for material in materials {
            if names.insert(material.name.clone()) {
                found.push(materials::to_native(&material, folder, &mut textures, &mut warnings));
            } else {
                let message = format!("material `{}` is defined twice; the first holds", material.name);
                warnings.push(Diagnostic::warning("duplicate-name", message));
            }
        }
    }

    // Give every corner one index.
    let mut mesh = unify::unify(&statements, |n| names.contains(n)).map_err(fail)?;
    let mut told = BTreeSet::new();
    for (_, name) in &statements.switches {
        let text = name.text();
        if !text.is_empty() && !names.contains(text.as_ref()) && told.len() < 20 && told.insert(text.to_string()) {
            let mut d = kirkas_scene::diagnostic::unknown_name(
                "material",
                &name.shown(),
                name.span(statements::SOURCE),
                names.iter().map(String::as_str).filter(|n| n.len() < 64),
            );
            d.severity = kirkas_scene::Severity::Warning;
            warnings.push(d.help("its triangles take the material of the object that uses the mesh"));
        }
    }
    mesh.materials = found;
    mesh.textures = textures;
    mesh.folder = path.rfind('/').map_or(String::new(), |i| path[..i].to_string());
    let mut sources = Sources::default();
    if !warnings.is_empty() {
        sources.add(path, printable(bytes));
        libraries.into_iter().for_each(|(p, t)| {
            sources.add(p, t);
        });
    }
    Ok(Reading { mesh, warnings, sources })
}

fn no_faces(path: &str, statements: &statements::Statements) -> Diagnostic {
    let vertices = statements.positions.len();
    let message = if vertices > 0 {
        format!("`{path}` holds {vertices} vertices but no faces: there is nothing to draw")
    } else {
        format!("`{path}` holds no faces: it may be empty, cut off, or no OBJ file")
    };
    Diagnostic::error("no-faces", message).help("export a mesh with faces (`f` lines)")
}

/// The contents of all libraries that can be had. A line may hold one name with spaces, or several names.
fn open_libraries(
    statements: &statements::Statements,
    mtl: &mut OpenMtl,
    warnings: &mut Vec<Diagnostic>,
) -> Vec<(String, Arc<[u8]>)> {
    let mut opened: Vec<(String, Arc<[u8]>)> = Vec::new();
    let mut tried = BTreeSet::new();
    for line in &statements.libraries {
        let whole = line.text().replace('\\', "/");
        if whole.is_empty() || tried.len() >= 1000 || !tried.insert(whole.clone()) {
            continue;
        }
        let problem = match mtl(&whole) {
            Ok(content) => {
                opened.push((whole, content));
                continue;
            }
            Err(problem) => problem,
        };
        let parts: Vec<(String, Arc<[u8]>)> = whole
            .split_whitespace()
            .take(if whole.contains(char::is_whitespace) { 100 } else { 0 })
            .filter_map(|part| mtl(part).ok().map(|content| (part.to_string(), content)))
            .collect();
        if parts.is_empty() {
            warnings.push(
                Diagnostic::warning(
                    "missing-mtl",
                    format!("the materials in `{whole}` are missing: {}", problem.message),
                )
                .at(line.span(statements::SOURCE), "cannot be read")
                .help("put the file beside the OBJ; until then the object's own material is used"),
            );
        }
        opened.extend(parts.into_iter().filter(|(name, _)| tried.insert(name.clone())));
    }
    opened
}

fn beside(path: &str, name: &str) -> String {
    match path.rfind('/') {
        Some(i) => format!("{}/{name}", &path[..i]),
        None => name.to_string(),
    }
}

/// A text of the same length to point into: bytes that are not UTF-8 become `?`.
pub(crate) fn printable(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_string(),
        Err(_) => bytes.iter().map(|&b| if b.is_ascii() { b as char } else { '?' }).collect(),
    }
}
