//! RGB and spectral mode agree where they must, lamps and metals by name shine as they should, and prisms bend each colour by
//! its own angle.

use crate::support::{Rgb, expose, one_pixel, pixel, prepared, prepared_with};
use kirkas_optics::ColorMode;
use kirkas_render::{Options, prepare};
use kirkas_scene::files::{FileAccess, Limits, MemoryFiles};

/// The radiance from `(0, 0, 5)` towards the origin.
fn seen(body: &str, mode: ColorMode, samples: u32) -> Rgb {
    let toml = one_pixel(body, [0.0, 0.0, 5.0], [0.0, 0.0, 0.0], samples);
    let p = prepared(&toml.replace("[film]", &format!("[film]\ncolor = \"{}\"", mode.name())));
    pixel(&expose(&p, 0..samples).0, 0, 0)
}

/// The same in both modes.
#[track_caller]
fn both(body: &str, tolerance: f64) -> Rgb {
    let (rgb, spectral) = (seen(body, ColorMode::Rgb, 64), seen(body, ColorMode::Spectral, 1024));
    let scale = rgb.iter().fold(1e-3, |a: f64, b| a.max(*b));
    assert!((0..3).all(|c| (rgb[c] - spectral[c]).abs() <= tolerance * scale), "{rgb:?} and {spectral:?}\n{body}");
    rgb
}

const LAMP: &str = "[lights.lamp]\ntype = \"directional\"\ndirection = [0, 0, -1]\n";
const CARD: &str = "[objects.card]\ntype = \"rectangle\"\nmaterial = \"m\"\nedge_u = [4, 0, 0]\nedge_v = [0, 4, 0]\n";

fn card(material: &str) -> String {
    format!("{LAMP}{CARD}[materials.m]\n{material}\n")
}

#[test]
fn what_is_white_in_rgb_is_white_in_wavelengths() {
    let all_near_one = |c: Rgb| assert!(c.iter().all(|x| (x - 1.0).abs() < 1e-3), "{c:?}");
    // A white background, seen at once, in a mirror, and through clear glass.
    let sky = "[background]\ncolor = 1\n";
    all_near_one(both(sky, 1e-3));
    all_near_one(both(&format!("{sky}{CARD}[materials.m]\ntype = \"mirror\"\n"), 1e-3));
    let glass = "[materials.m]\ntype = \"dielectric\"\nior = { material = \"N-SF11\" }\n[objects.ball]\ntype = \"sphere\"\n\
                 material = \"m\"\n[integrator]\nmax_depth = 30\nmin_contribution = 0\n";
    for mode in [ColorMode::Spectral, ColorMode::Rgb] {
        let c = seen(&format!("{sky}{glass}"), mode, 1024);
        assert!(c.iter().all(|x| (x - 1.0).abs() < 6e-3), "{c:?}");
    }
    // White light on a white card.
    all_near_one(both(&card("type = \"lambert\"\nreflectance = 1"), 1e-3));
}

#[test]
fn colours_look_alike_in_both_modes() {
    for color in ["[0.8, 0.2, 0.1]", "[0.1, 0.6, 0.9]", "0.4", "\"#80c040\""] {
        let got = both(&card(&format!("type = \"lambert\"\nreflectance = {color}")), 2e-3);
        assert!(got.iter().any(|c| *c > 0.1), "{color}: {got:?}");
        both(&format!("[background]\ncolor = {color}\n"), 2e-3);
        both(&card(&format!("type = \"emitter\"\nradiance = {color}\nintensity = 20")), 2e-3);
    }
    // A texture goes through the table.
    let checker = "type = \"lambert\"\nreflectance = \"t\"\n[textures.t]\ntype = \"checker\"\na = [0.7, 0.3, 0.2]\nb = [0.7, 0.3, 0.2]";
    both(&card(checker), 6e-3);
}

