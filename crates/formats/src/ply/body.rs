//! The data behind the header, element by element. Elements of fixed size and faces in their usual form are read in
//! straight loops; everything else, and ASCII, goes through one walk over [`Values`].

use super::header::{Element, Format, Header, Kind, Role, SOURCE, Storage, Ty};
use kirkas_geometry::{Vec2, Vec3};
use kirkas_scene::{Diagnostic, Span};

/// What a file gives before it is checked.
#[derive(Default)]
pub(super) struct Body {
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub uvs: Vec<Vec2>,
    /// As the file has them.
    pub colors: Vec<Vec3>,
    /// The largest number that a colour may be stored as; 0 where floats are stored.
    pub color_codes: f32,
    pub triangles: Vec<[u32; 3]>,
    /// Faces with more than three corners.
    pub polygons: Vec<Polygon>,
    /// Their corners.
    pub polygon_corners: Vec<u32>,
    /// The largest vertex number used, and the face that uses it.
    pub largest: Option<(u32, u64)>,
    /// Where vertices lie in a binary file: start and size of each, for messages.
    pub vertex_place: Option<(usize, usize)>,
}

pub(super) struct Polygon {
    /// How many triangles came before.
    pub before: usize,
    /// Its part of `polygon_corners`.
    pub corners: std::ops::Range<usize>,
}

pub(super) fn read(bytes: &[u8], header: &Header) -> Result<Body, Diagnostic> {
    let mut body = Body::default();
    let mut ascii = Ascii { bytes, at: header.body, last: header.body };
    let mut binary = Binary { bytes, at: header.body, big: header.format == Format::Big };
    for element in header.elements.iter().filter(|e| !e.properties.is_empty()) {
        check_count(
            element,
            header.format,
            bytes.len() - if header.format == Format::Ascii { ascii.at } else { binary.at },
        )?;
        match (header.format, element.fixed_layout()) {
            (Format::Ascii, _) => walk(&mut ascii, element, &mut body)?,
            (_, Some(layout)) => read_fixed(&mut binary, element, &layout, &mut body),
            _ if read_plain_faces(&mut binary, element, &mut body)? => {}
            _ => walk(&mut binary, element, &mut body)?,
        }
    }
    Ok(body)
}

/// What the header promises must fit into the bytes that are left.
fn check_count(element: &Element, format: Format, left: usize) -> Result<(), Diagnostic> {
    let properties = element.properties.len() as u64;
    let (needed, size, left) = match format {
        // One digit and one blank each; the last blank may be missing.
        Format::Ascii => (element.count.saturating_mul(2 * properties), 2 * properties, left as u64 + 1),
        _ => (element.count.saturating_mul(element.least_size()), element.least_size(), left as u64),
    };
    if needed <= left {
        return Ok(());
    }
    let (count, name) = (element.count, super::header::shown(&element.name));
    let fit = left / size;
    Err(Diagnostic::error("cut-off", format!("the file ends early: its header declares {count} of `{name}`, at least {size} bytes each, but no more than {fit} fit into the {left} bytes left"))
        .at(element.span, "declared here")
        .help("the file was cut off or its header is wrong; export or download it again"))
}

/// Elements of fixed size: one pass for each property we want.
fn read_fixed(binary: &mut Binary, element: &Element, layout: &[(usize, Ty, Role)], body: &mut Body) {
    let (stride, count) = (element.least_size() as usize, element.count as usize);
    let records = &binary.bytes[binary.at..binary.at + stride * count];
    if element.kind == Kind::Vertex {
        body.vertex_place = Some((binary.at, stride));
        body.allocate(element, count);
        for &(offset, ty, role) in layout {
            let Role::Slot(slot) = role else { continue };
            match slot {
                0..3 => {
                    column(records, stride, offset, ty, binary.big, body.positions.iter_mut().map(|p| &mut p[slot]))
                }
                3..6 => {
                    column(records, stride, offset, ty, binary.big, body.normals.iter_mut().map(|n| &mut n[slot - 3]))
                }
                6..8 => column(records, stride, offset, ty, binary.big, body.uvs.iter_mut().map(|t| &mut t[slot - 6])),
                _ => column(records, stride, offset, ty, binary.big, body.colors.iter_mut().map(|c| &mut c[slot - 8])),
            }
        }
    }
    binary.at += stride * count;
}

