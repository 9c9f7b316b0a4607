//! The shapes under test: at least one case of every listed shape, the places to put them, and rays to send at them.

use kirkas_accel::{Accel, AccelKind, Counters, Geometry, Hit, HitFilter, Query, SceneGeometry, Serial};
use kirkas_geometry::hash::mix64;
use kirkas_geometry::transform::rotation;
use kirkas_geometry::{DAffine3, DMat3, DVec3, Ray, Vec2, Vec3};
use kirkas_render::shapes::{COMMON, Detail, Part, SHAPES, ShapeInput, SurfacePoint};
use kirkas_render::textures::Textures;
use kirkas_scene::{Assets, Catalog, Diagnostic, Entity, Kind, Map, MeshData, MeshPart, Node, Params, SourceId, Value};
use std::sync::{Arc, Mutex};

/// A shape with parameters.
pub struct Case {
    pub type_name: &'static str,
    pub params: Map,
    /// Crossed an even number of times by every line, facing outward.
    pub closed: bool,
    /// Without a transform, where known in closed form.
    pub area: Option<f64>,
}

/// Every listed shape with its defaults where those suffice, and with less usual parameters.
pub fn cases() -> Vec<Case> {
    use std::f64::consts::PI;
    let p = Map::default;
    let case =
        |type_name, params, closed, area: f64| Case { type_name, params, closed, area: (area > 0.0).then_some(area) };
    let slant = |h: f64, a: f64, b: f64| PI * (a + b) * (h * h + (a - b) * (a - b)).sqrt();
    let vertices =
        [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    let vertices = Value::List(vertices.iter().map(|v| Node::new(*v)).collect());
    let faces = [0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5];
    let faces = Value::List(faces.iter().map(|&i| Node::new(i64::from(i))).collect());
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.2, 0.0], [0.1, 1.3, 0.4]];
    let corners = Value::List(corners.iter().map(|v| Node::new(*v)).collect());
    vec![
        case("sphere", p(), true, 4.0 * PI),
        case("sphere", p().with("center", [0.3, -0.2, 0.5]).with("radius", 0.4), true, 4.0 * PI * 0.16),
        case("plane", p().with("point", [0.1, 0.2, 0.3]).with("normal", [0.2, 3.0, -0.4]), false, 0.0),
        case("disk", p(), false, PI),
        case(
            "disk",
            p().with("center", [0.3, 0.1, 0.0])
                .with("normal", [1.0, -1.0, 2.0])
                .with("radius", 0.7)
                .with("inner_radius", 0.3),
            false,
            PI * 0.4,
        ),
        case("rectangle", p(), false, 1.0),
        case("rectangle", p().with("edge_u", [1.0, 0.5, 0.0]).with("edge_v", [0.0, 0.4, 0.9]), false, 0.0),
        case("box", p(), true, 6.0),
        case("box", p().with("min", [-1.0, 0.0, -0.2]).with("max", [0.5, 0.7, 0.3]), true, 2.0 * (1.05 + 0.35 + 0.75)),
        case("cylinder", p(), true, 6.0 * PI),
        case(
            "cylinder",
            p().with("from", [0.1, 0.2, 0.3]).with("to", [0.9, -0.4, 1.2]).with("radius", 0.3).with("caps", false),
            false,
            0.6 * PI * (0.64_f64 + 0.36 + 0.81).sqrt(),
        ),
        case("cone", p(), true, slant(1.0, 1.0, 0.0) + PI),
        case(
            "cone",
            p().with("to", [0.0, 1.5, 0.0]).with("radius", 0.4).with("top_radius", 0.7),
            true,
            slant(1.5, 0.4, 0.7) + PI * 0.65,
        ),
        case(
            "cone",
            p().with("to", [0.5, 1.0, 0.5]).with("top_radius", 0.5).with("caps", false),
            false,
            slant(1.5_f64.sqrt(), 1.0, 0.5),
        ),
        case("torus", p(), true, PI * PI),
        case("torus", p().with("axis", [1.0, 1.0, 0.3]).with("minor_radius", 0.9), true, 4.0 * PI * PI * 0.9),
        case("torus", p().with("major_radius", 2.0).with("minor_radius", 0.02), true, 4.0 * PI * PI * 0.04),
        case("triangle", p().with("vertices", corners), false, 0.0),
        case("mesh", p().with("vertices", vertices.clone()).with("faces", faces.clone()), true, 0.0),
        case("mesh", p().with("vertices", vertices).with("faces", faces).with("normals", "smooth"), true, 0.0),
        case("mesh", p().with("file", "tetrahedron.ply"), true, 0.0),
        case("sphereflake", p().with("depth", 2_i64), false, 4.0 * PI * 3.0),
    ]
}

