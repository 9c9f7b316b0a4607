//! # mesh
//!
//! Triangles over shared vertices, from an OBJ or PLY file or written in place. Both sides are seen; the outside is where the
//! vertices of a triangle run counter-clockwise, also after a mirroring transform.
//!
//! ## Parameters
//! - `file` (path): an OBJ or PLY file; OBJ materials come along where the object names no `material`.
//! - `vertices` (points, scene units): instead of a file.
//! - `faces` (whole numbers, three per triangle, from 0): which vertices make each triangle; with `vertices`.
//! - `uvs` (numbers, two per vertex): texture coordinates; with `vertices`.
//! - `normals` (`"file"`, `"smooth"` or `"flat"`, default `"file"`): shading normals: those of the file, if it has any, else
//!   flat; the mean of the faces around each vertex; or none.
//! - `subdivisions` (whole number, 0 to 10, default 0): how often each triangle is cut into four.
//! - `displacement` (number or texture): moves the vertices along their normals; shading normals are then computed anew.
//! - `displacement_scale` (number, units of the mesh, default 1): how far a displacement of 1 moves.
//! - `displacement_middle` (number, default 0): the displacement that leaves a vertex where it is.
//!
//! ## Example
//! ```toml
//! [objects.roof]
//! type = "mesh"
//! vertices = [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1], [0, 1, 0]]
//! faces = [0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4]
//! normals = "flat"
//! ```
//!
//! ## Limits
//! Vertices are rounded to f32 (about 7 digits) after the transform. Triangles without area are never hit. A displacement shows no
//! detail finer than the triangles: picture and subdivisions should match. Other shapes are not displaced: give them as a mesh.
//!
//! ## References
//! Smooth normals: Max, "Weights for Computing Vertex Normals from Facet Normals", 1999. Intersection: Woop, Benthin & Wald,
//! "Watertight Ray/Triangle Intersection", 2013.

use super::analytic::degenerate;
use super::displace;
use super::triangles::{PlacedMesh, TriangleSurface};
use super::{Part, ShapeInput};
use kirkas_geometry::hash::mix64;
use kirkas_geometry::transform::transform_normal;
use kirkas_geometry::{DAffine3, DVec3, Vec2, Vec3};
use kirkas_scene::{Diagnostic, Fallback, Kind, MeshData, MeshPart, ParamSpec, ParamType, TypeSpec};
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};
use std::sync::Arc;

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Object,
    name: "mesh",
    doc: "Triangles, from a file or written in place.",
    params: &[
        ParamSpec::new("file", ParamType::Path, Fallback::Absent, "An OBJ or PLY file."),
        ParamSpec::new("vertices", ParamType::Vectors, Fallback::Absent, "Points, instead of a file.")
            .unit("scene units"),
        ParamSpec::new("faces", ParamType::Numbers, Fallback::Absent, "Three vertices per triangle, counted from 0.")
            .range((0.0, u32::MAX as f64)),
        ParamSpec::new("uvs", ParamType::Numbers, Fallback::Absent, "Texture coordinates, two per vertex."),
        ParamSpec::choice("normals", &["file", "smooth", "flat"], "Which shading normals to use."),
        displace::SUBDIVISIONS,
        displace::DISPLACEMENT,
        displace::SCALE,
        displace::MIDDLE,
    ],
};

/// Builds it.
pub fn build(input: &ShapeInput) -> Result<Vec<Part>, Diagnostic> {
    let params = &input.params;
    let normals = match params.text("normals") {
        Some("smooth") => Normals::Smooth,
        Some("flat") => Normals::Flat,
        _ => Normals::File,
    };
    match (params.text("file"), params.has("vertices")) {
        (Some(file), false) => {
            let data = input.assets.mesh(input.source, file).map_err(|d| d.at(params.span("file"), "named here"))?;
            build_mesh(Source::File(data), normals, input)
        }
        (None, true) => {
            let exact = points(input, "vertices");
            let data = inline_mesh(input, &exact)?;
            build_mesh(Source::Inline { data: Box::new(data), exact: &exact }, normals, input)
        }
        (Some(_), true) => Err(degenerate(input, "file", "it has both a file and vertices".into(), "one too many")
            .help("remove `file`, or remove `vertices`")),
        (None, false) => Err(degenerate(input, "file", "it has neither a file nor vertices".into(), "no triangles")
            .help("add `file = \"model.ply\"`, or `vertices` and `faces`")),
    }
}

