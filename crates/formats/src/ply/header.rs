//! The header: which elements follow, how many, and how their properties are stored.

use kirkas_scene::diagnostic::unknown_name;
use kirkas_scene::{Diagnostic, SourceId, Span};

pub(super) const SOURCE: SourceId = SourceId(0);

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Format {
    Ascii,
    Little,
    Big,
}

/// A stored type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Ty {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Ty {
    pub fn size(self) -> usize {
        match self {
            Ty::I8 | Ty::U8 => 1,
            Ty::I16 | Ty::U16 => 2,
            Ty::I32 | Ty::U32 | Ty::F32 => 4,
            Ty::F64 => 8,
        }
    }
    pub fn is_integer(self) -> bool {
        !matches!(self, Ty::F32 | Ty::F64)
    }
}

const TYPES: [(&str, Ty); 16] = [
    ("char", Ty::I8),
    ("uchar", Ty::U8),
    ("short", Ty::I16),
    ("ushort", Ty::U16),
    ("int", Ty::I32),
    ("uint", Ty::U32),
    ("float", Ty::F32),
    ("double", Ty::F64),
    ("int8", Ty::I8),
    ("uint8", Ty::U8),
    ("int16", Ty::I16),
    ("uint16", Ty::U16),
    ("int32", Ty::I32),
    ("uint32", Ty::U32),
    ("float32", Ty::F32),
    ("float64", Ty::F64),
];

/// What a property is to us.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Role {
    /// Position (0, 1, 2), normal (3, 4, 5), texture coordinate (6, 7) or colour (8, 9, 10) of a vertex.
    Slot(usize),
    /// Corners of a face or of triangle strips.
    Corners,
    /// Skipped.
    Other,
}

/// How a property is stored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Storage {
    Scalar(Ty),
    /// Type of the count, type of the items.
    List(Ty, Ty),
}

#[derive(Clone, Debug)]
pub(super) struct Property {
    pub name: String,
    pub storage: Storage,
    pub role: Role,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Vertex,
    Face,
    Strips,
    Other,
}

#[derive(Clone, Debug)]
pub(super) struct Element {
    pub name: String,
    pub kind: Kind,
    pub count: u64,
    pub properties: Vec<Property>,
    pub span: Span,
}

impl Element {
    /// The stored type of the property with this role.
    pub fn scalar_of(&self, role: Role) -> Option<Ty> {
        self.properties.iter().find(|p| p.role == role).and_then(|p| match p.storage {
            Storage::Scalar(ty) => Some(ty),
            Storage::List(..) => None,
        })
    }

    /// The least number of bytes one takes in binary.
    pub fn least_size(&self) -> u64 {
        let size = |p: &Property| match p.storage {
            Storage::Scalar(t) | Storage::List(t, _) => t.size() as u64,
        };
        self.properties.iter().map(size).sum()
    }

    /// Offset, type and role of each property, if none is a list.
    pub fn fixed_layout(&self) -> Option<Vec<(usize, Ty, Role)>> {
        let mut at = 0;
        let place = |p: &Property| match p.storage {
            Storage::Scalar(t) => {
                at += t.size();
                Some((at - t.size(), t, p.role))
            }
            Storage::List(..) => None,
        };
        self.properties.iter().map(place).collect()
    }

    pub fn has(&self, role: Role) -> bool {
        self.properties.iter().any(|p| p.role == role)
    }
}

#[derive(Clone, Debug)]
pub(super) struct Header {
    pub format: Format,
    pub elements: Vec<Element>,
    /// Where the data start.
    pub body: usize,
}

/// Lines of text; they end with `\n`, `\r\n` or `\r`.
struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
}

type Words<'a> = Vec<(&'a str, Span)>;

impl<'a> Lines<'a> {
    /// The words of the next line; `None` at the end of the file.
    fn next(&mut self) -> Result<Option<Words<'a>>, Diagnostic> {
        let left = &self.bytes[self.at..];
        let Some(end) = left.iter().position(|&b| b == b'\n' || b == b'\r') else { return Ok(None) };
        let start = self.at;
        self.at += end + if left[end..].starts_with(b"\r\n") { 2 } else { 1 };
        let Ok(line) = std::str::from_utf8(&left[..end]) else {
            if left.starts_with(b"comment") || left.starts_with(b"obj_info") {
                return Ok(Some(Vec::new()));
            }
            return Err(Diagnostic::error("bad-header", "this line of the PLY header is not text")
                .at(Span::new(SOURCE, start, start + end), "not text")
                .help("the file is damaged; export it again"));
        };
        let place = |w: &'a str| {
            let from = start + (w.as_ptr() as usize - line.as_ptr() as usize);
            (w, Span::new(SOURCE, from, from + w.len()))
        };
        Ok(Some(line.split_ascii_whitespace().map(place).collect()))
    }
}

