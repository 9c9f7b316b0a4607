//! A boundary between two media: the delta pair of mirror and pane that several models share, and how light is split.

use super::{Branches, BsdfSample, Lobe, LobeSet, Mode};
use crate::index::Index;
use crate::thin_film::{Beneath, Film};
use crate::{Lanes, Light, fresnel};
use kirkas_geometry::Vec3;

/// Refractive indices on both sides of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interface {
    /// On the +z side, in the hero's lane.
    pub eta_above: f32,
    /// On the -z side, in the hero's lane.
    pub eta_below: f32,
    /// Set where lanes refract differently.
    spread: Option<Spread>,
}

/// Indices by lane. All lanes are reflected together; only the hero is refracted, and stands for the others.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Spread {
    above: Light,
    below: Light,
    /// See [`Lanes::hero_weight`].
    hero_weight: Light,
}

impl Interface {
    /// Nothing on either side.
    pub const VACUUM: Self = Interface::new(1.0, 1.0);

    /// The same indices in every lane.
    pub const fn new(eta_above: f32, eta_below: f32) -> Self {
        Interface { eta_above, eta_below, spread: None }
    }

    /// For a path's lanes.
    pub fn between(lanes: &Lanes, above: &Index, below: &Index) -> Self {
        let disperses = (above.is_dispersive() || below.is_dispersive()) && !lanes.is_alone() && above != below;
        let spread = disperses.then(|| Spread {
            above: above.at(lanes),
            below: below.at(lanes),
            hero_weight: lanes.hero_weight(),
        });
        Interface { eta_above: above.of_hero(lanes), eta_below: below.of_hero(lanes), spread }
    }

    /// True when only the hero is refracted.
    pub fn disperses(&self) -> bool {
        self.spread.is_some()
    }

    /// What a refracted lane is multiplied by.
    pub(crate) fn refracted_weight(&self) -> Light {
        self.spread.map_or(Light::splat(1.0), |s| s.hero_weight)
    }

    /// `(eta_o, eta_i)`: on `wo`'s side and beyond.
    pub fn seen_from(&self, wo: Vec3) -> (f32, f32) {
        if wo.z > 0.0 { (self.eta_above, self.eta_below) } else { (self.eta_below, self.eta_above) }
    }
}

/// How the two parts are weighted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fresnel {
    /// The classics' constants: both parts at full weight at any angle; radiance is not scaled on crossing.
    Constant,
    /// Schlick's approximation.
    Schlick,
    /// Fresnel's equations for unpolarised light.
    Exact,
}

impl Fresnel {
    pub(crate) const WORDS: &'static [&'static str] = &["exact", "schlick", "constant"];
    pub(crate) const WORDS_CONSTANT_FIRST: &'static [&'static str] = &["constant", "schlick", "exact"];

    pub(crate) fn of(word: Option<&str>) -> Self {
        match word {
            Some("constant") => Fresnel::Constant,
            Some("schlick") => Fresnel::Schlick,
            _ => Fresnel::Exact,
        }
    }
}

/// The two parts and their weighting; the geometry comes from the caller.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Split {
    pub(crate) reflect: Light,
    pub(crate) transmit: Light,
    pub(crate) fresnel: Fresnel,
    /// Between the two, unless the weights are constant.
    pub(crate) film: Option<Film>,
}

impl Split {
    /// Weights `(R, T)` of reflection and transmission at a (micro)facet, seen from `wo`'s side at this cosine; `T` is of power,
    /// black under total reflection, and still of all lanes.
    pub(crate) fn at(&self, cos_o: f32, interface: &Interface, wo: Vec3) -> (Light, Light) {
        let (eta_o, eta_i) = interface.seen_from(wo);
        if let (Some(film), false) = (&self.film, self.fresnel == Fresnel::Constant) {
            let n = match &interface.spread {
                Some(spread) => {
                    if wo.z > 0.0 {
                        spread.below
                    } else {
                        spread.above
                    }
                }
                None => Light::splat(eta_i),
            };
            let r = film.reflectance(cos_o, eta_o, &Beneath { n, k: Light::BLACK });
            // Beyond the critical angle the film lets nothing through, but for rounding.
            let r = if fresnel::refracted_cosine(cos_o, eta_o, eta_i).is_some() { r } else { Light::splat(1.0) };
            return (self.reflect * r, self.transmit * r.map(|r| 1.0 - r));
        }
        let Some(spread) = &interface.spread else {
            let (r, t) = self.parts(cos_o, eta_o, eta_i);
            return (self.reflect * r, self.transmit * t);
        };
        let (etas_o, etas_i) = if wo.z > 0.0 { (spread.above, spread.below) } else { (spread.below, spread.above) };
        let parts: [(f32, f32); 4] = core::array::from_fn(|lane| self.parts(cos_o, etas_o[lane], etas_i[lane]));
        (self.reflect * Light(parts.map(|p| p.0)), self.transmit * Light(parts.map(|p| p.1)))
    }