/// Which shading normals to use.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Normals {
    /// The mesh's own, if any.
    File,
    /// Computed.
    Smooth,
    /// None.
    Flat,
}

/// Where the triangles come from.
pub(super) enum Source<'a> {
    /// A file, perhaps shared by several objects.
    File(Arc<MeshData>),
    /// The description: the vertices as they were written replace the rounded ones.
    Inline { data: Box<MeshData>, exact: &'a [DVec3] },
}

fn inline_mesh(input: &ShapeInput, vertices: &[DVec3]) -> Result<MeshData, Diagnostic> {
    let faces = numbers(input, "faces").unwrap_or_default();
    if faces.is_empty() || !faces.len().is_multiple_of(3) {
        let what = format!("`faces` has {} numbers", faces.len());
        return Err(degenerate(input, "faces", what, "not three per triangle")
            .help("write the numbers of three vertices for each triangle: `faces = [0, 1, 2]`"));
    }
    let count = vertices.len();
    if let Some(i) = faces.iter().position(|&i| i.fract() != 0.0 || !(i >= 0.0 && i < count as f64)) {
        let what = format!("`faces` names vertex {}, but there are {count}", faces[i]);
        return Err(degenerate(input, "faces", what, format!("triangle {}", i / 3).as_str())
            .help(format!("vertices count from 0 to {}", count.saturating_sub(1))));
    }
    let uvs = numbers(input, "uvs").unwrap_or_default();
    if !uvs.is_empty() && uvs.len() != 2 * count {
        let what = format!("`uvs` has {} numbers for {count} vertices", uvs.len());
        return Err(degenerate(input, "uvs", what, "not two per vertex").help("write two numbers for each vertex"));
    }
    Ok(MeshData {
        positions: vertices.iter().map(|v| v.as_vec3()).collect(),
        uvs: pairs(&uvs),
        triangles: faces.chunks_exact(3).map(|f| [f[0] as u32, f[1] as u32, f[2] as u32]).collect(),
        ..MeshData::default()
    })
}

/// Places a mesh and splits it by material.
pub(super) fn build_mesh(source: Source, normals: Normals, input: &ShapeInput) -> Result<Vec<Part>, Diagnostic> {
    let m = &input.part_from_object;
    let (mut data, exact) = match source {
        // Whoever reads last keeps it: then nothing is copied.
        Source::File(data) => (Arc::try_unwrap(data).unwrap_or_else(|shared| (*shared).clone()), None),
        Source::Inline { data, exact } => (*data, Some(exact)),
    };
    let broken = |what: String| {
        let name = if input.params.spec().name == "mesh" { "file" } else { "vertices" };
        degenerate(input, name, what, "cannot be used").help("mend the mesh where it was made, and write it again")
    };
    data.validate().map_err(broken)?;
    if data.triangles.is_empty() {
        return Err(broken("it has no triangles".into()));
    }

    // Place the vertices.
    let is_identity = *m == DAffine3::IDENTITY;
    let is_mesh = input.params.spec().name == "mesh";
    let is_cut = is_mesh && (input.params.has("displacement") || input.params.integer("subdivisions") > 0);
    let (mut normals, mut exact) = (normals, exact);
    if is_cut {
        exact = None;
        if displace::displace(&mut data, input)? && normals == Normals::File {
            normals = Normals::Smooth;
        }
    }
    match exact {
        Some(exact) => data.positions.iter_mut().zip(exact).for_each(|(p, e)| *p = m.transform_point3(*e).as_vec3()),
        None if !is_identity => {
            data.positions.iter_mut().for_each(|p| *p = m.transform_point3(p.as_dvec3()).as_vec3());
        }
        None => {}
    }
    if let Some(i) = data.positions.iter().position(|p| !p.is_finite()) {
        return Err(broken(format!("vertex {i} lies beyond what f32 holds")));
    }

    // Keep the outside outside.
    if m.matrix3.determinant() < 0.0 {
        data.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }

    let shading = match normals {
        Normals::Flat => Vec::new(),
        Normals::Smooth => smooth_normals(&data),
        Normals::File if is_identity => core::mem::take(&mut data.normals),
        Normals::File => {
            let object_from_part = m.inverse();
            let placed = |n: &Vec3| transform_normal(&object_from_part, n.as_dvec3()).normalize_or_zero().as_vec3();
            data.normals.iter().map(placed).collect()
        }
    };

    let runs = runs(&data.parts, data.triangles.len());
    let MeshData { positions, uvs, colors, mut triangles, .. } = data;
    let mesh = Arc::new(PlacedMesh {
        positions: Arc::new(positions),
        normals: shading,
        uvs,
        colors,
        object_from_part: m.inverse(),
    });
    Ok(runs
        .iter()
        .map(|(range, material)| {
            let indices =
                if runs.len() == 1 { core::mem::take(&mut triangles) } else { triangles[range.clone()].to_vec() };
            TriangleSurface::part(mesh.clone(), indices, material.clone())
        })
        .collect())
}

