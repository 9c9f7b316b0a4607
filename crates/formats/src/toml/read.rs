//! A file and all it includes, walked into a description.

use super::syntax;
use crate::Failure;
use crate::failure::{file_problem, read_text};
use kirkas_scene::diagnostic::unknown_name;
use kirkas_scene::files::{FileAccess, resolve};
use kirkas_scene::{Description, Diagnostic, Entity, Kind, Map, Name, Node, SourceId, Span, Value};
use std::collections::{BTreeMap, BTreeSet};

/// The version of the format that this build writes and reads.
pub(super) const VERSION: i64 = 1;

/// Top-level words beside the sections.
const WORDS: [&str; 4] = ["version", "title", "description", "include"];

/// More problems than this are not worth a person's time.
const MOST_PROBLEMS: usize = 50;

/// Read the scene `path` and every file that it includes.
pub fn read(files: &FileAccess, path: &str) -> Result<Description, Failure> {
    let mut reader = Reader {
        files,
        into: Description::default(),
        problems: Vec::new(),
        chain: Vec::new(),
        done: BTreeSet::new(),
        names: BTreeMap::new(),
    };
    reader.file("", path, Span::NONE);
    let Reader { into, mut problems, .. } = reader;
    if problems.is_empty() {
        return Ok(into);
    }
    problems.truncate(MOST_PROBLEMS);
    Err(Failure::new(into.sources, problems))
}

struct Reader<'a> {
    files: &'a FileAccess,
    into: Description,
    problems: Vec<Diagnostic>,
    /// The files being read, from the scene to the innermost include.
    chain: Vec<String>,
    done: BTreeSet<String>,
    /// Where each named entity stands in its kind's list.
    names: BTreeMap<(Kind, String), usize>,
}