    /// How much of each part there is.
    fn parts(&self, cos_o: f32, eta_o: f32, eta_i: f32) -> (f32, f32) {
        let f = match self.fresnel {
            Fresnel::Constant => {
                let passes = fresnel::refracted_cosine(cos_o, eta_o, eta_i).is_some();
                return (1.0, if passes { 1.0 } else { 0.0 });
            }
            Fresnel::Schlick => fresnel::dielectric_schlick(cos_o, eta_o, eta_i),
            Fresnel::Exact => fresnel::dielectric(cos_o, eta_o, eta_i),
        };
        (f, 1.0 - f)
    }

    /// What turns a transmitted power into what travels along `wo` in this mode. The constant hack leaves radiance alone,
    /// so it is its adjoint that scales.
    pub(crate) fn transmission_scale(&self, eta_o: f32, eta_i: f32, mode: Mode) -> f32 {
        match (self.fresnel, mode) {
            (Fresnel::Constant, Mode::Radiance) => 1.0,
            (Fresnel::Constant, Mode::Importance) => square(eta_o / eta_i),
            (_, Mode::Radiance) => square(eta_o / eta_i),
            (_, Mode::Importance) => 1.0,
        }
    }
}

/// A perfectly smooth boundary: mirror and pane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DeltaPair {
    pub(crate) split: Split,
    pub(crate) interface: Interface,
}

impl DeltaPair {
    pub(crate) fn lobes(&self) -> LobeSet {
        LobeSet::of(Lobe::DeltaReflection).when(!self.split.reflect.is_black())
            | LobeSet::of(Lobe::DeltaTransmission).when(!self.split.transmit.is_black())
    }

    /// Weights `(R, T)` of power for light along `wo`.
    pub(crate) fn weights(&self, wo: Vec3) -> (Light, Light) {
        self.split.at(wo.z.abs(), &self.interface, wo)
    }

    /// The mirrored direction with weight `f`, chosen with probability `pdf`.
    pub(crate) fn reflected(&self, wo: Vec3, f: Light, pdf: f32) -> BsdfSample {
        BsdfSample {
            wi: Vec3::new(-wo.x, -wo.y, wo.z),
            f,
            pdf,
            lobe: Lobe::DeltaReflection,
            eta: 1.0,
            disperses: false,
        }
    }

    /// The refracted direction with weight of power `t`, chosen with probability `pdf`.
    pub(crate) fn refracted(&self, wo: Vec3, t: Light, pdf: f32, mode: Mode) -> Option<BsdfSample> {
        let (eta_o, eta_i) = self.interface.seen_from(wo);
        let n = Vec3::new(0.0, 0.0, 1.0_f32.copysign(wo.z));
        let wi = fresnel::refract(wo, n, eta_o, eta_i)?;
        let f = t * self.split.transmission_scale(eta_o, eta_i, mode) * self.interface.refracted_weight();
        Some(BsdfSample {
            wi,
            f,
            pdf,
            lobe: Lobe::DeltaTransmission,
            eta: eta_i / eta_o,
            disperses: self.interface.disperses(),
        })
    }

    pub(crate) fn branches(&self, wo: Vec3, mode: Mode) -> Branches {
        let mut all = Branches::default();
        if wo.z == 0.0 {
            return all;
        }
        let (r, t) = self.weights(wo);
        if !r.is_black() {
            all.push(self.reflected(wo, r, 1.0));
        }
        if !t.is_black()
            && let Some(s) = self.refracted(wo, t, 1.0, mode)
        {
            all.push(s);
        }
        all
    }
}

/// Which of several alternatives `u` in `[0, 1)` picks, each with its weight, and the probability of that; `None` if all
/// weights are 0.
pub(crate) fn pick<const N: usize>(weights: [f32; N], u: f32) -> Option<(usize, f32)> {
    let total: f32 = weights.iter().sum();
    let mut left = u * total;
    let mut last = None;
    for (i, &w) in weights.iter().enumerate().filter(|(_, w)| **w > 0.0) {
        last = Some((i, w / total));
        if left < w {
            break;
        }
        left -= w;
    }
    last
}

pub(crate) fn square(x: f32) -> f32 {
    x * x
}
