//! The models of scattering, one file each, and the contract they share.
//!
//! **Frame.** +z is the shading normal. `wo` (to where the light goes, or where importance comes from) and `wi` are unit
//! vectors that point away from the surface; the sign of z tells the side. Opaque models look the same from both sides.
//!
//! **Measures.** `f` is per solid angle and projected solid angle as usual (1/sr), *without* the cosine. `pdf` is per
//! solid angle of `wi`. A delta lobe has no `f` and no pdf: `eval` and `pdf` leave it out, `sample` gives its weight (the
//! cosine already divided out) and its discrete probability. Both cases: [`BsdfSample::weight`].
//!
//! **Lobes.** Every call takes the set of lobes it is about; `pdf` and `sample` then speak of the distribution restricted
//! to that set, so `sample` with one lobe draws that lobe alone.
//!
//! **Modes.** `Importance` is the adjoint: `f*(wo, wi) = f(wi, wo)` (Veach 1997, section 3.7.6). Radiance is scaled by
//! `(eta_o / eta_i)^2` where it crosses a boundary, importance is not (Veach 1997, section 5.2). Between entering and leaving
//! a body the factors cancel; a camera *inside* a medium of index n sees n^2 the radiance, as is right, and a renderer that
//! wants its exposure independent of that divides by n^2.
//!
//! **Composed models** are made of other materials ([`Parts`]); they stand last in the list.
//!
//! To add a model: write `NAME.rs` beside this file (start from `lambert.rs`), and add `pub mod NAME;` and its row in
//! `models!` below.

use crate::{Lanes, Light, Medium, Palette};
use kirkas_geometry::Vec3;
use kirkas_scene::{ParamSpec, ParamType, Params, TypeSpec};

pub mod ashikhmin_shirley;
pub mod blend;
pub mod blinn_phong;
pub mod conductor;
pub mod cook_torrance;
pub mod dielectric;
pub mod emitter;
pub mod hull;
pub mod lafortune;
pub mod lambert;
pub mod mask;
pub mod measured;
pub mod microfacet_table;
pub mod mirror;
pub mod normal_map;
pub mod oren_nayar;
pub mod phong;
pub mod plastic;
pub mod principled;
pub mod rough_conductor;
pub mod rough_dielectric;
pub mod rough_mirror;
pub mod rough_plastic;
pub mod sum;
pub mod thin_dielectric;
pub mod two_sided;
pub mod velvet;
pub mod ward;

mod boundary;
mod coat;
mod conductor_body;
mod film;
mod glass_losses;
mod lobes;
mod mirror_body;
mod mixture;
mod opaque;
mod parts;
mod phong_body;
mod rough_coat;
mod roughness;
mod sides;
mod tilt;

pub use boundary::Interface;
pub use lobes::{Lobe, LobeSet};
pub use parts::{MOST_PARTS, NoParts, Parts, Shares, part_names};

models! {
    lambert Lambert,
    phong Phong,
    blinn_phong BlinnPhong,
    mirror Mirror,
    dielectric Dielectric,
    rough_mirror RoughMirror,
    rough_dielectric RoughDielectric,
    conductor Conductor,
    rough_conductor RoughConductor,
    emitter Emitter,
    measured Measured,
    hull Hull,
    oren_nayar OrenNayar,
    cook_torrance CookTorrance,
    ashikhmin_shirley AshikhminShirley,
    lafortune Lafortune,
    ward Ward,
    plastic Plastic,
    rough_plastic RoughPlastic,
    thin_dielectric ThinDielectric,
    velvet Velvet,
    microfacet_table MicrofacetTable,
    principled Principled,
    ;
    sum Sum,
    blend Blend,
    mask Mask,
    two_sided TwoSided,
    normal_map NormalMap,
}

/// What travels along `wo`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Paths from the camera: light arrives along `wi` and leaves along `wo`.
    Radiance,
    /// Paths from a light: light arrives along `wo` and leaves along `wi`.
    Importance,
}

/// One sampled direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// Where it goes, unit, away from the surface.
    pub wi: Vec3,
    /// The value without cosine, of all lobes asked for; for a delta lobe its weight, `L_o = f L_i`.
    pub f: Light,
    /// Density per solid angle; for a delta lobe the probability with which it was chosen. Above 0, finite.
    pub pdf: f32,
    /// The lobe it was drawn from.
    pub lobe: Lobe,
    /// Refractive index on `wi`'s side over the one on `wo`'s; 1 for reflection.
    pub eta: f32,
    /// True when only the hero went this way: the path goes on with [`BsdfSample::lanes`].
    pub disperses: bool,
}

impl BsdfSample {
    /// The lanes with which a path goes on.
    pub fn lanes(&self, lanes: Lanes) -> Lanes {
        if self.disperses { lanes.alone() } else { lanes }
    }

