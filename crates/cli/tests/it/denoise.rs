//! `--denoise`: with Open Image Denoise where it is, and without.

use crate::common::{EVERYTHING, Folder, bits};
use kirkas_images::RgbImage;

#[test]
fn where_there_is_no_denoiser_it_is_said_before_the_work() {
    let f = Folder::with_scene("no_denoiser", EVERYTHING);
    let absent = f.path("none.so");
    let out =
        f.command(&["render", "scene.toml", "-o", "a.png", "--denoise"]).env("KIRKAS_OIDN", &absent).output().unwrap();
    let stderr = String::from_utf8(out.stderr).unwrap();
    assert_eq!(out.status.code(), Some(1), "{stderr}");
    for words in ["Open Image Denoise is not installed", "KIRKAS_OIDN", "openimagedenoise.org", "leave out --denoise"] {
        assert!(stderr.split_whitespace().collect::<Vec<_>>().join(" ").contains(words), "{words}\n{stderr}");
    }
    assert!(!f.path("a.png").exists());
}

#[test]
fn a_denoised_picture_is_nearer_to_the_truth_and_the_noisy_one_is_kept() {
    let f = Folder::with_scene("denoiser", &EVERYTHING.replace("width = 40\nheight = 36", "width = 96\nheight = 72"));
    let first =
        f.run(&["render", "scene.toml", "--spp", "8", "-o", "a.exr", "-o", "a.png", "-o", "a.hdr", "--denoise"]);
    if first.code == Some(1) && first.stderr.contains("no-denoiser") {
        println!("skipped: Open Image Denoise is not installed (KIRKAS_OIDN says where it is)");
        return;
    }
    assert_eq!(first.code, Some(0), "{}", first.stderr);
    f.ok(&["render", "scene.toml", "--spp", "8", "-o", "plain.exr", "-o", "plain.png"]);
    f.ok(&["render", "scene.toml", "--spp", "256", "-o", "truth.exr"]);

    // The noisy picture is the one that is rendered without the option.
    let (clean, plain) = (f.exr("a.exr"), f.exr("plain.exr"));
    assert!(["R", "G", "B"].iter().all(|c| bits(&clean)[*c] == bits(&plain)[*c]));
    assert_eq!(f.ok(&["diff", "a.noisy.png", "plain.png"]).stdout, "rmse 0\n");
    assert!(f.path("a.noisy.hdr").exists());

    // The other is better.
    let layer = |name: &str| clean.channel(name).and_then(|c| c.floats()).unwrap().to_vec();
    let [r, g, b] = ["denoised.R", "denoised.G", "denoised.B"].map(layer);
    let pixels = (0..r.len()).map(|i| [r[i], g[i], b[i]]).collect();
    let denoised = RgbImage { width: 96, height: 72, pixels };
    let truth = f.exr("truth.exr").rgb().unwrap();
    let error = |a: &RgbImage| {
        // On a scale on which dark and bright count alike.
        let square = |(a, b): (&f32, &f32)| f64::from((a - b) * (a - b) / (b * b + 0.01));
        a.pixels.iter().flatten().zip(truth.pixels.iter().flatten()).map(square).sum::<f64>()
            / truth.pixels.len() as f64
    };
    let (before, after) = (error(&plain.rgb().unwrap()), error(&denoised));
    println!("relative squared error {before:.4} before, {after:.4} after");
    assert!(after < 0.5 * before, "{before} {after}");
}
