//! Lit spheres: a material as the renderer shows it, always in the same light.

use super::material::Matter;
use super::sheet::pack;
use crate::conductor::Conductor;
use crate::pictures::codes;
use crate::problem::Problem;
use crate::progress::Progress;
use kirkas_images::RgbImage;
use kirkas_plot::Picture;
use kirkas_render::{Film, Options, prepare};
use kirkas_scene::{Description, Entity, Kind, Map, Node, Value};

/// How spheres are shown on a screen.
const TONE: &str = "aces";
const EXPOSURE: f32 = -0.5;
/// The most that one path brings: light thrown onto the floor by the ball would speckle it.
const CLAMP: f64 = 3.0;
/// Pixels of a sphere to a point of the sheet.
const PIXELS_PER_POINT: f64 = 1.5;

/// How spheres are rendered.
#[derive(Clone, Debug, clap::Args)]
pub struct StudioArgs {
    /// Samples per pixel of spheres
    #[arg(long, value_name = "N", default_value_t = 32, value_parser = clap::value_parser!(u32).range(1..65536))]
    spp: u32,
    /// Show no progress
    #[arg(long)]
    quiet: bool,
}

/// One sphere for each material, for a place of `side` points on a sheet.
pub fn spheres(materials: &[Matter], side: f64, args: &StudioArgs) -> Result<Vec<RgbImage>, Problem> {
    let side = (side * PIXELS_PER_POINT).round() as u32;
    let progress = Progress::new(args.quiet, Some(materials.len()));
    let one = |(i, matter): (usize, &Matter)| {
        progress.begin(i as u32);
        let description = scene(matter, side, args.spp);
        let prepared =
            prepare(&description, &matter.file.assets(), &Options::default()).map_err(|d| matter.file.failure(d))?;
        let mut film = Film::new(prepared.film.clone());
        let bar = progress.picture(u64::from(side) * u64::from(side) * u64::from(args.spp), 0);
        let conductor = Conductor::new(bar, None, None);
        conductor.render(&prepared.renderer(256), &mut film, 0..args.spp);
        conductor.finish(&film, args.spp)?;
        progress.end(false);
        Ok(film.to_rgb())
    };
    materials.iter().enumerate().map(one).collect()
}

/// A sphere on a sheet.
pub fn framed(image: &RgbImage, place: [f64; 4]) -> Picture {
    let pixels = codes(image, TONE, EXPOSURE);
    let png = pack(image.width, image.height, &pixels);
    Picture { place, width: image.width, height: image.height, pixels, png }
}

/// The luminance of every pixel as a screen shows it, 0..1.
pub fn shown_luminance(image: &RgbImage) -> Vec<f64> {
    let luminance = |c: &[u8]| 0.2126 * f64::from(c[0]) + 0.7152 * f64::from(c[1]) + 0.0722 * f64::from(c[2]);
    codes(image, TONE, EXPOSURE).chunks_exact(3).map(|c| luminance(c) / 255.0).collect()
}

fn scene(matter: &Matter, side: u32, spp: u32) -> Description {
    let mut scene = matter.file.description.clone();
    let name = |kind: Kind, base: &str| scene.free_name(kind, base);
    let (floor, tiles) = (name(Kind::Material, "floor"), name(Kind::Texture, "tiles"));
    let lamps = [name(Kind::Material, "key"), name(Kind::Material, "window")];

    let side = i64::from(side);
    let film = Map::default().with("width", side).with("height", side).with("color", matter.lanes().mode().name());
    let film = film.with("clamp", CLAMP);
    let camera = Map::default().with("position", [0.0, 2.5, 5.9]).with("look_at", [0.0, -0.06, 0.0]).with("fov", 21.5);
    let single = |scene: &mut Description, kind: Kind, type_name: &str, params: Map| {
        *scene.all_mut(kind) = vec![Entity::new("", type_name, params)];
    };
    single(&mut scene, Kind::Film, "image", film);
    single(&mut scene, Kind::Sampler, "sobol", Map::default().with("samples", i64::from(spp)));
    single(&mut scene, Kind::Integrator, "path", Map::default().with("max_depth", 6_i64));
    single(&mut scene, Kind::Background, "gradient", Map::default().with("stops", sky()));
    *scene.all_mut(Kind::Camera) = vec![Entity::new("camera", "perspective", camera)];

    // A key light from the left, a weak window on the right, a floor that shows how it looks through and around the ball.
    let shade = |x: f64| [x, x, x * 1.04];
    let squares = Map::default()
        .with("a", shade(0.42))
        .with("b", shade(0.30))
        .with("mapping", "solid")
        .with("transform", Value::List(vec![Node::new(Map::default().with("scale", 0.8))]));
    let lambert = Map::default().with("reflectance", tiles.as_str());
    let glow = |color: [f64; 3], strength: f64| Map::default().with("radiance", color).with("intensity", strength);
    let disk = |at: [f64; 3], radius: f64, material: &str| {
        let towards = at.map(|x| -x);
        Map::default().with("center", at).with("normal", towards).with("radius", radius).with("material", material)
    };
    let ground =
        Map::default().with("point", [0.0, -1.0, 0.0]).with("normal", [0.0, 1.0, 0.0]).with("material", floor.as_str());
    let ball = Map::default().with("material", matter.name.as_str());
    scene.all_mut(Kind::Texture).push(Entity::new(&tiles, "checker", squares));
    scene.all_mut(Kind::Material).extend([
        Entity::new(&floor, "lambert", lambert),
        Entity::new(&lamps[0], "emitter", glow([1.0, 0.95, 0.88], 58.0)),
        Entity::new(&lamps[1], "emitter", glow([0.8, 0.9, 1.0], 10.0)),
    ]);
    *scene.all_mut(Kind::Object) = vec![
        Entity::new("ball", "sphere", ball),
        Entity::new("ground", "plane", ground),
        Entity::new("key", "disk", disk([-4.5, 6.0, 4.5], 1.2, &lamps[0])),
        Entity::new("window", "disk", disk([6.5, 3.0, 1.5], 1.6, &lamps[1])),
    ];
    scene
}

fn sky() -> Value {
    let stop = |at: f64, color: [f64; 3]| Node::new(vec![Node::new(at), Node::new(color)]);
    Value::List(vec![stop(-1.0, [0.1; 3]), stop(0.0, [0.20, 0.21, 0.23]), stop(1.0, [0.34, 0.38, 0.44])])
}
