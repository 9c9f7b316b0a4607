//! What a user can get wrong is an error, never a panic.

use crate::common::{Boxes, geometry, triangles, world};
use crate::solids;
use kirkas_accel::*;
use kirkas_geometry::{AnimatedTransform, Bounds3, DAffine3, DMat3, Vec3};
use std::sync::Arc;

fn error(scene: SceneGeometry) -> String {
    match Accel::build(AccelKind::Bvh2, scene, &Serial) {
        Ok(_) => "no error".into(),
        Err(e) => e.to_string(),
    }
}

#[test]
fn each_fault_is_named_with_its_place() {
    let bad_vertex = triangles(&[[Vec3::ZERO, Vec3::X, Vec3::new(0.0, f32::NAN, 0.0)]]);
    assert_eq!(error(world(vec![bad_vertex])), "vertex 2 of geometry 0 in the world is not a finite number");

    let lost = Shape::Triangles { positions: Arc::new(vec![Vec3::ZERO; 3]), indices: Arc::new(vec![[0, 1, 3]]) };
    let scene = SceneGeometry {
        aggregates: vec![Aggregate::default(), vec![geometry(lost)].into()],
        ..SceneGeometry::default()
    };
    assert_eq!(error(scene), "triangle 0 of geometry 0 in aggregate 1 uses vertex 3, but there are 3");

    for radius in [-1.0, f32::INFINITY] {
        let ball = Shape::Spheres(Arc::new(vec![Sphere { center: Vec3::ZERO, radius }]));
        assert!(error(world(vec![ball])).starts_with("sphere 0 of geometry 0"));
    }
    let texts = [
        (solids::disk(Vec3::X, Vec3::ZERO, 1.0), "disk 0 of geometry 0 in the world has a normal of length 0"),
        (solids::disk(Vec3::X, Vec3::Z, -1.0), "disk 0 of geometry 0 in the world has a negative radius"),
        (solids::disk(Vec3::X, Vec3::NAN, 1.0), "disk 0 of geometry 0 in the world is not a finite number"),
        (solids::cylinder(Vec3::X, Vec3::Z, -2.0), "cylinder 0 of geometry 0 in the world has a negative radius"),
        (
            solids::cylinder(Vec3::X, Vec3::INFINITY, 1.0),
            "cylinder 0 of geometry 0 in the world is not a finite number",
        ),
        (
            solids::curve(&[(Vec3::X, 1.0), (Vec3::Y, -1.0)]),
            "curve point 1 of geometry 0 in the world has a negative radius",
        ),
        (
            Shape::Curves { points: Arc::new(vec![]), segments: Arc::new(vec![u32::MAX]) },
            "curve segment 0 of geometry 0 in the world uses vertex 4294967295, but there are 0",
        ),
        (
            Shape::Quads { positions: Arc::new(vec![Vec3::X; 3]), indices: Arc::new(vec![[0, 1, 2, 3]]) },
            "quad 0 of geometry 0 in the world uses vertex 3, but there are 3",
        ),
        (
            Shape::MovingTriangles { keys: Arc::new(vec![vec![Vec3::X; 3], vec![]]), indices: Arc::default() },
            "geometry 0 in the world moves: it needs two or more keys with as many vertices each, and has [3, 0]",
        ),
    ];
    for (shape, text) in texts {
        assert_eq!(error(world(vec![shape])), text);
    }
    let boxes = Boxes(vec![Bounds3 { min: Vec3::ZERO, max: Vec3::NAN }]);
    assert!(error(world(vec![Shape::User(Arc::new(boxes))])).starts_with("user shape 0"));

    let place = |aggregate, m: DAffine3| SceneGeometry {
        aggregates: vec![Aggregate::default()],
        instances: vec![Instance { aggregate, outer_from_object: AnimatedTransform::still(m), mask: 1 }],
        ..SceneGeometry::default()
    };
    assert_eq!(error(place(3, DAffine3::IDENTITY)), "instance 0 places aggregate 3, but there are 1");
    let flat = DAffine3 { matrix3: DMat3::ZERO, ..DAffine3::IDENTITY };
    assert_eq!(error(place(0, flat)), "the transform of instance 0 cannot be inverted at time 0");
    let scene = SceneGeometry { shutter: (1.0, 0.0), ..SceneGeometry::default() };
    assert_eq!(error(scene), "the shutter cannot be open from 1 to 0");
}

/// As many users as primitives can be claimed without memory.
struct Endless;
impl UserShape for Endless {
    fn len(&self) -> usize {
        1 << 29
    }
    fn bounds(&self, _: u32) -> Bounds3 {
        Bounds3::EMPTY
    }
    fn intersect(&self, _: u32, _: &kirkas_geometry::Ray, _: &mut dyn FnMut(f32, f32, f32) -> bool) {}
}

#[test]
fn too_many_primitives_are_refused() {
    let text = error(world(vec![Shape::User(Arc::new(Endless))]));
    assert_eq!(text, "the world holds 536870912 primitives; the limit is 268435455");
}
