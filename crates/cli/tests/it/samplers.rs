//! Every sampler from the command line, and what cannot be had from one.

use crate::common::{BALL, EVERYTHING, Folder, bits};

#[test]
fn a_stratified_picture_can_be_cut_in_parts_but_not_be_given_more() {
    let f = Folder::with_scene("stratified", &EVERYTHING.replace("[sampler]", "[sampler]\ntype = \"stratified\""));
    let render = |args: &[&str]| f.run(&[&["render", "scene.toml"], args].concat());
    for (samples, out) in [("0..3", "a.exr"), ("3..8", "b.exr"), ("0..8", "all.exr")] {
        assert_eq!(render(&["--samples", samples, "-o", out]).code, Some(0));
    }
    f.ok(&["merge", "a.exr", "b.exr", "-o", "merged.exr"]);
    assert_eq!(bits(&f.exr("merged.exr")), bits(&f.exr("all.exr")));

    let refused = render(&["--samples", "8..12", "-o", "more.exr"]);
    assert_eq!(refused.code, Some(2));
    assert!(refused.stderr.contains("has 8 samples per pixel"), "{}", refused.stderr);
    assert!(refused.stderr.contains("-D sampler.samples=12"), "{}", refused.stderr);

    // Other strata are other points.
    assert_eq!(render(&["--samples", "8..16", "-o", "c.exr", "-D", "sampler.samples=16"]).code, Some(0));
    let refused = f.run(&["merge", "a.exr", "b.exr", "c.exr", "-o", "x.exr"]);
    assert_eq!(refused.code, Some(2));
    assert_eq!(render(&["--checkpoint", "saved.exr", "-o", "x.exr"]).code, Some(0));
    let refused = render(&["--checkpoint", "saved.exr", "--resume", "--spp", "16", "-o", "x.exr"]);
    assert_eq!(refused.code, Some(2));
    assert!(refused.stderr.contains("that the sampler was made for: `8` and `16`"), "{}", refused.stderr);
}

#[test]
fn every_sampler_renders_the_same_scene() {
    let f = Folder::with_scene("every_sampler", BALL);
    let render = |name: &str| {
        let sampler = format!("sampler.type={name}");
        f.ok(&["render", "scene.toml", "-D", &sampler, "--spp", "64", "-o", &format!("{name}.exr")]);
    };
    render("sobol");
    for name in ["halton", "stratified", "independent"] {
        render(name);
        let file = format!("{name}.exr");
        f.ok(&["diff", "sobol.exr", &file, "--metric", "rmse", "--max", "0.02"]);
        assert_eq!(f.run(&["diff", "sobol.exr", &file, "--max", "0"]).code, Some(3));
    }
}
