//! As much of a pbrt-v4 file as gives its triangles and its camera: `Transform`, `plymesh`, `trianglemesh`, `fov`.

use super::{Scene, Soup, read, say};
use kirkas_accel::ray_sets::Pinhole;
use kirkas_formats::ply;
use kirkas_geometry::elementary::tan;
use kirkas_geometry::{DAffine3, DMat3, DVec3, Vec3};
use std::path::Path;

/// The scene in `folder/scene-v4.pbrt`. Everything but the shapes named above is passed over.
pub fn load(name: &str, folder: &Path) -> Result<Scene, String> {
    let path = folder.join("scene-v4.pbrt");
    let text = String::from_utf8_lossy(&read(&path)?).into_owned();
    let words = words(&text);
    let wrong = |what: &str| format!("{}: {what}", path.display());

    let mut soup = Soup::default();
    let (mut world_from_object, mut kept) = (DAffine3::IDENTITY, Vec::new());
    let (mut world_from_camera, mut fov) = (DAffine3::IDENTITY, 90.0);
    for (k, word) in words.iter().enumerate() {
        let after = &words[k + 1..];
        match *word {
            "Transform" => {
                world_from_object = transform(after).ok_or_else(|| wrong("`Transform` without 16 numbers"))?
            }
            "AttributeBegin" => kept.push(world_from_object),
            "AttributeEnd" => world_from_object = kept.pop().ok_or_else(|| wrong("`AttributeEnd` ends nothing"))?,
            "WorldBegin" => world_from_object = DAffine3::IDENTITY,
            "Camera" => {
                world_from_camera = world_from_object.inverse();
                fov = *numbers(parameter(after, "float fov")).first().unwrap_or(&fov);
            }
            "Shape" => {
                let place = |p: Vec3| world_from_object.transform_point3(p.as_dvec3()).as_vec3();
                match after.first() {
                    Some(&"\"plymesh\"") => {
                        let file = parameter(after, "string filename").first().map(|w| w.trim_matches('"'));
                        let file = folder.join(file.ok_or_else(|| wrong("`plymesh` without a file"))?);
                        let mesh = ply::read(&read(&file)?, &file.display().to_string()).map_err(|f| say(&file, &f))?;
                        soup.add(mesh.positions.into_iter().map(place), mesh.triangles);
                    }
                    Some(&"\"trianglemesh\"") => {
                        let points = numbers(parameter(after, "point3 P"));
                        let corners = numbers(parameter(after, "integer indices"));
                        let count = points.len() as f64 / 3.0;
                        if corners.iter().any(|c| !(0.0..count).contains(c)) {
                            return Err(wrong("`trianglemesh` names a corner that is not there"));
                        }
                        let points = points.chunks_exact(3).map(|p| Vec3::new(p[0] as f32, p[1] as f32, p[2] as f32));
                        soup.add(
                            points.map(place),
                            corners.chunks_exact(3).map(|c| [c[0] as u32, c[1] as u32, c[2] as u32]),
                        );
                    }
                    _ => {}
                }
            }
            _ => {}
        }
    }
    let half = tan(fov.to_radians() * 0.5);
    let axis = |v: DVec3| world_from_camera.transform_vector3(v).normalize();
    let camera = Pinhole {
        eye: world_from_camera.translation.as_vec3(),
        forward: axis(DVec3::Z).as_vec3(),
        right: (axis(DVec3::X) * half).as_vec3(),
        up: (axis(DVec3::Y) * half).as_vec3(),
    };
    Ok(soup.into_scene(name, camera))
}

/// Words, strings with their quotes, and brackets.
fn words(text: &str) -> Vec<&str> {
    let mut out = Vec::new();
    for line in text.lines() {
        let line = line.split('#').next().unwrap_or_default();
        for (k, piece) in line.split('"').enumerate() {
            if k % 2 == 1 {
                // The piece lies between two quotes of `line`: take them with it.
                let start = piece.as_ptr() as usize - line.as_ptr() as usize;
                out.push(line.get(start - 1..start + piece.len() + 1).unwrap_or(piece));
                continue;
            }
            for word in piece.split_whitespace() {
                out.extend(word.split_inclusive(['[', ']']).flat_map(|w| {
                    let bracket = w.len() - w.trim_end_matches(['[', ']']).len();
                    let (word, bracket) = w.split_at(w.len() - bracket);
                    [word, bracket].into_iter().filter(|p| !p.is_empty())
                }));
            }
        }
    }
    out
}

/// The values of `"type name" [ ... ]` among the words of one statement.
fn parameter<'a, 'b>(after: &'b [&'a str], name: &str) -> &'b [&'a str] {
    let is_statement = |w: &&str| w.starts_with(|c: char| c.is_ascii_uppercase());
    let end = after.iter().position(is_statement).unwrap_or(after.len());
    let Some(k) = after[..end].iter().position(|w| w.trim_matches('"') == name) else { return &[] };
    bracketed(&after[k + 1..end])
}

/// What stands between `[` and `]`, or the one word there is.
fn bracketed<'a, 'b>(after: &'b [&'a str]) -> &'b [&'a str] {
    match after.first() {
        Some(&"[") => {
            let end = after.iter().position(|w| *w == "]").unwrap_or(after.len());
            &after[1..end]
        }
        Some(_) => &after[..1],
        None => &[],
    }
}

fn numbers(words: &[&str]) -> Vec<f64> {
    words.iter().filter_map(|w| w.parse().ok()).collect()
}

/// Sixteen numbers, column by column.
fn transform(after: &[&str]) -> Option<DAffine3> {
    let m = numbers(bracketed(after));
    let column = |k: usize| DVec3::new(m[k], m[k + 1], m[k + 2]);
    let matrix = |()| DMat3::from_cols(column(0), column(4), column(8));
    (m.len() == 16).then_some(()).map(|unit| DAffine3 { matrix3: matrix(unit), translation: column(12) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_is_read_with_its_camera_and_places() {
        let folder = std::env::temp_dir().join(format!("kirkas-bench-pbrt-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let text = "Transform [1 0 0 0 0 1 0 0 0 0 -1 0 0 0 5 1]\nCamera \"perspective\" \"float fov\" [ 90 ] # wide\n\
            WorldBegin AttributeBegin Transform [ 1 0 0 0 0 1 0 0 0 0 1 0 0 2 0 1 ]\n\
            Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 ] \"point3 P\" [ 0 0 0 1 0 0\n 0 1 0 ]\nAttributeEnd\n\
            Shape \"disk\" \"float radius\" 3 Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [2 1 0]";
        std::fs::write(folder.join("scene-v4.pbrt"), text).expect("written");
        let scene = load("two", &folder).expect("sound");
        assert_eq!(*scene.indices, [[0, 1, 2], [5, 4, 3]]);
        assert_eq!((scene.positions[2], scene.positions[5]), (Vec3::new(0.0, 3.0, 0.0), Vec3::Y));
        assert_eq!((scene.camera.eye, scene.camera.forward), (Vec3::Z * 5.0, Vec3::NEG_Z));
        assert!((scene.camera.right - Vec3::X).length() < 1e-6);
        std::fs::remove_dir_all(&folder).expect("removed");
    }
}
