//! Random scenes, made from the tables, with triangles of every bad kind: every number on the film is finite, and every sample
//! that was left out is counted and located. `KIRKAS_HOSTILE_SCENES=10000` (`cargo xtask hostile`) runs more of them.

use crate::support::Rgb;
use kirkas_formats::{FormatAssets, load};
use kirkas_geometry::hash::{combine, unit_f32};
use kirkas_images::{RgbImage, Texts, write_hdr};
use kirkas_render::render::Undisturbed;
use kirkas_render::{Film, Options, catalog, prepare};
use kirkas_scene::files::{FileAccess, Limits, MemoryFiles};
use kirkas_scene::{Kind, ParamSpec, ParamType, TypeSpec};

/// What composed materials are made of.
const PARTS: [&str; 3] = ["clear", "metal", "skin"];

/// Numbers that a seed names, one after another.
struct Dice(u64);

impl Dice {
    fn bits(&mut self) -> u64 {
        self.0 = combine(self.0, 1);
        self.0
    }
    fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }
    fn unit(&mut self) -> f64 {
        f64::from(unit_f32(self.bits() as u32))
    }
    fn pick<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())]
    }
    /// Within a range, often at its ends.
    fn number(&mut self, (low, high): (f64, f64)) -> f64 {
        let wild = self.pick(&[0.0, 1.0, 1e-3, 0.5, 2.0, 1e-30, 1e3, 1e6]);
        let sign = if self.below(2) == 0 { 1.0 } else { -1.0 };
        let number = match self.below(4) {
            0 if low.is_finite() => low,
            1 if high.is_finite() => high,
            2 => wild * sign,
            _ => 4.0 * self.unit() * sign,
        };
        number.clamp(low, high)
    }
    fn numbers(&mut self, row: &ParamSpec, count: usize) -> String {
        let all: Vec<String> = (0..count).map(|_| format!("{:e}", self.number(row.range))).collect();
        format!("[{}]", all.join(", "))
    }
    /// A value for a row; `None` for what refers to other things.
    fn value(&mut self, row: &ParamSpec) -> Option<String> {
        Some(match row.ty {
            ParamType::Bool => format!("{}", self.below(2) == 0),
            ParamType::Integer => {
                format!("{}", self.number((row.range.0, row.range.1.min(3.0).max(row.range.0))) as i64)
            }
            ParamType::Number | ParamType::NumberTexture => format!("{:e}", self.number(row.range)),
            ParamType::Index if self.below(2) == 0 => {
                format!("{{ material = {:?} }}", self.pick(&["gold", "aluminium"]))
            }
            ParamType::Index => format!("{:e}", self.number(row.range)),
            ParamType::Choice(words) => format!("{:?}", self.pick(words)),
            ParamType::Vector2 => self.numbers(row, 2),
            ParamType::Vector | ParamType::VectorTexture | ParamType::Color | ParamType::ColorTexture => {
                self.numbers(row, 3)
            }
            ParamType::Gradient => {
                format!(
                    "[[-1.0, {}], [0.3, {}], [1.0, {}]]",
                    self.numbers(row, 3),
                    self.numbers(row, 3),
                    self.numbers(row, 3)
                )
            }
            ParamType::Path => "\"sky.hdr\"".into(),
            ParamType::Reference(Kind::Material) => format!("{:?}", self.pick(&PARTS)),
            ParamType::References(Kind::Material) => format!("[{:?}, {:?}]", self.pick(&PARTS), self.pick(&PARTS)),
            _ => return None,
        })
    }
    /// An entity of a type, some of its rows written.
    fn entity(&mut self, section: &str, spec: &TypeSpec, besides: &str) -> String {
        let mut text = format!("[{section}]\ntype = \"{}\"\n{besides}", spec.name);
        for row in spec.params {
            let is_required = row.fallback == kirkas_scene::Fallback::Required;
            let value = if is_required || self.below(2) == 0 { self.value(row) } else { None };
            text += &value.map_or(String::new(), |value| format!("{} = {value}\n", row.name));
        }
        text
    }
    fn point(&mut self) -> [f64; 3] {
        let scale = self.pick(&[1.0, 1.0, 1.0, 1e-6, 1e3, 1e-20]);
        std::array::from_fn(|_| (2.0 * self.unit() - 1.0) * scale)
    }
    /// An OBJ of triangles, many of them without area.
    fn mesh(&mut self) -> String {
        let mut text = String::new();
        for i in 0..12 {
            let (a, b, c) = (self.point(), self.point(), self.point());
            let middle: [f64; 3] = std::array::from_fn(|k| 0.5 * (a[k] + b[k]));
            let corners = match self.below(5) {
                0 => [a, a, b],
                1 => [a, a, a],
                2 => [a, b, middle],
                _ => [a, b, c],
            };
            for v in corners {
                text += &format!("v {} {} {}\n", v[0], v[1], v[2]);
            }
            let n = self.point();
            text += &format!("vn {} {} {}\n", n[0], n[1], n[2]);
            let (v, n) = (3 * i + 1, i + 1);
            text += &match self.below(2) {
                0 => format!("f {v} {} {}\n", v + 1, v + 2),
                _ => format!("f {v}//{n} {}//{n} {}//{n}\n", v + 1, v + 2),
            };
        }
        text
    }
    /// A scene, and the mesh beside it.
    fn scene(&mut self) -> (String, String) {
        let catalog = catalog();
        // Files of measurements are large, and have tests of their own.
        let listed = |kind| catalog.of_kind(kind).filter(|spec| spec.name != "measured").collect::<Vec<_>>();
        let mut of = |kind| self.pick(&listed(kind));
        let (integrator, background) = (of(Kind::Integrator), of(Kind::Background));
        let materials = [of(Kind::Material), of(Kind::Material), of(Kind::Material)];
        let lights = [of(Kind::Light), of(Kind::Light)];
        let seed = self.below(1000);
        let mut toml = format!(
            "[film]\nwidth = 9\nheight = 7\n[sampler]\nsamples = 3\nseed = {seed}\n\
             [cameras.c]\ntype = \"perspective\"\nposition = [0, 0.5, 4]\nlook_at = [0, 0, 0]\n"
        );
        toml += &self.entity("integrator", integrator, "");
        toml += &self.entity("background", background, "");
        for (i, light) in lights.into_iter().enumerate() {
            toml += &self.entity(&format!("lights.l{i}"), light, "");
        }
        for (i, material) in materials.into_iter().enumerate() {
            toml += &self.entity(&format!("materials.m{i}"), material, "");
        }
        toml += "[materials.clear]\ntype = \"rough_dielectric\"\n[materials.metal]\ntype = \"rough_conductor\"\nior = 0.2\nk = 3\n";
        toml += "[materials.skin]\ntype = \"principled\"\n[materials.shine]\ntype = \"emitter\"\nintensity = 3\n";
        let material = self.pick(&["m0", "m1", "m2", "shine"]);
        toml += &format!("[objects.mesh]\ntype = \"mesh\"\nfile = \"m.obj\"\nmaterial = \"{material}\"\n");
        for (i, y) in [-1.0, 0.0, 0.7].into_iter().enumerate() {
            let radius = self.pick(&[0.5, 0.9, 1e-3]);
            toml += &format!(
                "[objects.s{i}]\ntype = \"sphere\"\ncenter = [{}, {y}, 0.5]\nradius = {radius}\nmaterial = \"m{i}\"\n",
                0.6 * y
            );
        }
        (toml + "[objects.floor]\ntype = \"plane\"\npoint = [0, -1, 0]\nmaterial = \"m1\"\n", self.mesh())
    }
}