impl Case {
    /// What to call it in a failing test.
    pub fn label(&self) -> String {
        format!("{} {:?}", self.type_name, self.params.iter().map(|(n, _)| n.text.as_str()).collect::<Vec<_>>())
    }

    /// Builds it under a transform.
    pub fn build(&self, part_from_object: DAffine3) -> Result<Vec<Part>, Diagnostic> {
        build(&Entity::new("thing", self.type_name, self.params.clone()), part_from_object)
    }

    /// A center and a radius that hold it, or the interesting piece of it.
    pub fn ball(&self, m: &DAffine3) -> (DVec3, f64) {
        let bounds =
            self.build(*m).unwrap().iter().fold(kirkas_geometry::Bounds3::EMPTY, |b, p| b.union(p.surface.bounds()));
        if !bounds.is_finite() {
            return (m.translation, m.matrix3.determinant().abs().cbrt());
        }
        (bounds.center().as_dvec3(), 0.5 * bounds.extent().as_dvec3().length() * 1.0001)
    }
}

/// The catalogue of shapes alone.
pub fn catalog() -> Catalog {
    Catalog { types: SHAPES.iter().map(|s| s.spec).collect(), common: vec![(Kind::Object, COMMON)] }
}

/// Builds any entity.
pub fn build(entity: &Entity, part_from_object: DAffine3) -> Result<Vec<Part>, Diagnostic> {
    let shape = SHAPES.iter().find(|s| s.spec.name == entity.type_name.text).expect("listed");
    let params = Params::new(entity, Kind::Object, &catalog()).expect("in the catalogue");
    (shape.build)(&ShapeInput {
        params,
        assets: &Files,
        textures: &Textures::default(),
        source: None,
        part_from_object,
    })
}

/// A meshes' library of one: a tetrahedron of two materials, with texture coordinates and its own normals.
pub struct Files;

impl Assets for Files {
    fn mesh(&self, _from: Option<SourceId>, path: &str) -> Result<Arc<MeshData>, Diagnostic> {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        let part = |material: &str, first, count| MeshPart { material: material.into(), first, count };
        let data = MeshData {
            normals: positions.iter().map(|p| (*p - Vec3::splat(0.25)).normalize()).collect(),
            uvs: positions.iter().map(|p| Vec2::new(p.x, p.y + 0.5 * p.z)).collect(),
            positions,
            triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
            parts: vec![part("red", 0, 1), part("blue", 2, 2)],
            ..MeshData::default()
        };
        match path {
            "tetrahedron.ply" => Ok(Arc::new(data)),
            "empty.ply" => Ok(Arc::default()),
            _ => Err(Diagnostic::error("no-file", format!("no file `{path}`"))),
        }
    }

    fn bytes(&self, _from: Option<SourceId>, path: &str) -> Result<Arc<[u8]>, Diagnostic> {
        Err(Diagnostic::error("no-file", format!("no file `{path}`")))
    }
}

/// A map that turns, scales evenly and moves.
pub fn similarity(scale: f64, move_by: DVec3) -> DAffine3 {
    DAffine3 { matrix3: rotation(DVec3::new(1.0, -2.0, 0.5), 71.0) * scale, translation: move_by }
}

