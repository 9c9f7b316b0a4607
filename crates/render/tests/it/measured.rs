//! Materials from files of measurements, through the whole renderer.

use crate::support::{assert_near, expose, one_pixel, pixel, prepared_with};
use kirkas_formats::FormatAssets;
use kirkas_optics::measured::write_merl;
use kirkas_render::{Options, prepare};
use kirkas_scene::files::{FileAccess, Limits, MemoryFiles};

/// A floor of the file under an even sky.
fn floor(path: &str, film: &str) -> String {
    let body = format!(
        "[integrator]\ntype = \"path\"\n[background]\ncolor = 1\n[materials.m]\ntype = \"measured\"\nfile = \"{path}\"\n\
         [objects.floor]\ntype = \"plane\"\nmaterial = \"m\"\n"
    );
    one_pixel(&body, [0.0, 2.0, 1.0], [0.0, 0.0, 0.0], 256).replace("[film]\n", &format!("[film]\n{film}\n"))
}

/// A matte file is as bright as its reflectance, in both ways of carrying colour.
#[test]
fn a_matte_file_shows_its_reflectance() {
    let rho = [0.6, 0.3, 0.1];
    let file = write_merl(|_, _| rho.map(|r| r / std::f64::consts::PI));
    for (film, slack) in [("", 0.01), ("color = \"spectral\"", 0.06)] {
        let p = prepared_with(&floor("matte.binary", film), &[("matte.binary", &file)], &Options::default());
        let found = pixel(&expose(&p, 0..p.samples).0, 0, 0);
        for c in 0..3 {
            assert_near(found[c], rho[c], slack / rho[c]);
        }
    }
}

#[test]
fn what_is_wrong_with_a_file_is_told_at_its_name() {
    let told = |path: &str| {
        let scene = floor(path, "");
        let mut all = MemoryFiles::default();
        all.0.insert("scene.toml".into(), scene.clone().into_bytes());
        all.0.insert("picture.binary".into(), b"\x89PNG\r\n\x1a\n and more".to_vec());
        all.0.insert("short.binary".into(), [90, 0, 0, 0, 90, 0, 0, 0, 180, 0, 0, 0, 1].to_vec());
        let access = FileAccess::new(Box::new(all), Limits::default());
        let description = kirkas_formats::load(&access, "scene.toml").unwrap_or_else(|e| panic!("{e:?}"));
        let assets = FormatAssets::new(&access, &description.sources);
        let errors = prepare(&description, &assets, &Options::default()).err().expect("it is wrong");
        assert_eq!(errors.len(), 1, "{errors:#?}");
        assert!(errors[0].labels.len() == 1, "{errors:#?}");
        format!("{} {}", errors[0].code, errors[0].message)
    };
    assert!(told("none.binary").contains("there is no file `none.binary`"));
    let neither = "bad-measured `picture.binary` cannot be read: it is neither a MERL `.binary` nor an RGL `.bsdf`";
    assert_eq!(told("picture.binary"), neither);
    assert!(told("short.binary").contains("a MERL file has 34992012 bytes, this one 13"));
}