/// The film of a scene, or why it is none.
fn film_of(toml: &str, mesh: &str) -> Result<Film, String> {
    let mut files = MemoryFiles::default();
    files.0.insert("scene.toml".into(), toml.as_bytes().to_vec());
    files.0.insert("m.obj".into(), mesh.as_bytes().to_vec());
    let sky = RgbImage::from_fn(4, 2, |x, y| [x as f32, 1e4 * (x * y) as f32, 0.0]);
    files.0.insert("sky.hdr".into(), write_hdr(&sky, &Texts::default()).map_err(|e| e.to_string())?);
    let access = FileAccess::new(Box::new(files), Limits::default());
    let description = load(&access, "scene.toml").map_err(|e| format!("{e:?}"))?;
    let assets = FormatAssets::new(&access, &description.sources);
    let p = prepare(&description, &assets, &Options::default()).map_err(|e| format!("{e:?}"))?;
    let mut film = Film::new(p.film.clone());
    p.renderer(64).render(&mut film, 0..p.samples, &Undisturbed);
    Ok(film)
}

#[test]
fn random_scenes_give_numbers_or_say_where_not() {
    let count: u64 = std::env::var("KIRKAS_HOSTILE_SCENES").ok().and_then(|s| s.parse().ok()).unwrap_or(150);
    let (mut rendered, mut with_invalid, mut refused) = (0, 0, String::new());
    for seed in 0..count {
        let (toml, mesh) = Dice(seed).scene();
        let film = match film_of(&toml, &mesh) {
            Ok(film) => film,
            Err(why) => {
                refused = why;
                continue;
            }
        };
        rendered += 1;
        let mut located = 0;
        for tile in &film.tiles {
            for i in 0..tile.counts.len() {
                let (c, mean): (_, Rgb) = (&tile.counts[i], tile.moments(i).0);
                assert!(mean.iter().all(|v| v.is_finite()), "scene {seed}: {mean:?}");
                assert!(c.taken == 3 && c.invalid <= 3, "scene {seed}");
            }
            let here: u32 = tile.counts.iter().map(|c| c.invalid).sum();
            assert_eq!(tile.invalid.len(), (here as usize).min(16), "scene {seed}");
            for id in &tile.invalid {
                let i = (id.y - tile.rect.y0) * tile.rect.width() + id.x - tile.rect.x0;
                assert!(id.sample < 3 && tile.counts[i as usize].invalid > 0, "scene {seed}: {id:?}");
            }
            located += tile.invalid.len();
        }
        if located > 0 {
            with_invalid += 1;
            println!("scene {seed}: {} samples left out", film.invalid_samples());
        }
    }
    println!("{rendered} of {count} scenes rendered, {with_invalid} with samples left out");
    assert!(rendered > count / 5 * 4, "{refused}");
}
