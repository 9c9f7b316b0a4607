//! HDR: within the precision of RGBE, and texts come back.

use crate::samples::{data_folder, kirkas_hash, smooth_rgb};
use kirkas_images::*;

#[test]
fn values_survive_to_one_part_in_128_of_the_largest() {
    // Widths below 8 are stored flat, others run-length coded.
    for [width, height] in [[3, 5], [8, 4], [300, 7]] {
        let rgb = RgbImage::from_fn(width, height, |x, y| {
            let scale = 2f32.powi((x % 60) as i32 - 30);
            let lane = |seed| (kirkas_hash(seed, x / 5 + 1000 * y) % 1000) as f32 * scale;
            [lane(1), lane(2), lane(3)]
        });
        let back = read_hdr(&write_hdr(&rgb, &Texts::new()).unwrap()).unwrap().rgb();
        for (given, got) in rgb.pixels.iter().zip(&back.pixels) {
            let step = given.iter().fold(0f32, |a, &b| a.max(b)) / 128.0;
            for lane in 0..3 {
                let lost = given[lane] - got[lane];
                assert!((0.0..=step).contains(&lost), "{given:?} came back as {got:?}");
            }
        }
    }
}

#[test]
fn writing_twice_changes_nothing_more() {
    let once = read_hdr(&write_hdr(&smooth_rgb(50, 20), &Texts::new()).unwrap()).unwrap().rgb();
    let twice = read_hdr(&write_hdr(&once, &Texts::new()).unwrap()).unwrap().rgb();
    assert_eq!(once, twice);
}

#[test]
fn what_rgbe_cannot_hold_goes_to_its_ends() {
    let largest = 255.0 * 2f32.powi(119);
    let pixels = vec![[f32::NAN, -1.0, 0.0], [f32::INFINITY, 1.0, f32::MAX], [1e-40, 0.0, 0.0]];
    let image = RgbImage { width: 3, height: 1, pixels };
    let back = read_hdr(&write_hdr(&image, &Texts::new()).unwrap()).unwrap().rgb();
    assert_eq!(back.pixels, [[0.0; 3], [largest, 0.0, largest], [0.0; 3]]);
}

#[test]
fn texts_survive() {
    let texts = Texts::from([("argv".into(), "a\\b\nkirkas = ☁\r".into()), ("seed".into(), "7".into())]);
    assert_eq!(read_hdr(&write_hdr(&smooth_rgb(9, 2), &texts).unwrap()).unwrap().texts, texts);
    let bad = Texts::from([("a=b".into(), String::new())]);
    assert!(write_hdr(&smooth_rgb(9, 2), &bad).is_err());
}

#[test]
fn an_environment_map_from_the_world_is_read() {
    let Some(data) = data_folder("an_environment_map_from_the_world_is_read") else { return };
    let file = std::fs::read(data.join("envmaps/chinese_garden_1k.hdr")).unwrap();
    let image = decode(&file, None).unwrap();
    assert_eq!((image.width, image.height), (1024, 512));
    // What is written of it is the same numbers again.
    let again = read_hdr(&write_hdr(&image.rgb(), &Texts::new()).unwrap()).unwrap();
    assert_eq!(again.rgb(), image.rgb());
}