#[test]
fn what_is_the_same_at_all_wavelengths_gives_the_same_picture() {
    let scene = |mode: &str| {
        format!(
            "[film]\nwidth = 24\nheight = 16\ncolor = \"{mode}\"\n[sampler]\nsamples = 256\n\
             [cameras.eye]\ntype = \"perspective\"\nposition = [0, 1, 5]\nlook_at = [0, 0, 0]\n[background]\ncolor = 0.3\n\
             [lights.lamp]\ntype = \"point\"\nposition = [2, 4, 3]\nintensity = 20\n\
             [materials.floor]\ntype = \"lambert\"\nreflectance = 0.6\n[materials.glass]\ntype = \"rough_dielectric\"\nabsorption = 0.2\n\
             [materials.shiny]\ntype = \"phong\"\n\
             [objects.floor]\ntype = \"rectangle\"\nmaterial = \"floor\"\ncenter = [0, -1, 0]\nedge_u = [9, 0, 0]\nedge_v = [0, 0, -9]\n\
             [objects.a]\ntype = \"sphere\"\nmaterial = \"glass\"\ncenter = [-1, 0, 0]\n\
             [objects.b]\ntype = \"sphere\"\nmaterial = \"shiny\"\ncenter = [1.2, 0, 0]\n"
        )
    };
    let film = |mode| expose(&prepared(&scene(mode)), 0..256).0;
    let (a, b) = (film("rgb"), film("spectral"));
    // Squares of the differences over their variances: about one per pixel and channel.
    let (mut z2, mut count, mut worst) = (0.0, 0.0, 0.0_f64);
    for (p, q) in a.pixels().zip(b.pixels()) {
        let (m, n) = (p.2.mean(p.3), q.2.mean(q.3));
        let (v, w) = (p.2.variance_of_mean(p.3), q.2.variance_of_mean(q.3));
        for c in 0..3 {
            let difference = f64::from(m[c] - n[c]);
            let variance = f64::from(v[c] + w[c]) + 1e-8;
            z2 += difference * difference / variance;
            worst = worst.max(difference.abs() / variance.sqrt());
            count += 1.0;
        }
    }
    assert!(z2 / count < 1.3 && worst < 6.0, "{} {worst}", z2 / count);
}

#[test]
fn lamps_have_the_colour_that_they_name() {
    let card_in = |color: &str| {
        card("type = \"lambert\"\nreflectance = 1").replace("direction =", &format!("color = {color}\ndirection ="))
    };
    let warm = both(&card_in("{ blackbody = 2700 }"), 3e-3);
    let cold = both(&card_in("{ blackbody = 10000 }"), 3e-3);
    let tube = both(&card_in("{ illuminant = \"F2\" }"), 4e-3);
    let white = both(&card_in("{ illuminant = \"D65\" }"), 2e-3);
    let luminance = |c: Rgb| 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
    for c in [warm, cold, tube, white] {
        assert!((luminance(c) - 1.0).abs() < 2e-3, "{c:?}");
    }
    assert!(warm[0] > 1.5 * warm[1] && warm[1] > 2.0 * warm[2] && cold[2] > 1.2 * cold[0], "{warm:?} {cold:?}");
    assert!(white.iter().all(|x| (x - 1.0).abs() < 1e-3), "{white:?}");
}

#[test]
fn metals_have_their_colour_in_both_modes() {
    let scene = |metal: &str| {
        format!(
            "[background]\ncolor = 1\n{CARD}[materials.m]\ntype = \"conductor\"\nior = {{ material = \"{metal}\" }}\n"
        )
    };
    // Red of gold lies outside of Rec.709, so RGB mode holds less of it.
    both(&scene("silver"), 6e-3);
    let gold = seen(&scene("gold"), ColorMode::Spectral, 1024);
    assert!(gold[0] > gold[1] && gold[1] > gold[2] + 0.3, "{gold:?}");
    both(&scene("aluminium").replace("conductor", "rough_conductor"), 1e-2);
}

/// Ends at -1 and 1 along z, apex up, sides of length 1.
const PRISM: &str = "v 0 0.57735 -1\nv -0.5 -0.288675 -1\nv 0.5 -0.288675 -1\nv 0 0.57735 1\nv -0.5 -0.288675 1\nv 0.5 -0.288675 1\n\
                     f 1 2 5 4\nf 2 3 6 5\nf 3 1 4 6\nf 1 3 2\nf 4 5 6\n";

const WIDTH: u32 = 201;
/// Of the picture, degrees.
const FIELD: f64 = 1.5;

