//! Pictures of the surroundings and daylight, from the scene file to the pixel.

use crate::support::{assert_near, pixel, prepared_with};
use kirkas_formats::{FormatAssets, load};
use kirkas_images::{RgbImage, Texts, write_hdr};
use kirkas_render::render::Undisturbed;
use kirkas_render::{Film, Options, prepare};
use kirkas_scene::files::{FileAccess, Limits, MemoryFiles};

/// Blue above, and on the horizon a red texel to the right of the middle of the picture, a green one to the left.
fn picture() -> Vec<u8> {
    let color = |x: u32, y: u32| match (x, y) {
        (_, 0) => [0.0, 0.0, 1.0],
        (12, 4 | 3) => [3.0, 0.0, 0.0],
        (4, 4 | 3) => [0.0, 5.0, 0.0],
        _ => [0.25; 3],
    };
    write_hdr(&RgbImage::from_fn(16, 8, color), &Texts::default()).unwrap()
}

fn scene(background: &str, from: [f64; 3], to: [f64; 3]) -> String {
    format!(
        "{background}\n[film]\nwidth = 1\nheight = 1\nfilter = \"point\"\n[sampler]\nsamples = 1\n\
         [cameras.eye]\ntype = \"perspective\"\nposition = {from:?}\nlook_at = {to:?}\nup = [0.1, 0.9, 0.3]\n"
    )
}

/// What is seen in a direction from a place.
fn seen(background: &str, towards: [f64; 3]) -> [f64; 3] {
    let from = [1.0, 2.0, 3.0];
    let to = std::array::from_fn(|i| from[i] + towards[i]);
    let p = prepared_with(&scene(background, from, to), &[("sky.hdr", &picture())], &Options::default());
    let mut film = Film::new(p.film.clone());
    p.renderer(1).render(&mut film, 0..1, &Undisturbed);
    pixel(&film, 0, 0)
}

/// Towards the middle of the texel in this column on the horizon.
fn column(x: f64) -> [f64; 3] {
    let angle = (x + 0.5) / 16.0 * std::f64::consts::TAU;
    [angle.sin(), 0.0, -angle.cos()]
}

#[test]
fn an_environment_map_is_seen_as_its_manual_says() {
    let plain = "[background]\ntype = \"image\"\nfile = \"sky.hdr\"\nintensity = 2\n";
    assert_eq!(seen(plain, [0.0, 1.0, 0.0]), [0.0, 0.0, 2.0]);
    assert_eq!(seen(plain, [0.0, -1.0, 0.0]), [0.5; 3]);
    // To the right of the middle, +z, lies -x.
    let right = column(12.0);
    assert!(right[0] < -0.9);
    assert_near(seen(plain, right)[0], 6.0, 1e-4);
    assert_near(seen(plain, column(4.0))[1], 10.0, 1e-4);
}

#[test]
fn a_turned_environment_map_shows_the_turned_picture() {
    let turned = "[background]\ntype = \"image\"\nfile = \"sky.hdr\"\ntransform = [{ rotate = [0, 1, 0, 90] }]\n";
    // A quarter turn about y takes +x to -z: what was at d is at (d.z, d.y, -d.x).
    let d = column(12.0);
    assert_near(seen(turned, [d[2], d[1], -d[0]])[0], 3.0, 1e-4);
    let tipped = "[background]\ntype = \"image\"\nfile = \"sky.hdr\"\ntransform = [{ rotate = [1, 0, 0, 90] }]\n";
    assert_eq!(seen(tipped, [0.0, 0.0, 1.0]), [0.0, 0.0, 1.0]);
}

#[test]
fn a_stretched_environment_map_is_refused() {
    let text = scene(
        "[background]\ntype = \"image\"\nfile = \"sky.hdr\"\ntransform = [{ scale = 2 }]",
        [0.0; 3],
        [0.0, 0.0, 1.0],
    );
    let files = [("scene.toml".to_string(), text.into_bytes()), ("sky.hdr".to_string(), picture())];
    let access = FileAccess::new(Box::new(MemoryFiles(files.into())), Limits::default());
    let description = load(&access, "scene.toml").unwrap();
    let assets = FormatAssets::new(&access, &description.sources);
    let errors = prepare(&description, &assets, &Options::default()).err().unwrap();
    assert!(errors[0].message.contains("not stretched"), "{errors:?}");
}

#[test]
fn the_sun_is_seen_where_it_stands_and_not_beside() {
    let sky = "[background]\ntype = \"sun_sky\"\nsun_direction = [0, 1, 1]\n";
    let sun = seen(sky, [0.0, 1.0, 1.0]);
    let beside = seen(sky, [0.01, 1.0, 1.0]);
    assert!(sun[1] > 1e6 && beside[1] > 10.0 && beside[1] < 1000.0, "{sun:?} {beside:?}");
}