/// Read the header of `bytes`.
pub(super) fn read(bytes: &[u8], path: &str) -> Result<Header, Diagnostic> {
    let mut lines = Lines { bytes, at: 0 };
    if !(bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r") || bytes.starts_with(b"ply ")) {
        return Err(Diagnostic::error("not-ply", format!("`{path}` is not a PLY file: it does not start with `ply`"))
            .help("check the name, or export the mesh again"));
    }
    lines.next()?;
    let mut format = None;
    let mut elements: Vec<Element> = Vec::new();
    while let Some(words) = lines.next()? {
        let Some(&(first, span)) = words.first() else { continue };
        match first {
            "comment" | "obj_info" => {}
            "format" => format = Some(read_format(&words, span)?),
            "element" => {
                let element = read_element(&words, span)?;
                if elements.iter().any(|e| e.name == element.name) {
                    return Err(bad_line(span, &format!("element `{}` is declared twice", shown(&element.name))));
                }
                if elements.len() >= 1000 {
                    return Err(bad_line(span, "the header declares more than 1000 elements"));
                }
                elements.push(element);
            }
            "property" => {
                let Some(element) = elements.last_mut() else {
                    return Err(bad_line(span, "a property stands before any element"));
                };
                let property = read_property(&words, span, element)?;
                element.properties.push(property);
            }
            "end_header" => {
                let format = format.ok_or_else(|| bad_line(span, "the header names no format"))?;
                return Ok(Header { format, elements, body: lines.at });
            }
            other => {
                let known = ["comment", "obj_info", "format", "element", "property", "end_header"];
                return Err(unknown_name("header word", &shown(other), span, known));
            }
        }
    }
    let end = Span::new(SOURCE, lines.at, lines.at);
    Err(Diagnostic::error("cut-off", "the file ends inside the PLY header")
        .at(end, "`end_header` is missing")
        .help("the file was cut off; export or download it again"))
}

pub(super) fn shown(name: &str) -> String {
    match name.char_indices().nth(40) {
        Some((end, _)) => format!("{}...", &name[..end]),
        None => name.to_string(),
    }
}

fn bad_line(span: Span, message: &str) -> Diagnostic {
    Diagnostic::error("bad-header", message).at(span, "in this line of the header").help(
        "a header reads: `ply`, `format binary_little_endian 1.0`, `element vertex 8`, `property float x`, ..., `end_header`",
    )
}

fn read_format(words: &Words, span: Span) -> Result<Format, Diagnostic> {
    let Some(&(name, place)) = words.get(1) else { return Err(bad_line(span, "`format` names no format")) };
    let format = match name {
        "ascii" => Format::Ascii,
        "binary_little_endian" => Format::Little,
        "binary_big_endian" => Format::Big,
        other => {
            let known = ["ascii", "binary_little_endian", "binary_big_endian"];
            return Err(unknown_name("PLY format", &shown(other), place, known));
        }
    };
    match words.get(2) {
        Some(&("1.0" | "1", _)) => Ok(format),
        _ => Err(bad_line(span, "only version 1.0 of PLY exists")),
    }
}

fn read_element(words: &Words, span: Span) -> Result<Element, Diagnostic> {
    let (Some(&(name, _)), Some(&(count, place))) = (words.get(1), words.get(2)) else {
        return Err(bad_line(span, "an element needs a name and a count"));
    };
    let count = count.parse().map_err(|_| {
        Diagnostic::error("bad-header", format!("`{}` is not a count of elements", shown(count)))
            .at(place, "expected a whole number")
            .help("the file is damaged; export it again")
    })?;
    let kind = match name {
        "vertex" => Kind::Vertex,
        "face" => Kind::Face,
        "tristrips" => Kind::Strips,
        _ => Kind::Other,
    };
    Ok(Element { name: name.to_string(), kind, count, properties: Vec::new(), span })
}

fn read_property(words: &Words, span: Span, element: &Element) -> Result<Property, Diagnostic> {
    let ty = |i: usize| -> Result<Ty, Diagnostic> {
        let &(name, place) = words.get(i).ok_or_else(|| bad_line(span, "this property is incomplete"))?;
        let found = TYPES.iter().find(|t| t.0 == name);
        found.map(|t| t.1).ok_or_else(|| unknown_name("property type", &shown(name), place, TYPES.map(|t| t.0)))
    };
    let is_list = words.get(1).is_some_and(|w| w.0 == "list");
    let storage = if is_list { Storage::List(ty(2)?, ty(3)?) } else { Storage::Scalar(ty(1)?) };
    let &(name, place) =
        words.get(if is_list { 4 } else { 2 }).ok_or_else(|| bad_line(span, "this property has no name"))?;
    let role = match (element.kind, storage, name) {
        (Kind::Vertex, Storage::Scalar(_), "x") => Role::Slot(0),
        (Kind::Vertex, Storage::Scalar(_), "y") => Role::Slot(1),
        (Kind::Vertex, Storage::Scalar(_), "z") => Role::Slot(2),
        (Kind::Vertex, Storage::Scalar(_), "nx") => Role::Slot(3),
        (Kind::Vertex, Storage::Scalar(_), "ny") => Role::Slot(4),
        (Kind::Vertex, Storage::Scalar(_), "nz") => Role::Slot(5),
        (Kind::Vertex, Storage::Scalar(_), "u" | "s" | "texture_u" | "texture_s") => Role::Slot(6),
        (Kind::Vertex, Storage::Scalar(_), "v" | "t" | "texture_v" | "texture_t") => Role::Slot(7),
        (Kind::Vertex, Storage::Scalar(_), "red" | "r" | "diffuse_red") => Role::Slot(8),
        (Kind::Vertex, Storage::Scalar(_), "green" | "g" | "diffuse_green") => Role::Slot(9),
        (Kind::Vertex, Storage::Scalar(_), "blue" | "b" | "diffuse_blue") => Role::Slot(10),
        (Kind::Face | Kind::Strips, Storage::List(_, item), "vertex_indices" | "vertex_index") => {
            if !item.is_integer() {
                return Err(bad_line(place, "vertex numbers must be of a whole-number type"));
            }
            Role::Corners
        }
        _ => Role::Other,
    };
    if matches!(storage, Storage::List(count, _) if !count.is_integer()) {
        return Err(bad_line(span, "the length of a list must be of a whole-number type"));
    }
    // The first of two properties with one meaning holds.
    let role = if role != Role::Other && element.has(role) { Role::Other } else { role };
    Ok(Property { name: name.to_string(), storage, role })
}