impl Body {
    fn allocate(&mut self, element: &Element, count: usize) {
        let has = |slots: std::ops::Range<usize>| slots.into_iter().all(|s| element.has(Role::Slot(s)));
        self.positions = vec![Vec3::ZERO; count];
        self.normals = vec![Vec3::ZERO; if has(3..6) { count } else { 0 }];
        self.uvs = vec![Vec2::ZERO; if has(6..8) { count } else { 0 }];
        self.colors = vec![Vec3::ZERO; if has(8..11) { count } else { 0 }];
        self.color_codes = match element.scalar_of(Role::Slot(8)) {
            Some(Ty::U8 | Ty::I8) => 255.0,
            Some(Ty::U16 | Ty::I16) => 65_535.0,
            _ => 0.0,
        };
    }

    fn set(&mut self, vertex: usize, slot: usize, value: f32) {
        match slot {
            0..3 => self.positions[vertex][slot] = value,
            3..6 => {
                if let Some(n) = self.normals.get_mut(vertex) {
                    n[slot - 3] = value;
                }
            }
            6..8 => {
                if let Some(t) = self.uvs.get_mut(vertex) {
                    t[slot - 6] = value;
                }
            }
            _ => {
                if let Some(c) = self.colors.get_mut(vertex) {
                    c[slot - 8] = value;
                }
            }
        }
    }
}

/// Copy one property of all records. The type is decided once, outside of the loop.
fn column<'a>(
    records: &[u8],
    stride: usize,
    offset: usize,
    ty: Ty,
    big: bool,
    targets: impl Iterator<Item = &'a mut f32>,
) {
    macro_rules! copy {
        ($t:ty, $n:literal) => {
            for (record, target) in records.chunks_exact(stride).zip(targets) {
                let mut b = [0; $n];
                b.copy_from_slice(&record[offset..offset + $n]);
                *target = (if big { <$t>::from_be_bytes(b) } else { <$t>::from_le_bytes(b) }) as f32;
            }
        };
    }
    match ty {
        Ty::I8 => copy!(i8, 1),
        Ty::U8 => copy!(u8, 1),
        Ty::I16 => copy!(i16, 2),
        Ty::U16 => copy!(u16, 2),
        Ty::I32 => copy!(i32, 4),
        Ty::U32 => copy!(u32, 4),
        Ty::F32 => copy!(f32, 4),
        Ty::F64 => copy!(f64, 8),
    }
}

/// Faces as nearly every file has them: a list with a one-byte count and four-byte vertex numbers, scalars before and
/// after it. False (and nothing read) if they are stored otherwise.
fn read_plain_faces(binary: &mut Binary, element: &Element, body: &mut Body) -> Result<bool, Diagnostic> {
    let usual = |p: &super::header::Property| {
        p.role == Role::Corners && matches!(p.storage, Storage::List(Ty::U8, Ty::I32 | Ty::U32))
    };
    let Some(list) = element.properties.iter().position(usual).filter(|_| element.kind == Kind::Face) else {
        return Ok(false);
    };
    let scalars = |properties: &[super::header::Property]| {
        properties.iter().try_fold(0, |sum, p| match p.storage {
            Storage::Scalar(t) => Some(sum + t.size()),
            Storage::List(..) => None,
        })
    };
    let around = scalars(&element.properties[..list]).zip(scalars(&element.properties[list + 1..]));
    let Some((before, after)) = around else { return Ok(false) };
    let is_big = binary.big;
    let number = |b: &[u8]| {
        let b = [b[0], b[1], b[2], b[3]];
        if is_big { u32::from_be_bytes(b) } else { u32::from_le_bytes(b) }
    };
    body.triangles.reserve(element.count as usize);
    let (mut largest, mut largest_face) = body.largest.unwrap_or((0, 0));
    let mut at = binary.at;
    let mut polygon: Vec<u32> = Vec::new();
    for face in 0..element.count {
        let cut = || cut_off(element, face, binary.bytes.len());
        let count = usize::from(*binary.bytes.get(at + before).ok_or_else(cut)?);
        let from = at + before + 1;
        let end = from + 4 * count + after;
        let corners = binary.bytes.get(from..end).ok_or_else(cut)?;
        if count == 3 {
            let t = [number(corners), number(&corners[4..]), number(&corners[8..])];
            let most = t[0].max(t[1]).max(t[2]);
            if most > largest {
                (largest, largest_face) = (most, face);
            }
            body.triangles.push(t);
        } else {
            polygon.clear();
            polygon.extend(corners[..4 * count].chunks_exact(4).map(number));
            body.largest = Some((largest, largest_face));
            add_face(body, face, &polygon, || format!("byte {at}"))?;
            (largest, largest_face) = body.largest.unwrap_or((0, 0));
        }
        at = end;
    }
    if element.count > 0 {
        body.largest = Some((largest, largest_face));
    }
    binary.at = at;
    Ok(true)
}

