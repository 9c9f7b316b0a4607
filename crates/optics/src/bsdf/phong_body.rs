//! What `phong` and `blinn_phong` share: a diffuse part, a highlight whose shape they bring along, and the classics' mirror
//! and pane.

use super::boundary::{DeltaPair, Fresnel, Split, pick};
use super::{Branches, BsdfSample, Interface, Lobe, LobeSet, Mode, Prepare, Scatter, slot};
use crate::{Lanes, Light, Medium, Palette, Spectrum};
use core::f32::consts::PI;
use core::marker::PhantomData;
use kirkas_geometry::Vec3;
use kirkas_geometry::elementary::pow_f32;
use kirkas_geometry::warp::{square_to_cosine_hemisphere, square_to_cosine_hemisphere_pdf};
use kirkas_scene::spec::NOT_NEGATIVE;
use kirkas_scene::{Fallback, ParamSpec, ParamType, Params};

/// The rows of both tables.
pub(super) const ROWS: &[ParamSpec] = &[
    ParamSpec::reflectance("diffuse", [0.5; 3], "diffuse colour k_d").range(NOT_NEGATIVE),
    ParamSpec::reflectance("specular", [0.0; 3], "colour of the highlight k_s").range(NOT_NEGATIVE),
    ParamSpec::number_texture("exponent", 32.0, (0.0, 1e6), "sharpness of the highlight q"),
    ParamSpec::choice("form", &["normalized", "classic"], "energy-conserving, or as the textbooks of old have it"),
    ParamSpec::new("ambient", ParamType::ColorTexture, Fallback::Absent, "factor of ambient light; absent = diffuse")
        .range(NOT_NEGATIVE),
    ParamSpec::reflectance("reflect", [0.0; 3], "ideal mirror reflection on top").range(NOT_NEGATIVE),
    ParamSpec::reflectance("transmit", [0.0; 3], "ideal refraction, on closed surfaces").range(NOT_NEGATIVE),
    ParamSpec::number("ior", 1.5, "refractive index inside").range((0.01, f64::INFINITY)),
    ParamSpec::choice("fresnel", Fresnel::WORDS_CONSTANT_FIRST, "how `reflect` and `transmit` depend on the angle"),
    ParamSpec::integer("priority", 0, (-1e6, 1e6), "where insides overlap, the highest wins"),
];
const DIFFUSE: usize = slot(ROWS, "diffuse");
const SPECULAR: usize = slot(ROWS, "specular");
const EXPONENT: usize = slot(ROWS, "exponent");
const AMBIENT: usize = slot(ROWS, "ambient");
const REFLECT: usize = slot(ROWS, "reflect");
const TRANSMIT: usize = slot(ROWS, "transmit");

/// A highlight. All directions are on the +z side.
pub trait Highlight {
    /// The cosine that is raised to the exponent; at most 1, negative behind the lobe.
    fn cosine(wo: Vec3, wi: Vec3) -> f32;
    /// What `cosine^q` is multiplied by so that no more light leaves than came.
    fn normalisation(q: f32) -> f32;
    /// Density per solid angle of [`Highlight::sample`].
    fn pdf(q: f32, wo: Vec3, wi: Vec3) -> f32;
    /// A direction, perhaps below the horizon (then it carries nothing).
    fn sample(q: f32, wo: Vec3, u: (f32, f32)) -> Vec3;
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Normalized,
    Classic,
}

/// The fixed parameters.
#[derive(Clone, Debug)]
pub struct Prepared<H> {
    form: Form,
    fresnel: Fresnel,
    own_ambient: bool,
    medium: Medium,
    transmits: bool,
    shape: PhantomData<H>,
}

/// At a point.
#[derive(Clone, Debug)]
pub struct Body<H> {
    diffuse: Light,
    specular: Light,
    exponent: f32,
    form: Form,
    ambient: Light,
    delta: DeltaPair,
    /// Index under the coat of a body that bounds no medium.
    coat: Option<f32>,
    shape: PhantomData<H>,
}

impl<H: Highlight> Prepare for Prepared<H> {
    type At = Body<H>;

    fn prepare(params: &Params, palette: &Palette) -> Self {
        let form = if params.text("form") == Some("classic") { Form::Classic } else { Form::Normalized };
        Prepared {
            form,
            fresnel: Fresnel::of(params.text("fresnel")),
            own_ambient: params.has("ambient"),
            medium: Medium {
                ior: palette.index(params, "ior"),
                priority: params.integer("priority") as i32,
                absorption: Spectrum::BLACK,
            },
            // A texture may transmit anywhere.
            transmits: params.has("transmit") && params.optional_color("transmit") != Some([0.0; 3]),
            shape: PhantomData,
        }
    }

    fn at(&self, _: &Lanes, slots: &[Light], interface: Interface) -> Body<H> {
        let transmit = if self.transmits { slots[TRANSMIT] } else { Light::BLACK };
        let split = Split { reflect: slots[REFLECT], transmit, fresnel: self.fresnel, film: None };
        Body {
            diffuse: slots[DIFFUSE],
            specular: slots[SPECULAR],
            exponent: slots[EXPONENT][0],
            form: self.form,
            ambient: if self.own_ambient { slots[AMBIENT] } else { slots[DIFFUSE] },
            delta: DeltaPair { split, interface },
            coat: (!self.transmits).then(|| self.medium.ior.at_d_line()),
            shape: PhantomData,
        }
    }

    fn medium(&self) -> Option<&Medium> {
        self.transmits.then_some(&self.medium)
    }
}