    /// What the light along `wi` is multiplied by: `f |cos| / pdf`, for a delta lobe `f / pdf`.
    pub fn weight(&self) -> Light {
        let cos = if self.lobe.is_delta() { 1.0 } else { self.wi.z.abs() };
        self.f * (cos / self.pdf)
    }
}

/// Delta lobes, of a plain model up to two, the reflected one first. Their `f` is whole: `pdf` is 1, nothing was drawn.
#[derive(Clone, Copy, Debug, Default)]
pub struct Branches {
    items: [Option<BsdfSample>; MOST_BRANCHES],
}

const MOST_BRANCHES: usize = 6;

impl Branches {
    /// One more. Those that go the same way are one; what finds no place is left out.
    fn push(&mut self, s: BsdfSample) {
        for item in &mut self.items {
            match item {
                None => {
                    *item = Some(s);
                    return;
                }
                Some(known) if known.lobe == s.lobe && (known.wi - s.wi).length() < 1e-5 => {
                    known.f += s.f;
                    return;
                }
                Some(_) => {}
            }
        }
    }

    /// In order.
    pub fn iter(&self) -> impl Iterator<Item = &BsdfSample> {
        self.items.iter().flatten()
    }
}

impl IntoIterator for Branches {
    type Item = BsdfSample;
    type IntoIter = core::iter::Flatten<core::array::IntoIter<Option<BsdfSample>, MOST_BRANCHES>>;
    fn into_iter(self) -> Self::IntoIter {
        self.items.into_iter().flatten()
    }
}

/// A model with its fixed parameters read: once per material.
trait Prepare: Sized {
    /// What it is at a point.
    type At: Scatter;
    /// From validated parameters.
    fn prepare(params: &Params, palette: &Palette) -> Self;
    /// With the values of its texture rows, in table order.
    fn at(&self, lanes: &Lanes, slots: &[Light], interface: Interface) -> Self::At;
    /// The filling, if the surface bounds one.
    fn medium(&self) -> Option<&Medium> {
        None
    }
}

/// A material made of others, with its fixed parameters read: once per material.
trait Compose: Sized {
    /// From validated parameters.
    fn prepare(params: &Params, palette: &Palette) -> Self;
    /// With the values of its texture rows, in table order.
    fn at(&self, slots: &[Light], parts: &dyn Parts) -> Bsdf;
    /// How much each part counts here.
    fn shares(&self, slots: &[Light]) -> Shares;
    /// Lets nothing through, whatever its parts do.
    fn is_opaque(&self) -> bool {
        false
    }
}

/// What every model answers at a point. The contract stands at the head of this file.
trait Scatter {
    fn lobes(&self) -> LobeSet;
    fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, mode: Mode) -> Light;
    fn pdf(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, mode: Mode) -> f32;
    fn sample(&self, wo: Vec3, u_lobe: f32, u: (f32, f32), lobes: LobeSet, mode: Mode) -> Option<BsdfSample>;
    fn delta_branches(&self, _wo: Vec3, _mode: Mode) -> Branches {
        Branches::default()
    }
    fn traced_lobes(&self) -> LobeSet {
        LobeSet::NONE
    }
    fn ambient(&self) -> Light {
        Light::BLACK
    }
}