/// A prism before a far, narrow slit whose light comes in at `incidence` degrees, in a picture of one row, and the angle that
/// the camera looks down, a little more than the slit's.
fn prism(glass: &str, incidence: f64, radiance: &str, film: &str) -> (String, f64) {
    const FAR: f64 = 1e5;
    let tilt = (incidence - 30.0).to_radians();
    let aim = tilt + 0.2_f64.to_radians();
    // It looks at the middle of the left face, from where light crosses to the middle of the right one: no ray meets the base.
    const MIDDLE: (f64, f64) = (-0.25, 0.1443);
    let (x, y) = (MIDDLE.0 - 10.0 * aim.cos(), MIDDLE.1 - 10.0 * aim.sin());
    let slit = (FAR * tilt.cos(), -FAR * tilt.sin());
    let half = FAR * 0.01_f64.to_radians().tan();
    let toml = format!(
        "[film]\nwidth = {WIDTH}\nheight = 1\ncolor = \"spectral\"\nfilter = \"box\"\n{film}\
         [integrator]\nmin_contribution = 0\n[cameras.eye]\ntype = \"perspective\"\nposition = [{x:?}, {y:?}, 0]\nlook_at = [{:?}, {:?}, 0]\n\
         up = [0, 0, 1]\nfov = {FIELD}\nfov_axis = \"horizontal\"\n\
         [materials.glass]\ntype = \"dielectric\"\nior = {{ material = \"{glass}\" }}\n\
         [materials.line]\ntype = \"emitter\"\ntwo_sided = true\nradiance = {radiance}\n\
         [objects.prism]\ntype = \"mesh\"\nmaterial = \"glass\"\nfile = \"prism.obj\"\n\
         [objects.slit]\ntype = \"rectangle\"\nmaterial = \"line\"\ncenter = [{:?}, {:?}, 0]\nedge_u = [{:?}, {:?}, 0]\n\
         edge_v = [0, 0, {FAR:?}]\n",
        MIDDLE.0,
        MIDDLE.1,
        slit.0,
        slit.1,
        2.0 * half * tilt.sin(),
        2.0 * half * tilt.cos(),
    );
    (toml, aim.to_degrees())
}

/// The deviation of light that came in at `incidence`, by where it is in the picture: its centre of gravity.
fn deviation(light: &[f64], aim: f64, incidence: f64) -> f64 {
    let total: f64 = light.iter().sum();
    assert!(total > 0.0, "the slit is not seen");
    let column = light.iter().enumerate().map(|(i, l)| l * (i as f64 + 0.5)).sum::<f64>() / total;
    // Right in the picture is down in the scene.
    let across = 2.0 * column / f64::from(WIDTH) - 1.0;
    aim - (across * (FIELD / 2.0).to_radians().tan()).atan().to_degrees() + incidence - 30.0
}

/// The deviation in degrees at which a prism shows a slit that shines at one wavelength, nm.
fn measured_deviation(glass: &str, nanometres: f64, incidence: f64) -> f64 {
    let (toml, aim) = prism(glass, incidence, "{ spectrum = \"line.spd\" }", "");
    let line = format!("{} 0\n{nanometres} 1\n{} 0\n", nanometres - 0.5, nanometres + 0.5);
    let files: [(&str, &[u8]); 2] = [("prism.obj", PRISM.as_bytes()), ("line.spd", line.as_bytes())];
    let film = expose(&prepared_with(&toml, &files, &Options::default()), 0..1024).0;
    let luminance = |[r, g, b]: Rgb| 0.2126 * r + 0.7152 * g + 0.0722 * b;
    let light: Vec<f64> = (0..WIDTH).map(|i| luminance(pixel(&film, i, 0))).collect();
    deviation(&light, aim, incidence)
}

