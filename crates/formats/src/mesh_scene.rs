//! A scene around a bare mesh: seen from a three-quarter view, on a round floor, under two large soft lamps.
//!
//! Everything is measured in the radius of the mesh's bounding box, so that a mesh in metres and one in microns look the same.

use crate::Failure;
use crate::assets::MeshCache;
use kirkas_geometry::elementary::tan;
use kirkas_geometry::{Bounds3, DVec3, Vec3};
use kirkas_scene::files::FileAccess;
use kirkas_scene::{Description, Diagnostic, Entity, Kind, Map, MeshData, Node, SourceId, Span, Value};

/// Vertical field of view, in degrees.
const FOV: f64 = 30.0;
/// Width over height of the picture.
const ASPECT: f64 = 4.0 / 3.0;
/// How much of the picture's half width and half height the mesh may take.
const FILL: f64 = 0.82;
/// From the mesh to the eye: from the front right, a little from above.
const TO_EYE: DVec3 = DVec3::new(0.55, 0.38, 1.0);
/// A round lamp that looks at the mesh; lengths in radii of the mesh.
struct Lamp {
    name: &'static str,
    /// From the mesh to the lamp.
    towards: DVec3,
    distance: f64,
    radius: f64,
    color: [f64; 3],
    /// How bright a white surface at the mesh looks that faces the lamp.
    brightness: f64,
}

/// One from the left, from above, from the front; a weak wide one from the other side.
const LAMPS: [Lamp; 2] = [
    Lamp {
        name: "key",
        towards: DVec3::new(-0.75, 1.15, 0.8),
        distance: 7.0,
        radius: 1.4,
        color: [1.0, 0.96, 0.9],
        brightness: 0.9,
    },
    Lamp {
        name: "fill",
        towards: DVec3::new(1.0, 0.55, 0.5),
        distance: 9.0,
        radius: 3.5,
        color: [0.8, 0.9, 1.0],
        brightness: 0.2,
    },
];

/// Read the mesh `path` and describe a scene around it.
pub fn mesh_scene(files: &FileAccess, path: &str, meshes: &MeshCache) -> Result<Description, Failure> {
    let mesh = meshes.read(files, "", path)?;
    let mut scene = Description::default();
    let source = scene.sources.add(path, "");
    describe(&mut scene, path, source, &mesh)?;
    Ok(scene)
}

fn describe(scene: &mut Description, path: &str, source: SourceId, mesh: &MeshData) -> Result<(), Diagnostic> {
    // Measure.
    let bounds =
        Bounds3::around(mesh.triangles.iter().flatten().filter_map(|&i| mesh.positions.get(i as usize)).copied());
    let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let (center, radius) = ((low + high) / 2.0, (high - low).length() / 2.0);
    if mesh.triangles.is_empty() || !(radius > 0.0) || !radius.is_finite() {
        return Err(Diagnostic::error("empty-mesh", format!("`{path}` holds nothing that can be seen"))
            .help("a mesh needs at least one triangle that is not a point"));
    }

    // Look.
    let to_eye = TO_EYE.normalize();
    let distance = fitting_distance(mesh, center, to_eye).max(radius * 0.5);
    scene.add(Kind::Film, Entity::new("", "image", Map::default().with("width", 640_i64).with("height", 480_i64)))?;
    let camera = Map::default()
        .with("position", (center + to_eye * distance).to_array())
        .with("look_at", center.to_array())
        .with("fov", FOV);
    scene.add(Kind::Camera, Entity::new("camera", "perspective", camera))?;

    // Light: two lamps with soft shadows, and a little from the sky.
    scene.add(Kind::Background, Entity::new("", "gradient", Map::default().with("stops", background())))?;

    // Put the mesh on a floor that it does not quite touch.
    let floor = Map::default()
        .with("center", [center.x, low.y - 1e-3 * radius, center.z])
        .with("normal", [0.0, 1.0, 0.0])
        .with("radius", 40.0 * radius)
        .with("material", "floor");
    let mut thing = Map::default();
    let name = path.rsplit('/').next().unwrap_or(path);
    thing.set(kirkas_scene::Name::new("file"), Node::spanned(name, Span::new(source, 0, 0)));
    scene.add(Kind::Material, Entity::new("floor", "lambert", Map::default().with("reflectance", 0.42)))?;
    if mesh.materials.is_empty() {
        thing = thing.with("material", "clay");
        scene.add(Kind::Material, Entity::new("clay", "lambert", Map::default().with("reflectance", 0.6)))?;
    }
    scene.add(Kind::Object, Entity::new("mesh", "mesh", thing))?;
    scene.add(Kind::Object, Entity::new("floor", "disk", floor))?;
    LAMPS.iter().try_for_each(|lamp| add_lamp(scene, lamp, center, radius))
}

fn add_lamp(scene: &mut Description, lamp: &Lamp, center: DVec3, unit: f64) -> Result<(), Diagnostic> {
    let towards = lamp.towards.normalize();
    // A disk of radiance L and radius r that faces a white surface from far away makes it look L (r / distance)^2 bright.
    let intensity = lamp.brightness * (lamp.distance / lamp.radius) * (lamp.distance / lamp.radius);
    let emitter = Map::default().with("radiance", lamp.color).with("intensity", intensity).with("samples", 8_i64);
    let disk = Map::default()
        .with("center", (center + towards * (lamp.distance * unit)).to_array())
        .with("normal", (-towards).to_array())
        .with("radius", lamp.radius * unit)
        .with("material", lamp.name);
    scene.add(Kind::Material, Entity::new(lamp.name, "emitter", emitter))?;
    scene.add(Kind::Object, Entity::new(lamp.name, "disk", disk))
}

/// How far away the eye must be for every vertex to lie inside the picture.
fn fitting_distance(mesh: &MeshData, center: DVec3, to_eye: DVec3) -> f64 {
    let right = DVec3::Y.cross(to_eye).normalize();
    let up = to_eye.cross(right);
    let slope_y = tan((FOV / 2.0).to_radians()) * FILL;
    let slope_x = slope_y * ASPECT;
    let needs = |p: &Vec3| {
        let d = p.as_dvec3() - center;
        d.dot(to_eye) + (d.dot(right).abs() / slope_x).max(d.dot(up).abs() / slope_y)
    };
    mesh.triangles.iter().flatten().filter_map(|&i| mesh.positions.get(i as usize)).map(needs).fold(0.0, f64::max)
}

fn background() -> Value {
    let stop = |at: f64, color: [f64; 3]| Node::new(vec![Node::new(at), Node::new(color)]);
    // Dark at the horizon, as the floor is there; brighter above, for what reflects.
    Value::List(vec![stop(-1.0, [0.10, 0.10, 0.10]), stop(0.0, [0.085, 0.09, 0.1]), stop(1.0, [0.34, 0.42, 0.54])])
}