/// The rows that the renderer evaluates at every hit, in the order in which [`BsdfModel::at`] takes their values.
pub fn texture_rows(spec: &'static TypeSpec) -> impl Iterator<Item = &'static ParamSpec> {
    spec.params.iter().filter(|row| is_texture(row.ty))
}

const fn is_texture(ty: ParamType) -> bool {
    matches!(ty, ParamType::ColorTexture | ParamType::NumberTexture | ParamType::VectorTexture)
}

/// Place of the row `name` among the texture rows; an unknown name does not compile.
const fn slot(params: &[ParamSpec], name: &str) -> usize {
    let (mut i, mut n) = (0, 0);
    while i < params.len() {
        if is_texture(params[i].ty) {
            if same(params[i].name.as_bytes(), name.as_bytes()) {
                return n;
            }
            n += 1;
        }
        i += 1;
    }
    panic!("no such texture row")
}

const fn same(a: &[u8], b: &[u8]) -> bool {
    let mut i = 0;
    while i < a.len() && i < b.len() && a[i] == b[i] {
        i += 1;
    }
    a.len() == b.len() && i == a.len()
}

macro_rules! models {
    ($($module:ident $Name:ident,)* ; $($composed:ident $Composed:ident,)*) => {
        /// The tables of all models, in listed order.
        pub const SPECS: &[TypeSpec] = &[$($module::SPEC,)* $($composed::SPEC,)*];

        /// A model with its fixed parameters read: once per material.
        #[derive(Clone, Debug)]
        #[allow(missing_docs)]
        pub enum BsdfModel {
            $($Name($module::Prepared),)*
            $($Composed($composed::Prepared),)*
        }

        impl BsdfModel {
            /// From validated parameters; `None` if the type is not a material's.
            pub fn prepare(params: &Params, palette: &Palette) -> Option<Self> {
                $(if params.spec().name == $module::SPEC.name {
                    return Some(BsdfModel::$Name(Prepare::prepare(params, palette)));
                })*
                $(if params.spec().name == $composed::SPEC.name {
                    return Some(BsdfModel::$Composed(Compose::prepare(params, palette)));
                })*
                None
            }

            /// Its table.
            pub fn spec(&self) -> &'static TypeSpec {
                match self {
                    $(BsdfModel::$Name(_) => &$module::SPEC,)*
                    $(BsdfModel::$Composed(_) => &$composed::SPEC,)*
                }
            }

            /// The model at a point: `slots` are the values of its [`texture_rows`] (by
            /// [`Lanes::parameter`](crate::Lanes::parameter)), black for one that is absent; `interface` the refractive
            /// indices on both sides (the same twice where the surface bounds no medium); `parts` what it is made of, if it is.
            #[inline]
            pub fn at(&self, lanes: &Lanes, slots: &[Light], interface: Interface, parts: &dyn Parts) -> Bsdf {
                match self {
                    $(BsdfModel::$Name(m) => Bsdf::$Name(m.at(lanes, slots, interface)),)*
                    $(BsdfModel::$Composed(m) => m.at(slots, parts),)*
                }
            }

            /// How much each of its parts counts at a point.
            pub fn shares(&self, slots: &[Light]) -> Shares {
                match self {
                    $(BsdfModel::$Composed(m) => m.shares(slots),)*
                    _ => [0.0; MOST_PARTS],
                }
            }

            /// True for composed models that let nothing through, whatever their parts do.
            pub fn is_opaque(&self) -> bool {
                match self {
                    $(BsdfModel::$Composed(m) => m.is_opaque(),)*
                    _ => false,
                }
            }

            /// What fills the body, if its surface is a boundary between media. (A composed model asks its parts.)
            pub fn medium(&self) -> Option<&Medium> {
                match self {
                    $(BsdfModel::$Name(m) => m.medium(),)*
                    _ => None,
                }
            }
        }

        /// A model at a point, ready to be asked. See the head of [`bsdf`](crate::bsdf) for frame and measures.
        #[derive(Clone, Debug)]
        #[allow(missing_docs)]
        pub enum Bsdf {
            $($Name($module::$Name),)*
            Mixture(mixture::Mixture),
            Sides(sides::Sides),
            Tilted(tilt::Tilted),
        }

        /// The body of a function of `Scatter`, for each variant.
        macro_rules! each {
            ($bsdf:ident, $b:ident => $answer:expr) => {
                match $bsdf {
                    $(Bsdf::$Name($b) => $answer,)*
                    Bsdf::Mixture($b) => $answer,
                    Bsdf::Sides($b) => $answer,
                    Bsdf::Tilted($b) => $answer,
                }
            };
        }

        impl Bsdf {
            /// The lobes it has here.
            pub fn lobes(&self) -> LobeSet {
                each!(self, b => b.lobes())
            }

            /// The value (1/sr, no cosine) of the lobes asked for; delta lobes count nothing.
            #[inline]
            pub fn eval(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, mode: Mode) -> Light {
                each!(self, b => b.eval(wo, wi, lobes, mode))
            }

            /// The density per solid angle with which [`Bsdf::sample`] with the same lobes gives `wi`.
            #[inline]
            pub fn pdf(&self, wo: Vec3, wi: Vec3, lobes: LobeSet, mode: Mode) -> f32 {
                each!(self, b => b.pdf(wo, wi, lobes, mode))
            }

            /// A direction drawn from the lobes asked for; `u_lobe` picks the lobe (not looked at where there is one only), `u`
            /// the direction, all in `[0, 1)`.
            /// `None`: this sample carries nothing.
            #[inline]
            pub fn sample(
                &self,
                wo: Vec3,
                u_lobe: f32,
                u: (f32, f32),
                lobes: LobeSet,
                mode: Mode,
            ) -> Option<BsdfSample> {
                each!(self, b => b.sample(wo, u_lobe, u, lobes, mode))
            }

            /// All its delta lobes with their whole weights, for a Whitted tree.
            pub fn delta_branches(&self, wo: Vec3, mode: Mode) -> Branches {
                each!(self, b => b.delta_branches(wo, mode))
            }

            /// The glossy lobes that stand for blurred mirrors and panes: a Whitted tree follows each with rays of its
            /// own, from [`Bsdf::sample`] with that one lobe. (A Phong highlight is not one of them.)
            pub fn traced_lobes(&self) -> LobeSet {
                each!(self, b => b.traced_lobes())
            }

            /// What ambient light, the classics' stand-in for all indirect light, is multiplied by.
            pub fn ambient(&self) -> Light {
                each!(self, b => b.ambient())
            }
        }
    };
}
use models;
