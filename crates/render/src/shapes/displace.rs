//! Displacement by tessellation: triangles are cut into four, as often as told, and their vertices moved along the normals.
//!
//! Vertices at the same place move to the same place, although files split them where texture coordinates or normals differ: so
//! no crack opens. Cook 1984, "Shade Trees" (displacement maps).

use super::ShapeInput;
use super::analytic::degenerate;
use super::mesh::{homes, smooth_normals};
use crate::textures::{NumberSource, Patch, TexturePoint};
use kirkas_geometry::{Vec2, Vec3};
use kirkas_scene::spec::ANY;
use kirkas_scene::{Diagnostic, Fallback, MeshData, ParamSpec, ParamType};
use std::collections::HashMap;

/// The row `displacement`.
pub(super) const DISPLACEMENT: ParamSpec = ParamSpec::new(
    "displacement",
    ParamType::NumberTexture,
    Fallback::Absent,
    "A texture, or a number, that moves the vertices along their normals.",
);
/// The row `displacement_scale`.
pub(super) const SCALE: ParamSpec = ParamSpec::number("displacement_scale", 1.0, "How far a displacement of 1 moves.")
    .unit("units of the mesh")
    .range(ANY);
/// The row `displacement_middle`.
pub(super) const MIDDLE: ParamSpec =
    ParamSpec::number("displacement_middle", 0.0, "The displacement that leaves a vertex where it is.").range(ANY);
/// The row `subdivisions`.
pub(super) const SUBDIVISIONS: ParamSpec = ParamSpec::integer(
    "subdivisions",
    0,
    (0.0, 10.0),
    "How often each triangle is cut into four: the detail that a displacement can show.",
);

/// More triangles are refused.
const MOST_TRIANGLES: usize = 1 << 26;

/// Cut and move as the parameters say; true if vertices moved. In object space.
pub(super) fn displace(data: &mut MeshData, input: &ShapeInput) -> Result<bool, Diagnostic> {
    let p = &input.params;
    let levels = p.integer("subdivisions") as u32;
    let many = data.triangles.len().saturating_mul(4_usize.saturating_pow(levels));
    if levels > 0 && many > MOST_TRIANGLES {
        let what = format!("{levels} subdivisions of {} triangles make {many}", data.triangles.len());
        return Err(degenerate(input, "subdivisions", what, "too many")
            .help(format!("choose fewer subdivisions: at most {MOST_TRIANGLES} triangles are made")));
    }
    for _ in 0..levels {
        cut_in_four(data);
    }
    if !p.has("displacement") {
        return Ok(false);
    }
    let height = input.textures.names().number(p, "displacement");
    move_vertices(data, height, input);
    Ok(true)
}

fn cut_in_four(data: &mut MeshData) {
    // Looked up, never walked.
    let mut middles: HashMap<(u32, u32), u32> = HashMap::with_capacity(data.triangles.len() * 3 / 2);
    let mut triangles = Vec::with_capacity(data.triangles.len() * 4);
    for t in std::mem::take(&mut data.triangles) {
        let [ab, bc, ca] = [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])].map(|(a, b)| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| add_middle(data, a as usize, b as usize))
        });
        triangles.extend([[t[0], ab, ca], [ab, t[1], bc], [ca, bc, t[2]], [ab, bc, ca]]);
    }
    data.triangles = triangles;
    for part in &mut data.parts {
        (part.first, part.count) = (part.first * 4, part.count * 4);
    }
}

/// The vertex half-way between two. Sums of two are the same in either order, so seams stay closed.
fn add_middle(data: &mut MeshData, a: usize, b: usize) -> u32 {
    data.positions.push((data.positions[a] + data.positions[b]) * 0.5);
    if !data.normals.is_empty() {
        let sum = data.normals[a].as_dvec3() + data.normals[b].as_dvec3();
        data.normals.push(sum.normalize_or_zero().as_vec3());
    }
    if !data.uvs.is_empty() {
        let middle: Vec2 = (data.uvs[a] + data.uvs[b]) * 0.5;
        data.uvs.push(middle);
    }
    if !data.colors.is_empty() {
        data.colors.push((data.colors[a] + data.colors[b]) * 0.5);
    }
    data.positions.len() as u32 - 1
}

fn move_vertices(data: &mut MeshData, height: NumberSource, input: &ShapeInput) {
    let (scale, middle) = (input.params.number("displacement_scale"), input.params.number("displacement_middle"));
    let count = data.positions.len();
    let has_normals = data.normals.iter().any(|n| *n != Vec3::ZERO);
    let normals = if has_normals { std::mem::take(&mut data.normals) } else { smooth_normals(data) };
    data.normals = Vec::new();

    // What each copy of a vertex says; then all copies of a place move by their mean.
    let homes = homes(&data.positions);
    let (mut heights, mut copies) = (vec![0.0_f64; count], vec![0.0_f64; count]);
    let mut directions = vec![kirkas_geometry::DVec3::ZERO; count];
    for i in 0..count {
        let position = data.positions[i].as_dvec3();
        let patch = Patch {
            object_normal: normals[i],
            world_normal: normals[i],
            color: data.colors.get(i).map_or([0.0; 4], |c| c.extend(1.0).to_array()),
            ..Patch::POINT
        };
        let at = TexturePoint {
            uv: data.uvs.get(i).map_or([0.0; 2], |uv| uv.to_array()),
            object_position: position,
            world_position: input.part_from_object.transform_point3(position),
            patch,
        };
        let home = homes[i] as usize;
        heights[home] += f64::from(input.textures.number(height, &at));
        copies[home] += 1.0;
        directions[home] += normals[i].as_dvec3();
    }
    for (position, &home) in data.positions.iter_mut().zip(&homes) {
        let home = home as usize;
        let far = (heights[home] / copies[home] - middle) * scale;
        *position = (position.as_dvec3() + directions[home].normalize_or_zero() * far).as_vec3();
    }
}
