//! MTL materials as native entities. The manual in `mod.rs` has the table.

use super::mtl::{Map as Image, Material};
use kirkas_scene::{Diagnostic, Entity, Map, Value};

/// The entity of `material`; images it needs are added to `textures`. `folder` leads from the OBJ to the MTL.
pub(super) fn to_native(
    material: &Material,
    folder: &str,
    textures: &mut Vec<Entity>,
    warnings: &mut Vec<Diagnostic>,
) -> Entity {
    let m = material;
    let mut texture = |image: &Image, role: &str, linear: bool| -> Value {
        let params = image_params(image, folder, linear);
        if let Some(same) = textures.iter().find(|t| t.params == params) {
            return Value::Text(same.name.text.clone());
        }
        let name = format!("{}_{role}", m.name);
        textures.push(Entity::new(&name, "image", params));
        Value::Text(name)
    };
    let diffuse: Option<Value> = match (&m.map_kd, m.kd) {
        (Some(image), kd) => {
            if kd.is_some_and(|c| c != [1.0; 3] && c != [0.0; 3] && c != [0.8; 3]) {
                warnings.push(
                    Diagnostic::warning("ignored", format!("`Kd` of material `{}` does not tint its `map_Kd`", m.name))
                        .help("the image alone is used"),
                );
            }
            Some(texture(image, "map_Kd", false))
        }
        (None, kd) => kd.map(Value::from),
    };
    let emits = lit(m.ke) || m.map_ke.is_some();
    let alpha = match (&m.map_d, m.d) {
        (Some(image), _) => Some(texture(image, "map_d", true)),
        (None, Some(d)) if d < 1.0 && !lets_through(m) => Some(Value::Float(d)),
        _ => None,
    };
    let black = m.map_kd.is_none() && !lit(m.kd);
    let specular = m.ks.unwrap_or([0.0; 3]);
    let with = |map: Map, name: &str, value: &Option<Value>| match value {
        Some(v) => map.with(name, v.clone()),
        None => map,
    };
    let highlights = |map: Map| {
        let map = with(map, "diffuse", &diffuse).with("form", "classic").with("specular", specular);
        with(map, "exponent", &m.ns.map(Value::Float))
    };

    let (type_name, params) = match m.illum {
        _ if emits => {
            let radiance = match &m.map_ke {
                Some(image) => texture(image, "map_Ke", false),
                None => m.ke.unwrap_or_default().into(),
            };
            if lit(m.ks) || lets_through(m) {
                let message =
                    format!("`Ks`, `Tf`, `Ni` and `illum` of material `{}`, which shines, are passed over", m.name);
                warnings.push(
                    Diagnostic::warning("ignored", message).help("a lamp reflects diffusely, by `Kd` or `map_Kd`"),
                );
            }
            let map = Map::default().with("radiance", radiance);
            ("emitter", if black { map } else { with(map, "reflectance", &diffuse) })
        }
        Some(i @ (4 | 6 | 7 | 9)) if lets_through(m) => {
            let transmit = m.tf.unwrap_or(if black { [1.0; 3] } else { [1.0 - m.d.unwrap_or(0.0); 3] });
            let ior = m.ni.unwrap_or(1.5);
            if black {
                ("dielectric", Map::default().with("ior", ior).with("transmittance", transmit))
            } else {
                let fresnel = if i == 7 { "exact" } else { "constant" };
                let map = highlights(Map::default()).with("transmit", transmit).with("ior", ior);
                let map = if i == 9 { map } else { map.with("reflect", specular) };
                ("blinn_phong", map.with("fresnel", fresnel))
            }
        }
        Some(i @ (3 | 5)) if lit(m.ks) => {
            let fresnel = if i == 5 { "schlick" } else { "constant" };
            if black {
                ("mirror", Map::default().with("reflectance", specular).with("fresnel", fresnel))
            } else {
                ("blinn_phong", highlights(Map::default()).with("reflect", specular).with("fresnel", fresnel))
            }
        }
        Some(0 | 1) => ("lambert", with(Map::default(), "reflectance", &diffuse)),
        _ if lit(m.ks) => ("blinn_phong", highlights(Map::default())),
        _ => ("lambert", with(Map::default(), "reflectance", &diffuse)),
    };
    Entity::new(&m.name, type_name, with(params, "alpha", &alpha))
}

fn lit(color: Option<[f64; 3]>) -> bool {
    color.is_some_and(|c| c.iter().any(|&v| v > 0.0))
}

/// True if `illum` promises refraction and something says that light passes.
fn lets_through(m: &Material) -> bool {
    let said = m.d.is_some_and(|d| d < 1.0) || lit(m.tf) || m.ni.is_some_and(|n| n != 1.0);
    matches!(m.illum, Some(4 | 6 | 7 | 9)) && said
}

fn image_params(image: &Image, folder: &str, linear: bool) -> Map {
    let mut map = Map::default().with("file", format!("{folder}{}", image.file));
    if image.scale != [1.0; 2] {
        map = map.with("scale", image.scale);
    }
    if image.offset != [0.0; 2] {
        map = map.with("offset", image.offset);
    }
    if image.clamp {
        map = map.with("wrap", "clamp");
    }
    if linear {
        map = map.with("encoding", "linear");
    }
    map
}
