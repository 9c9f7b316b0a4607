//! Four numbers, one per lane: radiance, weights, reflectances. Which wavelength or primary a lane is, [`Lanes`](crate::Lanes)
//! knows.

use core::ops::{Add, AddAssign, Div, Index, Mul, MulAssign, Sub};

/// Light, or what is done to it, per lane. In RGB mode the lanes are red, green, blue and an idle 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Light(pub [f32; 4]);

impl Light {
    /// None at all.
    pub const BLACK: Self = Light([0.0; 4]);

    /// The same in every lane. (The weight that a path starts with is [`Lanes::one`](crate::Lanes::one).)
    pub const fn splat(x: f32) -> Self {
        Light([x; 4])
    }

    /// `f` applied to each lane.
    #[inline]
    pub fn map(self, f: impl FnMut(f32) -> f32) -> Self {
        Light(self.0.map(f))
    }

    /// The greatest lane.
    #[inline]
    pub fn max_component(self) -> f32 {
        self.0[0].max(self.0[1]).max(self.0[2].max(self.0[3]))
    }

    /// All lanes together.
    #[inline]
    pub fn sum(self) -> f64 {
        self.0.iter().map(|&x| f64::from(x)).sum()
    }

    /// True when every lane is 0.
    #[inline]
    pub fn is_black(self) -> bool {
        self.0 == [0.0; 4]
    }

    /// True when no lane is infinite or NaN.
    pub fn is_finite(self) -> bool {
        self.0.iter().all(|x| x.is_finite())
    }
}

impl Add for Light {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        Light(core::array::from_fn(|i| self.0[i] + o.0[i]))
    }
}
impl AddAssign for Light {
    #[inline]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}
impl Sub for Light {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Self {
        Light(core::array::from_fn(|i| self.0[i] - o.0[i]))
    }
}
impl Mul for Light {
    type Output = Self;
    #[inline]
    fn mul(self, o: Self) -> Self {
        Light(core::array::from_fn(|i| self.0[i] * o.0[i]))
    }
}
impl MulAssign for Light {
    #[inline]
    fn mul_assign(&mut self, o: Self) {
        *self = *self * o;
    }
}
impl Mul<f32> for Light {
    type Output = Self;
    #[inline]
    fn mul(self, x: f32) -> Self {
        Light(self.0.map(|a| a * x))
    }
}
impl Mul<Light> for f32 {
    type Output = Light;
    #[inline]
    fn mul(self, l: Light) -> Light {
        l * self
    }
}
impl MulAssign<f32> for Light {
    #[inline]
    fn mul_assign(&mut self, x: f32) {
        *self = *self * x;
    }
}
impl Div<f32> for Light {
    type Output = Self;
    #[inline]
    fn div(self, x: f32) -> Self {
        Light(self.0.map(|a| a / x))
    }
}
impl core::iter::Sum for Light {
    fn sum<I: Iterator<Item = Self>>(lights: I) -> Self {
        lights.fold(Self::BLACK, Add::add)
    }
}
impl Index<usize> for Light {
    type Output = f32;
    fn index(&self, lane: usize) -> &f32 {
        &self.0[lane]
    }
}
