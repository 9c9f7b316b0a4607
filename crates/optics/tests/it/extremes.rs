//! The ends of every parameter's range, and grey matter in both ways of carrying colour, for every listed model.

use crate::models::{Case, Colors, GREY, build, build_in, parameter_sets};
use kirkas_geometry::Vec3;
use kirkas_geometry::warp::square_to_uniform_sphere;
use kirkas_optics::{LobeSet, Mode, SPECS};
use kirkas_scene::{Map, Node, ParamType, Value};
use kirkas_testkit::Random;

/// What an unbounded row goes up to.
const MUCH: f64 = 1e6;

/// Values at the ends of a row's range, every word of a choice.
fn ends(ty: ParamType, range: (f64, f64)) -> Vec<Value> {
    let numbers = || vec![Value::Float(range.0.max(-MUCH)), Value::Float(range.1.min(MUCH))];
    match ty {
        ParamType::Number | ParamType::NumberTexture | ParamType::Color | ParamType::ColorTexture => numbers(),
        ParamType::Index => vec![Value::Float(range.0.max(0.01)), Value::Float(1.0), Value::Float(range.1.min(MUCH))],
        ParamType::VectorTexture => [[0.0; 3], [1.0; 3], [0.0, 1.0, 0.5], [1.0, 0.5, 0.5]].map(Value::from).into(),
        ParamType::Bool => vec![Value::from(false), Value::from(true)],
        ParamType::Choice(words) => words.iter().map(|word| Value::from(*word)).collect(),
        _ => Vec::new(),
    }
}

/// Normal, oblique, grazing, all but flat; above and below.
fn directions() -> Vec<Vec3> {
    let above = [
        Vec3::Z,
        Vec3::new(1e-4, 0.0, 1.0),
        Vec3::new(0.6, 0.0, 0.8),
        Vec3::new(-0.48, 0.64, 0.6),
        Vec3::new(0.0, -0.9999, 0.01),
        Vec3::new(1.0, 0.0, 1e-4),
        Vec3::new(-0.8, 0.6, 1e-7),
    ];
    above.into_iter().map(Vec3::normalize).flat_map(|v| [v, Vec3::new(v.x, v.y, -v.z)]).collect()
}

fn is_sane(case: &Case) {
    let all = LobeSet::ALL;
    for wo in directions() {
        for wi in directions() {
            let (f, pdf) = (case.bsdf.eval(wo, wi, all, Mode::Radiance), case.bsdf.pdf(wo, wi, all, Mode::Radiance));
            assert!(f.0.iter().all(|x| *x >= 0.0) && pdf >= 0.0, "{}: {wo} {wi}: {f:?} {pdf}", case.label);
        }
        let mut random = Random::new(3);
        for _ in 0..40 {
            let Some(s) = case.bsdf.sample(wo, random.number(), random.pair(), all, Mode::Radiance) else { continue };
            let is_sane = s.wi.is_finite() && s.pdf > 0.0 && s.pdf.is_finite() && s.weight().is_finite();
            assert!(is_sane && s.f.0.iter().all(|x| *x >= 0.0), "{}: {wo}: {s:?}", case.label);
        }
    }
}

#[test]
fn the_ends_of_every_range_give_no_nan_from_any_side() {
    for spec in SPECS {
        for (params, outside) in parameter_sets(spec.name) {
            for row in spec.params {
                for value in ends(row.ty, row.range) {
                    let with = params.clone().with(row.name, value);
                    is_sane(&build(spec.name, &with, outside));
                }
            }
        }
        // All roughs and all colours at their ends together.
        for end in [0, 1] {
            let all = spec.params.iter().fold(parameter_sets(spec.name)[0].0.clone(), |map, row| match row.ty {
                ParamType::NumberTexture | ParamType::ColorTexture => {
                    map.with(row.name, ends(row.ty, row.range)[end].clone())
                }
                _ => map,
            });
            is_sane(&build(spec.name, &all, 1.0));
        }
    }
}

/// The set with its first channel for all; `None` where what it says depends on the wavelength by itself.
pub fn grey(params: &Map) -> Option<Map> {
    let mut out = Map::default();
    let grey_part = |name: &str| Value::from(format!("{GREY}{name}").as_str());
    let is_part = |name: &str| ["material", "first", "second", "front", "back"].contains(&name);
    for (name, node) in params.iter() {
        let is_colour = node.list().is_some_and(|l| l.len() == 3 && node.numbers::<3>().is_some());
        let value = match &node.value {
            Value::Map(_) => return None,
            _ if name.text == "film_thickness" => return None,
            Value::Text(file) if name.text == "file" && !file.starts_with("grey") => return None,
            Value::Text(part) if is_part(&name.text) => grey_part(part),
            Value::List(list) if name.text == "materials" => {
                Value::List(list.iter().map(|n| Node::new(grey_part(n.text().unwrap_or_default()))).collect())
            }
            Value::List(_) if name.text == "normals" || name.text == "weights" => node.value.clone(),
            Value::List(list) if is_colour => list[0].value.clone(),
            // Seven numbers to a lobe, the last three its colour.
            Value::List(list) if name.text == "lobes" => {
                let place = |i: usize| if i % 7 > 4 { i - (i % 7 - 4) } else { i };
                Value::List((0..list.len()).map(|i| list[place(i)].clone()).collect())
            }
            other => other.clone(),
        };
        out = out.with(&name.text, Node::new(value).value);
    }
    Some(out)
}

#[test]
fn grey_matter_is_the_same_in_rgb_and_by_wavelength() {
    for spec in SPECS {
        let mut tried = 0;
        for (params, outside) in parameter_sets(spec.name) {
            let Some(params) = grey(&params) else { continue };
            tried += 1;
            let rgb = build(spec.name, &params, outside);
            let waves = build_in(Colors::Spectral(0.37), spec.name, &params, outside);
            let mut random = Random::new(11);
            for _ in 0..300 {
                let (a, b) = (square_to_uniform_sphere(random.pair()), square_to_uniform_sphere(random.pair()));
                for mode in [Mode::Radiance, Mode::Importance] {
                    let (f, g) = (rgb.bsdf.eval(a, b, LobeSet::ALL, mode), waves.bsdf.eval(a, b, LobeSet::ALL, mode));
                    let same = g.0.iter().all(|x| (x - f[0]).abs() <= 1e-5 * f[0]);
                    assert!(same, "{}: {a} {b}: {f:?} {g:?}", rgb.label);
                    let (p, q) = (rgb.bsdf.pdf(a, b, LobeSet::ALL, mode), waves.bsdf.pdf(a, b, LobeSet::ALL, mode));
                    assert!((p - q).abs() <= 1e-5 * p, "{}: {a} {b}: {p} {q}", rgb.label);
                }
            }
        }
        assert!(tried > 0, "`{}` has no set without dispersion", spec.name);
    }
}
