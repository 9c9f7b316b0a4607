//! MIT 6.837 scene text: the format of the course's ray tracing assignments, in the dialects of 2004 and 2012.
//!
//! # What is read
//!
//! `PerspectiveCamera`, `OrthographicCamera`, `Lights` (`DirectionalLight`, `PointLight`), `Background`, `Materials`
//! (`PhongMaterial` or `Material`; `Checkerboard`, `Noise`, `Marble`, `Wood` of two materials) and `Group` with `Sphere`,
//! `Plane`, `Triangle`, `TriangleMesh`, `Transform` and `Group` inside. `#` and `//` start comments. Counts such as
//! `numObjects` may be left out, but must be right.
//!
//! # How it is meant
//!
//! | the course | native |
//! |---|---|
//! | no flags | 200 x 200 pixels, one point sample, `whitted` with `max_depth = 0`, no shadows, backs not shaded |
//! | `-size W H` | `--size WxH` |
//! | `-shadows` | `-D integrator.shadows=opaque` |
//! | `-bounces N`, `-weight W` | `-D integrator.max_depth=N`, `-D integrator.min_contribution=W` |
//! | `-shade_back` | `-D integrator.shade_back=true` |
//! | `ambientLight` | an `ambient` light: it adds itself times the diffuse colour |
//! | no `Lights` and no `ambientLight` (first assignment) | a white `ambient` light: pictures show the diffuse colour |
//! | `attenuation c l q` | `attenuation = [q, l, c]`, `1 / (q r^2 + l r + c)`; absent: no falloff |
//! | `exponent` (2004) | `blinn_phong`: half vector (Blinn-Torrance), not multiplied by the cosine |
//! | `shininess` (2012) | `phong`: reflected vector |
//! | `texture FILE` (2012) | replaces the diffuse colour, used as stored (linear) |
//! | `Noise { color color ... }` in a material (2012) | a `marble` texture of two colours |
//! | a pattern of two materials | one material; colours that differ become textures in world space |
//! | its `Transform` | takes world to texture space (a scale of 2 halves the squares); natively inverted |
//! | `Transform` around an object | as in OpenGL the step next to the object acts first; natively the list is reversed |
//! | `Plane` | the plane `n . p = offset`, with `n` the normal made unit |
//!
//! Lights are numbered `light_0`, ..., materials `material_0`, ..., objects by type: `sphere_0`, `mesh_0`, `group_0`, ...
//!
//! # Limits
//!
//! `cubeMap` and `bump` are ignored with a warning. `TriangleMesh` uses the normals of the file and is flat without them, as
//! in 2004; the course of 2012 smooths all meshes: `-D objects.mesh_0.normals=smooth`. Patterns of materials with different
//! refractive indices take the first one's. Groups and transformations nest 64 deep at most.
//!
//! # References
//!
//! MIT 6.837 Introduction to Computer Graphics, assignments 1 to 7 (Fall 2004) and 4 (Fall 2012), OpenCourseWare.

mod emit;
mod materials;
mod parse;
mod scene;
mod tokens;

use crate::Failure;
use crate::failure::read_text;
use kirkas_scene::files::FileAccess;
use kirkas_scene::{Description, Diagnostic, Sources};

/// Read the scene `path`.
pub fn read(files: &FileAccess, path: &str) -> Result<Description, Failure> {
    read_with_warnings(files, path).map(|r| r.0)
}

/// [`read`], with what is approximated or ignored.
pub fn read_with_warnings(files: &FileAccess, path: &str) -> Result<(Description, Vec<Diagnostic>), Failure> {
    let file = read_text(files, "", path)?;
    let mut d = Description::default();
    let mut warnings = Vec::new();
    let source = d.sources.add(file.path, file.text);
    // The text moves out for the time of reading, so that the description can be written to.
    let sources = std::mem::take(&mut d.sources);
    let text = sources.get(source).map_or("", |s| s.text.as_str());
    let outcome = parse::parse(tokens::Tokens::new(text, source), &mut warnings)
        .and_then(|scene| check_complete(&scene, &sources).map(|()| scene))
        .and_then(|scene| emit::emit(scene, &mut d, &mut warnings));
    match outcome {
        Ok(()) => {
            d.sources = sources;
            Ok((d, warnings))
        }
        Err(problem) => Err(Failure::one(sources, problem)),
    }
}

fn check_complete(scene: &scene::Scene, sources: &Sources) -> Result<(), Diagnostic> {
    let path = sources.0.first().map_or("", |s| s.path.as_str());
    let is_empty = sources.0.iter().all(|s| s.text.trim().is_empty());
    let message = match () {
        () if is_empty => format!("`{path}` is empty"),
        () if scene.cameras.is_empty() => format!("`{path}` has no camera"),
        () if scene.objects.is_empty() => format!("`{path}` has no objects"),
        () => return Ok(()),
    };
    Err(Diagnostic::error("incomplete", message)
        .help("a scene has a `PerspectiveCamera` or `OrthographicCamera` block, `Materials` and a `Group` of objects"))
}
