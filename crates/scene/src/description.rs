//! A whole scene as it was described: entities of each kind, flat, by name.

use crate::diagnostic::unknown_name;
use crate::{Diagnostic, Map, Name, Node, Sources, Span, Value};

/// The kinds of things a scene holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    /// Image size, filter, crop (one).
    Film,
    /// How sample points are made (one).
    Sampler,
    /// How light is found (one).
    Integrator,
    /// How rays find surfaces (one).
    Accelerator,
    /// What rays see that hit nothing (one).
    Background,
    /// Cameras by name.
    Camera,
    /// Lights by name.
    Light,
    /// Textures by name.
    Texture,
    /// Phase functions by name: how the particles of media scatter.
    Phase,
    /// Media by name: what fills space.
    Medium,
    /// Materials by name.
    Material,
    /// Shapes, groups and instances by name.
    Object,
}

impl Kind {
    /// All of them, in the order in which they are written.
    pub const ALL: [Kind; 12] = [
        Kind::Film,
        Kind::Sampler,
        Kind::Integrator,
        Kind::Accelerator,
        Kind::Background,
        Kind::Camera,
        Kind::Light,
        Kind::Texture,
        Kind::Phase,
        Kind::Medium,
        Kind::Material,
        Kind::Object,
    ];

    /// The singular, for messages: `material`.
    pub fn singular(self) -> &'static str {
        match self {
            Kind::Film => "film",
            Kind::Sampler => "sampler",
            Kind::Integrator => "integrator",
            Kind::Accelerator => "accelerator",
            Kind::Background => "background",
            Kind::Camera => "camera",
            Kind::Light => "light",
            Kind::Texture => "texture",
            Kind::Phase => "phase",
            Kind::Medium => "medium",
            Kind::Material => "material",
            Kind::Object => "object",
        }
    }

    /// The section it is written in: `materials`, `film`.
    pub fn section(self) -> &'static str {
        match self {
            Kind::Camera => "cameras",
            Kind::Light => "lights",
            Kind::Texture => "textures",
            Kind::Phase => "phases",
            Kind::Medium => "media",
            Kind::Material => "materials",
            Kind::Object => "objects",
            single => single.singular(),
        }
    }

    /// True for kinds of which a scene has exactly one, without a name.
    pub fn is_single(self) -> bool {
        self.singular() == self.section()
    }

    /// The type that a single kind has where none is written.
    pub fn default_type(self) -> Option<&'static str> {
        match self {
            Kind::Film => Some("image"),
            Kind::Sampler => Some("sobol"),
            Kind::Integrator => Some("path"),
            Kind::Accelerator => Some("bvh8"),
            Kind::Background => Some("constant"),
            _ => None,
        }
    }

    /// From the section's name.
    pub fn from_section(name: &str) -> Option<Kind> {
        Kind::ALL.into_iter().find(|k| k.section() == name)
    }
}

/// One thing: its name, its type, and what was said about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Entity {
    /// Name; empty for single kinds.
    pub name: Name,
    /// Type, such as `lambert`.
    pub type_name: Name,
    /// Parameters as written (without `type`).
    pub params: Map,
    /// The whole place.
    pub span: Span,
}

impl Entity {
    /// An entity that nobody wrote.
    pub fn new(name: &str, type_name: &str, params: Map) -> Self {
        Entity { name: Name::new(name), type_name: Name::new(type_name), params, span: Span::NONE }
    }
}

/// A scene as described.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Description {
    /// The texts it was read from.
    pub sources: Sources,
    /// What the picture is called; empty if nobody said.
    pub title: String,
    /// A few words about it; empty if nobody said.
    pub description: String,
    entities: [Vec<Entity>; Kind::ALL.len()],
}

impl Description {
    /// All entities of a kind, in written order.
    pub fn all(&self, kind: Kind) -> &[Entity] {
        &self.entities[kind as usize]
    }

    /// The same, to change.
    pub fn all_mut(&mut self, kind: Kind) -> &mut Vec<Entity> {
        &mut self.entities[kind as usize]
    }

    /// The one entity of a single kind, if written.
    pub fn single(&self, kind: Kind) -> Option<&Entity> {
        self.all(kind).first()
    }

    /// The one entity of a single kind, made of its default type if it was not written.
    pub fn single_mut(&mut self, kind: Kind) -> &mut Entity {
        let list = self.all_mut(kind);
        if list.is_empty() {
            list.push(Entity::new("", kind.default_type().unwrap_or_default(), Map::default()));
        }
        &mut list[0]
    }

    /// An entity by name.
    pub fn find(&self, kind: Kind, name: &str) -> Option<&Entity> {
        self.all(kind).iter().find(|e| e.name.text == name)
    }