/// Nothing; a similarity; an uneven map; a mirror.
pub fn transforms() -> [(&'static str, DAffine3); 4] {
    let uneven = DMat3::from_diagonal(DVec3::new(1.5, 0.6, 0.9)) * rotation(DVec3::new(0.3, 1.0, 0.2), 40.0);
    let mirror = rotation(DVec3::Z, 25.0) * DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0));
    [
        ("identity", DAffine3::IDENTITY),
        ("similarity", similarity(1.7, DVec3::new(0.4, -3.0, 2.0))),
        ("uneven", DAffine3 { matrix3: uneven, translation: DVec3::new(0.2, 0.1, -0.7) }),
        ("mirror", DAffine3 { matrix3: mirror, translation: DVec3::new(1.0, 0.0, 0.0) }),
    ]
}

/// True where the case cannot be built under this transform, by its manual.
pub fn is_refused(case: &Case, transform: &str) -> bool {
    case.type_name == "sphereflake" && transform == "uneven"
}

/// A small generator.
pub struct Random(pub u64);

impl Random {
    pub fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        (mix64(self.0) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn pair(&mut self) -> (f32, f32) {
        ((self.number() as f32).min(1.0 - f32::EPSILON), (self.number() as f32).min(1.0 - f32::EPSILON))
    }

    pub fn direction(&mut self) -> DVec3 {
        let z = 1.0 - 2.0 * self.number();
        let (r, a) = ((1.0 - z * z).max(0.0).sqrt(), std::f64::consts::TAU * self.number());
        DVec3::new(r * a.cos(), r * a.sin(), z)
    }

    /// A point in a ball.
    pub fn within(&mut self, center: DVec3, radius: f64) -> DVec3 {
        let d = self.direction();
        center + d * (radius * self.number().cbrt())
    }

    /// A ray along a line that is uniform among those that meet a ball, from outside it.
    pub fn line(&mut self, center: DVec3, radius: f64) -> Ray {
        let d = self.direction();
        let (x, y) = d.any_orthonormal_pair();
        let (r, a) = (radius * self.number().sqrt(), std::f64::consts::TAU * self.number());
        let through = center + x * (r * a.cos()) + y * (r * a.sin());
        Ray::new((through - d * (2.0 * radius)).as_vec3(), d.as_vec3())
    }
}

/// Parts, ready to be hit.
pub struct Target {
    pub parts: Vec<Part>,
    accel: Accel,
}

impl Target {
    pub fn new(parts: Vec<Part>, kind: AccelKind) -> Self {
        let geometry = |p: &Part| Geometry { shape: p.shape.clone(), opaque: false, mask: u32::MAX };
        let scene = SceneGeometry { world: parts.iter().map(geometry).collect(), ..SceneGeometry::default() };
        let accel = Accel::build(kind, scene, &Serial).unwrap();
        Target { parts, accel }
    }

    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        self.accel.closest_hit(ray, Query::ALL, 0, &mut Counters::default())
    }

    /// Every crossing, nearest first.
    pub fn all(&self, ray: &Ray) -> Vec<Hit> {
        let found = Refuse(Mutex::default());
        self.accel.closest_hit(ray, Query::filtered(&found), 0, &mut Counters::default());
        let mut hits = found.0.into_inner().unwrap();
        hits.sort_by(|a, b| a.t.total_cmp(&b.t));
        hits
    }

    pub fn point(&self, hit: &Hit, ray: &Ray) -> SurfacePoint {
        self.parts[hit.geometry as usize].surface.point(hit.primitive, hit.u, hit.v, hit.t, ray, Detail::Texture)
    }
}

/// Notes every hit and takes none.
struct Refuse(Mutex<Vec<Hit>>);

impl HitFilter for Refuse {
    fn accept(&self, _ray_index: usize, _ray: &Ray, hit: &Hit) -> bool {
        self.0.lock().unwrap().push(*hit);
        false
    }
}