fn add_face(body: &mut Body, face: u64, corners: &[u32], place: impl Fn() -> String) -> Result<(), Diagnostic> {
    for &c in corners {
        if body.largest.is_none_or(|(l, _)| c > l) {
            body.largest = Some((c, face));
        }
    }
    match *corners {
        [a, b, c] => body.triangles.push([a, b, c]),
        [_, _, _, ..] => {
            let start = body.polygon_corners.len();
            body.polygon_corners.extend_from_slice(corners);
            body.polygons.push(Polygon { before: body.triangles.len(), corners: start..start + corners.len() });
        }
        _ => {
            return Err(Diagnostic::error(
                "bad-face",
                format!("face {face} has {} corners; it needs at least 3 ({})", corners.len(), place()),
            )
            .help("remove degenerate faces and export the mesh again"));
        }
    }
    Ok(())
}

fn cut_off(element: &Element, done: u64, length: usize) -> Diagnostic {
    let name = super::header::shown(&element.name);
    Diagnostic::error("cut-off", format!("the file ends after {length} bytes, in {name} {done} of {}", element.count))
        .at(element.span, "declared here")
        .help("the file was cut off; export or download it again")
}

/// Values one after the other.
trait Values {
    /// The next value, or why there is none.
    fn next(&mut self, ty: Ty) -> Result<f64, Stop>;
    /// Bytes not yet read.
    fn left(&self) -> usize;
    /// Bytes that a value takes at least.
    fn least(&self, ty: Ty) -> usize;
    /// Where the last value stood, in words.
    fn place(&self) -> String;
    /// The same as a span, in texts.
    fn span(&self) -> Span;
    fn length(&self) -> usize;
}

enum Stop {
    End,
    NotANumber(String),
}

struct Binary<'a> {
    bytes: &'a [u8],
    at: usize,
    big: bool,
}

impl Values for Binary<'_> {
    fn next(&mut self, ty: Ty) -> Result<f64, Stop> {
        let b = self.bytes.get(self.at..self.at + ty.size()).ok_or(Stop::End)?;
        self.at += ty.size();
        let mut word = [0; 8];
        let n = b.len();
        // As if little-endian.
        for (i, w) in word.iter_mut().take(n).enumerate() {
            *w = b[if self.big { n - 1 - i } else { i }];
        }
        let bits = u64::from_le_bytes(word);
        Ok(match ty {
            Ty::I8 => f64::from(bits as i8),
            Ty::U8 => f64::from(bits as u8),
            Ty::I16 => f64::from(bits as i16),
            Ty::U16 => f64::from(bits as u16),
            Ty::I32 => f64::from(bits as i32),
            Ty::U32 => f64::from(bits as u32),
            Ty::F32 => f64::from(f32::from_bits(bits as u32)),
            Ty::F64 => f64::from_bits(bits),
        })
    }
    fn left(&self) -> usize {
        self.bytes.len() - self.at
    }
    fn least(&self, ty: Ty) -> usize {
        ty.size()
    }
    fn place(&self) -> String {
        format!("before byte {}", self.at)
    }
    fn span(&self) -> Span {
        Span::NONE
    }
    fn length(&self) -> usize {
        self.bytes.len()
    }
}

struct Ascii<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Start of the last word.
    last: usize,
}

impl Values for Ascii<'_> {
    fn next(&mut self, ty: Ty) -> Result<f64, Stop> {
        let left = &self.bytes[self.at..];
        let start = left.iter().position(|&b| b > b' ').ok_or(Stop::End)?;
        let end = left[start..].iter().position(|&b| b <= b' ').map_or(left.len(), |n| start + n);
        self.last = self.at + start;
        self.at += end;
        let word = &left[start..end];
        let number = std::str::from_utf8(word).ok().and_then(|w| match ty {
            Ty::F32 => w.parse::<f32>().ok().map(f64::from),
            _ => w.parse().ok(),
        });
        let wrong = || Stop::NotANumber(String::from_utf8_lossy(&word[..word.len().min(40)]).into_owned());
        number.filter(|v| !ty.is_integer() || *v as i64 as f64 == *v).ok_or_else(wrong)
    }
    fn left(&self) -> usize {
        self.bytes.len() - self.at
    }
    fn least(&self, _: Ty) -> usize {
        2
    }
    fn place(&self) -> String {
        let line = self.bytes[..self.last].iter().filter(|&&b| b == b'\n').count() + 1;
        format!("line {line}")
    }
    fn span(&self) -> Span {
        Span::new(SOURCE, self.last, self.at)
    }
    fn length(&self) -> usize {
        self.bytes.len()
    }
}

