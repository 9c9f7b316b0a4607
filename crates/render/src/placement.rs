//! Objects find their places: groups nest, instances repeat, motions carry everything below them.

use crate::compile_scene::Groups;
use crate::materials::Material;
use crate::scene::{InstanceInfo, NO_LIGHT, PartInfo};
use crate::shapes::{SHAPES, ShapeInput};
use crate::textures::Textures;
use kirkas_accel as accel;
use kirkas_geometry::{AnimatedTransform, DAffine3};
use kirkas_optics::Palette;
use kirkas_scene::transforms::{read_motion, read_transform};
use kirkas_scene::{Assets, Catalog, Description, Diagnostic, Entity, Kind, Map, Params, SourceId};
use std::collections::BTreeMap;

/// One geometry and what is known of it.
pub(crate) struct PlacedPart {
    pub shape: accel::Shape,
    pub info: PartInfo,
    pub is_visible: bool,
}

/// Everything placed.
pub(crate) struct Placement {
    pub world: Vec<PlacedPart>,
    pub aggregates: Vec<Vec<PlacedPart>>,
    pub instances: Vec<InstanceInfo>,
    pub materials: Vec<Material>,
    pub textures: Textures,
    pub object_names: Vec<String>,
}

/// Groups within groups, instances of instances: more is refused.
const DEEPEST: usize = 256;
/// Placed aggregates: more is refused.
const MOST_INSTANCES: usize = 1 << 22;

/// Put every object of `d` where it belongs.
pub(crate) fn place_objects(
    d: &Description,
    catalog: &Catalog,
    assets: &dyn Assets,
    palette: &Palette,
    textures: Textures,
    materials: Vec<Material>,
    groups: &mut Groups,
) -> Result<Placement, Vec<Diagnostic>> {
    let objects = d.all(Kind::Object);
    let numbers: BTreeMap<&str, usize> = objects.iter().enumerate().map(|(i, e)| (e.name.text.as_str(), i)).collect();
    let params: Vec<Params> =
        objects.iter().map(|e| Params::new(e, Kind::Object, catalog).expect("the description was validated")).collect();
    let mut builder = Builder {
        d,
        catalog,
        assets,
        palette,
        groups,
        material_numbers: materials.iter().enumerate().map(|(i, m)| (m.name.clone(), i as u32)).collect(),
        materials,
        textures,
        children: vec![Vec::new(); objects.len()],
        numbers,
        params,
        prototypes: Vec::new(),
        prototype_of: vec![None; objects.len()],
        is_open: vec![false; objects.len()],
    };
    let roots = builder.link().map_err(|e| vec![e])?;
    let mut space = Space::default();
    let mut errors = Vec::new();
    for root in roots {
        errors.extend(builder.visit(root, &Context::root(), &mut space).err());
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    let mut placed = Placement {
        world: space.parts,
        aggregates: Vec::new(),
        instances: Vec::new(),
        object_names: objects.iter().map(|e| e.name.text.clone()).collect(),
        materials: builder.materials,
        textures: builder.textures,
    };
    flatten(builder.prototypes, space.nested, &mut placed).map_err(|e| vec![e])?;
    Ok(placed)
}

/// A space that geometry is collected in: the world, or one of an aggregate's.
#[derive(Default)]
struct Space {
    parts: Vec<PlacedPart>,
    nested: Vec<Nested>,
}

/// A prototype placed in a space.
#[derive(Clone)]
struct Nested {
    placement: AnimatedTransform,
    prototype: usize,
    object: Option<u32>,
    material: Option<u32>,
    is_visible: bool,
}

/// What an object inherits from above.
#[derive(Clone, Copy)]
struct Context {
    matrix: DAffine3,
    material: Option<u32>,
    is_visible: bool,
    depth: usize,
    /// True when an instance asks: then templates are drawn.
    as_template: bool,
}

impl Context {
    fn root() -> Self {
        Context { matrix: DAffine3::IDENTITY, material: None, is_visible: true, depth: 0, as_template: false }
    }
}

struct Builder<'a> {
    d: &'a Description,
    catalog: &'a Catalog,
    assets: &'a dyn Assets,
    palette: &'a Palette,
    groups: &'a mut Groups,
    material_numbers: BTreeMap<String, u32>,
    materials: Vec<Material>,
    textures: Textures,
    numbers: BTreeMap<&'a str, usize>,
    params: Vec<Params<'a>>,
    children: Vec<Vec<usize>>,
    prototypes: Vec<Space>,
    prototype_of: Vec<Option<usize>>,
    /// Instances being resolved: one that comes back to itself is refused.
    is_open: Vec<bool>,
}