impl<H: Highlight> Body<H> {
    /// Diffuse and highlight for directions on the +z side: `f` without cosine.
    fn value(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, mode: Mode) -> Light {
        let highlight = if lobes.contains(Lobe::GlossyReflection) && !self.specular.is_black() {
            power(H::cosine(wo, wi), self.exponent)
        } else {
            0.0
        };
        let diffuse = if lobes.contains(Lobe::DiffuseReflection) { self.diffuse / PI } else { Light::BLACK };
        match self.form {
            Form::Normalized => diffuse + self.specular * (highlight * H::normalisation(self.exponent)),
            // The cosine of the light is missing from the highlight, so without it the highlight is divided by it.
            Form::Classic => {
                let light = if mode == Mode::Radiance { wi } else { wo };
                diffuse + self.specular * (highlight / (PI * light.z))
            }
        }
    }

    /// The weights by which lobes are chosen: diffuse, highlight, mirror, pane; and the latter two's own.
    fn choice(&self, wo: Vec3, lobes: LobeSet) -> ([f32; 4], (Light, Light)) {
        let delta = if lobes.intersects(LobeSet::DELTA) { self.delta_weights(wo) } else { Default::default() };
        let wanted = |lobe, w: Light| if lobes.contains(lobe) { w.max_component() } else { 0.0 };
        let weights = [
            wanted(Lobe::DiffuseReflection, self.diffuse),
            wanted(Lobe::GlossyReflection, self.specular),
            wanted(Lobe::DeltaReflection, delta.0),
            wanted(Lobe::DeltaTransmission, delta.1),
        ];
        (weights, delta)
    }

    fn delta_weights(&self, wo: Vec3) -> (Light, Light) {
        self.boundary(wo).weights(wo)
    }

    /// The boundary as seen from `wo`: an opaque coat has the body's index beneath it, from either side.
    fn boundary(&self, wo: Vec3) -> DeltaPair {
        let Some(ior) = self.coat else { return self.delta };
        let outside = self.delta.interface.seen_from(wo).0;
        let interface = if wo.z > 0.0 { Interface::new(outside, ior) } else { Interface::new(ior, outside) };
        DeltaPair { interface, ..self.delta }
    }
}

/// `cosine^exponent`, and 0 behind the lobe even where the exponent is 0.
pub(super) fn power(cosine: f32, exponent: f32) -> f32 {
    if cosine > 0.0 { pow_f32(cosine, exponent) } else { 0.0 }
}

fn upper(v: Vec3, wo: Vec3) -> Vec3 {
    if wo.z < 0.0 { Vec3::new(v.x, v.y, -v.z) } else { v }
}

impl<H: Highlight> Scatter for Body<H> {
    fn lobes(&self) -> LobeSet {
        LobeSet::of(Lobe::DiffuseReflection).when(!self.diffuse.is_black())
            | LobeSet::of(Lobe::GlossyReflection).when(!self.specular.is_black())
            | self.delta.lobes()
    }

    fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, mode: Mode) -> Light {
        if wo.z * wi.z > 0.0 { self.value(upper(wo, wo), upper(wi, wo), lobes, mode) } else { Light::BLACK }
    }

    fn pdf(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, _: Mode) -> f32 {
        if !(wo.z * wi.z > 0.0) {
            return 0.0;
        }
        let (w, _) = self.choice(wo, lobes);
        let total: f32 = w.iter().sum();
        let (wo, wi) = (upper(wo, wo), upper(wi, wo));
        let mut pdf = 0.0;
        if w[0] > 0.0 {
            pdf += w[0] / total * square_to_cosine_hemisphere_pdf(wi);
        }
        if w[1] > 0.0 {
            pdf += w[1] / total * H::pdf(self.exponent, wo, wi);
        }
        pdf
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: (f32, f32), lobes: LobeSet, mode: Mode) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let (weights, (r, t)) = self.choice(wo, lobes);
        let (which, p) = pick(weights, u_lobe)?;
        let (wi, lobe) = match which {
            0 => (square_to_cosine_hemisphere(u), Lobe::DiffuseReflection),
            1 => (H::sample(self.exponent, upper(wo, wo), u), Lobe::GlossyReflection),
            2 => return Some(self.boundary(wo).reflected(wo, r, p)),
            _ => return self.boundary(wo).refracted(wo, t, p, mode),
        };
        let wi = upper(wi, wo);
        let pdf = self.pdf(wo, wi, lobes, mode);
        (pdf > 0.0).then(|| BsdfSample { wi, f: self.eval(wo, wi, lobes, mode), pdf, lobe, eta: 1.0, disperses: false })
    }

    fn delta_branches(&self, wo: Vec3, mode: Mode) -> Branches {
        self.boundary(wo).branches(wo, mode)
    }

    fn ambient(&self) -> Light {
        self.ambient
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn priorities_may_be_below_and_above_that_of_others() {
        let row = ROWS.iter().find(|row| row.name == "priority").unwrap();
        assert!(row.range.0 <= -1000.0 && row.range.1 >= 1000.0, "{:?}", row.range);
        assert_eq!(row.fallback, Fallback::Number(0.0));
    }

    #[test]
    fn what_is_seen_from_the_rim_lies_above_it() {
        let v = Vec3::new(0.5, 0.25, 0.75);
        assert_eq!(upper(v, Vec3::X), v);
        assert_eq!(upper(v, Vec3::new(0.6, 0.0, 0.8)), v);
        assert_eq!(upper(v, Vec3::new(0.6, 0.0, -0.8)), Vec3::new(0.5, 0.25, -0.75));
    }
}
