//! One index per corner: each different (position, texture coordinate, normal) becomes one vertex, in order of first use.

use super::polygon::triangulate;
use super::statements::{NONE, Statements};
use kirkas_geometry::hash::mix64;
use kirkas_geometry::{Vec2, Vec3};
use kirkas_scene::{Diagnostic, MeshData, MeshPart};
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// Fast and the same everywhere. The map is only looked up, never iterated.
#[derive(Default)]
struct Mix(u64);

impl Hasher for Mix {
    fn finish(&self) -> u64 {
        self.0
    }
    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&b| self.write_u64(b.into()));
    }
    fn write_u32(&mut self, v: u32) {
        self.write_u64(v.into());
    }
    fn write_u64(&mut self, v: u64) {
        self.0 = mix64(self.0.rotate_left(32) ^ v);
    }
}

/// Turn statements into a mesh; `defined` says which material names exist.
pub(super) fn unify(all: &Statements, defined: impl Fn(&str) -> bool) -> Result<MeshData, Diagnostic> {
    let mut mesh = MeshData::default();
    let has_uvs = all.corners.iter().any(|c| c[1] != NONE);
    let has_normals = all.corners.iter().any(|c| c[2] != NONE);

    // Number the different corners in order of first use.
    let mut plain = vec![NONE; if has_uvs || has_normals { 0 } else { all.positions.len() }];
    let mut seen: HashMap<(u32, u32, u32), u32, BuildHasherDefault<Mix>> = HashMap::default();
    let mut vertices = Vec::with_capacity(all.corners.len());
    for &[p, t, n] in &all.corners {
        let fresh = mesh.positions.len() as u32;
        let slot = if plain.is_empty() { seen.entry((p, t, n)).or_insert(NONE) } else { &mut plain[p as usize] };
        if *slot == NONE {
            if fresh == NONE {
                return Err(Diagnostic::error("too-large", "the mesh has more than 4294967295 different vertices"));
            }
            *slot = fresh;
            mesh.positions.push(all.positions[p as usize]);
            if !all.colors.is_empty() {
                mesh.colors.push(all.colors.get(p as usize).copied().unwrap_or(Vec3::ONE));
            }
            if has_uvs {
                mesh.uvs.push(all.uvs.get(t as usize).copied().unwrap_or(Vec2::ZERO));
            }
            if has_normals {
                mesh.normals.push(all.normals.get(n as usize).copied().unwrap_or(Vec3::ZERO));
            }
        }
        vertices.push(*slot);
    }

    // Cut polygons into triangles, and note where materials change.
    let mut switches = all.switches.iter().peekable();
    let mut material: Option<String> = None;
    let mut first = 0;
    for (i, face) in all.faces.iter().enumerate() {
        while let Some((_, name)) = switches.next_if(|s| s.0 <= i) {
            close_part(&mut mesh, &material, first);
            first = mesh.triangles.len();
            material = Some(name.text().into_owned()).filter(|n| defined(n));
        }
        let end = all.faces.get(i + 1).map_or(vertices.len(), |f| f.first);
        let corners = &vertices[face.first..end];
        let (positions, triangles) = (&mesh.positions, &mut mesh.triangles);
        triangulate(
            corners.len(),
            |c| positions[corners[c] as usize],
            |[a, b, c]| triangles.push([corners[a], corners[b], corners[c]]),
        );
    }
    close_part(&mut mesh, &material, first);
    Ok(mesh)
}

fn close_part(mesh: &mut MeshData, material: &Option<String>, first: usize) {
    let count = mesh.triangles.len() - first;
    let Some(material) = material.as_ref().filter(|_| count > 0) else { return };
    match mesh.parts.last_mut() {
        Some(p) if p.material == *material && (p.first + p.count) as usize == first => p.count += count as u32,
        _ => mesh.parts.push(MeshPart { material: material.clone(), first: first as u32, count: count as u32 }),
    }
}
