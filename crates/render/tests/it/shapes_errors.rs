//! What cannot be built says why, where and what to do.

use crate::shapes_cases::{build, catalog};
use kirkas_geometry::DAffine3;
use kirkas_scene::validate::validate;
use kirkas_scene::{Description, Entity, Kind, Map, Node, SourceId, Span, Value};

fn check(type_name: &str, mut params: Map, expected: &str) {
    let name = "thing";
    for (i, (_, node)) in params.0.iter_mut().enumerate() {
        node.span = Span::new(SourceId(0), 10 * i, 10 * i + 5);
    }
    let mut entity = Entity::new(name, type_name, params);
    entity.name.span = Span::new(SourceId(0), 100, 105);
    let Err(found) = build(&entity, DAffine3::IDENTITY) else { panic!("{type_name} was built") };
    assert_eq!(found.message, expected);
    assert!(found.help.is_some(), "no cure: {expected}");
    assert!(!found.labels.is_empty(), "no place: {expected}");
}

fn list(numbers: &[f64]) -> Value {
    Value::List(numbers.iter().map(|x| Node::new(*x)).collect())
}

fn points(points: &[[f64; 3]]) -> Value {
    Value::List(points.iter().map(|p| Node::new(*p)).collect())
}

#[test]
fn degenerate_parameters_are_explained() {
    let p = Map::default;
    check("cylinder", p().with("to", [0.0, -1.0, 0.0]), "cylinder `thing`: `from` and `to` are the same point");
    check("plane", p().with("normal", [0.0; 3]), "plane `thing`: `normal` is the zero vector");
    check("torus", p().with("axis", [0.0; 3]), "torus `thing`: `axis` is the zero vector");
    check("torus", p().with("minor_radius", 2.0), "torus `thing`: the tube would cut through itself");
    check("disk", p().with("inner_radius", 1.0), "disk `thing`: the hole is as large as the disk");
    check("rectangle", p().with("edge_u", [0.0; 3]), "rectangle `thing`: `edge_u` is zero");
    check("rectangle", p().with("edge_v", [2.0, 0.0, 0.0]), "rectangle `thing`: `edge_u` and `edge_v` are parallel");
    check("box", p().with("max", [1.0, -0.5, 1.0]), "box `thing`: `max` is not above `min` in y");
    check("triangle", p().with("vertices", points(&[[0.0; 3]])), "triangle `thing`: it has 1 of three vertices");
    let line = points(&[[0.0; 3], [1.0; 3], [2.0; 3]]);
    check("triangle", p().with("vertices", line), "triangle `thing`: its vertices lie on one line");
    check(
        "sphere",
        p().with("radius", 1e-60),
        "sphere `thing`: its radius or place, 0 at [0, 0, 0], is beyond what f32 holds",
    );
}

#[test]
fn broken_meshes_are_explained() {
    let p = || Map::default().with("vertices", points(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]));
    check("mesh", Map::default(), "mesh `thing`: it has neither a file nor vertices");
    check("mesh", p().with("file", "a.ply"), "mesh `thing`: it has both a file and vertices");
    check("mesh", p(), "mesh `thing`: `faces` has 0 numbers");
    check("mesh", p().with("faces", list(&[0.0, 1.0])), "mesh `thing`: `faces` has 2 numbers");
    check("mesh", p().with("faces", list(&[0.0, 1.0, 3.0])), "mesh `thing`: `faces` names vertex 3, but there are 3");
    check("mesh", p().with("faces", list(&[0.0, 1.0, 0.5])), "mesh `thing`: `faces` names vertex 0.5, but there are 3");
    let faces = || p().with("faces", list(&[0.0, 1.0, 2.0]));
    check("mesh", faces().with("uvs", list(&[0.0])), "mesh `thing`: `uvs` has 1 numbers for 3 vertices");
    check("mesh", Map::default().with("file", "empty.ply"), "mesh `thing`: it has no triangles");
}

#[test]
fn ranges_are_caught_by_validation() {
    let bad = [
        ("sphere", "radius", Node::new(0.0)),
        ("sphere", "radius", Node::new(-1.0)),
        ("disk", "inner_radius", Node::new(-0.1)),
        ("cylinder", "radius", Node::new(0.0)),
        ("cone", "top_radius", Node::new(-1.0)),
        ("torus", "major_radius", Node::new(0.0)),
        ("sphereflake", "depth", Node::new(8_i64)),
        ("sphereflake", "ratio", Node::new(0.0)),
    ];
    for (type_name, name, node) in bad {
        let mut d = Description::default();
        let mut params = Map::default();
        params.set(kirkas_scene::Name::new(name), node);
        d.add(Kind::Object, Entity::new("thing", type_name, params)).unwrap();
        let found = validate(&d, &catalog());
        assert_eq!(found.len(), 1, "{type_name} {name}: {found:?}");
        assert_eq!(found[0].code, "out-of-range");
    }
}