/// Any element, value by value.
fn walk(values: &mut impl Values, element: &Element, body: &mut Body) -> Result<(), Diagnostic> {
    if element.kind == Kind::Vertex {
        body.allocate(element, element.count as usize);
    }
    let mut corners: Vec<i64> = Vec::new();
    for row in 0..element.count {
        for property in &element.properties {
            let stop = |stop: Stop, values: &dyn ValuesPlace| explain(stop, element, row, property, values);
            match property.storage {
                Storage::Scalar(ty) => {
                    let v = values.next(ty).map_err(|s| stop(s, values))?;
                    if let Role::Slot(slot) = property.role {
                        body.set(row as usize, slot, v as f32);
                        if !(v as f32).is_finite() && (0..3).contains(&slot) | (6..8).contains(&slot) {
                            return Err(not_finite(row, &values.place()).at(values.span(), "not finite"));
                        }
                    }
                }
                Storage::List(count, ty) => {
                    let n = values.next(count).map_err(|s| stop(s, values))?;
                    if n < 0.0 {
                        return Err(Diagnostic::error(
                            "bad-list",
                            format!(
                                "{} {row} has a list of {n} items ({})",
                                super::header::shown(&element.name),
                                values.place()
                            ),
                        )
                        .at(values.span(), "negative")
                        .help("the file is damaged; export it again"));
                    }
                    if n > (values.left() + 1) as f64 / values.least(ty) as f64 {
                        return Err(cut_off(element, row, values.length()));
                    }
                    if property.role == Role::Corners {
                        corners.clear();
                        for _ in 0..n as u64 {
                            corners.push(values.next(ty).map_err(|s| stop(s, values))? as i64);
                        }
                        add_list(body, element, row, &corners, values)?;
                    } else {
                        for _ in 0..n as u64 {
                            values.next(ty).map_err(|s| stop(s, values))?;
                        }
                    }
                }
            }
        }
    }
    Ok(())
}

/// The part of [`Values`] that messages need.
trait ValuesPlace {
    fn place_of(&self) -> (String, Span, usize);
}
impl<V: Values> ValuesPlace for V {
    fn place_of(&self) -> (String, Span, usize) {
        (self.place(), self.span(), self.length())
    }
}

fn explain(
    stop: Stop,
    element: &Element,
    row: u64,
    property: &super::header::Property,
    values: &dyn ValuesPlace,
) -> Diagnostic {
    let (place, span, length) = values.place_of();
    let (name, property) = (super::header::shown(&element.name), super::header::shown(&property.name));
    match stop {
        Stop::End => cut_off(element, row, length),
        Stop::NotANumber(word) => Diagnostic::error(
            "not-a-number",
            format!("`{word}` is no value for `{property}` of {name} {row} ({place})"),
        )
        .at(span, "expected a number")
        .help("the file is damaged; export it again"),
    }
}

pub(super) fn not_finite(vertex: u64, place: &str) -> Diagnostic {
    Diagnostic::error("not-finite", format!("vertex {vertex} is not a finite point ({place})"))
        .help("remove NaN and infinite vertices and export the mesh again")
}

/// A face, or triangle strips that end at -1.
fn add_list(
    body: &mut Body,
    element: &Element,
    row: u64,
    list: &[i64],
    values: &impl Values,
) -> Result<(), Diagnostic> {
    let number = |v: i64| {
        u32::try_from(v).map_err(|_| {
            Diagnostic::error(
                "bad-index",
                format!("{} {row} uses vertex {v} ({})", super::header::shown(&element.name), values.place()),
            )
            .at(values.span(), "no such vertex")
            .help("vertices count from 0; export the mesh again")
        })
    };
    if element.kind == Kind::Face {
        let corners = list.iter().map(|&v| number(v)).collect::<Result<Vec<u32>, _>>()?;
        return add_face(body, row, &corners, || values.place()).map_err(|d| d.at(values.span(), "ends here"));
    }
    for strip in list.split(|&v| v == -1) {
        for (i, w) in strip.windows(3).enumerate() {
            let [a, b, c] = [number(w[0])?, number(w[1])?, number(w[2])?];
            if a != b && b != c && c != a {
                add_face(body, row, &if i % 2 == 0 { [a, b, c] } else { [b, a, c] }, || values.place())?;
            }
        }
    }
    Ok(())
}
