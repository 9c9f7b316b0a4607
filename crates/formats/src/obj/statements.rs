//! The statements of an OBJ file, still as it numbers things: positions, texture coordinates and normals apart.

use super::lines::{Lines, Word};
use kirkas_geometry::{Vec2, Vec3};
use kirkas_scene::{Diagnostic, SourceId};

/// "This corner has none."
pub(super) const NONE: u32 = u32::MAX;

/// Statements without a surface that Kirkas draws, or grouping only.
const IGNORED: [&str; 38] = [
    "o",
    "g",
    "s",
    "mg",
    "l",
    "p",
    "vp",
    "cstype",
    "deg",
    "bmat",
    "step",
    "curv",
    "curv2",
    "surf",
    "parm",
    "trim",
    "hole",
    "scrv",
    "sp",
    "end",
    "con",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "shadow_obj",
    "trace_obj",
    "ctech",
    "stech",
    "call",
    "csh",
    "maplib",
    "usemap",
    "fo",
    "bzp",
    "bsp",
    "res",
    "cdc",
];
const KNOWN: [&str; 6] = ["v", "vt", "vn", "f", "usemtl", "mtllib"];
const MOST_WARNINGS: usize = 20;

/// A face: its first corner in `corners`, and the position of its first word after `f`.
pub(super) struct Face {
    pub first: usize,
    pub at: usize,
}

#[derive(Default)]
pub(super) struct Statements<'a> {
    pub positions: Vec<Vec3>,
    /// One per position, or none at all.
    pub colors: Vec<Vec3>,
    pub uvs: Vec<Vec2>,
    pub normals: Vec<Vec3>,
    /// Position, texture coordinate, normal; from 0.
    pub corners: Vec<[u32; 3]>,
    pub faces: Vec<Face>,
    /// From which face on which material holds.
    pub switches: Vec<(usize, Word<'a>)>,
    pub libraries: Vec<Word<'a>>,
    pub warnings: Vec<Diagnostic>,
}

pub(super) const SOURCE: SourceId = SourceId(0);

pub(super) fn read<'a>(bytes: &'a [u8]) -> Result<Statements<'a>, Diagnostic> {
    let mut all = Statements::default();
    let mut lines = Lines::new(bytes);
    loop {
        if let Some(word) = lines.word() {
            read_statement(word, &mut lines, &mut all)?;
        }
        if !lines.next_line() {
            break;
        }
    }
    check_indices(&all, bytes)?;
    Ok(all)
}

fn read_statement<'a>(word: Word<'a>, lines: &mut Lines<'a>, all: &mut Statements<'a>) -> Result<(), Diagnostic> {
    match word.bytes {
        b"v" => {
            all.positions.push(Vec3::from_array(numbers(word, lines, 3)?));
            if let Some(color) = color(lines) {
                // Positions before the first that has a colour are white, as those without one behind it.
                all.colors.resize(all.positions.len() - 1, Vec3::ONE);
                all.colors.push(color);
            }
        }
        b"vt" => {
            let [u, v, _] = numbers(word, lines, 1)?;
            all.uvs.push(Vec2::new(u, v));
        }
        b"vn" => {
            let n = Vec3::from_array(numbers(word, lines, 3)?).as_dvec3().normalize_or_zero();
            all.normals.push(n.as_vec3());
        }
        b"f" => {
            let face = Face { first: all.corners.len(), at: lines.position() };
            while let Some(corner) = lines.word() {
                let corner = read_corner(corner, all)?;
                all.corners.push(corner);
            }
            let count = all.corners.len() - face.first;
            if count < 3 {
                return Err(Diagnostic::error(
                    "bad-face",
                    format!("a face needs at least 3 corners, this one has {count}"),
                )
                .at(word.span(SOURCE), "this face")
                .help("remove the face, or make it a line with `l`"));
            }
            all.faces.push(face);
        }
        b"usemtl" => all.switches.push((all.faces.len(), lines.rest())),
        b"mtllib" => all.libraries.push(lines.rest()),
        other => {
            let known = std::str::from_utf8(other).is_ok_and(|w| IGNORED.contains(&w));
            if !known && all.warnings.len() < MOST_WARNINGS {
                let mut d =
                    kirkas_scene::diagnostic::unknown_name("statement", &word.shown(), word.span(SOURCE), KNOWN);
                d.severity = kirkas_scene::Severity::Warning;
                all.warnings.push(d);
            }
        }
    }
    Ok(())
}

/// The colour behind a position: three numbers (one more would be a weight alone).
fn color(lines: &mut Lines) -> Option<Vec3> {
    let mut color = [0.0; 3];
    for lane in &mut color {
        *lane = lines.word()?.number().filter(|c| c.is_finite())?.max(0.0);
    }
    Some(Vec3::from_array(color))
}

