//! The gallery: every scene of the folders `lecture`, `light` and `matter`, rendered small into `docs/gallery`, and plots of
//! materials.

use crate::sh::{self, Outcome, build_kirkas, root};
use std::fs;
use std::process::Command;

/// One picture: its name, its scene's folder and name, and what differs from the scene as it stands.
struct Picture {
    name: &'static str,
    folder: &'static str,
    scene: &'static str,
    options: &'static [&'static str],
}

const fn plain(name: &'static str) -> Picture {
    variant(name, name, &[])
}

const fn variant(name: &'static str, scene: &'static str, options: &'static [&'static str]) -> Picture {
    Picture { name, folder: "lecture", scene, options }
}

const fn light(name: &'static str, options: &'static [&'static str]) -> Picture {
    Picture { name, folder: "light", scene: name, options }
}

const fn matter(name: &'static str, options: &'static [&'static str]) -> Picture {
    Picture { name, folder: "matter", scene: name, options }
}

const fn row_of_phong(name: &'static str, options: &'static [&'static str]) -> Picture {
    Picture { name, folder: "matter", scene: "phong_table", options }
}

/// Plots: the file's name, and what `kirkas brdf` is asked for.
const PLOTS: &[(&str, &[&str])] = &[
    (
        "brdf_slices.svg",
        &["plot", "phong:diffuse=0.3,specular=0.5", "blinn_phong:diffuse=0.3,specular=0.5,exponent=128"],
    ),
    (
        "brdf_lobes.svg",
        &[
            "plot",
            "phong:exponent=80,specular=1",
            "blinn_phong:exponent=320,specular=1",
            "--label",
            "Phong, exponent 80",
            "--label",
            "Blinn-Phong, exponent 320",
            "--kind",
            "lobes",
        ],
    ),
    (
        "brdf_factors.svg",
        &[
            "plot",
            "rough_conductor:ior.material=gold,roughness=0.2",
            "rough_conductor:ior.material=gold,roughness=0.2,distribution=beckmann",
            "cook_torrance:roughness=0.2,ior=1.5",
            "--label",
            "gold, GGX",
            "--label",
            "gold, Beckmann",
            "--label",
            "Cook-Torrance, index 1.5",
            "--kind",
            "curves",
            "--log",
        ],
    ),
    (
        "brdf_maps.png",
        &[
            "plot",
            "scenes/matter/measured/blue-metallic-paint.bsdf",
            "--label",
            "blue metallic paint",
            "--kind",
            "incidence",
            "--log",
        ],
    ),
    (
        "brdf_compare.png",
        &[
            "compare",
            "scenes/matter/measured/specular-red-phenolic.bsdf",
            "rough_plastic:reflectance=[0.39, 0.06, 0.03],roughness=0.03",
            "--label",
            "measured red phenolic",
            "--label",
            "rough_plastic, roughness 0.03",
            "--quiet",
        ],
    ),
];

/// Every picture, in the order of the lecture.
const PICTURES: &[Picture] = &[
    variant("sphereflake", "../sphereflake", &["--size", "400x300"]),
    plain("ray_casting"),
    variant("ray_casting_shadows", "ray_casting", &["-D", "integrator.shadows=opaque"]),
    variant("whitted_depth_0", "whitted", &["-D", "integrator.max_depth=0"]),
    variant("whitted_depth_1", "whitted", &["-D", "integrator.max_depth=1"]),
    variant("whitted_depth_2", "whitted", &["-D", "integrator.max_depth=2"]),
    variant("whitted_depth_3", "whitted", &["-D", "integrator.max_depth=3"]),
    plain("whitted"),
    plain("mirror"),
    plain("surface_offset"),
    variant("surface_offset_off", "surface_offset", &["-D", "integrator.surface_offset=false", "--spp", "1"]),
    plain("fresnel"),
    plain("refraction"),
    plain("snell_window"),
    plain("total_internal_reflection"),
    plain("nested_dielectrics"),
    plain("glossy_reflection"),
    plain("glossy_refraction"),
    plain("hard_shadows"),
    plain("soft_shadows"),
    variant("lamp_size_small", "lamp_size", &["-D", "objects.lamp.radius=0.02"]),
    variant("lamp_size_medium", "lamp_size", &["-D", "objects.lamp.radius=0.35"]),
    variant("lamp_size_large", "lamp_size", &["-D", "objects.lamp.radius=1.1"]),
    variant("filter_point", "antialiasing", &["-D", "film.filter=point", "--spp", "1"]),
    variant("filter_box", "antialiasing", &["-D", "film.filter=box"]),
    variant("filter_tent", "antialiasing", &["-D", "film.filter=tent"]),
    variant("filter_gaussian", "antialiasing", &["-D", "film.filter=gaussian"]),
    variant("filter_mitchell", "antialiasing", &["-D", "film.filter=mitchell"]),
    variant("filter_blackman_harris", "antialiasing", &["-D", "film.filter=blackman_harris"]),
    plain("motion_blur"),
    variant("motion_blur_panning", "motion_blur", &["--camera", "panning"]),
    plain("depth_of_field"),
    plain("everything_at_once"),
    plain("point_falloff"),
    plain("directional"),
    plain("spot_light"),
    variant("linearity_a", "linearity", &["-D", "materials.cool_lamp.intensity=0"]),
    variant("linearity_b", "linearity", &["-D", "materials.warm_lamp.intensity=0"]),
    plain("linearity"),
    plain("primitives"),
    plain("textures"),
    variant("instances", "instances", &["--size", "400x300"]),
    plain("alpha_mask"),
    light("cornell_box", &["--size", "400x400", "--spp", "128"]),
    light("sun_sky", &["--size", "480x300", "--spp", "64"]),
    light("many_lights", &["--size", "480x300", "--spp", "64"]),
    light("prism", &["--spp", "128"]),
    light("prism_screen", &["--size", "480x300", "--spp", "96"]),
    light("glass_caustics", &["--size", "480x315", "--spp", "64"]),
    light("pool", &["--size", "480x315", "--spp", "48"]),
    light("fog", &["--size", "480x300", "--spp", "128"]),
    light("cloud", &["--size", "480x320", "--spp", "16"]),
    light("rainbow", &["--size", "540x300", "--spp", "64"]),
    matter("models", &["--size", "540x315", "--spp", "64"]),
    row_of_phong("phong_table_60", &["--size", "540x135", "--spp", "16"]),
    row_of_phong(
        "phong_table_25",
        &["--size", "540x135", "--spp", "16", "-D", "lights.lamp.direction=[-0.42, 0, -0.91]"],
    ),
    row_of_phong("phong_table_0", &["--size", "540x135", "--spp", "16", "-D", "lights.lamp.direction=[0, 0, -1]"]),
    matter("diffuse", &["--size", "540x142", "--spp", "96"]),
    matter("highlights", &["--size", "540x225", "--spp", "96"]),
    matter("microfacets", &["--size", "540x225", "--spp", "96"]),
    matter("anisotropy", &["--size", "540x225", "--spp", "96"]),
    matter("lafortune", &["--size", "540x142", "--spp", "96"]),
    matter("coats", &["--size", "540x225", "--spp", "96"]),
    matter("metals", &["--size", "540x225", "--spp", "96"]),
    matter("brushed_metal", &["--size", "540x270", "--spp", "80"]),
    matter("velvet", &["--size", "540x142", "--spp", "96"]),
    matter("car_paint", &["--size", "540x142", "--spp", "96"]),
    matter("designer", &["--size", "540x195", "--spp", "128"]),
    matter("layers", &["--size", "540x225", "--spp", "64"]),
    matter("measured", &["--size", "480x280", "--spp", "96"]),
];

/// `cargo xtask gallery [NAME...]`
pub fn run(only: &[String]) -> Outcome {
    let kirkas = build_kirkas()?;
    let folder = root().join("docs/gallery");
    fs::create_dir_all(&folder).map_err(|e| e.to_string())?;
    for p in PICTURES.iter().filter(|p| only.is_empty() || only.iter().any(|o| o == p.name)) {
        let mut c = Command::new(&kirkas);
        c.current_dir(root());
        c.arg("render")
            .arg(format!("scenes/{}/{}.toml", p.folder, p.scene))
            .arg("-o")
            .arg(folder.join(format!("{}.png", p.name)));
        c.args(p.options).arg("--quiet");
        sh::run(&mut c)?;
    }
    let is_wanted = |file: &str| only.is_empty() || only.iter().any(|o| file.split('.').next() == Some(o));
    for (file, args) in PLOTS.iter().filter(|p| is_wanted(p.0)) {
        let mut c = Command::new(&kirkas);
        c.current_dir(root()).arg("brdf").args(*args).arg("-o").arg(folder.join(file));
        sh::run(&mut c)?;
    }
    Ok(())
}