impl Builder<'_> {
    /// Hang every object below its parent; gives those without one.
    fn link(&mut self) -> Result<Vec<usize>, Diagnostic> {
        let mut roots = Vec::new();
        let mut parents = vec![None; self.params.len()];
        for i in 0..self.params.len() {
            let p = self.params[i];
            let Some(name) = p.text("parent") else {
                roots.push(i);
                continue;
            };
            let parent = self.numbers[name];
            if self.params[parent].spec().name != "group" {
                return Err(Diagnostic::error(
                    "bad-parent",
                    format!("`{name}` is a {}, and only groups have children", self.params[parent].spec().name),
                )
                .at(p.span("parent"), "not a group")
                .help("make the parent a `group`, or put both into one"));
            }
            parents[i] = Some(parent);
            self.children[parent].push(i);
        }
        // Every chain of parents must end: mark what the roots reach.
        let mut reached = vec![false; parents.len()];
        let mut todo = roots.clone();
        while let Some(i) = todo.pop() {
            reached[i] = true;
            todo.extend(&self.children[i]);
        }
        if let Some(i) = reached.iter().position(|r| !r) {
            return Err(Diagnostic::error(
                "parent-cycle",
                format!("`{}` is, through its parents, its own parent", self.params[i].entity.name.text),
            )
            .at(self.params[i].span("parent"), "leads back here")
            .help("remove one `parent`"));
        }
        Ok(roots)
    }

    fn visit(&mut self, i: usize, context: &Context, space: &mut Space) -> Result<(), Diagnostic> {
        let p = self.params[i];
        if p.spec().name == "group" && p.bool("template") && !context.as_template {
            return Ok(());
        }
        if context.depth > DEEPEST {
            return Err(Diagnostic::error(
                "too-deep",
                format!("`{}` lies more than {DEEPEST} groups deep", p.entity.name.text),
            )
            .at(p.entity.name.span, "here")
            .help("flatten some of the groups"));
        }
        let mut inner = *context;
        inner.depth += 1;
        inner.as_template = false;
        inner.is_visible &= p.bool("visible");
        inner.material = p.text("material").map(|n| self.material_numbers[n]).or(context.material);
        let own = p.entity.params.get("transform").map_or(Ok(DAffine3::IDENTITY), read_transform)?;
        let motion = p.entity.params.get("motion").map(read_motion).transpose()?;
        match motion {
            // What moves gets a space of its own.
            Some(m) if m.is_moving() => {
                let mut moved = Space::default();
                inner.matrix = own;
                self.fill(i, &inner, &mut moved)?;
                self.prototypes.push(moved);
                let placement = m.within(&AnimatedTransform::still(context.matrix));
                let prototype = self.prototypes.len() - 1;
                space.nested.push(Nested { placement, prototype, object: None, material: None, is_visible: true });
                Ok(())
            }
            other => {
                let carried = other.map_or(DAffine3::IDENTITY, |m| m.at(0.0));
                inner.matrix = context.matrix * carried * own;
                self.fill(i, &inner, space)
            }
        }
    }

    /// Put what object `i` consists of into `space`; its own transform is in the context already.
    fn fill(&mut self, i: usize, context: &Context, space: &mut Space) -> Result<(), Diagnostic> {
        match self.params[i].spec().name {
            "group" => {
                let was_open = std::mem::replace(&mut self.is_open[i], true);
                let result =
                    self.children[i].clone().into_iter().try_for_each(|child| self.visit(child, context, space));
                self.is_open[i] = was_open;
                result
            }
            "instance" => self.instance(i, context, space),
            _ => self.shape(i, context, space),
        }
    }

    fn instance(&mut self, i: usize, context: &Context, space: &mut Space) -> Result<(), Diagnostic> {
        let p = self.params[i];
        let name = p.text("of").unwrap_or_default();
        let target = self.numbers[name];
        if self.is_open[target] {
            return Err(Diagnostic::error("instance-cycle", format!("`{name}` holds an instance of itself"))
                .at(p.span("of"), "leads back here")
                .help("remove this instance, or instance something else"));
        }
        let prototype = match self.prototype_of[target] {
            Some(known) => known,
            None => {
                let mut own = Space::default();
                self.is_open[target] = true;
                let start = Context { depth: context.depth, as_template: true, ..Context::root() };
                let result = self.visit(target, &start, &mut own);
                self.is_open[target] = false;
                result?;
                self.prototypes.push(own);
                self.prototype_of[target] = Some(self.prototypes.len() - 1);
                self.prototypes.len() - 1
            }
        };
        let placement = AnimatedTransform::still(context.matrix);
        let is_visible = context.is_visible;
        space.nested.push(Nested {
            placement,
            prototype,
            object: Some(i as u32),
            material: context.material,
            is_visible,
        });
        Ok(())
    }

    fn shape(&mut self, i: usize, context: &Context, space: &mut Space) -> Result<(), Diagnostic> {
        let p = self.params[i];
        let Some(shape) = SHAPES.iter().find(|s| s.spec.name == p.spec().name) else { return Ok(()) };
        let span = p.entity.name.span;
        let source: Option<SourceId> = span.is_some().then_some(span.source);
        let input = ShapeInput {
            params: p,
            assets: self.assets,
            textures: &self.textures,
            source,
            part_from_object: context.matrix,
        };
        for part in (shape.build)(&input)? {
            let material = match (context.material, &part.own_material) {
                (Some(m), _) => m,
                (None, Some(own)) => self.own_material(&p, source, own)?,
                (None, None) => self.default_material(),
            };
            let name = &p.entity.name.text;
            let emission_group = self.emission_group(material, name);
            space.parts.push(PlacedPart {
                shape: part.shape,
                info: PartInfo { surface: part.surface, material, object: i as u32, emission_group, light: NO_LIGHT },
                is_visible: context.is_visible,
            });
        }
        Ok(())
    }

    fn emission_group(&mut self, material: u32, object: &str) -> u32 {
        let m = &self.materials[material as usize];
        if m.emission.is_none() {
            return 0;
        }
        let entity = self.d.find(Kind::Material, &m.name);
        let named = entity.and_then(|e| e.params.get("group")).and_then(|n| n.text());
        self.groups.number(named.unwrap_or(object))
    }

    /// Grey, for objects without a material.
    fn default_material(&mut self) -> u32 {
        const NAME: &str = "(default)";
        if let Some(known) = self.material_numbers.get(NAME) {
            return *known;
        }
        let entity = Entity::new(NAME, "lambert", Map::default());
        let params = Params::new(&entity, Kind::Material, self.catalog).expect("`lambert` is listed");
        self.materials.extend(Material::new(&params, self.textures.names(), self.palette));
        self.material_numbers.insert(NAME.into(), self.materials.len() as u32 - 1);
        self.materials.len() as u32 - 1
    }

    /// A material that came with the mesh file of object `p`.
    fn own_material(&mut self, p: &Params, source: Option<SourceId>, name: &str) -> Result<u32, Diagnostic> {
        let file = p.text("file").unwrap_or_default();
        let folder = source.and_then(|s| self.d.sources.get(s)).map_or("", |s| s.path.as_str());
        let key = |material: &str| format!("{folder}:{file}:{material}");
        if let Some(known) = self.material_numbers.get(&key(name)) {
            return Ok(*known);
        }
        let mesh = self.assets.mesh(source, file)?;
        let first = |mut e: Vec<Diagnostic>| e.swap_remove(0);
        let names = self.textures.add(&mesh.textures, &mesh.folder, self.catalog, self.assets).map_err(first)?;
        for entity in &mesh.materials {
            let params = Params::new(entity, Kind::Material, self.catalog);
            if let Some(mut material) = params.and_then(|p| Material::new(&p, &names, self.palette)) {
                material.name = format!("{}.{}", p.entity.name.text, entity.name.text);
                self.materials.push(material);
                self.material_numbers.insert(key(&entity.name.text), self.materials.len() as u32 - 1);
            }
        }
        match self.material_numbers.get(&key(name)) {
            Some(known) => Ok(*known),
            None => Ok(self.default_material()),
        }
    }
}

