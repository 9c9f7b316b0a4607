//! Writing.

use kirkas_scene::MeshData;

/// A mesh as binary little-endian PLY, with normals and texture coordinates if it has them. Materials are left out: the
/// format has none.
pub fn write_binary(mesh: &MeshData) -> Vec<u8> {
    let (vertices, faces) = (mesh.positions.len(), mesh.triangles.len());
    let has_normals = mesh.normals.len() == vertices && vertices > 0;
    let has_uvs = mesh.uvs.len() == vertices && vertices > 0;
    let mut header = String::from("ply\nformat binary_little_endian 1.0\ncomment written by Kirkas\n");
    header += &format!("element vertex {vertices}\n");
    let mut properties = vec!["x", "y", "z"];
    properties.extend(if has_normals { &["nx", "ny", "nz"][..] } else { &[] });
    properties.extend(if has_uvs { &["u", "v"][..] } else { &[] });
    for p in &properties {
        header += &format!("property float {p}\n");
    }
    header += &format!("element face {faces}\nproperty list uchar int vertex_indices\nend_header\n");
    let mut out = Vec::with_capacity(header.len() + 4 * properties.len() * vertices + 13 * faces);
    out.extend_from_slice(header.as_bytes());
    let put = |numbers: &[f32], out: &mut Vec<u8>| numbers.iter().for_each(|v| out.extend(v.to_le_bytes()));
    for i in 0..vertices {
        put(&mesh.positions[i].to_array(), &mut out);
        if has_normals {
            put(&mesh.normals[i].to_array(), &mut out);
        }
        if has_uvs {
            put(&mesh.uvs[i].to_array(), &mut out);
        }
    }
    for t in &mesh.triangles {
        out.push(3);
        t.iter().for_each(|i| out.extend(i.to_le_bytes()));
    }
    out
}
