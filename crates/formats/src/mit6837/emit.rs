//! From [`Scene`] to the native description.

use super::materials;
use super::scene::*;
use kirkas_geometry::DVec3;
use kirkas_scene::{Description, Diagnostic, Entity, Kind, Map, Name, Node, Span};
use std::collections::BTreeMap;

pub(super) fn emit(scene: Scene, d: &mut Description, warnings: &mut Vec<Diagnostic>) -> Result<(), Diagnostic> {
    course_settings(d);
    for camera in &scene.cameras {
        emit_camera(camera, d);
    }
    emit_lights(&scene, d);
    materials::emit(&scene, d, warnings)?;
    let mut objects = Objects { d, warnings, counts: BTreeMap::new(), steps: Vec::new() };
    for object in &scene.objects {
        objects.emit(object, None);
    }
    Ok(())
}

/// What the course's program does when it is given no flags.
fn course_settings(d: &mut Description) {
    let film = Map::default()
        .with("width", 200_i64)
        .with("height", 200_i64)
        .with("filter", "point")
        .with("shift", [-0.5, 0.5])
        .with("tone", "raw");
    let integrator = Map::default()
        .with("max_depth", 0_i64)
        .with("min_contribution", 0.01)
        .with("shadows", "none")
        .with("shade_back", false);
    d.single_mut(Kind::Film).params = film;
    d.single_mut(Kind::Sampler).params = Map::default().with("samples", 1_i64);
    *d.single_mut(Kind::Integrator) = Entity::new("", "whitted", integrator);
}

fn put(map: &mut Map, name: &str, value: At<[f64; 3]>) {
    map.set(Name::new(name), Node::spanned(value.0, value.1));
}

fn placed(name: &str, type_name: &str, params: Map, span: Span) -> Entity {
    let mut entity = Entity { span, ..Entity::new(name, type_name, params) };
    entity.name.span = span;
    entity.type_name.span = span;
    entity
}

fn emit_camera(camera: &Camera, d: &mut Description) {
    let mut params = Map::default();
    put(&mut params, "position", camera.center);
    let (from, along) = (DVec3::from_array(camera.center.0), DVec3::from_array(camera.direction.0));
    put(&mut params, "look_at", ((from + along).to_array(), camera.direction.1));
    if let Some(up) = camera.up {
        put(&mut params, "up", up);
    }
    let (type_name, extent) = if camera.is_perspective { ("perspective", "fov") } else { ("orthographic", "height") };
    params.set(Name::new(extent), Node::spanned(camera.extent.0, camera.extent.1));
    let name = d.free_name(Kind::Camera, "camera");
    d.all_mut(Kind::Camera).push(placed(&name, type_name, params, camera.span));
}

fn emit_lights(scene: &Scene, d: &mut Description) {
    if let Some(color) = scene.background {
        let background = d.single_mut(Kind::Background);
        put(&mut background.params, "color", color);
    }
    // The first assignment has no lights at all: its pictures show the plain diffuse colours.
    let is_flat = !scene.names_lights && scene.ambient.is_none();
    let ambient = if is_flat { Some(([1.0; 3], Span::NONE)) } else { scene.ambient };
    if let Some(color) = ambient.filter(|a| a.0 != [0.0; 3]) {
        let mut params = Map::default();
        put(&mut params, "color", color);
        d.all_mut(Kind::Light).push(placed("ambient", "ambient", params, color.1));
    }
    for (i, light) in scene.lights.iter().enumerate() {
        let mut params = Map::default();
        let type_name = match light.place {
            LightPlace::Directional(direction) => {
                put(&mut params, "direction", direction);
                "directional"
            }
            LightPlace::Point(position, ([c, l, q], span)) => {
                put(&mut params, "position", position);
                put(&mut params, "attenuation", ([q, l, c], span));
                "point"
            }
        };
        put(&mut params, "color", light.color);
        let params = params.with("unit", "plain");
        d.all_mut(Kind::Light).push(placed(&format!("light_{i}"), type_name, params, light.span));
    }
}

struct Objects<'a> {
    d: &'a mut Description,
    warnings: &'a mut Vec<Diagnostic>,
    /// How many of each type have a name.
    counts: BTreeMap<&'static str, usize>,
    /// The transformations around the object at hand, outermost first.
    steps: Vec<Step>,
}

impl Objects<'_> {
    /// Add `object` and what it holds. Nesting is bounded by [`super::parse::DEEPEST`].
    fn emit(&mut self, object: &Object, parent: Option<&str>) {
        let mut params = Map::default();
        let type_name = match &object.shape {
            Shape::Transform(steps, inner) => {
                let outside = self.steps.len();
                self.steps.extend(steps);
                self.emit(inner, parent);
                self.steps.truncate(outside);
                return;
            }
            Shape::Group(objects) => {
                let name = self.add("group", Map::default(), object, parent);
                let outside = std::mem::take(&mut self.steps);
                for inner in objects {
                    self.emit(inner, Some(&name));
                }
                self.steps = outside;
                return;
            }
            Shape::Sphere(center, radius) => {
                put(&mut params, "center", *center);
                params.set(Name::new("radius"), Node::spanned(radius.0, radius.1));
                "sphere"
            }
            Shape::Plane(normal, offset) => {
                let unit = DVec3::from_array(normal.0).normalize_or_zero();
                put(&mut params, "point", ((unit * offset.0).to_array().map(|v| v + 0.0), offset.1));
                put(&mut params, "normal", *normal);
                "plane"
            }
            Shape::Triangle(vertices) => {
                let list: Vec<Node> = vertices.iter().map(|v| Node::spanned(v.0, v.1)).collect();
                params.set(Name::new("vertices"), Node::spanned(list, vertices[0].1.to(vertices[2].1)));
                "triangle"
            }
            Shape::Mesh((file, span)) => {
                params.set(Name::new("file"), Node::spanned(file.as_str(), *span));
                params = params.with("normals", "file");
                "mesh"
            }
        };
        match object.material {
            Some((i, span)) => params.set(Name::new("material"), Node::spanned(format!("material_{i}"), span)),
            None => self.warnings.push(
                Diagnostic::warning("no-material", "this object stands before any `MaterialIndex`")
                    .at(object.span, "takes the default material")
                    .help("write `MaterialIndex 0` before it"),
            ),
        }
        self.add(type_name, params, object, parent);
    }

    fn add(&mut self, type_name: &'static str, mut params: Map, object: &Object, parent: Option<&str>) -> String {
        if let Some(parent) = parent {
            params = params.with("parent", parent);
        }
        if !self.steps.is_empty() {
            // The course applies the step next to the object first, Kirkas the first one written.
            let steps: Vec<Node> = self.steps.iter().rev().map(Step::native).collect();
            let span = self.steps[0].span.to(self.steps[self.steps.len() - 1].span);
            params.set(Name::new("transform"), Node::spanned(steps, span));
        }
        let count = self.counts.entry(type_name).or_default();
        let name = format!("{type_name}_{count}");
        *count += 1;
        self.d.all_mut(Kind::Object).push(placed(&name, type_name, params, object.span));
        name
    }
}
