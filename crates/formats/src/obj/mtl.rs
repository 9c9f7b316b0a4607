//! The statements of an MTL file.

use super::lines::{Lines, Word};
use super::statements::finite;
use kirkas_scene::{Diagnostic, Severity, SourceId};

/// An image and how it lies on the surface.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Map {
    pub file: String,
    pub scale: [f64; 2],
    pub offset: [f64; 2],
    pub clamp: bool,
}

/// A material as written.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Material {
    pub name: String,
    pub kd: Option<[f64; 3]>,
    pub ks: Option<[f64; 3]>,
    pub ke: Option<[f64; 3]>,
    pub tf: Option<[f64; 3]>,
    pub ns: Option<f64>,
    pub ni: Option<f64>,
    /// Opacity, from `d` or `1 - Tr`.
    pub d: Option<f64>,
    pub illum: Option<i64>,
    pub map_kd: Option<Map>,
    pub map_ke: Option<Map>,
    pub map_d: Option<Map>,
}

const KNOWN: [&str; 13] = ["newmtl", "Ka", "Kd", "Ks", "Ke", "Tf", "Ns", "Ni", "d", "Tr", "illum", "map_Kd", "map_d"];

/// Read all materials of one file.
pub(super) fn read(
    bytes: &[u8],
    source: SourceId,
    warnings: &mut Vec<Diagnostic>,
) -> Result<Vec<Material>, Diagnostic> {
    let mut all: Vec<Material> = Vec::new();
    let mut lines = Lines::new(bytes);
    loop {
        if let Some(word) = lines.word() {
            if word.bytes == b"newmtl" {
                let name = lines.rest();
                if name.bytes.is_empty() {
                    return Err(Diagnostic::error("missing-name", "`newmtl` needs a name")
                        .at(word.span(source), "no name follows")
                        .help("write `newmtl NAME`"));
                }
                all.push(Material { name: name.text().into_owned(), ..Material::default() });
            } else {
                let Some(material) = all.last_mut() else {
                    return Err(Diagnostic::error(
                        "no-material",
                        format!("`{}` stands before any material", word.shown()),
                    )
                    .at(word.span(source), "belongs to no material")
                    .help("start each material with `newmtl NAME`"));
                };
                read_statement(word, &mut lines, source, material, warnings)?;
            }
        }
        if !lines.next_line() {
            return Ok(all);
        }
    }
}

fn read_statement(
    word: Word,
    lines: &mut Lines,
    source: SourceId,
    material: &mut Material,
    warnings: &mut Vec<Diagnostic>,
) -> Result<(), Diagnostic> {
    let ignored = |what: &str| {
        Diagnostic::warning("ignored", format!("{what} of material `{}` is ignored", material.name))
            .at(word.span(source), "has no equivalent")
            .help("set it on a native material instead")
    };
    let in_range = |(v, place): (f64, Word), high: f64, warnings: &mut Vec<Diagnostic>| {
        if (0.0..=high).contains(&v) {
            return v;
        }
        let clamped = v.clamp(0.0, high);
        warnings.push(
            Diagnostic::warning("out-of-range", format!("`{}` is {v}; {clamped} is used", word.shown()))
                .at(place.span(source), format!("must be from 0 to {high}")),
        );
        clamped
    };
    match word.bytes {
        b"Kd" | b"Ks" | b"Ke" | b"Tf" => {
            let Some((color, place)) = read_color(word, lines, source)? else {
                warnings.push(ignored(&format!("the spectral or XYZ `{}`", word.shown())));
                return Ok(());
            };
            let high = if word.bytes == b"Ke" { f64::INFINITY } else { 1.0 };
            let color = Some(color.map(|v| in_range((v, place), high, warnings)));
            match word.bytes {
                b"Kd" => material.kd = color,
                b"Ks" => material.ks = color,
                b"Ke" => material.ke = color,
                _ => material.tf = color,
            }
        }
        b"Ns" => material.ns = Some(in_range(read_number(word, lines, source)?, f64::INFINITY, warnings)),
        b"Ni" => material.ni = Some(read_number(word, lines, source)?.0).filter(|&n| n > 0.0),
        b"d" => {
            let mut ahead = lines.clone();
            if ahead.word().is_some_and(|w| w.bytes == b"-halo") {
                warnings.push(ignored("the halo"));
                *lines = ahead;
            }
            material.d = Some(in_range(read_number(word, lines, source)?, 1.0, warnings));
        }
        b"Tr" => material.d = Some(1.0 - in_range(read_number(word, lines, source)?, 1.0, warnings)),
        b"illum" => material.illum = Some(read_number(word, lines, source)?.0 as i64),
        b"map_Kd" => material.map_kd = Some(read_map(word, lines, source, warnings)?),
        b"map_Ke" => material.map_ke = Some(read_map(word, lines, source, warnings)?),
        b"map_d" => material.map_d = Some(read_map(word, lines, source, warnings)?),
        // Nearly every exporter writes these without meaning anything by them.
        b"Ka" | b"map_Ka" | b"sharpness" => {}
        other => {
            let text = word.shown();
            let lower = text.to_ascii_lowercase();
            let understood = lower.starts_with("map_")
                || ["bump", "norm", "disp", "decal", "refl", "pr", "pm", "ps", "pc", "pcr", "aniso", "anisor"]
                    .contains(&lower.as_str());
            if understood {
                warnings.push(ignored(&format!("`{text}`")));
            } else if std::str::from_utf8(other).is_ok_and(|t| t.bytes().all(|b| b.is_ascii_graphic())) {
                let mut d = kirkas_scene::diagnostic::unknown_name("MTL statement", &text, word.span(source), KNOWN);
                d.severity = Severity::Warning;
                warnings.push(d);
            } else {
                return Err(Diagnostic::error("not-mtl", "this is not an MTL file")
                    .at(word.span(source), "not text")
                    .help("check which file the `mtllib` line names"));
            }
        }
    }
    Ok(())
}

