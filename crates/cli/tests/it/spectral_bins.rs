//! `--spectral-bins` from the command line: the layers, the same bits, and what cannot be had.

use crate::common::{EVERYTHING, Folder, bits, header};
use crate::errors::said;

const SPECTRAL: [&str; 6] = ["render", "scene.toml", "--color", "spectral", "--spectral-bins", "20:400..700"];

fn folder(name: &str) -> Folder {
    Folder::with_scene(name, EVERYTHING)
}

#[test]
fn spectra_are_layers_beside_the_picture_with_the_same_bits_for_all_threads_parts_and_stops() {
    let f = folder("spectra");
    let render = |args: &[&str]| f.ok(&[&SPECTRAL, args].concat());
    render(&["-o", "one.exr", "--threads", "1"]);
    let one = f.exr("one.exr");
    let layers: Vec<&str> = one.channels.iter().map(|c| c.name.as_str()).filter(|n| n.starts_with("S0.")).collect();
    assert_eq!((layers.len(), layers[0], layers[19]), (20, "S0.407,50nm", "S0.692,50nm"));
    assert_eq!((one.text("spectralLayoutVersion"), one.text("emissiveUnits")), (Some("1.0"), Some("W.m^-2.sr^-1")));
    assert!(one.rgb().is_some());
    let is_lit = |name: &str| one.channel(name).and_then(|c| c.floats()).is_some_and(|v| v.iter().any(|x| *x > 0.0));
    assert!(layers.iter().all(|name| is_lit(name)), "a bin is dark everywhere");

    render(&["-o", "two.exr", "--threads", "2", "--flock", "7"]);
    render(&["--samples", "0..3", "-o", "a.exr"]);
    render(&["--samples", "3..8", "-o", "b.exr"]);
    f.ok(&["merge", "b.exr", "a.exr", "--flat", "-o", "merged.exr"]);
    render(&["--checkpoint", "c.exr", "--spp", "5", "-o", "five.exr"]);
    render(&["--checkpoint", "c.exr", "--spp", "8", "--resume", "-o", "resumed.exr"]);
    for name in ["two.exr", "merged.exr", "resumed.exr"] {
        let other = f.exr(name);
        assert_eq!(bits(&other), bits(&one), "{name}");
        assert_eq!(header(&other), header(&one), "{name}");
    }

    // Relit, colours change by group, of which bins know nothing.
    for input in ["a.exr", "one.exr"] {
        f.ok(&["relight", input, "lamp=2", "-o", "relit.exr"]);
        assert!(f.exr("relit.exr").channels.iter().all(|c| !c.name.starts_with("S0.")), "{input}");
    }
}

#[test]
fn what_bins_cannot_be_is_said() {
    let f = folder("spectra_errors");
    said(&f, "bins_without_wavelengths", &["render", "scene.toml", "--spectral-bins", "40", "-o", "a.exr"]);
    let spectral = ["render", "scene.toml", "--color", "spectral", "-o"];
    let with = |args: &[&'static str]| [&spectral, args].concat();
    said(&f, "bins_none", &with(&["a.exr", "--spectral-bins", "0"]));
    said(&f, "bins_too_many", &with(&["a.exr", "--spectral-bins", "100000"]));
    said(&f, "bins_beyond_the_range", &with(&["a.exr", "--spectral-bins", "40:300..700"]));
    said(&f, "bins_without_exr", &with(&["a.png", "--spectral-bins", "40"]));
    assert_eq!(f.names(), ["scene.toml"]);
    f.ok(&with(&["a.exr", "--spectral-bins", "40", "--checkpoint", "c.exr", "--spp", "1"]));
    said(
        &f,
        "bins_of_other_checkpoint",
        &with(&["a.exr", "--spectral-bins", "20", "--checkpoint", "c.exr", "--resume", "--spp", "2"]),
    );
}
