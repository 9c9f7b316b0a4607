//! What is recorded of a pixel: the one list of all fields, from which come the JSON and its schema.

use crate::fields::{Json, records};
use serde_json::{Value, json};

/// Of the layout. It grows whenever a field changes its meaning or goes away.
pub const VERSION: u32 = 1;

/// JSON Schema of an [`Explanation`].
pub fn schema() -> Value {
    let mut schema = Explanation::schema();
    schema["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    schema["title"] = json!("What `kirkas explain` writes");
    schema["$defs"] = Value::Object(definitions());
    schema
}

records! {
    /// Why a pixel has its colour.
    Explanation {
        /// Of this layout.
        version: u32,
        /// Of Kirkas.
        kirkas: String,
        /// The scene, as the user named it.
        scene: String,
        /// How light was found.
        integrator: String,
        /// How rays found surfaces.
        accelerator: String,
        /// How light was carried: `rgb` or `spectral`.
        color: String,
        /// Which of all pictures.
        seed: u64,
        /// Column from the left and row from the top of the whole image.
        pixel: [u32; 2],
        /// Columns and rows of the whole image.
        size: [u32; 2],
        /// The first sample, and the one behind the last.
        samples: [u32; 2],
        /// Samples that were left out, since they were not finite or absurdly bright.
        invalid_samples: u32,
        /// Mean of the samples: linear red, green, blue.
        value: [f32; 3],
        /// The pixel's stored integers, all light groups together, in units of 2^-64: what the contributions add up to exactly.
        sums: [i128; 3],
        /// Names of the light groups.
        groups: Vec<String>,
        /// In order.
        trees: Vec<Sample>,
    }
    /// One sample: the tree of its rays.
    Sample {
        /// Its number.
        sample: u32,
        /// What its contributions add up to, in units of 2^-64.
        sums: [i128; 3],
        /// It was left out.
        is_invalid: bool,
        /// What particles from the lights put on the pixel in this pass, by light group, in units of 2^-64.
        landed: Vec<Contribution>,
        /// Its rays; the first comes from the camera, and every other one after its parent.
        rays: Vec<Node>,
    }
    /// A ray of the tree, and what happened at its end.
    Node {
        /// The ray whose end sent it, by its place among the rays.
        parent: Option<usize>,
        /// `camera`, `reflected`, `refracted`, `glossy`, `diffuse`, or `passed`: the same ray behind a boundary that is not there.
        kind: &'static str,
        /// Bounces since the camera.
        depth: u32,
        /// Scene units.
        origin: [f32; 3],
        /// Unit.
        direction: [f32; 3],
        /// Seconds.
        time: f32,
        /// Of its lanes, nm; absent in RGB.
        wavelengths: Option<[f32; 4]>,
        /// What light found at its end is multiplied by, lane by lane.
        throughput: [f32; 4],
        /// Materials of the bodies that it is inside of, in the order in which they were entered.
        inside: Vec<String>,
        /// How the surface at its parent's end sent it; absent for a camera ray and behind a boundary that is not there.
        sent: Option<Sending>,
        /// What it hit; absent if it left the scene.
        hit: Option<Hit>,
        /// What it found shining.
        saw: Vec<Saw>,
        /// Lights that were asked from its end.
        asked: Vec<Asked>,
        /// Rays that its end would have sent, but did not.
        not_sent: Vec<Sending>,
        /// Why the path went no further: `escaped`, `absorbed`, `depth`, `contribution` or `roulette`; absent if it did.
        ended: Option<&'static str>,
        /// Nodes of the accelerator that it visited.
        nodes: u64,
        /// Primitives that it was tested against.
        primitives: u64,
    }
    /// Where a ray hit a surface.
    Hit {
        /// Scene units from the ray's origin.
        distance: f64,
        /// Scene units.
        position: [f64; 3],
        /// Geometric, unit, outward.
        normal: [f64; 3],
        /// Interpolated or bent, unit, on the side of `normal`.
        shading_normal: [f64; 3],
        /// The ray came from the side that `normal` points to.
        is_front: bool,
        /// Texture coordinates; 0 where the material has no texture.
        uv: [f32; 2],
        /// Name.
        object: String,
        /// Name.
        material: String,
        /// The object's face, by number.
        primitive: u32,
    }
    /// A ray that a surface or a medium sends, or would have.
    Sending {
        /// `diffuse_reflection`, `glossy_reflection`, `mirror`, `diffuse_transmission`, `glossy_transmission`, `refraction`,
        /// `medium`, or absent if no direction was found.
        lobe: Option<&'static str>,
        /// Value of the scattering function without the cosine, 1/sr, lane by lane; of a mirror or a refraction its share of the light (Fresnel).
        bsdf: [f32; 4],
        /// Density of the direction, 1/sr; of a mirror or a refraction the probability of its choice.
        pdf: f32,
        /// Between the direction and the shading normal.
        cosine: f32,
        /// Probability with which roulette let it go on.
        survival: f32,
        /// `goes`, `swallowed`, `wrong_side`, `roulette` or `too_weak`.
        fate: &'static str,
    }
    /// Light that a ray found by itself.
    Saw {
        /// `surface`, `background`, `medium`, `ambient`, `photons` or `light`.
        what: &'static str,
        /// Radiance towards the ray, W/(m2 sr), lane by lane.
        radiance: [f32; 4],
        /// The share that counts, since asking lights could have found it too.
        mis_weight: f32,
        /// What it adds to the pixel.
        contribution: Contribution,
    }
    /// A light that was asked.
    Asked {
        /// Its name; absent if no light was chosen.
        light: Option<String>,
        /// Probability of its choice; in a Whitted tree, the number of its samples.
        chance: f32,
        /// Unit, towards the place that was chosen.
        direction: [f64; 3],
        /// Scene units; not finite for lights infinitely far away.
        distance: f64,
        /// Radiance over its density, lane by lane.
        radiance_over_pdf: [f32; 4],
        /// Density of the direction, 1/sr; 0 for lights that no ray can hit.
        pdf: f32,
        /// Value of the scattering function without the cosine, 1/sr, lane by lane.
        bsdf: [f32; 4],
        /// Between the direction and the shading normal.
        cosine: f32,
        /// The share that counts, since a ray could have found it too.
        mis_weight: f32,
        /// What came of it.
        answer: Answered,
    }
    /// What came of asking a light.
    Answered {
        /// `lit`, `blocked`, `no_light`, `dark` (it sends nothing here), `behind` (the surface), or `black` (the surface, or what fills the way).
        what: &'static str,
        /// What was in the way.
        blocker: Option<Blocker>,
        /// What it adds to the pixel.
        contribution: Option<Contribution>,
    }
    /// What was in the way of a shadow ray.
    Blocker {
        /// Name.
        object: String,
        /// Name.
        material: String,
        /// The object's face, by number.
        primitive: u32,
        /// Scene units from where the light was asked, or from the last clear surface on the way.
        distance: f64,
        /// It is the surface from which the light was asked.
        is_same_surface: bool,
    }
    /// What is added to the pixel.
    Contribution {
        /// Light group, by number.
        group: u32,
        /// Red, green, blue in units of 2^-64, as integers.
        sums: [i128; 3],
        /// It was not finite or absurdly bright, and the whole sample was left out.
        is_invalid: bool,
    }
}

impl Explanation {
    /// As JSON.
    pub fn to_json(&self) -> Value {
        self.json()
    }
}

impl Contribution {
    /// Nothing yet.
    pub const NONE: Contribution = Contribution { group: 0, sums: [0; 3], is_invalid: false };

    /// As linear red, green, blue, of a single sample.
    pub fn color(&self) -> [f64; 3] {
        color(&self.sums)
    }
}

/// Units of 2^-64 as numbers.
pub fn color(sums: &[i128; 3]) -> [f64; 3] {
    sums.map(kirkas_render::film::fixed::to_f64)
}

impl Sample {
    /// Every contribution of its rays, with the ray's place.
    pub fn contributions(&self) -> impl Iterator<Item = (usize, &Contribution)> {
        self.rays.iter().enumerate().flat_map(|(i, n)| n.contributions().map(move |c| (i, c)))
    }
}

impl Node {
    /// Every contribution of it.
    pub fn contributions(&self) -> impl Iterator<Item = &Contribution> {
        let asked = self.asked.iter().filter_map(|a| a.answer.contribution.as_ref());
        self.saw.iter().map(|s| &s.contribution).chain(asked)
    }
}