/// The parts in order, with what lies between them, which has no material.
fn runs(parts: &[MeshPart], count: usize) -> Vec<(core::ops::Range<usize>, Option<String>)> {
    let mut sorted: Vec<&MeshPart> = parts.iter().filter(|p| p.count > 0).collect();
    sorted.sort_by_key(|p| p.first);
    let mut runs = Vec::new();
    let mut at = 0;
    for part in sorted {
        let start = (part.first as usize).clamp(at, count);
        let end = (part.first as usize).saturating_add(part.count as usize).clamp(start, count);
        if at < start {
            runs.push((at..start, None));
        }
        if start < end {
            runs.push((start..end, Some(part.material.clone())));
        }
        at = end;
    }
    if at < count {
        runs.push((at..count, None));
    }
    runs
}

/// For each vertex the first one at the same place.
pub(super) fn homes(positions: &[Vec3]) -> Vec<u32> {
    let mut seen = HashMap::with_capacity_and_hasher(positions.len(), BuildHasherDefault::<Mix>::default());
    // Adding zero makes one of both zeros. Only looked up, never walked: the order of the map does not matter.
    let key = |p: &Vec3| (*p + Vec3::ZERO).to_array().map(f32::to_bits);
    positions.iter().enumerate().map(|(i, p)| *seen.entry(key(p)).or_insert(i as u32)).collect()
}

/// The mean of the normals around each vertex, weighted so that it is exact on a sphere (Max 1999). Vertices at the same
/// place count as one, although files split them where texture coordinates or normals differ.
pub(super) fn smooth_normals(data: &MeshData) -> Vec<Vec3> {
    let split = !data.uvs.is_empty() || !data.normals.is_empty();
    let first: Vec<u32> = if split { homes(&data.positions) } else { Vec::new() };
    let home = |i: u32| if split { first[i as usize] } else { i } as usize;
    let mut sums = vec![DVec3::ZERO; data.positions.len()];
    for t in &data.triangles {
        let p = t.map(|i| data.positions[i as usize].as_dvec3());
        for k in 0..3 {
            let (e1, e2) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
            let weighted = e1.cross(e2) / (e1.length_squared() * e2.length_squared());
            if weighted.is_finite() {
                sums[home(t[k])] += weighted;
            }
        }
    }
    (0..data.positions.len() as u32).map(|i| sums[home(i)].normalize_or_zero().as_vec3()).collect()
}

/// A fast hash: positions are no attackers.
#[derive(Default)]
struct Mix(u64);

impl Hasher for Mix {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let word = chunk.iter().fold(0, |w, &b| w << 8 | u64::from(b));
            self.0 = mix64(self.0 ^ word);
        }
    }
}

/// A list of points; empty if not written.
pub(super) fn points(input: &ShapeInput, name: &str) -> Vec<DVec3> {
    let node = input.params.entity.params.get(name);
    let list = node.and_then(|n| n.list()).unwrap_or_default();
    list.iter().filter_map(|n| n.numbers::<3>()).map(DVec3::from_array).collect()
}

/// A list of numbers, if written.
pub(super) fn numbers(input: &ShapeInput, name: &str) -> Option<Vec<f64>> {
    let list = input.params.entity.params.get(name)?.list()?;
    Some(list.iter().filter_map(|n| n.number()).collect())
}

/// Numbers, two by two.
pub(super) fn pairs(numbers: &[f64]) -> Vec<Vec2> {
    numbers.chunks_exact(2).map(|c| Vec2::new(c[0] as f32, c[1] as f32)).collect()
}