/// One picture of a white slit, and the bins of the three lines in it.
#[test]
fn a_prism_spreads_white_light_so_that_each_line_has_its_own_exit_angle() {
    const INCIDENCE: f64 = 49.3233492526;
    let bins = "spectral_bins = 180\nspectral_range = [480, 660]\n";
    let (toml, aim) = prism("N-BK7", INCIDENCE, "10", bins);
    let p = prepared_with(&toml, &[("prism.obj", PRISM.as_bytes())], &Options::default());
    let film = expose(&p, 0..4096).0;
    for (line, nanometres, n) in
        [("F", 486.1327, 1.52237628973), ("d", 587.5618, 1.5168000345), ("C", 656.2725, 1.51432234726)]
    {
        // Snell's law, twice, in a prism of 60 degrees.
        let inside = (INCIDENCE.to_radians().sin() / n).asin();
        let exit = (n * (60.0_f64.to_radians() - inside).sin()).asin().to_degrees();
        let bin = film.layout.bins.and_then(|b| b.bin(nanometres)).expect("a bin of the film");
        let light: Vec<f64> = film.spectral_bin(bin).into_iter().map(f64::from).collect();
        let found = deviation(&light, aim, INCIDENCE) - INCIDENCE + 60.0;
        println!("{line}: leaves at {found:.4} degrees, {exit:.4} expected");
        assert!((found - exit).abs() < 0.05, "{line}: leaves at {found} degrees, not {exit}");
    }
}

#[test]
fn prisms_bend_the_f_d_and_c_lines_by_their_own_angles() {
    // n by SCHOTT's Sellmeier formula, apex 60 degrees: incidence of least deviation and that deviation.
    let lines = [
        ("N-BK7", 486.1327, 49.5690543678, 39.1381087357),
        ("N-BK7", 587.5618, 49.3233492526, 38.6466985053),
        ("N-BK7", 656.2725, 49.2145683518, 38.4291367036),
        ("N-SF11", 486.1327, 64.5894600461, 69.1789200923),
        ("N-SF11", 587.5618, 63.1713144107, 66.3426288214),
        ("N-SF11", 656.2725, 62.6201974151, 65.2403948302),
    ];
    for (glass, nanometres, incidence, truth) in lines {
        let found = measured_deviation(glass, nanometres, incidence);
        println!("{glass} {nanometres} nm: {found:.4} degrees, {truth:.4} expected");
        assert!((found - truth).abs() < 0.05, "{glass} at {nanometres} nm: {found} degrees, not {truth}");
    }
}

#[test]
fn what_is_wrong_with_wavelengths_is_told() {
    let told = |toml: &str| {
        let mut all = MemoryFiles::default();
        all.0.insert("scene.toml".into(), toml.as_bytes().to_vec());
        all.0.insert("bad.spd".into(), b"400 1\n300 2\n".to_vec());
        let access = FileAccess::new(Box::new(all), Limits::default());
        let description = kirkas_formats::load(&access, "scene.toml").unwrap_or_else(|e| panic!("{e:?}"));
        let assets = kirkas_formats::FormatAssets::new(&access, &description.sources);
        let errors = prepare(&description, &assets, &Options::default()).err().expect("it is wrong");
        errors.iter().map(|e| format!("{} {}", e.code, e.message)).collect::<Vec<_>>().join("; ")
    };
    let head = "[cameras.eye]\ntype = \"perspective\"\n";
    let lamp = |color: &str| format!("{head}[lights.l]\ntype = \"point\"\ncolor = {color}\n");
    let material = |rows: &str| format!("{head}[materials.m]\n{rows}\n");
    for (toml, part) in [
        (lamp("{ illuminant = \"D66\" }"), "illuminant `D66`"),
        (lamp("{ spectrum = \"bad.spd\" }"), "wavelengths must rise"),
        (lamp("{ spectrum = \"none.spd\" }"), "none.spd"),
        (lamp("{ blackbody = -3 }"), "wrong-type"),
        (lamp("{ blackbody = 2700, illuminant = \"A\" }"), "wrong-type"),
        (material("type = \"lambert\"\nreflectance = { illuminant = \"A\" }"), "no light source"),
        (material("type = \"dielectric\"\nior = { material = \"N-BK8\" }"), "`N-BK8`"),
        (material("type = \"dielectric\"\nior = { sellmeier = [1, 2, 3] }"), "wrong-type"),
        (material("type = \"dielectric\"\nior = { file = \"bad.spd\" }"), "no `DATA:`"),
        (material("type = \"conductor\"\nior = { material = \"water\" }"), "no-extinction"),
    ] {
        let errors = told(&toml);
        assert!(errors.contains(part), "{part}: {errors}");
    }
}
