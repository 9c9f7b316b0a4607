//! Elementary functions that give the same bits on every platform: the `libm` crate, never the platform's.
//!
//! `f32` answers are the `f64` ones rounded, so they are almost always correctly rounded.

/// Sine, radians.
pub fn sin(x: f64) -> f64 {
    libm::sin(x)
}
/// Cosine, radians.
pub fn cos(x: f64) -> f64 {
    libm::cos(x)
}
/// Tangent, radians.
pub fn tan(x: f64) -> f64 {
    libm::tan(x)
}
/// Arc sine.
pub fn asin(x: f64) -> f64 {
    libm::asin(x)
}
/// Arc cosine, in `[0, pi]`.
pub fn acos(x: f64) -> f64 {
    libm::acos(x)
}
/// Arc tangent.
pub fn atan(x: f64) -> f64 {
    libm::atan(x)
}
/// Angle of the point `(x, y)`, in `[-pi, pi]`.
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}
/// e to the x.
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}
/// Natural logarithm.
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}
/// Base-2 logarithm.
pub fn log2(x: f64) -> f64 {
    libm::log2(x)
}
/// x to the y.
pub fn pow(x: f64, y: f64) -> f64 {
    libm::pow(x, y)
}
/// Cube root.
pub fn cbrt(x: f64) -> f64 {
    libm::cbrt(x)
}

/// Sine and cosine of an f32 angle in radians.
pub fn sin_cos_f32(x: f32) -> (f32, f32) {
    let (s, c) = libm::sincos(f64::from(x));
    (s as f32, c as f32)
}
/// e to the x.
pub fn exp_f32(x: f32) -> f32 {
    libm::exp(f64::from(x)) as f32
}
/// x to the y.
pub fn pow_f32(x: f32, y: f32) -> f32 {
    libm::pow(f64::from(x), f64::from(y)) as f32
}
/// Arc cosine, in `[0, pi]`.
pub fn acos_f32(x: f32) -> f32 {
    libm::acos(f64::from(x)) as f32
}
/// Angle of the point `(x, y)`, in `[-pi, pi]`.
pub fn atan2_f32(y: f32, x: f32) -> f32 {
    libm::atan2(f64::from(y), f64::from(x)) as f32
}
/// Natural logarithm.
pub fn ln_f32(x: f32) -> f32 {
    libm::log(f64::from(x)) as f32
}
