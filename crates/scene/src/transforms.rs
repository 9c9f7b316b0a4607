//! Transforms as written: lists of steps, applied in the order in which they stand.

use crate::diagnostic::unknown_name;
use crate::{Diagnostic, Node, Value};
use kirkas_geometry::transform::{is_invertible, look_at, rotation};
use kirkas_geometry::{AnimatedTransform, DAffine3, DMat3, DVec3};

/// The steps that exist.
pub const STEPS: [&str; 5] = ["translate", "rotate", "scale", "look_at", "matrix"];

/// Read a list of steps.
pub fn read_transform(node: &Node) -> Result<DAffine3, Diagnostic> {
    let steps = match &node.value {
        Value::List(steps) => steps.as_slice(),
        Value::Map(_) => std::slice::from_ref(node),
        other => {
            return Err(Diagnostic::error(
                "bad-transform",
                format!("a transform is a list of steps, not {}", other.article()),
            )
            .at(node.span, "here")
            .help("write `[{ scale = 2 }, { translate = [1, 0, 0] }]`"));
        }
    };
    let mut total = DAffine3::IDENTITY;
    for step in steps {
        total = read_step(step)? * total;
    }
    if !is_invertible(&total) {
        return Err(Diagnostic::error("singular-transform", "this transform squashes space flat and cannot be undone")
            .at(node.span, "no inverse")
            .help("make every scale different from 0 and every number finite"));
    }
    Ok(total)
}

/// Read key frames.
pub fn read_motion(node: &Node) -> Result<AnimatedTransform, Diagnostic> {
    let wrong = |span| {
        Diagnostic::error("bad-motion", "motion is a list of key frames with rising times")
            .at(span, "here")
            .help("write `[{ time = 0, transform = [...] }, { time = 1, transform = [...] }]`")
    };
    let mut keys = Vec::new();
    for key in node.list().ok_or_else(|| wrong(node.span))? {
        let map = key.map().ok_or_else(|| wrong(key.span))?;
        if let Some((name, _)) = map.iter().find(|(n, _)| n.text != "time" && n.text != "transform") {
            return Err(unknown_name("key frame entry", &name.text, name.span, ["time", "transform"]));
        }
        let time = map.get("time").and_then(Node::number).ok_or_else(|| wrong(key.span))?;
        let transform = map.get("transform").map_or(Ok(DAffine3::IDENTITY), read_transform)?;
        keys.push((time, transform));
    }
    AnimatedTransform::from_keys(&keys).ok_or_else(|| wrong(node.span))
}

fn read_step(step: &Node) -> Result<DAffine3, Diagnostic> {
    let wrong = |what: &str, span| {
        Diagnostic::error("bad-transform", format!("a transform step takes {what}"))
            .at(span, "here")
            .help("steps: { translate = [x, y, z] }, { rotate = [ax, ay, az, degrees] }, { scale = s or [x, y, z] }, { look_at = { from, to, up } }, { matrix = 12 or 16 numbers by rows }")
    };
    let map = step.map().filter(|m| m.0.len() == 1).ok_or_else(|| wrong("exactly one entry", step.span))?;
    let (name, value) = &map.0[0];
    let at = value.span;
    match name.text.as_str() {
        "translate" => {
            let v = value.numbers::<3>().ok_or_else(|| wrong("three numbers to translate", at))?;
            Ok(DAffine3::from_translation(DVec3::from_array(v)))
        }
        "rotate" => {
            let [x, y, z, degrees] = value.numbers::<4>().ok_or_else(|| wrong("an axis and degrees to rotate", at))?;
            let axis = DVec3::new(x, y, z);
            if !(axis.length() > 0.0) || !axis.is_finite() || !degrees.is_finite() {
                return Err(wrong("an axis that is not zero", at));
            }
            Ok(DAffine3::from_mat3(rotation(axis, degrees)))
        }
        "scale" => {
            let v = match value.number() {
                Some(s) => [s; 3],
                None => value.numbers::<3>().ok_or_else(|| wrong("one or three numbers to scale", at))?,
            };
            Ok(DAffine3::from_mat3(DMat3::from_diagonal(DVec3::from_array(v))))
        }
        "look_at" => {
            let m = value.map().ok_or_else(|| wrong("`from`, `to` and `up`", at))?;
            let part = |n: &str| m.get(n).and_then(Node::numbers::<3>).map(DVec3::from_array);
            let (from, to) = part("from").zip(part("to")).ok_or_else(|| wrong("`from` and `to` in look_at", at))?;
            look_at(from, to, part("up").unwrap_or(DVec3::Y)).ok_or_else(|| wrong("different `from` and `to`", at))
        }
        "matrix" => {
            let rows: [f64; 12] = match value.numbers::<16>() {
                Some(m) if m[12..] == [0.0, 0.0, 0.0, 1.0] => std::array::from_fn(|i| m[i]),
                Some(_) => return Err(wrong("a matrix whose last row is 0 0 0 1", at)),
                None => value.numbers::<12>().ok_or_else(|| wrong("12 or 16 numbers in a matrix", at))?,
            };
            let col = |c: usize| DVec3::new(rows[c], rows[4 + c], rows[8 + c]);
            Ok(DAffine3 { matrix3: DMat3::from_cols(col(0), col(1), col(2)), translation: col(3) })
        }
        other => Err(unknown_name("transform step", other, name.span, STEPS)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Map;

    fn step(name: &str, value: impl Into<Value>) -> Node {
        Node::new(Map::default().with(name, value))
    }

    #[test]
    fn steps_apply_in_written_order() {
        let list = Node::new(vec![
            step("scale", 2.0),
            step("translate", [1.0, 0.0, 0.0]),
            step("rotate", [0.0, 0.0, 1.0, 90.0]),
        ]);
        let m = read_transform(&list).unwrap();
        assert_eq!(m.transform_point3(DVec3::X), DVec3::new(0.0, 3.0, 0.0));
    }

    #[test]
    fn a_flat_scale_is_refused() {
        assert!(read_transform(&step("scale", [1.0, 0.0, 1.0])).is_err());
        assert!(read_transform(&step("scael", 2.0)).unwrap_err().message.contains("did you mean `scale`"));
    }
}
