//! Scenes: triangles in world space and a place to look from.

mod generated;
mod pbrt;

use kirkas_accel::ray_sets::Pinhole;
use kirkas_formats::{Failure, obj};
use kirkas_geometry::{Bounds3, Vec3};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A scene.
pub struct Scene {
    /// Its name in tables and rows.
    pub name: String,
    /// Vertices.
    pub positions: Arc<Vec<Vec3>>,
    /// Corners of each triangle.
    pub indices: Arc<Vec<[u32; 3]>>,
    /// Where primary rays start.
    pub camera: Pinhole,
}

impl Scene {
    /// The box around it.
    pub fn bounds(&self) -> Bounds3 {
        Bounds3::around(self.positions.iter().copied())
    }
}

/// Triangles while they are gathered.
#[derive(Default)]
struct Soup {
    positions: Vec<Vec3>,
    indices: Vec<[u32; 3]>,
}

impl Soup {
    fn add(&mut self, positions: impl IntoIterator<Item = Vec3>, triangles: impl IntoIterator<Item = [u32; 3]>) {
        let first = self.positions.len() as u32;
        self.positions.extend(positions);
        self.indices.extend(triangles.into_iter().map(|t| t.map(|k| k + first)));
    }

    fn quad(&mut self, corners: [Vec3; 4]) {
        self.add(corners, [[0, 1, 2], [0, 2, 3]]);
    }

    fn into_scene(self, name: &str, camera: Pinhole) -> Scene {
        Scene { name: name.into(), positions: Arc::new(self.positions), indices: Arc::new(self.indices), camera }
    }
}

/// The scene of this name; `None` when it needs files and `KIRKAS_DATA` names no folder.
pub fn load(name: &str) -> Result<Option<Scene>, String> {
    let data = std::env::var_os("KIRKAS_DATA").filter(|d| !d.is_empty()).map(PathBuf::from);
    let data = data.as_deref();
    let of_pbrt = |folder: &str| data.map(|d| pbrt::load(name, &d.join("pbrt-v4").join(folder))).transpose();
    match name {
        "stadium" => match data {
            Some(data) => Ok(Some(generated::stadium("stadium", bunny(data)?))),
            None => Ok(Some(generated::stadium("stadium-sphere", generated::sphere(70_000)))),
        },
        "bunny" => data.map(|d| Ok(bunny_alone(bunny(d)?))).transpose(),
        "coffee" | "staircase2" => of_pbrt(name),
        _ => {
            let count = name.strip_prefix("sphere-").and_then(number).filter(|n| (8..=1_000_000_000).contains(n));
            let count =
                count.ok_or_else(|| format!("no scene `{name}`: sphere-N, stadium, bunny, coffee, staircase2"))?;
            Ok(Some(generated::sphere_in_a_box(name, count)))
        }
    }
}

/// `20k` or `5m`: thousands and millions.
fn number(text: &str) -> Option<usize> {
    let (digits, unit) = match text.as_bytes().last()? {
        b'k' => (&text[..text.len() - 1], 1000),
        b'm' => (&text[..text.len() - 1], 1_000_000),
        _ => (text, 1),
    };
    digits.parse::<usize>().ok()?.checked_mul(unit)
}

/// Stanford's bunny as it was scanned, in metres; its middle is 0.11 above its origin.
fn bunny(data: &Path) -> Result<Soup, String> {
    let path = data.join("meshes/stanford-bunny.obj");
    let mesh = obj::read(&read(&path)?, &path.display().to_string(), &mut |_| Ok(Arc::from(&[][..])));
    let mesh = mesh.map_err(|f| say(&path, &f))?;
    Ok(Soup { positions: mesh.positions, indices: mesh.triangles })
}

fn bunny_alone(mut soup: Soup) -> Scene {
    let (half, floor) = (0.4, 0.033);
    soup.quad([(-half, -half), (half, -half), (half, half), (-half, half)].map(|(x, z)| Vec3::new(x, floor, z)));
    let camera = Pinhole::look_at(Vec3::new(0.1, 0.2, 0.35), Vec3::new(-0.017, 0.1, 0.0), 0.3);
    soup.into_scene("bunny", camera)
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    std::fs::read(path).map_err(|e| format!("{}: {e}", path.display()))
}

fn say(path: &Path, failure: &Failure) -> String {
    let first = failure.diagnostics.first().map_or("cannot be read", |d| d.message.as_str());
    format!("{}: {first}", path.display())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_part_of_a_spheres_name() {
        let scene = load("sphere-2k").expect("sound").expect("needs no files");
        assert!((1900..2100).contains(&scene.indices.len()), "{}", scene.indices.len());
        let far = |p: &&Vec3| p.abs().max_element() > 2.0;
        assert_eq!(scene.positions.iter().filter(far).count(), 0, "all within the box");
        assert!(load("sphere-").is_err() && load("teapot").is_err());
    }
}
