//! A film so thin that light bouncing in it interferes: soap skins, oil on water, tempered steel, anodised titanium.
//!
//! Exact for a flat film of one index on a clear or metallic body (Airy's sum over all bounces; M. Born & E. Wolf, "Principles of
//! Optics", 7th ed., sections 7.6.1 and 14.4); put on each facet of rough bodies as L. Belcour & P. Barla, "A Practical Extension to
//! Microfacet Theory for the Modeling of Varying Iridescence", SIGGRAPH 2017, do. Where they integrate over the eye's curves by
//! Fourier's transform, renders in RGB here add up [`crate::spectrum::observer::BANDS`] bands of the spectrum.

use crate::lanes::ColorMode;
use crate::spectrum::observer::observer;
use crate::{Lanes, Light};
use core::f64::consts::PI;
use kirkas_geometry::elementary::{exp, sin_cos};

/// A film as a path's lanes see it.
#[derive(Clone, Copy, Debug)]
pub struct Film {
    /// nm
    thickness: f32,
    ior: f32,
    wavelengths: [f32; 4],
    mode: ColorMode,
}

/// What lies under a film, by lane: the refractive index `n + i k`.
#[derive(Clone, Copy, Debug)]
pub struct Beneath {
    /// n
    pub n: Light,
    /// k, 0 for clear bodies.
    pub k: Light,
}

impl Film {
    /// `None` where there is none: no thickness (nm).
    pub fn new(lanes: &Lanes, thickness: f32, ior: f32) -> Option<Self> {
        (thickness > 0.0).then(|| Film { thickness, ior, wavelengths: lanes.wavelengths(), mode: lanes.mode() })
    }

    /// Reflectance for unpolarised light from a medium of index `eta_o`, by lane.
    pub fn reflectance(&self, cos: f32, eta_o: f32, beneath: &Beneath) -> Light {
        let at = |wavelength: f32, n: f32, k: f32| {
            airy(
                f64::from(cos),
                f64::from(eta_o),
                f64::from(self.ior),
                (f64::from(n), f64::from(k)),
                f64::from(self.thickness / wavelength),
            )
        };
        if self.mode == ColorMode::Spectral {
            return Light(core::array::from_fn(|lane| {
                at(self.wavelengths[lane], beneath.n[lane], beneath.k[lane]) as f32
            }));
        }
        // Red, green and blue fall with the lane; between them the body's index is linear in the wavelength.
        let index = |of: &Light, wavelength: f32| {
            let [red, green, blue, _] = self.wavelengths;
            let (a, b, from, to) = if wavelength < green { (2, 1, blue, green) } else { (1, 0, green, red) };
            let t = ((wavelength - from) / (to - from)).clamp(0.0, 1.0);
            of[a] + (of[b] - of[a]) * t
        };
        let mut sum = [0.0; 3];
        for (wavelength, weights) in observer().bands() {
            let r = at(*wavelength, index(&beneath.n, *wavelength), index(&beneath.k, *wavelength));
            for (s, w) in sum.iter_mut().zip(weights) {
                *s += w * r;
            }
        }
        Light([sum[0], sum[1], sum[2], 0.0].map(|x| x.clamp(0.0, 1.0) as f32))
    }
}

/// Reflectance of unpolarised light by a film of index `eta_f` and a thickness in wavelengths, between a medium of index `eta_o`, from
/// which light comes at this cosine, and a body of index `n + i k`.
pub fn airy(cos: f64, eta_o: f64, eta_f: f64, (n, k): (f64, f64), thickness: f64) -> f64 {
    let (one, body) = (Complex(eta_o, 0.0), Complex(n, k));
    let film = Complex(eta_f, 0.0);
    let tangential2 = eta_o * eta_o * (1.0 - cos) * (1.0 + cos);
    // Each index times the cosine within.
    let (c1, c2, c3) = (Complex(eta_o * cos, 0.0), normal_part(film, tangential2), normal_part(body, tangential2));
    let phase = (c2 * (4.0 * PI * thickness)).exp_i();
    let power = |first: Complex, second: Complex| {
        let r = (first + second * phase) / (Complex(1.0, 0.0) + first * second * phase);
        r.0 * r.0 + r.1 * r.1
    };
    let across = |a: Complex, b: Complex| (a - b) / (a + b);
    // Along the plane of incidence, n_b^2 c_a - n_a^2 c_b over their sum.
    let along = |na: Complex, ca: Complex, nb: Complex, cb: Complex| {
        let (x, y) = (nb * nb * ca, na * na * cb);
        (x - y) / (x + y)
    };
    let s = power(across(c1, c2), across(c2, c3));
    let p = power(along(one, c1, film, c2), along(film, c2, body, c3));
    let mean = 0.5 * (s + p);
    if mean.is_finite() { mean.clamp(0.0, 1.0) } else { 1.0 }
}

/// `sqrt(index^2 - tangential^2)`, on the branch that fades inwards.
fn normal_part(index: Complex, tangential2: f64) -> Complex {
    (index * index - Complex(tangential2, 0.0)).sqrt()
}

#[derive(Clone, Copy)]
struct Complex(f64, f64);

impl Complex {
    /// The root whose imaginary part is not negative.
    fn sqrt(self) -> Self {
        let size = (self.0 * self.0 + self.1 * self.1).sqrt();
        let real = (0.5 * (size + self.0)).max(0.0).sqrt();
        let imaginary = (0.5 * (size - self.0)).max(0.0).sqrt();
        Complex(if self.1 < 0.0 { -real } else { real }, imaginary)
    }

    /// `exp(i z)`
    fn exp_i(self) -> Self {
        let (sin, cos) = sin_cos(self.0);
        let size = exp(-self.1);
        Complex(size * cos, size * sin)
    }
}

impl core::ops::Add for Complex {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Complex(self.0 + o.0, self.1 + o.1)
    }
}
impl core::ops::Sub for Complex {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Complex(self.0 - o.0, self.1 - o.1)
    }
}
impl core::ops::Mul for Complex {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Complex(self.0 * o.0 - self.1 * o.1, self.0 * o.1 + self.1 * o.0)
    }
}
impl core::ops::Mul<f64> for Complex {
    type Output = Self;
    fn mul(self, x: f64) -> Self {
        Complex(self.0 * x, self.1 * x)
    }
}
impl core::ops::Div for Complex {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let size = o.0 * o.0 + o.1 * o.1;
        Complex((self.0 * o.0 + self.1 * o.1) / size, (self.1 * o.0 - self.0 * o.1) / size)
    }
}
