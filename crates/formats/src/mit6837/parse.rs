//! From text to [`Scene`].

use super::scene::*;
use super::tokens::{Token, Tokens};
use kirkas_scene::diagnostic::unknown_name;
use kirkas_scene::{Diagnostic, Span};

/// Groups and transformations nest no deeper than this.
pub(super) const DEEPEST: usize = 64;

const MATERIALS: [&str; 6] = ["PhongMaterial", "Material", "Checkerboard", "Noise", "Marble", "Wood"];
const STEPS: [&str; 8] = ["Translate", "Scale", "UniformScale", "XRotate", "YRotate", "ZRotate", "Rotate", "Matrix"];
const OBJECTS: [&str; 6] = ["Sphere", "Plane", "Triangle", "TriangleMesh", "Transform", "Group"];

/// Read the whole text.
pub(super) fn parse(tokens: Tokens, warnings: &mut Vec<Diagnostic>) -> Result<Scene, Diagnostic> {
    let mut p = Parser { tokens, scene: Scene::default(), material: None, warnings };
    while let Some(word) = p.tokens.next() {
        match word.text {
            "PerspectiveCamera" | "OrthographicCamera" => p.camera(word)?,
            "Lights" => p.lights(word)?,
            "Background" => p.background(word)?,
            "Materials" => p.materials(word)?,
            "Group" => {
                let objects = p.group(word, 0)?;
                p.scene.objects.extend(objects);
            }
            _ => {
                let known = ["PerspectiveCamera", "OrthographicCamera", "Lights", "Background", "Materials", "Group"];
                return Err(unknown_name("block", &word.shown(), word.span, known));
            }
        }
    }
    Ok(p.scene)
}

struct Parser<'a, 'w> {
    tokens: Tokens<'a>,
    scene: Scene,
    /// What the last `MaterialIndex` said.
    material: Option<At<usize>>,
    warnings: &'w mut Vec<Diagnostic>,
}

fn missing(owner: Token, name: &str) -> Diagnostic {
    Diagnostic::error("missing-value", format!("`{}` lacks `{name}`", owner.shown()))
        .at(owner.span, format!("needs `{name}`"))
        .help(format!("add a line `{name} ...` to its block"))
}

fn unknown(owner: Token, word: Token, known: &[&str]) -> Diagnostic {
    unknown_name(&format!("word in `{}`:", owner.shown()), &word.shown(), word.span, known.iter().copied())
}

/// `numObjects 3` must tell the truth.
fn check_count(said: Option<(Token, At<usize>)>, found: usize, what: &str, owner: Token) -> Result<(), Diagnostic> {
    match said {
        Some((word, (n, span))) if n != found => Err(Diagnostic::error(
            "wrong-count",
            format!("`{}` says {n}, but this block holds {found} {what}", word.text),
        )
        .at(span, format!("should be {found}"))
        .at(owner.span, "of this block")
        .help(format!("write `{} {found}`, or mend the block", word.text))),
        _ => Ok(()),
    }
}

