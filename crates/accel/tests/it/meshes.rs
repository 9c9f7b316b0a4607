//! Closed meshes.

use kirkas_geometry::Vec3;
use std::collections::HashMap;

/// Vertices and faces.
pub type Mesh = (Vec<Vec3>, Vec<[u32; 3]>);

/// A cube of 12 triangles, its corners at +-1.
pub fn cube() -> Mesh {
    let p = (0..8).map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * 2.0 - 1.0).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    (p, quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect())
}

/// An octahedron, its faces split `levels` times and pushed out to the unit sphere.
pub fn ball(levels: u32) -> Mesh {
    let mut p = vec![Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z];
    let mut f: Vec<[u32; 3]> =
        vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    for _ in 0..levels {
        let mut middles: HashMap<(u32, u32), u32> = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                p.push((p[a as usize] + p[b as usize]).normalize());
                p.len() as u32 - 1
            })
        };
        f = f
            .iter()
            .flat_map(|&[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    (p, f)
}

/// The same faces over other vertices.
pub fn mapped(mesh: &Mesh, f: impl Fn(Vec3) -> Vec3) -> Mesh {
    (mesh.0.iter().map(|&p| f(p)).collect(), mesh.1.clone())
}
