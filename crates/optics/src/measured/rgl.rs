//! The RGL database's `.bsdf` files: materials measured where their microfacets reflect, isotropic and anisotropic.
//!
//! J. Dupuy, W. Jakob, "An Adaptive Parameterization for Efficient Material Acquisition and Rendering", TOG 37(6), 2018; symbols
//! as there. `i` is the direction for which a file has slices (by longitude and angle), `o` the other one, `m` the half vector. The
//! unit square of `m` is `(sqrt(2 theta / pi), phi / 2 pi + 1/2)`, `phi` counted from `i` where the material is isotropic.
//! A warp by the visible facets takes the unit square of the measurements `u` to that of `m`, and the file holds there
//! `f cos_o 4 sigma(i) / D(m)`: nearly constant, with `D` the density of facets and `sigma` their area seen from `i` (equations
//! 8 to 10). A second warp, by luminance, makes the samples nearly perfect; [`COSINE_SHARE`] of them follow the cosine.
//!
//! The files give a density for `o` that suits `i`: here `i` is where the path comes from (`wo`), as long as the mode is
//! radiance. Measurements are reciprocal only up to their noise; nothing mends that.

use super::rgl_values::{Channels, Values, colour_weights};
use super::tensor_file::{Tensor, TensorFile};
use super::warp::{Blend, Grid, Warp};
use super::{COSINE_SHARE, Reflectance, in_lanes};
use crate::fresnel::reflect;
use crate::lanes::ColorMode;
use crate::{Lanes, Light};
use core::f32::consts::{FRAC_2_PI, FRAC_PI_2, PI, TAU};
use kirkas_geometry::Vec3;
use kirkas_geometry::elementary::{atan2_f32, sin_cos_f32};
use kirkas_geometry::warp::{square_to_cosine_hemisphere, square_to_cosine_hemisphere_pdf};

/// A material of the database.
#[derive(Clone, Debug, PartialEq)]
pub struct RglTable {
    /// What the file says of itself.
    pub description: String,
    phi_i: Vec<f32>,
    theta_i: Vec<f32>,
    /// In how many equal parts of a turn the material is the same: 1, 2 or 4.
    symmetry: u32,
    /// The facets' density, or nothing where values are `f cos` itself.
    facets: Option<Facets>,
    visible: Warp,
    luminance: Warp,
    values: Values,
    /// The part of even light from all round that is reflected, linear Rec.709.
    albedo: [f32; 3],
}

#[derive(Clone, Debug, PartialEq)]
struct Facets {
    density: Grid,
    projected: Grid,
}

/// Two directions as the file sees them.
struct Pair {
    blend: Blend,
    /// `m` in its unit square.
    m: (f32, f32),
    /// `i` in its unit square.
    i: (f32, f32),
    /// `m`'s part across the normal times the length of `i + o`.
    across: f32,
}

/// The facets' unit square by angles.
pub(super) fn square(theta: f32, phi: f32) -> (f32, f32) {
    let turns = phi / TAU + 0.5;
    ((theta * FRAC_2_PI).max(0.0).sqrt().min(1.0), turns - turns.floor())
}

/// Angle from the normal and longitude of a vector of any length.
pub(super) fn angles(v: Vec3) -> (f32, f32) {
    (atan2_f32((v.x * v.x + v.y * v.y).sqrt(), v.z), atan2_f32(v.y, v.x))
}

/// The unit vector at a point of the unit square, its longitude from `phi`.
pub(super) fn facet((x, y): (f32, f32), phi: f32) -> Vec3 {
    let (sin_t, cos_t) = sin_cos_f32(x * x * FRAC_PI_2);
    let (sin_p, cos_p) = sin_cos_f32((2.0 * y - 1.0) * PI + phi);
    Vec3::new(sin_t * cos_p, sin_t * sin_p, cos_t)
}

impl RglTable {
    /// From a file's bytes. In RGB renders measurements by wavelength become colours under D65.
    pub fn read(bytes: &[u8], mode: ColorMode) -> Result<Self, String> {
        let file = TensorFile::read(bytes)?;
        let axis = |name: &str, least: usize| -> Result<Vec<f32>, String> {
            let nodes = file.floats(name, 1)?.values;
            let rises = nodes.windows(2).all(|w| w[0] < w[1]);
            if rises && nodes.len() >= least { Ok(nodes) } else { Err(format!("its field `{name}` does not rise")) }
        };
        let (phi_i, theta_i) = (axis("phi_i", 1)?, axis("theta_i", 1)?);
        let slices = [phi_i.len(), theta_i.len()];
        let (visible, luminance) = (file.floats("vndf", 4)?, file.floats("luminance", 4)?);
        visible.check("vndf", &slices)?;
        luminance.check("luminance", &slices)?;
        let warp = |t: Tensor| Warp::new(t.shape[3], t.shape[2], t.values);
        let facets = match file.bytes("jacobian")?.first() {
            Some(0) => None,
            _ => Some(Facets { density: grid(&file, "ndf")?, projected: grid(&file, "sigma")? }),
        };
        let turn = f64::from(phi_i[phi_i.len() - 1]) - f64::from(phi_i[0]);
        let parts = core::f64::consts::TAU / turn;
        let symmetry = if phi_i.len() <= 2 { 1 } else { parts.round().clamp(1.0, 8.0) as u32 };
        if !matches!(symmetry, 1 | 2 | 4) {
            return Err(format!("its field `phi_i` spans {turn} radians"));
        }
        let mut table = RglTable {
            description: String::from_utf8_lossy(file.bytes("description").unwrap_or_default()).into_owned(),
            values: Values::read(&file, &slices, mode)?,
            phi_i,
            theta_i,
            symmetry,
            facets,
            visible: warp(visible),
            luminance: warp(luminance),
            albedo: [0.0; 3],
        };
        table.albedo = table.mean_albedo();
        Ok(table)
    }