impl<'a> Parser<'a, '_> {
    fn ignored(&mut self, word: Token, why: &str) {
        let message = format!("`{}` is ignored: {why}", word.shown());
        self.warnings.push(Diagnostic::warning("ignored", message).at(word.span, "has no effect"));
    }

    fn camera(&mut self, owner: Token) -> Result<(), Diagnostic> {
        let is_perspective = owner.text == "PerspectiveCamera";
        let size = if is_perspective { "angle" } else { "size" };
        let (mut center, mut direction, mut up, mut extent) = (None, None, None, None);
        self.tokens.open(owner)?;
        while let Some(word) = self.tokens.entry(owner)? {
            match word.text {
                "center" => center = Some(self.tokens.numbers(word)?),
                "direction" => direction = Some(self.tokens.numbers(word)?),
                "up" => up = Some(self.tokens.numbers(word)?),
                w if w == size => extent = Some(self.tokens.number(word)?),
                _ => return Err(unknown(owner, word, &["center", "direction", "up", size])),
            }
        }
        self.scene.cameras.push(Camera {
            span: owner.span,
            center: center.ok_or_else(|| missing(owner, "center"))?,
            direction: not_zero(direction.ok_or_else(|| missing(owner, "direction"))?, "direction")?,
            up,
            extent: extent.ok_or_else(|| missing(owner, size))?,
            is_perspective,
        });
        Ok(())
    }

    fn lights(&mut self, owner: Token) -> Result<(), Diagnostic> {
        let (before, mut said) = (self.scene.lights.len(), None);
        self.scene.names_lights = true;
        self.tokens.open(owner)?;
        while let Some(word) = self.tokens.entry(owner)? {
            match word.text {
                "numLights" => said = Some((word, self.tokens.count(word)?)),
                "DirectionalLight" | "PointLight" => self.light(word)?,
                _ => return Err(unknown(owner, word, &["numLights", "DirectionalLight", "PointLight"])),
            }
        }
        check_count(said, self.scene.lights.len() - before, "lights", owner)
    }

    fn light(&mut self, owner: Token) -> Result<(), Diagnostic> {
        let is_point = owner.text == "PointLight";
        let place = if is_point { "position" } else { "direction" };
        let known: &[&str] = if is_point { &["position", "color", "attenuation"] } else { &["direction", "color"] };
        let (mut at, mut color, mut attenuation) = (None, None, ([1.0, 0.0, 0.0], Span::NONE));
        self.tokens.open(owner)?;
        while let Some(word) = self.tokens.entry(owner)? {
            match word.text {
                "color" => color = Some(self.tokens.numbers(word)?),
                "attenuation" if is_point => attenuation = self.tokens.numbers(word)?,
                w if w == place => at = Some(self.tokens.numbers(word)?),
                _ => return Err(unknown(owner, word, known)),
            }
        }
        let at = at.ok_or_else(|| missing(owner, place))?;
        let place = match is_point {
            true => LightPlace::Point(at, attenuation),
            false => LightPlace::Directional(not_zero(at, "direction")?),
        };
        let color = color.ok_or_else(|| missing(owner, "color"))?;
        self.scene.lights.push(Light { span: owner.span, color, place });
        Ok(())
    }

    fn background(&mut self, owner: Token) -> Result<(), Diagnostic> {
        self.tokens.open(owner)?;
        while let Some(word) = self.tokens.entry(owner)? {
            match word.text {
                "color" => self.scene.background = Some(self.tokens.numbers(word)?),
                "ambientLight" => self.scene.ambient = Some(self.tokens.numbers(word)?),
                "cubeMap" => {
                    self.scene.is_2012 = true;
                    self.tokens.expect("a folder", word)?;
                    self.ignored(word, "Kirkas has no cube maps yet; the background is plain");
                }
                _ => return Err(unknown(owner, word, &["color", "ambientLight", "cubeMap"])),
            }
        }
        Ok(())
    }

    fn materials(&mut self, owner: Token) -> Result<(), Diagnostic> {
        let (before, mut said) = (self.scene.materials.len(), None);
        self.tokens.open(owner)?;
        while let Some(word) = self.tokens.entry(owner)? {
            let material = match word.text {
                "numMaterials" => {
                    said = Some((word, self.tokens.count(word)?));
                    continue;
                }
                "PhongMaterial" | "Material" => Material::Surface(Box::new(self.surface(word)?)),
                "Checkerboard" => Material::Pattern(self.pattern(word, "checker")?),
                "Noise" => Material::Pattern(self.pattern(word, "noise")?),
                "Marble" => Material::Pattern(self.pattern(word, "marble")?),
                "Wood" => Material::Pattern(self.pattern(word, "wood")?),
                _ => return Err(unknown(owner, word, &[&MATERIALS[..], &["numMaterials"]].concat())),
            };
            self.scene.materials.push((material, word.span));
        }
        check_count(said, self.scene.materials.len() - before, "materials", owner)
    }

    fn surface(&mut self, owner: Token) -> Result<Surface, Diagnostic> {
        let mut s = Surface::default();
        self.tokens.open(owner)?;
        while let Some(word) = self.tokens.entry(owner)? {
            match word.text {
                "diffuseColor" => s.diffuse = Some(self.tokens.numbers(word)?),
                "specularColor" => s.specular = Some(self.tokens.numbers(word)?),
                "reflectiveColor" => s.reflective = Some(self.tokens.numbers(word)?),
                "transparentColor" => s.transparent = Some(self.tokens.numbers(word)?),
                "indexOfRefraction" | "refractionIndex" => s.ior = Some(self.tokens.number(word)?),
                "exponent" | "shininess" => {
                    s.exponent = Some(self.tokens.number(word)?);
                    s.has_shininess = word.text == "shininess";
                    self.scene.is_2012 |= s.has_shininess;
                }
                "texture" => {
                    self.scene.is_2012 = true;
                    let file = self.tokens.expect("an image file", word)?;
                    s.texture = Some((file.text.to_string(), file.span));
                }
                "bump" => {
                    self.scene.is_2012 = true;
                    self.tokens.expect("an image file", word)?;
                    self.ignored(word, "Kirkas has no bump maps yet");
                }
                "Noise" => {
                    self.scene.is_2012 = true;
                    s.noise = Some(self.color_noise(word)?);
                }
                _ => {
                    let known = [
                        "diffuseColor",
                        "specularColor",
                        "reflectiveColor",
                        "transparentColor",
                        "indexOfRefraction",
                        "exponent",
                        "shininess",
                        "texture",
                        "bump",
                        "Noise",
                    ];
                    return Err(unknown(owner, word, &known));
                }
            }
        }
        Ok(s)
    }

    /// One of `octaves`, `frequency`, `amplitude`; false if `word` is none of them.
    fn turbulence(&mut self, word: Token, t: &mut Turbulence) -> Result<bool, Diagnostic> {
        match word.text {
            "octaves" => t.octaves = Some(self.tokens.count(word)?),
            "frequency" => t.frequency = Some(self.tokens.number(word)?),
            "amplitude" => t.amplitude = Some(self.tokens.number(word)?),
            _ => return Ok(false),
        }
        Ok(true)
    }

    fn color_noise(&mut self, owner: Token) -> Result<ColorNoise, Diagnostic> {
        let (mut colors, mut turbulence) = (Vec::new(), Turbulence::default());
        self.tokens.open(owner)?;
        while let Some(word) = self.tokens.entry(owner)? {
            match word.text {
                "color" if colors.len() < 2 => colors.push(self.tokens.numbers(word)?),
                _ if self.turbulence(word, &mut turbulence)? => {}
                _ => return Err(unknown(owner, word, &["color", "octaves", "frequency", "amplitude"])),
            }
        }
        let colors = colors.try_into().map_err(|_| missing(owner, "color"))?;
        Ok(ColorNoise { colors, turbulence })
    }

    fn pattern(&mut self, owner: Token, texture: &'static str) -> Result<Pattern, Diagnostic> {
        let (mut steps, mut materials, mut turbulence) = (Vec::new(), Vec::new(), Turbulence::default());
        self.tokens.open(owner)?;
        while let Some(word) = self.tokens.entry(owner)? {
            match word.text {
                "Transform" => {
                    self.tokens.open(word)?;
                    while let Some(step) = self.tokens.entry(word)? {
                        match self.step(step)? {
                            Some(s) => steps.push(s),
                            None => return Err(unknown(word, step, &STEPS)),
                        }
                    }
                }
                "materialIndex" if materials.len() < 2 => {
                    let (index, span) = self.tokens.count(word)?;
                    self.check_index((index, span))?;
                    materials.push((index, span));
                }
                "materialIndex" => {
                    return Err(Diagnostic::error(
                        "too-many",
                        format!("`{}` mixes two materials, not more", owner.text),
                    )
                    .at(word.span, "the third")
                    .help("mix two, and mix the result with the third in another pattern"));
                }
                _ if texture != "checker" && self.turbulence(word, &mut turbulence)? => {}
                _ if texture == "checker" => return Err(unknown(owner, word, &["Transform", "materialIndex"])),
                _ => {
                    let known = ["Transform", "materialIndex", "octaves", "frequency", "amplitude"];
                    return Err(unknown(owner, word, &known));
                }
            }
        }
        let materials = materials.try_into().map_err(|_| missing(owner, "materialIndex"))?;
        Ok(Pattern { texture, steps, materials, turbulence })
    }

    /// Only materials that stand above may be named.
    fn check_index(&self, (index, span): At<usize>) -> Result<(), Diagnostic> {
        let count = self.scene.materials.len();
        if index < count {
            return Ok(());
        }
        let (message, help) = match count {
            0 => (
                format!("material {index} does not exist: there are none above"),
                "write the `Materials` block first".into(),
            ),
            _ => (
                format!("material {index} does not exist: there are {count} above"),
                format!("write a number from 0 to {}", count - 1),
            ),
        };
        Err(Diagnostic::error("bad-index", message).at(span, "no such material").help(help))
    }

    /// A transformation's step; `None` if `word` is none.
    fn step(&mut self, word: Token) -> Result<Option<Step>, Diagnostic> {
        let (action, span) = match word.text {
            "Translate" => {
                let (v, span) = self.tokens.numbers(word)?;
                (Action::Translate(v), span)
            }
            "Scale" => {
                let (v, span) = self.tokens.numbers(word)?;
                (Action::Scale(v), span)
            }
            "UniformScale" => {
                let (s, span) = self.tokens.number(word)?;
                (Action::Scale([s; 3]), span)
            }
            "XRotate" | "YRotate" | "ZRotate" => {
                let (a, span) = self.tokens.number(word)?;
                let axis = |c: char| if word.text.starts_with(c) { 1.0 } else { 0.0 };
                (Action::Rotate([axis('X'), axis('Y'), axis('Z'), a]), span)
            }
            "Rotate" => {
                self.tokens.open(word)?;
                self.skip("axis");
                let ([x, y, z], axis) = not_zero(self.tokens.numbers(word)?, "axis")?;
                self.skip("angle");
                let (a, end) = self.tokens.number(word)?;
                self.close(word)?;
                (Action::Rotate([x, y, z, a]), axis.to(end))
            }
            "Matrix" => {
                self.tokens.open(word)?;
                let (m, span) = self.tokens.numbers::<16>(word)?;
                self.close(word)?;
                if m[12..] != [0.0, 0.0, 0.0, 1.0] {
                    return Err(Diagnostic::error("bad-matrix", "the last row of a matrix must be 0 0 0 1")
                        .at(span, "by rows")
                        .help("write sixteen numbers, row by row; the translation ends the first three rows"));
                }
                (Action::Matrix(std::array::from_fn(|i| m[i])), span)
            }
            _ => return Ok(None),
        };
        Ok(Some(Step { span: word.span.to(span), action }))
    }

    fn skip(&mut self, text: &str) {
        if self.tokens.peek().is_some_and(|t| t.text == text) {
            self.tokens.next();
        }
    }

    fn close(&mut self, owner: Token) -> Result<(), Diagnostic> {
        match self.tokens.entry(owner)? {
            None => Ok(()),
            Some(t) => Err(Diagnostic::error("too-many", format!("`{}` holds more than it takes", owner.text))
                .at(t.span, "expected `}`")
                .help("`Rotate { x y z degrees }`, `Matrix { 16 numbers }`")),
        }
    }

    fn group(&mut self, owner: Token, depth: usize) -> Result<Vec<Object>, Diagnostic> {
        let (mut objects, mut said) = (Vec::new(), None);
        self.tokens.open(owner)?;
        while let Some(word) = self.tokens.entry(owner)? {
            match word.text {
                "numObjects" => said = Some((word, self.tokens.count(word)?)),
                "MaterialIndex" => self.material_index(word)?,
                _ => match self.object(word, depth + 1)? {
                    Some(object) => objects.push(object),
                    None => {
                        return Err(unknown(owner, word, &[&OBJECTS[..], &["numObjects", "MaterialIndex"]].concat()));
                    }
                },
            }
        }
        check_count(said, objects.len(), "objects", owner)?;
        Ok(objects)
    }

    fn material_index(&mut self, word: Token) -> Result<(), Diagnostic> {
        let index = self.tokens.count(word)?;
        self.check_index(index)?;
        self.material = Some(index);
        Ok(())
    }

    fn object(&mut self, word: Token<'a>, depth: usize) -> Result<Option<Object>, Diagnostic> {
        if depth > DEEPEST {
            return Err(Diagnostic::error(
                "too-deep",
                format!("groups and transformations nest deeper than {DEEPEST}"),
            )
            .at(word.span, "too deep")
            .help("flatten the scene"));
        }
        let material = self.material;
        let (shape, material) = match word.text {
            "Group" => (Shape::Group(self.group(word, depth)?), None),
            "Transform" => (self.transform(word, depth)?, None),
            "Sphere" => (self.sphere(word)?, material),
            "Plane" => (self.plane(word)?, material),
            "Triangle" => (self.triangle(word)?, material),
            "TriangleMesh" => (self.mesh(word)?, material),
            _ => return Ok(None),
        };
        Ok(Some(Object { span: word.span, material, shape }))
    }

    fn transform(&mut self, owner: Token<'a>, depth: usize) -> Result<Shape, Diagnostic> {
        let (mut steps, mut object) = (Vec::new(), None);
        self.tokens.open(owner)?;
        while let Some(word) = self.tokens.entry(owner)? {
            if word.text == "MaterialIndex" {
                self.material_index(word)?;
            } else if let Some(step) = self.step(word)? {
                if object.is_some() {
                    return Err(Diagnostic::error(
                        "bad-order",
                        format!("`{}` stands after the object it should move", word.text),
                    )
                    .at(word.span, "too late")
                    .help("write all steps before the object"));
                }
                steps.push(step);
            } else if let Some(found) = self.object(word, depth + 1)? {
                if object.is_some() {
                    return Err(Diagnostic::error("too-many", "a `Transform` moves one object")
                        .at(word.span, "the second")
                        .help("put several objects into a `Group`"));
                }
                object = Some(Box::new(found));
            } else {
                return Err(unknown(owner, word, &[&STEPS[..], &OBJECTS[..], &["MaterialIndex"]].concat()));
            }
        }
        Ok(Shape::Transform(steps, object.ok_or_else(|| missing(owner, "an object"))?))
    }

    fn sphere(&mut self, owner: Token) -> Result<Shape, Diagnostic> {
        let (mut center, mut radius) = (None, None);
        self.tokens.open(owner)?;
        while let Some(word) = self.tokens.entry(owner)? {
            match word.text {
                "center" => center = Some(self.tokens.numbers(word)?),
                "radius" => radius = Some(self.tokens.number(word)?),
                _ => return Err(unknown(owner, word, &["center", "radius"])),
            }
        }
        let center = center.ok_or_else(|| missing(owner, "center"))?;
        Ok(Shape::Sphere(center, radius.ok_or_else(|| missing(owner, "radius"))?))
    }

    fn plane(&mut self, owner: Token) -> Result<Shape, Diagnostic> {
        let (mut normal, mut offset) = (None, None);
        self.tokens.open(owner)?;
        while let Some(word) = self.tokens.entry(owner)? {
            match word.text {
                "normal" => normal = Some(self.tokens.numbers(word)?),
                "offset" => offset = Some(self.tokens.number(word)?),
                _ => return Err(unknown(owner, word, &["normal", "offset"])),
            }
        }
        let normal = not_zero(normal.ok_or_else(|| missing(owner, "normal"))?, "normal")?;
        Ok(Shape::Plane(normal, offset.ok_or_else(|| missing(owner, "offset"))?))
    }

    fn triangle(&mut self, owner: Token) -> Result<Shape, Diagnostic> {
        const NAMES: [&str; 3] = ["vertex0", "vertex1", "vertex2"];
        let mut vertices = [None; 3];
        self.tokens.open(owner)?;
        while let Some(word) = self.tokens.entry(owner)? {
            let i = NAMES.iter().position(|&n| n == word.text).ok_or_else(|| unknown(owner, word, &NAMES))?;
            vertices[i] = Some(self.tokens.numbers(word)?);
        }
        let vertex = |i: usize| vertices[i].ok_or_else(|| missing(owner, NAMES[i]));
        Ok(Shape::Triangle([vertex(0)?, vertex(1)?, vertex(2)?]))
    }

    fn mesh(&mut self, owner: Token) -> Result<Shape, Diagnostic> {
        let mut file = None;
        self.tokens.open(owner)?;
        while let Some(word) = self.tokens.entry(owner)? {
            if word.text != "obj_file" {
                return Err(unknown(owner, word, &["obj_file"]));
            }
            let name = self.tokens.expect("a file", word)?;
            file = Some((name.text.to_string(), name.span));
        }
        Ok(Shape::Mesh(file.ok_or_else(|| missing(owner, "obj_file"))?))
    }
}

fn not_zero(v: At<[f64; 3]>, what: &str) -> Result<At<[f64; 3]>, Diagnostic> {
    if v.0 != [0.0; 3] {
        return Ok(v);
    }
    Err(Diagnostic::error("zero-vector", format!("the {what} is 0 0 0, which points nowhere"))
        .at(v.1, "has no length")
        .help("write a vector that is not zero"))
}