fn read_number<'a>(statement: Word, lines: &mut Lines<'a>, source: SourceId) -> Result<(f64, Word<'a>), Diagnostic> {
    let word = lines.word().ok_or_else(|| {
        Diagnostic::error("missing-number", format!("`{}` needs a number", statement.shown()))
            .at(statement.span(source), "nothing follows")
            .help("the line may have been cut off; export the file again")
    })?;
    Ok((f64::from(finite(word, source)?), word))
}

/// `r g b` or one grey; `None` for the forms `spectral FILE` and `xyz X Y Z`.
fn read_color<'a>(
    statement: Word,
    lines: &mut Lines<'a>,
    source: SourceId,
) -> Result<Option<([f64; 3], Word<'a>)>, Diagnostic> {
    let mut ahead = lines.clone();
    if ahead.word().is_some_and(|w| w.bytes == b"spectral" || w.bytes == b"xyz") {
        return Ok(None);
    }
    let (r, place) = read_number(statement, lines, source)?;
    let mut ahead = lines.clone();
    if ahead.word().is_none() {
        return Ok(Some(([r; 3], place)));
    }
    let g = read_number(statement, lines, source)?.0;
    let b = read_number(statement, lines, source)?.0;
    Ok(Some(([r, g, b], place)))
}

/// `[-s u [v [w]]] [-o u [v [w]]] [-clamp on] ... FILE`
fn read_map(
    statement: Word,
    lines: &mut Lines,
    source: SourceId,
    warnings: &mut Vec<Diagnostic>,
) -> Result<Map, Diagnostic> {
    let mut map = Map { file: String::new(), scale: [1.0; 2], offset: [0.0; 2], clamp: false };
    loop {
        let mut ahead = lines.clone();
        let Some(option) = ahead.word() else { break };
        let ignored = |arguments: usize, ahead: &mut Lines, warnings: &mut Vec<Diagnostic>| {
            for _ in 0..arguments {
                ahead.word();
            }
            warnings.push(
                Diagnostic::warning("ignored", format!("the texture option `{}` is ignored", option.shown()))
                    .at(option.span(source), "has no equivalent"),
            );
        };
        match option.bytes {
            b"-s" => map.scale = read_up_to_three(option, &mut ahead, 1.0, source)?,
            b"-o" => map.offset = read_up_to_three(option, &mut ahead, 0.0, source)?,
            b"-t" => {
                read_up_to_three(option, &mut ahead, 0.0, source)?;
                ignored(0, &mut ahead, warnings);
            }
            b"-clamp" => map.clamp = ahead.word().is_some_and(|w| w.bytes == b"on"),
            b"-blendu" | b"-blendv" | b"-cc" | b"-bm" | b"-boost" | b"-texres" | b"-imfchan" | b"-type" => {
                ignored(1, &mut ahead, warnings);
            }
            b"-mm" => ignored(2, &mut ahead, warnings),
            _ => break,
        }
        *lines = ahead;
    }
    let file = lines.rest();
    if file.bytes.is_empty() {
        return Err(Diagnostic::error("missing-file", format!("`{}` names no file", statement.shown()))
            .at(statement.span(source), "no file follows")
            .help("write the image's path after the options"));
    }
    map.file = file.text().replace('\\', "/");
    Ok(map)
}

/// The first two of one to three numbers.
fn read_up_to_three(option: Word, lines: &mut Lines, missing: f64, source: SourceId) -> Result<[f64; 2], Diagnostic> {
    let mut out = [missing; 3];
    out[0] = read_number(option, lines, source)?.0;
    for slot in &mut out[1..] {
        let mut ahead = lines.clone();
        match ahead.word().and_then(|w| w.number()) {
            Some(v) if v.is_finite() => *slot = f64::from(v),
            _ => break,
        }
        *lines = ahead;
    }
    Ok([out[0], out[1]])
}
