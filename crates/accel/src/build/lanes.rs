//! Four f32 side by side, of which builders use three. SSE2, which every x86-64 has, or plain arrays: the same bits.

#[cfg(target_arch = "x86_64")]
use core::arch::x86_64::*;

/// Four numbers.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub(crate) struct Lanes(pub [f32; 4]);

/// Four answers: all bits set for yes.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub(crate) struct Mask(pub [u32; 4]);

#[cfg(target_arch = "x86_64")]
macro_rules! sse {
    ($call:expr) => {{
        // SAFETY: every x86-64 has SSE2.
        unsafe { $call }
    }};
}

#[cfg(target_arch = "x86_64")]
impl Lanes {
    #[inline(always)]
    fn get(self) -> __m128 {
        // SAFETY: both are four f32 in order.
        unsafe { core::mem::transmute(self) }
    }

    #[inline(always)]
    fn new(v: __m128) -> Self {
        // SAFETY: both are four f32 in order.
        unsafe { core::mem::transmute(v) }
    }

    /// The lesser of each; `o` when they are equal or one is NaN.
    #[inline(always)]
    pub fn min(self, o: Self) -> Self {
        Self::new(sse!(_mm_min_ps(self.get(), o.get())))
    }

    /// The greater of each; `o` when they are equal or one is NaN.
    #[inline(always)]
    pub fn max(self, o: Self) -> Self {
        Self::new(sse!(_mm_max_ps(self.get(), o.get())))
    }

    #[inline(always)]
    pub fn plus(self, o: Self) -> Self {
        Self::new(sse!(_mm_add_ps(self.get(), o.get())))
    }

    #[inline(always)]
    pub fn minus(self, o: Self) -> Self {
        Self::new(sse!(_mm_sub_ps(self.get(), o.get())))
    }

    #[inline(always)]
    pub fn times(self, o: Self) -> Self {
        Self::new(sse!(_mm_mul_ps(self.get(), o.get())))
    }

    #[inline(always)]
    pub fn less(self, o: Self) -> Mask {
        // SAFETY: every x86-64 has SSE2, and both are four times 32 bits in order.
        unsafe { core::mem::transmute(_mm_cmplt_ps(self.get(), o.get())) }
    }

    /// Of `self` where the mask says yes, else of `o`.
    #[inline(always)]
    pub fn where_or(self, mask: Mask, o: Self) -> Self {
        // SAFETY: both are four times 32 bits in order.
        let mask: __m128 = unsafe { core::mem::transmute(mask) };
        Self::new(sse!(_mm_or_ps(_mm_and_ps(mask, self.get()), _mm_andnot_ps(mask, o.get()))))
    }

    /// The x, the y and the z of three.
    #[inline(always)]
    pub fn transpose([a, b, c]: [Self; 3]) -> [Self; 3] {
        let (a, b, c) = (a.get(), b.get(), c.get());
        let ab = sse!(_mm_unpacklo_ps(a, b));
        let x = sse!(_mm_movelh_ps(ab, c));
        let y = sse!(_mm_shuffle_ps::<0b01_01_11_10>(ab, c));
        let z = sse!(_mm_shuffle_ps::<0b10_10_01_00>(_mm_unpackhi_ps(a, b), c));
        [Self::new(x), Self::new(y), Self::new(z)]
    }
}

#[cfg(not(target_arch = "x86_64"))]
impl Lanes {
    #[inline(always)]
    fn with(self, o: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        Lanes(core::array::from_fn(|i| f(self.0[i], o.0[i])))
    }

    /// The lesser of each; `o` when they are equal or one is NaN.
    #[inline(always)]
    pub fn min(self, o: Self) -> Self {
        self.with(o, |a, b| if a < b { a } else { b })
    }

    /// The greater of each; `o` when they are equal or one is NaN.
    #[inline(always)]
    pub fn max(self, o: Self) -> Self {
        self.with(o, |a, b| if a > b { a } else { b })
    }

    #[inline(always)]
    pub fn plus(self, o: Self) -> Self {
        self.with(o, |a, b| a + b)
    }

    #[inline(always)]
    pub fn minus(self, o: Self) -> Self {
        self.with(o, |a, b| a - b)
    }

    #[inline(always)]
    pub fn times(self, o: Self) -> Self {
        self.with(o, |a, b| a * b)
    }

    #[inline(always)]
    pub fn less(self, o: Self) -> Mask {
        Mask(core::array::from_fn(|i| if self.0[i] < o.0[i] { u32::MAX } else { 0 }))
    }

    /// Of `self` where the mask says yes, else of `o`.
    #[inline(always)]
    pub fn where_or(self, mask: Mask, o: Self) -> Self {
        Lanes(core::array::from_fn(|i| if mask.0[i] != 0 { self.0[i] } else { o.0[i] }))
    }

    /// The x, the y and the z of three.
    #[inline(always)]
    pub fn transpose(rows: [Self; 3]) -> [Self; 3] {
        [0, 1, 2].map(|k| Lanes([rows[0].0[k], rows[1].0[k], rows[2].0[k], 0.0]))
    }
}

impl Lanes {
    #[inline(always)]
    pub fn splat(x: f32) -> Self {
        Lanes([x; 4])
    }

    #[inline(always)]
    pub fn to_bits(self) -> [u32; 4] {
        let [x, y, z, w] = self.0;
        [x.to_bits(), y.to_bits(), z.to_bits(), w.to_bits()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_do_what_single_numbers_do() {
        let (a, b) = (Lanes([1.0, -2.0, 0.5, f32::INFINITY]), Lanes([0.25, 3.0, 0.5, 7.0]));
        for i in 0..4 {
            let (x, y) = (a.0[i], b.0[i]);
            assert_eq!([a.min(b).0[i], a.max(b).0[i]], [x.min(y), x.max(y)]);
            assert_eq!([a.plus(b).0[i], a.minus(b).0[i], a.times(b).0[i]], [x + y, x - y, x * y]);
            assert_eq!(a.where_or(a.less(b), b).0[i], x.min(y));
        }
        let rows = [a, b, Lanes([5.0, 6.0, 8.0, 9.0])];
        let columns = Lanes::transpose(rows);
        for (k, column) in columns.iter().enumerate() {
            assert_eq!([column.0[0], column.0[1], column.0[2]], [rows[0].0[k], rows[1].0[k], rows[2].0[k]]);
        }
    }
}