    /// True when turning the material changes nothing.
    pub fn is_isotropic(&self) -> bool {
        self.phi_i.len() <= 2
    }

    /// Signs that turn `i` into the part of the turn that was measured, for x and y.
    fn fold(&self, i: Vec3) -> (f32, f32) {
        let towards_minus = |x: f32| if x.is_sign_negative() { 1.0 } else { -1.0 };
        match self.symmetry {
            2 => (towards_minus(i.y), towards_minus(i.y)),
            4 => (towards_minus(i.x), towards_minus(i.y)),
            _ => (1.0, 1.0),
        }
    }

    fn pair(&self, i: Vec3, o: Vec3) -> Pair {
        let (sx, sy) = self.fold(i);
        let turn = |v: Vec3| Vec3::new(sx * v.x, sy * v.y, v.z);
        let (i, sum) = (turn(i), turn(i + o));
        let ((theta_i, phi_i), (theta_m, phi_m)) = (angles(i), angles(sum));
        let from = if self.is_isotropic() { phi_i } else { 0.0 };
        Pair {
            blend: Blend::between(&self.phi_i, phi_i, &self.theta_i, theta_i),
            m: square(theta_m, phi_m - from),
            i: square(theta_i, phi_i),
            across: (sum.x * sum.x + sum.y * sum.y).sqrt(),
        }
    }

    /// `D(m) / 4 sigma(i)`.
    fn facets(&self, p: &Pair) -> f32 {
        match &self.facets {
            None => 1.0,
            Some(f) => f.density.at(p.m) / (4.0 * f.projected.at(p.i)),
        }
    }

    /// Of even light from all round, by samples of cosine-distributed `i` and the table's own `o`.
    fn mean_albedo(&self) -> [f32; 3] {
        const SAMPLES: u32 = 1024;
        let channels = self.values.channels.count();
        let mut sums = vec![0.0_f64; channels];
        for k in 0..SAMPLES {
            let u = |base: f64| (f64::from(k) * base).fract() as f32;
            let i = square_to_cosine_hemisphere(((k as f32 + 0.5) / SAMPLES as f32, u(0.754_877_666_246_692_8)));
            let o = self.draw(i, u(0.569_840_290_998_053_3), (u(0.819_172_513_396_164_4), u(0.671_043_606_703_789_2)));
            if o.z > 0.0 && i.z > 0.0 {
                let p = self.pair(i, o);
                let (u, _) = self.visible.invert(&p.blend, p.m);
                let weight = f64::from(self.facets(&p) / self.density(i, o)) / f64::from(SAMPLES);
                for (c, sum) in sums.iter_mut().enumerate() {
                    *sum += weight * f64::from(self.values.channel(&p.blend, u, c).max(0.0));
                }
            }
        }
        match &self.values.channels {
            Channels::Rgb => core::array::from_fn(|c| sums[c] as f32),
            Channels::Waves(waves) => colour_weights(waves)
                .iter()
                .zip(&sums)
                .fold([0.0; 3], |rgb, (w, s)| core::array::from_fn(|c| rgb[c] + (w[c] * s) as f32)),
        }
    }
}

impl Reflectance for RglTable {
    fn value(&self, wo: Vec3, wi: Vec3, lanes: &Lanes) -> Light {
        let p = self.pair(wo, wi);
        let (u, _) = self.visible.invert(&p.blend, p.m);
        self.values.at(&p.blend, u, lanes) * (self.facets(&p) / wi.z)
    }

    fn density(&self, wo: Vec3, wi: Vec3) -> f32 {
        let cosine = COSINE_SHARE * square_to_cosine_hemisphere_pdf(wi);
        let p = self.pair(wo, wi);
        let (u, visible) = self.visible.invert(&p.blend, p.m);
        let drawn = visible * self.luminance.density(&p.blend, u);
        // Unit square to solid angle of m (2 pi^2 u sin), to that of wi (4 wo.m, twice the length of wo + wi).
        const LEAST: f32 = 1e-12;
        cosine + (1.0 - COSINE_SHARE) * drawn / (4.0 * PI * PI * p.m.0 * p.across).max(LEAST)
    }

    fn draw(&self, wo: Vec3, u_lobe: f32, u: (f32, f32)) -> Vec3 {
        if u_lobe < COSINE_SHARE {
            return square_to_cosine_hemisphere(u);
        }
        let (sx, sy) = self.fold(wo);
        let i = Vec3::new(sx * wo.x, sy * wo.y, wo.z);
        let (theta_i, phi_i) = angles(i);
        let blend = Blend::between(&self.phi_i, phi_i, &self.theta_i, theta_i);
        let m = self.visible.sample(&blend, self.luminance.sample(&blend, u));
        let o = reflect(i, facet(m, if self.is_isotropic() { phi_i } else { 0.0 }));
        Vec3::new(sx * o.x, sy * o.y, o.z)
    }

    fn albedo(&self, lanes: &Lanes) -> Light {
        in_lanes(self.albedo, lanes)
    }
}

/// A table of the facets, nowhere negative.
fn grid(file: &TensorFile, name: &str) -> Result<Grid, String> {
    let tensor = file.floats(name, 2)?;
    tensor.check(name, &[])?;
    /// Keeps what is divided by it finite.
    const LEAST: f32 = 1e-12;
    let values = tensor.values.into_iter().map(|v| v.max(LEAST)).collect();
    Ok(Grid { width: tensor.shape[1], height: tensor.shape[0], values })
}