/// Walk the tree of prototypes and give every one with geometry an instance for each of its places.
fn flatten(prototypes: Vec<Space>, roots: Vec<Nested>, placed: &mut Placement) -> Result<(), Diagnostic> {
    let mut aggregate_of = Vec::new();
    let mut nested_of = Vec::new();
    for space in prototypes {
        aggregate_of.push((!space.parts.is_empty()).then(|| {
            placed.aggregates.push(space.parts);
            placed.aggregates.len() - 1
        }));
        nested_of.push(space.nested);
    }
    let mut todo: Vec<Nested> = roots.into_iter().rev().collect();
    let mut steps = 0_usize;
    while let Some(n) = todo.pop() {
        steps += 1;
        if steps > MOST_INSTANCES {
            return Err(Diagnostic::error(
                "too-many-instances",
                format!("the scene places more than {MOST_INSTANCES} instances"),
            )
            .help("instance smaller groups, or nest fewer instances in instances"));
        }
        if let Some(aggregate) = aggregate_of[n.prototype] {
            let still = (!n.placement.is_moving()).then(|| {
                let m = n.placement.at(0.0);
                (m, m.inverse())
            });
            placed.instances.push(InstanceInfo {
                aggregate,
                world_from_part: n.placement.clone(),
                still,
                object: n.object,
                material: n.material,
                is_visible: n.is_visible,
                lights: std::sync::Arc::new([]),
            });
        }
        for inner in nested_of[n.prototype].iter().rev() {
            todo.push(Nested {
                placement: inner.placement.within(&n.placement),
                prototype: inner.prototype,
                object: n.object.or(inner.object),
                material: n.material.or(inner.material),
                is_visible: n.is_visible && inner.is_visible,
            });
        }
    }
    Ok(())
}
