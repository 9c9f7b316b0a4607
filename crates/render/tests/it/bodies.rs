//! Bodies in bodies, beside bodies and behind shadows; instances that change what they repeat.

use crate::support::{grey, prepared, seen};
use kirkas_formats::load;
use kirkas_render::film::AovSet;
use kirkas_render::{Options, prepare};
use kirkas_scene::files::{FileAccess, Limits, MemoryFiles};

const FAR: [f64; 3] = [0.1, 0.05, 10.0];
const MIDDLE: [f64; 3] = [0.1, 0.05, 0.0];

/// In light from everywhere a clear body cannot be seen, however many there are.
fn in_a_furnace(bodies: &str) -> f64 {
    let around = "[integrator]\nmax_depth = 60\nmin_contribution = 0.0\n[background]\ncolor = 0.5\n\
                  [materials.glass]\ntype = \"dielectric\"\nior = 1.5\n\
                  [materials.water]\ntype = \"dielectric\"\nior = 1.33\npriority = 1\n";
    grey(&format!("{around}{bodies}"), FAR, MIDDLE, 1)
}

#[test]
fn overlapping_bodies_stay_unseen_in_a_furnace() {
    let ball = |name: &str, z: f64| {
        format!("[objects.{name}]\ntype = \"sphere\"\ncenter = [0, 0, {z}]\nmaterial = \"glass\"\n")
    };
    let block = |name: &str, low: f64, high: f64, material: &str| {
        format!(
            "[objects.{name}]\ntype = \"box\"\nmin = [-2, -2, {low}]\nmax = [2, 2, {high}]\nmaterial = \"{material}\"\n"
        )
    };
    // The same index on both sides of the overlap, and another index ruled by priority.
    for (what, bodies) in [
        ("one", ball("a", 0.0)),
        ("overlapping", ball("a", 0.0) + &ball("b", 0.7)),
        ("glass in water", block("a", -1.0, 0.1, "glass") + &block("b", 0.0, 1.0, "water")),
    ] {
        let value = in_a_furnace(&bodies);
        assert!((value - 0.5).abs() < 2e-3, "{what}: {value}");
    }
}

#[test]
fn tinted_shadows_know_beers_law() {
    for absorption in [0.0, 0.1, 0.5] {
        let scene = format!(
            "[integrator]\nshadows = \"transparent\"\n[lights.sun]\ntype = \"directional\"\ndirection = [1, 0, -1]\n\
             [materials.white]\ntype = \"lambert\"\nreflectance = 1\n\
             [materials.glass]\ntype = \"dielectric\"\nior = 1.5\nabsorption = {absorption}\n\
             [objects.floor]\ntype = \"plane\"\nnormal = [0, 0, 1]\nmaterial = \"white\"\n\
             [objects.slab]\ntype = \"box\"\nmin = [-3, -2, 0]\nmax = [-1, 2, 9]\nmaterial = \"glass\"\n"
        );
        // The light crosses two units of glass at 45 degrees.
        let truth = 0.5_f64.sqrt() * (-absorption * 8.0_f64.sqrt()).exp();
        let value = grey(&scene, [0.0, 0.0, 8.0], [0.0, 0.0, 0.0], 1);
        assert!((value - truth).abs() < 1e-4, "absorption {absorption}: {value} instead of {truth}");
    }
}

/// A glowing pane in front of a dark background, as an instance with something else said of it.
fn instance_with(words: &str) -> f64 {
    let scene = format!(
        "[materials.glow]\ntype = \"emitter\"\ntwo_sided = true\n\
         [materials.veil]\ntype = \"emitter\"\ntwo_sided = true\nalpha = 0.25\n\
         [objects.pane]\ntype = \"rectangle\"\nedge_u = [4, 0, 0]\nedge_v = [0, 4, 0]\nmaterial = \"glow\"\nparent = \"model\"\n\
         [objects.model]\ntype = \"group\"\ntemplate = true\n\
         [objects.copy]\ntype = \"instance\"\nof = \"model\"\n{words}\n"
    );
    seen(&scene, FAR, MIDDLE, 4096)[0]
}

#[test]
fn instances_change_material_opacity_and_visibility() {
    assert_eq!(instance_with(""), 1.0);
    assert_eq!(instance_with("visible = false"), 0.0);
    let veil = instance_with("material = \"veil\"");
    assert!((veil - 0.25).abs() < 0.03, "{veil}");
}

#[test]
fn a_group_that_holds_itself_is_refused() {
    let text = "[cameras.eye]\ntype = \"perspective\"\n[objects.g]\ntype = \"group\"\n\
                [objects.again]\ntype = \"instance\"\nof = \"g\"\nparent = \"g\"\n";
    let files = MemoryFiles([("scene.toml".to_string(), text.as_bytes().to_vec())].into());
    let access = FileAccess::new(Box::new(files), Limits::default());
    let description = load(&access, "scene.toml").expect("it is well written");
    let assets = kirkas_formats::FormatAssets::new(&access, &description.sources);
    let errors = prepare(&description, &assets, &Options::default()).err().expect("it is refused");
    assert_eq!(errors[0].message, "`g` holds an instance of itself");
}

#[test]
fn depth_passes_boundaries_that_are_covered() {
    let scene = "[film]\nwidth = 1\nheight = 1\nfilter = \"point\"\n[sampler]\nsamples = 1\n\
                 [cameras.eye]\ntype = \"perspective\"\nposition = [0.1, 0.05, 10]\nlook_at = [0.1, 0.05, 0]\n\
                 [materials.hidden]\ntype = \"dielectric\"\npriority = 0\n\
                 [materials.ruling]\ntype = \"dielectric\"\npriority = 1\n\
                 [objects.ruling]\ntype = \"box\"\nmin = [-9, -9, -1]\nmax = [9, 9, 20]\nmaterial = \"ruling\"\n\
                 [objects.hidden]\ntype = \"box\"\nmin = [-9, -9, 2]\nmax = [9, 9, 5]\nmaterial = \"hidden\"\n";
    let options = Options { aovs: AovSet::from_names(["depth"]).expect("it is listed"), ..Options::default() };
    let p = crate::support::prepared_with(scene, &[], &options);
    let (film, _) = crate::support::expose(&p, 0..1);
    // From inside the ruling body, the hidden one's two boundaries are not there; its own end is 11 away.
    let depth = film.aov_channel("depth", 0);
    let depth = depth.floats().expect("depth is a float")[0];
    assert!((depth - 11.0).abs() < 1e-4, "{depth}");
}

#[test]
fn darkness_and_a_closed_shutter_are_said() {
    let codes = |body: &str| -> Vec<&'static str> {
        prepared(&format!("[cameras.eye]\ntype = \"perspective\"\n{body}")).warnings.iter().map(|w| w.code).collect()
    };
    assert_eq!(codes("[objects.ball]\ntype = \"sphere\"\n"), ["no-light"]);
    let moving = "motion = [{ time = 0 }, { time = 1, transform = [{ translate = [1, 0, 0] }] }]\n";
    let lit = "[lights.a]\ntype = \"ambient\"\n";
    assert_eq!(codes(&format!("{lit}[objects.ball]\ntype = \"sphere\"\n{moving}")), ["no-shutter"]);
}