    /// Add one; a second of the same name, or of a single kind, is an error.
    pub fn add(&mut self, kind: Kind, entity: Entity) -> Result<(), Diagnostic> {
        if let Some(first) = self.find(kind, &entity.name.text) {
            let what = format!("{} `{}`", kind.singular(), entity.name.text);
            return Err(Diagnostic::error("duplicate-name", format!("{what} is defined twice"))
                .at(entity.name.span, "again here")
                .at(first.name.span, "first here")
                .help("rename or remove one of them"));
        }
        self.all_mut(kind).push(entity);
        Ok(())
    }

    /// A name of `kind` that is not taken yet, `base` if it can be.
    pub fn free_name(&self, kind: Kind, base: &str) -> String {
        if self.find(kind, base).is_none() {
            return base.to_string();
        }
        (2..).map(|i| format!("{base}_{i}")).find(|n| self.find(kind, n).is_none()).unwrap_or_default()
    }

    /// Set the value at a path such as `integrator.max_depth` or `lights.lamp.intensity`; `type` sets the type.
    /// Deeper parts walk into maps and lists (`objects.a.transform.0.scale`).
    pub fn set(&mut self, path: &str, path_span: Span, node: Node) -> Result<(), Diagnostic> {
        let mut parts = path.split('.');
        let section = parts.next().unwrap_or_default();
        let Some(kind) = Kind::from_section(section) else {
            return Err(unknown_name("section", section, path_span, Kind::ALL.map(Kind::section)));
        };
        let entity = if kind.is_single() {
            self.single_mut(kind)
        } else {
            let name = parts.next().unwrap_or_default();
            let names: Vec<String> = self.all(kind).iter().map(|e| e.name.text.clone()).collect();
            match self.all_mut(kind).iter_mut().find(|e| e.name.text == name) {
                Some(e) => e,
                None => {
                    return Err(unknown_name(
                        kind.singular(),
                        name,
                        path_span,
                        names.iter().map(String::as_str).collect::<Vec<_>>(),
                    ));
                }
            }
        };
        let rest: Vec<&str> = parts.collect();
        let Some((first, deeper)) = rest.split_first() else {
            return Err(Diagnostic::error(
                "bad-path",
                format!("`{path}` names a {}, not one of its values", kind.singular()),
            )
            .at(path_span, "stops too early")
            .help(format!("write `{path}.parameter=value`")));
        };
        if *first == "type" && deeper.is_empty() {
            let Value::Text(text) = node.value else {
                return Err(Diagnostic::error("wrong-type", format!("a type is a text, not {}", node.value.article()))
                    .at(node.span, "expected a text")
                    .help(format!("write `{path}=NAME`")));
            };
            entity.type_name = Name { text, span: node.span };
            return Ok(());
        }
        if deeper.is_empty() {
            entity.params.set(Name { text: (*first).into(), span: path_span }, node);
            return Ok(());
        }
        let missing = || {
            Diagnostic::error("bad-path", format!("`{path}` leads to nothing that was written"))
                .at(path_span, "no such place")
                .help("set the whole value instead, one step up")
        };
        let mut place =
            entity.params.0.iter_mut().find(|(n, _)| n.text == *first).map(|(_, v)| v).ok_or_else(missing)?;
        for part in deeper {
            place = match &mut place.value {
                Value::Map(m) => m.0.iter_mut().find(|(n, _)| n.text == *part).map(|(_, v)| v),
                Value::List(l) => part.parse::<usize>().ok().and_then(|i| l.get_mut(i)),
                _ => None,
            }
            .ok_or_else(missing)?;
        }
        *place = node;
        Ok(())
    }

    /// Forget where everything was written: for comparing descriptions.
    pub fn without_spans(mut self) -> Self {
        fn clear(node: &mut Node) {
            node.span = Span::NONE;
            match &mut node.value {
                Value::List(l) => l.iter_mut().for_each(clear),
                Value::Map(m) => clear_map(m),
                _ => {}
            }
        }
        fn clear_map(map: &mut Map) {
            for (name, node) in &mut map.0 {
                name.span = Span::NONE;
                clear(node);
            }
        }
        for e in self.entities.iter_mut().flatten() {
            e.name.span = Span::NONE;
            e.type_name.span = Span::NONE;
            e.span = Span::NONE;
            clear_map(&mut e.params);
        }
        self.sources = Sources::default();
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_reaches_single_and_named_values() {
        let mut d = Description::default();
        d.set("integrator.max_depth", Span::NONE, Node::new(3_i64)).unwrap();
        d.add(Kind::Light, Entity::new("lamp", "point", Map::default().with("intensity", 1.0))).unwrap();
        d.set("lights.lamp.intensity", Span::NONE, Node::new(2.0)).unwrap();
        assert_eq!(d.find(Kind::Light, "lamp").unwrap().params.get("intensity").unwrap().number(), Some(2.0));
        assert_eq!(d.single(Kind::Integrator).unwrap().type_name.text, "path");
        let wrong = d.set("lights.lmap.intensity", Span::NONE, Node::new(2.0)).unwrap_err();
        assert_eq!(wrong.message, "unknown light `lmap`; did you mean `lamp`?");
        assert!(d.add(Kind::Light, Entity::new("lamp", "spot", Map::default())).is_err());
    }
}
