//! PLY meshes: the format of scanners, and the fastest way to bring a large mesh into Kirkas.
//!
//! # What is read
//!
//! ASCII, binary little-endian and big-endian files of version 1.0. Of `vertex`: `x y z`, `nx ny nz`, and texture
//! coordinates named `u v`, `s t`, `texture_u texture_v` or `texture_s texture_t`, of any type and in any order; `red green blue`,
//! sRGB codes if they are whole numbers, else linear. Of `face`:
//! the list `vertex_indices` or `vertex_index`; polygons are cut like those of OBJ ([`crate::obj::polygon`]). Of `tristrips`
//! (Stanford's strips, ended by -1) the same. Everything else is skipped. Vertices keep their order.
//!
//! Counts are checked against the bytes left before memory is taken. A vertex that is not finite, a corner that does not
//! exist and a file that ends early are errors that name the element and its line or byte.
//!
//! # References
//!
//! Turk, "The PLY Polygon File Format" (1994).

mod body;
mod header;
mod write;

pub use write::write_binary;

use crate::Failure;
use crate::obj::{polygon, printable};
use body::Body;
use header::{Format, Kind};
use kirkas_geometry::Vec3;
use kirkas_geometry::elementary::pow;
use kirkas_scene::{Diagnostic, MeshData, Sources};

/// Read the PLY file `bytes`, known to the user as `path`.
pub fn read(bytes: &[u8], path: &str) -> Result<MeshData, Failure> {
    let mut text = 0;
    let outcome = header::read(bytes, path).and_then(|header| {
        text = if header.format == Format::Ascii { bytes.len() } else { header.body };
        check_elements(&header, path)?;
        let mut body = body::read(bytes, &header)?;
        check_values(&mut body)?;
        Ok(to_mesh(body))
    });
    outcome.map_err(|d| {
        // Spans point into the header, or anywhere in ASCII files. Where the header's end is not known, show whole lines.
        let shown = d.labels.iter().map(|l| l.0.end as usize).fold(text, usize::max).min(bytes.len());
        let line = bytes[shown..].iter().take(200).position(|&b| b == b'\n' || b == b'\r');
        let shown = if text == 0 { shown + line.unwrap_or(0) } else { shown };
        let mut sources = Sources::default();
        sources.add(path, printable(&bytes[..shown]));
        Failure::one(sources, d)
    })
}

fn check_elements(header: &header::Header, path: &str) -> Result<(), Diagnostic> {
    let end = || kirkas_scene::Span::new(header::SOURCE, header.body.saturating_sub(1), header.body);
    let find = |kind: Kind| header.elements.iter().find(|e| e.kind == kind && e.count > 0);
    let Some(vertices) = find(Kind::Vertex) else {
        return Err(Diagnostic::error("no-vertices", format!("`{path}` holds no vertices"))
            .at(end(), "no `element vertex` above")
            .help("export a mesh with vertices and faces"));
    };
    for (slot, name) in ["x", "y", "z"].iter().enumerate() {
        if !vertices.has(header::Role::Slot(slot)) {
            return Err(Diagnostic::error("missing-property", format!("the vertices have no `{name}`"))
                .at(vertices.span, "declared here")
                .help("a vertex needs the properties `x`, `y` and `z`"));
        }
    }
    let faces: Vec<_> = [find(Kind::Face), find(Kind::Strips)].into_iter().flatten().collect();
    if faces.is_empty() {
        let message = format!("`{path}` holds {} vertices but no faces: there is nothing to draw", vertices.count);
        return Err(Diagnostic::error("no-faces", message)
            .at(end(), "no `element face` above")
            .help("Kirkas draws surfaces; turn the point cloud into a mesh first"));
    }
    match faces.iter().find(|f| !f.has(header::Role::Corners)) {
        Some(f) => Err(Diagnostic::error("missing-property", format!("`{}` has no list `vertex_indices`", f.name))
            .at(f.span, "declared here")
            .help("add `property list uchar int vertex_indices`")),
        None => Ok(()),
    }
}

/// Points must be finite and corners exist; normals are made unit, or zero where they are nothing.
fn check_values(body: &mut Body) -> Result<(), Diagnostic> {
    let bad = body.positions.iter().position(|p| !p.is_finite());
    if let Some(i) = bad.or_else(|| body.uvs.iter().position(|t| !t.is_finite())) {
        let place = body.vertex_place.map(|(start, size)| format!("byte {}", start + i * size));
        return Err(body::not_finite(i as u64, &place.unwrap_or_default()));
    }
    let count = body.positions.len();
    if let Some((vertex, face)) = body.largest.filter(|l| l.0 as usize >= count) {
        // Numbers this large were negative in the file.
        let vertex = if vertex > i32::MAX as u32 { i64::from(vertex as i32) } else { i64::from(vertex) };
        let message = format!("face {face} uses vertex {vertex}, but there are only {count}, from 0 to {}", count - 1);
        return Err(Diagnostic::error("bad-index", message).help("the file is damaged; export it again"));
    }
    for n in &mut body.normals {
        *n = if n.is_finite() { n.as_dvec3().normalize_or_zero().as_vec3() } else { kirkas_geometry::Vec3::ZERO };
    }
    Ok(())
}

fn to_mesh(body: Body) -> MeshData {
    let Body { positions, normals, uvs, mut colors, color_codes, triangles, polygons, polygon_corners, .. } = body;
    colors.iter_mut().for_each(|c| *c = linear_color(*c, color_codes));
    let triangles = if polygons.is_empty() {
        triangles
    } else {
        // Put the polygons' triangles where the polygons stood.
        let mut all = Vec::with_capacity(triangles.len() + 2 * polygons.len());
        let mut done = 0;
        for p in &polygons {
            all.extend_from_slice(&triangles[done..p.before]);
            done = p.before;
            let corner = |i: usize| polygon_corners[p.corners.start + i];
            let point = |i: usize| positions[corner(i) as usize];
            polygon::triangulate(p.corners.len(), point, |t| all.push(t.map(corner)));
        }
        all.extend_from_slice(&triangles[done..]);
        all
    };
    MeshData { positions, normals, uvs, colors, triangles, ..MeshData::default() }
}

/// IEC 61966-2-1.
fn srgb_to_linear(coded: f32) -> f32 {
    let c = f64::from(coded);
    (if c <= 0.04045 { c / 12.92 } else { pow((c + 0.055) / 1.055, 2.4) }) as f32
}

/// Whole numbers are codes of sRGB, floats are linear; what is no number or negative is 0.
fn linear_color(stored: Vec3, codes: f32) -> Vec3 {
    let lane = |c: f32| match codes {
        0.0 => c,
        most => srgb_to_linear(c / most),
    };
    let sound = |c: f32| if c.is_finite() { c.max(0.0) } else { 0.0 };
    Vec3::from_array(stored.to_array().map(|c| sound(lane(c))))
}