/// The next three numbers of the line, of which `least` must be there.
fn numbers<'a>(statement: Word<'a>, lines: &mut Lines<'a>, least: usize) -> Result<[f32; 3], Diagnostic> {
    let mut out = [0.0; 3];
    for (i, slot) in out.iter_mut().enumerate() {
        let Some(word) = lines.word() else {
            if i >= least {
                break;
            }
            let name = statement.shown();
            return Err(Diagnostic::error("missing-number", format!("`{name}` takes {least} numbers, here are {i}"))
                .at(statement.span(SOURCE), "too short")
                .help("the line may have been cut off; export the file again"));
        };
        *slot = finite(word, SOURCE)?;
    }
    Ok(out)
}

/// A finite number.
pub(super) fn finite(word: Word, source: SourceId) -> Result<f32, Diagnostic> {
    match word.number() {
        Some(v) if v.is_finite() => Ok(v),
        Some(_) => Err(Diagnostic::error("not-finite", format!("`{}` is not a finite number", word.shown()))
            .at(word.span(source), "not finite")
            .help("export the file again without NaN, infinite or gigantic numbers")),
        None => Err(Diagnostic::error("not-a-number", format!("`{}` is not a number", word.shown()))
            .at(word.span(source), "expected a number")
            .help("write a number such as `1`, `-0.5` or `2e-3`")),
    }
}

const KINDS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// `1`, `1/2`, `1//3`, `1/2/3`; negative numbers count back from the last one read.
#[inline]
fn read_corner(word: Word, all: &Statements) -> Result<[u32; 3], Diagnostic> {
    let mut corner = [NONE; 3];
    let counts = [all.positions.len(), all.uvs.len(), all.normals.len()];
    let mut parts = word.bytes.split(|&b| b == b'/');
    for (i, part) in parts.by_ref().take(3).enumerate() {
        if part.is_empty() && i > 0 {
            continue;
        }
        let index =
            std::str::from_utf8(part).ok().and_then(|t| t.parse::<i64>().ok()).ok_or_else(|| bad_corner(word))?;
        corner[i] = match index {
            1.. => u32::try_from(index - 1)
                .ok()
                .filter(|&i| i != NONE)
                .ok_or_else(|| no_such(word, i, index, counts[i]))?,
            0 => {
                return Err(Diagnostic::error("bad-index", format!("a {} has number 0", KINDS[i]))
                    .at(word.span(SOURCE), "here")
                    .help("OBJ counts from 1 (or from -1 backwards)"));
            }
            _ => (counts[i] as i64)
                .checked_add(index)
                .and_then(|k| u32::try_from(k).ok())
                .ok_or_else(|| no_such(word, i, index, counts[i]))?,
        };
    }
    if parts.next().is_some() { Err(bad_corner(word)) } else { Ok(corner) }
}

fn bad_corner(word: Word) -> Diagnostic {
    Diagnostic::error("bad-corner", format!("`{}` is not a corner of a face", word.shown()))
        .at(word.span(SOURCE), "expected numbers")
        .help("write `vertex`, `vertex/texture`, `vertex//normal` or `vertex/texture/normal`")
}

fn no_such(word: Word, kind: usize, index: i64, count: usize) -> Diagnostic {
    let kind = KINDS[kind];
    Diagnostic::error("bad-index", format!("{kind} {index} does not exist: there are {count}"))
        .at(word.span(SOURCE), format!("no such {kind}"))
        .help("the file may have been cut off or edited by hand; export it again")
}

/// Corners may name things that follow later, so they are checked last.
fn check_indices(all: &Statements, bytes: &[u8]) -> Result<(), Diagnostic> {
    let counts = [all.positions.len(), all.uvs.len(), all.normals.len()];
    let wrong = |c: &[u32; 3]| (0..3).find(|&i| c[i] != NONE && c[i] as usize >= counts[i]);
    let Some(at) = all.corners.iter().position(|c| wrong(c).is_some()) else { return Ok(()) };
    let face = &all.faces[all.faces.partition_point(|f| f.first <= at).saturating_sub(1)];
    let mut lines = Lines::from(bytes, face.at);
    let word = (face.first..=at).filter_map(|_| lines.word()).last();
    let kind = wrong(&all.corners[at]).unwrap_or(0);
    let word = word.unwrap_or(Word { bytes: &bytes[face.at..face.at], start: face.at });
    Err(no_such(word, kind, i64::from(all.corners[at][kind]) + 1, counts[kind]))
}
