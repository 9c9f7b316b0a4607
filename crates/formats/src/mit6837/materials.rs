//! Materials: Phong surfaces, and patterns of two of them as one surface with textures.

use super::scene::*;
use kirkas_scene::{Description, Diagnostic, Entity, Kind, Map, Name, Node, Span, Value};

/// What one material comes to. Each value is a colour, a number, or the name of a texture.
#[derive(Clone)]
struct Look {
    model: &'static str,
    diffuse: Node,
    specular: Node,
    reflect: Node,
    transmit: Node,
    exponent: Node,
    ior: Node,
}

/// Add all materials of `scene`, as `material_0`, `material_1`, ...
pub(super) fn emit(scene: &Scene, d: &mut Description, warnings: &mut Vec<Diagnostic>) -> Result<(), Diagnostic> {
    let mut looks: Vec<Look> = Vec::with_capacity(scene.materials.len());
    for (i, (material, span)) in scene.materials.iter().enumerate() {
        let look = match material {
            Material::Surface(s) => surface(s, i, scene.is_2012, d),
            Material::Pattern(p) => {
                let [a, b] = p.materials.map(|(index, _)| looks[index].clone());
                mix(p, i, *span, a, b, d, warnings)?
            }
        };
        d.all_mut(Kind::Material).push(entity(i, *span, &look));
        looks.push(look);
    }
    Ok(())
}

fn color(value: Option<At<[f64; 3]>>, default: f64) -> Node {
    value.map_or_else(|| Node::new([default; 3]), |(c, span)| Node::spanned(c, span))
}

fn number(value: Option<At<f64>>, default: f64) -> Node {
    value.map_or_else(|| Node::new(default), |(v, span)| Node::spanned(v, span))
}

fn add_texture(d: &mut Description, name: String, type_name: &str, params: Map, span: Span) -> Node {
    d.all_mut(Kind::Texture).push(Entity { span, ..Entity::new(&name, type_name, params) });
    Node::spanned(name, span)
}

fn surface(s: &Surface, i: usize, is_2012: bool, d: &mut Description) -> Look {
    let mut diffuse = color(s.diffuse, 1.0);
    if let Some(noise) = &s.noise {
        let [a, b] = noise.colors;
        let params = Map::default().with("space", "world");
        let mut params = turbulence(params, &noise.turbulence, true);
        params.set(Name::new("a"), Node::spanned(a.0, a.1));
        params.set(Name::new("b"), Node::spanned(b.0, b.1));
        diffuse = add_texture(d, format!("material_{i}_noise"), "marble", params, a.1);
    }
    if let Some((file, span)) = &s.texture {
        // The course's pictures are shaded as they are stored, without a transfer curve.
        let mut params = Map::default().with("encoding", "linear");
        params.set(Name::new("file"), Node::spanned(file.as_str(), *span));
        diffuse = add_texture(d, format!("material_{i}_image"), "image", params, *span);
    }
    let is_phong = if s.exponent.is_some() { s.has_shininess } else { is_2012 };
    Look {
        model: if is_phong { "phong" } else { "blinn_phong" },
        diffuse,
        specular: color(s.specular, 0.0),
        reflect: color(s.reflective, 0.0),
        transmit: color(s.transparent, 0.0),
        exponent: number(s.exponent, 1.0),
        ior: number(s.ior, 1.0),
    }
}

fn turbulence(mut map: Map, t: &Turbulence, waves: bool) -> Map {
    if let Some((octaves, span)) = t.octaves {
        map.set(Name::new("octaves"), Node::spanned(octaves as i64, span));
    }
    if waves {
        map.set(Name::new("frequency"), number(t.frequency, 1.0));
        map.set(Name::new("amplitude"), number(t.amplitude, 1.0));
    }
    map
}

/// One material whose values are textures wherever the two differ.
fn mix(
    p: &Pattern,
    i: usize,
    span: Span,
    a: Look,
    b: Look,
    d: &mut Description,
    warnings: &mut Vec<Diagnostic>,
) -> Result<Look, Diagnostic> {
    // The course's transformation takes world to texture space; the native one places the texture, so it is the inverse:
    // the inverse steps in written order.
    let steps = p
        .steps
        .iter()
        .map(|s| s.inverse().map(|s| s.native()))
        .collect::<Option<Vec<Node>>>()
        .ok_or_else(|| singular(p))?;
    let mut params = Map::default().with("space", "world");
    if p.texture == "checker" {
        params = params.with("mapping", "solid");
    }
    if !steps.is_empty() {
        params = params.with("transform", steps);
    }
    let params = turbulence(params, &p.turbulence, p.texture == "marble" || p.texture == "wood");
    let mut pick = |a: Node, b: Node, name: &str| {
        if a.value == b.value {
            return a;
        }
        let mut params = params.clone();
        params.set(Name::new("a"), a);
        params.set(Name::new("b"), b);
        add_texture(d, format!("material_{i}_{name}"), p.texture, params, span)
    };
    let mixed = Look {
        model: a.model,
        diffuse: pick(a.diffuse, b.diffuse, "diffuse"),
        specular: pick(a.specular.clone(), b.specular.clone(), "specular"),
        reflect: pick(a.reflect, b.reflect, "reflect"),
        transmit: pick(a.transmit.clone(), b.transmit.clone(), "transmit"),
        // A surface without highlights has no exponent worth mixing.
        exponent: match (is_black(&a.specular), is_black(&b.specular)) {
            (true, _) => b.exponent,
            (_, true) => a.exponent,
            _ => pick(a.exponent, b.exponent, "exponent"),
        },
        ior: if is_black(&a.transmit) { b.ior.clone() } else { a.ior.clone() },
    };
    let both_clear = !is_black(&a.transmit) && !is_black(&b.transmit);
    if both_clear && a.ior.value != b.ior.value {
        warnings.push(
            Diagnostic::warning("approximated", "the two materials of a pattern differ in their refractive index")
                .at(span, "one index holds for both")
                .help("the first material's index is used"),
        );
    }
    if a.model != b.model {
        warnings.push(
            Diagnostic::warning("approximated", "one material of a pattern has an `exponent`, the other `shininess`")
                .at(span, "one model holds for both")
                .help("the first material's model is used"),
        );
    }
    Ok(mixed)
}

fn singular(p: &Pattern) -> Diagnostic {
    let place = p.steps.iter().find(|s| s.inverse().is_none()).map_or(Span::NONE, |s| s.span);
    Diagnostic::error("singular-transform", "this transformation squashes the pattern flat and cannot be undone")
        .at(place, "no inverse")
        .help("make every scale different from 0")
}

fn is_black(color: &Node) -> bool {
    color.value == Value::from([0.0; 3])
}

fn entity(i: usize, span: Span, look: &Look) -> Entity {
    let mut params = Map::default().with("form", "classic");
    let mut set = |name: &str, node: &Node| params.set(Name::new(name), node.clone());
    set("diffuse", &look.diffuse);
    if !is_black(&look.specular) {
        set("specular", &look.specular);
        set("exponent", &look.exponent);
    }
    let (mirrors, clear) = (!is_black(&look.reflect), !is_black(&look.transmit));
    if mirrors {
        set("reflect", &look.reflect);
    }
    if clear {
        set("transmit", &look.transmit);
        set("ior", &look.ior);
    }
    if mirrors || clear {
        set("fresnel", &Node::new("constant"));
    }
    let mut entity = Entity { span, ..Entity::new(&format!("material_{i}"), look.model, params) };
    entity.name.span = span;
    entity.type_name.span = span;
    entity
}