impl Reader<'_> {
    fn file(&mut self, folder: &str, path: &str, named_at: Span) {
        if let Err(problem) = self.try_file(folder, path) {
            self.problems.push(problem.at(named_at, "included here"));
        }
    }

    fn try_file(&mut self, folder: &str, path: &str) -> Result<(), Diagnostic> {
        // Stop before a file that is being read, or was.
        let full = resolve(folder, path).map_err(|e| file_problem(&e))?;
        if let Some(start) = self.chain.iter().position(|p| *p == full) {
            let loop_ = self.chain[start..].iter().chain([&full]).map(|p| format!("`{p}`")).collect::<Vec<_>>();
            return Err(Diagnostic::error(
                "recursive-include",
                format!("`{full}` includes itself: {}", loop_.join(" -> ")),
            )
            .help("remove one of these includes"));
        }
        let deepest = self.files.limits().include_depth;
        if self.chain.len() > deepest {
            return Err(Diagnostic::error("deep-include", format!("`{full}` lies more than {deepest} includes deep"))
                .help("include it nearer to the scene"));
        }
        if !self.done.insert(full.clone()) {
            return Ok(());
        }

        // Parse.
        let file = read_text(self.files, folder, path)?;
        let source = self.into.sources.add(file.path, file.text.clone());
        let root = match syntax::parse(source, &file.text) {
            Ok(root) => root,
            Err(problems) => {
                self.problems.extend(problems);
                return Ok(());
            }
        };
        drop(file.text);

        // Included files come first.
        self.chain.push(full);
        if let Some((_, node)) = root.entry("include") {
            self.includes(source, node);
        }
        self.chain.pop();
        for (name, node) in root.0 {
            if name.text != "include" {
                self.top_level(name, node);
            }
        }
        Ok(())
    }

    fn includes(&mut self, source: SourceId, node: &Node) {
        let folder = self.into.sources.folder(source).to_string();
        let items = match &node.value {
            Value::List(items) => items.as_slice(),
            _ => std::slice::from_ref(node),
        };
        for item in items {
            match item.text() {
                Some(path) => self.file(&folder, path, item.span),
                None => self.problems.push(
                    Diagnostic::error("wrong-type", format!("`include` takes paths, not {}", item.value.article()))
                        .at(item.span, "expected a path")
                        .help("write `include = [\"studio.toml\"]`"),
                ),
            }
            if self.problems.len() >= MOST_PROBLEMS {
                return;
            }
        }
    }

    fn top_level(&mut self, name: Name, node: Node) {
        match (name.text.as_str(), Kind::from_section(&name.text)) {
            ("title", _) => {
                if let Some(text) = self.text("title", node) {
                    self.into.title = text;
                }
            }
            ("description", _) => {
                if let Some(text) = self.text("description", node) {
                    self.into.description = text;
                }
            }
            ("version", _) if node.value == Value::Int(VERSION) => {}
            ("version", _) => self.problems.push(
                Diagnostic::error(
                    "unknown-version",
                    format!("this Kirkas reads version {VERSION} of the scene format"),
                )
                .at(node.span, "another version")
                .help(format!("write `version = {VERSION}`, or use the Kirkas that this scene was made for")),
            ),
            (_, Some(kind)) => match node.value {
                Value::Map(map) if kind.is_single() => {
                    let entity = self.entity(kind, Name { text: String::new(), span: name.span }, map, node.span);
                    self.join_single(kind, entity);
                }
                Value::Map(map) => self.named(kind, map),
                other => self.problems.push(not_a_table(kind, &name, &other)),
            },
            (unknown, None) => {
                let known: Vec<&str> = Kind::ALL.into_iter().map(Kind::section).chain(WORDS).collect();
                self.problems.push(unknown_name("section", unknown, name.span, known));
            }
        }
    }

    fn text(&mut self, what: &str, node: Node) -> Option<String> {
        if let Value::Text(text) = node.value {
            return Some(text);
        }
        self.problems.push(
            Diagnostic::error("wrong-type", format!("`{what}` takes a text, not {}", node.value.article()))
                .at(node.span, "expected a text")
                .help("put it in quotes"),
        );
        None
    }

    fn named(&mut self, kind: Kind, map: Map) {
        for (name, node) in map.0 {
            let Value::Map(params) = node.value else {
                let section = kind.section();
                self.problems.push(
                    Diagnostic::error(
                        "missing-name",
                        format!("`{}` stands in [{section}], but {section} have names", name.text),
                    )
                    .at(name.span, "whose?")
                    .help(format!("write [{section}.NAME] above it")),
                );
                continue;
            };
            let entity = self.entity(kind, name, params, node.span);
            let at = self.into.all(kind).len();
            match self.names.insert((kind, entity.name.text.clone()), at) {
                None => self.into.all_mut(kind).push(entity),
                Some(first) => {
                    // The first one stays, and says so.
                    self.names.insert((kind, entity.name.text.clone()), first);
                    let first_span = self.into.all(kind)[first].name.span;
                    let what = format!("{} `{}` is defined twice", kind.singular(), entity.name.text);
                    self.problems.push(
                        Diagnostic::error("duplicate-name", what)
                            .at(entity.name.span, "again here")
                            .at(first_span, "first here")
                            .help("rename or remove one of them"),
                    );
                }
            }
        }
    }

    /// Split `type` from the rest. A missing type is left empty for named kinds: validation tells which types there are.
    fn entity(&mut self, kind: Kind, name: Name, mut params: Map, span: Span) -> Entity {
        let type_name = match params.remove("type") {
            Some(Node { value: Value::Text(text), span }) => Name { text, span },
            Some(other) => {
                self.problems.push(
                    Diagnostic::error("wrong-type", format!("`type` takes a text, not {}", other.value.article()))
                        .at(other.span, "expected a text")
                        .help("write `type = \"NAME\"`"),
                );
                Name::new("")
            }
            None => Name::new(kind.default_type().unwrap_or_default()),
        };
        Entity { name, type_name, params, span }
    }

    /// The later word wins, key by key; another written type forgets the earlier entity.
    fn join_single(&mut self, kind: Kind, later: Entity) {
        let Some(earlier) = self.into.all_mut(kind).first_mut() else {
            self.into.all_mut(kind).push(later);
            return;
        };
        let type_was_written = later.type_name.span.is_some();
        if type_was_written && later.type_name.text != earlier.type_name.text {
            *earlier = later;
            return;
        }
        if type_was_written {
            earlier.type_name = later.type_name;
        }
        earlier.name.span = later.name.span;
        earlier.span = later.span;
        let mut places: BTreeMap<String, usize> =
            earlier.params.iter().enumerate().map(|(i, (n, _))| (n.text.clone(), i)).collect();
        for (name, node) in later.params.0 {
            let next = earlier.params.0.len();
            match *places.entry(name.text.clone()).or_insert(next) {
                i if i == next => earlier.params.0.push((name, node)),
                i => earlier.params.0[i] = (name, node),
            }
        }
    }
}

fn not_a_table(kind: Kind, name: &Name, value: &Value) -> Diagnostic {
    let section = kind.section();
    let header = if kind.is_single() { format!("[{section}]") } else { format!("[{section}.NAME]") };
    let tables = matches!(value, Value::List(l) if l.iter().all(|n| n.map().is_some()));
    let message = match (tables, kind.is_single()) {
        (true, true) => format!("a scene has one {section}"),
        (true, false) => format!("{section} have names"),
        (false, _) => format!("`{section}` is a table, not {}", value.article()),
    };
    Diagnostic::error("wrong-type", message)
        .at(name.span, "here")
        .help(format!("write {header}, with single brackets, and its values below"))
}
